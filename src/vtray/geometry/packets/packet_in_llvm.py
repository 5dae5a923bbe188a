"""In LLVM's language: memory of doubles as other numbers, which Numba takes long to compile."""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from typing import Any

from llvmlite import ir
from numba import types

from vtray.base.compiler.in_memory import DATA, ITEM_BYTES, ITEMS, SHAPE, STRIDES
from vtray.geometry.bvh.boxes_in_llvm import Code


def write_integers(_: object, packet: Any) -> Code:
    """Return the code of `integers`."""
    return _seen_as(types.int64, packet)


def write_singles(_: object, fan: Any) -> Code:
    """Return the code of `singles_of`."""
    return _seen_as(types.float32, fan)


def _seen_as(number: Any, doubles: Any) -> Code:
    """Return the code of what returns the memory of a row of doubles as other numbers."""
    each = types.float64.bitwidth // number.bitwidth

    def write(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        (array,) = values
        made = ir.Constant(context.get_value_type(signature.return_type), None)
        for at, kind in enumerate(made.type.elements):
            value = builder.extract_value(array, at)
            if at == DATA:
                value = builder.bitcast(value, kind)
            elif at == ITEMS:
                value = builder.mul(value, value.type(each))
            elif at == ITEM_BYTES:
                value = value.type(number.bitwidth // 8)
            elif at == SHAPE:
                first = builder.extract_value(value, 0)
                value = builder.insert_value(value, builder.mul(first, first.type(each)), 0)
            elif at == STRIDES:
                bytes_apart = value.type.element(number.bitwidth // 8)
                value = builder.insert_value(value, bytes_apart, 0)
            made = builder.insert_value(made, value, at)
        return made

    return doubles.copy(dtype=number)(doubles), write
