"""In LLVM's language: eight rays of a fan in one register, and counts of bits.

References
----------
https://llvm.org/docs/LangRef.html
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from vtray.geometry.bvh.boxes_in_llvm import ALIGNED_TO, SINGLES, data_of, in_all_lanes
from vtray.geometry.bvh.tree import WIDTH

Code = tuple[Any, Callable[[Any, Any, Any, Any], Any]]
"""What an intrinsic is: its signature, and what writes it."""


def write_octet_within(
    _: object, singles: Any, first: Any, step: Any, way: Any, least: Any
) -> Code:
    """Return the code of `octet_within`."""

    def write(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        singles, first, step, way, least = values
        data = data_of(context, builder, signature.args[0], singles)
        products = []
        for axis in range(3):
            place = builder.bitcast(builder.gep(data, [first]), SINGLES.as_pointer())
            lanes = in_all_lanes(builder, builder.extract_value(way, axis))
            products.append(builder.fmul(builder.load(place, align=ALIGNED_TO), lanes))
            first = builder.add(first, step)
        ahead = builder.fadd(builder.fadd(products[0], products[1]), products[2])
        met = builder.fcmp_ordered(">=", ahead, in_all_lanes(builder, least))
        return builder.zext(builder.bitcast(met, ir.IntType(WIDTH)), ir.IntType(64))

    return types.uint64(singles, first, step, way, least), write


def write_count_bits(_: object, bits: Any) -> Code:
    """Return the code of `count_bits`."""

    def write(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.ctpop(values[0])

    return types.int64(bits), write


def write_first_bit(_: object, bits: Any) -> Code:
    """Return the code of `first_bit`."""

    def write(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.cttz(values[0], ir.Constant(ir.IntType(1), 1))

    return types.int64(bits), write
