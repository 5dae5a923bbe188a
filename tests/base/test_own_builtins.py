"""``min``, ``max`` and ``int`` in kernels are those of Python."""

import math
from typing import Any

import numba
import numpy as np
import pytest

from vtray.base.compiler.compiled import device, kernel, uncompiled
from vtray.base.compiler.numba_pipeline import DevicePipeline
from vtray.base.compiler.object_code import compile_part

pytestmark = pytest.mark.usefixtures("compiler")

NUMBERS = (-1.0, -0.0, 0.0, 2.5, math.inf, -math.inf, math.nan)


@device
def _extremes(a: Any, b: Any) -> tuple[Any, Any]:
    return min(a, b), max(a, b)


@kernel
def extremes_of_two(a: Any, b: Any) -> tuple[Any, Any]:
    return _extremes(a, b)


@kernel
def extremes_of_three(a: Any, b: Any, c: Any) -> tuple[Any, Any]:
    return min(a, b, c), max(a, b, c)


@kernel
def extremes_with_constants(a: float, n: int) -> tuple[float, float, int, int]:
    return min(a, 1.0), max(a, 0), min(n, 3), max(7, n)


@kernel
def extremes_of_tuples(a: float, b: float) -> tuple[float, float]:
    return min((a, b)), max((a, b))


@kernel
def integers_of(a: float, b: np.uint64) -> tuple[int, int]:
    return int(a), int(b) + 1


def same(found: Any, expected: Any) -> bool:
    """Tell whether numbers are the same to the last bit."""
    return [np.float64(each).tobytes() for each in found] == [
        np.float64(each).tobytes() for each in expected
    ]


@pytest.mark.parametrize("a", NUMBERS)
@pytest.mark.parametrize("b", NUMBERS)
def test_of_numbers_of_all_kinds(a: float, b: float) -> None:
    assert same(extremes_of_two(a, b), (min(a, b), max(a, b)))
    assert same(extremes_of_tuples(a, b), (min(a, b), max(a, b)))
    single = float(np.float32(b))
    assert same(extremes_of_two(a, np.float32(b)), (min(a, single), max(a, single)))
    for c in NUMBERS:
        assert same(extremes_of_three(a, b, c), (min(a, b, c), max(a, b, c)))


def test_of_integers_truth_values_and_constants() -> None:
    for a, b in ((1, 2), (2, 1), (-5, -5)):
        assert extremes_of_two(a, b) == (min(a, b), max(a, b))
        assert extremes_of_two(a, np.int32(b)) == (min(a, b), max(a, b))
        assert extremes_of_two(a, float(b)) == (min(a, b), max(a, b))
        assert extremes_with_constants(a, b) == (min(a, 1.0), max(a, 0), min(b, 3), max(7, b))
        assert integers_of(a + 0.9, np.uint64(b + 9)) == (int(a + 0.9), b + 10)
    assert extremes_of_two(True, False) == (False, True)


def test_numba_makes_no_functions_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    take_all = DevicePipeline._compile_core

    def spy(pipeline: Any) -> Any:
        made.append(pipeline.state.func_id.func_name)
        return take_all(pipeline)

    def refuse(pipeline: Any) -> Any:
        raise AssertionError(pipeline.state.func_id.func_name)

    monkeypatch.setattr(numba.core.compiler.CompilerBase, "_compile_core", refuse)
    monkeypatch.setattr(DevicePipeline, "_compile_core", spy)
    options = {"error_model": "numpy", "nogil": True, "_nrt": False}
    types = (numba.float32, numba.int32)
    compile_part(uncompiled(_extremes), types, options, "extremes-part")
    assert made == ["_extremes"]
