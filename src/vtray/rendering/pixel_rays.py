"""Tracing the rays of one pixel, to be looked at."""

import operator
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np

from vtray.base.compiler.compiled import uncompiled
from vtray.base.errors import RenderError
from vtray.base.pool import available_cores
from vtray.figures.ray_tree import Exposed, RayTree, Veil, View
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, add, scale
from vtray.image.white import known_white
from vtray.rendering.fog import ball_around, fitted
from vtray.rendering.followed import check_image_plane, check_told
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import number_objects
from vtray.rendering.pack import Packed, pack
from vtray.rendering.passes import Tracer
from vtray.rendering.pixel_layers import Pixel, look_through
from vtray.rendering.styled import styled
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.light_types import Light
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.transport.fog import fog_share
from vtray.transport.integrators.reference import TracedPixel
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
        There is no such pixel; or the integrator follows rays over surfaces.
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
    check_image_plane(camera, caller)
    settings = settings_of(scene) if image is None else image.settings
    check_told(scene.objects, settings, caller)
    style = (
        fitted(scene.style, camera, lambda: ball_around(scene)) if image is None else image.style
    )
    kept = accelerate(scene, style=style)  # which the given scene may have already
    render = scene.render.replace(tonemap=settings.tonemap, integrator="direct")
    scene = Scene(camera, lights_of(scene), list(scene.objects), render, style)
    packed, numbering = styled(pack(scene, kept), style), number_objects(scene.objects)
    noise = _noise(packed, settings) if image is None else image.noise
    pixel = Pixel(scene, numbering, packed, (column, row), noise, int(settings.seed))
    layers, behind, light = look_through(pixel)
    traced = behind.traced
    start, direction = _world(scene, packed, traced.ray.origin), traced.ray.direction
    eye = uncompiled(add)(start, uncompiled(scale)(-packed.before, direction))
    return RayTree(
        (column, row),
        eye,
        direction,
        behind.hit,
        behind.lights,
        light,
        _view(scene, packed),
        None if image is None else _exposed(image, column, row),
        None if traced.lamp == NOTHING else _place_of(scene, packed, traced.lamp),
        scene,
        layers,
        behind.share,
        _veil(packed, traced, light),
    )


def _veil(packed: Packed, traced: TracedPixel, light: Vec) -> Veil | None:
    """Return what fog does to the light along the ray of a pixel."""
    fog = packed.arrays.fog
    # Where there are layers, fog takes its share of each.
    has_layers = packed.arrays.world.faded is not None
    if fog is None or has_layers or (traced.primitive == NOTHING and traced.lamp == NOTHING):
        return None
    share = uncompiled(fog_share)(fog, traced.distance)
    distance = traced.distance * packed.unit + packed.before
    return Veil(distance, share, uncompiled(scale)(1.0 - share, light))


def _noise(packed: Packed, settings: RenderSettings) -> Noise | None:
    """Return how noisy soft light may be in a picture with some settings."""
    tracer = Tracer(packed.arrays, available_cores())
    return tracer.noise(settings, known_white(settings), keep=False)


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
        x, y, z = map(float, image.with_sky[row, column] - image.drawn[row, column])
        sky = x, y, z
    shine, stars = image.starlight, None
    if shine is not None:
        x, y, z = map(float, shine[row, column])
        stars = x, y, z
    overlays = []
    for share, color in image.overlays:
        part = float(share[row, column])
        if part > 0.0:
            overlays.append((part * color.r, part * color.g, part * color.b))
    own = image.linear[row, column], image.drawn[row, column]
    x, y, z = map(float, own[1])
    drawn = None if (own[0] == own[1]).all() else (x, y, z)
    white = float(image.white)
    return Exposed(
        light=(red, green, blue),
        stars=stars,
        white=white,
        brightest=white == float(image.linear.max()),
        background=0.0 if image.settings.background == "black" else 1 - image.alpha[row, column],
        sky=sky,
        value=tuple(int(channel) for channel in image.pixels[row, column]),
        overlays=tuple(overlays),
        drawn=drawn,
        tonemap=image.settings.tonemap,
    )


def _world(scene: Scene, packed: Packed, point: Vec) -> Vec:
    """Return a point of the arrays in world space."""
    center, unit = scene.camera.center, packed.unit
    return (
        center.x + point[0] * unit,
        center.y + point[1] * unit,
        center.z + point[2] * unit,
    )
