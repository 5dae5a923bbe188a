"""How scenes look whose lights were never set: as in a studio, with a white wall behind."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

from vtray.scene.arrays import Arrays
from vtray.scene.copies import Copies
from vtray.scene.grain import tolerance_of
from vtray.scene.light_presets import studio
from vtray.scene.light_types import Ambient, AnyLight, NeverSet
from vtray.scene.objects import Plane
from vtray.scene.settings import TOLERANCE, RenderSettings, overridden
from vtray.scene.stars import Stars
from vtray.scene.studio import HasCamera
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from vtray.scene.objects import Object


SAMPLES, EDGE_SAMPLES = 4, 16
"""Rays for each pixel that needs them in default light, and for those with the sharpest edges."""


class HasLights(HasCamera, Protocol):
    """A scene, as far as its light is concerned."""

    @property
    def lights(self) -> list[AnyLight]: ...  # noqa: D102


class HasSettings(HasLights, Protocol):
    """A scene, as far as its light and its settings are concerned."""

    render: RenderSettings


def has_default_light(scene: HasLights) -> bool:
    """Tell whether the lights of a scene were never set, and none was added."""
    return isinstance(scene.lights, NeverSet) and not scene.lights


def lights_of(scene: HasLights) -> list[AnyLight]:
    """Return the lights of a checked scene; those of `vtray.lights.studio` if none were ever set.

    Without anything for a studio to be built around, planes alone, all light is ambient; points
    that shine need none, nor does what has no objects in it.
    """
    kinds = set(map(type, lit_objects(scene)))
    if not has_default_light(scene) or not kinds:
        return list(scene.lights)
    if kinds == {Plane}:
        return [Ambient()]
    return studio(scene)


def lit_objects(scene: HasCamera) -> "list[Object]":
    """Return the objects that light falls on: points that shine, and what holds none, need none."""
    return [item for item in scene.objects if not isinstance(item, Stars) and not _is_empty(item)]


def has_end(scene: HasCamera) -> bool:
    """Tell whether a camera can show the whole of something: planes have no end."""
    return any(not isinstance(item, Plane) and not _is_empty(item) for item in scene.objects)


def _is_empty(item: object) -> bool:
    """Tell whether an object is one of many that holds none."""
    if isinstance(item, Copies):
        return len(item) == 0 or all(map(_is_empty, item.objects))
    return isinstance(item, Arrays) and len(item) == 0


def settings_of(
    scene: HasSettings, given: Mapping[str, Any] = MappingProxyType({})
) -> RenderSettings:
    """Return the settings of a scene, with those that are given in place of some.

    In default light, those that have their defaults and are not given are others. It is made for an
    exposure of 1, with which colours are what they were given as, and its rims for a bright
    background. Behind points that shine, the background is black. Edges are smooth, and soft light
    has as much grain as is not seen.

    Parameters
    ----------
    scene
        The scene.
    given
        As for `overridden`.

    Raises
    ------
    SceneError
        If a value that is given is not right.
    """
    set_, asked = scene.render, overridden(scene.render, given)
    if not has_default_light(scene):
        return asked
    look: dict[str, Any] = {}
    if set_.exposure == "max":
        look["exposure"] = 1.0
    shines = any(isinstance(item, Stars) for item in scene.objects)
    if set_.background == "black" and not shines:
        look["background"] = Color(255, 255, 255)
    if set_.samples == 1:
        look["samples"] = SAMPLES
    if set_.edge_samples == 1:
        look["edge_samples"] = EDGE_SAMPLES
    if set_.tolerance == TOLERANCE and given.get("tolerance") is None and scene.camera is not None:
        width, height = asked.size or scene.camera.size
        look["tolerance"] = tolerance_of(scene, scene.camera.resized((int(width), int(height))))
    return overridden(set_.replace(**look), given)
