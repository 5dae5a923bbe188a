"""Arguments and results of compiled functions, against Numba's own way of calling them."""

import threading
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from conftest import once
from vtray.base.compiler.compiled import Device, Kernel, pinned
from vtray.base.compiler.native_call import UnsupportedError, unpack

pytestmark = pytest.mark.usefixtures("compiler")


class Pair(NamedTuple):
    """A NamedTuple as kernels take and return them."""

    first: Any
    second: Any


class Grid(NamedTuple):
    """Arrays of several types, with scalars and tuples among them."""

    size: int
    axes: tuple[float, float]
    cells: Any
    inner: Pair
    flag: bool
    empty: tuple[()]


def make_grid(size: int = 3) -> Grid:
    cells = np.arange(size * size, dtype=np.int32).reshape(size, size)
    inner = Pair(np.linspace(0, 1, size, dtype=np.float32), np.ones(size, np.uint8))
    return Grid(size, (0.5, -2.0), cells, inner, True, ())


def sum_grid(grid: Any, factor: Any) -> Any:
    total = 0.0
    for row in range(grid.size):
        for column in range(grid.size):
            total += grid.cells[row, column] * grid.inner.first[column] * grid.axes[1]
        total += grid.inner.second[row]
    return total * factor if grid.flag else grid.axes[0]


def return_nothing(array: Any) -> None:
    array[0] += 1


def return_same(value: Any) -> Any:
    return value


def return_nested(x: Any) -> Any:
    return Pair(Pair(x > 0, np.float32(x)), (np.uint8(7), x, np.int32(-1)))


def spin(numbers: Any, rounds: Any) -> Any:
    x = 0.0
    for _ in range(rounds):
        for k in range(numbers.size):
            x += numbers[k]
    return x


def native(kernel: Kernel) -> bool:
    """Tell whether all calls so far were done without Numba's wrappers."""
    return bool(kernel._native) and None not in kernel._native.values()


@once
@pytest.mark.parametrize("factor", [2.0, 3, True, np.float32(0.5), np.int32(4), np.float64(1.5)])
def test_nested_arguments(factor: object) -> None:
    kernel = Kernel(sum_grid)
    expected = numba.njit(sum_grid)(make_grid(), factor)
    assert kernel(make_grid(), factor) == expected
    assert kernel(pinned(make_grid()), pinned(factor)) == expected
    assert native(kernel)
    assert len(kernel._native) == 1


def test_none_is_left_out_of_what_is_compiled() -> None:
    def add(first: Any, missing: Any, second: Any) -> Any:
        if missing is None:
            return first + second
        return first + missing[0] + second

    kernel = Kernel(add)
    array = np.array([10.0])
    assert (kernel(1.5, None, 2), kernel(1.5, array, 2), kernel(0.5, None, 1)) == (3.5, 13.5, 1.5)
    assert native(kernel)
    assert len(kernel._native) == 2


@pytest.mark.parametrize(
    "value",
    [0, -1, 2**63 - 1, -(2**63), 0.1, -0.0, np.inf, True, False, (), (1, 2.5), ((1.0,), (True, 2))],
)
def test_values_come_back(value: object) -> None:
    kernel = Kernel(return_same)
    result = kernel(value)
    assert (type(result), result) == (type(value), value)


@once
@pytest.mark.parametrize(
    "dtype", ["b1", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8"]
)
def test_scalars_of_numpy_come_back(dtype: str) -> None:
    value = np.ones(1, dtype)[0]
    assert Kernel(return_same)(value) == value


def test_nothing_and_nested_results() -> None:
    array = np.zeros(1)
    kernel = Kernel(return_nothing)
    assert kernel(array) is None
    assert array[0] == 1
    assert native(kernel)
    kernel = Kernel(return_nested)
    assert kernel(2.5) == Pair(Pair(True, 2.5), (7, 2.5, -1))
    assert type(kernel(2.5)) is Pair
    assert native(kernel)


def test_types_tell_what_must_be_compiled_anew() -> None:
    square = np.zeros((4, 4))
    frozen = square.copy()
    frozen.flags.writeable = False
    several = [
        *(square, square[::2], square[0], frozen, square.astype(np.float32)),
        *(np.asfortranarray(square), 1, 1.0, True, np.float32(1), (1,), (1.0,), Pair(1, 1)),
        *(((1, 1), 1), (1, (1, 1)), ()),
    ]
    assert len({unpack([value])[0] for value in several}) == len(several)
    alike = [(1, 2), (np.zeros(3), np.ones(0)), (1.0, np.float64(2)), (Pair(1, 2), Pair(3, 4))]
    for one, other in alike:
        assert unpack([one])[0] == unpack([other])[0]


@once
@pytest.mark.parametrize("order", ["rows", "columns", "parts", "nothing", "frozen"])
def test_arrays_of_any_order(order: str) -> None:
    square = np.arange(36.0).reshape(6, 6)
    frozen = square.copy()
    frozen.flags.writeable = False
    array = {
        "rows": square,
        "columns": np.asfortranarray(square),
        "parts": square[1::2, ::-1],
        "nothing": square[:0],
        "frozen": frozen,
    }[order]

    def total(array: Any) -> Any:
        result = 0.0
        for row in range(array.shape[0]):
            for column in range(array.shape[1]):
                result += (row + 1) * array[row, column]
        return result

    kernel = Kernel(total)
    assert kernel(array) == total(array)
    assert native(kernel)


@pytest.mark.parametrize("value", [2**63, "text", b"text", [1.0], np.zeros(1, "f2"), 1j])
def test_other_values_are_left_to_numba(value: object) -> None:
    with pytest.raises(UnsupportedError):
        unpack([value])


@once
def test_more_words_than_ctypes_allows() -> None:
    def last(numbers: Any, weights: Any) -> Any:
        return numbers[-1], weights[-1], numbers[0] + weights[0]

    kernel = Kernel(last)
    numbers, weights = tuple(range(1, 700)), (0.5,) * 698 + (-2.5,)
    assert kernel(numbers, pinned(weights)) == (699, -2.5, 1.5)
    assert native(kernel)


@pytest.mark.parametrize("dtype", ["b1", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4"])
def test_words_beside_a_small_one_are_left_alone(dtype: str) -> None:
    one = np.ones(1, dtype)[0]
    arguments = (-1, one, -0.1, True, 2**63 - 1, False, -np.inf)
    kernel = Kernel(return_same)
    assert kernel(arguments) == arguments
    assert native(kernel)


def test_unsupported_arguments_are_still_computed() -> None:
    kernel = Kernel(return_same)
    assert kernel(2**63) == kernel(pinned(2**63)) == 2**63
    assert kernel(pinned(1)) == 1
    assert list(kernel._native) == [("i8,",)]


def test_raising_kernel_is_noticed() -> None:
    def fail(x: Any) -> Any:
        if x > 0:
            raise ValueError
        return x

    kernel = Kernel(fail)
    assert kernel(0) == 0
    with pytest.raises(RuntimeError, match="a kernel raised an exception: status"):
        kernel(1)


def test_error_of_the_compiler_is_shown() -> None:
    with pytest.raises(numba.TypingError):
        Kernel(lambda x: x.no_such_thing)(1.0)


def test_device_functions_run_compiled_in_python_too() -> None:
    divide = Device(lambda a, b: a / b)
    assert divide(1.0, 0.0) == np.inf


def test_threads_run_side_by_side() -> None:
    # The interpreter's lock is free during a call: this thread counts on meanwhile.
    kernel = Kernel(spin)
    numbers = np.ones(1000)
    kernel(numbers, 1)
    results: list[Any] = []
    threads = [
        threading.Thread(target=lambda: results.append(kernel(numbers, 100_000))) for _ in range(2)
    ]
    for thread in threads:
        thread.start()
    beats = 0
    while threads[0].is_alive():
        threads[0].join(0.001)
        beats += 1
    threads[1].join()
    assert results == [1e8, 1e8]
    assert beats > 10
