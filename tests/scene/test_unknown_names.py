"""Arguments and attributes that there are not: none is taken and ignored; the remedy is told."""

import copy
import inspect
import pickle
from collections.abc import Callable
from typing import Any, TypeVar

import msgspec
import pytest

import vtray

SCENE = vtray.Scene()
LIGHT = vtray.Light((0, 0, 0), 1)


@pytest.mark.parametrize(
    ("owner", "name", "message"),
    [
        (SCENE, "cmera", "Scene has no attribute 'cmera'; did you mean \"camera\"?"),
        (
            SCENE,
            "threads",
            "Scene has no attribute 'threads'; the attributes are camera, lights, objects, render",
        ),
        (
            SCENE,
            "background",
            "Scene has no attribute 'background', which is a setting of the render: vtray.render("
            "scene, background=...) or scene.render = scene.render.replace(background=...)",
        ),
        (SCENE, "samples", "Scene has no attribute 'samples', which is a setting of the render: "),
        (LIGHT, "intensty", "Light has no attribute 'intensty'; did you mean \"intensity\"?"),
        (
            LIGHT,
            "intensity",
            "Light.intensity: cannot be changed; make a new one by replace(intensity=...), "
            "and put it in the place of this one",
        ),
        (SCENE.render, "samples", "RenderSettings.samples: cannot be changed; make a new one by "),
        (vtray.Spheres([], 1, (0, 0, 0), 1), "radius", "Spheres.radius: cannot be changed; make"),
    ],
)
def test_attributes_that_cannot_be_set(owner: object, name: str, message: str) -> None:
    with pytest.raises(AttributeError) as caught:
        setattr(owner, name, 1)
    assert str(caught.value).startswith(message)


def test_scenes_keep_what_is_set_and_what_belongs_to_them() -> None:
    scene = vtray.Scene()
    scene.lights = [LIGHT]
    scene.__dict__["_kept"] = 1
    for other in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert other == scene
    assert scene.lights == [LIGHT]


@pytest.mark.parametrize(
    ("call", "keyword", "message"),
    [
        (SCENE.add_spheres, "vmin", "the limits of the colour map are clim=(low, high)"),
        (SCENE.add_spheres, "norm", "the limits of the colour map are clim=(low, high); for log"),
        (SCENE.add_spheres, "alpha", 'did you mean "opacity"?'),
        (SCENE.add_spheres, "colour", 'did you mean "color"?'),
        (SCENE.add_spheres, "radii", 'did you mean "radius"?'),
        (SCENE.add_sphere, "colour", 'did you mean "color"?'),
        (SCENE.add_plane, "center", 'did you mean "point"?'),
        (SCENE.add_light, "intensty", 'did you mean "intensity"?'),
        (SCENE.add_light, "w", "the arguments are location, intensity"),
        (vtray.render, "sample", 'did you mean "samples"?'),
        (vtray.render, "alpha", 'for a transparent background, background="transparent"'),
        (vtray.Image.recolor, "vmin", "the limits of the colour map are clim=(low, high)"),
        (vtray.Image.expose, "exposre", 'did you mean "exposure"?'),
        (vtray.Image.relight, "intensity", 'did you mean "intensities"?'),
        (vtray.Image.annotated, "tilte", 'did you mean "title"?'),
        (vtray.Image.save, "bit", 'did you mean "bits"?'),
        (vtray.trace_pixel, "samples", 'did you mean "sample"?'),
        (vtray.load, "wran", 'did you mean "warn"?'),
        (vtray.loads, "json", "the arguments are text, name, warn"),
        (vtray.load_dict, "dict", "the arguments are data, name, warn"),
        (vtray.compare, "image", "the arguments are a, b"),
        (vtray.ColorScale, "vmin", 'did you mean "low"?'),
        (vtray.ColorScale, "nancolor", 'did you mean "nan_color"?'),
        (vtray.lights.studio, "intensty", 'did you mean "intensity"?'),
        (vtray.lights.rembrandt, "sides", 'did you mean "side"?'),
        (vtray.lights.cloudy, "counts", 'did you mean "count"?'),
        (vtray.Camera.fit, "fov", 'did you mean "fov_degrees"?'),
        (vtray.Sphere, "colour", 'did you mean "color"?'),
        (vtray.Spheres, "alpha", 'did you mean "opacity"?'),
        (LIGHT.replace, "place", "the arguments are location, intensity"),
    ],
)
def test_unknown_arguments(call: Callable[..., Any], keyword: str, message: str) -> None:
    with pytest.raises(TypeError) as caught:
        call(**{keyword: 1})
    assert f"() argument {keyword!r} is unknown; {message}" in str(caught.value)


def test_what_code_may_leave_out() -> None:
    white = vtray.Color(255, 255, 255)
    assert vtray.Light((1, 2, 3)) == vtray.Light((1, 2, 3), 1)
    assert vtray.Sphere((1, 2, 3), 4) == vtray.Sphere((1, 2, 3), 4, white, 1)
    assert vtray.Plane((1, 2, 3), (0, 0, 1)) == vtray.Plane((1, 2, 3), (0, 0, 1), white, 1)
    # A file has to say it still.
    with pytest.raises(msgspec.ValidationError, match="missing required field `intensity`"):
        msgspec.json.decode(b'{"location": {"x": 0, "y": 0, "z": 0}}', type=vtray.Light)


def test_replace_checks() -> None:
    assert LIGHT.replace(intensity=2) == vtray.Light((0, 0, 0), 2)
    assert vtray.Sphere((0, 0, 0), 1).replace(center=(1, 2, 3)).center == vtray.Vector(1, 2, 3)
    with pytest.raises(vtray.SceneError, match="Light.intensity: expected a number ≥ 0, got -1"):
        LIGHT.replace(intensity=-1)


@pytest.mark.parametrize("kind", [vtray.Scene, vtray.Light, vtray.Camera, vtray.Style, vtray.Sky])
def test_type_checkers_are_told_what_a_call_makes(kind: type) -> None:
    # Where a metaclass says something else, they look at no __init__.
    call = inspect.signature(type(kind).__call__)
    made = call.return_annotation
    assert isinstance(made, TypeVar)
    assert call.parameters["cls"].annotation == type[made]
