"""Tracing the rays of one pixel, to be looked at."""

import math
from dataclasses import replace
from typing import SupportsIndex

import numpy as np

from vtray.base.compiler.compiled import uncompiled
from vtray.base.errors import RenderError
from vtray.base.pool import available_cores
from vtray.figures.ray_tree import Exposed, RayTree, Veil, View
from vtray.geometry.vector import Vec, add, scale
from vtray.image.image import Image
from vtray.image.picking import whole
from vtray.image.white import known_white
from vtray.rendering.fog import fitted, shapes_of
from vtray.rendering.followed import check_followed, followed
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import number_objects
from vtray.rendering.pack import Packed, pack
from vtray.rendering.passes import SurfaceRays, Tracer, rays_from_surfaces
from vtray.rendering.pixel import Pixel, in_world
from vtray.rendering.pixel_layers import is_met, look_through
from vtray.rendering.pixel_lights import place_of_lamp
from vtray.rendering.pixel_paths import follow_path
from vtray.rendering.styled import styled
from vtray.scene.camera import Camera
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.default_camera import with_camera
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.placing.directions import are_parallel, camera_axes, view_axes
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.transport.fog import fog_share
from vtray.transport.sampling.fans import Noise
from vtray.transport.sampling.pixel_samples import filter_samples, lens_points, middle_rays
from vtray.transport.scene_arrays import SceneArrays, with_pinhole


@explain_unknown
def trace_pixel(
    scene: Scene | Image,
    x: SupportsIndex,
    y: SupportsIndex,
    sample: SupportsIndex | None = None,
) -> RayTree:
    """Trace the rays of one pixel and return them all.

    Parameters
    ----------
    scene
        The scene; or a rendered image, whose exposure is then explained as well.
    x, y
        Column from the left and row from the top, from 0.
    sample
        Where rays go on from surfaces, as by the integrators whitted and path: which sample of the
        pixel to follow, from 0. None, the default, for the ray through the middle of the pixel, and
        of a lens.

    Returns
    -------
    RayTree
        The ray, what it hits, the rays to all lights, and those that go on from there.

    Raises
    ------
    RenderError
        There is no such pixel or sample; or what the integrator does not show.
    SceneError
        The scene is not valid.

    Examples
    --------
    >>> tree = vtray.trace_pixel(scene, 210, 230)
    >>> print(tree)
    >>> tree.draw().figure.savefig("rays.png")
    """
    if isinstance(scene, Image):
        return trace_rays(scene.scene, scene, x, y, sample)
    return trace_rays(with_camera(scene, None), None, x, y, sample)


def trace_rays(
    scene: Scene,
    image: Image | None,
    x: SupportsIndex,
    y: SupportsIndex,
    sample: SupportsIndex | None = None,
    caller: str = "trace_pixel",
) -> RayTree:
    """Trace the rays of one pixel of a checked scene; see `trace_pixel`."""
    camera = scene.camera if image is None else image.scene.camera
    width, height = (int(pixels) for pixels in camera.size)
    column, row = whole(x, caller), whole(y, caller)
    if not (0 <= column < width and 0 <= row < height):
        message = f"{caller}: expected 0,0 to {width - 1},{height - 1}, got {column},{row}"
        raise RenderError(message)
    settings = settings_of(scene) if image is None else image.settings
    style = fitted(scene.style, camera, lambda: shapes_of(scene)) if image is None else image.style
    kept = accelerate(scene, style=style)  # which the given scene may have already
    check_followed(kept, scene.objects, settings, keep_lights=False)
    render = followed(scene.render, settings)
    scene = Scene(camera, lights_of(scene), list(scene.objects), render, style)
    packed, numbering = styled(pack(scene, kept), style), number_objects(scene.objects)
    number = _check_sample(sample, packed.arrays, settings, caller)
    noise = _noise(packed, settings) if image is None else image.noise
    first, later = rays_from_surfaces(settings, noise)
    from_surfaces = first if number is None else later
    are_shared = noise is not None and noise.are_shared
    pixel = Pixel(
        scene,
        numbering,
        packed,
        (column, row),
        from_surfaces.fans,
        are_shared,
        int(settings.seed),
    )
    exposed = None if image is None else _exposed(image, column, row)
    if packed.arrays.materials.looks is None:
        return _direct_tree(pixel, exposed)
    return _path_tree(pixel, from_surfaces, settings, number, exposed)


def _check_sample(
    sample: SupportsIndex | None, arrays: SceneArrays, settings: RenderSettings, caller: str
) -> int | None:
    """Return the number of a sample, None for the ray through the middle of the pixel.

    Raises
    ------
    RenderError
        There is no such sample, or no ray goes on from what it meets.
    """
    if sample is None:
        return None
    number = whole(sample, caller, "samples have whole numbers")
    samples = int(settings.samples)
    if arrays.materials.looks is None:
        message = (
            f"{caller}: samples are told where rays go on from surfaces, as with "
            f'integrator="path"; leave out the sample, got {number}'
        )
        raise RenderError(message)
    if not 0 <= number < samples:
        message = f"{caller}: expected a sample from 0 to {samples - 1}, got {number}"
        raise RenderError(message)
    return number if samples > 1 else None


def _direct_tree(pixel: Pixel, exposed: Exposed | None) -> RayTree:
    """Return the rays of a pixel in direct light."""
    scene, packed = pixel.scene, pixel.packed
    layers, behind, light = look_through(pixel)
    traced = behind.traced
    start, direction = in_world(pixel, traced.ray.origin), traced.ray.direction
    return RayTree(
        pixel.place,
        uncompiled(add)(start, uncompiled(scale)(-packed.before, direction)),
        direction,
        behind.hit,
        behind.lights,
        light,
        _view(scene, packed, direction),
        exposed,
        place_of_lamp(scene, packed.arrays.lights, traced.lamp),
        scene,
        layers,
        behind.share,
        _veil(packed, traced.distance, light) if is_met(traced) else None,
    )


def _path_tree(
    pixel: Pixel,
    from_surfaces: SurfaceRays,
    settings: RenderSettings,
    sample: int | None,
    exposed: Exposed | None,
) -> RayTree:
    """Return the rays of a pixel that go on from surfaces, and those to lights."""
    scene, packed = pixel.scene, pixel.packed
    fans, paths = from_surfaces
    if sample is None:
        pixel = pixel._replace(packed=replace(packed, arrays=with_pinhole(packed.arrays)))
        sampling = middle_rays(before_samples=True, fans=fans, paths=paths, seed=pixel.seed)
    else:
        lens = lens_points(packed.arrays.camera, int(settings.samples))
        sampling = filter_samples(settings, np.zeros((0, 0), np.bool_), fans, paths, lens)
    path, light = follow_path(pixel, sampling, sample or 0)
    first = path[0]
    distance = (first.distance - packed.before) / packed.unit
    return RayTree(
        pixel.place,
        first.origin,
        first.direction,
        first.hit,
        first.lights,
        light,
        _view(scene, packed, first.direction),
        exposed,
        first.lamp,
        scene,
        veil=_veil(packed, distance, light) if distance < math.inf else None,
        path=path,
        sample=sample,
    )


def _veil(packed: Packed, distance: float, light: Vec) -> Veil | None:
    """Return what fog does to the light along the ray of a pixel, which goes so far."""
    fog = packed.arrays.fog
    if fog is None:
        return None
    share = uncompiled(fog_share)(fog, distance)
    length = distance * packed.unit + packed.before
    # Where bodies are faded, fog has taken its share of each layer, and of what is behind.
    is_counted = packed.arrays.world.faded is not None
    left = light if is_counted else uncompiled(scale)(1.0 - share, light)
    return Veil(length, share, left, is_counted)


def _noise(packed: Packed, settings: RenderSettings) -> Noise | None:
    """Return how noisy soft light may be in a picture with some settings."""
    tracer = Tracer(packed.arrays, available_cores())
    return tracer.noise(settings, known_white(settings), keep=False)


def _view(scene: Scene, packed: Packed, direction: Vec) -> View:
    """Return the camera in world space.

    A panorama has no image plane; it is as one that looks in the direction of the ray.
    """
    camera, frame = scene.camera, packed.arrays.camera
    if frame.turn is not None:
        return _view_along(camera, frame.down, direction)
    center = (camera.center.x, camera.center.y, camera.center.z)
    size, pixel = (frame.width, frame.height), camera.resolution
    return View(center, frame.right, frame.down, frame.forward, camera.focus, size, pixel)


def _view_along(camera: Camera, down: Vec, direction: Vec) -> View:
    """Return a camera that looks along a ray of a panorama, and shows nothing beside it."""
    up = -down[0], -down[1], -down[2]
    is_steep = are_parallel(direction, up)
    x, y = camera_axes(direction) if is_steep else view_axes(direction, up)
    eye = camera.center.x, camera.center.y, camera.center.z
    size = int(camera.size[0]), int(camera.size[1])
    return View(eye, x, y, direction, 0.0, size, (0.0, 0.0))


def _exposed(image: Image, column: int, row: int) -> Exposed:
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
