"""A strict JSON reader that remembers where everything stood.

It is slow and used only to explain what is wrong with a scene file; see
`vtray.scene.files.scene_file`.
"""

import math
import re
from collections.abc import Container
from functools import cache, cached_property
from typing import Any, NamedTuple, NoReturn, TypeAlias

from vtray.base.errors import SceneError, printable

MAX_DEPTH = 100  # a scene needs 4

_SPACE = re.compile(rb"[ \t\n\r]*")
_SCALAR = rb"(?:true|false|null|-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)"
_LITERAL = re.compile(_SCALAR + rb"(?![\w.+-])")
_ESCAPE = rb'\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4})'
_STRING = re.compile(rb'"(?:[^"\\\x00-\x1f]|' + _ESCAPE + rb")*+")
# An object like a sphere or a light, with nothing in it that needs a close look.
_SIMPLE_STRING = rb'"[^"\\\x00-\x1f]*+"'
_SIMPLE_OBJECT = rb"\{(?: K : V (?:, K : V )*+)?+\}".replace(b"K", _SIMPLE_STRING)
_FLAT = _SIMPLE_OBJECT.replace(b"V", b"(?:" + _SCALAR + b"|" + _SIMPLE_STRING + b")")
_NESTED = _SIMPLE_OBJECT.replace(
    b"V", b"(?:" + _SCALAR + b"|" + _SIMPLE_STRING + b"|" + _FLAT + b")"
)
_LONE_SURROGATE = re.compile(r"[\ud800-\udfff]")
_WORD = re.compile(r"[\w.+-]+|.", re.DOTALL)

# What people write that is not JSON: its beginning, and what to say.
_HABITS = (
    ("//", "JSON has no comments"),
    ("/*", "JSON has no comments"),
    ("#", "JSON has no comments"),
    ("'", "JSON strings stand in double quotes"),
    ("NaN", "JSON has no NaN"),
    ("nan", "JSON has no NaN"),
    ("Infinity", "JSON has no infinity"),
    ("-Infinity", "JSON has no infinity"),
    ("inf", "JSON has no infinity"),
    ("-inf", "JSON has no infinity"),
    ("True", "JSON writes true"),
    ("False", "JSON writes false"),
    ("None", "JSON writes null"),
    ("+", "JSON numbers have no plus sign"),
    (".", "JSON numbers begin with a digit"),
    ("-.", "JSON numbers begin with a digit"),
)


class Member(NamedTuple):
    """One key of an object, and the byte offset at which the key stands."""

    key: str
    offset: int
    value: "Tree"


class Members(tuple[Member, ...]):
    """An object: its members in the order of the file, repeated keys included."""

    __slots__ = ()


class Written(bytes):
    """A string, number, true, false or null, exactly as the file writes it."""


class Clean:
    """Stands for a part of the file that is known to be right and was not read."""


CLEAN = Clean()
Tree: TypeAlias = "Members | list[Tree] | Written | Clean"  # the values of JSON


class JsonTree:
    """Reads one JSON document.

    Parameters
    ----------
    raw : bytes
        The document, valid UTF-8 without a byte-order mark.
    clean : dict of int to int, optional
        First and end offset of values that need not be read. Without it, only the syntax is
        looked at: simple objects in arrays are passed over quickly, and kept nowhere.
    known : container of str, optional
        The keys of the document whose values are looked at closely; others are passed over where
        they are right.
    """

    def __init__(
        self,
        raw: bytes,
        clean: dict[int, int] | None = None,
        known: Container[str] | None = None,
    ) -> None:
        self.raw = raw
        self.known = known
        self.clean = clean or {}
        self.only_syntax = clean is None
        self.at = 0

    def read(self) -> Tree:
        """Read the whole document, or raise SceneError with line and column."""
        tree = self._value(0)
        if self._next():
            self._fail("the end of the file")
        return tree

    def line(self, offset: int) -> int:
        """Give the line, counted from 1, of a byte offset."""
        return self.raw.count(b"\n", 0, offset) + 1

    def _next(self) -> bytes:
        """Skip white space and give the byte that follows, b"" at the end."""
        match = _SPACE.match(self.raw, self.at)
        self.at = match.end() if match else self.at
        return self.raw[self.at : self.at + 1]

    def _value(self, depth: int) -> Tree:
        byte = self._next()
        if self.at in self.clean:
            self.at = self.clean[self.at]
            return CLEAN
        if byte in {b"{", b"["}:
            if depth == MAX_DEPTH:
                self._fail(f"at most {MAX_DEPTH} levels of nesting", "nested too deeply")
            self.at += 1
            return self._object(depth + 1) if byte == b"{" else self._array(depth + 1)
        return self._string() if byte == b'"' else self._literal()

    def _object(self, depth: int) -> Members:
        members: list[Member] = []
        if self._next() == b"}":
            self.at += 1
            return Members()
        while True:
            if self._next() != b'"':
                self._fail("a key in double quotes" if members else 'a key in double quotes or "}"')
            offset = self.at
            key = _text(self._string())
            if self._next() != b":":
                self._fail('":" after the key')
            self.at += 1
            members.append(Member(key, offset, self._value_of(key, depth)))
            if self._ends(b"}"):
                return Members(members)

    def _value_of(self, key: str, depth: int) -> Tree:
        if depth > 1 or self.only_syntax or self.known is None or key in self.known:
            return self._value(depth)
        self._next()
        end = _end_of_plain(self._latin, self.at)
        if end is None:
            return self._value(depth)
        self.at = end
        return CLEAN

    @cached_property
    def _latin(self) -> str:
        """The document with a character for each byte, which does for all but what texts say."""
        return self.raw.decode("latin-1")

    def _array(self, depth: int) -> "list[Tree]":
        items: list[Tree] = []
        if self._next() == b"]":
            self.at += 1
            return items
        while True:
            items.append(self._item(depth))
            if self._ends(b"]"):
                return items

    def _item(self, depth: int) -> Tree:
        if self.only_syntax and self._next() == b"{":
            match = _simple_item().match(self.raw, self.at)
            if match:
                self.at = match.end()
                return CLEAN
        return self._value(depth)

    def _ends(self, bracket: bytes) -> bool:
        """Take the comma or the closing bracket after a value."""
        byte = self._next()
        if byte not in (b",", bracket):
            self._fail(f'"," or "{bracket.decode()}"')
        self.at += 1
        if byte == b"," and self._next() == bracket:
            after = "a key" if bracket == b"}" else "a value"
            self._fail(f"{after} after the comma", "JSON has no trailing commas")
        return byte == bracket

    def _literal(self) -> Written:
        match = _LITERAL.match(self.raw, self.at)
        if match is None:
            self._fail("a value")
        self.at = match.end()
        return Written(match.group())

    def _string(self) -> Written:
        start = self.at
        match = _STRING.match(self.raw, start)
        self.at = match.end() if match else start
        if self.raw[self.at : self.at + 1] != b'"':
            self._fail_in_string()
        self.at += 1
        written = self.raw[start : self.at]
        if b"\\u" in written and _LONE_SURROGATE.search(_text(written)):
            self.at = start
            self._fail("a string of whole characters", "half of a surrogate pair stands alone")
        return Written(written)

    def _fail_in_string(self) -> NoReturn:
        byte = self.raw[self.at : self.at + 1]
        if byte == b"\\":
            self._fail(r"an escape that JSON knows, such as \n, \\ or \u00e9")
        hint = "write control characters as escapes, such as \\n" if byte else ""
        self._fail("the closing quote of the string", hint)

    def _fail(self, expected: str, hint: str = "") -> NoReturn:
        """Raise the error for the place where the reader stands."""
        start = self.raw.rfind(b"\n", 0, self.at) + 1
        column = len(self.raw[start : self.at].decode(errors="replace")) + 1
        rest = self.raw[self.at : self.at + 200].decode(errors="ignore")
        word = _WORD.match(rest)
        got = _quote(short(word.group())) if word else "the end of the file"
        habits = [text for habit, text in _HABITS if rest.startswith(habit)]
        hint = hint or (habits[0] if habits else "")
        message = f"line {self.line(self.at)}, column {column}: expected {expected}, got {got}"
        raise SceneError(message + (f" ({hint})" if hint else ""))


@cache
def _simple_item() -> re.Pattern[bytes]:
    """Return the pattern of a simple item of an array; it takes 2 ms to make."""
    return re.compile(_NESTED.replace(b" ", rb"[ \t\n\r]*+"))


def _quote(text: str) -> str:
    return f"'{text}'" if '"' in text else f'"{text}"'


def _text(written: bytes) -> str:
    """Give the text that a JSON string stands for."""
    if b"\\" not in written:
        return written[1:-1].decode()
    import json

    text: str = json.loads(written)
    return text


def _end_of_plain(document: str, at: int) -> int | None:
    """Return where a value of right syntax ends, None if it needs a close look.

    That is so for keys given twice, and numbers beyond the range of a double.
    """
    import json

    decoder = json.JSONDecoder(
        object_pairs_hook=_check_keys, parse_float=_check_number, parse_int=_check_number
    )
    try:
        end: int = decoder.raw_decode(document, at)[1]
    except (ValueError, RecursionError):
        return None
    # Keys may be equal that are not written alike.
    return None if document.find("\\u", at, end) >= 0 else end


def _check_keys(pairs: list[tuple[str, Any]]) -> None:
    """Raise ValueError if a key is given twice."""
    if len({key for key, _ in pairs}) < len(pairs):
        raise ValueError


def _check_number(text: str) -> None:
    """Raise ValueError if a number is beyond the range of a double."""
    if math.isinf(float(text)):
        raise ValueError


def short(text: str, limit: int = 40) -> str:
    """Cut a long text, and escape what a terminal would not show as it is."""
    return printable(text[: limit - 3] + "..." if len(text) > limit else text)
