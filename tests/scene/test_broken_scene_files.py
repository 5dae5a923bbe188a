"""Broken and mutated text: never anything but a scene or an error."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_text import TEXT, changed, message_of, replaced

from conftest import once
from vtray.base.errors import VtrayError
from vtray.scene.files.scene_file import loads
from vtray.scene.scene import Scene

EXPECTED_SCENE = "expected an object with the keys camera, lights and objects"
RANGE = "expected a number within the range of a double, up to about 1.8e308, got"
EMPTY = "the file is empty; expected a JSON object with the keys camera, lights and objects"
BAD_TEXTS: list[tuple[str | bytes, str]] = [
    ("", EMPTY),
    (
        "\ufeff \n",
        "the file is empty; expected a JSON object with the keys camera, lights and objects",
    ),
    ("[]", f"{EXPECTED_SCENE}, got []"),
    ("null", f"{EXPECTED_SCENE}, got null"),
    ('"scene"', f'{EXPECTED_SCENE}, got "scene"'),
    ("{", 'line 1, column 2: expected a key in double quotes or "}", got the end of the file'),
    (TEXT[:-3], 'line 15, column 4: expected "," or "}", got the end of the file'),
    (TEXT + "x", 'line 17, column 1: expected the end of the file, got "x"'),
    (TEXT + "\0", 'line 17, column 1: expected the end of the file, got "\\x00"'),
    (
        replaced('"focus": 10,', '"focus": 10, // metres'),
        'line 5, column 18: expected a key in double quotes, got "/" (JSON has no comments)',
    ),
    (
        replaced('"focus": 10,', '"focus": 10, # metres'),
        'line 5, column 18: expected a key in double quotes, got "#" (JSON has no comments)',
    ),
    (
        replaced('"focus": 10,', '/* metres */ "focus": 10,'),
        'line 5, column 5: expected a key in double quotes, got "/" (JSON has no comments)',
    ),
    (
        replaced("0.02]\n", "0.02],\n"),
        'line 8, column 3: expected a key after the comma, got "}" (JSON has no trailing commas)',
    ),
    (
        replaced('"lambert": 0.5}', '"lambert": 0.5},'),
        'line 15, column 3: expected a value after the comma, got "]"'
        " (JSON has no trailing commas)",
    ),
    (
        replaced('"focus": 10', '"focus": NaN'),
        'line 5, column 14: expected a value, got "NaN" (JSON has no NaN)',
    ),
    (
        replaced('"focus": 10', '"focus": Infinity'),
        'line 5, column 14: expected a value, got "Infinity" (JSON has no infinity)',
    ),
    (
        replaced('"focus": 10', '"focus": -Infinity'),
        'line 5, column 14: expected a value, got "-Infinity" (JSON has no infinity)',
    ),
    (
        replaced('"focus": 10', '"focus": +10'),
        'line 5, column 14: expected a value, got "+10" (JSON numbers have no plus sign)',
    ),
    (
        replaced('"focus": 10', '"focus": .5'),
        'line 5, column 14: expected a value, got ".5" (JSON numbers begin with a digit)',
    ),
    (replaced('"focus": 10', '"focus": 010'), 'line 5, column 14: expected a value, got "010"'),
    (replaced('"focus": 10', '"focus": 10.'), 'line 5, column 14: expected a value, got "10."'),
    (
        replaced('"focus"', "'focus'"),
        'line 5, column 5: expected a key in double quotes, got "\'" '
        "(JSON strings stand in double quotes)",
    ),
    (
        replaced('"focus": 10', '"focus" 10'),
        'line 5, column 13: expected ":" after the key, got "10"',
    ),
    (
        replaced('"focus": 10,', '"focus": 10'),
        'line 6, column 5: expected "," or "}", got \'"\'',
    ),
    (
        replaced('"focus": 10,', '"é": "é", focus: 10,'),
        'line 5, column 15: expected a key in double quotes, got "focus"',
    ),
    (
        replaced('"focus": 10', '"note": "\\x", "focus": 10'),
        "line 5, column 14: expected an escape that JSON knows, such as \\n, \\\\ or \\u00e9, "
        'got "\\"',
    ),
    (
        replaced('"focus": 10', '"note": "a\nb", "focus": 10'),
        'line 5, column 15: expected the closing quote of the string, got "\\n" '
        "(write control characters as escapes, such as \\n)",
    ),
    (
        replaced('"focus": 10', '"note": "a\0b", "focus": 10'),
        'line 5, column 15: expected the closing quote of the string, got "\\x00" '
        "(write control characters as escapes, such as \\n)",
    ),
    (
        '{"camera": "abc',
        "line 1, column 16: expected the closing quote of the string, got the end of the file",
    ),
    (
        replaced('"focus": 10', '"note": "\\ud800", "focus": 10'),
        "line 5, column 13: expected a string of whole characters, got '\"' "
        "(half of a surrogate pair stands alone)",
    ),
    (
        replaced('"sphere"', '"sph\\udc00"'),
        "line 11, column 14: expected a string of whole characters, got '\"' "
        "(half of a surrogate pair stands alone)",
    ),
    (
        TEXT + "\ud800",
        "half of a surrogate pair stands alone in line 17; expected whole characters",
    ),
    (TEXT.encode("utf-16"), "line 1, byte 0 of the file: not UTF-8; expected UTF-8 text"),
    (
        b"\xef\xbb\xbf"
        + replaced('"focus": 10', '"note": "@", "focus": 10').encode().replace(b"@", b"\xe9"),
        "line 5, byte 112 of the file: not UTF-8; expected UTF-8 text",
    ),
    (replaced('"focus": 10', '"focus": 1e400'), f"camera.focus: {RANGE} 1e400"),
    (replaced('"focus": 10', '"focus": -1e999'), f"camera.focus: {RANGE} -1e999"),
    (replaced('"focus": 10', '"focus": ' + "9" * 400), f"camera.focus: {RANGE} {'9' * 37}..."),
    (replaced("256", "9" * 400), f"camera.size[0]: {RANGE} {'9' * 37}..."),
    (replaced('"r": 255', '"r": ' + "9" * 9999), f"objects[0].color.r: {RANGE} {'9' * 37}..."),
    (
        replaced('"focus": 10', '"note": [{"a": 1e400}], "focus": 10'),
        f"camera.note[0].a: {RANGE} 1e400",
    ),
    (
        replaced('"focus": 10', '"focus": 10, "focus": 10'),
        "camera.focus: given twice, on line 5; expected each key once",
    ),
    (
        replaced('"size": [', '"f\\u006fcus": 11,\n"size": ['),
        "camera.focus: given twice, on lines 5 and 6; expected each key once",
    ),
    (
        replaced('"type": "plane"', '"type": "plane", "type": "sphere"'),
        "objects[1].type: given twice, on line 13; expected each key once",
    ),
    (
        replaced('"y": 5', '"y": 5, "y": 6'),
        "objects[1].center.y: given twice, on line 13; expected each key once",
    ),
    (
        replaced('"lights"', '"objects": [],\n"lights"'),
        "objects: given twice, on lines 9 and 11; expected each key once",
    ),
    (
        replaced('"lights"', '"note": 1,\n"note": 2,\n"lights"'),
        "note: given twice, on lines 9 and 10; expected each key once",
    ),
    (
        replaced('"lights"', '"note": [{"a b": 1, "a b": 2}],\n"lights"'),
        'note[0]["a b"]: given twice, on line 9; expected each key once',
    ),
    (
        "[" * 100_000,
        'line 1, column 101: expected at most 100 levels of nesting, got "[" (nested too deeply)',
    ),
    (
        '{"a":' * 100_000,
        'line 1, column 501: expected at most 100 levels of nesting, got "{" (nested too deeply)',
    ),
    (
        replaced('"focus": 10', '"a": ' + "[" * 200 + "]" * 200 + ', "focus": 10'),
        'line 5, column 108: expected at most 100 levels of nesting, got "[" (nested too deeply)',
    ),
    (
        replaced('"focus": 10', '"a": ' + "[" * 10**6 + "]" * 10**6 + ', "focus": 10'),
        'line 5, column 108: expected at most 100 levels of nesting, got "[" (nested too deeply)',
    ),
]


@pytest.mark.parametrize(("text", "message"), BAD_TEXTS, ids=range(len(BAD_TEXTS)))
def test_bad_texts(text: str | bytes, message: str) -> None:
    assert message_of(text) == message


def scene_or_error(text: str | bytes) -> Scene | None:
    try:
        return loads(text, "room.json", warn=lambda text: None)
    except VtrayError as error:
        assert str(error).startswith("room.json: ")
        assert "malformed" not in str(error), "left to the words of msgspec"
        return None


@given(
    st.integers(0, len(TEXT) - 1),
    st.integers(0, 12),
    st.binary(max_size=8) | st.sampled_from([*b'{}[],:"\\']).map(lambda byte: bytes([byte])),
)
def test_any_change_of_bytes_gives_a_scene_or_an_error(at: int, length: int, new: bytes) -> None:
    raw = TEXT.encode()
    scene_or_error(raw[:at] + new + raw[at + length :])


PLACES = [
    "camera",
    "camera.center",
    "camera.normal.z",
    "camera.size",
    "camera.size[0]",
    "lights",
    "lights[0].intensity",
    "objects",
    "objects[0]",
    "objects[0].type",
    "objects[1].normal",
    "objects[1].color.g",
]
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=5,
)


@once
@given(st.sampled_from(PLACES), VALUES, st.booleans())
def test_any_value_anywhere_gives_a_scene_or_an_error(
    place: str, value: object, ascii_only: bool
) -> None:
    scene_or_error(json.dumps(changed({place: value}), ensure_ascii=ascii_only))
