"""Cylinders of scene files and dictionaries, single ones and with files of arrays."""

import json
import os
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from scene_text import ABSENT, changed, message_of, read
from strategies import colors, places
from test_broken_scene_files import VALUES
from test_cylinders import BLUE, COLORS, ENDS, FIVE, POINTS, RED, columns
from test_spheres import BYTE, CAMERA, COUNT
from test_spheres import columns as columns_of_spheres

import vtray
from conftest import once
from vtray import Cylinder, Cylinders, Light, OutputError, Scene, SceneError, Spheres
from vtray.scene.files.scene_file import load, loads
from vtray.scene.files.schema import scene_schema
from vtray.scene.fingerprint import scene_hash

VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
R, B = ({"r": 255, "g": 0, "b": 0}, {"r": 0, "g": 0, "b": 255})
REST = {"radius": 0.5, "color": R, "color_end": B, "lambert": 1}
WHERE = "objects[1].data: bonds.npz"
ONE = {
    "type": "cylinder",
    "start": {"x": 0, "y": 0, "z": 5},
    "end": {"x": 1, "y": 2, "z": 3},
    "radius": 0.5,
    "color": R,
    "lambert": 1,
}


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def text_of(**keys: object) -> str:
    """Return a scene file whose second object are cylinders."""
    entry = {"type": "cylinders", "data": "bonds.npz", **keys}
    return json.dumps(changed({"objects[1]": entry}))


def savez(**changed_columns: Any) -> None:
    """Write bonds.npz, with some arrays replaced, or left out where they are None."""
    arrays = {
        name: array for name, array in columns(**changed_columns).items() if array is not None
    }
    np.savez("bonds.npz", **arrays)


def scene(*objects: Any) -> Scene:
    return Scene(CAMERA, [Light((1, 2, 3), 1)], list(objects))


# ---- one cylinder


def one(**keys: object) -> str:
    """Return a scene file whose second object is a cylinder."""
    entry = {name: value for name, value in {**ONE, **keys}.items() if value is not ABSENT}
    return json.dumps(changed({"objects[1]": entry}))


def test_one_cylinder() -> None:
    expected = Cylinder((0, 0, 5), (1, 2, 3), 0.5, RED, 1)
    assert read(one()).objects[1] == expected
    assert read(one(radius=0, end=ONE["start"])).objects[1].radius == 0  # type: ignore[union-attr]
    assert VALIDATOR.is_valid(json.loads(one()))


def test_good_files_need_no_second_look(monkeypatch: pytest.MonkeyPatch) -> None:
    explain = "vtray.scene.files.scene_file._explain"
    monkeypatch.setattr(explain, lambda *_: pytest.fail("looked again"))
    read(one())
    savez(radius=None, color_end=None)
    for keys in ({"radius": 1}, {"radius": 1, "color_end": B}):
        assert len(read(text_of(**keys)).objects[1]) == COUNT  # type: ignore[arg-type]


def test_unknown_keys_are_warned_of() -> None:
    warnings: list[str] = []
    found = loads(one(color_end=B, centre=1), "room.json", warn=warnings.append)
    assert found == read(one())
    assert [warning.split(": ")[1] for warning in warnings] == [
        "objects[1].color_end",
        "objects[1].centre",
    ]
    assert 'the nearest known key is "color"' in warnings[0]


NOT_REAL = "expected a number within the range of a double, up to about 1.8e308, got 1e999"
XYZ = "expected an object with the keys x, y and z"
BAD: list[tuple[dict[str, Any], str]] = [
    ({"start": ABSENT}, f"start: missing; {XYZ}"),
    ({"end": ABSENT, "ends": ONE["end"]}, f'end: missing; {XYZ} (is "ends" meant for it?)'),
    ({"end": [0, 0, 1]}, f"end: {XYZ}, got [0, 0, 1]"),
    ({"start": {"x": 0, "y": "0", "z": 0}}, 'start.y: expected a finite number, got "0"'),
    ({"radius": -1}, "radius: expected a number ≥ 0, got -1"),
    ({"radius": ABSENT}, "radius: missing; expected a number ≥ 0"),
    ({"color": "red"}, 'color: expected an object with the keys r, g and b, got "red"'),
    ({"lambert": 1.5}, "lambert: expected a number from 0 to 1, got 1.5"),
]


@pytest.mark.parametrize(("keys", "message"), BAD, ids=range(len(BAD)))
def test_bad_cylinder(keys: dict[str, Any], message: str) -> None:
    assert message_of(one(**keys)) == f"objects[1].{message}"
    assert not VALIDATOR.is_valid(json.loads(one(**keys)))


def test_a_number_beyond_a_double() -> None:
    assert message_of(one().replace('"x": 1', '"x": 1e999')) == f"objects[1].end.x: {NOT_REAL}"


# ---- files of arrays


@pytest.mark.parametrize("left_out", [(), ("color_end",)])
def test_npz(left_out: tuple[str, ...]) -> None:
    given = columns(**dict.fromkeys(left_out))
    savez(**given)
    found = read(text_of()).objects[1]
    assert found == Cylinders(**given)
    assert (found.color_end is None) == bool(left_out)  # type: ignore[union-attr]


def test_some_in_the_file_and_some_in_the_object() -> None:
    savez(**dict.fromkeys(REST))
    expected = Cylinders(columns()["start"], columns()["end"], 0.5, RED, 1, BLUE)
    assert read(text_of(**REST)).objects[1] == expected
    savez(radius=None, color_end=None)
    expected = Cylinders(**columns(radius=2, color_end=BLUE))
    assert read(text_of(radius=2, color_end=B)).objects[1] == expected


PATH = "expected the path of a .npz file, got"
BAD_ARRAYS: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    ({}, {"data": "bonds.npy"}, f'data: {PATH} "bonds.npy"'),
    ({}, {"data": "bonds.txt"}, f'data: {PATH} "bonds.txt"'),
    ({}, {"data": None}, f"data: {PATH} null"),
    ({}, {"color_end": [1, 2, 3]}, "color_end: expected an object with the keys r, g and b, got"),
    ({}, {"color_end": None}, "color_end: expected an object with the keys r, g and b, got null"),
    ({}, {"color_end": B}, "color_end: given here and in bonds.npz; expected it in one of them"),
    ({}, {"radius": 1}, "radius: given here and in bonds.npz; expected it in one of them"),
    (
        {"start": None},
        {},
        "data: bonds.npz: start: missing; expected an array of numbers of shape (n, 3)",
    ),
    (
        {"end": None, "ends": np.zeros((5, 3))},
        {},
        "data: bonds.npz: end: missing; expected an array of numbers of shape (n, 3)"
        ' (is "ends" meant for it?)',
    ),
    (
        {"lambert": None},
        {},
        "lambert: missing; expected a number from 0 to 1, or an array lambert in bonds.npz",
    ),
    ({"start": np.zeros((3, 5))}, {}, f"data: bonds.npz: start: {POINTS} shape (3, 5) (transpose"),
    ({"end": np.zeros((4, 3))}, {}, f"data: bonds.npz: end: {ENDS} (4, 3)"),
    (
        {"end": np.full((5, 3), np.nan)},
        {},
        "data: bonds.npz: end[0, 0]: expected a finite number, got nan",
    ),
    (
        {"color_end": np.zeros((4, 3))},
        {},
        f"data: bonds.npz: color_end: {COLORS} (5, 3), {FIVE} (4, 3)",
    ),
    ({"color_end": np.full((5, 3), 256)}, {}, f"data: bonds.npz: color_end[0, 0]: {BYTE} 256"),
    (
        {"radius": np.array([None] * 5)},
        {},
        "data: bonds.npz: radius: holds Python objects; expected numbers",
    ),
]


@pytest.mark.parametrize(("arrays", "keys", "message"), BAD_ARRAYS, ids=range(len(BAD_ARRAYS)))
def test_bad_arrays(arrays: dict[str, Any], keys: dict[str, Any], message: str) -> None:
    savez(**arrays)
    np.save("bonds.npy", columns()["start"])
    assert message_of(text_of(**keys)).startswith(f"objects[1].{message}")


def test_unknown_arrays_are_warned_of() -> None:
    savez(center=np.zeros(3), colour_end=np.zeros(3))
    warnings: list[str] = []
    assert loads(text_of(), "room.json", warn=warnings.append).objects[1] == Cylinders(**columns())
    assert warnings == [
        f'room.json: {WHERE}: {name}: unknown array, ignored; the nearest known array is "{near}"'
        for name, near in (("center", "end"), ("colour_end", "color_end"))
    ]


def test_spheres_and_cylinders_each_have_their_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    savez()
    np.savez("atoms.npz", **columns_of_spheres())
    data = json.loads(text_of())
    data["objects"] += [{"type": "spheres", "data": "atoms.npz"}, ONE, data["objects"][1]]
    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", 2 * COUNT + 1)
    assert len(loads(json.dumps(data)).objects) == 5
    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", 2 * COUNT)
    left = f"start: expected fewer cylinders, got 5, {COUNT - 1} of {2 * COUNT} are left"
    assert message_of(json.dumps(data)) == f"objects[4].data: bonds.npz: {left}"
    monkeypatch.setattr("vtray.scene.files.named_arrays.MAX_SPHERES", COUNT)
    del data["objects"][3:]
    left = f"center: expected fewer spheres, got 5, {COUNT - 1} of {COUNT} are left"
    assert message_of(json.dumps(data)) == f"objects[2].data: atoms.npz: {left}"


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(["data", *REST, "color_end.r", "type"]), VALUES)
def test_any_value_anywhere_gives_a_scene_or_an_error(key: str, value: object) -> None:
    savez(**dict.fromkeys(REST))
    data = json.loads(text_of(**REST))
    inner = data["objects"][1]["color_end"] if key == "color_end.r" else data["objects"][1]
    inner[key.removeprefix("color_end.")] = value
    try:
        loads(json.dumps(data), "room.json", warn=lambda _: None)
    except SceneError as error:
        assert str(error).startswith("room.json: ")
        assert "malformed" not in str(error), "left to the words of msgspec"


# ---- writing


def test_files_of_all_kinds_are_numbered_together() -> None:
    bonds = Cylinders(**columns(start=columns()["start"].astype("f4")))
    plain = Cylinders(**columns(radius=0.1, color=(1, 2, 3), color_end=None))
    mixed = Cylinders(**columns(color_end=(4, 5, 6)))
    single = Cylinder((0, 0, 1), (1, 0, 1), 1, (1, 2, 3), 0.5)
    saved = scene(bonds, Spheres(**columns_of_spheres()), single, plain, mixed)
    saved.save("room.json")
    found = load("room.json")
    assert found == saved
    assert scene_hash(found) == scene_hash(saved)
    names = ["room-2.npz", "room-3.npz", "room-4.npz", "room.json", "room.npz"]
    assert sorted(os.listdir()) == names
    assert found.objects[0].start.dtype == np.float32  # type: ignore[union-attr]
    assert found.objects[3].color_end is None  # type: ignore[union-attr]
    entries = json.loads(Path("room.json").read_text())["objects"]
    color, end = {"r": 1, "g": 2, "b": 3}, {"r": 4, "g": 5, "b": 6}
    assert entries[3] == {
        "type": "cylinders",
        "data": "room-3.npz",
        "radius": 0.1,
        "color": color,
    }
    assert entries[4] == {"type": "cylinders", "data": "room-4.npz", "color_end": end}
    assert VALIDATOR.is_valid(json.loads(Path("room.json").read_text()))


def test_save_replaces_only_arrays_of_its_own() -> None:
    bonds = Cylinders(**columns())
    Path("room.npz").write_text("precious")
    with pytest.raises(OutputError, match="room.npz: is there already and does not belong"):
        scene(bonds).save("room.json")
    assert Path("room.npz").read_text() == "precious"
    Path("room.npz").unlink()
    scene(bonds).save("room.json")
    loaded = load("room.json")
    Path("room.json").unlink()
    loaded.save("room.json")  # read from there, they may go back there
    assert load("room.json").objects == [bonds]


def test_a_picture_does_not_replace_arrays_of_its_scene() -> None:
    from vtray.scene.arrays import check_spares_data

    scene(Cylinders(**columns())).save("room.json")
    with pytest.raises(OutputError, match=r"room.npz: holds arrays of the scene itself; choose"):
        check_spares_data(Path("room.npz"), load("room.json").objects)


# ---- dictionaries


def test_dictionaries_hold_the_arrays() -> None:
    bonds = Cylinders(**columns(color=RED, radius=0.5))
    data = scene(bonds, Cylinder((0, 0, 0), (0, 0, 1), 1)).to_dict()
    entry = data["objects"][0]
    assert list(entry) == ["type", "start", "end", "radius", "color", "lambert", "color_end"]
    assert (entry["type"], entry["color"]) == ("cylinders", R)
    assert np.shares_memory(entry["end"], bonds.end)
    assert "color_end" not in scene(bonds.replace(color_end=None)).to_dict()["objects"][0]


@pytest.mark.parametrize(
    ("changed_keys", "message"),
    [
        ({"end": ABSENT}, "end: missing; expected an array of numbers of shape (n, 3)"),
        (
            {"start": ABSENT, "starts": 1},
            "start: missing; expected an array of numbers of shape (n, 3)"
            ' (is "starts" meant for it?)',
        ),
        ({"end": np.zeros((4, 3))}, f"end: {ENDS} (4, 3)"),
        ({"color_end": {"r": 1, "g": 2, "b": 256}}, f"color_end[2]: {BYTE} 256"),
        ({"color_end": {"r": 1}}, f"color_end: expected three integers or {COLORS[27:]} (n, 3)"),
    ],
)
def test_bad_dictionaries(changed_keys: dict[str, Any], message: str) -> None:
    data = scene(Cylinders(**columns())).to_dict()
    entry = {**data["objects"][0], **changed_keys}
    data["objects"] = [{k: value for k, value in entry.items() if value is not ABSENT}]
    with pytest.raises(SceneError) as caught:
        vtray.load_dict(data, "bonds", warn=pytest.fail)
    assert str(caught.value).startswith(f"bonds: objects[0].{message}")


def test_unknown_keys_of_dictionaries() -> None:
    data = scene(Cylinders(**columns())).to_dict()
    data["objects"][0]["colour_end"] = 1
    with pytest.warns(UserWarning, match=r'colour_end: unknown key, .* key is "color_end"'):
        assert vtray.load_dict(data).objects == [Cylinders(**columns())]


# ---- there and back


def points(count: int) -> st.SearchStrategy[np.ndarray]:
    finite = {"allow_nan": False, "allow_infinity": False}
    dtypes = st.sampled_from(["f4", "f8"])
    return dtypes.flatmap(lambda dtype: arrays_of.arrays(dtype, (count, 3), elements=finite))


@st.composite
def many_cylinders(draw: st.DrawFn) -> Cylinders:
    """Cylinders of which each array may be one value, and the last be left out."""
    count = draw(st.integers(0, 4))

    def maybe(dtype: str, most: int, row: tuple[int, ...]) -> Any:
        shape = draw(st.sampled_from([(count, *row), row]))
        return draw(arrays_of.arrays(dtype, shape, elements={"min_value": 0, "max_value": most}))

    return Cylinders(
        draw(points(count)),
        draw(points(count)),
        maybe(draw(st.sampled_from(["f4", "f8"])), 1000, ()),
        maybe("u1", 255, (3,)),
        maybe("f8", 1, ()),
        draw(st.none() | st.just(maybe("u1", 255, (3,)))),
    )


ONE_CYLINDER = st.fixed_dictionaries(
    {
        "type": st.just("cylinder"),
        "start": places(1e6),
        "end": places(1e6),
        "radius": st.floats(0, 1e300),
        "color": colors(),
        "lambert": st.floats(0, 1),
    }
)


@once
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(many=st.lists(many_cylinders(), max_size=2), single=st.lists(ONE_CYLINDER, max_size=2))
def test_files_and_dictionaries_give_the_same_scene(
    many: list[Cylinders],
    single: list[dict[str, Any]],
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    document = changed({"objects": single})
    assert VALIDATOR.is_valid(document)
    made = vtray.load_dict(document)
    assert made == read(json.dumps(document))
    made.objects += many
    path = tmp_path_factory.mktemp("scene") / "room.json"
    made.save(path)
    for again in (load(path, warn=pytest.fail), vtray.load_dict(made.to_dict())):
        assert again == made
        assert scene_hash(again) == scene_hash(made)


# ---- the schema


VALID: list[dict[str, Any]] = [
    {"data": "bonds.npz"},
    {"data": "a/b.npz", **REST},
    {"data": "x.npz", "color_end": B},
]
NOT_VALID: list[dict[str, Any]] = [
    {},
    {"data": "bonds.npy", **REST},
    {"data": "bonds.npz\n"},
    {"data": "bonds.npz", "radius": -1},
    {"data": "bonds.npz", "color_end": [1, 2, 3]},
    {"data": "bonds.npz", "color_end": None},
]


@pytest.mark.parametrize(
    ("entry", "valid"), [*((e, True) for e in VALID), *((e, False) for e in NOT_VALID)]
)
def test_schema(entry: dict[str, object], valid: bool) -> None:
    document = changed({"objects[1]": {"type": "cylinders", **entry}})
    assert VALIDATOR.is_valid(document) is valid
