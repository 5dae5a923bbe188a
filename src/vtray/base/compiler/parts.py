"""Parts of kernels: functions with machine code of their own, which several kernels share.

A kernel is compiled anew for each combination of shapes, lights and what is wanted of a picture.
What depends on few of these is a part: it is compiled once for them, and kept on disk beside the
kernels that call it. So the time of combinations adds up instead of multiplying.

Machine code calls a part by a name, a hash of all that the part depends on. Who loads the code says
where the part is in memory. Without all its parts, code is not used, and compiled again: only the
compiler knows the types of their arguments.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, NamedTuple

from vtray.base.compiler.function_names import full_name
from vtray.base.compiler.object_code import (
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


_origins: dict[str, Origin] = {}
_addresses: dict[str, int] = {}


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
    _origins[name] = Origin(function, options, types)
    return name


def origin_of(name: str) -> Origin:
    """Return what a part is compiled from, given its name."""
    return _origins[name]


def know_part(
    name: str, module: str, function: str, options: Mapping[str, Any], types: tuple[Any, ...]
) -> None:
    """Take note of a part that code calls which this process has not compiled.

    Parameters
    ----------
    name
        That of the part.
    module, function, options
        The module of the part in Python, its name there, and Numba's options.
    types
        Numba's types of the arguments.
    """
    if name not in _origins:
        part: Any = getattr(import_module(module), function)
        _origins[name] = Origin(part.__wrapped__, options, types)


def load_parts(compiled: ObjectCode) -> dict[str, int] | None:
    """Return the addresses of the parts that code calls, None if one of them is not on disk."""
    return _addresses_of(compiled, _load)


def make_parts(compiled: ObjectCode) -> dict[str, int]:
    """Return the addresses of the parts that code calls; what is not on disk is compiled."""
    return _addresses_of(compiled, lambda name: _load(name) or _make(name)) or {}


def _addresses_of(compiled: ObjectCode, find: Callable[[str], int | None]) -> dict[str, int] | None:
    """Return the addresses of the parts that code calls, None if one of them is not found."""
    for name in compiled.parts:
        if name not in _addresses:
            address = find(name)
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
    """Compile a part, and keep it on disk; return its address."""
    function, options, types = _origins[name]
    made = compile_part(function, types, options, name)
    parts = make_parts(made)
    file = object_file(name)
    if file:
        write_object_code(file, made)
    return link(made, parts)
