"""In LLVM's language: bits of integers.

References
----------
https://llvm.org/docs/LangRef.html
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from typing import Any

from llvmlite import ir
from numba import types

from vtray.geometry.bvh.boxes_in_llvm import Code


def write_count_bits(_: object, bits: Any) -> Code:
    """Return the code of `count_bits`."""

    def write(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.ctpop(values[0])

    return types.int64(bits), write


def write_lowest_bit(_: object, bits: Any) -> Code:
    """Return the code of `lowest_bit`."""

    def write(_: Any, builder: Any, __: Any, values: Any) -> Any:
        return builder.cttz(values[0], ir.Constant(ir.IntType(1), 1))

    return types.int64(bits), write
