"""Five sets of particles such as people look at, made up without any data from outside."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CARBON, NITROGEN, OXYGEN, SULFUR = (144, 144, 144), (48, 80, 248), (255, 13, 13), (255, 200, 50)
"""The colours that chemists' programs give to elements."""


class Particles(NamedTuple):
    """Particles: their places (n, 3), radii (n,), and colours from 0 to 255 (n, 3)."""

    places: Floats
    radii: Floats
    colors: Floats


def crystal() -> Particles:
    """Return rock salt: 11 by 11 by 11 ions."""
    grid = _grid(11, 11, 11)
    is_large = (grid.sum(axis=1) % 2 == 0)[:, None]
    colors = np.where(is_large, (90, 160, 90), (170, 110, 210))
    return Particles(grid * 2.82, np.where(is_large[:, 0], 1.67, 1.16), colors.astype(float))


def packing() -> Particles:
    """Return 50,000 spheres of two sizes, shaken on a lattice."""
    random = np.random.default_rng(1)
    grid = _grid(37, 37, 37)[:50_000]
    radii = random.choice([0.5, 0.42], len(grid))
    colors = np.where(radii[:, None] == 0.5, (200, 204, 208), (70, 120, 180))
    return Particles(grid + random.normal(0, 0.06, grid.shape), radii, colors.astype(float))


def protein() -> Particles:
    """Return a bundle of seven helices with side chains, of the measures of a protein's."""
    random = np.random.default_rng(5)
    parts, elements = [], []
    for helix in range(7):
        turn = 2 * np.pi * helix / 6
        across = 9.5 * np.array([np.cos(turn), np.sin(turn), 0]) * (helix < 6)
        step = np.arange(34)
        angle = np.radians(100) * step + turn
        sign = 1 if helix % 2 else -1
        for radius, rise, shift, element in [
            (2.3, 0.0, 0.0, CARBON),  # the backbone: alpha carbon, carbon, oxygen, nitrogen
            (1.7, 1.1, 0.5, CARBON),
            (2.0, 2.2, 0.6, OXYGEN),
            (1.6, -0.9, -0.5, NITROGEN),
            (3.4, 0.3, 0.2, CARBON),  # and the side chain
            (4.8, 0.6, 0.4, CARBON),
            (6.0, 0.2, 0.5, None),
        ]:
            ring = [radius * np.cos(angle + shift), radius * np.sin(angle + shift)]
            height = sign * (1.5 * step - 25 + rise)
            wobble = random.normal(0, 0.15 if element else 0.5, (34, 3))
            parts.append(np.stack([*ring, height], axis=1) + across + wobble)
            ends = np.array([CARBON, OXYGEN, NITROGEN, CARBON, SULFUR])
            elements.append(
                np.full((34, 3), element) if element else ends[random.integers(0, 5, 34)]
            )
    places, colors = np.concatenate(parts), np.concatenate(elements).astype(float)
    radius_of = {CARBON: 1.7, NITROGEN: 1.55, OXYGEN: 1.52, SULFUR: 1.8}
    radii = np.array([radius_of[tuple(map(int, color))] for color in colors])
    return Particles(places, radii, colors)


def melt() -> Particles:
    """Return a melt of 60 polymers of 300 beads each, every polymer in a colour."""
    random = np.random.default_rng(4)
    palette = np.array(
        [(228, 87, 46), (23, 190, 187), (255, 201, 20), (46, 40, 130), (118, 176, 65)], float
    )
    places, colors = [], []
    for chain in range(60):
        ways = random.normal(size=(300, 3))
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        for bead in range(1, 300):
            ways[bead] = 0.75 * ways[bead - 1] + 0.6 * ways[bead]
            ways[bead] /= np.linalg.norm(ways[bead])
        chain_places = np.cumsum(0.9 * ways, axis=0)
        # Folded into a box, as periodic boundaries do.
        places.append(np.abs((chain_places + random.uniform(0, 60, 3)) % 60 - 30))
        colors.append(np.tile(palette[chain % 5], (300, 1)))
    return Particles(np.concatenate(places), np.full(18_000, 0.55), np.concatenate(colors))


def landscape() -> Particles:
    """Return a landscape of 90,000 points, coloured by height."""
    from matplotlib import colormaps

    x, y = (side.ravel() for side in np.meshgrid(*[np.linspace(-4, 4, 300)] * 2))
    hills = 1.3 * np.exp(-((x - 1) ** 2 + y**2) / 2) + 0.8 * np.exp(-((x + 2) ** 2 + (y - 1) ** 2))
    z = hills + 0.12 * np.sin(3 * x) * np.cos(2.5 * y)
    share = (z - z.min()) / (z.max() - z.min())
    colors = 255 * colormaps["viridis"](share)[:, :3]
    return Particles(np.stack([x, y, z], axis=1), np.full(len(x), 0.022), colors)


DATA_SETS: dict[str, Callable[[], Particles]] = {
    "crystal": crystal,
    "packing": packing,
    "protein": protein,
    "melt": melt,
    "landscape": landscape,
}


def _grid(*counts: int) -> Floats:
    """Return the points of a lattice of cubes, (n, 3)."""
    grid = np.meshgrid(*map(np.arange, counts), indexing="ij")
    return np.stack(grid, axis=-1).reshape(-1, 3).astype(float)
