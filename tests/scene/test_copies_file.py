"""Copies of scene files and dictionaries, with places in the file or in one of arrays."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scene_text import ABSENT, changed, message_of, read
from strategies import copied_scenes
from test_broken_scene_files import VALUES
from test_cylinders import POINTS
from test_cylinders import columns as columns_of_cylinders
from test_cylinders_file import ONE, XYZ, many_cylinders, points
from test_spheres import CAMERA, COUNT, columns
from written_out import written_out, written_out_file

import vtray
from conftest import once
from vtray import (
    Copies,
    Cylinder,
    Cylinders,
    Light,
    OutputError,
    Scene,
    SceneError,
    Sphere,
    Spheres,
)
from vtray.scene.files.scene_file import load, loads
from vtray.scene.files.schema import scene_schema
from vtray.scene.fingerprint import scene_hash

VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
AT = np.array([(0, 0, 1), (2, 3, 4), (5, 6, 7.5)])
ROWS = [dict(zip("xyz", row, strict=True)) for row in AT.tolist()]
RED = {"r": 255, "g": 0, "b": 0}
BALL = {"type": "sphere", "center": ROWS[0], "radius": 1, "color": RED, "lambert": 1}
ATOMS = {"type": "spheres", "data": "atoms.npz"}
SPHERE = Sphere((0, 0, 1), 1, (255, 0, 0))
WHERE = "objects[1].data: places.npz"


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    np.savez("atoms.npz", **columns())
    np.savez("places.npz", at=AT)


def text_of(**keys: object) -> str:
    """Return a scene file whose second object are copies of a ball at three places."""
    entry = {"type": "copies", "objects": [BALL], "at": ROWS, **keys}
    entry = {name: value for name, value in entry.items() if value is not ABSENT}
    return json.dumps(changed({"objects[1]": entry}))


def named(data: str = "places.npz", **keys: object) -> str:
    """Return the same with the places in a file of arrays."""
    return text_of(at=ABSENT, data=data, **keys)


def scene(*objects: Any) -> Scene:
    return Scene(CAMERA, [Light((1, 2, 3), 1)], list(objects))


# ---- read


def test_places_in_the_file() -> None:
    found = read(text_of(objects=[BALL, ONE])).objects[1]
    stick = Cylinder((0, 0, 5), (1, 2, 3), 0.5, (255, 0, 0), 1)
    assert found == Copies([SPHERE, stick], AT)
    assert found.at.dtype == np.float64  # type: ignore[union-attr]
    assert read(text_of(at=[])).objects[1] == Copies(SPHERE, [])


@pytest.mark.parametrize("dtype", ["f4", "f8", "i2"])
def test_places_in_a_file_of_arrays(dtype: str) -> None:
    at = AT.astype(dtype)
    np.savez("places.npz", at=at)
    np.save("places.npy", at)
    for name in ("places.npz", "places.npy"):
        found = read(named(name)).objects[1]
        assert isinstance(found, Copies)
        assert found == Copies(SPHERE, at)
        assert found.at.dtype == (np.float32 if dtype == "f4" else np.float64)
        assert found.source == Path(name).absolute()


def test_objects_with_arrays_of_their_own() -> None:
    found = read(named(objects=[ATOMS, BALL])).objects[1]
    assert isinstance(found, Copies)
    assert found == Copies([Spheres(**columns()), SPHERE], AT)
    assert [path.name for path in found.sources()] == ["places.npz", "atoms.npz"]


def test_good_files_need_no_second_look(monkeypatch: pytest.MonkeyPatch) -> None:
    explain = "vtray.scene.files.scene_file._explain"
    monkeypatch.setattr(explain, lambda *_: pytest.fail("looked again"))
    np.savez("a:b.npz", at=AT)
    np.save("c:d.npy", columns()["center"])
    some = {"type": "spheres", "data": "c:d.npy", "radius": 1, "color": RED, "lambert": 1}
    for text in (
        text_of(),
        text_of(at=[]),
        text_of(objects=[BALL, ONE, BALL, ATOMS, some]),
        named(),
        named("a:b.npz", objects=[some, ONE]),
    ):
        assert isinstance(read(text).objects[1], Copies)


@pytest.mark.parametrize("count", [1, 30])
def test_unknown_keys_are_warned_of(count: int) -> None:
    ball = {**BALL, "colour": 1}
    copies = {"type": "copies", "objects": [BALL, ball], "at": [*ROWS, {**ROWS[0], "w": 0}]}
    text = json.dumps(changed({"objects": [{**copies, "places": {"a": 1}}] * count}))
    warnings: list[str] = []
    found = loads(text, "room.json", warn=warnings.append)
    assert found.objects == [Copies([SPHERE, SPHERE], [*AT, AT[0]])] * count
    near = "unknown key, ignored; the nearest known key is"
    assert warnings[:3] == [
        f'room.json: objects[0].objects[1].colour: {near} "color"',
        f'room.json: objects[0].at[3].w: {near} "z"',
        f'room.json: objects[0].places: {near} "type"',
    ]
    assert len(warnings) == (3 if count == 1 else 21)
    if count == 30:
        assert warnings[20] == "room.json: 70 more unknown keys, ignored"


def test_no_key_hides_behind_an_escaped_colon() -> None:
    np.savez("a:b.npz", at=AT)
    escaped = named("a:b.npz").replace("a:b", r"a\u003ab")
    warnings: list[str] = []
    loads(escaped, warn=warnings.append)
    assert warnings == []
    loads(escaped.replace('"data"', '"unknown": 1, "data"'), warn=warnings.append)
    assert len(warnings) == 1


def test_unknown_arrays_are_warned_of() -> None:
    np.savez("places.npz", at=AT, places=AT)
    np.savez("atoms.npz", **columns(), centre=1)
    warnings: list[str] = []
    loads(named(objects=[ATOMS]), "room.json", warn=warnings.append)
    ignored = "unknown array, ignored; the nearest known array is"
    assert warnings == [
        f'room.json: objects[1].objects[0].data: atoms.npz: centre: {ignored} "center"',
        f'room.json: {WHERE}: places: {ignored} "at"',
    ]


KINDS = '"sphere", "cylinder", "cone", "spheres", "cylinders" or "cones"'
PLACES = "an array of places, or the key data with the path of a .npz or .npy file"
SUM = "expected a number whose sums with all coordinates of the objects are doubles"
FAR = {**BALL, "center": {"x": 0, "y": -1e308, "z": 0}}
BAD: list[tuple[str, str]] = [
    (text_of(at=ABSENT), f"at: missing; expected {PLACES}"),
    (text_of(at=ABSENT, places=ROWS), f"at: missing; expected {PLACES}"),
    (
        text_of(data="places.npz"),
        'data: expected the places here or in at, not both, got "places.npz"',
    ),
    (text_of(at=None), "at: expected an array, got null"),
    (text_of(at={"x": 1, "y": 2, "z": 3}), 'at: expected an array, got {"x": 1, "y": 2, "z": 3}'),
    (text_of(at=[[1, 2, 3]]), f"at[0]: {XYZ}, got [1, 2, 3]"),
    (text_of(at=[ROWS[0], {"x": 1, "z": 2}]), "at[1].y: missing; expected a finite number"),
    (text_of(at=[{"x": "0", "y": 0, "z": 0}]), 'at[0].x: expected a finite number, got "0"'),
    (text_of(objects=ABSENT), "objects: missing; expected an array of at least one object"),
    (text_of(objects=[]), "objects: expected an array of at least one object, got []"),
    (text_of(objects=BALL), 'objects: expected an array of at least one object, got {"type"'),
    (text_of(objects=[None]), f'objects[0]: expected an object with "type": {KINDS}, got null'),
    (
        text_of(objects=[{"type": "plane"}]),
        f'objects[0].type: expected {KINDS}, got "plane"',
    ),
    (
        text_of(objects=[BALL, {"type": "copies", "objects": [BALL], "at": ROWS}]),
        f'objects[1].type: expected {KINDS}, got "copies"',
    ),
    (
        text_of(objects=[BALL, {**BALL, "radius": -1}]),
        "objects[1].radius: expected a number ≥ 0, got -1",
    ),
    (
        text_of(objects=[BALL, FAR], at=[ROWS[0], {"x": 0, "y": -1e308, "z": 0}]),
        f"at[1, 1]: {SUM}",
    ),
    (named("places.txt"), "data: expected the path of a .npz or .npy file, got"),
    (named("none.npy"), "data: none.npy: no such file"),
]


@pytest.mark.parametrize(("text", "message"), BAD, ids=range(len(BAD)))
def test_bad_copies(text: str, message: str) -> None:
    assert message_of(text).startswith(f"objects[1].{message}")
    is_right = "data: none.npy" in message or SUM in message  # as far as a schema can tell
    assert VALIDATOR.is_valid(json.loads(text)) is is_right


BAD_ARRAYS: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    ({}, {}, "data: places.npz: at: missing; expected an array of numbers of shape (n, 3)"),
    ({"at": AT[0]}, {}, f"data: places.npz: at: {POINTS} shape (3,)"),
    ({"at": AT * np.nan}, {}, "data: places.npz: at[0, 0]: expected a finite number, got nan"),
    ({"at": AT * 2e307}, {"objects": [FAR]}, ""),
    ({"at": AT * -2e307}, {"objects": [FAR]}, f"data: places.npz: at[2, 1]: {SUM}"),
    ({"At": AT}, {}, "data: places.npz: at: missing; expected an array of numbers of shape (n, 3)"),
]


@pytest.mark.parametrize(("arrays", "keys", "message"), BAD_ARRAYS, ids=range(len(BAD_ARRAYS)))
def test_bad_arrays(arrays: dict[str, Any], keys: dict[str, Any], message: str) -> None:
    np.savez("places.npz", **arrays)
    if message:
        assert message_of(named(**keys)).startswith(f"objects[1].{message}")
    else:
        read(named(**keys))


def test_bad_arrays_within() -> None:
    np.savez("atoms.npz", **columns(radius=-1))
    problem = "data: atoms.npz: radius: expected a number ≥ 0, got -1"
    assert message_of(named(objects=[BALL, ATOMS])) == f"objects[1].objects[1].{problem}"


def test_objects_count_once_for_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    limit = "vtray.scene.files.named_arrays.MAX_SPHERES"
    data = json.loads(named(objects=[BALL, ATOMS]))
    data["objects"].append(ATOMS)
    text = json.dumps(data)
    single = sum(item["type"] == "sphere" for item in data["objects"]) + 1
    monkeypatch.setattr(limit, 2 * COUNT + single)
    assert len(loads(text).objects) == len(data["objects"])
    monkeypatch.setattr(limit, 2 * COUNT + single - 1)
    place = f"objects[{len(data['objects']) - 1}].data: atoms.npz"
    left = f"{COUNT - 1} of {2 * COUNT + single - 1} are left"
    assert message_of(text) == f"{place}: center: expected fewer spheres, got 5, {left}"
    monkeypatch.setattr(limit, COUNT + single - 1)
    del data["objects"][2:]
    message = message_of(json.dumps(data))
    assert message.startswith("objects[1].objects[1].data: atoms.npz: center: expected fewer")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from(["type", "objects", "at", "data", "at.0", "at.0.x", "objects.0"]),
    VALUES,
    st.booleans(),
)
def test_any_value_anywhere_gives_a_scene_or_an_error(
    key: str, value: object, is_named: bool
) -> None:
    data = json.loads(named() if is_named and "at" not in key[:3] else text_of())
    *way, last = (int(part) if part.isdigit() else part for part in key.split("."))
    inner = data["objects"][1]
    for part in way:
        inner = inner[part]
    inner[last] = value
    try:
        loads(json.dumps(data), "room.json", warn=lambda _: None)
    except SceneError as error:
        assert str(error).startswith("room.json: ")
        assert "malformed" not in str(error), "left to the words of msgspec"


# ---- written


def test_files_of_all_arrays_are_numbered_together() -> None:
    copies = Copies([Spheres(**columns()), SPHERE, Cylinders(**columns_of_cylinders())], AT)
    single = Copies(SPHERE, AT.astype("f4"))
    saved = scene(copies, Spheres(**columns(radius=1)), single)
    saved.save("room.json")
    found = load("room.json", warn=pytest.fail)
    assert found == saved
    assert scene_hash(found) == scene_hash(saved)
    entries = json.loads(Path("room.json").read_text())["objects"]
    assert VALIDATOR.is_valid(json.loads(Path("room.json").read_text()))
    assert [part.get("data") for part in entries[0]["objects"]] == [
        "room.npz",
        None,
        "room-2.npz",
    ]
    assert [entry["data"] for entry in entries] == ["room-3.npz", "room-4.npz", "room-5.npz"]
    assert list(entries[2]) == ["type", "objects", "data"]
    found.save("room.json")
    assert load("room.json") == saved
    assert found.objects[2].at.dtype == np.float32  # type: ignore[union-attr]


def test_save_replaces_only_arrays_of_its_own() -> None:
    saved = scene(Copies(Spheres(**columns()), AT))
    saved.save("room.json")
    saved.save("room.json")  # named there, by the copies and within them
    Path("room.json").rename("other.json")
    with pytest.raises(OutputError, match=r"room.npz: is there already and does not belong"):
        saved.save("room.json")
    Path("room.npz").unlink()
    with pytest.raises(OutputError, match=r"room-2.npz: is there already and does not belong"):
        saved.save("room.json")
    saved.save("new.json")
    loaded = load("new.json")
    Path("new.json").unlink()
    loaded.save("new.json")  # read from there, they may go back there
    assert load("new.json") == saved


# ---- dictionaries


def test_dictionaries_hold_the_arrays() -> None:
    copies = Copies([SPHERE, Spheres(**columns())], AT)
    data = scene(copies).to_dict()
    (entry,) = data["objects"]
    assert list(entry) == ["type", "objects", "at"]
    assert np.shares_memory(entry["at"], AT)
    assert entry["objects"][1]["type"] == "spheres"
    found = vtray.load_dict(data, warn=pytest.fail).objects[0]
    assert found == copies
    assert np.shares_memory(found.at, AT)  # type: ignore[union-attr]
    entry["at"] = ROWS
    assert vtray.load_dict(data, warn=pytest.fail).objects == [copies]
    for at in (AT.tolist(), tuple(map(tuple, AT)), ROWS):
        data["objects"] = [{"type": "copies", "objects": (ATOMS,), "at": at}]
        expected = Copies(Spheres(**columns()), AT)
        assert vtray.load_dict(data, warn=pytest.fail).objects == [expected]
    data["objects"] = [{"type": "copies", "objects": [entry["objects"][1]], "data": "places.npz"}]
    (found,) = vtray.load_dict(data, warn=pytest.fail).objects
    assert found == expected
    assert found.source == Path("places.npz").absolute()  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"at": AT[:, :2]}, f"at: {POINTS} shape (3, 2)"),
        ({"at": AT + np.inf}, "at[0, 0]: expected a finite number, got inf"),
        ({"at": [(0, 0, 0), (0, 1)]}, "at: expected an array of numbers of shape (n, 3), got"),
        ({"at": 5}, "at: expected an array, got 5"),
        ({"at": "abc"}, 'at: expected an array, got "abc"'),
        ({"at": AT, "data": "places.npz"}, "data: expected the places here or in at, not both"),
        ({"at": ABSENT}, f"at: missing; expected {PLACES}"),
        ({"objects": []}, "objects: expected an array of at least one object, got []"),
        ({"objects": 3}, "objects: expected an array of at least one object, got 3"),
        (
            {"objects": [{"type": "spheres", "center": AT, "radius": -1, "color": (1, 2, 3)}]},
            "objects[0].lambert: missing; expected a number or an array of numbers",
        ),
        (
            {
                "objects": [
                    BALL,
                    {**ATOMS, "data": ABSENT, "center": AT, "color": (1, 2, 3), "radius": -1}
                    | {"lambert": 1},
                ]
            },
            "objects[1].radius: expected a number ≥ 0, got -1",
        ),
        (
            {"objects": [{"type": "copies", "objects": [BALL], "at": AT}]},
            f'objects[0].type: expected {KINDS}, got "copies"',
        ),
    ],
)
def test_bad_dictionaries(keys: dict[str, Any], message: str) -> None:
    entry = {"type": "copies", "objects": [BALL], "at": AT, **keys}
    entry = {name: value for name, value in entry.items() if value is not ABSENT}
    if isinstance(entry["objects"], list):
        entry["objects"] = [
            {k: v for k, v in part.items() if v is not ABSENT} for part in entry["objects"]
        ]
    data = {**scene().to_dict(), "objects": [entry]}
    with pytest.raises(SceneError) as caught:
        vtray.load_dict(data, "cell", warn=pytest.fail)
    assert str(caught.value).startswith(f"cell: objects[0].{message}")


def test_unknown_keys_of_dictionaries() -> None:
    data = scene(Copies(Spheres(**columns()), AT)).to_dict()
    data["objects"][0]["objects"][0]["colour"] = 1
    data["objects"][0]["places"] = 1
    warnings: list[str] = []
    vtray.load_dict(data, "cell", warn=warnings.append)
    assert [line.split(": ")[1] for line in warnings] == [
        "objects[0].places",
        "objects[0].objects[0].colour",
    ]


# ---- there and back


@once
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    document=copied_scenes(),
    many=st.lists(many_cylinders(), max_size=2),
    at=st.integers(0, 3).flatmap(points),
)
def test_files_and_dictionaries_give_the_same_scene(
    document: dict[str, Any],
    many: list[Cylinders],
    at: np.ndarray,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    plain = json.loads(json.dumps(document), object_hook=without_ends)
    assert VALIDATOR.is_valid(plain)
    made = vtray.load_dict(plain)
    assert made == read(json.dumps(plain))
    written = Scene(made.camera, made.lights, written_out(made.objects))
    assert written == vtray.load_dict(written_out_file(plain))
    try:
        made.add_copies([*many, SPHERE], at)
    except SceneError as problem:
        assert SUM in str(problem)
    path = tmp_path_factory.mktemp("scene") / "room.json"
    made.save(path)
    for again in (load(path, warn=pytest.fail), vtray.load_dict(made.to_dict())):
        assert again == made
        assert scene_hash(again) == scene_hash(made)


def without_ends(item: dict[str, Any]) -> dict[str, Any]:
    """Return a part of a scene without colours that only arrays have."""
    return {key: value for key, value in item.items() if key != "color_end"}
