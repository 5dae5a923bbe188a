"""An independent picture of mirrors and glass: rays by recursion, in the plainest Python.

Spheres and planes, hard point lights, no hierarchy; shapes are given as plain tuples.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Vec = NDArray[np.float64]

NEAR = 1e-9
"""What is nearer to the start of a ray is what it starts on."""

LEAST = 2.0**-10

BLENDS = {
    "glass on matt": [("glass", 0.25), ("matt", 0.75)],
    "plastic on a mirror": [("plastic", 0.5), ("mirror", 0.5)],
}
"""What is made of two kinds, and their shares."""


class View(NamedTuple):
    """The image plane: nothing on the near side of it exists."""

    center: Vec
    forward: Vec

    def has(self, point: Vec) -> bool:
        """Tell whether a point is in front of it."""
        return bool(np.dot(point - self.center, self.forward) > 0)


class Ball(NamedTuple):
    """A sphere, and what it is made of."""

    center: Vec
    radius: float
    color: Vec
    kind: str = "matt"
    index: float = 1.5

    def crossings(self, start: Vec, way: Vec) -> list[float]:
        """Return the distances at which a line crosses it."""
        b = np.dot(way, start - self.center)
        c = np.dot(start - self.center, start - self.center) - self.radius**2
        if b * b - c <= 0:
            return []
        root = math.sqrt(b * b - c)
        return [-b - root, -b + root]

    def outward(self, point: Vec) -> Vec:
        """Return its normal."""
        return (point - self.center) / self.radius


class Floor(NamedTuple):
    """A plane."""

    center: Vec
    normal: Vec
    color: Vec
    kind: str = "matt"
    index: float = 1.5

    def crossings(self, start: Vec, way: Vec) -> list[float]:
        """Return the distance at which a line crosses it."""
        steep = np.dot(way, self.normal)
        return [] if steep == 0 else [np.dot(self.center - start, self.normal) / steep]

    def outward(self, point: Vec) -> Vec:
        """Return its normal."""
        return self.normal


Shape = Ball | Floor


def nearest(view: View, shapes: list[Shape], start: Vec, way: Vec) -> tuple[float, Shape | None]:
    """Return what a ray meets first, and how far away."""
    found = [(t, k) for k, shape in enumerate(shapes) for t in shape.crossings(start, way)]
    ahead = [pair for pair in found if pair[0] > NEAR and view.has(start + pair[0] * way)]
    distance, k = min(ahead, default=(math.inf, -1))
    return distance, (shapes[k] if k >= 0 else None)


def seen(
    view: View,
    shapes: list[Shape],
    lights: list[tuple[Vec, float]],
    start: Vec,
    way: Vec,
    share: Vec,
    bounces: int,
) -> Vec:
    """Return the light along a ray of which a share is seen, in parts of 255."""
    distance, shape = nearest(view, shapes, start, way)
    if shape is None:
        return np.zeros(3)
    point, outward = start + distance * way, shape.outward(start + distance * way)
    is_inner = np.dot(outward, way) > 0
    normal = -outward if is_inner else outward
    light = matt_light(view, shapes, lights, point, normal, shape.color)
    tint, cosine = shape.color / 255, -np.dot(way, normal)
    across, ways = way + 2 * cosine * normal, []
    total = np.zeros(3)
    for kind, weight in BLENDS.get(shape.kind, [(shape.kind, 1.0)]):
        own = weight * share
        if kind == "matt":
            total += own * light
        elif kind in ("glass", "sheet", "plastic"):
            eta = shape.index if is_inner and kind == "glass" else 1 / shape.index
            reflected, through = passed(way, normal, cosine, eta)
            if kind == "sheet":
                reflected, through = sheet(reflected), way
            ways.append((across, own * reflected))
            if kind == "plastic":
                total += (1 - reflected) * own * light
            elif reflected < 1:
                ways.append((through, own * (1 - reflected) * tint))
        else:
            ways.append((across, own * tint))
    for direction, left in ways:
        if bounces > 0 and left.max() >= LEAST:
            unit = direction / np.linalg.norm(direction)
            total = total + seen(view, shapes, lights, point, unit, left, bounces - 1)
    return total


def matt_light(
    view: View,
    shapes: list[Shape],
    lights: list[tuple[Vec, float]],
    point: Vec,
    normal: Vec,
    color: Vec,
) -> Vec:
    """Return the light that a matt surface scatters."""
    light = np.zeros(3)
    for place, intensity in lights:
        to_light = place - point
        length = np.linalg.norm(to_light)
        cosine = np.dot(normal, to_light) / length
        if cosine > 0 and nearest(view, shapes, point, to_light / length)[0] > length:
            light += color * cosine * intensity
    return light


def sheet(reflected: float) -> float:
    """Return what a thin sheet mirrors, light going to and fro within, given that of one side.

    That is R + (1 - R)**2 R + (1 - R)**2 R**3 + ...
    """
    return reflected + (1 - reflected) ** 2 * sum(reflected**k for k in range(1, 400, 2))


def passed(way: Vec, normal: Vec, cosine: float, eta: float) -> tuple[float, Vec]:
    """Return what share is mirrored, and where the rest goes; `eta` is as in GLSL's refract."""
    k = 1 - eta**2 * (1 - cosine**2)
    if k <= 0:
        return 1.0, way
    other = math.sqrt(k)
    s = ((eta * cosine - other) / (eta * cosine + other)) ** 2
    p = ((eta * other - cosine) / (eta * other + cosine)) ** 2
    return (s + p) / 2, eta * way + (eta * cosine - other) * normal
