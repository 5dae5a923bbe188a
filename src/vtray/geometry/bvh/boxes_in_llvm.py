"""In LLVM's language: eight boxes in one register, and memory that is asked for early.

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

from vtray.geometry.bvh.tree import WIDTH

_WORD = ir.IntType(32)
SINGLES = ir.VectorType(ir.FloatType(), WIDTH)
ALIGNED_TO = 4
_READ, _KEEP, _DATA = 0, 3, 1

Code = tuple[Any, Callable[[Any, Any, Any, Any], Any]]
"""What an intrinsic is: its signature, and what writes it."""


def write_boxes_met(
    _: object, bvh: Any, first: Any, near: Any, far: Any, start: Any, end: Any, entered: Any
) -> Code:
    """Return the code of `boxes_met`."""

    def write(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        bvh, first, near, far, start, end, entered = values
        sides = data_in(context, builder, signature.args[0], bvh, "sides")

        def narrowed(limit: Any, bounds: Any, order: str) -> Any:
            """Return a limit, or the bound of an axis that is nearer, for each box."""
            found = in_all_lanes(builder, limit)
            for axis in range(3):
                side, factor, term = (builder.extract_value(bounds, (k, axis)) for k in range(3))
                place = builder.gep(sides, [builder.add(first, side)])
                place = builder.bitcast(place, SINGLES.as_pointer())
                bound = builder.load(place, align=ALIGNED_TO)
                bound = builder.fmul(bound, in_all_lanes(builder, factor))
                bound = builder.fadd(bound, in_all_lanes(builder, term))
                found = builder.select(builder.fcmp_ordered(order, bound, found), bound, found)
            return found

        enter, leave = narrowed(start, near, ">"), narrowed(end, far, "<")
        out = data_of(context, builder, signature.args[6], entered)
        builder.store(enter, builder.bitcast(out, SINGLES.as_pointer()), align=ALIGNED_TO)
        met = builder.fcmp_ordered("<=", enter, leave)
        return builder.zext(builder.bitcast(met, ir.IntType(WIDTH)), ir.IntType(64))

    return types.int64(bvh, first, near, far, start, end, entered), write


def write_fetch_early(_: object, values: Any, at: Any) -> Code:
    """Return the code of `fetch_early`."""

    def write(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = data_of(context, builder, signature.args[0], arguments[0])
        place = builder.gep(data, [arguments[1]])
        place = builder.bitcast(place, ir.IntType(8).as_pointer())
        kind = ir.FunctionType(ir.VoidType(), [place.type, _WORD, _WORD, _WORD])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch.p0", (), kind)
        builder.call(prefetch, [place, _WORD(_READ), _WORD(_KEEP), _WORD(_DATA)])
        return context.get_dummy_value()

    return types.none(values, at), write


def data_in(context: Any, builder: Any, kind: Any, holder: Any, name: str) -> Any:
    """Return the address of the first number of an array, by its name in a tuple."""
    array = context.get_getattr(kind, name)(context, builder, kind, holder, name)
    return data_of(context, builder, context.typing_context.resolve_getattr(kind, name), array)


def data_of(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    """Return the address of an array's first number."""
    return context.make_array(kind)(context, builder, array).data


def in_all_lanes(builder: Any, value: Any) -> Any:
    """Return eight times the same number."""
    nothing = ir.Constant(SINGLES, ir.Undefined)
    lane = builder.insert_element(nothing, value, _WORD(0))
    lanes = ir.Constant(ir.VectorType(_WORD, WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(lane, nothing, lanes)
