"""Materials that a scene file names at its top."""

import copy
import json
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import vtray
from conftest import once
from vtray.scene.fingerprint import scene_hash
from vtray.scene.materials import MaterialName

RUBY = {"type": "glass", "ior": 1.76}
SCHEMA = Path(__file__).parents[2] / "docs" / "scene.schema.json"


def ball(material: Any) -> dict[str, Any]:
    zero = {"x": 0, "y": 0, "z": 0}
    color = {"r": 255, "g": 99, "b": 71}
    ball = {"type": "sphere", "center": zero, "radius": 1, "color": color, "lambert": 1}
    return {**ball, "material": material}


def scene(*materials: Any, **changed: Any) -> dict[str, Any]:
    """Return a scene of balls of some materials, and one of ruby that is copied."""
    copies = {"type": "copies", "objects": [ball("ruby")], "at": [{"x": 1, "y": 2, "z": 3}]}
    return {
        "camera": {
            "center": {"x": 0, "y": 0, "z": -6},
            "normal": {"x": 0, "y": 0, "z": 1},
            "focus": 1,
            "size": [24, 16],
            "resolution": [0.02, 0.02],
        },
        "materials": {"ruby": RUBY, "water": {"type": "glass", "ior": 1.33}, "chrome": "mirror"},
        "lights": [],
        "objects": [*map(ball, materials), copies],
        **changed,
    }


def written_out(value: Any, named: dict[str, Any]) -> Any:
    """Return a scene with what stands for each name in its place."""
    if isinstance(value, list):
        return [written_out(one, named) for one in value]
    if not isinstance(value, dict):
        return value
    return {
        key: named.get(one, one) if key == "material" and isinstance(one, str)
        else written_out(one, named)
        for key, one in value.items()
        if key != "materials"
    }  # fmt: skip


def test_are_as_if_written_where_they_are_named() -> None:
    given = scene("ruby", "metal", "water", "chrome", RUBY)
    plain = written_out(given, given["materials"])
    assert "ruby" not in json.dumps(plain)
    assert vtray.loads(json.dumps(given)) == vtray.loads(json.dumps(plain))
    assert vtray.load_dict(given) == vtray.load_dict(plain)


@once
def test_are_those_of_blends_too() -> None:
    blend = {"type": "blend", "first": "ruby", "second": "chrome", "weight": 0.25}
    given = scene(blend, "speckled")
    given["materials"]["speckled"] = {"type": "blend", "first": "glass", "second": "lambert"}
    for read in (lambda: vtray.loads(json.dumps(given)), lambda: vtray.load_dict(given)):
        one, other = (item.material for item in read().objects[:2])
        assert one == vtray.Blend(vtray.Glass(1.76), "mirror", 0.25)
        assert other == vtray.Blend("glass", "lambert")
    jsonschema.validate(given, json.loads(SCHEMA.read_text(encoding="utf-8")))


@once
def test_blends_of_the_table_may_name_others() -> None:
    given = scene("wet", "mixed")
    given["materials"]["wet"] = {"type": "blend", "first": "water", "second": "chrome"}
    given["materials"]["mixed"] = {"type": "blend", "first": "ruby", "second": "lambert"}
    for read in (lambda: vtray.loads(json.dumps(given)), lambda: vtray.load_dict(given)):
        one, other = (item.material for item in read().objects[:2])
        assert one == vtray.Blend(vtray.Glass(1.33), "mirror")
        assert other == vtray.Blend(vtray.Glass(1.76), "lambert")
    jsonschema.validate(given, json.loads(SCHEMA.read_text(encoding="utf-8")))
    given["materials"]["mixed"]["first"] = "wet"
    with pytest.raises(vtray.SceneError, match=r"materials\.mixed\.first: expected .*got \"wet\""):
        vtray.loads(json.dumps(given))
    given["materials"]["mixed"]["first"] = "watr"
    with pytest.raises(vtray.SceneError, match=r"materials\.mixed\.first: .*did you mean \"water"):
        vtray.load_dict(given)


def test_may_be_named_like_those_that_all_files_know() -> None:
    given = scene("glass", "metal", materials={"glass": RUBY, "ruby": "mirror"})
    found = [item.material for item in vtray.loads(json.dumps(given)).objects[:2]]
    assert found == [vtray.Glass(1.76), "metal"]


def test_change_nothing_else() -> None:
    given = scene("ruby", "water")
    place = {"x": 0.1 + 0.2, "y": -0.0, "z": 123456789012345678901234567890}
    given["objects"][0]["center"] = place
    plain = written_out(given, given["materials"])
    text = json.dumps(given).replace("-0.0", "-0e-7")
    found, wanted = (vtray.loads(one).objects[0] for one in (text, json.dumps(plain)))
    assert found == wanted
    assert repr(found.center) == repr(wanted.center)


def test_are_those_of_arrays_too(tmp_path: Path) -> None:
    np.savez(tmp_path / "balls.npz", center=np.eye(3), radius=1, material_index=[0, 1, 0])
    color = {"r": 1, "g": 2, "b": 3}
    balls = {"type": "spheres", "color": color, "lambert": 1, "material": ["ruby", "chrome"]}
    given = scene()
    given["objects"].append({**balls, "data": "balls.npz"})
    (tmp_path / "scene.json").write_text(json.dumps(given))
    (read,) = vtray.load(tmp_path / "scene.json").objects[1:]
    assert read.material == (vtray.Glass(1.76), "mirror")
    arrays = {"center": np.eye(3), "radius": 1.0, "material_index": np.array([0, 1, 0])}
    given["objects"][-1] = {**balls, **arrays}
    assert vtray.load_dict(given).objects[1] == read


def test_unknown_keys_are_told_once() -> None:
    given = scene("ruby")
    given["materials"]["ruby"] = {**RUBY, "iorr": 2}
    given["extra"] = 1
    problems: list[str] = []
    vtray.loads(json.dumps(given), warn=problems.append)
    assert [problem.split(":")[1] for problem in problems] == [" materials.ruby.iorr", " extra"]


@once
def test_fit_the_schema() -> None:
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    balls = {"type": "spheres", "data": "balls.npz", "material": ["ruby", "chrome", RUBY]}
    given = scene("ruby", RUBY)
    jsonschema.validate({**given, "objects": [*given["objects"], balls]}, schema)
    for wrong in ({"ruby": {"type": "glass", "ior": 0}}, {"ruby": 3}, ["ruby"]):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(scene("ruby", materials=wrong), schema)


def _change(*path: Any, to: Any) -> Callable[[dict[str, Any]], None]:
    def change(given: Any) -> None:
        for key in path[:-1]:
            given = given[key]
        given[path[-1]] = to

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            _change("objects", 0, "material", to="rubi"),
            'objects[0].material: expected "chrome", "ruby", "water", "lambert", "mirror", '
            '"glass", "metal", "plastic", "emissive" or an object with one of these or "blend" as '
            'its "type", '
            'got "rubi"; did you mean "ruby"?',
        ),
        (_change("objects", 2, "objects", 0, "material", to="?"), "objects[2].objects[0].material"),
        (_change("objects", 1, "material", to=3), "objects[1].material: expected"),
        (_change("objects", 1, "radius", to=-1), "objects[1].radius: expected a number ≥ 0"),
        (
            _change("objects", 0, "material", to={"type": "blend", "first": "ruby"}),
            "objects[0].material.second: missing",
        ),
        (
            _change(
                "objects", 0, "material", to={"type": "blend", "first": "rubi", "second": "glass"}
            ),
            'objects[0].material.first: expected "chrome", "ruby"',
        ),
        (
            _change("materials", "ruby", to={"type": "glass", "thin": True, "roughness": 0.5}),
            "materials.ruby.roughness: expected 0 for glass that is thin, got 0.5",
        ),
        (
            _change("objects", 0, "material", to={"type": "metal", "roughness": 1.5}),
            "objects[0].material.roughness: expected a number from 0 to 1, got 1.5",
        ),
        (_change("materials", "ruby", "ior", to=0), "materials.ruby.ior: expected a number from"),
        (_change("materials", "ruby", to="water"), 'materials.ruby: expected "lambert", "mirror"'),
        (_change("materials", "ruby", to=None), 'materials.ruby: expected "lambert", "mirror"'),
        (
            _change("materials", to=[RUBY]),
            "materials: expected an object with a material for each name, got",
        ),
        (_change("materials", to={}), "objects[0].material: expected "),
    ],
)
def test_what_is_wrong_is_told(change: Callable[[dict[str, Any]], None], message: str) -> None:
    given = copy.deepcopy(scene("ruby", "chrome"))
    change(given)
    for read in (lambda: vtray.loads(json.dumps(given)), lambda: vtray.load_dict(given)):
        with pytest.raises(vtray.SceneError) as problem:
            read()
        assert message in str(problem.value)


def test_each_name_is_given_once() -> None:
    text = json.dumps(scene("ruby"), indent=1).replace('"chrome":', '"ruby":')
    lines = [k for k, line in enumerate(text.split("\n"), 1) if '"ruby":' in line]
    words = f"materials.ruby: given twice, on lines {lines[0]} and {lines[1]}"
    with pytest.raises(vtray.SceneError, match=words):
        vtray.loads(text)


def test_who_takes_materials_says_which() -> None:
    classes = "Sphere", "Cylinder", "Cone", "Plane", "Spheres", "Cylinders", "Cones"
    methods = "add_sphere", "add_cylinder", "add_cone", "add_plane"
    takers = [getattr(vtray, name) for name in classes]
    for taker in (*takers, *(getattr(vtray.Scene, name) for name in methods)):
        missing = [
            name for name in typing.get_args(MaterialName) if f'"{name}"' not in taker.__doc__
        ]
        assert not missing, taker.__name__


def test_several_matt_materials_are_saved(tmp_path: Path) -> None:
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0), (1, 0, 0)], 0.5)
    scene.objects[0] = scene.objects[0].replace(
        material=("lambert", "lambert"), material_index=[0, 1]
    )
    scene.add_light((0, 0, 9))
    scene.camera = vtray.Camera.fit(scene)
    scene.save(tmp_path / "two.json")
    for again in (vtray.load(tmp_path / "two.json"), vtray.load_dict(scene.to_dict())):
        assert again.objects == scene.objects
        assert scene_hash(again) == scene_hash(scene)
