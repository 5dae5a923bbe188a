"""The rays of a path in a drawing: those that go on from surfaces, and the light they find."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from vtray.figures.path_ends import SHORT, path_ends
from vtray.figures.pen import INK, LIT, RAY
from vtray.figures.stage import Stage
from vtray.figures.traced_rays import PathRay, ShadowRay, Surface, WayToLight

MOST_NUMBERS = 12
"""Of more rays, none has its number."""

FAINTEST = 0.25
"""How opaque rays are of which almost nothing is seen."""


def draw_path(stage: Stage, show: Callable[[Surface], None]) -> None:
    """Draw the rays that go on from surfaces; `show` draws what they meet, if it is not yet."""
    path = stage.tree.path
    ends = [stage.section(end) for end in path_ends(path)]
    most = max((max(ray.seen) for ray in path), default=1.0)
    for number, ray in enumerate(path):
        if ray.parent is not None:
            start, end = stage.section(ray.origin), ends[number]
            strength = FAINTEST + (1.0 - FAINTEST) * math.sqrt(max(ray.seen) / most)
            stage.line(start, end, RAY, lw=1.4, arrow=0.6, alpha=strength)
            if len(path) <= MOST_NUMBERS:
                stage.note(f"{number}", (start + end) / 2, (4, 4), color=RAY)
            if ray.hit is not None:
                show(ray.hit.surface)
                stage.ax.plot(*end, "o", ms=4, color=INK, zorder=9)
                _draw_lights(stage, ray, end)


def _draw_lights(stage: Stage, ray: PathRay, place: NDArray[np.float64]) -> None:
    """Draw the ways from a hit to the lights of which any light arrives."""
    short = SHORT * stage.tree.path[0].distance
    for way in ray.lights:
        if way.arrives:
            length = min(_length_of(way), short)
            towards = stage.section.turn(way.direction)
            stage.line(place, place + length * towards, LIT, lw=0.9, arrow=1.0, alpha=0.8)


def _length_of(way: WayToLight) -> float:
    """Return how far a light is, at least."""
    if isinstance(way, ShadowRay):
        return way.distance
    return min((ray.length for ray in way.rays), default=math.inf)
