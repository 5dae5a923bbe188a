"""From a scene to its picture: the steps in their order."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any, Literal, Protocol

from vtray.base.caller_warning import warn_caller
from vtray.base.compiler.compiled import loading_seconds
from vtray.base.function import check_function
from vtray.base.memory import (
    BYTES_PER_PIXEL_AND_MORE,
    BYTES_PER_PIXEL_DENOISED,
    BYTES_PER_PIXEL_SHOWN,
    BYTES_PER_PIXEL_STARRY,
    check_memory,
)
from vtray.base.number import is_integer, number_of
from vtray.base.pool import Progress as StepProgress
from vtray.base.pool import available_cores
from vtray.base.stopwatch import Stopwatch
from vtray.base.tiles import TILE
from vtray.image.compositing import warm_up
from vtray.image.denoise import load_library
from vtray.image.exposure import check_brightness
from vtray.image.image import Image
from vtray.image.white import known_white, locked_white
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.ahead import compile_ahead
from vtray.rendering.clipping import is_nothing_left
from vtray.rendering.darkroom import Darkroom
from vtray.rendering.denoising import Denoising
from vtray.rendering.drawing import Drawing
from vtray.rendering.fog import fitted, shapes_of
from vtray.rendering.followed import (
    check_followed,
    check_radiances,
    darkness,
    followed,
    shines,
    simpler_looks,
)
from vtray.rendering.growth import Growth
from vtray.rendering.guides import Guiding
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import Packed, pack
from vtray.rendering.passes import Tracer
from vtray.rendering.relighting import Relighting, Rerendering
from vtray.rendering.seen_sky import SeenSky, check_sky
from vtray.rendering.starlight import Starlight, check_stars, has_stars
from vtray.rendering.styled import styled
from vtray.rendering.surfaces import Look
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.default_camera import with_camera
from vtray.scene.default_light import lights_of, lit_objects, settings_of
from vtray.scene.files.scene_file import Warn
from vtray.scene.light_types import AnyLight, gives_light, strength_of
from vtray.scene.scene import Camera, Scene
from vtray.scene.settings import FilterName, IntegratorName, RenderSettings, overridden
from vtray.scene.style import Style

Progress = Callable[[str, int, int], None]

NOTHING_LEFT = (
    "style.clip: leaves nothing of the scene; what lies on the side that a normal points to is "
    "left out, so maybe turn one round"
)


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
    filter: FilterName | None = None,  # noqa: A002 - as in the scene file
    seed: int | None = None,
    size: Sequence[int] | None = None,
    exposure: Literal["max", "auto"] | float | None = None,
    background: Any = None,  # noqa: ANN401
    tolerance: float | None = None,
    denoise: bool | None = None,
    stops: float | None = None,
    tonemap: ToneMapName | None = None,
    integrator: IntegratorName | Mapping[str, object] | None = None,
    depth: int | None = None,
    firefly: Literal["off"] | float | None = None,
    edge_samples: int | None = None,
    outline: Any = None,  # noqa: ANN401 - all that `Style` takes
    fog: Any = None,  # noqa: ANN401
    eye_dome: Any = None,  # noqa: ANN401
    clip: Any = None,  # noqa: ANN401
    slice: Any = None,  # noqa: A002, ANN401 - as in the scene file
    cap: Any = None,  # noqa: ANN401
    solid_from: float | None = None,
    lock: HasWhite | None = None,
    keep_lights: bool = False,
    on_update: Callable[[Image], object] | None = None,
    update_seconds: float = 1.0,
    tile: int = TILE,
    warn: Warn | None = None,
) -> Image:
    """Render a scene.

    The picture depends on the scene and the settings alone: not on threads, tiles or the machine.
    Settings that are not given are those of ``scene.render``, parts of the style those of
    ``scene.style``.

    Parameters
    ----------
    scene
        The scene. Where its camera was never set, all is seen that has an end, as
        ``vtray.Camera.fit(scene, view="auto")`` shows it, with particles that have a cell as
        ``view=(-65, 20)`` does, or above the first plane if there is one.
    threads
        How many threads to use, at least 1; None for all cores. No more are used than there is
        work for.
    progress
        Called from time to time with what is being done, ``"build"`` or ``"trace"``, how many of
        its tasks are done, and how many there are.
    samples
        Rays for each pixel in which more than one surface or shadow may be seen; 1 for exactly the
        picture that the format defines, which is the default. 4 is that of scenes whose lights were
        never set.
    filter
        How the samples of a pixel are weighted: ``"box"``, ``"tent"``, ``"gaussian"``,
        ``"mitchell"`` or ``"blackman-harris"``, the default.
    seed
        Chooses among equally good places of the samples.
    size
        Width and height of the picture in pixels, of the same view, instead of the camera's.
    exposure
        ``"max"``, the default: the brightest channel becomes 255. ``"auto"``: that of 99 of 100
        pixels with light does at the most, and what is brighter is cut off. A number: light is
        multiplied by it, so that for 1 a surface that a light of intensity 1 shines on squarely
        gets its colour. 1 is also the default of scenes whose lights were never set.
    background
        What is seen where nothing is: ``"black"``, the default, ``"transparent"``, ``"sky"`` for
        the skies among the lights, or a colour in any of the ways of `vtray.colors.to_rgb`.
        White is the default of scenes whose lights were never set, unless they hold `Stars`.
    tolerance
        How noisy soft light may be: the standard error of a pixel, 1 for white; 0.008 by default,
        two steps of 255. For scenes whose lights were never set, and without planes, it is 0.012 to
        0.06: more for small things, among which grain is not seen. From each point that is seen,
        rays are cast to each lamp with a size until what they tell is estimated to be as exact as
        that. With `keep_lights`, that does not look at light: each of n soft lights counts as if it
        gave one n-th of white.
    denoise
        Whether the grain of soft light is taken out by Open Image Denoise, once all is traced. The
        picture is then no longer the same on every machine; `Image.raw` is.
    stops
        How often the light is doubled after the exposure, 0 by default; below 0 it is halved.
    integrator
        ``"direct"``, the default: mirrors and glass look matt; ``"whitted"``: they are followed;
        ``"path"``: all light is, by paths that go on at random, which takes many samples.
    depth
        Over how many surfaces light is followed, from 0 to 64; 8 by default.
    firefly
        The brightest light that one sample may bring to a pixel with ``integrator="whitted"`` and
        ``"path"``, 1 for white: specks of light become darker, and so does the picture, which is
        then biased; edges of bright things become smooth. ``"off"`` by default.
    edge_samples
        Rays for each pixel whose samples differ much, if that is more than `samples`: for one pixel
        of sixteen at the most, those that differ most. 16 is the default of scenes whose lights
        were never set. In direct light, without a lens and without `keep_lights`.
    tonemap
        How light becomes the numbers of a file: ``"linear"``, the default, as it is; ``"srgb"``,
        ``"filmic"`` and ``"agx"`` encoded for monitors. For these, all colours that are given are
        taken for sRGB, so that what is lit squarely shows its own colour back with ``"srgb"``.
    outline
        Lines around what is seen: True, their width in pixels, that and a colour, or an `Outline`;
        False for none.
    fog
        Fog, in which things fade with their distance: True for fog that is fitted to the scene, two
        distances, these and a colour, or a `Fog`; False for none.
    eye_dome
        Eye-dome lighting, for points and landscapes: True, its strength, or an `EyeDome`; False for
        none.
    clip
        Planes; nothing exists on the sides that their normals point to, for rays of the camera and
        for shadow rays alike. One is its normal, through the middle of the scene, or four numbers,
        that and its distance from the origin along it, or a `ClipPlane`; several are a list of
        such; ``()`` for none.
    slice
        A slab; nothing exists outside of it: its normal, maybe the distance of its middle from the
        origin, and its thickness, as four or five numbers, or a `Slice`; False for none.
    cap
        Whether spheres, cylinders and cones that are cut are closed: True in their own colour, or a
        colour; False leaves them open, so that light comes in and their inside is seen, but for
        bodies that let light through, which are solid and always closed.
    solid_from
        Depth, ids and normals are those of the first surface that is more opaque than that, 0.5 by
        default.
    lock
        A picture whose exposure is taken, its stops too, so that a sequence does not flicker; not
        together with `exposure` or `stops`. What is white is then known before rays are cast to
        soft lights and edges, whose grain may be another than without a lock.
    keep_lights
        Keep the light of each lamp apart, for `Image.relight` and `Image.recolor`.
    on_update
        Called from time to time with the picture so far, an `Image` to look at or to save whose
        `Image.partial` says how much of it is done: first with a draft of an eighth of its width
        and height, in whose place exact pixels come from the middle outwards, and with samples a
        second time. It is called in the calling thread, a last time after Ctrl-C, and never with
        the whole picture, which does not depend on it. What it raises ends the render.
    update_seconds
        The least time between two such calls, and before the first; ``math.inf`` for one after
        Ctrl-C alone. If they take long, there are fewer, so that they take a tenth of the time at
        the most.
    tile
        Side of a tile in pixels.
    warn
        Called with one line of text if there is something to see, but no light, or far brighter
        light in mirrors, which leaves all else dark; `warnings.warn` by default.

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
        picture, or `exposure` or `stops` is given too; or the background is the sky, and there is
        none.
    ValueError
        `threads` or `tile` is not an integer of at least 1, `update_seconds` no number ≥ 0, or
        `progress`, `on_update` or `warn` no function.
    ExtraError
        `denoise` is asked for, and its library is not installed.
    KeyboardInterrupt
        After Ctrl-C; all threads have ended by then.
    """
    threads = _count("threads", threads if threads is not None else available_cores())
    tile = _count("tile", tile)
    _check_calls(progress, on_update, update_seconds, warn)
    if lock is not None:
        locked_white(lock, exposure, stops)
    given, scene = scene, with_camera(scene, size)
    lights = lights_of(scene)
    settings, style = settings_of(scene, locals()), overridden(scene.style, locals())
    shown = _shown(scene, lights, settings)
    style = fitted(style, shown.camera, lambda: shapes_of(shown))
    if settings.denoise:
        load_library()  # before any work is done
    _tell(warn, *_problems(shown, settings, keep_lights=keep_lights))
    _check(shown, settings, is_shown=on_update is not None)
    # Kernels are compiled, or loaded, when they are first called: that is no part of a step.
    clock, loaded = Stopwatch(loading_seconds), loading_seconds()
    kept = _accelerated(given, shown, settings, style, threads, progress)
    check_followed(kept, scene.objects, settings, keep_lights=keep_lights)
    _tell(warn, NOTHING_LEFT if is_nothing_left(kept, scene.objects) else "")
    clock.lap("build")
    packed = styled(pack(shown, kept), style)
    clock.lap("pack")
    drawing = Drawing(style, shown, packed, threads)
    drawing.warm_up()
    warm_up(settings)
    sky = SeenSky(packed.arrays.camera, settings, threads)
    sky.warm_up(shown)
    clock.lap("compile")
    look, guiding = Look(shown, packed, threads), Guiding(kept, settings, style, threads)
    white = known_white(settings, lock)
    rerendering = Rerendering(kept, settings, style, white, threads, keep_lights=keep_lights)
    darkroom = Darkroom(
        shown,
        Scene(scene.camera, lights, list(scene.objects), scene.render, scene.style),
        settings,
        style,
        look,
        guiding.albedo,
        rerendering.orders,
        sky,
        Starlight(lambda: look().depth, kept.rooms),
        lock,
        bool(keep_lights),
        threads,
    )
    growth = _growth(darkroom, on_update, update_seconds)
    tracer = Tracer(
        packed.arrays, threads, tile, _step_of(progress, "trace"), growth, drawing.wanted
    )
    with growth or nullcontext():
        traced = tracer.light(settings, white, keep=keep_lights)
    clock.lap("trace")
    _tell(warn, darkness(traced.film.linear, traced.peak, settings) if lock is None else "")
    relighting = (
        Relighting(kept, traced.kept, int(settings.samples), threads)
        if packed.arrays.world.faded is None and packed.arrays.materials.paints.patterns is None
        else rerendering
    )
    denoising = Denoising(
        None if _is_blurred(packed, settings) else guiding, traced.film.coverage, threads
    )
    image = darkroom.picture(
        traced.film.linear,
        denoising.shares(traced.film.coverage) if settings.denoise else traced.film.coverage,
        traced.peak,
        fog=denoising.shares(traced.film.fog) if settings.denoise else traced.film.fog,
        lines=drawing.lines(traced.film),
        shade=drawing.shade(traced.film),
        error=traced.film.error,
        samples=traced.samples,
        noise=traced.noise,
        relighting=relighting if keep_lights else None,
        denoising=denoising if settings.denoise else None,
    )
    if settings.denoise:
        clock.lap("denoise")
    image.develop()
    clock.lap("develop")
    clock.seconds["compile"] += loading_seconds() - loaded
    image.stats = {
        **clock.seconds,
        "rays": traced.rays,
        "nodes": kept.nodes,
        "depth": kept.tree_depth,
        "memory": kept.memory,
    }
    return image


def _accelerated(
    given: Scene,
    shown: Scene,
    settings: RenderSettings,
    style: Style,
    threads: int,
    progress: Progress | None,
) -> Acceleration:
    """Return what is kept with a scene, which is given, for the picture of it that is shown."""
    compile_ahead(shown, settings, style)
    return accelerate(given, threads, _step_of(progress, "build"), style)


def _growth(
    darkroom: Darkroom, on_update: Callable[[Image], object] | None, seconds: float
) -> Growth | None:
    """Return what shows the picture as it grows, if somebody looks."""
    if on_update is None:
        return None
    return Growth(lambda part: on_update(darkroom.part(part)), seconds)


def _problems(scene: Scene, settings: RenderSettings, *, keep_lights: bool) -> tuple[str, ...]:
    """Say what will not be seen as it may be meant; "" for what will."""
    darkness = _darkness(scene, keep_lights=keep_lights)
    return darkness, simpler_looks(scene.objects, settings), _sharpness(scene.camera, settings)


def _darkness(scene: Scene, *, keep_lights: bool) -> str:
    """Say why all that is seen is black, if that is known before; "" if it is not."""
    if not lit_objects(scene) or any(map(gives_light, scene.lights)) or shines(scene):
        return ""
    if not scene.lights:
        remedy = "add one by scene.add_light, or some of vtray.lights; in a file, under that key"
        return f"lights: there are none, so all that is seen is black; {remedy}"
    if keep_lights:  # to be relit with other intensities
        return ""
    if any(strength_of(light) > 0 for light in scene.lights):
        return "lights: all are black, and so is all that is seen; give one another color"
    return "lights: all have the intensity 0, so all that is seen is black; give one more than 0"


def _sharpness(camera: Camera, settings: RenderSettings) -> str:
    """Say why nothing is blurred though there is a lens; "" if it is, or if there is none."""
    if camera.lens is None or camera.lens.radius == 0 or settings.samples > 1:
        return ""
    return "camera.lens: all is sharp with one ray a pixel; give samples, such as 64"


def _tell(warn: Warn | None, *problems: str) -> None:
    """Warn of each problem that is not "", in the name of the code that called `render`."""
    for problem in filter(None, problems):
        (warn or warn_caller)(problem)


def _camera(scene: Scene, settings: RenderSettings) -> Camera:
    """Return the camera of a scene in the size asked for."""
    size = settings.size
    if size is None or size == scene.camera.size:
        return scene.camera
    return scene.camera.resized((int(size[0]), int(size[1])))


def _check(scene: Scene, settings: RenderSettings, *, is_shown: bool) -> None:
    """Raise RenderError if there can be no picture."""
    _check_memory(scene, settings, is_shown=is_shown)
    check_brightness(scene.lights)
    check_radiances(scene)
    check_sky(scene.lights, settings)
    check_stars(scene, settings)


def _check_memory(scene: Scene, settings: RenderSettings, *, is_shown: bool) -> None:
    """Raise RenderError if the picture cannot be held in memory."""
    width, height = scene.camera.size
    behind = 0 if settings.background == "black" else BYTES_PER_PIXEL_AND_MORE
    more = BYTES_PER_PIXEL_SHOWN if is_shown else 0
    more += BYTES_PER_PIXEL_DENOISED if settings.denoise else 0
    more += BYTES_PER_PIXEL_STARRY if has_stars(scene) else 0
    check_memory(int(width), int(height), int(settings.samples), behind, more)


def _is_blurred(packed: Packed, settings: RenderSettings) -> bool:
    """Tell whether rays go through a lens: the light of surfaces is then less sharp than they."""
    return packed.arrays.camera.lens is not None and settings.samples > 1


def _shown(scene: Scene, lights: list[AnyLight], settings: RenderSettings) -> Scene:
    """Return the scene as it is now and is to be shown: how large, in which light, how followed."""
    render = followed(scene.render, settings)
    return Scene(_camera(scene, settings), lights, list(scene.objects), render, scene.style)


def _step_of(progress: Progress | None, step: str) -> StepProgress | None:
    """Return what shows the progress of one step."""
    return None if progress is None else partial(progress, step)


def _check_calls(progress: object, on_update: object, seconds: float, warn: object) -> None:
    """Raise ValueError if one is neither None nor can be called, or not every so many seconds."""
    for name, given, takes in (
        ("progress", progress, "a step, and how much of how much is done"),
        ("on_update", on_update, "an image"),
        ("warn", warn, "a line of text"),
    ):
        check_function(name, given, takes)
    if not number_of(seconds) >= 0:
        message = f"update_seconds: expected a number ≥ 0, got {seconds!r}"
        raise ValueError(message)


def _count(name: str, value: int) -> int:
    """Return an argument that must be an integer of at least 1."""
    if not is_integer(value) or value < 1:
        message = f"{name}: expected an integer ≥ 1, got {value!r}"
        raise ValueError(message)
    return int(value)
