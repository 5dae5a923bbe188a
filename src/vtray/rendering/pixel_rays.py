"""Tracing the rays of one pixel, to be looked at."""

import operator
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np

from vtray.base.compiler.compiled import uncompiled
from vtray.base.errors import RenderError
from vtray.base.exact_math import hypotenuse
from vtray.figures.drawn.objects import where_met
from vtray.figures.ray_tree import Exposed, Hit, RayTree, ShadowRay, Surface, View
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, add, scale
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import Numbering, find, number_objects
from vtray.rendering.pack import Packed, pack
from vtray.rendering.shape_kinds import KINDS
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.copies import Copies
from vtray.scene.default_light import lights_of
from vtray.scene.light_types import Light
from vtray.scene.objects import Plane
from vtray.scene.placing.directions import unit
from vtray.scene.scene import Scene
from vtray.scene.vectors import Color, Vector
from vtray.transport.integrators.reference import trace_pixel as trace_one

if TYPE_CHECKING:
    from vtray.image.image import Image


def trace_pixel(scene: "Scene | Image", x: SupportsIndex, y: SupportsIndex) -> RayTree:
    """Trace the rays of one pixel and return them all.

    Parameters
    ----------
    scene
        The scene; or a rendered image, whose exposure is then explained as well.
    x, y
        Column from the left and row from the top, from 0.

    Returns
    -------
    RayTree
        The ray through the middle of the pixel, what it hits, and the rays to the point lights.

    Raises
    ------
    RenderError
        There is no such pixel.
    SceneError
        The scene is not valid.

    Examples
    --------
    >>> tree = vtray.trace_pixel(scene, 210, 230)
    >>> print(tree)
    >>> tree.draw().figure.savefig("rays.png")
    """
    if isinstance(scene, Scene):
        scene.check()
        return trace_rays(scene, None, x, y)
    return trace_rays(scene.scene, scene, x, y)


def trace_rays(
    scene: Scene,
    image: "Image | None",
    x: SupportsIndex,
    y: SupportsIndex,
    caller: str = "trace_pixel",
) -> RayTree:
    """Trace the rays of one pixel of a checked scene; see `trace_pixel`."""
    camera = scene.camera if image is None else image.scene.camera
    width, height = (int(pixels) for pixels in camera.size)
    column, row = operator.index(x), operator.index(y)
    if not (0 <= column < width and 0 <= row < height):
        message = f"{caller}: expected 0,0 to {width - 1},{height - 1}, got {column},{row}"
        raise RenderError(message)
    kept = accelerate(scene)  # which the given scene may have already
    scene = Scene(camera, lights_of(scene), list(scene.objects))
    # Other lights than points are not a ray each.
    points = {k: light for k, light in enumerate(scene.lights) if isinstance(light, Light)}
    shown = Scene(camera, list(points.values()), scene.objects)
    packed, numbering = pack(shown, kept), number_objects(scene.objects)
    cosines = np.zeros(len(points))
    blockers = np.full(len(points), NOTHING)
    traced = trace_one(packed.arrays, column, row, new_stack(), cosines, blockers)
    start, direction = _world(scene, packed, traced.ray.origin), traced.ray.direction
    eye = uncompiled(add)(start, uncompiled(scale)(-packed.before, direction))
    hit = None
    lights: list[ShadowRay] = []
    if traced.primitive != NOTHING:
        hit = Hit(
            _surface(scene, numbering, traced.primitive, is_second=traced.interaction.is_second),
            traced.distance * packed.unit + packed.before,
            _world(scene, packed, traced.interaction.point),
            traced.interaction.normal,
        )
        lights = [
            _shadow_ray(scene, numbering, hit, (k, light), float(cosine), int(blocker))
            for (k, light), cosine, blocker in zip(points.items(), cosines, blockers, strict=True)
        ]
    return RayTree(
        (column, row),
        eye,
        direction,
        hit,
        tuple(lights),
        traced.value,
        _view(scene, packed),
        None if image is None else _exposed(image, column, row),
        scene,
    )


def _shadow_ray(
    scene: Scene,
    numbering: Numbering,
    hit: Hit,
    numbered: tuple[int, Light],
    cosine: float,
    primitive: int,
) -> ShadowRay:
    """Return the ray from a hit to a point light; `primitive` is the number of what blocks it."""
    (number, light), point = numbered, hit.point
    place = (light.location.x, light.location.y, light.location.z)
    way = (place[0] - point[0], place[1] - point[1], place[2] - point[2])
    distance = hypotenuse(*way)
    if distance:
        way = (way[0] / distance, way[1] / distance, way[2] / distance)
    blocker = None if primitive == NOTHING else _blocker(scene, numbering, primitive, point, way)
    # In the order of the kernels, so that the sum has the same bits.
    strength = cosine * hit.surface.lambert * light.intensity if blocker is None else 0.0
    red, green, blue = hit.surface.color
    tint = _rgb(light.color)
    adds = (
        strength * red * (tint[0] / 255),
        strength * green * (tint[1] / 255),
        strength * blue * (tint[2] / 255),
    )
    return ShadowRay(number, place, light.intensity, way, distance, cosine, blocker, adds, tint)


def _blocker(scene: Scene, numbering: Numbering, primitive: int, start: Vec, way: Vec) -> Surface:
    """Return what blocks a ray, its colour as where the ray meets it."""
    surface = _surface(scene, numbering, primitive)
    if surface.end is None:
        return surface
    place = where_met(scene, surface, start, way)
    to_end, to_start = (
        (place[0] - end[0], place[1] - end[1], place[2] - end[2])
        for end in (surface.end, surface.center)
    )
    is_second = hypotenuse(*to_end) < hypotenuse(*to_start)
    return _surface(scene, numbering, primitive, is_second=is_second)


def _surface(
    scene: Scene, numbering: Numbering, primitive: int, *, is_second: bool = False
) -> Surface:
    """Return the primitive of a number, its colour as on its first or its second half."""
    found = find(scene.objects, numbering, primitive)
    item: Any = scene.objects[found.place]
    copy = part = None
    shift, member = (0.0, 0.0, 0.0), found.member
    if isinstance(item, Copies):
        copy, shift = found.copy, _row(item, "at", found.copy)
        part, member = item.locate(member)
        item = item.objects[part]
    if isinstance(item, Plane):
        center, normal = _vec(item.center), unit(item.normal)
        return Surface(found.place, None, center, None, normal, _rgb(item.color), item.lambert)
    (kind,) = (kind for kind in KINDS if isinstance(item, (kind.single, kind.arrays)))
    single = isinstance(item, kind.single)
    if single:
        points = [_vec(getattr(item, name)) for name in kind.points]
        color, radius, lambert, number = _rgb(item.color), item.radius, item.lambert, None
    else:
        points = [_row(item, name, member) for name in kind.points]
        halves = is_second and getattr(item, "color_end", None) is not None
        color = _row(item, "color_end" if halves else "color", member)
        radius, lambert = _number(item, "radius", member), _number(item, "lambert", member)
        number = member
    if copy is not None:
        points = [uncompiled(add)(point, shift) for point in points]
    end = points[1] if len(points) > 1 else None
    return Surface(found.place, number, points[0], radius, None, color, lambert, end, copy, part)


def _vec(point: Vector) -> Vec:
    """Return a point as a tuple."""
    return point.x, point.y, point.z


def _rgb(color: Color) -> Vec:
    """Return a colour as a tuple."""
    return float(color.r), float(color.g), float(color.b)


def _row(item: ArrayHolder, name: str, index: int) -> Vec:
    """Return a row of an array, in which one may stand for all."""
    column = getattr(item, name)
    x, y, z = map(float, column if column.ndim == 1 else column[index])
    return x, y, z


def _number(item: Arrays, name: str, index: int) -> float:
    """Return a number of an array, or the one that stands for all."""
    return float(np.broadcast_to(getattr(item, name), len(item))[index])


def _view(scene: Scene, packed: Packed) -> View:
    """Return the camera in world space."""
    camera, frame = scene.camera, packed.arrays.camera
    center = (camera.center.x, camera.center.y, camera.center.z)
    size, pixel = (frame.width, frame.height), camera.resolution
    return View(center, frame.right, frame.down, frame.forward, camera.focus, size, pixel)


def _exposed(image: "Image", column: int, row: int) -> Exposed:
    """Return what a picture made of the light of a pixel."""
    red, green, blue = map(float, image.linear[row, column])
    white = float(image.white)
    return Exposed(
        light=(red, green, blue),
        white=white,
        brightest=white == float(image.linear.max()),
        background=0.0 if image.settings.background == "black" else 1 - image.alpha[row, column],
        value=tuple(int(channel) for channel in image.pixels[row, column]),
    )


def _world(scene: Scene, packed: Packed, point: Vec) -> Vec:
    """Return a point of the arrays in world space."""
    center, unit = scene.camera.center, packed.unit
    return (
        center.x + point[0] * unit,
        center.y + point[1] * unit,
        center.z + point[2] * unit,
    )
