"""What a render gives: light, the pixels that it becomes, and what the rays met."""

import copy
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.base.number import is_integer
from vtray.figures.brightness_scale import SHADES, BrightnessScale
from vtray.image.compositing import Drawn, composite, has_background, with_lines
from vtray.image.exposure import Overlay, check_brightness, develop
from vtray.image.orders import Orders, unknown_orders
from vtray.image.surfaces import Surfaces
from vtray.image.toned import Toning, develop_toned
from vtray.image.white import white_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.tone_map_names import is_encoded
from vtray.scene.fingerprint import scene_hash
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.stars import Stars
from vtray.scene.style import Fog, Outline, Style
from vtray.scene.vectors import Color

Floats = NDArray[np.float64]
Shares = NDArray[np.float32]

PLAIN = Style()
BLACK = Color(0, 0, 0)
WHITE = (255, 255, 255)


class GivesSurfaces(Protocol):
    """Gives what the middle rays of a picture meet."""

    def __call__(self, *, faint: bool = False) -> Surfaces:
        """Return the first solid surfaces, or the first ones, however faint."""


class GivesStarlight(Protocol):
    """Gives the light of the points that shine in a scene."""

    def __call__(self, scene: Scene) -> Floats | None:
        """Return their light, (height, width, 3); None without any."""

    def peaks(self, scene: Scene) -> list[tuple[Stars, float]]:
        """Return those that are seen, and the light of a pixel that is as bright as can be."""


class Rendered:
    """A rendered picture as data; `Image` says what its attributes are, and what can be done.

    Parameters
    ----------
    linear, white, scene, settings, stats, locked, keep_lights, partial
        The attributes.
    pixels
        Light after exposure with 8 bits; None until it is asked for.
    look
        Gives what the middle rays meet; called once, when it is first asked for.
    albedo
        Gives what share of light the surfaces of a scene send on; called when it is asked for.
    orders
        Gives the light of a scene as it was traced by how often it was scattered; likewise.
    alpha
        How much of each pixel is covered, if that is known; None for what `look` says.
    fog
        How much of each pixel fog is, if there is any.
    lines
        How much of each pixel outlines hide, if there are any.
    shade
        How much of its light each pixel keeps in eye-dome lighting, if there is any.
    error
        The standard error of light, if it is not 0 everywhere.
    samples
        How many rays each pixel has; None where each has one.
    noise
        How noisy soft light was allowed to be, which says what rays were cast, if there is any.
    relighting
        Gives the light of the same view of a scene with other lights or colours, if that was kept.
    raw
        Light as it was traced, if that is not `linear`.
    denoising
        Gives the light of a scene without grain, if that is what `linear` is.
    threads
        How many threads to use at the most.
    original
        The scene with its camera as it was given, whatever size was asked for.
    sky
        Gives the light of the skies of a scene where its pixels are not covered; called where that
        is the background.
    starlight
        Gives the light of the points that shine in a scene, which is a part of `linear` and `raw`;
        None if there are none.
    style
        How it is drawn, beside its light.
    """

    def __init__(
        self,
        linear: Floats,
        pixels: NDArray[np.uint8] | None,
        white: float,
        scene: Scene,
        settings: RenderSettings,
        stats: Mapping[str, float],
        *,
        look: GivesSurfaces,
        albedo: Callable[[Scene], Floats],
        orders: Callable[[Scene], Orders],
        alpha: Floats | None = None,
        fog: Floats | None = None,
        lines: Shares | None = None,
        shade: Shares | None = None,
        error: Floats | None = None,
        samples: NDArray[np.int32] | None = None,
        noise: Any = None,  # noqa: ANN401
        relighting: Callable[[Scene], Floats] | None = None,
        raw: Floats | None = None,
        denoising: Callable[[Scene, Floats], Floats] | None = None,
        threads: int = 1,
        original: Scene | None = None,
        locked: bool = False,
        keep_lights: bool = False,
        partial: float | None = None,
        sky: Callable[[Scene, Floats], Floats] | None = None,
        starlight: GivesStarlight | None = None,
        style: Style = PLAIN,
    ) -> None:
        self.linear = linear
        self.white = white
        self.scene = scene
        self.settings = settings
        self.stats = stats
        self._look = look
        self._albedo = albedo
        self._orders_of = orders
        # What it gave, faint or not; shared with other exposures of the view.
        self._seen: dict[bool, Surfaces] = {}
        self._pixels = pixels
        self._alpha = alpha
        self._fog = fog
        self._lines = lines
        self._shade = shade
        self._error = error
        self._samples = samples
        self.noise = noise
        self._relighting = relighting
        self._raw = raw
        self._denoising = denoising
        self._threads = threads
        self._original = original or scene
        self.locked = locked
        self.keep_lights = keep_lights
        self.partial = partial
        self._sky = sky
        self._starlight = starlight
        self.style = style

    def __repr__(self) -> str:
        height, width = self.linear.shape[:2]
        part = "" if self.partial is None else f", {self.partial:.0%} of it done"
        return f"<Image of {width} x {height} pixels, {self.settings}{part}>"

    @property
    def pixels(self) -> NDArray[np.uint8]:
        """Light after exposure, uint8, (height, width, 3), or with alpha (height, width, 4)."""
        return self.develop()

    def develop(self, bits: int = 8) -> NDArray[Any]:
        """Return light after exposure with 8 or 16 bits for each channel.

        A channel v of light becomes ``floor(maximum * v / white)``, where the maximum is 255 or
        65535. With a tone map that is not linear, it becomes ``round(maximum * encoded)``. With a
        transparent background there is a fourth channel, alpha, and colours are not multiplied by
        it.

        Raises
        ------
        RenderError
            `bits` is neither 8 nor 16.
        """
        if not is_integer(bits) or bits not in (8, 16):
            raise RenderError(f"bits: expected 8 or 16, got {bits!r}")
        if bits == 8 and self._pixels is not None:
            return self._pixels
        background = self.settings.background
        if is_encoded(self.settings.tonemap):
            return self._develop_toned(bits)
        is_drawn_on = background == "black" and self._is_drawn_on
        if bits == 8 and (is_drawn_on or has_background(self.settings)):
            self._pixels = composite(
                self.linear,
                self.white,
                background,
                lambda: self._covered,
                self._drawn,
                self._threads,
            )
            return self._pixels
        pixels = develop(
            self.with_sky,
            self.white,
            background,
            lambda: self.alpha,
            self._threads,
            bits,
            self.overlays,
        )
        if bits == 8:
            self._pixels = pixels
        return pixels

    def _develop_toned(self, bits: int) -> NDArray[Any]:
        """Return what `develop` does, by a tone map that is not linear."""
        settings = self.settings
        toning = Toning(settings.tonemap, self.white, settings.background, 2**bits - 1)
        light, overlays = self.with_sky, self.overlays
        pixels = develop_toned(light, toning, lambda: self.alpha, self._threads, overlays)
        if bits == 8:
            self._pixels = pixels
        return pixels

    @property
    def raw(self) -> Floats:
        """Light as it was traced, exact to the last bit: `linear` if that is not denoised."""
        return self.linear if self._raw is None else self._raw

    @property
    def _surfaces(self) -> Surfaces:
        return self._seen_once(faint=False)

    def _seen_once(self, *, faint: bool) -> Surfaces:
        """Return what middle rays meet, for which they are traced once."""
        if faint not in self._seen:
            self._seen[faint] = self._look(faint=True) if faint else self._look()
        return self._seen[faint]

    @property
    def shown(self) -> Surfaces:
        """What figures measure and colour: surfaces, or faint ones where no pixel has another."""
        return self._seen_once(faint=not self._surfaces.any_seen)

    @property
    def depth(self) -> Floats:
        """Distance along the ray in scene units, infinite where nothing is, (height, width)."""
        return self._surfaces.depth

    @property
    def normals(self) -> Floats:
        """Unit normals in world space on the ray's side, 0 where nothing is, (h, w, 3)."""
        return self._surfaces.normals

    @property
    def ids(self) -> NDArray[np.int32]:
        """What is seen, (height, width, 2): the place in ``scene.objects``, and that in its arrays.

        Both are -1 where nothing is; the second is 0 for a single sphere and for a plane. What
        `Copies` place is counted through all their objects; `copies` tells which copy it is.
        """
        return self._surfaces.ids

    @property
    def copies(self) -> NDArray[np.int32]:
        """Which copy of what `Copies` place is seen, (height, width); -1 where there is none."""
        return self._surfaces.copies

    @property
    def halves(self) -> NDArray[np.int8]:
        """Which half of a cylinder or cone is seen, (height, width): 1 for that at its end."""
        return self._surfaces.halves

    @cached_property
    def albedo(self) -> Floats:
        """The share of light that surfaces send on, (height, width, 3); 0 where nothing is.

        Of a matt one that is its colour as light, 1 for white, times ``lambert``. With the
        integrators whitted and path it is also what coats, mirrors and metals mirror, and what
        glass mirrors and lets through of white light from everywhere: the first surface alone, not
        what is seen in it or behind it. Of what has an opacity below 1, each layer counts for as
        much of it as is seen. Of a pixel with samples it is the mean over the pixel, sharp also
        where there is a lens.
        """
        return self._albedo(self.scene)

    @cached_property
    def _orders(self) -> Orders:
        height, width = self.linear.shape[:2]
        if self.partial is not None:
            return unknown_orders(height, width)
        found, shine = self._orders_of(self.scene), self.starlight
        return found if shine is None else found._replace(emission=found.emission + shine)

    @property
    def emission(self) -> Floats:
        """The part of `raw` that no surface has scattered, (height, width, 3).

        That is the light of lamps that are seen, of stars, and of emissive surfaces that are the
        first on the way. It is 0 in a mirror, as a mirror scatters what is seen in it, and where
        the sky is the background, which is laid behind `linear` and no part of it.

        It is known by tracing all rays once more when `emission`, `direct` or `indirect` is first
        asked for. These three add up to `raw`: to the last bit where only one of them is not 0,
        else as exactly as sums of doubles are. Of a part of a picture they are not known: NaN.
        """
        return self._orders.emission

    @property
    def direct(self) -> Floats:
        """The part of `raw` that one surface has scattered, (height, width, 3).

        That is light of lamps, skies and emissive surfaces that reaches the first surface that is
        seen, and is seen there: on a matt one by its colour, in a mirror or in glass by what it
        shows. See `emission` for how it is known, and how exactly.
        """
        return self._orders.direct

    @property
    def indirect(self) -> Floats:
        """The part of `raw` that two surfaces or more have scattered, (height, width, 3).

        It is 0 with the integrator direct. With whitted it is what mirrors and glass show of lit
        surfaces, and of lamps through two of them, such as the two sides of a ball of glass. See
        `emission` for how it is known, and how exactly.
        """
        return self._orders.indirect

    @cached_property
    def alpha(self) -> Floats:
        """How much of each pixel is covered, from 0 to 1, (height, width).

        Fog of no colour of its own covers nothing: as much of the background is seen. Lines cover
        what they are drawn on.
        """
        covered = self._covered
        return covered if self._lines is None else with_lines(covered, self._lines)

    @property
    def _covered(self) -> Floats:
        """How much of each pixel is covered if there are no lines, (height, width)."""
        covered = self._alpha
        if covered is None:
            covered = (self.ids[..., 0] >= 0).astype(np.float64)
        if self._fog is not None and self._fog_color is None:
            covered = np.maximum(covered - self._fog, 0.0)
        return covered

    @property
    def _fog_color(self) -> Color | None:
        return self.style.fog.color if isinstance(self.style.fog, Fog) else None

    @property
    def _seen_beside_lines(self) -> Floats:
        """How much of each pixel lines leave."""
        assert self._lines is not None  # noqa: S101
        return 1.0 - self._lines.astype(np.float64)

    @property
    def _is_drawn_on(self) -> bool:
        given = self._shade, self._lines, self._fog_color
        return any(part is not None for part in given)

    @property
    def _drawn(self) -> Drawn:
        """What the style draws."""
        none, outline = np.zeros((0, 0), np.float32), self.style.outline
        line, fog = outline.color if isinstance(outline, Outline) else BLACK, self._fog_color
        return Drawn(
            none if self._shade is None else self._shade,
            none if self._lines is None else self._lines,
            none.astype(np.float64) if self._fog is None or fog is None else self._fog,
            (float(line.r), float(line.g), float(line.b)),
            (0.0, 0.0, 0.0) if fog is None else (float(fog.r), float(fog.g), float(fog.b)),
        )

    @property
    def overlays(self) -> list[Overlay]:
        """What has colours that exposure does not change: fog with one of its own, and lines."""
        found = []
        outline = self.style.outline
        if self._fog is not None and self._fog_color is not None:
            left = self._fog if self._lines is None else self._fog * self._seen_beside_lines
            found.append(Overlay(left, self._fog_color))
        if self._lines is not None and isinstance(outline, Outline):
            found.append(Overlay(self._lines.astype(np.float64), outline.color))
        return found

    @property
    def drawn(self) -> Floats:
        """Light before exposure that lines and eye-dome lighting leave, (height, width, 3)."""
        light = self.linear
        if self._shade is not None:
            light = light * self._shade[..., None]
        if self._lines is not None:
            light = light * self._seen_beside_lines[..., None]
        return light

    @cached_property
    def with_sky(self) -> Floats:
        """Light before exposure, drawn, with that of the sky if it is the background, (h, w, 3)."""
        if self._sky is None or self.settings.background != "sky":
            return self.drawn
        behind = self._sky(self.scene, self.alpha)
        return self.drawn + (1.0 - self.alpha[..., None]) * behind

    @property
    def with_overlays(self) -> Floats:
        """Light before exposure of all that is seen, fog and lines too, (height, width, 3)."""
        light = self.with_sky
        for share, color in self.overlays:
            own = np.array(light_of(color, self.settings.tonemap)) * (self.white / 255)
            light = light + share[..., None] * own
        return light

    @property
    def starlight(self) -> Floats | None:
        """The part of `linear` that points give which shine; None if there are none."""
        return None if self._starlight is None else self._starlight(self.scene)

    @property
    def brightness_scales(self) -> list[BrightnessScale]:
        """How bright points that shine make pixels: a scale for each of `Stars` that is seen."""
        found = [] if self._starlight is None else self._starlight.peaks(self.scene)
        return [
            BrightnessScale(peak, stars.stretch, stars.soft, self._shades_of(stars))
            for stars, peak in found
        ]

    def _shades_of(self, stars: Stars) -> NDArray[np.uint8]:
        """Return pixels that points light more and more up to their peak, (m, 3).

        They have the colour of the points, if that is one, and else are white.
        """
        each = stars.color.reshape(-1, 3)
        red, green, blue = (int(part) for part in (each[0] if (each == each[0]).all() else WHITE))
        color = np.array(light_of(Color(red, green, blue), self.settings.tonemap))
        light = np.linspace(0.0, 1.0, SHADES)[:, None, None] * color
        nothing = lambda: np.zeros(light.shape[:2])  # noqa: E731
        tonemap, background = self.settings.tonemap, self.settings.background
        if is_encoded(tonemap):
            toning = Toning(tonemap, self.white, background, 255)
            return develop_toned(light, toning, nothing)[:, 0]
        return develop(light, self.white, background, nothing)[:, 0]

    @cached_property
    def error(self) -> Floats:
        """The estimated standard error of `linear`, (height, width): that of the worst channel.

        Of a pixel with one ray it says how noisy soft light is; of one with samples, how much those
        differ, whatever they show. It is rather too large than too small. For pictures that were
        relit or recoloured it is not known: NaN.
        """
        if self._error is not None:
            return self._error
        return np.zeros(self.linear.shape[:2])

    @cached_property
    def samples(self) -> NDArray[np.int32]:
        """How many rays of the camera each pixel has, int32, (height, width).

        One where the whole pixel is known to look the same, else ``settings.samples``; where these
        differ most, ``settings.edge_samples`` if that is more.
        """
        if self._samples is not None:
            return self._samples
        return np.ones(self.linear.shape[:2], np.int32)

    @cached_property
    def scene_hash(self) -> str:
        """A hash of the scene, 32 hexadecimal digits: that of the same scene loaded again."""
        return scene_hash(self._original)

    @cached_property
    def shown_hash(self) -> str | None:
        """A hash of `scene`, whose camera may have another size; None if it has the same."""
        is_same = self.scene.camera == self._original.camera
        return None if is_same else scene_hash(self.scene)

    def _relit(self, scene: Scene, lock: object) -> Self:
        """Return the picture of a scene that differs in lights and colours alone."""
        if self.partial is not None:
            message = "image: a part of a picture has the lights and colours of its render alone"
            raise RenderError(message)
        if self._relighting is None:
            message = "image: its lights were not kept; render it with keep_lights=True"
            raise RenderError(message)
        check_brightness(scene.lights)
        # The camera may have another size now, and the hash is that of the scene as it was given.
        camera = self._original.camera
        given = Scene(camera, scene.lights, scene.objects, scene.render, scene.style)
        unknown = np.full(self.linear.shape[:2], np.nan)
        raw = self._relighting(scene)
        linear = raw if self._denoising is None else self._denoising(scene, raw)
        shine = None if self._starlight is None else self._starlight(scene)
        if shine is not None:
            linear, raw = linear + shine, raw + shine
        return self._again(
            lock, _raw=raw, linear=linear, scene=scene, _error=unknown, _original=given
        )

    def _again(self, lock: object, **changes: object) -> Self:
        """Return a picture of the same view with other attributes, exposed anew."""
        other = copy.copy(self)
        of_scene = ("_orders",) if "scene" in changes else ()
        for name in ("scene_hash", "shown_hash", "with_sky", "error", "albedo", *of_scene):
            vars(other).pop(name, None)
        vars(other).update(changes, _pixels=None, locked=lock is not None)
        other.white = white_of(other.settings, other.linear, lock)
        return other
