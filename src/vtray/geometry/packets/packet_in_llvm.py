"""In LLVM's language: the memory of a packet as integers, which Numba takes long to compile."""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from typing import Any

from llvmlite import ir
from numba import types

from vtray.base.compiler.in_memory import DATA
from vtray.geometry.bvh.boxes_in_llvm import Code


def write_integers(_: object, packet: Any) -> Code:
    """Return the code of `integers`."""

    def write(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        (array,) = values
        made = ir.Constant(context.get_value_type(signature.return_type), None)
        for number, kind in enumerate(made.type.elements):
            value = builder.extract_value(array, number)
            value = builder.bitcast(value, kind) if number == DATA else value
            made = builder.insert_value(made, value, number)
        return made

    return packet.copy(dtype=types.int64)(packet), write
