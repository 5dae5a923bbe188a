"""What moves in a movie, picture by picture: the camera, clip planes, opacities.

Each may be one for all pictures, a function of their numbers, or keyframes.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from vtray.animation.between_cameras import between_cameras
from vtray.animation.between_planes import between_clips, between_slices
from vtray.animation.fading import Opacity, between_opacities, opacity_of
from vtray.animation.keyframes import Keyframes, numbers_of
from vtray.base.errors import SceneError
from vtray.scene.camera import Camera
from vtray.scene.checks.scene_words import show
from vtray.scene.clip import Slice
from vtray.scene.placing.directions import Vec
from vtray.scene.style import Style, taken

Way = Callable[[int], Any]
"""Gives what something is in a picture, by its number."""

STYLE = ("clip", "slice")
"""The parts of a style that can move."""


class Moved(NamedTuple):
    """What is said of a picture alone.

    Attributes
    ----------
    camera
        Its camera; None for that of the scene.
    opacity
        How opaque its objects are; None for as they are.
    style
        Parts of its style, by their names.
    """

    camera: Camera | None = None
    opacity: Opacity | None = None
    style: Mapping[str, Any] = {}


@dataclass(frozen=True)
class Moving:
    """What moves in a movie.

    Attributes
    ----------
    ways
        How ``camera``, ``clip``, ``slice`` and ``opacity`` move, as far as that is said.
    """

    ways: Mapping[str, Way] = field(default_factory=dict)

    def __call__(self, k: int) -> Moved:
        """Return what is said of a picture."""
        found = {name: way(k) for name, way in self.ways.items()}
        style = {name: found[name] for name in STYLE if name in found}
        return Moved(found.get("camera"), found.get("opacity"), style)


def is_moving(given: object) -> bool:
    """Tell whether a part of a style is a function or keyframes: those of a plane have names."""
    if isinstance(given, Mapping):
        return not given or not all(isinstance(key, str) for key in given)
    return callable(given)


def last_of(**given: object) -> int | None:
    """Return the number of the last picture that any keyframes name; None if there are none."""
    numbers = [numbers_of(name, one)[-1] for name, one in given.items() if isinstance(one, Mapping)]
    return int(max(numbers)) if numbers else None


def way_of_cameras(given: object, pivot: Callable[[], Vec]) -> Way:
    """Return how a camera moves; keyframes turn about what `pivot` gives."""
    if callable(given):
        return _Each(given, _camera)
    if isinstance(given, Camera):
        return _Each(lambda _: given, _camera)
    if isinstance(given, Mapping):
        numbers_of("camera", given)
        cameras = {number: _key(camera, number) for number, camera in given.items()}
        return Keyframes("camera", cameras, partial(between_cameras, pivot=pivot()))
    words = "expected a Camera, cameras by the numbers of pictures, or a function of these"
    raise SceneError(f"camera: {words}, got {show(given)}")


def way_of_opacity(given: Any) -> Way:  # noqa: ANN401
    """Return how opacities move."""
    if isinstance(given, Mapping):
        numbers_of("opacity", given)
        each = {n: opacity_of(one, f"opacity[{n}]") for n, one in given.items()}
        return Keyframes("opacity", each, between_opacities)
    if callable(given):
        return _Each(given, lambda one, k: opacity_of(one, f"opacity of picture {k}"))
    found = opacity_of(given, "opacity")
    return lambda _: found


def way_of_part(name: str, given: Any) -> Way:  # noqa: ANN401
    """Return how a part of the style moves, one of `STYLE`."""
    if not isinstance(given, Mapping):
        return _Each(given, lambda one, k: taken(Style, name, one, f"{name} of picture {k}"))
    numbers_of(name, given)
    each = {n: taken(Style, name, one, f"{name}[{n}]") for n, one in given.items()}
    if name == "clip":
        return Keyframes(name, each, between_clips)
    for number, one in each.items():
        if not isinstance(one, Slice):
            raise SceneError(f"{name}[{number}]: expected a slab, got {show(one)}")
    return Keyframes(name, each, between_slices)


class _Each:
    """What a function gives, checked."""

    def __init__(self, function: Way, check: Callable[[Any, int], Any]) -> None:
        self._function, self._check = function, check

    def __call__(self, k: int) -> Any:  # noqa: ANN401
        return self._check(self._function(k), k)


def _camera(found: object, k: int) -> Camera:
    if not isinstance(found, Camera):
        raise SceneError(f"camera: expected a Camera for picture {k}, got {show(found)}")
    return found


def _key(found: object, number: float) -> Camera:
    if not isinstance(found, Camera):
        raise SceneError(f"camera[{number}]: expected a Camera, got {show(found)}")
    return found
