"""From a scene to its picture: the steps in their order."""

from collections.abc import Callable
from functools import partial
from typing import Any, Literal, Protocol

import numpy as np

from vtray.base.compiler.compiled import loading_seconds
from vtray.base.memory import BYTES_PER_PIXEL_AND_MORE, check_memory
from vtray.base.pool import Progress as StepProgress
from vtray.base.pool import available_cores
from vtray.base.stopwatch import Stopwatch
from vtray.base.tiles import TILE
from vtray.image.exposure import check_brightness, locked_white, warm_up, white_of
from vtray.image.image import Image
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.rendering.passes import Tracer, compile_kernels
from vtray.rendering.relighting import Relighting
from vtray.rendering.surfaces import Look
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.default_light import default_settings, has_default_light, lights_of
from vtray.scene.files.scene_file import Warn
from vtray.scene.light_types import AnyLight, strength_of
from vtray.scene.scene import Camera, Scene
from vtray.scene.settings import RenderSettings, overridden

Progress = Callable[[str, int, int], None]


class HasWhite(Protocol):
    """What an exposure can be locked to: a picture, or what one says of itself."""

    @property
    def white(self) -> float:
        """The light that becomes 255."""


@explain_unknown
def render(
    scene: Scene,
    threads: int | None = None,
    progress: Progress | None = None,
    *,
    samples: int | None = None,
    filter: str | None = None,  # noqa: A002 - as in the scene file
    seed: int | None = None,
    size: tuple[int, int] | None = None,
    exposure: Literal["max"] | float | None = None,
    background: Any = None,  # noqa: ANN401
    lock: HasWhite | None = None,
    keep_lights: bool = False,
    tile: int = TILE,
    warn: Warn | None = None,
) -> Image:
    """Render a scene.

    The picture depends on the scene and the settings alone: not on threads, tiles or the machine.
    Settings that are not given are those of ``scene.render``.

    Parameters
    ----------
    scene
        The scene.
    threads
        How many threads to use, at least 1; None for all cores. No more are used than there is
        work for.
    progress
        Called from time to time with what is being done, ``"build"`` or ``"trace"``, how many of
        its tasks are done, and how many there are.
    samples
        Rays for each pixel in which more than one surface or shadow may be seen; 1 for exactly the
        picture that the format defines, which is the default.
    filter
        How the samples of a pixel are weighted: ``"box"``, ``"tent"``, ``"gaussian"``,
        ``"mitchell"`` or ``"blackman-harris"``, the default.
    seed
        Chooses among equally good places of the samples.
    size
        Width and height of the picture in pixels, of the same view, instead of the camera's.
    exposure
        ``"max"``, the default: the brightest channel becomes 255. A number: light is multiplied by
        it, so that for 1 a surface that a light of intensity 1 shines on squarely gets its colour.
        1 is also the default of scenes whose lights were never set.
    background
        What is seen where nothing is: ``"black"``, the default, ``"transparent"``, or a colour in
        any of the ways of `vtray.colors.to_rgb`.
    lock
        A picture whose exposure is taken, so that a sequence does not flicker; not together with
        `exposure`.
    keep_lights
        Keep the light of each lamp apart, for `Image.relight` and `Image.recolor`.
    tile
        Side of a tile in pixels.
    warn
        Called with one line of text if there is something to see, but no light; `warnings.warn` by
        default.

    Returns
    -------
    Image
        The picture.

    Raises
    ------
    SceneError
        The scene or a setting holds something that none may hold.
    RenderError
        The image does not fit into memory, its light is too bright for a double, `lock` is no
        picture, or `exposure` is given too.
    ValueError
        `threads` or `tile` is not an integer of at least 1.
    KeyboardInterrupt
        After Ctrl-C; all threads have ended by then.
    """
    threads = _count("threads", threads if threads is not None else available_cores())
    tile = _count("tile", tile)
    if lock is not None:
        locked_white(lock, exposure)
    scene.check()
    lights = lights_of(scene)
    settings = overridden(_settings_of(scene), locals())
    shown = _snapshot(scene, lights, _camera(scene, settings))
    problem = _darkness(shown, keep_lights=keep_lights)
    if problem:
        (warn or _warn)(problem)
    width, height = shown.camera.size
    behind = 0 if settings.background == "black" else BYTES_PER_PIXEL_AND_MORE
    check_memory(int(width), int(height), int(settings.samples), behind)
    check_brightness(shown.lights)
    clock = Stopwatch()
    loaded = loading_seconds()
    kept = accelerate(scene, threads, _step_of(progress, "build"))
    clock.lap("build")
    loading = loading_seconds() - loaded
    packed = pack(shown, kept)
    clock.lap("pack")
    compile_kernels(packed.arrays, settings, keep=keep_lights)
    warm_up()
    clock.lap("compile")
    tracer = Tracer(packed.arrays, threads, tile, _step_of(progress, "trace"))
    traced = tracer.light(settings, keep=keep_lights)
    clock.lap("trace")
    stats = {
        "rays": traced.rays,
        "nodes": kept.nodes,
        "depth": kept.tree_depth,
        "memory": kept.memory,
    }
    image = Image(
        traced.film.linear,
        None,
        white_of(settings.exposure, traced.peak) if lock is None else locked_white(lock),
        shown,
        settings,
        {},
        look=Look(shown, packed, threads),
        alpha=traced.film.coverage,
        relighting=Relighting(kept, traced.kept, int(settings.samples), threads)
        if keep_lights
        else None,
        threads=threads,
        original=_snapshot(scene, lights, scene.camera),
        locked=lock is not None,
    )
    image.develop()
    clock.lap("develop")
    # Kernels are loaded when they are first called; that is no part of the build.
    clock.seconds["build"] -= loading
    clock.seconds["compile"] += loading
    image.stats = {**clock.seconds, **stats}
    return image


def _darkness(scene: Scene, *, keep_lights: bool) -> str:
    """Say why all that is seen is black, if that is known before; "" if it is not."""
    if not scene.objects or any(strength_of(light) > 0 for light in scene.lights):
        return ""
    if not scene.lights:
        remedy = "add one by scene.add_light, or some of vtray.lights; in a file, under that key"
        return f"lights: there are none, so all that is seen is black; {remedy}"
    if keep_lights:  # to be relit with other intensities
        return ""
    return "lights: all have the intensity 0, so all that is seen is black; give one more than 0"


def _warn(message: str) -> None:
    """Warn in the name of the code that called `render`."""
    import warnings

    warnings.warn(message, stacklevel=4)


def _settings_of(scene: Scene) -> RenderSettings:
    """Return the settings of a scene, with those for its light if that is the default one."""
    look = default_settings(scene.render) if has_default_light(scene) else {}
    return scene.render.replace(**look)


def _camera(scene: Scene, settings: RenderSettings) -> Camera:
    """Return the camera of a scene in the size asked for."""
    size = settings.size
    if size is None or size == scene.camera.size:
        return scene.camera
    return scene.camera.resized((int(size[0]), int(size[1])))


def _snapshot(scene: Scene, lights: list[AnyLight], camera: Camera) -> Scene:
    """Return the scene as it is now, with a camera."""
    return Scene(camera, lights, list(scene.objects), scene.render)


def _step_of(progress: Progress | None, step: str) -> StepProgress | None:
    """Return what shows the progress of one step."""
    return None if progress is None else partial(progress, step)


def _count(name: str, value: int) -> int:
    """Return an argument that must be an integer of at least 1."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        message = f"{name}: expected an integer ≥ 1, got {value!r}"
        raise ValueError(message)
    return int(value)
