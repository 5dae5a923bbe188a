"""A ball-and-stick model: the atoms of a diamond crystal, and bonds between them.

    python benchmarks/scenes/ball_and_stick.py FOLDER ATOMS

Writes two scenes, atoms.json and bonds.json: the atoms alone, and with two bonds for each.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import vtray

SIDE = 1024
ATOM, BOND = 0.28, 0.1
"""Radii of atoms and bonds, for bonds of length 1."""
ONE, OTHER = (70, 110, 190), (240, 170, 60)
"""Colours of the halves of the atoms, and of each bond."""


def make_crystal(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return atoms and bonds of a ball of crystal, its bonds of length 1.

    Parameters
    ----------
    count
        How many atoms there are, even.

    Returns
    -------
    atoms
        Their places, (count, 3): one half of them, and the other.
    bonds
        Where bonds start and end, (2, 2 * count, 3): four from each atom of the first half.
    """
    cells = int(np.cbrt(count)) + 2
    grid = np.stack(np.meshgrid(*[np.arange(-cells, cells)] * 3, indexing="ij"), axis=-1)
    places = grid.reshape(-1, 3)
    places = places[places.sum(axis=1) % 2 == 0]
    nearest = np.argsort((places**2).sum(axis=1), kind="stable")[: count // 2]
    ways = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / np.sqrt(3)
    first = places[nearest] * (2 / np.sqrt(3))
    ends = first[:, None] + ways
    starts = np.broadcast_to(first[:, None], ends.shape)
    bonds = np.stack([starts.reshape(-1, 3), ends.reshape(-1, 3)])
    return np.concatenate([first, first + ways[0]]), bonds


def make_scenes(count: int, side: int = SIDE) -> dict[str, vtray.Scene]:
    """Return a scene of the atoms alone, and one with bonds, seen alike."""
    atoms, (start, end) = make_crystal(count)
    colors = np.repeat(np.array([ONE, OTHER], np.uint8), [count // 2, count - count // 2], axis=0)
    scenes = {}
    for name in ("atoms", "bonds"):
        scene = scenes[name] = vtray.Scene()
        scene.add_spheres(atoms, ATOM, color=colors)
        scene.add_plane((0, 1.1 * float(atoms[:, 1].min()), 0), (0, 1, 0), color=(230, 230, 230))
        scene.camera = vtray.Camera.fit(scene, (-0.5, -0.4, -1), size=(side, side))
        scene.lights = vtray.lights.rembrandt(scene, points=True)[:1]
    scenes["bonds"].add_cylinders(start, end, BOND, color=ONE, color_end=OTHER)
    return scenes


def write_scenes(count: int, folder: Path, side: int = SIDE) -> dict[str, Path]:
    """Write the scene files, and arrays beside them."""
    paths = {}
    for name, scene in make_scenes(count, side).items():
        paths[name] = folder / f"{name}.json"
        scene.save(paths[name])
    return paths


if __name__ == "__main__":
    for path in write_scenes(int(float(sys.argv[2])), Path(sys.argv[1])).values():
        print(path)
