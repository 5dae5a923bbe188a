"""Without the steps that kernels do not need, Numba makes the same code of them."""

from collections.abc import Callable
from itertools import count
from typing import Any

import numba
import numpy as np
import pytest
from numba.core.bytecode import FunctionIdentity
from numba.core.compiler import Compiler
from numba.core.typing.context import Context

from conftest import once
from vtray.base.compiler import known_types
from vtray.base.compiler.compiled import Device
from vtray.base.compiler.numba_pipeline import DevicePipeline
from vtray.base.compiler.object_code import ObjectCode, compile_part

pytestmark = pytest.mark.usefixtures("compiler")

OPTIONS = {"error_model": "numpy", "nogil": True, "_nrt": False}


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
