"""Without the steps that kernels do not need, Numba makes the same code of them."""

import gc
import threading
import time
from collections.abc import Callable
from itertools import count
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite import ir
from llvmlite.binding import ffi
from numba.core import errors
from numba.core.bytecode import FunctionIdentity
from numba.core.compiler import Compiler
from numba.core.registry import cpu_target
from numba.core.typing.context import Context

from conftest import once
from vtray.base.compiler import known_types
from vtray.base.compiler.compiled import Device
from vtray.base.compiler.in_memory import WORD
from vtray.base.compiler.numba_pipeline import DevicePipeline
from vtray.base.compiler.object_code import ObjectCode, compile_part
from vtray.base.compiler.plain_calls import KernelContext, context_of

pytestmark = pytest.mark.usefixtures("compiler")

OPTIONS = {"error_model": "numpy", "nogil": True, "_nrt": False}
POINTS = (numba.typeof(np.zeros(3)),)


def _difference(left: Any, right: Any) -> Any:
    return left[0] - right[0], left[1] - right[1], left[2] - right[2]


difference: Callable[..., Any] = _difference


def nearest(points: Any, at: Any, limit: Any) -> Any:
    """Find what is nearest to a place: with None, tuples, loops, and ways that meet."""
    best, found = np.inf, -1
    if limit is not None:
        best = limit * limit
    for k in range(points.shape[0] // 3):
        away = difference((points[3 * k], points[3 * k + 1], points[3 * k + 2]), at)
        if away[0] > best:
            continue
        square = away[0] * away[0] + away[1] * away[1] + away[2] ** 2
        if square < best:
            best, found = square, k
        elif square == best and found < 0:
            break
    points[0] = -points[0] if found >= 0 and not points[1] > 2.0 else float(found)
    return found


def compiled(monkeypatch: pytest.MonkeyPatch, limit: float | None) -> ObjectCode:
    """Compile all anew, with names that are the same each time."""
    monkeypatch.setitem(globals(), "difference", Device(_difference))
    monkeypatch.setattr(FunctionIdentity, "_unique_ids", count(1000))
    types = tuple(map(numba.typeof, (np.zeros(6), (0.0, 1.0, 2.0), limit)))
    return compile_part(nearest, types, OPTIONS, "nearest-part")


@once
@pytest.mark.parametrize("limit", [None, 2.0])
def test_steps_that_are_left_out_change_nothing(
    monkeypatch: pytest.MonkeyPatch, limit: float | None
) -> None:
    short = compiled(monkeypatch, limit)
    taken: list[str] = []

    def take_all(pipeline: Any) -> Any:
        taken.append(pipeline.state.func_id.func_name)
        return Compiler._compile_core(pipeline)

    monkeypatch.setattr(DevicePipeline, "_compile_core", take_all)
    assert compiled(monkeypatch, limit) == short
    assert sorted(taken) == ["_difference", "nearest"]


def test_types_are_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_types, "_signatures", {})
    asked: list[object] = []
    find = Context.resolve_function_type

    def spy(context: Any, function: Any, *arguments: Any) -> Any:
        if isinstance(function, numba.types.Function) or not isinstance(function, numba.types.Type):
            asked.append((function, *map(str, arguments)))
        return find(context, function, *arguments)

    monkeypatch.setattr(Context, "resolve_function_type", spy)
    first = compiled(monkeypatch, 2.0)
    assert len(asked) == len(set(asked)) > 5
    assert compiled(monkeypatch, 2.0) == first
    assert len(asked) == len(set(asked))


def _next(count: Any) -> Any:
    return count + 2


follows: Callable[..., Any] = _next


def count_up(points: Any) -> Any:
    """Count from a constant on, in a loop and in a branch."""
    counted, way = 0, 1
    for k in range(points.shape[0]):
        counted = follows(counted)
        if points[k] > 0.0:
            way = 3
        way = follows(way)
    return counted + follows(way)


def test_constants_that_counting_begins_with_are_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled_for: list[str] = []
    take_all = DevicePipeline._compile_core

    def spy(pipeline: Any) -> Any:
        compiled_for.extend(map(str, pipeline.state.args))
        return take_all(pipeline)

    monkeypatch.setitem(globals(), "follows", Device(_next))
    monkeypatch.setattr(DevicePipeline, "_compile_core", spy)
    compile_part(count_up, POINTS, OPTIONS, "count-part")
    assert [kind for kind in compiled_for if "array" not in kind] == ["int64"]


def test_errors_that_nobody_sees_are_not_painted(monkeypatch: pytest.MonkeyPatch) -> None:
    painted: list[str] = []

    class Painter:
        def __getattr__(self, _: str) -> Callable[[str], str]:
            return lambda text: painted.append(text) or text

    monkeypatch.setattr(errors, "_termcolor_inst", Painter())
    str(errors.TypingError("seen"))
    assert painted == ["seen"]
    compiled(monkeypatch, 2.0)
    assert painted == ["seen"]
    assert isinstance(errors._termcolor_inst, Painter)


def test_what_is_left_out_is_left_out_for_each_of_two_threads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: list[tuple[str, str, int]] = []
    take_all = DevicePipeline._compile_core
    lock: Any = ffi.lib._lock
    others = threading.Thread(target=compile_part, args=(count_up, POINTS, OPTIONS, "other-part"))

    def spy(pipeline: Any) -> Any:
        if not seen:
            others.start()
            time.sleep(0.2)  # for it to come as far as it may
        painter = type(errors._termcolor_inst).__name__
        seen.append((pipeline.state.func_id.func_name, painter, len(lock._cblist)))
        return take_all(pipeline)

    before = list(lock._cblist), errors._termcolor_inst, gc.get_threshold()
    monkeypatch.setitem(globals(), "follows", Device(_next))
    monkeypatch.setattr(DevicePipeline, "_compile_core", spy)
    compiled(monkeypatch, None)
    others.join()
    assert [name for name, _, _ in seen] == ["nearest", "_difference", "count_up", "_next"]
    assert {(painter, told) for _, painter, told in seen} == {("_NoColors", 0)}
    assert (list(lock._cblist), errors._termcolor_inst, gc.get_threshold()) == before


def test_sizes_of_types_are_those_that_llvm_tells() -> None:
    context = context_of(KernelContext, cpu_target.target_context)
    for kind in (ir.IntType(1), ir.DoubleType(), ir.LiteralStructType([ir.IntType(8), WORD])):
        for _ in range(2):
            assert context.get_abi_sizeof(kind) == kind.get_abi_size(context.target_data)
