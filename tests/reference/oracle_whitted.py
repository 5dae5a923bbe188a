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


class View(NamedTuple):
    """The image plane: nothing on the near side of it exists."""

    center: Vec
    forward: Vec

    def has(self, point: Vec) -> bool:
        """Tell whether a point is in front of it."""
        return bool(np.dot(point - self.center, self.forward) > 0)


class Ball(NamedTuple):
    """A sphere; `index` is None for no glass."""

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
    if shape.kind == "matt":
        light = np.zeros(3)
        for place, intensity in lights:
            to_light = place - point
            length = np.linalg.norm(to_light)
            cosine = np.dot(normal, to_light) / length
            if cosine > 0 and nearest(view, shapes, point, to_light / length)[0] > length:
                light += shape.color * cosine * intensity
        return share * light
    total = np.zeros(3)
    if bounces == 0:
        return total
    tint, cosine = shape.color / 255, -np.dot(way, normal)
    across = way + 2 * cosine * normal
    ways = [(across, share * tint)]
    if shape.kind == "glass":
        eta = shape.index if is_inner else 1 / shape.index  # as in GLSL's refract
        k = 1 - eta**2 * (1 - cosine**2)
        reflected = 1.0
        if k > 0:
            one, two = (shape.index, 1.0) if is_inner else (1.0, shape.index)
            other = math.sqrt(k)
            s = ((one * cosine - two * other) / (one * cosine + two * other)) ** 2
            p = ((one * other - two * cosine) / (one * other + two * cosine)) ** 2
            reflected = (s + p) / 2
            through = eta * way + (eta * cosine - other) * normal
            ways = [(across, share * reflected), (through, share * (1 - reflected) * tint)]
        else:
            ways = [(across, share)]
    for direction, left in ways:
        if left.max() >= LEAST:
            total = total + seen(
                view,
                shapes,
                lights,
                point,
                direction / np.linalg.norm(direction),
                left,
                bounces - 1,
            )
    return total
