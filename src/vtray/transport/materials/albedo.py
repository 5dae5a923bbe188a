"""What rough surfaces and coats mirror of the light that comes at an angle: tables."""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.vector import Vec
from vtray.transport.materials.facets import both_seen, seen_facet
from vtray.transport.materials.look import GLASS, METAL, Albedos
from vtray.transport.materials.optics import mirrored, mirrored_part, split_at

Floats = NDArray[np.float64]

NODES = 32
"""Steps of a table, which are even in the root of the cosine: close where albedos change fast."""

POINTS, STEP = 1597, 987
"""An albedo is the mean over so many points of the square. They lie on Fibonacci's lattice, in
which none has a coordinate of another; so the few facets that turn far away have their share."""

UP = (0.0, 0.0, 1.0)


@device
def albedo_at(albedos: Albedos, table: int, cosine: float) -> float:
    """Return the share of light that is mirrored.

    Parameters
    ----------
    albedos
        The tables, (tables, ``NODES + 1``).
    table
        Which of them.
    cosine
        That of the angle between the light and the normal, from 0 to 1; rounding may take it
        beyond.
    """
    place = NODES * math.sqrt(min(max(cosine, 0.0), 1.0))
    node = min(int(place), NODES - 1)
    below = albedos[table, node]
    share: float = below + (place - node) * (albedos[table, node + 1] - below)
    return share


def mean_albedo(table: Floats) -> float:
    """Return the mean of a table, (``NODES + 1``,), over light that comes evenly from all sides.

    That is twice the integral of albedo times cosine over the cosine; with its root s, four times
    that of albedo times s**3 over s, exact for what is read between nodes.
    """
    parts = []
    for k in range(NODES):
        low, high = k / NODES, (k + 1) / NODES
        slope = (table[k + 1] - table[k]) * NODES
        level = table[k] - slope * low
        below, above = low * low * low * low, high * high * high * high
        parts.append(level * (above - below) + 0.8 * slope * (high * above - low * below))
    return math.fsum(map(float, parts))


@kernel
def measure_albedo(kind: int, ratio: float, spread: float, table: Floats) -> None:
    """Set a table of what a surface with facets mirrors, and lets through.

    Parameters
    ----------
    kind
        ``METAL`` for facets that mirror all light, ``GLASS`` for those that let the rest through,
        which counts, too; else it does not.
    ratio
        The index of refraction on the other side, divided by that on this one.
    spread
        How far facets turn away, 0 for a smooth surface.
    table
        Out: (``NODES + 1``,).
    """
    for node in range(NODES + 1):
        root = max(node, 0.25) / NODES
        cosine = root * root
        towards = math.sqrt(1.0 - cosine * cosine), 0.0, cosine
        table[node] = _albedo(kind, ratio, spread, towards)


@device
def _albedo(kind: int, ratio: float, spread: float, towards: Vec) -> float:
    """Return the share for one direction."""
    if spread == 0.0:
        return 1.0 if kind in (METAL, GLASS) else mirrored_part(towards[2], ratio)
    total, direction = 0.0, (-towards[0], -towards[1], -towards[2])
    for k in range(POINTS):
        u, v = (k + 0.5) / POINTS, (k * STEP % POINTS + 0.5) / POINTS
        facet = seen_facet(spread, towards, UP, u, v)
        split = split_at(direction, facet, ratio)
        share = 1.0 if kind == METAL else split.reflected
        total += share * _open(spread, towards, mirrored(direction, facet)[2])
        if kind == GLASS and share < 1.0:
            total += (1.0 - share) * _open(spread, towards, -split.refracted[2])
    return total / POINTS


@device
def _open(spread: float, towards: Vec, cosine: float) -> float:
    """Return the share of light that no facet stops, 0 for light that goes to the wrong side."""
    return both_seen(spread, towards[2], cosine) if cosine > 0.0 else 0.0
