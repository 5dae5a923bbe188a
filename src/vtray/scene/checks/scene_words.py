"""The words for places, values and expectations in the messages about scenes."""

import functools
import re
import types
import typing
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import msgspec

from vtray.scene.checks.json_tree import Members, Written, short

Struct: TypeAlias = type[msgspec.Struct]

_PLAIN_KEY = re.compile(r"[A-Za-z_][A-Za-z_0-9]*")
_UNIONS = (types.UnionType, typing.Union)
_SHOWN_ITEMS = 4
_SHOWN_DEPTH = 2

_SYNONYMS = {"intensity": "radiance", "radiance": "intensity"}
"""Words that do not look like those that are meant."""

SHOWN_UNKNOWN = 20
"""Unknown keys of which there are warnings; of more, only how many there are."""


def expected(kind: Any, *, in_code: bool = False) -> str:  # noqa: ANN401
    """Say what a kind of value is, to follow the word "expected"."""
    kind = given_kind(kind)
    if hasattr(kind, "__metadata__"):
        return str(kind.__metadata__[-1].description)
    if typing.get_origin(kind) is typing.Literal:
        return either(map(repr if in_code else quoted, typing.get_args(kind)))
    structs = struct_kinds(kind)
    if not structs and len(options(kind)) > 1:
        return either(_words_of_options(kind, in_code=in_code))
    if not structs:
        return "a list" if in_code else "an array"
    if in_code:
        names = either(cls.__name__ for cls in structs)
        kinds = [field.type for field in msgspec.structs.fields(structs[0])]
        triple = len(structs) == 1 and len(kinds) == 3 and not any(map(struct_kinds, kinds))
        return f"{names} or three numbers" if triple else names
    plain = untagged(structs)
    if plain is None:
        return f"an object with {_tags_of(structs)}"
    others = [cls for cls in structs if cls is not plain]
    fields = plain.__struct_fields__
    *most, last = fields[: len(fields) - len(plain.__struct_defaults__)] or fields
    keys = f"an object with the keys {', '.join(most)} and {last}"
    if not most:
        keys = f"an object with the key {last}"
    return f"{keys}, or with {_tags_of(others)}" if others else keys


def _words_of_options(kind: Any, *, in_code: bool) -> list[str]:  # noqa: ANN401
    """Name what a union allows, with all its Structs in the place of the first."""
    structs, found = struct_options(kind), options(kind)
    if not in_code and may_be_named(kind):
        others = [expected(option) for option in found if hasattr(option, "__metadata__")]
        names = list(map(quoted, names_alone(structs)))
        more = [name for name in map(quoted, tags(structs)) if name not in names]
        which = either(["one of these", *more])
        return [*names, f'an object with {which} as its "type"', *others]
    words: list[str] = []
    for option in found:
        if option not in structs[1:]:
            one = typing.Union[structs] if option in structs else option  # noqa: UP007
            words += expected(one, in_code=in_code).split(" or ", 1)
    return words


def either(words: Iterable[str]) -> str:
    """Join words as in "a, b or c"."""
    *most, last = words
    return f"{', '.join(most)} or {last}" if most else last


def options(kind: Any) -> tuple[Any, ...]:  # noqa: ANN401
    """Give the kinds that a union allows, or the only one."""
    return typing.get_args(kind) if typing.get_origin(kind) in _UNIONS else (kind,)


def is_optional(kind: Any) -> bool:  # noqa: ANN401
    """Tell whether a kind allows None, which a file writes as null or leaves out."""
    return type(None) in options(kind)


def given_kind(kind: Any) -> Any:  # noqa: ANN401
    """Give the kind that a value has where one is given: neither None nor left out."""
    absent = (type(None), msgspec.UnsetType)
    found = options(kind)
    given = tuple(option for option in found if option not in absent)
    return kind if len(given) == len(found) else typing.Union[given]  # noqa: UP007


def struct_kinds(kind: Any) -> tuple[Struct, ...]:  # noqa: ANN401
    """Give the Structs that a kind allows; empty if it allows anything else but None."""
    found = options(given_kind(kind))
    return found if all(isinstance(item, msgspec.StructMeta) for item in found) else ()


def struct_options(kind: Any) -> tuple[Struct, ...]:  # noqa: ANN401
    """Give the Structs that a kind allows, maybe beside other values."""
    found: tuple[Struct, ...] = options(kind)
    return tuple(item for item in found if isinstance(item, msgspec.StructMeta))


def may_be_named(kind: Any) -> bool:  # noqa: ANN401
    """Tell whether the names of types, which the Structs of a union say, may stand alone."""
    names = names_alone(struct_options(kind))
    return bool(names) and any(list(typing.get_args(option)) == names for option in options(kind))


def names_alone(structs: Iterable[Struct]) -> list[str]:
    """Give the tags of the Structs that need nothing else."""
    return tags(cls for cls in structs if not required_keys(cls))


@functools.cache
def required_keys(cls: Struct) -> frozenset[str]:
    """Give the keys of a Struct's fields that a file must have."""
    return frozenset(field.encode_name for field in msgspec.structs.fields(cls) if field.required)


def tags(structs: Iterable[Struct]) -> list[str]:
    """Give the tags by which a file tells the Structs apart; empty if it need not."""
    found = (cls.__struct_config__.tag for cls in structs)
    return [str(tag) for tag in found if tag is not None]


def untagged(structs: Sequence[Struct]) -> Struct | None:
    """Give the Struct that an object is which does not say its type; None if it has to."""
    if not tags(structs):
        return structs[0]
    return next((cls for cls in structs if getattr(cls, "_tag_left_out", False)), None)


def _tags_of(structs: Sequence[Struct]) -> str:
    """Say what the key may hold by which a file tells the Structs apart."""
    (field,) = tag_field(structs[0])
    return f"{quoted(field)}: {either(map(quoted, tags(structs)))}"


def tag_field(cls: Struct) -> list[str]:
    """Give the key that holds the tag of a Struct, in a list; empty if it has none."""
    field = cls.__struct_config__.tag_field
    return [field] if field else []


class Unknown:
    """The lines about keys or arrays that are not known: a few, and how many more there are.

    Parameters
    ----------
    what : str
        What they are, "key" or "array".
    more : int
        How many there are beside those that are noted.
    """

    def __init__(self, what: str, more: int = 0) -> None:
        self._what = what
        self._lines: list[str] = []
        self._more = more

    def add(self, place: str, word: str, known: list[str]) -> None:
        """Note one at a place; to look for the nearest known word takes long."""
        if len(self._lines) == SHOWN_UNKNOWN:
            self._more += 1
            return
        what = self._what
        meant = _SYNONYMS.get(word)
        close = quoted(meant) if meant in known else nearest(word, known)
        text = f"unknown {what}, ignored; the nearest known {what} is {close}"
        self._lines.append(f"{place}: {text}")

    def lines(self) -> list[str]:
        """Give the lines."""
        more = [f"{self._more} more unknown {self._what}s, ignored"] if self._more else []
        return self._lines + more


def nearest(word: str, known: list[str], cutoff: float = 0.0) -> str:
    """Give the most similar known word in quotes, "" if none is similar enough."""
    import difflib

    same = next((one for one in known if one.casefold() == word.casefold()), None)
    close = [same] if same else difflib.get_close_matches(word, known, n=1, cutoff=cutoff)
    return quoted(close[0]) if close else ""


def quoted(text: str) -> str:
    """Write a text as JSON does, cut short."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{short(escaped)}"'


def join(place: str, key: str) -> str:
    """Append a key to a place such as objects[3]."""
    if not _PLAIN_KEY.fullmatch(key):
        return f"{place}[{quoted(key)}]"
    return f"{place}.{short(key)}" if place else short(key)


def show(found: object, depth: int = 0) -> str:
    """Write a value as JSON does, or as Python does if it was given in code, cut short."""
    if isinstance(found, Written):
        return short(found.decode())
    if isinstance(found, Members):
        shown = found[:_SHOWN_ITEMS] if depth < _SHOWN_DEPTH else []
        items = [f"{quoted(key)}: {show(value, depth + 1)}" for key, _, value in shown]
        return _brackets("{}", items, len(found))
    if isinstance(found, (list, tuple)):
        shown = found[:_SHOWN_ITEMS] if depth < _SHOWN_DEPTH else []
        items = [show(value, depth + 1) for value in shown]
        return _brackets("[]" if isinstance(found, list) else "()", items, len(found))
    try:
        return short(repr(found))
    except ValueError:
        return "an integer of thousands of digits"


def _brackets(pair: str, items: list[str], count: int) -> str:
    if count > len(items):
        items.append("...")
    return pair[0] + ", ".join(items) + pair[1]
