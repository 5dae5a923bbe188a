"""Tuples that code does not look into, and only passes on to the parts that do.

What a tuple holds, or whether it does, is part of its type, so code would be compiled anew for each
combination of shapes, patterns and lights, even where it only hands them to others. A kernel or
part that says which tuples it passes on is compiled once, whatever they are. Of the parts that it
calls, those that look into them are *open*: which code is meant is known only together with the
arguments of the kernel. So each kernel has a file that says what all its open parts are there, and
code with open parts is loaded once for each of these.
"""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import msgspec

from vtray.base.compiler.function_names import full_name

Kind = TypeVar("Kind", bound=type)

OPEN = "~"
"""What ends the name of an open part, and of no other."""

kept_parts: dict[str, "KeptPart"] = {}
"""Those that this process knows, by their names."""

_APART = "is_apart"

_unseen: dict[str, frozenset[str]] = {}
_unsaid: dict[str, "Unsaid"] = {}


class KeptPart(msgspec.Struct, frozen=True):
    """A part, for other processes.

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


class Unsaid(msgspec.Struct):
    """What code does not say of the tuples that it passes on.

    Attributes
    ----------
    key
        The same for the same types, in all processes.
    names
        What open parts are for these types: the names of closed ones by their own.
    types
        Numba's types of the tuples, by the names of their classes; empty where nothing is compiled.
    """

    key: str
    names: dict[str, str] = {}
    types: Mapping[str, Any] = {}


def unsaid_of(key: str) -> Unsaid:
    """Return what is known for a key in this process."""
    return _unsaid.setdefault(key, Unsaid(key))


def apart(kind: Kind) -> Kind:
    """Let tuples of a class lie in words of their own, wherever they are items of another one.

    What is in them may then differ, and all else lies where it does. Only tuples of such classes
    can be passed on unseen.
    """
    setattr(kind, _APART, True)
    return kind


def is_apart(kind: type) -> bool:
    """Tell whether tuples of a class lie in words of their own."""
    return hasattr(kind, _APART)


def pass_on(function: Callable[..., object], classes: tuple[type, ...]) -> None:
    """Note that a kernel or part does not look into tuples of some classes."""
    _unseen[full_name(function)] = frozenset(map(full_name, classes))


def unseen_by(function: Callable[..., object]) -> frozenset[str]:
    """Return the names of the classes of tuples that a kernel or part does not look into."""
    return _unseen.get(full_name(function), frozenset())


def all_unseen() -> frozenset[str]:
    """Return the names of all classes of tuples that anything does not look into."""
    return frozenset().union(*_unseen.values())


def is_open(name: str) -> bool:
    """Tell whether a part is open, given its name."""
    return name.endswith(OPEN)
