"""What light passes of faded bodies, worked out point by point: plain, slow, by other rules.

Instead of joining the parts of a ray within shapes, each point where it crosses a surface is asked
whether it is inside another shape of the same body. Only spheres and planes, points of light, and
perspective or orthographic views; rounding is met by a distance that is far above it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from oracle import _Render

import vtray

NEAR = 1e-7
"""What is nearer than that, in scene units, is at the same place."""

Array = np.ndarray


class Ball(NamedTuple):
    """A sphere of a scene; a plane has a normal in place of a radius."""

    center: Array
    size: Any
    color: Array
    lambert: float
    opacity: float
    body: tuple[int, float]


def render(scene: vtray.Scene) -> tuple[Array, Array]:
    """Return the linear light of a scene, (height, width, 3), and the coverage of its pixels."""
    return _traced(scene, _shade)


def albedo(scene: vtray.Scene) -> Array:
    """Return the share of light that all that is seen sends on, (height, width, 3)."""
    return _traced(scene, lambda _shapes, _lights, _at, _ray, ball, _view: _share(ball))[0]


def _share(ball: Ball) -> Array:
    """Return the share of light that a surface sends on."""
    return ball.lambert * ball.color / 255


def _traced(scene: vtray.Scene, shade: Callable[..., Array]) -> tuple[Array, Array]:
    """Return what all layers have by some function, (height, width, 3), and their coverage."""
    view = _Render({**scene.to_dict(), "objects": [], "lights": []}, np.float64)
    rows, columns = np.mgrid[0 : view.height, 0 : view.width]
    starts, rays = view.rays(columns.astype(float), rows.astype(float))
    shapes = [ball for k, item in enumerate(scene.objects) for ball in _balls(item, k, view.center)]
    lights = [
        (np.array([light.location.x, light.location.y, light.location.z]) - view.center, light)
        for light in scene.lights
    ]
    linear, cover = np.zeros((*rows.shape, 3)), np.zeros(rows.shape)
    for place in np.ndindex(rows.shape):
        linear[place], cover[place] = _look(shapes, lights, starts[place], rays[place], view, shade)
    return linear, cover


def _balls(item: Any, place: int, origin: Array) -> list[Ball]:
    if isinstance(item, vtray.Plane):
        point, normal = (
            np.array([getattr(of, axis) for axis in "xyz"]) for of in (item.center, item.normal)
        )
        color = np.array([item.color.r, item.color.g, item.color.b], float)
        size = normal / np.linalg.norm(normal)
        return [Ball(point - origin, size, color, item.lambert, item.opacity, (place, -1.0))]
    if isinstance(item, vtray.Sphere):
        color = np.array([item.color.r, item.color.g, item.color.b], float)
        center = np.array([item.center.x, item.center.y, item.center.z]) - origin
        key = place, item.opacity
        return [Ball(center, item.radius, color, item.lambert, item.opacity, key)]
    count = len(item)
    opacity = np.broadcast_to(1.0 if item.opacity is None else item.opacity, count)
    return [
        Ball(
            item.center[k] - origin,
            np.broadcast_to(item.radius, count)[k],
            np.broadcast_to(item.color, (count, 3))[k].astype(float),
            np.broadcast_to(item.lambert, count)[k],
            opacity[k],
            (place, opacity[k]),
        )
        for k in range(count)
    ]


def _look(
    shapes: list[Ball],
    lights: list[Any],
    start: Array,
    ray: Array,
    view: Any,
    shade: Callable[..., Array],
) -> tuple[Array, float]:
    """Return the light along a ray, and how much of what is behind everything it does not see."""
    # What is behind the image plane is not there.
    first = view.focus / (ray @ view.forward)
    passed, light = 1.0, np.zeros(3)
    for at, ball in sorted(_seen(shapes, start, ray, first, np.inf), key=lambda found: found[0]):
        point = start + at * ray
        light += passed * ball.opacity * shade(shapes, lights, point, ray, ball, view)
        passed *= 1.0 - ball.opacity
    return light, 1.0 - passed


def _crossings(ball: Ball, start: Array, ray: Array) -> list[float]:
    """Return where a line crosses a surface: nowhere, once or twice."""
    if isinstance(ball.size, np.ndarray):
        slope = ray @ ball.size
        return [((ball.center - start) @ ball.size) / slope] if slope else []
    half_b, c = ray @ (start - ball.center), np.sum((start - ball.center) ** 2) - ball.size**2
    root = half_b**2 - c
    return [] if root <= 0 else [-half_b - np.sqrt(root), -half_b + np.sqrt(root)]


def _is_in(ball: Ball, point: Array) -> bool:
    if isinstance(ball.size, np.ndarray):
        return False
    return bool(np.linalg.norm(point - ball.center) < ball.size)


def _seen(
    shapes: list[Ball], start: Array, ray: Array, first: float, last: float
) -> list[tuple[float, Ball]]:
    """Return where a ray meets bodies between two distances: once for each time that it is in one.

    That is where it comes in, or where it goes out if it starts inside; surfaces that no light
    passes have no inside, and are met wherever they are crossed.
    """
    found = []
    begin = start + (first + NEAR) * ray
    for body in {ball.body for ball in shapes if ball.opacity > 0}:
        members = [ball for ball in shapes if ball.body == body]
        is_opaque = members[0].opacity == 1.0
        cross = [
            (at, ball)
            for ball in members
            for at in _crossings(ball, start, ray)
            if first + NEAR < at < last - NEAR
        ]
        if not is_opaque:
            cross = [
                (at, ball)
                for at, ball in cross
                if not any(_is_in(o, start + at * ray) for o in members if o is not ball)
            ]
        cross.sort(key=lambda pair: pair[0])
        inside = any(_is_in(ball, begin) for ball in members)
        if is_opaque or isinstance(members[0].size, np.ndarray):
            found += cross
        else:
            # Ways in and ways out take turns; of those out only the first counts, from inside.
            found += cross[:1] + cross[1::2] if inside else cross[::2]
    return found


def _shade(
    shapes: list[Ball], lights: list[Any], point: Array, ray: Array, ball: Ball, view: Any
) -> Array:
    """Return the light that a point scatters along a ray."""
    is_plane = isinstance(ball.size, np.ndarray)
    normal = ball.size if is_plane else (point - ball.center) / ball.size
    normal = -normal if normal @ ray > 0 else normal
    light = np.zeros(3)
    for place, lamp in lights:
        way = place - point
        length = np.linalg.norm(way)
        cosine = normal @ way / length
        if cosine <= 0:
            continue
        passed = 1.0
        end = length
        if place @ view.forward < 0:
            depth = point @ view.forward
            end = length * depth / (depth - place @ view.forward)
        for _, other in _seen(shapes, point, way / length, 0.0, end):
            passed *= 1.0 - other.opacity
        light += ball.color * ball.lambert * cosine * lamp.intensity * passed
    return light
