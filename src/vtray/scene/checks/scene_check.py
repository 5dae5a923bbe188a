"""Finds out, slowly and in full, what is wrong with a scene and where.

The fast way to a scene is msgspec alone. Only when something is amiss do these walk through
the values beside the types of `vtray.scene.scene`, whose annotations hold every rule and every
word: `FileChecker` through the tree of a file, `construct` through values given in code.
"""

import functools
import math
import typing
from collections.abc import Callable
from numbers import Real
from typing import Any

import msgspec

from vtray.base.errors import SceneError
from vtray.base.number import number_of
from vtray.scene.checks.given_array import RED_GREEN_BLUE, remedy_for_name
from vtray.scene.checks.json_tree import CLEAN, Members, Tree, Written
from vtray.scene.checks.limits import FieldError, limits_alone, may_be_infinite
from vtray.scene.checks.scene_words import (
    Struct,
    Unknown,
    either,
    expected,
    given_kind,
    is_optional,
    join,
    may_be_named,
    names_alone,
    nearest,
    options,
    quoted,
    required_keys,
    show,
    struct_kinds,
    struct_options,
    tag_field,
    tags,
    untagged,
)

# A type as an annotation says it: a class, a union, an Annotated, list[...] or tuple[...].
Kind = Any

Make = Callable[[type, object], object]
"""Makes what a text of a file stands for."""


class FileChecker:
    """Walks through a scene file in its order and stops at the first problem.

    Parameters
    ----------
    line_of : callable
        Gives the line, counted from 1, of an offset in the file.
    ignored : int
        How many unknown keys there are in parts that are not read.
    names : set of str
        What may stand for a material, beside the names that all files know.
    make : callable, optional
        Makes what a text stands for where a kind is none that JSON knows, as ``dec_hook`` of
        msgspec.

    Attributes
    ----------
    unknown : Unknown
        The keys that the format does not know.
    """

    def __init__(
        self,
        line_of: Callable[[int], int],
        ignored: int = 0,
        names: frozenset[str] = frozenset(),
        make: Make | None = None,
    ) -> None:
        self.line_of = line_of
        self.names = names
        self.make = make
        self.unknown = Unknown("key", ignored)

    def check(self, found: Tree, kind: Kind, place: str = "") -> Any:  # noqa: ANN401
        """Convert a value to a kind; raise SceneError where that cannot be done."""
        if found is CLEAN or (found == b"null" and is_optional(kind)):
            return None
        kind = given_kind(kind)
        if origin_of(kind) is dict and isinstance(found, Members):
            return self._named(found, kind, place)
        if struct_options(kind) and isinstance(found, Members):
            return self._struct(found, struct_options(kind), place)
        arrays = [option for option in options(kind) if origin_of(option) in (list, tuple)]
        if arrays and type(found) is list:
            return self._array(found, arrays[0], place)
        if struct_kinds(kind) or not isinstance(found, Written):
            raise wrong(place, kind, show(found))
        self._check_range(found, place)
        if self.names and may_be_named(kind) and found[:1] == b'"':
            return self._name(found, kind, place)
        return _convert_leaf(found, kind, place, self.make)

    def _named(self, found: Members, kind: Kind, place: str) -> None:
        """Check materials, of which blends may name others that are none."""
        self._check_repeated(found, place)
        names = self.names
        single = frozenset(key for key, _, value in found if not _is_blend(value))
        for key, _, value in found:
            self.names = single if _is_blend(value) else frozenset()
            self.check(value, typing.get_args(plain_kind(kind))[1], join(place, key))
        self.names = names

    def _name(self, found: Written, kind: Kind, place: str) -> Any:  # noqa: ANN401
        """Check the name of a material; return one that every file knows."""
        name, known = msgspec.json.decode(found), names_alone(struct_options(kind))
        own = sorted(self.names.difference(known))
        if name not in (*own, *known):
            close = nearest(name, [*own, *known], cutoff=0.6)
            hint = f"; did you mean {close}?" if close else ""
            words = ", ".join([*map(quoted, own), expected(kind)])
            raise SceneError(f"{place}: expected {words}, got {show(found)}{hint}")
        return known[0]

    def _struct(self, found: Members, structs: tuple[Struct, ...], place: str) -> Any:  # noqa: ANN401
        self._check_repeated(found, place)
        cls = structs[0] if not tags(structs) else _by_tag(found, structs, place)
        hints = hints_of(cls)
        known = [*hints, *tag_field(cls)]
        values: dict[str, Any] = dict(zip(tag_field(cls), tags([cls]), strict=True))
        for key, _, value in found:
            where = join(place, key)
            if key in hints:
                values[key] = self.check(value, hints[key], where)
            elif key not in known:
                self.unknown.add(where, key, known)
                self._check_ignored(value, where)
        for key in hints:
            if key not in values and key in required_keys(cls):
                raise _missing(join(place, key), hints[key], key, found, known)
        # Only these have rules about several fields; others may hold parts that were not read.
        return _make(cls, values, place, found) if hasattr(cls, "__post_init__") else values

    def _array(self, found: list[Tree], kind: Kind, place: str) -> Any:  # noqa: ANN401
        kinds = _kinds_of_items(kind, len(found))
        if len(found) != len(kinds) or len(found) < _least_length(kind):
            raise wrong(place, kind, show(found))
        pairs = enumerate(zip(found, kinds, strict=True))
        return [self.check(item, item_kind, f"{place}[{i}]") for i, (item, item_kind) in pairs]

    def _check_repeated(self, found: Members, place: str) -> None:
        first: dict[str, int] = {}
        for key, offset, _ in found:
            if key in first:
                one, two = self.line_of(first[key]), self.line_of(offset)
                lines = f"line {one}" if one == two else f"lines {one} and {two}"
                problem = f"given twice, on {lines}; expected each key once"
                raise SceneError(f"{join(place, key)}: {problem}")
            first[key] = offset

    def _check_ignored(self, found: Tree, place: str) -> None:
        """Check what holds also for values that nobody reads."""
        if isinstance(found, Members):
            self._check_repeated(found, place)
            for key, _, value in found:
                self._check_ignored(value, join(place, key))
        elif isinstance(found, list):
            for index, item in enumerate(found):
                self._check_ignored(item, f"{place}[{index}]")
        elif isinstance(found, Written):
            self._check_range(found, place)

    def _check_range(self, found: Written, place: str) -> None:
        if found[:1] in b"-0123456789" and math.isinf(float(found)):
            words = "a number within the range of a double, up to about 1.8e308"
            raise SceneError(f"{place}: expected {words}, got {show(found)}")


def construct(cls: Struct, values: dict[str, object], place: str = "") -> Any:  # noqa: ANN401
    """Make an object of a scene from values given in code.

    Parameters
    ----------
    cls : type
        One of the types of `vtray.scene.scene`.
    values : dict
        A value for each field.
    place : str
        Where the object belongs, for messages; the name of the type by default.

    Raises
    ------
    SceneError
        If a value is not right.
    """
    place = place or cls.__name__
    hints = hints_of(cls)
    made = {
        name: from_code(values[name], hints[name], f"{place}.{name}")
        for name in hints
        if name in values
    }
    return _make(cls, made, place, tuple(made.values()))


def from_code(found: Any, kind: Kind, place: str) -> Any:  # noqa: ANN401
    """Convert one value given in code: also tuples and what NumPy makes.

    Raises
    ------
    SceneError
        If the value is not of the kind; the message begins with the place.
    """
    if found is None and is_optional(kind):
        return None
    kind = given_kind(kind)
    # NumPy is not imported here; its arrays and scalars turn into Python's with tolist.
    if hasattr(found, "tolist"):
        found = found.tolist()
    if not isinstance(found, (int, float)) and isinstance(found, Real):
        found = number_of(found)  # a fraction, or one that is longer than a double
    structs = struct_kinds(kind)
    if structs:
        return _struct_from_code(found, structs, kind, place)
    origin = origin_of(kind)
    if origin not in (list, tuple):
        is_right = not isinstance(found, float) or math.isfinite(found) or may_be_infinite(kind)
        if not is_right:
            raise SceneError(f"{place}: expected a finite number, got {found!r}")
        return _convert_leaf(found, kind, place)
    if not isinstance(found, (list, tuple)):
        raise wrong(place, kind, show(found), in_code=True)
    kinds = _kinds_of_items(kind, len(found))
    if len(found) != len(kinds):
        raise wrong(place, kind, show(found), in_code=True)
    pairs = enumerate(zip(found, kinds, strict=True))
    return [from_code(item, item_kind, f"{place}[{i}]") for i, (item, item_kind) in pairs]


def _struct_from_code(found: Any, structs: tuple[Struct, ...], kind: Kind, place: str) -> Any:  # noqa: ANN401
    """Take an object as it is, or make a vector, direction or colour of three numbers."""
    if isinstance(found, structs):
        return found
    names = tuple(hints_of(structs[0]))
    if isinstance(found, msgspec.Struct) and found.__struct_fields__ == names:
        found = msgspec.structs.astuple(found)
    if isinstance(found, (list, tuple)) and len(found) == len(names) and _is_triple(structs):
        return construct(structs[0], dict(zip(names, found, strict=True)), place)
    remedy = remedy_for_name(found) if names == RED_GREEN_BLUE else ""
    raise wrong(place, kind, f"{show(found)}{remedy}", in_code=True)


def _is_triple(structs: tuple[Struct, ...]) -> bool:
    """Tell whether three numbers can stand for the only type there is."""
    kinds = hints_of(structs[0]).values()
    return len(structs) == 1 and len(kinds) == 3 and not any(map(struct_kinds, kinds))


@functools.cache
def hints_of(cls: Struct) -> dict[str, Kind]:
    """Give the annotations of a Struct's fields, in their order, without what is not for checks."""
    hints = typing.get_type_hints(cls, include_extras=True)
    return {name: limits_alone(hints[name]) for name in cls.__struct_fields__}


def plain_kind(kind: Kind) -> Kind:
    """Give the type inside an Annotated."""
    return typing.get_args(kind)[0] if hasattr(kind, "__metadata__") else kind


def origin_of(kind: Kind) -> Kind:
    """Give list or tuple for an array of these, None for a single value."""
    return typing.get_origin(plain_kind(kind))


def _kinds_of_items(kind: Kind, count: int) -> tuple[Kind, ...]:
    """Give the kinds of the items of an array; of one of any length, of so many."""
    first, *rest = typing.get_args(plain_kind(kind))
    return (first,) * count if rest in ([], [...]) else (first, *rest)


def _is_blend(found: Tree) -> bool:
    """Tell whether a material of a file is one of two."""
    return isinstance(found, Members) and any(
        key == "type" and value == b'"blend"' for key, _, value in found
    )


def _least_length(kind: Kind) -> int:
    """Give the least length of an array of a kind."""
    limits = getattr(kind, "__metadata__", ())
    return max((limit.min_length or 0 for limit in limits), default=0)


def wrong(place: str, kind: Kind, got: str, *, in_code: bool = False) -> SceneError:
    """Give the error for a value that is not of its kind."""
    message = f"expected {expected(kind, in_code=in_code)}, got {got}"
    return SceneError(f"{place}: {message}" if place else message)


def _missing(place: str, kind: Kind, key: str, found: Members, known: list[str]) -> SceneError:
    """Give the error for a key that is not there, with the one that may be meant for it."""
    import difflib

    strange = [member.key for member in found if member.key not in known]
    close = difflib.get_close_matches(key, strange, n=1)
    hint = f" (is {quoted(close[0])} meant for it?)" if close else ""
    return SceneError(f"{place}: missing; expected {expected(kind)}{hint}")


def _by_tag(found: Members, structs: tuple[Struct, ...], place: str) -> Struct:
    """Choose the type that an object names."""
    (field,) = tag_field(structs[0])
    by_tag = dict(zip(tags(structs), structs, strict=True))
    words = either(map(quoted, by_tag))
    where = join(place, field)
    written = next((member.value for member in found if member.key == field), None)
    if written is None:
        return _without_tag(found, structs, where, words)
    try:
        tag = msgspec.json.decode(written, type=str) if isinstance(written, Written) else ""
    except msgspec.ValidationError:
        tag = ""
    if tag in by_tag:
        return by_tag[tag]
    close = nearest(tag, list(by_tag), cutoff=0.6)
    hint = f"; did you mean {close}?" if close else ""
    raise SceneError(f"{where}: expected {words}, got {show(written)}{hint}")


def _without_tag(found: Members, structs: tuple[Struct, ...], place: str, words: str) -> Struct:
    """Choose the type of an object that does not name it, or raise SceneError."""
    keys = {member.key for member in found}
    plain = untagged(structs)
    if plain is not None and required_keys(plain) <= keys:
        return plain
    meant = [cls for cls in structs if keys and keys <= set(hints_of(cls))]
    if plain is not None and (plain in meant or not meant):
        return plain
    hint = f"; is it {either(map(quoted, tags(meant)))}?" if meant and plain else ""
    raise SceneError(f"{place}: missing; expected {words}{hint}")


def _convert_leaf(found: Any, kind: Kind, place: str, make: Make | None = None) -> Any:  # noqa: ANN401
    try:
        if isinstance(found, Written):
            return msgspec.json.decode(found, type=kind, dec_hook=make)
        return msgspec.convert(found, kind)
    except (msgspec.MsgspecError, OverflowError) as error:
        if isinstance(error.__cause__, SceneError):
            raise SceneError(f"{place}: {error.__cause__}") from None
        # Only what may be an object has other words in code: the types that code makes it with.
        in_code = bool(struct_options(kind)) and not isinstance(found, Written)
        raise wrong(place, kind, show(found), in_code=in_code) from None


def _make(cls: Struct, values: dict[str, Any], place: str, found: object) -> Any:  # noqa: ANN401
    """Make an object whose fields are right; what is left is in its __post_init__."""
    try:
        return msgspec.convert(values, cls)
    except msgspec.ValidationError as error:
        cause = error.__cause__
        if isinstance(cause, FieldError):
            place = join(place, cause.field)
            if cause.field not in values:
                raise SceneError(f"{place}: missing; expected {cause}") from None
            found = _field_of(found, cause.field, values)
            raise SceneError(f"{place}: expected {cause}, got {show(found)}") from None
        raise SceneError(f"{place}: expected {error}, got {show(found)}") from None


def _field_of(found: object, field: str, values: dict[str, Any]) -> object:
    """Give one field as it was written, or as it was given in code."""
    if isinstance(found, Members):
        return next(member.value for member in found if member.key == field)
    value = values[field]
    is_triple = isinstance(value, msgspec.Struct) and _is_triple((type(value),))
    return msgspec.structs.astuple(value) if is_triple else value
