"""Scene files that are refused: the place and the words of each error."""

import json
from typing import Any

import pytest
from scene_text import ABSENT, changed, message_of, replaced

from vtray.base.errors import SceneError
from vtray.scene.files.scene_file import loads
from vtray.scene.scene import Scene

TYPES = '"sphere", "cylinder", "cone", "plane", "spheres", "cylinders", "cones" or "copies"'
OBJECT = f'expected an object with "type": {TYPES}, got'
TYPE = f"expected {TYPES}, got"
LIGHT = (
    "expected an object with the keys location and intensity, "
    'or with "type": "sun", "sphere", "rectangle", "sky" or "ambient", got'
)
BYTE = "expected an integer from 0 to 255, got"
SIZE = "expected an integer from 1 to 2147483647, got"
DIRECTION = "expected numbers x, y and z that are not all zero, got"
NO_VECTOR = "missing; expected an object with the keys x, y and z"
NO_CAMERA = "missing; expected an object with the keys center, normal, focus, size and resolution"

# Each value is put at its place in the valid scene.
BAD_VALUES: list[tuple[str, object, str]] = [
    ("objects[1].color.r", 600, f"{BYTE} 600"),
    ("objects[0].color.b", -1, f"{BYTE} -1"),
    ("objects[0].color.b", 254.5, f"{BYTE} 254.5"),
    ("objects[0].color.b", True, f"{BYTE} true"),
    ("objects[0].color.b", "255", f'{BYTE} "255"'),
    ("objects[0].color", [1, 2, 3], "expected an object with the keys r, g and b, got [1, 2, 3]"),
    ("objects[0].radius", -2.0, "expected a number ≥ 0, got -2.0"),
    ("objects[0].radius", None, "expected a number ≥ 0, got null"),
    ("objects[0].radius", ABSENT, "missing; expected a number ≥ 0"),
    ("objects[0].lambert", 1.5, "expected a number from 0 to 1, got 1.5"),
    ("objects[0].lambert", "x" * 50, f'expected a number from 0 to 1, got "{"x" * 36}...'),
    ("objects[1].normal", ABSENT, NO_VECTOR),
    ("objects[1].normal", {"x": 0, "y": 0, "z": 0}, f'{DIRECTION} {{"x": 0, "y": 0, "z": 0}}'),
    ("objects[0].type", "cube", f'{TYPE} "cube"'),
    ("objects[1].type", "planet", f'{TYPE} "planet"; did you mean "plane"?'),
    ("objects[1].type", "$.objects[0]", f'{TYPE} "$.objects[0]"'),
    ("objects[1].type", ["plane"], f'{TYPE} ["plane"]'),
    ("objects[1].type", 7, f"{TYPE} 7"),
    (
        "objects[1].type",
        ABSENT,
        f"missing; expected {TYPES}",
    ),
    ("objects[1]", [1, 2, [3, [4]]], f"{OBJECT} [1, 2, [3, [...]]]"),
    ("objects[1]", None, f"{OBJECT} null"),
    ("objects", {"a": 1}, 'expected an array, got {"a": 1}'),
    ("objects", "none", 'expected an array, got "none"'),
    ("lights", 5, "expected an array, got 5"),
    ("lights", ABSENT, "missing; expected an array"),
    ("lights[0]", [1, 2, 3, 4, 5], f"{LIGHT} [1, 2, 3, 4, ...]"),
    ("lights[0].intensity", -0.5, "expected a number ≥ 0, got -0.5"),
    ("lights[0].location.z", ABSENT, "missing; expected a finite number"),
    ("camera", ABSENT, NO_CAMERA),
    ("camera.focus", ABSENT, "missing; expected a number > 0"),
    ("camera.focus", 0, "expected a number > 0, got 0"),
    ("camera.normal", {"z": 0, "y": -0.0, "x": 0}, f'{DIRECTION} {{"z": 0, "y": -0.0, "x": 0}}'),
    ("camera.size", [1, 2, 3], "expected an array of two integers > 0, got [1, 2, 3]"),
    ("camera.size", {"w": 1}, 'expected an array of two integers > 0, got {"w": 1}'),
    ("camera.size[1]", 0, f"{SIZE} 0"),
    ("camera.size[0]", 10**30, f"{SIZE} 1{'0' * 30}"),
    ("camera.resolution[1]", 0, "expected a number > 0, got 0"),
]


@pytest.mark.parametrize(("place", "value", "problem"), BAD_VALUES)
def test_bad_values(place: str, value: object, problem: str) -> None:
    text = json.dumps(changed({place: value}))
    assert message_of(text) == f"{place}: {problem}"


@pytest.mark.parametrize(("place", "value", "problem"), BAD_VALUES)
def test_places_do_not_depend_on_order(place: str, value: object, problem: str) -> None:
    data = changed({place: value})
    sorted_keys = json.dumps(data, sort_keys=True, indent=1)
    reversed_keys = json.dumps(with_keys_reversed(data))
    words = problem.partition(" {")[0]
    for text in (sorted_keys, reversed_keys):
        assert message_of(text).startswith(f"{place}: {words}")


def with_keys_reversed(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: with_keys_reversed(data[key]) for key in reversed(data)}
    return [with_keys_reversed(item) for item in data] if isinstance(data, list) else data


def test_misspelt_key_is_named_with_the_missing_one() -> None:
    text = replaced('"radius"', '"raduis"')
    problem = 'missing; expected a number ≥ 0 (is "raduis" meant for it?)'
    assert message_of(text) == f"objects[0].radius: {problem}"


@pytest.mark.parametrize("note", [{}, {"note": 1}])
def test_places_among_equal_objects(note: dict[str, object]) -> None:
    data = changed(note)
    data["objects"] = [json.loads(json.dumps(data["objects"][i % 2])) for i in range(100)]
    data["objects"][60]["lambert"] = 2
    data["objects"][70]["lambert"] = 3
    problem = "expected a number from 0 to 1, got 2"
    assert message_of(json.dumps(data)) == f"objects[60].lambert: {problem}"


def test_broken_json_behind_many_objects() -> None:
    data = changed({})
    data["objects"] *= 50
    text = json.dumps(data, indent=1)
    line, column = text.count("\n") + 1, len(text) - text.rindex("\n")
    problem = 'expected "," or "}", got the end of the file'
    assert message_of(text[:-1]) == f"line {line}, column {column - 1}: {problem}"


def test_near_the_recursion_limit() -> None:
    text = replaced('"focus": 10', '"note": ' + "[" * 90 + "]" * 90 + ', "focus": 10')

    def deeper() -> Scene | None:
        try:
            return deeper()
        except RecursionError:
            return loads(text, warn=lambda _: None)

    try:
        deeper()
    except (SceneError, RecursionError) as error:
        # The stack may be too full even for the call itself.
        assert isinstance(error, RecursionError) or "nested too deeply" in str(error)
