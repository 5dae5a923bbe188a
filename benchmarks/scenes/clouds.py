"""Clouds of spheres like those of molecules, in studio light: chains, and balls of packed atoms.

python benchmarks/scenes/clouds.py FOLDER COUNT [COUNT ...]
"""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import vtray

SIDE = 1024
SEED = 4
ATOM = 0.6
"""Radius of the atoms of a chain, in steps."""
CARBON, NITROGEN, OXYGEN = 1.7, 1.55, 1.52
"""Radii of atoms, in angstroms."""
APART = 2.15
"""How far apart packed atoms are: as dense as in proteins."""

Cloud = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Centres (n, 3) and radii (n,)."""


def make_chain(count: int) -> Cloud:
    """Make a walk with steps at random, pressed into about `count` units of volume."""
    steps = np.random.default_rng(SEED).normal(size=(count, 3))
    places = np.cumsum(steps, axis=0)
    return places * (np.cbrt(count) / np.abs(places).max()), np.full(count, ATOM)


def make_packed(count: int) -> Cloud:
    """Make a ball of atoms that overlap, each a little off its place in a grid."""
    generator = np.random.default_rng(SEED)
    cells = int(np.cbrt(2 * count)) + 2
    axis = np.arange(cells) - cells / 2
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3) * APART
    grid += 0.35 * generator.normal(size=grid.shape)
    nearest = np.argsort((grid**2).sum(axis=1))[:count]
    return grid[nearest], generator.choice([CARBON, NITROGEN, OXYGEN], count)


CLOUDS: dict[str, Callable[[int], Cloud]] = {"in a chain": make_chain, "packed": make_packed}


def make_scene(kind: str, count: int, side: int = SIDE) -> vtray.Scene:
    """Return a cloud of a kind as scenes look whose lights were never set."""
    scene = vtray.Scene()
    scene.add_spheres(*CLOUDS[kind](count), color="#3a6ea5")
    scene.camera = vtray.Camera.fit(scene, size=(side, side))
    return scene


if __name__ == "__main__":
    for number in sys.argv[2:]:
        for name in CLOUDS:
            path = Path(sys.argv[1]) / f"{name.split()[-1]}-{int(float(number))}.json"
            make_scene(name, int(float(number))).save(path)
            print(path)
