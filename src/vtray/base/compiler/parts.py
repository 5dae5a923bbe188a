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
from vtray.base.compiler.mode import compiling, is_kept
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


class Origin(NamedTuple):
    """What a part is compiled from."""

    function: Callable[..., object]
    options: Mapping[str, Any]
    types: tuple[Any, ...]


class KeptPart(msgspec.Struct, frozen=True):
    """The same for other processes.

    Attributes
    ----------
    name
        That of the part.
    module, function, options
        The module of the part in Python, its name there, and Numba's options.
    types
        Numba's types of the arguments, pickled.
    """

    name: str
    module: str
    function: str
    options: dict[str, Any]
    types: bytes


_long: set[str] = set()
_origins: dict[str, Origin] = {}
_kept: dict[str, KeptPart] = {}
_addresses: dict[str, int] = {}
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
    name = object_name(full_name(function), ", ".join(map(str, types)))
    if name not in _origins:
        _origins[name] = Origin(function, options, types)
        if is_kept():
            with contextlib.suppress(UnnamedError):
                _call_for(kept_part(name))
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

    if name not in _kept:
        function, options, types = _origins[name]
        module, called = function.__module__, function.__qualname__
        _kept[name] = KeptPart(name, module, called, dict(options), pickled(types))
    return _kept[name]


def get_help() -> None:
    """Let other processes get ready to compile parts."""
    from vtray.base.compiler import helpers

    helpers.get_ready()


def know_part(part: KeptPart) -> None:
    """Take note of a part that code calls which this process has not compiled."""
    if part.name not in _kept:
        _kept[part.name] = part
        _call_for(part)


def compile_kept(order: bytes) -> None:
    """Compile a part, as another process has told of it, and keep it on disk."""
    part = msgspec.json.decode(order, type=KeptPart)
    _kept[part.name] = part
    _compile(part.name)


def tell_instead(tell: Callable[[bytes], object]) -> None:
    """Tell of parts that this process meets, in place of having them compiled by another."""
    _told.append(tell)


def _call_for(part: KeptPart) -> None:
    """Let another process compile a part that is not on disk."""
    from vtray.base.compiler import helpers

    file = object_file(part.name)
    if file and not file.exists():
        order = msgspec.json.encode(part) + b"\n"
        if _told:
            _told[0](order)
        else:
            helpers.ask(part.name, order, _know_order, is_long=_is_long(part.name))


def _know_order(order: bytes) -> None:
    know_part(msgspec.json.decode(order, type=KeptPart))


def _origin_of(name: str) -> Origin:
    """Return what a part is compiled from."""
    from vtray.base.compiler.kept_types import unpickled

    if name not in _origins:
        kept = _kept[name]
        part: Any = getattr(import_module(kept.module), kept.function)
        with compiling(is_kept=True):
            _origins[name] = Origin(part.__wrapped__, kept.options, unpickled(kept.types))
    return _origins[name]


def make_parts(compiled: ObjectCode) -> dict[str, int]:
    """Return the addresses of the parts that code calls; what is not on disk is compiled."""
    from vtray.base.compiler import helpers

    # Meanwhile, what others are at comes to an end.
    for name in sorted(compiled.parts, key=lambda k: (helpers.is_at_work_on(k), not _is_long(k))):
        if name not in _addresses:
            _addresses[name] = _load(name) or _make(name)
    return {name: _addresses[name] for name in compiled.parts}


def load_parts(compiled: ObjectCode) -> dict[str, int] | None:
    """Return the addresses of the parts that code calls, None if one of them is not on disk."""
    for name in compiled.parts:
        if name not in _addresses:
            address = _load(name)
            if address is None:
                return None
            _addresses[name] = address
    return {name: _addresses[name] for name in compiled.parts}


def _load(name: str) -> int | None:
    """Return the address of a part that is on disk with all its own parts, else None."""
    file = object_file(name)
    found = read_object_code(file) if file else None
    parts = load_parts(found) if found else None
    return None if found is None or parts is None else link(found, parts)


def _make(name: str) -> int:
    """Compile a part, if no other process has; return its address.

    While another one is at it, parts are made that nobody has begun.
    """
    from vtray.base.compiler import helpers

    while (other := helpers.wait_for(name)) is not None:
        if other not in _addresses:
            _addresses[other] = _load(other) or _make(other)
    helpers.leave_to_caller(name)
    file = object_file(name)
    made = read_object_code(file) if file else None
    # The compiler alone knows the types of parts that are lost.
    if made is None or not all(part in _kept or part in _origins for part in made.parts):
        made = _compile(name)
    return link(made, make_parts(made))


def _compile(name: str) -> ObjectCode:
    """Compile a part, and keep it on disk."""
    function, options, types = _origin_of(name)
    made = compile_part(function, types, options, name)
    file = object_file(name)
    if file:
        write_object_code(file, made)
    return made
