"""Lights of all kinds in scene files: read, refused with place and words, and written again."""

import json
import math
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_text import TEXT, changed, message_of, read, replaced
from strategies import colors, directions, places

import vtray
from conftest import once
from vtray import Ambient, Color, Gradient, Light, RectangleLight, Sky, SphereLight, Sun
from vtray.scene.checks.json_tree import JsonTree
from vtray.scene.checks.scene_check import FileChecker
from vtray.scene.files.in_file import SceneInFile
from vtray.scene.files.schema import scene_schema
from vtray.scene.fingerprint import scene_hash
from vtray.scene.light_types import AnyLight, strength_of

VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
PLACE = {"x": 1, "y": 2, "z": 3}
DOWN = {"x": 0, "y": 0, "z": -2}
RED = {"r": 255, "g": 0, "b": 0}
WHITE = {"r": 255, "g": 255, "b": 255}
SIDES = [{"x": 0, "y": 4, "z": 0}, {"x": 2, "y": 0, "z": 1e-3}]
POINT = {"location": PLACE, "intensity": 0.5}


def lit_by(*lights: object) -> str:
    """Return the valid scene with other lights, as text."""
    return json.dumps(changed({"lights": list(lights)}))


READ: list[tuple[dict[str, Any], AnyLight]] = [
    (POINT, Light((1, 2, 3), 0.5)),
    ({"type": "point", **POINT}, Light((1, 2, 3), 0.5)),
    ({**POINT, "color": RED}, Light((1, 2, 3), 0.5, (255, 0, 0))),
    ({**POINT, "color": WHITE, "type": "point"}, Light((1, 2, 3), 0.5)),
    ({"type": "sun", "direction": DOWN}, Sun((0, 0, -2), 1, 0.53)),
    (
        {"type": "sun", "direction": DOWN, "intensity": 3, "angle": 0, "color": RED},
        Sun((0, 0, -2), 3, 0, (255, 0, 0)),
    ),
    ({"angle": 180, "direction": DOWN, "type": "sun"}, Sun((0, 0, -2), angle=180)),
    ({"type": "sphere", "location": PLACE, "radius": 0}, SphereLight((1, 2, 3), 0)),
    (
        {"type": "sphere", "location": PLACE, "radius": 2, "intensity": 1, "color": RED},
        SphereLight((1, 2, 3), 2, 1, (255, 0, 0)),
    ),
    (
        {"type": "sphere", "location": PLACE, "radius": 2, "radiance": 0.5},
        SphereLight((1, 2, 3), 2, radiance=0.5),
    ),
    (
        {"type": "sphere", "location": PLACE, "radius": 2, "radiance": 1, "intensity": None},
        SphereLight((1, 2, 3), 2, radiance=1),
    ),
    (
        {"type": "rectangle", "location": PLACE, "edges": SIDES},
        RectangleLight((1, 2, 3), ((0, 4, 0), (2, 0, 1e-3))),
    ),
    (
        {"type": "rectangle", "location": PLACE, "edges": SIDES, "intensity": 1, "color": RED},
        RectangleLight((1, 2, 3), ((0, 4, 0), (2, 0, 1e-3)), color=(255, 0, 0)),
    ),
    (
        {"type": "rectangle", "location": PLACE, "edges": SIDES, "visible": True},
        RectangleLight((1, 2, 3), ((0, 4, 0), (2, 0, 1e-3)), visible=True),
    ),
    (
        {"type": "sphere", "visible": False, "location": PLACE, "radius": 2},
        SphereLight((1, 2, 3), 2),
    ),
    (
        {"radiance": 7, "edges": SIDES, "location": PLACE, "type": "rectangle"},
        RectangleLight((1, 2, 3), ((0, 4, 0), (2, 0, 1e-3)), radiance=7),
    ),
    ({"type": "sky"}, Sky()),
    ({"type": "sky", "radiance": 0.5, "color": RED}, Sky(0.5, (255, 0, 0))),
    ({"type": "sky", "gradient": {}}, Sky(gradient=Gradient())),
    ({"type": "sky", "gradient": None, "up": None}, Sky()),
    (
        {"type": "sky", "gradient": {"zenith": RED}, "up": PLACE, "rotation": -30},
        Sky(gradient=Gradient((255, 0, 0)), up=(1, 2, 3), rotation=-30),
    ),
    ({"type": "ambient"}, Ambient(1, math.inf)),
    ({"type": "ambient", "intensity": 0, "distance": 7}, Ambient(0, 7)),
    ({"type": "ambient", "distance": 5e-324, "color": WHITE}, Ambient(distance=5e-324)),
    ({"type": "ambient", "distance": 0}, Ambient(distance=0)),
]


@once
@pytest.mark.parametrize(("written", "light"), READ)
def test_what_is_read(written: dict[str, Any], light: object) -> None:
    for others in ([], [POINT], [{"type": "sky"}], [POINT, {"type": "sky"}]):
        text = lit_by(*others, written)
        assert read(text).lights[len(others) :] == [light]
        VALIDATOR.validate(json.loads(text))
        assert vtray.load_dict(json.loads(text)).lights == read(text).lights
    escaped = lit_by(written, POINT).replace('"type": "s', '"\\u0074ype": "\\u0073')
    assert read(escaped).lights == [light, Light((1, 2, 3), 0.5)]


def test_order_is_kept() -> None:
    random = [written for written, _ in READ]
    assert read(lit_by(*random)).lights == [light for _, light in READ]
    assert read(lit_by(*random[::-1])).lights == [light for _, light in READ][::-1]


TYPES = '"point", "sun", "sphere", "rectangle", "sky" or "ambient"'
VECTOR = "expected an object with the keys x, y and z"
ANGLE = "expected a number of degrees from 0 to 180, got"
SUN = {"type": "sun", "direction": DOWN}
BALL = {"type": "sphere", "location": PLACE, "radius": 1}
PANEL = {"type": "rectangle", "location": PLACE, "edges": SIDES}
ZERO = {"x": 0, "y": 0, "z": 0}
BOTH = "expected either this or the intensity, not both, got 2"

BAD: list[tuple[object, str, str]] = [
    ({}, "location", f"missing; {VECTOR}"),
    ({"type": "point", "location": PLACE}, "intensity", "missing; expected a number ≥ 0"),
    ({"intensity": 1}, "location", f"missing; {VECTOR}"),
    ({"place": PLACE, "intensity": 1}, "location", f"missing; {VECTOR}"),
    ({"direction": DOWN}, "type", f'missing; expected {TYPES}; is it "sun"?'),
    ({"location": PLACE, "radius": 1}, "type", f'missing; expected {TYPES}; is it "sphere"?'),
    ({"radiance": 1}, "type", f'missing; expected {TYPES}; is it "sphere", "rectangle" or "sky"?'),
    ({"distance": 1}, "type", f'missing; expected {TYPES}; is it "ambient"?'),
    ({**POINT, "type": "Point"}, "type", f'expected {TYPES}, got "Point"; did you mean "point"?'),
    ({"type": "sum"}, "type", f'expected {TYPES}, got "sum"; did you mean "sun"?'),
    ({"type": "area"}, "type", f'expected {TYPES}, got "area"'),
    ({"type": None}, "type", f"expected {TYPES}, got null"),
    ({"type": ["sky"]}, "type", f'expected {TYPES}, got ["sky"]'),
    ({"type": "sun"}, "direction", f"missing; {VECTOR}"),
    (
        {"type": "sun", "directoin": DOWN},
        "direction",
        f'missing; {VECTOR} (is "directoin" meant for it?)',
    ),
    (
        {"type": "sun", "direction": {"x": 0, "y": 0, "z": 0}},
        "direction",
        'expected numbers x, y and z that are not all zero, got {"x": 0, "y": 0, "z": 0}',
    ),
    ({**SUN, "direction": [0, 0, 1]}, "direction", f"{VECTOR}, got [0, 0, 1]"),
    ({**SUN, "angle": -1}, "angle", f"{ANGLE} -1"),
    ({**SUN, "angle": 180.5}, "angle", f"{ANGLE} 180.5"),
    ({**SUN, "intensity": -1}, "intensity", "expected a number ≥ 0, got -1"),
    ({**SUN, "color": None}, "color", "expected an object with the keys r, g and b, got null"),
    (
        {**POINT, "color": {**RED, "g": 256}},
        "color.g",
        "expected an integer from 0 to 255, got 256",
    ),
    ({**BALL, "radius": -0.5}, "radius", "expected a number ≥ 0, got -0.5"),
    ({"type": "sphere", "location": PLACE}, "radius", "missing; expected a number ≥ 0"),
    ({"type": "sphere", "radius": 1}, "location", f"missing; {VECTOR}"),
    ({**BALL, "location": {"x": 1, "y": 2}}, "location.z", "missing; expected a finite number"),
    ({**BALL, "intensity": 1, "radiance": 2}, "radiance", BOTH),
    ({**PANEL, "intensity": 1, "radiance": 2}, "radiance", BOTH),
    ({**PANEL, "visible": 1}, "visible", "expected true or false, got 1"),
    ({**BALL, "visible": "yes"}, "visible", 'expected true or false, got "yes"'),
    ({**PANEL, "radiance": -1}, "radiance", "expected a number ≥ 0, got -1"),
    ({"type": "rectangle", "location": PLACE}, "edges", "missing; expected two vectors"),
    (
        {**PANEL, "edges": SIDES[:1]},
        "edges",
        'expected two vectors, got [{"x": 0, "y": 4, "z": 0}]',
    ),
    ({**PANEL, "edges": [SIDES[0], 7]}, "edges[1]", f"{VECTOR}, got 7"),
    (
        {**PANEL, "edges": [SIDES[0], {"x": 1, "y": 2}]},
        "edges[1].z",
        "missing; expected a finite number",
    ),
    ({"type": "sky", "radiance": -1}, "radiance", "expected a number ≥ 0, got -1"),
    ({"type": "sky", "radiance": "1"}, "radiance", 'expected a number ≥ 0, got "1"'),
    (
        {"type": "sky", "gradient": RED["r"]},
        "gradient",
        "expected an object with the keys zenith, horizon and ground, got 255",
    ),
    (
        {"type": "sky", "gradient": {"ground": {**RED, "b": 0.5}}},
        "gradient.ground.b",
        "expected an integer from 0 to 255, got 0.5",
    ),
    ({"type": "sky", "rotation": "left"}, "rotation", 'expected a finite number, got "left"'),
    ({"type": "ambient", "distance": -1}, "distance", "expected a number ≥ 0, got -1"),
    ({"type": "ambient", "distance": None}, "distance", "expected a number ≥ 0, got null"),
    ({"type": "ambient", "distance": "inf"}, "distance", 'expected a number ≥ 0, got "inf"'),
]


@once
@pytest.mark.parametrize(("light", "place", "problem"), BAD)
def test_what_is_refused(light: object, place: str, problem: str) -> None:
    for others in ([], [POINT], [{"type": "sky"}], [POINT, {"type": "sky"}]):
        text = lit_by(*others, light)
        assert message_of(text) == f"lights[{len(others)}].{place}: {problem}"
        assert not VALIDATOR.is_valid(json.loads(text))
        with pytest.raises(vtray.SceneError) as caught:
            vtray.load_dict(json.loads(text))
        assert str(caught.value) == f"<dict>: lights[{len(others)}].{place}: {problem}"


@pytest.mark.parametrize(
    ("edges", "problem"),
    [
        ([SIDES[0], ZERO], "expected two vectors that are not zero (a tiny one will do), got"),
        ([SIDES[0], SIDES[0]], "expected two vectors at right angles to each other, got"),
        ([{**ZERO, "x": 1}, {**ZERO, "x": 2e-3, "y": 1}], "expected two vectors at right angles"),
    ],
)
def test_edges_that_make_no_rectangle(edges: object, problem: str) -> None:
    for others in ([], [POINT], [{"type": "sky"}]):
        message = message_of(lit_by(*others, {**PANEL, "edges": edges}))
        assert message.startswith(f"lights[{len(others)}].edges: {problem}")


def test_numbers_that_json_does_not_have() -> None:
    with pytest.raises(vtray.SceneError) as caught:
        vtray.load_dict(changed({"lights": [{"type": "ambient", "distance": math.inf}]}))
    assert str(caught.value) == "<dict>: lights[0].distance: expected a finite number, got inf"
    words = "expected a number within the range of a double, up to about 1.8e308, got 1e999"
    assert message_of(lit_by({"type": "sky"}).replace('"sky"', '"sky", "radiance": 1e999')) == (
        f"lights[0].radiance: {words}"
    )
    assert message_of(lit_by({"type": "sky"}).replace('"sky"', '"sky", "note": 1e999')) == (
        f"lights[0].note: {words}"
    )


@pytest.mark.parametrize(
    ("light", "key", "nearest"),
    [
        ({**POINT, "typ": "sun"}, "typ", "type"),
        ({**POINT, "note": "type"}, "note", "type"),
        ({**POINT, "type": "point", "colour": RED}, "colour", "color"),
        ({**SUN, "angel": 3}, "angel", "angle"),
        ({**SUN, "intensity": 1, "size": "a:b"}, "size", "intensity"),
        ({**BALL, "locations": PLACE}, "locations", "location"),
        ({**BALL, "radience": 2}, "radience", "radiance"),
        ({**PANEL, "edge": 2}, "edge", "edges"),
        ({"type": "sky", "intensity": 2}, "intensity", "radiance"),
        ({"type": "sky", "gradient": {"horison": RED}}, "gradient.horison", "horizon"),
        ({"type": "ambient", "distanse": 2}, "distanse", "distance"),
    ],
)
def test_unknown_keys(light: dict[str, Any], key: str, nearest: str) -> None:
    for others in ([], [POINT], [{"type": "sky"}], [{"type": "sky"}, POINT]):
        warnings: list[str] = []
        vtray.loads(lit_by(*others, light), "room.json", warn=warnings.append)
        words = f'unknown key, ignored; the nearest known key is "{nearest}"'
        assert warnings == [f"room.json: lights[{len(others)}].{key}: {words}"]


def test_unknown_keys_of_many_lights_are_all_counted() -> None:
    written = [{**light, "note": k} for k, (light, _) in enumerate(READ * 3)]
    warnings: list[str] = []
    vtray.loads(lit_by(*written), "room.json", warn=warnings.append)
    assert len(warnings) == 21
    assert warnings[-1] == f"room.json: {len(written) - 20} more unknown keys, ignored"


@pytest.mark.parametrize("others", [[], [POINT], [{"type": "sky"}]])
def test_keys_given_twice(others: list[Any]) -> None:
    for key in ('"type": "point"', '"intensity": 0.5', '"color": {"r": 1, "g": 2, "b": 3}'):
        light = {"type": "point", **POINT, "color": {"r": 1, "g": 2, "b": 3}}
        text = lit_by(*others, light)
        assert key in text
        twice = text.replace(key, f"{key}, {key}", 2)
        name = key.split('"')[1]
        first = "0" if others and key in json.dumps(others) else f"{len(others)}"
        message = f"lights[{first}].{name}: given twice, on line 1; expected each key once"
        assert message_of(twice) == message


def sides() -> st.SearchStrategy[list[dict[str, float]]]:
    """Edges of rectangles along axes, of any length."""
    lengths = st.floats(1e-300, 1e300) | st.floats(-3, -1)
    axes = st.permutations("xyz")

    def edges(axes: list[str], one: float, other: float) -> list[dict[str, float]]:
        return [{**ZERO, axes[0]: one}, {**ZERO, axes[1]: other}]

    return st.builds(edges, axes, lengths, lengths)


def all_lights() -> st.SearchStrategy[dict[str, Any]]:
    """Lights of all kinds, with and without the keys that may be left out."""
    strength = st.sampled_from([0, 1, 1.0, 0.25]) | st.floats(0, 1e300)
    color = colors() | st.just(WHITE)

    def kind(tag: str, keys: dict[str, Any], **optional: Any) -> st.SearchStrategy[dict[str, Any]]:
        return st.fixed_dictionaries(
            {"type": st.just(tag), **keys}, optional={**optional, "color": color}
        )

    place = {"location": places(10.0)}
    angle = st.sampled_from([0, 0.53, 180]) | st.floats(0, 180)
    radius, distance = st.floats(0, 1e9), st.floats(0, 1e300)
    point = {**place, "intensity": strength}
    return st.one_of(
        st.fixed_dictionaries(point, optional={"type": st.just("point"), "color": color}),
        kind("sun", {"direction": directions()}, intensity=strength, angle=angle),
        *(
            kind(*lamp, visible=st.booleans(), **{measure: strength})
            for measure in ("intensity", "radiance")
            for lamp in (
                ("sphere", {**place, "radius": radius}),
                ("rectangle", {**place, "edges": sides()}),
            )
        ),
        kind("sky", {}, radiance=strength),
        kind("ambient", {}, intensity=strength, distance=distance),
    )


@once
@given(written=st.lists(all_lights(), max_size=6))
def test_lights_saved_and_loaded_again_are_the_same(
    written: list[dict[str, Any]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    scene = read(lit_by(*written))
    VALIDATOR.validate(changed({"lights": written}))
    path = tmp_path_factory.mktemp("scene") / "scene.json"
    scene.save(path)
    VALIDATOR.validate(json.loads(path.read_text()))
    again = vtray.load(path)
    assert again.lights == scene.lights
    assert list(map(strength_of, again.lights)) == [
        item.get("radiance", item.get("intensity", 1)) for item in written
    ]
    assert scene_hash(again) == scene_hash(scene) == scene_hash(vtray.load_dict(scene.to_dict()))
    # What is saved is the shortest form, whatever was read.
    again.save(path.with_name("again.json"))
    assert path.read_bytes() == path.with_name("again.json").read_bytes()
    assert vtray.load_dict(scene.to_dict()) == scene


@st.composite
def spoilt_lights(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Lights of which some lack a key, or have one that is unknown, of another kind or wrong."""
    lights = draw(st.lists(all_lights(), max_size=3))
    keys = st.sampled_from(["type", "intensity", "radius", "direction", "color", "note", "Type"])
    values = st.sampled_from([0, 1.0, -1, "sky", "a:b", None, [], PLACE, RED, {**PLACE, "w": "::"}])
    for light in lights:
        if draw(st.booleans()):
            light[draw(keys)] = draw(values)
        if draw(st.integers(0, 4)) == 0:
            light.pop(draw(keys), None)
    return lights


@once
@given(written=spoilt_lights())
def test_a_quick_look_finds_what_a_close_one_finds(written: list[dict[str, Any]]) -> None:
    text = lit_by(*written)
    tree = JsonTree(text.encode(), {}, SceneInFile.__struct_fields__)
    checker = FileChecker(tree.line)
    warnings: list[str] = []
    try:
        checker.check(tree.read(), SceneInFile)
    except vtray.SceneError as problem:
        assert message_of(text) == str(problem)
    else:
        vtray.loads(text, "room.json", warn=warnings.append)
        assert warnings == [f"room.json: {line}" for line in checker.unknown.lines()]


def test_plain_points_are_written_as_before(tmp_path: Path) -> None:
    scene = read(lit_by({"type": "point", **POINT, "color": WHITE}, {**POINT, "color": RED}))
    plain = {"location": {"x": 1.0, "y": 2.0, "z": 3.0}, "intensity": 0.5}
    assert scene.to_dict()["lights"] == [plain, {**plain, "color": RED}]
    scene.save(tmp_path / "scene.json")
    assert json.loads((tmp_path / "scene.json").read_text())["lights"] == [
        plain,
        {**plain, "color": RED},
    ]


def test_defaults_are_left_out() -> None:
    scene = read(TEXT)
    scene.lights = [
        Sun((0, 0, -1)),
        SphereLight((1, 2, 3), 4),
        SphereLight((1, 2, 3), 4, radiance=1),
        RectangleLight((1, 2, 3), ((4, 0, 0), (0, 5, 0))),
        Sky(),
        Ambient(),
    ]
    down, place = {"x": 0.0, "y": 0.0, "z": -1.0}, {"x": 1.0, "y": 2.0, "z": 3.0}
    assert scene.to_dict()["lights"] == [
        {"type": "sun", "direction": down},
        {"type": "sphere", "location": place, "radius": 4.0},
        {"type": "sphere", "location": place, "radius": 4.0, "radiance": 1.0},
        {
            "type": "rectangle",
            "location": place,
            "edges": ({"x": 4.0, "y": 0.0, "z": 0.0}, {"x": 0.0, "y": 5.0, "z": 0.0}),
        },
        {"type": "sky"},
        {"type": "ambient"},
    ]


def test_hash_of_a_file_of_points_is_that_of_versions_without_other_lights() -> None:
    assert scene_hash(read(TEXT)) == "1395b5e8731b4c01880ed5f516c2a966"
    typed = replaced('[{"location"', '[{"type": "point", "location"')
    assert scene_hash(read(typed)) == scene_hash(read(TEXT))


def test_hash_tells_lights_apart() -> None:
    place = (1.0, 2.0, 3.0)
    lights = [
        Light(place),
        Light(place, color=(255, 255, 254)),
        SphereLight(place, 0),
        SphereLight(place, 1),
        SphereLight(place, 1, radiance=1),
        SphereLight(place, 1, visible=True),
        RectangleLight(place, ((1, 0, 0), (0, 1, 0))),
        RectangleLight(place, ((0, 1, 0), (1, 0, 0))),
        RectangleLight(place, ((0, 1, 0), (1, 0, 0)), radiance=1),
        Sun(place),
        Sun(place, angle=0),
        Sky(),
        Sky(2),
        Ambient(),
        Ambient(distance=1),
        Ambient(color=Color(1, 2, 3)),
    ]
    hashes = set()
    for light in lights:
        scene = read(TEXT)
        scene.lights = [light]
        hashes.add(scene_hash(scene))
    assert len(hashes) == len(lights)
