"""In LLVM's language: eight rays of a fan in one register.

References
----------
https://llvm.org/docs/LangRef.html
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from typing import Any

from llvmlite import ir
from numba import types

from vtray.geometry.bvh.boxes_in_llvm import (
    ALIGNED_TO,
    SINGLES,
    Code,
    data_in,
    data_of,
    in_all_lanes,
)
from vtray.geometry.bvh.tree import WIDTH
from vtray.geometry.packets.beam import NEVER
from vtray.geometry.packets.fan_rays import FAR_SHARE, SINGLE_ERROR


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


def write_balls_seen(_: object, bvh: Any, first: Any, view: Any, balls: Any) -> Code:
    """Return the code of `balls_seen`."""

    def write(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        bvh, first, view, balls = values
        sides = data_in(context, builder, signature.args[0], bvh, "sides")
        out = data_of(context, builder, signature.args[3], balls)
        add, sub, mul = builder.fadd, builder.fsub, builder.fmul

        def lanes_of(place: tuple[int, ...]) -> Any:
            return in_all_lanes(builder, builder.extract_value(view, place))

        def lanes(value: float) -> Any:
            return ir.Constant(SINGLES, [value] * WIDTH)

        def load(side: int) -> Any:
            place = builder.gep(sides, [builder.add(first, ir.IntType(64)(side * WIDTH))])
            place = builder.bitcast(place, SINGLES.as_pointer())
            return builder.load(place, align=ALIGNED_TO)

        def store(row: int, value: Any) -> None:
            place = builder.gep(out, [ir.IntType(64)(row * WIDTH)])
            builder.store(value, builder.bitcast(place, SINGLES.as_pointer()), align=ALIGNED_TO)

        def size_of(value: Any) -> Any:
            kind = ir.FunctionType(SINGLES, [SINGLES])
            name = f"llvm.fabs.v{WIDTH}f32"
            return builder.call(builder.module.declare_intrinsic(name, (), kind), [value])

        def root_of(value: Any) -> Any:
            kind = ir.FunctionType(SINGLES, [SINGLES])
            name = f"llvm.sqrt.v{WIDTH}f32"
            return builder.call(builder.module.declare_intrinsic(name, (), kind), [value])

        def sum_of(terms: list[Any]) -> Any:
            return add(add(terms[0], terms[1]), terms[2])

        low, high = [load(axis) for axis in range(3)], [load(3 + axis) for axis in range(3)]
        apex, normal = ([lanes_of((k, axis)) for axis in range(3)] for k in range(2))
        margin, limit2, below, tilt = (lanes_of((k,)) for k in (2, 3, 4, 5))
        half = [mul(lanes(0.5), sub(b, a)) for a, b in zip(low, high, strict=True)]
        middle = [mul(lanes(0.5), add(a, b)) for a, b in zip(low, high, strict=True)]
        way = [sub(a, b) for a, b in zip(middle, apex, strict=True)]
        rise = sum_of([mul(a, b) for a, b in zip(way, normal, strict=True)])
        tall = sum_of([mul(a, size_of(b)) for a, b in zip(half, normal, strict=True)])
        widened = add(mul(lanes(2.0), sum_of(half)), margin)
        radius2 = add(sum_of([mul(a, a) for a in half]), mul(margin, widened))
        distance2 = sum_of([mul(a, a) for a in way])
        tangent2 = sub(
            mul(distance2, lanes(1.0 - SINGLE_ERROR)), mul(radius2, lanes(1.0 + SINGLE_ERROR))
        )
        starts_outside = builder.fcmp_ordered(">", tangent2, lanes(0.0))
        tangent = root_of(builder.select(starts_outside, tangent2, lanes(0.0)))
        away = sum_of([size_of(a) for a in way])
        error = mul(lanes(SINGLE_ERROR), away)
        least = builder.select(starts_outside, sub(tangent, error), lanes(-NEVER))
        for row, value in enumerate([*way, least]):
            store(row, value)
        exists = builder.fcmp_ordered("<=", low[0], high[0])
        lowest = add(below, mul(tilt, add(away, sum_of(half))))
        rises = builder.fcmp_ordered(">=", add(rise, tall), builder.fneg(lowest))
        farthest2 = add(limit2, mul(lanes(FAR_SHARE), radius2))
        is_near = builder.fcmp_ordered("<=", distance2, farthest2)
        seen = builder.and_(builder.and_(exists, rises), is_near)
        return builder.zext(builder.bitcast(seen, ir.IntType(WIDTH)), ir.IntType(64))

    return types.int64(bvh, first, view, balls), write
