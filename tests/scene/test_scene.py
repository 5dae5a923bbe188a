"""Scenes made in code: the same checks and words as in a file."""

import os
import pickle
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from vtray.base.errors import OutputError, SceneError
from vtray.scene.files.scene_file import load, loads
from vtray.scene.scene import Camera, Color, Direction, Light, Plane, Scene, Sphere, Vector

CAMERA = Camera(Vector(0, 0, 0), Direction(0, 0, 1), 10, (4, 3), (0.5, 0.25))
SPHERE = Sphere(Vector(1, 2, 3), 0.1, Color(1, 2, 255), 0.3)
PLANE = Plane(Vector(0, 5, 0), Direction(0, -1, 0), Color(9, 8, 7), 1)
OBJECTS = "expected Sphere, Cylinder, Cone, Plane, Spheres, Cylinders, Cones, Copies or Stars"
LIGHTS = "expected Light, Sun, SphereLight, RectangleLight, Sky or Ambient"
LIGHT = Light(Vector(0.1, -0.0, 1e300), 1e-320)


def make(cls: Any, *arguments: Any) -> Any:
    """Call a type with arguments that its annotations do not promise, but that it takes."""
    return cls(*arguments)


def scene() -> Scene:
    return Scene(CAMERA, [LIGHT], [SPHERE, PLANE])


@pytest.mark.parametrize(
    "triple",
    [
        (1, 2, 3),
        [1.0, 2, 3],
        np.array([1, 2, 3]),
        np.array([1, 2, 3], np.float32),
        Direction(1, 2, 3),
    ],
    ids=["tuple", "list", "int array", "float32 array", "Direction"],
)
def test_three_numbers_make_a_vector(triple: Any) -> None:
    assert Light(triple, 1) == Light(Vector(1, 2, 3), 1)


def test_three_numbers_make_a_direction_and_a_color() -> None:
    plane = make(Plane, (0, 5, 0), Vector(0, -1, 0), np.array([9, 8, 7], np.uint8), 1)
    assert plane == PLANE
    assert isinstance(plane.normal, Direction)


def test_numpy_scalars_are_numbers() -> None:
    color = make(Color, np.uint8(7), np.int64(0), 1)
    sphere = make(Sphere, SPHERE.center, np.float32(0.5), color, np.int64(1))
    assert (sphere.radius, sphere.color.r, sphere.lambert) == (0.5, 7, 1.0)
    assert type(sphere.radius) is float


def test_integers_may_be_written_as_floats() -> None:
    camera = make(Camera, CAMERA.center, CAMERA.normal, 1, np.array([4.0, 3.0]), [1, 1])
    assert camera.size == (4, 3)
    assert all(type(size) is int for size in camera.size)
    assert Color(255.0, 0, 0) == Color(255, 0, 0)


@pytest.mark.parametrize(
    ("cls", "arguments", "message"),
    [
        (Sphere, ((0, 0, 0), -2.0, (0, 0, 0), 1), "Sphere.radius: expected a number ≥ 0, got -2.0"),
        (Sphere, ((0, 0, 0), "1", (0, 0, 0), 1), "Sphere.radius: expected a number ≥ 0, got '1'"),
        (Sphere, ((0, 0, 0), True, (0, 0, 0), 1), "Sphere.radius: expected a number ≥ 0, got True"),
        (
            Sphere,
            ((0, 0, 0), float("nan"), (0, 0, 0), 1),
            "Sphere.radius: expected a finite number, got nan",
        ),
        (
            Sphere,
            ((0, 0, 0), np.float64("inf"), (0, 0, 0), 1),
            "Sphere.radius: expected a finite number, got inf",
        ),
        (
            Sphere,
            ((0, 0, 0), 1, (0, 600, 0), 1),
            "Sphere.color.g: expected an integer from 0 to 255, got 600",
        ),
        (
            Sphere,
            ((0, 0), 1, (0, 0, 0), 1),
            "Sphere.center: expected Vector or three numbers, got (0, 0)",
        ),
        (
            Sphere,
            ({"x": 0, "y": 0, "z": 0}, 1, (0, 0, 0), 1),
            "Sphere.center: expected Vector or three numbers, got {'x': 0, 'y': 0, 'z': 0}",
        ),
        (
            Sphere,
            ((0, 0, 0), 1, (0, 0, 0), 1.5),
            "Sphere.lambert: expected a number from 0 to 1, got 1.5",
        ),
        (Vector, (0, -float("inf"), 0), "Vector.y: expected a finite number, got -inf"),
        (Vector, (0, 10**400, 0), "Vector.y: expected a finite number, got 1000000000"),
        (
            Vector,
            (0, 10**5000, 0),
            "Vector.y: expected a finite number, got an integer of thousands",
        ),
        (Vector, (None, 0, 0), "Vector.x: expected a finite number, got None"),
        (Color, (254.5, 0, 0), "Color.r: expected an integer from 0 to 255, got 254.5"),
        (
            Direction,
            (0, -0.0, 0),
            "Direction: expected numbers x, y and z that are not all zero, got (0.0, -0.0, 0.0)",
        ),
        (
            Plane,
            ((0, 0, 0), [0, 0, 0], (0, 0, 0), 1),
            "Plane.normal: expected numbers x, y and z that are not all zero, got (0.0, 0.0, 0.0)",
        ),
        (
            Camera,
            ((0, 0, 0), (0, 0, 1), 0, (1, 1), (1, 1)),
            "Camera.focus: expected a number > 0, got 0",
        ),
        (
            Camera,
            ((0, 0, 0), (0, 0, 1), 1, (1, 0), (1, 1)),
            "Camera.size[1]: expected an integer from 1 to 2147483647, got 0",
        ),
        (
            Camera,
            ((0, 0, 0), (0, 0, 1), 1, (1, 1, 1), (1, 1)),
            "Camera.size: expected an array of two integers > 0, got (1, 1, 1)",
        ),
        (
            Camera,
            ((0, 0, 0), (0, 0, 1), 1, 5, (1, 1)),
            "Camera.size: expected an array of two integers > 0, got 5",
        ),
        (
            Camera,
            ((0, 0, 0), (0, 0, 1), 1, (1, 1), (1, float("nan"))),
            "Camera.resolution[1]: expected a finite number, got nan",
        ),
        (Scene, (CAMERA, [LIGHT, 3], []), f"Scene.lights[1]: {LIGHTS}, got 3"),
        (Scene, (CAMERA, LIGHT, []), "Scene.lights: expected a list, got Light(location"),
        (
            Scene,
            (CAMERA, [], [{"x": 1}]),
            f"Scene.objects[0]: {OBJECTS}, got {{'x': 1}}",
        ),
        (
            Scene,
            (CAMERA, [], [LIGHT]),
            f"Scene.objects[0]: {OBJECTS}, got Light(",
        ),
        (Scene, (1, [], []), "Scene.camera: expected Camera, got 1"),
        (Scene, (CAMERA, [], [], 4), "Scene.render: expected RenderSettings, got 4"),
        (Scene, (CAMERA, None, []), "Scene.lights: expected a list, got None"),
    ],
)
def test_wrong_arguments(cls: Any, arguments: tuple[Any, ...], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        cls(*arguments)
    assert str(caught.value).startswith(message)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("arguments", "keywords", "message"),
    [
        ((1, 2), {}, "lacks the arguments z"),
        ((1, 2, 3, 4), {}, "takes 3 arguments, got 4"),
        ((1, 2, 3), {"z": 3}, "'z' is given twice"),
        ((1, 2, 3), {"w": 3}, "'w' is unknown"),
    ],
)
def test_wrong_calls_are_type_errors(arguments: Any, keywords: Any, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        Vector(*arguments, **keywords)


def test_small_objects_are_frozen() -> None:
    with pytest.raises(AttributeError):
        SPHERE.radius = 2.0  # type: ignore[misc]


def test_scene_keeps_its_own_lists() -> None:
    lights = [LIGHT]
    made = Scene(CAMERA, lights, (SPHERE,))  # type: ignore[arg-type]
    lights.clear()
    assert made.lights == [LIGHT]
    assert made.objects == [SPHERE]


def test_check_after_changes() -> None:
    changed = scene()
    changed.objects.append(SPHERE)
    changed.check()
    changed.objects.append(LIGHT)  # type: ignore[arg-type]
    with pytest.raises(
        SceneError,
        match=rf"Scene.objects\[3\]: {OBJECTS}",
    ):
        changed.check()


def test_save_and_load_give_an_equal_scene(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    scene().save(path)
    assert load(path) == scene()
    assert path.read_text().endswith("}\n")
    assert '\n  "camera": {\n' in path.read_text()
    assert [file.name for file in tmp_path.iterdir()] == ["scene.json"]


def test_pickle_and_copies() -> None:
    assert pickle.loads(pickle.dumps(scene())) == scene()
    assert msgspec.structs.replace(SPHERE, radius=3.0).radius == 3.0


def test_saved_numbers_keep_every_bit() -> None:
    text = msgspec.json.encode(scene())
    light = loads(text).lights[0]
    assert (light.location.x, light.location.z, light.intensity) == (0.1, 1e300, 1e-320)
    assert str(light.location.y) == "-0.0"


def test_save_of_a_spoilt_scene_leaves_the_file(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text("old")
    spoilt = scene()
    spoilt.lights = [None]  # type: ignore[list-item]
    with pytest.raises(SceneError, match=rf"Scene.lights\[0\]: {LIGHTS}, got None"):
        spoilt.save(path)
    assert path.read_text() == "old"


def test_save_fails_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.json"
    path.write_text("old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OutputError, match="scene.json: cannot be written: no space left on device"):
        scene().save(path)
    assert [file.name for file in tmp_path.iterdir()] == ["scene.json"]
    assert path.read_text() == "old"


def test_save_into_no_folder(tmp_path: Path) -> None:
    with pytest.raises(
        OutputError, match="scene.json: cannot be written: no such file or directory"
    ):
        scene().save(tmp_path / "none" / "scene.json")
