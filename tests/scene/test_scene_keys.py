"""The optional keys `camera.up`, `camera.projection` and `render`, and dictionaries."""

import ast
import copy
import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_text import ABSENT, TEXT, changed, message_of, read, replaced
from strategies import directions, scenes

import vtray
from conftest import once
from vtray import Camera, Color, Direction, RenderSettings, Scene, SceneError
from vtray.scene.checks.json_tree import JsonTree
from vtray.scene.files.scene_file import loads
from vtray.scene.files.schema import scene_schema
from vtray.scene.settings import FILTERS

VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
ROOT = Path(__file__).parents[2]
UP = {"x": 0, "y": 1, "z": 0}
WHITE = {"r": 255, "g": 255, "b": 255}
FULL = {
    "camera.up": UP,
    "camera.projection": "orthographic",
    "render": {
        "samples": 16.0,
        "filter": "mitchell",
        "seed": 3,
        "size": [30, 20],
        "exposure": 1.5,
        "background": WHITE,
        "stops": -0.5,
        "tonemap": "agx",
    },
}
DEFAULTS = {
    "camera.up": None,
    "camera.projection": "perspective",
    "render": {
        "samples": 1,
        "filter": "blackman-harris",
        "seed": 0.0,
        "size": None,
        "exposure": "max",
        "background": "black",
        "stops": 0.0,
        "tonemap": "linear",
    },
}


def test_all_keys() -> None:
    scene = read(json.dumps(changed(FULL)))
    assert scene.camera.up == Direction(0, 1, 0)
    assert scene.camera.projection == "orthographic"
    assert scene.render == RenderSettings(
        16, "mitchell", 3, (30, 20), 1.5, (255, 255, 255), stops=-0.5, tonemap="agx"
    )
    assert type(scene.render.samples) is int
    VALIDATOR.validate(changed(FULL))


def test_defaults_may_be_written_and_are_left_out(tmp_path: Path) -> None:
    text = json.dumps(changed(DEFAULTS))
    VALIDATOR.validate(json.loads(text))
    scene = read(text)
    assert scene == read(TEXT)
    assert scene.render == RenderSettings()
    scene.save(tmp_path / "written.json")
    read(TEXT).save(tmp_path / "plain.json")
    assert (tmp_path / "written.json").read_bytes() == (tmp_path / "plain.json").read_bytes()
    assert set(json.loads((tmp_path / "plain.json").read_text())["camera"]) == {
        "center",
        "normal",
        "focus",
        "size",
        "resolution",
    }


def test_files_of_plain_scenes_are_as_before(tmp_path: Path) -> None:
    for path in (ROOT / "scenes").glob("*.json"):
        vtray.load(path).save(tmp_path / "again.json")
        assert json.loads(path.read_text()) == json.loads((tmp_path / "again.json").read_text())


TYPES = '"sphere", "cylinder", "cone", "plane", "spheres", "cylinders", "cones" or "copies"'
PARALLEL = "expected a direction that is not parallel to normal, got"
FILTER = 'expected "box", "tent", "gaussian", "mitchell" or "blackman-harris", got'
BACKGROUND = 'expected "black", "transparent", "sky" or an object with the keys r, g and b, got'
EXPOSURE = 'expected "max", "auto" or a number > 0, got'
TONEMAP = 'expected "linear", "srgb", "filmic" or "agx", got'
STOPS = "expected a number from -100 to 100, got"
FIREFLY = 'expected "off" or a number > 0, got'
BAD_VALUES: list[tuple[str, object, str]] = [
    ("camera.up", [0, 1, 0], "expected an object with the keys x, y and z, got [0, 1, 0]"),
    ("camera.up", "y", 'expected an object with the keys x, y and z, got "y"'),
    ("camera.up", {"x": 0, "y": 0, "z": 5}, f'{PARALLEL} {{"x": 0, "y": 0, "z": 5}}'),
    (
        "camera.up",
        {"x": 0, "y": 0, "z": 0},
        'expected numbers x, y and z that are not all zero, got {"x": 0, "y": 0, "z": 0}',
    ),
    ("camera.projection", "iso", 'expected "perspective", "orthographic" or "panorama", got "iso"'),
    ("camera.projection", None, 'expected "perspective", "orthographic" or "panorama", got null'),
    ("camera.projection", 1, 'expected "perspective", "orthographic" or "panorama", got 1'),
    ("render.samples", 0, "expected an integer from 1 to 65536, got 0"),
    ("render.samples", 65537, "expected an integer from 1 to 65536, got 65537"),
    ("render.samples", 1.5, "expected an integer from 1 to 65536, got 1.5"),
    ("render.samples", "4", 'expected an integer from 1 to 65536, got "4"'),
    ("render.samples", True, "expected an integer from 1 to 65536, got true"),
    ("render.filter", "Box", f'{FILTER} "Box"'),
    ("render.seed", -1, "expected an integer from 0 to 4294967295, got -1"),
    ("render.seed", 2**32, "expected an integer from 0 to 4294967295, got 4294967296"),
    ("render.size", [1], "expected an array of two integers > 0, got [1]"),
    ("render.size", 5, "expected an array of two integers > 0, got 5"),
    ("render.exposure", 0, f"{EXPOSURE} 0"),
    ("render.exposure", "min", f'{EXPOSURE} "min"'),
    ("render.exposure", "Auto", f'{EXPOSURE} "Auto"'),
    ("render.exposure", True, f"{EXPOSURE} true"),
    ("render.stops", "1", f'{STOPS} "1"'),
    ("render.stops", None, f"{STOPS} null"),
    ("render.stops", False, f"{STOPS} false"),
    ("render.stops", 100.5, f"{STOPS} 100.5"),
    ("render.stops", -101, f"{STOPS} -101"),
    ("render.stops", [1], f"{STOPS} [1]"),
    ("render.tonemap", "AgX", f'{TONEMAP} "AgX"'),
    ("render.tonemap", "", f'{TONEMAP} ""'),
    ("render.tonemap", None, f"{TONEMAP} null"),
    ("render.tonemap", 1, f"{TONEMAP} 1"),
    ("render.tonemap", ["agx"], f'{TONEMAP} ["agx"]'),
    ("render.background", "white", f'{BACKGROUND} "white"'),
    ("render.background", [1, 2, 3], f"{BACKGROUND} [1, 2, 3]"),
    ("render.background", 7, f"{BACKGROUND} 7"),
]


@pytest.mark.parametrize(("place", "value", "problem"), BAD_VALUES)
def test_bad_values(place: str, value: object, problem: str) -> None:
    data = changed({"render": {}})
    part, key = place.split(".")
    data[part][key] = value
    assert message_of(json.dumps(data)) == f"{place}: {problem}"
    with pytest.raises(SceneError) as caught:
        vtray.load_dict(data)
    assert str(caught.value) == f"<dict>: {place}: {problem}"
    if "parallel" not in problem and value is not None:
        assert not VALIDATOR.is_valid(data)


@pytest.mark.parametrize(
    ("place", "value", "problem"),
    [
        (
            "render",
            3,
            "expected an object with the keys samples, filter, seed, size, exposure, "
            "background, tolerance, denoise, stops, tonemap, integrator, depth, firefly and "
            "edge_samples, got 3",
        ),
        (
            "render",
            None,
            "expected an object with the keys samples, filter, seed, size, exposure, "
            "background, tolerance, denoise, stops, tonemap, integrator, depth, firefly and "
            "edge_samples, got null",
        ),
        ("render.size[1]", 0, "expected an integer from 1 to 2147483647, got 0"),
        ("render.background.g", 256, "expected an integer from 0 to 255, got 256"),
        ("camera.up.y", None, "expected a finite number, got null"),
    ],
)
def test_bad_values_inside(place: str, value: object, problem: str) -> None:
    data = changed({**copy.deepcopy(FULL), place: value})
    assert message_of(json.dumps(data)) == f"{place}: {problem}"


@pytest.mark.parametrize(
    ("old", "new", "warning"),
    [
        (
            '"focus"',
            '"Up": 1, "focus"',
            'camera.Up: unknown key, ignored; the nearest known key is "up"',
        ),
        (
            '"lights"',
            '"render": {"samples": 2, "sample": 1}, "lights"',
            'render.sample: unknown key, ignored; the nearest known key is "samples"',
        ),
        (
            '"lights"',
            '"render": {"background": {"r": 1, "g": 2, "b": 3, "a": 4}}, "lights"',
            'render.background.a: unknown key, ignored; the nearest known key is "r"',
        ),
        (
            '"lights"',
            '"render": {"exposure": "max", "a": ":"}, "lights"',
            'render.a: unknown key, ignored; the nearest known key is "tonemap"',
        ),
    ],
)
def test_unknown_keys(old: str, new: str, warning: str) -> None:
    warnings: list[str] = []
    vtray.loads(replaced(old, new), "room.json", warn=warnings.append)
    vtray.load_dict(json.loads(replaced(old, new)), "room.json", warn=warnings.append)
    assert warnings == [f"room.json: {warning}"] * 2


def test_key_given_twice() -> None:
    text = replaced('"lights"', '"render": {"samples": 2, "samples": 2}, "lights"')
    assert message_of(text) == "render.samples: given twice, on line 9; expected each key once"


CODE: list[tuple[dict[str, Any], str]] = [
    ({"samples": 0}, "samples: expected an integer from 1 to 65536, got 0"),
    ({"samples": 2.5}, "samples: expected an integer from 1 to 65536, got 2.5"),
    ({"samples": "4"}, "samples: expected an integer from 1 to 65536, got '4'"),
    ({"samples": None}, "samples: expected an integer from 1 to 65536, got None"),
    ({"samples": True}, "samples: expected an integer from 1 to 65536, got True"),
    ({"samples": float("nan")}, "samples: expected a finite number, got nan"),
    ({"filter": "lanczos"}, f"filter: {FILTER} 'lanczos'"),
    ({"seed": -1}, "seed: expected an integer from 0 to 4294967295, got -1"),
    ({"size": (0, 1)}, "size[0]: expected an integer from 1 to 2147483647, got 0"),
    ({"size": 5}, "size: expected an array of two integers > 0, got 5"),
    ({"exposure": -1}, f"exposure: {EXPOSURE} -1"),
    ({"exposure": "min"}, f"exposure: {EXPOSURE} 'min'"),
    ({"exposure": float("inf")}, "exposure: expected a finite number, got inf"),
    ({"tonemap": "aces"}, f"tonemap: {TONEMAP} 'aces'"),
    ({"tonemap": 2.2}, f"tonemap: {TONEMAP} 2.2"),
    ({"tonemap": float("nan")}, "tonemap: expected a finite number, got nan"),
    ({"firefly": 0}, f"firefly: {FIREFLY} 0"),
    ({"firefly": "on"}, f"firefly: {FIREFLY} 'on'"),
    ({"edge_samples": 0}, "edge_samples: expected an integer from 1 to 65536, got 0"),
    ({"edge_samples": 2.5}, "edge_samples: expected an integer from 1 to 65536, got 2.5"),
    ({"stops": "1"}, f"stops: {STOPS} '1'"),
    ({"stops": 101}, f"stops: {STOPS} 101"),
    ({"stops": float("nan")}, "stops: expected a finite number, got nan"),
    ({"stops": float("-inf")}, "stops: expected a finite number, got -inf"),
]


@pytest.mark.parametrize(("arguments", "message"), CODE)
def test_wrong_settings(arguments: dict[str, Any], message: str) -> None:
    calls = [lambda: RenderSettings(**arguments)]
    if None not in arguments.values():
        calls.append(lambda: RenderSettings().replace(**arguments))
    for call in calls:
        with pytest.raises(SceneError) as caught:
            call()
        assert str(caught.value) == f"RenderSettings.{message}"


def test_settings() -> None:
    assert RenderSettings(np.int64(4)) == RenderSettings(samples=4.0) == RenderSettings(4)  # type: ignore[arg-type]
    assert RenderSettings(size=np.array([3, 4])).size == (3, 4)  # type: ignore[arg-type]
    assert RenderSettings(background=(0, 0, 0)) == RenderSettings()
    assert RenderSettings(background="transparent").background == "transparent"
    changed = RenderSettings(4, background="red").replace(samples=None, seed=7, size=(1, 2))
    assert changed == RenderSettings(4, seed=7, size=(1, 2), background=(255, 0, 0))
    with pytest.raises(TypeError, match="'sample' is unknown"):
        RenderSettings().replace(sample=3)
    with pytest.raises(AttributeError):
        changed.samples = 3  # type: ignore[misc]


def settings_in_files() -> st.SearchStrategy[dict[str, Any]]:
    channels = {channel: st.integers(0, 255) for channel in "rgb"}
    return st.fixed_dictionaries(
        {},
        optional={
            "samples": st.integers(1, 65536),
            "filter": st.sampled_from(FILTERS),
            "seed": st.integers(0, 2**32 - 1),
            "size": st.tuples(st.integers(1, 99), st.integers(1, 99)).map(list),
            "exposure": st.sampled_from(["max", "auto"]) | st.floats(1e-9, 1e9),
            "stops": st.floats(-100, 100),
            "tonemap": st.sampled_from(["linear", "srgb", "filmic", "agx"]),
            "background": st.sampled_from(["black", "transparent", "sky"])
            | st.fixed_dictionaries(channels),
        },
    )


def spheres_in_dictionaries() -> st.SearchStrategy[dict[str, Any]]:
    def make(count: int, dtype: str, each: bool) -> dict[str, Any]:
        random = np.random.default_rng(count)
        return {
            "type": "spheres",
            "center": random.normal(size=(count, 3)).astype(dtype),
            "radius": random.random(count) if each else 0.5,
            "color": random.integers(0, 256, (count, 3)) if each else WHITE,
            "lambert": random.random(count).astype(dtype) if each else 1,
        }

    return st.builds(make, st.integers(0, 9), st.sampled_from(["f4", "f8"]), st.booleans())


@once
@given(
    scenes(),
    st.none() | directions(),
    st.sampled_from(["perspective", "orthographic", "panorama"]),
    st.none() | settings_in_files(),
    st.lists(spheres_in_dictionaries(), max_size=3),
)
def test_dictionaries_and_files_give_equal_scenes(
    tmp_path_factory: Any, data: Any, up: Any, projection: str, render: Any, spheres: Any
) -> None:
    data["camera"]["projection"] = projection
    if up:
        data["camera"]["up"] = up
    if render is not None:
        data["render"] = render
    data["objects"] += spheres
    try:
        scene = vtray.load_dict(data, warn=pytest.fail)
    except SceneError as error:
        assert "<dict>: camera.up: expected a direction that is not parallel" in str(error)
        return
    assert vtray.load_dict(scene.to_dict(), warn=pytest.fail) == scene
    path = tmp_path_factory.mktemp("scene") / "scene.json"
    scene.save(path)
    assert vtray.load(path, warn=pytest.fail) == scene
    VALIDATOR.validate(json.loads(path.read_text()))
    if not spheres:
        assert vtray.loads(json.dumps(data), warn=pytest.fail) == scene
        assert vtray.loads(json.dumps(scene.to_dict()), warn=pytest.fail) == scene


def dictionary() -> Any:
    data = json.loads(TEXT)
    data["objects"].append(
        {
            "type": "spheres",
            "center": np.zeros((3, 3), np.float32),
            "radius": 1,
            "color": WHITE,
            "lambert": [0, 0.5, 1],
        }
    )
    return data


def test_arrays_of_dictionaries_are_shared() -> None:
    data = dictionary()
    kept = copy.deepcopy(data)
    spheres = vtray.load_dict(data).objects[2]
    assert isinstance(spheres, vtray.Spheres)
    assert np.shares_memory(spheres.center, data["objects"][2]["center"])
    assert spheres.lambert.tolist() == [0, 0.5, 1]  # type: ignore[union-attr]
    assert spheres.color.tolist() == [255, 255, 255]
    assert vtray.load_dict(data).to_dict()["objects"][2]["color"] == WHITE
    assert str(data) == str(kept), "the dictionary was changed"


def test_dictionaries_of_numpy_and_tuples() -> None:
    data = json.loads(TEXT)
    data["lights"][0]["intensity"] = np.float32(1)
    data["camera"]["size"] = np.array([256, 128])
    data["camera"]["resolution"] = (0.01, 0.02)
    data["lights"] = tuple(data["lights"])
    assert vtray.load_dict(data) == read(TEXT)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("objects[0].radius", float("nan"), "expected a finite number, got nan"),
        ("objects[0].center.x", np.float64("inf"), "expected a finite number, got inf"),
        ("camera.size", (1, float("inf")), "camera.size[1]: expected a finite number, got inf"),
        (
            "lights[0].intensity",
            10**400,
            f"expected a number within the range of a double, up to about 1.8e308, got {10**36}...",
        ),
        ("objects[0].radius", "1", 'expected a number ≥ 0, got "1"'),
        ("objects[0].radius", -2, "expected a number ≥ 0, got -2"),
        (
            "objects[1].type",
            "planet",
            f'expected {TYPES}, got "planet"; did you mean "plane"?',
        ),
        (
            "lights[0]",
            object,
            "expected a number, a text, a list or a dictionary, got <class 'object'>",
        ),
        ("objects[2].radius", -1, "expected a number ≥ 0, got -1"),
        (
            "objects[2].color",
            (1, 2),
            "expected three integers or an array of numbers of shape (3, 3), "
            "as center has shape (3, 3), got shape (2,)",
        ),
        (
            "objects[2].lambert",
            None,
            "expected a number or an array of numbers of shape (n,), got None",
        ),
    ],
)
def test_bad_dictionaries(place: str, value: Any, message: str) -> None:
    data = dictionary()
    target: Any = data
    *steps, last = place.replace("[", ".[").split(".")
    for step in steps:
        target = target[int(step[1:-1]) if step.startswith("[") else step]
    target[int(last[1:-1]) if last.startswith("[") else last] = value
    with pytest.raises(SceneError) as caught:
        vtray.load_dict(data, "mine")
    assert (
        str(caught.value)
        == f"mine: {message if message.startswith('cam') else f'{place}: {message}'}"
    )


def test_missing_and_unknown_arrays_of_dictionaries() -> None:
    data = dictionary()
    data["objects"][2]["radios"] = data["objects"][2].pop("radius")
    with pytest.raises(SceneError) as caught:
        vtray.load_dict(data)
    words = "missing; expected a number or an array of numbers of shape (n,)"
    hint = '(is "radios" meant for it?)'
    assert str(caught.value) == f"<dict>: objects[2].radius: {words} {hint}"
    data["objects"][2]["radius"] = 1
    line = 'objects[2].radios: unknown key, ignored; the nearest known key is "radius"'
    with pytest.warns(UserWarning, match="<dict>: objects") as warned:
        vtray.load_dict(data)
    assert [str(warning.message) for warning in warned] == [f"<dict>: {line}"]
    assert warned[0].filename == __file__


def test_no_dictionary() -> None:
    for data in ([], None, 3):
        with pytest.raises(SceneError, match="<dict>: expected an object with the keys camera, "):
            vtray.load_dict(data)  # type: ignore[arg-type]


def test_scene_without_a_camera(tmp_path: Path) -> None:
    scene = Scene()
    scene.add_sphere((0, 0, 0), 1)
    words = "Scene.camera: there is none; set one, for instance vtray.Camera.fit(scene)"
    for use in (scene.check, scene.to_dict, lambda: scene.save(tmp_path / "scene.json")):
        with pytest.raises(SceneError) as caught:
            use()
        assert str(caught.value) == words
    assert list(tmp_path.iterdir()) == []
    scene.camera = Camera.fit(scene)
    scene.check()
    scene.render = 3  # type: ignore[assignment]
    with pytest.raises(SceneError, match="Scene.render: expected RenderSettings, got 3"):
        scene.check()


def test_scenes_do_not_share_their_lists() -> None:
    one, two = Scene(), Scene()
    one.add_light((1, 2, 3))
    one.add_sphere((1, 2, 3), 1)
    assert (two.lights, two.objects) == ([], [])
    assert (one.lights[0].intensity, one.objects[0].color) == (1, Color(255, 255, 255))  # type: ignore[union-attr]
    assert Scene(None, one.lights) == Scene(lights=one.lights)


@pytest.mark.parametrize(
    ("call", "arguments", "message"),
    [
        (
            "add_light",
            ((1, 2),),
            "add_light: location: expected Vector or three numbers, got (1, 2)",
        ),
        ("add_light", ((1, 2, 3), -1), "Light.intensity: expected a number ≥ 0, got -1"),
        (
            "add_sphere",
            ((1, None, 3), 1),
            "add_sphere: center.y: expected a finite number, got None",
        ),
        ("add_sphere", ((1, 2, 3), -1), "Sphere.radius: expected a number ≥ 0, got -1"),
        ("add_plane", (7, (0, 0, 1)), "add_plane: point: expected Vector or three numbers, got 7"),
        (
            "add_plane",
            ((0, 0, 0), (0, 0, 0)),
            "add_plane: normal: expected numbers x, y and z that are not all zero, "
            "got (0.0, 0.0, 0.0)",
        ),
        (
            "add_plane",
            ((0, 0, 0), (0, 0, 1), "red", 2),
            "Plane.lambert: expected a number from 0 to 1, got 2",
        ),
    ],
)
def test_wrong_arguments_of_adders(call: str, arguments: Any, message: str) -> None:
    scene = Scene()
    with pytest.raises(SceneError) as caught:
        getattr(scene, call)(*arguments)
    assert str(caught.value) == message
    assert (scene.lights, scene.objects) == ([], [])


def test_import_is_light() -> None:
    slow = ["numpy", "numba", "PIL", "json", "difflib", "llvmlite", "matplotlib"]
    code = (
        "import sys, time; begin = time.perf_counter(); import vtray; "
        "seconds = time.perf_counter() - begin; "
        "camera = vtray.Camera.look_at((0, 0, 0), (0, 0, 1)); "
        "scene = vtray.Scene(camera, render=vtray.RenderSettings(4, background='#fff')); "
        "scene.add_sphere((0, 0, 5), 1, (255, 0, 0)); scene.check(); "
        f"print([name for name in {slow} if name in sys.modules], seconds < 0.5)"
    )
    run = [sys.executable, "-c", code]
    assert subprocess.run(run, capture_output=True, check=True, text=True).stdout == "[] True\n"
    listed = subprocess.run(
        [sys.executable, "-c", "import vtray; print([getattr(vtray, n) for n in vtray.__all__])"],
        capture_output=True,
        check=True,
        text=True,
    )
    assert "vtray.lights" in listed.stdout
    assert set(vtray.__all__) <= set(dir(vtray))


def test_who_reads_types_finds_all_names() -> None:
    """Editors, type checkers and the docs see what is imported for them alone."""
    source = ast.parse(Path(str(vtray.__file__)).read_text("utf-8"))
    (block,) = (node for node in source.body if isinstance(node, ast.If))
    imports = (node for node in block.body if isinstance(node, ast.ImportFrom))
    assert {name.name for node in imports for name in node.names} == set(vtray.__all__)


@pytest.mark.parametrize(
    ("change", "end"),
    [
        ({"note": "a: b"}, "more unknown keys, ignored"),
        ({"color": {"r": 1, "g": 2, "b": 3, "a": 4}}, "more unknown keys, ignored"),
        (
            {"type": "ball"},
            f'objects[9].type: expected {TYPES}, got "ball"',
        ),
        ({"radius": ABSENT}, "objects[9].radius: missing; expected a number ≥ 0"),
    ],
)
def test_of_many_mistakes_few_are_looked_at(
    change: dict[str, Any], end: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[int] = []
    slowly = JsonTree._object
    monkeypatch.setattr(JsonTree, "_object", lambda *a: read.append(1) or slowly(*a))
    data = changed({})
    ball = data["objects"][0]
    wrong = {key: value for key, value in {**ball, **change}.items() if value is not ABSENT}
    data["objects"] = [ball] * 9 + [wrong] * 2000
    said: list[str] = []
    try:
        loads(json.dumps(data), "room.json", warn=said.append)
    except SceneError as error:
        said.append(str(error))
    warned = len(said) == 21
    assert said[-1] == f"room.json: {'1980 ' if warned else ''}{end}"
    assert warned or len(said) == 1
    assert len(read) < 100


def test_a_key_given_twice_among_many_unknown_ones_is_found() -> None:
    ball = json.dumps(changed({})["objects"][0])
    odd = ball.replace('"radius"', '"note": 1, "radius"')
    twice = ball.replace('"radius"', '"radius": 2, "note": ":", "radius"')
    balls = ", ".join([odd] * 50 + [twice] + [odd])
    text = json.dumps(changed({"objects": []})).replace('"objects": []', f'"objects": [{balls}]')
    with pytest.raises(SceneError, match=r"objects\[50\].radius: given twice, on line 1;"):
        loads(text, "room.json", warn=lambda _: None)


def test_unknown_values_are_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    slowly = JsonTree._object
    monkeypatch.setattr(JsonTree, "_object", lambda *a: read.append(1) or slowly(*a))
    said: list[str] = []
    balls = [changed({})["objects"][0]] * 2000
    loads(json.dumps(changed({"extra": balls})), "room.json", warn=said.append)
    assert said == ['room.json: extra: unknown key, ignored; the nearest known key is "camera"']
    assert len(read) < 100


TOO_LARGE = "expected a number within the range of a double, up to about 1.8e308, got"


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        ('{"a": 1, "a": 2}', "extra.a: given twice, on line 1"),
        ('[{"é": 1, "é": 2}]', 'extra[0]["é"]: given twice, on line 1'),
        ('{"\\u0061": 1, "a": 2}', "extra.a: given twice, on line 1"),
        ('[{"b": [1e999]}]', f"extra[0].b[0]: {TOO_LARGE} 1e999"),
        ("-1" + "0" * 400, f"extra: {TOO_LARGE} -1000"),
        ('"\\ud800"', "half of a surrogate pair stands alone"),
    ],
)
def test_what_holds_for_unknown_values_too(extra: str, message: str) -> None:
    text = json.dumps(changed({"extra": 0})).replace('"extra": 0', f'"extra": {extra}')
    with pytest.raises(SceneError) as caught:
        loads(text, "room.json", warn=lambda _: None)
    assert message in str(caught.value)


@pytest.mark.parametrize("half", [Fraction(1, 2), np.longdouble(0.5), np.float32(0.5)])
def test_numbers_of_all_kinds_are_those_of_python(half: Any) -> None:
    scene = vtray.Scene()
    made = scene.add_sphere(np.array([half, 1, 2]), half)
    assert made == vtray.Sphere((0.5, 1.0, 2.0), 0.5)
    for number in (made.radius, made.center.x):
        assert type(number) is float
    with pytest.raises(vtray.SceneError, match="samples: expected an integer"):
        vtray.RenderSettings(samples=half)
