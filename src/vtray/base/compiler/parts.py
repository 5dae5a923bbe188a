"""Parts of kernels: functions with machine code of their own, which several kernels share.

A kernel is compiled anew for each combination of shapes, lights and what is wanted of a picture.
What depends on few of these is a part: it is compiled once for them, and kept on disk beside the
kernels that call it. So the time of combinations adds up instead of multiplying.

Machine code calls a part by a name, a hash of all that the part depends on. Who loads the code says
where the part is in memory. Without all its parts, code is not used, and compiled again: only the
compiler knows the types of their arguments.
"""

import contextlib
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, NamedTuple

import msgspec

from vtray.base.compiler.function_names import UnnamedError, full_name
from vtray.base.compiler.mode import compiling, is_kept, unsaid_now
from vtray.base.compiler.object_code import (
    PART_MARK,
    ObjectCode,
    compile_part,
    link,
    object_file,
    object_name,
    read_object_code,
    write_object_code,
)
from vtray.base.compiler.unseen import (
    OPEN,
    KeptPart,
    Unsaid,
    is_open,
    kept_parts,
    unsaid_of,
    unseen_by,
)


class Origin(NamedTuple):
    """What a part is compiled from."""

    function: Callable[..., object]
    options: Mapping[str, Any]
    types: tuple[Any, ...]


class Order(msgspec.Struct, frozen=True):
    """What another process is told of a part.

    Attributes
    ----------
    part
        The part.
    key, types
        What is unsaid where it is called; the types are pickled.
    """

    part: KeptPart
    key: str
    types: bytes


_long: set[str] = set()
_origins: dict[str, Origin] = {}
_addresses: dict[tuple[str, str], int] = {}
"""Where parts are in memory, by their names and by the key of what is unsaid in them."""

_unkept: dict[str, ObjectCode] = {}
"""Parts that cannot be kept on disk, by their names."""

_pickled: dict[str, bytes] = {}
"""Types that are unsaid, by their keys."""

_told: list[Callable[[bytes], object]] = []


def new_name(
    function: Callable[..., object], options: Mapping[str, Any], types: tuple[Any, ...]
) -> str:
    """Return the name of a part, by which `make_parts` finds it again.

    Parameters
    ----------
    function, options
        The part in Python, and Numba's options.
    types
        Numba's types of the arguments.
    """
    from vtray.base.compiler.in_memory import has_unseen, hidden

    unseen = unseen_by(function)
    own = tuple(hidden(kind, unseen) for kind in types)
    name = object_name(full_name(function), ", ".join(map(str, own)))
    name += OPEN if any(has_unseen(kind, unseen) for kind in own) else ""
    is_new = name not in _origins
    _origins.setdefault(name, Origin(function, options, own))
    if is_open(name):
        kept_part(name)
        _meant(name, unsaid_now())
    elif is_new and is_kept():
        with contextlib.suppress(UnnamedError):
            _call_for(kept_part(name), unsaid_now())
    return name


def compile_sooner(function: Callable[..., object]) -> None:
    """Compile a part before others, as it takes longer than these."""
    _long.add(full_name(function))


def _is_long(name: str) -> bool:
    """Tell whether a part takes longer to compile than others."""
    return name.partition(PART_MARK)[0] in _long


def kept_part(name: str) -> KeptPart:
    """Return a part for other processes.

    Raises
    ------
    UnnamedError
        They would not find what it is made of.
    """
    from vtray.base.compiler.kept_types import pickled

    if name not in kept_parts:
        function, options, types = _origins[name]
        module, called = function.__module__, function.__qualname__
        kept_parts[name] = KeptPart(name, module, called, dict(options), pickled(types))
    return kept_parts[name]


def get_help() -> None:
    """Let other processes get ready to compile parts."""
    from vtray.base.compiler import helpers

    helpers.get_ready()


def know_part(part: KeptPart) -> None:
    """Take note of a part that code calls which this process has not compiled."""
    is_new = part.name not in kept_parts
    kept_parts.setdefault(part.name, part)
    if is_open(part.name):
        _meant(part.name, unsaid_now())
    elif is_new:
        _call_for(part, unsaid_now())


def _meant(name: str, unsaid: Unsaid) -> str | None:
    """Return the name of the part that is meant by one, None if that cannot be told."""
    if not is_open(name):
        return name
    if _is_known(name) and not _is_known(unsaid.names.get(name, "")):
        from vtray.base.compiler.in_memory import shown

        function, options, types = _origin_of(name)
        unseen = unseen_by(function)
        with contextlib.suppress(KeyError), compiling(is_kept(), unsaid):
            own = tuple(shown(kind, unsaid.types, unseen) for kind in types)
            unsaid.names[name] = new_name(function, options, own)
    return unsaid.names.get(name)


def _is_known(name: str) -> bool:
    """Tell whether this process could compile a part."""
    return name in kept_parts or name in _origins


def compile_kept(order: bytes) -> None:
    """Compile a part, as another process has told of it, and keep it on disk."""
    part, unsaid = _understood(order)
    kept_parts[part.name] = part
    _compile(part.name, unsaid)


def _understood(order: bytes) -> tuple[KeptPart, Unsaid]:
    """Return of which part another process has told, and what is unsaid in it."""
    from vtray.base.compiler.kept_types import unpickled

    told = msgspec.json.decode(order, type=Order)
    unsaid = unsaid_of(told.key)
    if not unsaid.types:
        with compiling(is_kept=True):
            unsaid.types = unpickled(told.types)
    return told.part, unsaid


def tell_instead(tell: Callable[[bytes], object]) -> None:
    """Tell of parts that this process meets, in place of having them compiled by another."""
    _told.append(tell)


def _call_for(part: KeptPart, unsaid: Unsaid) -> None:
    """Let another process compile a part that is not on disk."""
    from vtray.base.compiler import helpers
    from vtray.base.compiler.kept_types import pickled

    file = object_file(part.name)
    if file and not file.exists():
        if unsaid.key not in _pickled:
            _pickled[unsaid.key] = pickled(dict(unsaid.types))
        order = msgspec.json.encode(Order(part, unsaid.key, _pickled[unsaid.key])) + b"\n"
        if _told:
            _told[0](order)
        else:
            helpers.ask(part.name, order, _know_order, is_long=_is_long(part.name))


def _know_order(order: bytes) -> None:
    part, unsaid = _understood(order)
    with compiling(is_kept=True, unsaid=unsaid):
        know_part(part)


def _origin_of(name: str) -> Origin:
    """Return what a part is compiled from."""
    from vtray.base.compiler.kept_types import unpickled

    if name not in _origins:
        kept = kept_parts[name]
        part: Any = getattr(import_module(kept.module), kept.function)
        with compiling(is_kept=True):
            _origins[name] = Origin(part.__wrapped__, kept.options, unpickled(kept.types))
    return _origins[name]


def learn(code: ObjectCode) -> None:
    """Take note of the open parts of a kernel that is on disk for other arguments."""
    with compiling(is_kept=True, unsaid=unsaid_of(code.key)):
        for part in code.open_parts:
            know_part(part)


def with_names(kernel: ObjectCode) -> ObjectCode:
    """Return a kernel with all that other processes need to load it."""
    return msgspec.structs.replace(kernel, names=unsaid_of(kernel.key).names)


def make_parts(kernel: ObjectCode) -> dict[str, int] | None:
    """Return the addresses of the parts that a kernel calls; what is not on disk is compiled.

    The compiler alone knows the types of the parts of what is on disk: if one is lost, return None.
    """
    return _addresses_of(kernel, unsaid_of(kernel.key), is_made=True)


def load_parts(kernel: ObjectCode) -> dict[str, int] | None:
    """Return the addresses of the parts that a kernel calls, None if one of them is not on disk."""
    unsaid = unsaid_of(kernel.key)
    unsaid.names.update(kernel.names)
    return _addresses_of(kernel, unsaid, is_made=False)


def _addresses_of(code: ObjectCode, unsaid: Unsaid, *, is_made: bool) -> dict[str, int] | None:
    """Return the addresses of the parts that code calls, None if one of them is not to be had.

    Parameters
    ----------
    code, unsaid
        The code.
    is_made
        Whether parts that are not on disk are compiled.
    """
    if is_made:
        for part in code.open_parts:
            kept_parts.setdefault(part.name, part)
    found: dict[str, int] = {}
    for name in _in_turn(code, unsaid) if is_made else code.parts:
        own = _meant(name, unsaid)
        address = _address_of(own, unsaid, is_made=is_made) if own else None
        if address is None:
            return None
        found[name] = address
    return found


def _in_turn(code: ObjectCode, unsaid: Unsaid) -> list[str]:
    """Return the parts that code calls; last those that others are at, which come to an end."""
    from vtray.base.compiler import helpers

    def place(name: str) -> tuple[bool, bool, str]:
        own = _meant(name, unsaid) or name
        return helpers.is_at_work_on(own), not _is_long(own), name

    return sorted(code.parts, key=place)


def _address_of(name: str, unsaid: Unsaid, *, is_made: bool) -> int | None:
    """Return the address of a part, None if it is not to be had; the rest is as above."""
    place = name, unsaid.key
    if place not in _addresses:
        code, parts = _loaded(name, unsaid, is_made=False)
        if parts is None and is_made:
            code, parts = _made(name, unsaid)
        if code is None or parts is None:
            return None
        _addresses[place] = link(code, parts)
    return _addresses[place]


_Loaded = tuple[ObjectCode | None, dict[str, int] | None]


def _loaded(name: str, unsaid: Unsaid, *, is_made: bool) -> _Loaded:
    """Return a part that is there, and the addresses of its own parts."""
    file = object_file(name)
    code = read_object_code(file) if file else _unkept.get(name)
    return code, _addresses_of(code, unsaid, is_made=is_made) if code else None


def _made(name: str, unsaid: Unsaid) -> _Loaded:
    """Compile a part, if no other process has; return it with the addresses of its own parts.

    While another one is at it, parts are compiled that nobody has begun.
    """
    from vtray.base.compiler import helpers

    while (other := helpers.wait_for(name)) is not None:
        if (other, unsaid.key) not in _addresses:
            _address_of(other, unsaid, is_made=True)
    helpers.leave_to_caller(name)
    code, parts = _loaded(name, unsaid, is_made=True)
    if parts is None and _is_known(name):
        code = _compile(name, unsaid)
        parts = _addresses_of(code, unsaid, is_made=True)
    return code, parts


def _compile(name: str, unsaid: Unsaid) -> ObjectCode:
    """Compile a part, and keep it."""
    function, options, types = _origin_of(name)
    made = compile_part(function, types, options, name, unsaid)
    file = object_file(name)
    if file:
        write_object_code(file, made)
    else:
        _unkept[name] = made
    return made
