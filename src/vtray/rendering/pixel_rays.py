"""Tracing the rays of one pixel, to be looked at."""

import operator
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np

from vtray.base.compiler.compiled import uncompiled
from vtray.base.errors import RenderError
from vtray.base.pool import available_cores
from vtray.figures.ray_tree import Exposed, Hit, RayTree, View
from vtray.figures.traced_rays import WayToLight
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, add, scale
from vtray.image.exposure import known_white
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import number_objects
from vtray.rendering.pack import Packed, pack
from vtray.rendering.passes import Tracer
from vtray.rendering.pixel_crowd import trace_shared
from vtray.rendering.pixel_lights import Lit, shadow_rays, trace_fans
from vtray.rendering.pixel_surfaces import find_surface
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.light_types import Light
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.transport.integrators.reference import trace_pixel as trace_one
from vtray.transport.lights.light import light_count
from vtray.transport.sampling.fans import Noise

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
        The ray through the middle of the pixel, what it hits, and the rays to all lights.

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
    settings = settings_of(scene) if image is None else image.settings
    kept = accelerate(scene)  # which the given scene may have already
    scene = Scene(camera, lights_of(scene), list(scene.objects))
    packed, numbering = pack(scene, kept), number_objects(scene.objects)
    points = uncompiled(light_count)(packed.arrays.lights)
    cosines, blockers = np.zeros(points), np.full(points, NOTHING)
    traced = trace_one(packed.arrays, column, row, new_stack(), cosines, blockers)
    start, direction = _world(scene, packed, traced.ray.origin), traced.ray.direction
    eye = uncompiled(add)(start, uncompiled(scale)(-packed.before, direction))
    hit, light = None, traced.value
    ways: list[WayToLight] = []
    if traced.primitive != NOTHING:
        hit = Hit(
            find_surface(
                scene, numbering, traced.primitive, is_second=traced.interaction.is_second
            ),
            traced.distance * packed.unit + packed.before,
            _world(scene, packed, traced.interaction.point),
            traced.interaction.normal,
        )
        lit = Lit(scene, numbering, hit)
        noise = _noise(packed, settings) if image is None else image.noise
        known = lit, packed, traced, (column, row)
        if noise is not None and noise.are_shared:
            fans, light = trace_shared(*known, noise, int(settings.seed))
        else:
            fans, light = trace_fans(*known, noise, int(settings.seed))
        ways = [*shadow_rays(lit, cosines, blockers), *fans]
    return RayTree(
        (column, row),
        eye,
        direction,
        hit,
        tuple(sorted(ways, key=lambda way: way.light)),
        light,
        _view(scene, packed),
        None if image is None else _exposed(image, column, row),
        None if traced.lamp == NOTHING else _place_of(scene, packed, traced.lamp),
        scene,
    )


def _noise(packed: Packed, settings: RenderSettings) -> Noise | None:
    """Return how noisy soft light may be in a picture with some settings."""
    tracer = Tracer(packed.arrays, available_cores())
    return tracer.noise(settings, known_white(settings.exposure), keep=False)


def _place_of(scene: Scene, packed: Packed, row: int) -> int:
    """Return the place in `scene.lights` of a lamp, given the row of its strength in the arrays."""
    places = [k for k, light in enumerate(scene.lights) if not isinstance(light, Light)]
    assert packed.arrays.lights.soft is not None  # noqa: S101 - a lamp is seen
    return places[int(np.searchsorted(packed.arrays.lights.soft.row, row))]


def _view(scene: Scene, packed: Packed) -> View:
    """Return the camera in world space."""
    camera, frame = scene.camera, packed.arrays.camera
    center = (camera.center.x, camera.center.y, camera.center.z)
    size, pixel = (frame.width, frame.height), camera.resolution
    return View(center, frame.right, frame.down, frame.forward, camera.focus, size, pixel)


def _exposed(image: "Image", column: int, row: int) -> Exposed:
    """Return what a picture made of the light of a pixel."""
    red, green, blue = map(float, image.linear[row, column])
    sky = None
    if image.settings.background == "sky":
        x, y, z = map(float, image.with_sky[row, column] - image.linear[row, column])
        sky = x, y, z
    shine, stars = image.starlight, None
    if shine is not None:
        x, y, z = map(float, shine[row, column])
        stars = x, y, z
    white = float(image.white)
    return Exposed(
        light=(red, green, blue),
        stars=stars,
        white=white,
        brightest=white == float(image.linear.max()),
        background=0.0 if image.settings.background == "black" else 1 - image.alpha[row, column],
        sky=sky,
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
