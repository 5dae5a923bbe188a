"""The light of points that shine, as the camera of a scene sees it: added up pixel by pixel.

It is an image of projected points, not of rays. Sums have a fixed order and nothing is taken from
a library of C, so it is the same to the last bit on every machine.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.figures.projection import Places, project
from vtray.rendering.rooms import Rooms, Wall
from vtray.scene.camera import Camera
from vtray.scene.colors.color_light import light_of_numbers
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.stars import Stars
from vtray.scene.stretch import stretched

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

PIECE = 2**19
"""Points that are looked at together."""

USUAL = (995, 1000)
"""The share of the pixels with light that are no brighter than what is white, unless it is said."""

LEAST_PEAK = 2.0**-1000
"""In parts of the largest emission; what is smaller may be none of a double."""

RIM = 2
"""Pixels around the picture that light is collected for: of points just outside of it too."""


def has_stars(scene: Scene) -> bool:
    """Tell whether something in a scene shines."""
    return any(issubclass(kind, Stars) for kind in set(map(type, scene.objects)))


def check_stars(scene: Scene, settings: RenderSettings) -> None:
    """Raise RenderError if points that shine cannot be seen as they should be."""
    if scene.camera.projection == "panorama" and has_stars(scene):
        words = "points that shine are drawn flat, and not for a panorama"
        raise RenderError(f"camera.projection: {words}; give another one, or spheres instead")
    if settings.background == "transparent" and has_stars(scene):
        words = "the light of stars is added to what is behind it"
        message = f'background: "transparent" cannot hold stars, as {words}; choose "black"'
        raise RenderError(f"{message} or a colour")


class Starlight:
    """Gives the light of all points that shine in a scene.

    Parameters
    ----------
    depth
        Gives the distance to what is seen in each pixel, as `Image.depth`; only called where there
        are stars, and something that may hide them.
    rooms
        What clip planes leave; None where there are none.
    """

    def __init__(self, depth: Callable[[], Floats], rooms: Rooms | None = None) -> None:
        self._depth = depth
        self._rooms = rooms

    def __call__(self, scene: Scene) -> Floats | None:
        """Return their light, (height, width, 3); None without any.

        Parameters
        ----------
        scene
            The scene, with the camera of the picture.
        """
        if not has_stars(scene):
            return None
        width, height = map(int, scene.camera.size)
        light = np.zeros((height, width, 3))
        hidden_behind = self._hidden_behind(scene)
        for stars in self._left(scene):
            light += _light_of(stars, scene, hidden_behind)
        return light

    def peaks(self, scene: Scene) -> list[tuple[Stars, float]]:
        """Return those points that are seen, and the light of a pixel as bright as can be.

        Parameters
        ----------
        scene
            The scene, with the camera of the picture.
        """
        hidden_behind = self._hidden_behind(scene) if has_stars(scene) else None
        found = []
        for stars in self._left(scene):
            peak = stars.peak
            if peak is None:
                peak = peak_of(stars, scene.camera, hidden_behind)
            if peak is not None:
                found.append((stars, peak))
        return found

    def _left(self, scene: Scene) -> Iterator[Stars]:
        """Give the points that no clip plane leaves out."""
        for place, item in enumerate(scene.objects):
            if isinstance(item, Stars):
                left = item if self._rooms is None else _left_of(item, self._rooms.walls_of(place))
                if len(left):
                    yield left

    def _hidden_behind(self, scene: Scene) -> Floats | None:
        """Return how far along the view what hides points is; None for nothing."""
        if all(isinstance(item, Stars) for item in scene.objects):
            return None
        return _along_view(scene.camera, self._depth())


def _left_of(stars: Stars, walls: Sequence[Wall]) -> Stars:
    """Return those points that no clip plane leaves out."""
    is_left = np.ones(len(stars), np.bool_)
    x, y, z = np.asarray(stars.center, np.float64).T
    for a, b, c, *normal in walls:
        side = (x - a) * normal[0] + (y - b) * normal[1] + (z - c) * normal[2]
        is_left &= ~(side > 0.0)
    if is_left.all():
        return stars
    columns = {name: getattr(stars, name) for name in stars.__struct_fields__}
    each = {"center": 2, "color": 2, "emission": 1}
    for name, rank in each.items():
        if getattr(columns[name], "ndim", 0) == rank:
            columns[name] = columns[name][is_left]
    return Stars(**columns)


def peak_of(stars: Stars, camera: Camera, hidden_behind: Floats | None = None) -> float | None:
    """Return the peak that points have in a picture where none is said.

    None if none of them is seen. What hides them is told as in `_add`.
    """
    if not len(stars) or not float(np.max(stars.emission)):
        return None
    inner, unit, _ = _collected(stars, camera, hidden_behind)
    usual = _usual(inner[0])
    return None if usual is None else float(np.ldexp(max(usual, LEAST_PEAK), -unit))


def _light_of(stars: Stars, scene: Scene, hidden_behind: Floats | None) -> Floats:
    """Return the light of points, (height, width, 3), from 0 to 255."""
    camera, tonemap = scene.camera, scene.render.tonemap
    width, height = map(int, camera.size)
    most = float(np.max(stars.emission))
    if most == 0.0:
        return np.zeros((height, width, 3))
    inner, unit, color = _collected(stars, camera, hidden_behind, tonemap)
    total = inner[0]
    usual = _usual(total)
    if usual is None:
        return np.zeros((height, width, 3))
    peak = float(usual if stars.peak is None else np.ldexp(stars.peak, unit))
    with np.errstate(over="ignore"):
        bright = stretched(
            np.minimum(total / max(peak, LEAST_PEAK), 1.0), stars.stretch, stars.soft
        )
    if len(inner) == 1:
        return bright[..., None] * color
    share = bright / np.where(total > 0.0, total, 1.0)
    return np.stack([np.minimum(share * channel, 255.0) for channel in inner[1:]], axis=2)


def _usual(total: Floats) -> float | None:
    """Return the light that most pixels with light do not exceed; None if there is no light."""
    lit = total[total > 0.0]
    if not len(lit):
        return None
    rank = (len(lit) * USUAL[0] - 1) // USUAL[1]
    return float(np.partition(lit, rank)[rank])


def _collected(
    stars: Stars,
    camera: Camera,
    hidden_behind: Floats | None,
    tonemap: ToneMapName = "linear",
) -> tuple[Floats, int, Floats]:
    """Return the light that adds up in each pixel.

    Returns
    -------
    light
        (1, height, width), or (4, height, width) with that of each channel where colours differ.
    unit
        It is in units of this power of two, turned over.
    color
        The colour of the first point, as light.
    """
    width, height = map(int, camera.size)
    # In units of a power of two, so that no sum overflows.
    unit = -int(np.frexp(float(np.max(stars.emission)))[1])
    color = stars.color if stars.color.ndim == 1 else stars.color[0]
    many = any(bool((stars.color[..., k] != color[k]).any()) for k in range(3))
    film = np.zeros((4 if many else 1, (height + 2 * RIM) * (width + 2 * RIM)))
    for begin in range(0, len(stars), PIECE):
        rows = slice(begin, begin + PIECE)
        given = stars.emission if isinstance(stars.emission, float) else stars.emission[rows]
        emission = np.ldexp(np.float64(given), unit)
        with np.errstate(over="ignore", invalid="ignore"):
            places = project(camera, np.asarray(stars.center[rows], np.float64))
        _add(
            film,
            places,
            emission,
            light_of_numbers(tonemap)[stars.color[rows]] if many else None,
            camera,
            hidden_behind,
        )
    inner = film.reshape(-1, height + 2 * RIM, width + 2 * RIM)[:, RIM:-RIM, RIM:-RIM]
    return inner, unit, light_of_numbers(tonemap)[color]


def _add(
    film: Floats,
    places: Places,
    emission: Floats,
    color: Floats | None,
    camera: Camera,
    hidden_behind: Floats | None,
) -> None:
    """Add the light of some points to a film.

    Parameters
    ----------
    film
        The light so far, and that of each channel where colours differ, (1 or 4, pixels with
        their rim).
    places
        Where the points are in the picture.
    emission
        Their light, (n,), or one for all.
    color
        Their colours, (n, 3), where they differ.
    camera
        The camera.
    hidden_behind
        How far from the eye along the view what hides them is, (height, width); None for nothing.

    References
    ----------
    R. W. Hockney and J. W. Eastwood, "Computer Simulation Using Particles", 1988, chapter 5: the
    triangular shaped cloud, whose nine shares add up to one and change smoothly with the place.
    """
    width, height = map(int, camera.size)
    with np.errstate(invalid="ignore"):
        inside = (places.column > -1.5) & (places.column < width + 0.5)
        inside &= (places.row > -1.5) & (places.row < height + 0.5)
        inside &= places.depth > camera.focus
    seen = np.flatnonzero(inside)
    across, down = np.rint(places.column[seen]), np.rint(places.row[seen])
    column, row = across.astype(np.int64), down.astype(np.int64)
    if hidden_behind is not None:
        behind = hidden_behind[row.clip(0, height - 1), column.clip(0, width - 1)]
        free = places.depth[seen] <= behind
        seen, across, down, column, row = (v[free] for v in (seen, across, down, column, row))
    pixel = (row + RIM) * (width + 2 * RIM) + (column + RIM)
    light = emission[seen] if emission.ndim else np.full(len(seen), float(emission))
    by_column = _shares(places.column[seen] - across)
    by_row = _shares(places.row[seen] - down)
    channels = [light]
    if color is not None:
        channels += [light * channel for channel in color[seen].T]
    for i, j in product(range(3), repeat=2):
        target = pixel + ((i - 1) * (width + 2 * RIM) + (j - 1))
        share = by_row[i] * by_column[j]
        for k, channel in enumerate(channels):
            film[k] += np.bincount(target, share * channel, film.shape[1])


def _shares(offset: Floats) -> tuple[Floats, Floats, Floats]:
    """Return what falls onto the pixel before, that itself and the one after, from -0.5 to 0.5."""
    before, after = 0.5 - offset, 0.5 + offset
    return 0.5 * (before * before), 0.75 - offset * offset, 0.5 * (after * after)


def _along_view(camera: Camera, distance: Floats) -> Floats:
    """Return how far from the eye along the view what is seen is, (height, width).

    Parameters
    ----------
    camera
        The camera.
    distance
        Along the ray of each pixel, (height, width).
    """
    if camera.projection == "orthographic":
        return distance
    height, width = distance.shape
    across = (np.arange(width) - width / 2) * (camera.resolution[0] / camera.focus)
    down = (np.arange(height) - height / 2) * (camera.resolution[1] / camera.focus)
    depth: Floats = distance / np.sqrt(across * across + (down * down)[:, None] + 1.0)
    return depth
