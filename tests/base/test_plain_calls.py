"""Device functions return their values and nothing else, whoever calls them."""

from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite import ir
from numba.core.codegen import JITCodeLibrary

from conftest import once
from vtray.base.compiler import compiled
from vtray.base.compiler.compiled import Device, Kernel, Seldom
from vtray.base.compiler.numba_pipeline import DeviceLibrary

pytestmark = pytest.mark.usefixtures("compiler")


@pytest.fixture(params=["native", "through Numba"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Let kernels be called without Numba, or with it."""
    monkeypatch.setattr(compiled, "_trusted", [request.param == "native"])
    return str(request.param)


def use(function: Callable[..., Any], *arguments: Any) -> Any:
    """Return what a kernel and plain Python say, if that is the same."""
    found = Kernel(function)(*arguments)
    assert found == function(*arguments)
    return found


def mean(values: Any) -> Any:
    return values.sum() / values.size


def positive(x: Any) -> Any:
    return x if x > 0.0 else None


def moved(x: Any, by: Any = None, factor: Any = 2.0) -> Any:
    if by is not None:
        x = x + by
    return factor * x


def corners(x: Any, y: Any) -> Any:
    return (x, y), (y > x, np.int64(3))


def clear(values: Any) -> None:
    values[0] = 0.0


def third(x: Any, k: Any) -> Any:
    return (x, 2.0 * x)[k]


mean_, positive_, moved_, corners_ = Device(mean), Device(positive), Device(moved), Device(corners)
clear_, third_, apart_ = Device(clear), Device(third), Seldom(corners)


@once
@pytest.mark.usefixtures("way")
def test_values_of_all_kinds_go_both_ways() -> None:
    values = np.array([[1.0, 2.0], [3.0, 6.0]])
    assert use(lambda x: mean_(x) + mean_(x[0]), values) == 4.5
    assert use(lambda x: moved_(x) + moved_(x, 1.0) + moved_(x, 1.0, 5.0), 1.0) == 16.0
    assert use(lambda x: corners_(x, 2.0)[0][1] + corners_(x, 2.0)[1][1], 1.0) == 5.0
    assert use(lambda x: apart_(x, 0.5)[1][0], 1.0) is False


@pytest.mark.usefixtures("way")
def test_what_may_be_none() -> None:
    def asked(x: float) -> float:
        found = positive_(x)
        return -1.0 if found is None else 2.0 * found

    assert use(asked, 1.5) == 3.0
    assert use(asked, -1.5) == -1.0


@pytest.mark.usefixtures("way")
def test_what_returns_nothing() -> None:
    values = np.ones(3)

    def cleared(values: Any) -> float:
        clear_(values)
        return values[0] + values[1]

    assert Kernel(cleared)(values) == 1.0
    assert values.tolist() == [0.0, 1.0, 1.0]


def test_what_numba_would_raise_is_zero() -> None:
    kernel = Kernel(lambda x, k: 5.0 + third_(x, k))
    assert [kernel(1.0, k) for k in range(3)] == [6.0, 7.0, 5.0]


def test_python_calls_them_too() -> None:
    both = Device(lambda x: moved_(x[0]) + mean_(x))
    assert both(np.array([1.5, 4.5])) == 6.0
    assert third_(1.0, 1) == 2.0
    with pytest.raises(IndexError):
        third_(1.0, 2)


@once
def test_numbas_own_functions_are_not_changed() -> None:
    """What it compiles for itself, once for all who call it, is called in its own way."""

    def several(x: Any) -> Any:
        return np.sort(x)[0] + x.mean() + np.abs(x).max() + round(x[0], 1) + divmod(7, 2)[0]

    values = np.array([3.0, -1.0, 2.0])
    expected = several(values)
    assert numba.njit(several)(values) == expected
    least = numba.njit(lambda x: np.sort(x)[0])
    assert numba.njit(lambda x: least(x) + 3.0)(values) == 2.0
    assert numba.njit(several)(values.astype(np.float32)) == pytest.approx(expected)


def test_their_code_is_that_of_functions_in_c(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[ir.Module] = []
    add = JITCodeLibrary.add_ir_module

    def spy(library: JITCodeLibrary, module: ir.Module) -> None:
        if isinstance(library, DeviceLibrary):
            written.append(module)
        add(library, module)

    monkeypatch.setattr(JITCodeLibrary, "add_ir_module", spy)
    below = Device(lambda x: 3.0 * x)
    assert Kernel(lambda x: below(x) + 1.0)(2.0) == 7.0
    device, _ = written
    (function,) = (each for each in device.functions if each.blocks)
    double = ir.DoubleType()
    assert function.function_type == ir.FunctionType(double, [double])
