"""A small kernel that is called before all others, to see that calls without Numba are right.

How arguments are passed and where results lie is Numba's own affair, and may change with any of its
versions: kernels would then take some numbers for others. So this one reads and writes numbers in
all forms in which kernels are given them, and must do what plain Python does. (A call so wrong that
it ends the process cannot be caught: that is why the versions of Numba and llvmlite are capped.)
"""

import math
import sys
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.caller_warning import warn_caller
from vtray.base.compiler.native_call import NativeCall, unpack
from vtray.base.version import __version__

ROWS, COLUMNS = 3, 2

Array = NDArray[Any]

_warned: list[str] = []


class CanaryError(Exception):
    """A call without Numba did not do what plain Python does."""


class Cage(NamedTuple):
    """Arrays of the dtypes and dimensions that kernels take, with numbers and tuples among them."""

    points: Array
    cube: Array
    number: int
    fine: Array
    deep: tuple[float, tuple[Array, bool]]
    keys: Array
    numbers: Array
    short: Array
    signs: Array
    bytes_: Array


class Song(NamedTuple):
    """Numbers in tuples in a tuple, as kernels return them."""

    total: float
    memory: tuple[int, int, int]
    deep: tuple[tuple[float, bool], int]
    is_on: bool


def sing(cage: Cage, echo: Cage, weight: float, step: int, is_on: bool) -> Song:
    """Return other numbers if any two of those given are exchanged, and write to all of an echo."""
    scale, (marks, is_deep) = cage.deep
    _, (echo_marks, _) = echo.deep
    total = scale
    for row in range(cage.points.shape[0]):
        for column in range(cage.points.shape[1]):
            total = total * weight + float(cage.points[row, column])
            total = total * weight + float(cage.cube[row, column, row])
            total = total * weight + float(cage.fine[row, column])
            echo.points[row, column] += total
            echo.cube[row, column, row] -= total
            echo.fine[row, column] = weight
        total = total * weight + float(cage.keys[row])
        total = total * weight + float(cage.numbers[row])
        total = total * weight + float(cage.short[row])
        total = total * weight + float(cage.signs[row])
        total = total * weight + float(cage.bytes_[row])
        total = -total if marks[row] else total
        echo.keys[row] = row + step
        echo.numbers[row] = row - step
        echo.short[row] = row * step
        echo.signs[row] = -row
        echo.bytes_[row] = echo.number
        echo_marks[row] = is_on
    memory = cage.cube.size, cage.cube.itemsize, cage.cube.strides[0]
    return Song(total, memory, ((scale, is_deep), 100 * cage.number + 10 * step), is_on)


def new_arguments() -> tuple[Cage, Cage, float, int, bool]:
    """Return what the canary is called with: what is read, read-only, and what is written."""
    return _new_cage(10, 7, writeable=False), _new_cage(0, 8, writeable=True), 1.1, 2, True


def compare_with_python(native: NativeCall, arguments: tuple[object, ...]) -> None:
    """Call the canary without Numba, and see that it does what it does in plain Python.

    Raises
    ------
    CanaryError
        It does not.
    """
    same = new_arguments()
    found = native(unpack(arguments)[1])
    if _text(found) != _text(sing(*same)):
        message = "the canary returned other numbers than in plain Python"
        raise CanaryError(message)
    if _text(arguments) != _text(same):
        message = "the canary wrote other numbers than in plain Python"
        raise CanaryError(message)


def warn_of_slow_starts(reason: Exception) -> None:
    """Say that calls without Numba have failed, once in each process."""
    if _warned:
        return
    import llvmlite
    import numba

    versions = f"Numba {numba.__version__}, llvmlite {llvmlite.__version__}"
    python = "{}.{}.{}".format(*sys.version_info)
    _warned.append(f"{type(reason).__name__}: {reason}".splitlines()[0])
    message = (
        f"kernels cannot be called without Numba ({_warned[0]}), so each start compiles them anew, "
        "which takes seconds but changes no picture; please report this, with the versions: "
        f"vtray {__version__}, {versions}, Python {python}"
    )
    warn_caller(message)


def _new_cage(first: int, number: int, *, writeable: bool) -> Cage:
    """Return new arrays, of which no two hold the same numbers."""

    def array(dtype: type[np.generic], above: int, *shape: int) -> Array:
        low = first + above
        values = np.arange(low, low + math.prod(shape)).astype(dtype).reshape(shape)
        values.flags.writeable = writeable
        return values

    return Cage(
        points=array(np.float64, 0, ROWS, COLUMNS),
        cube=array(np.float64, 10, ROWS, COLUMNS, ROWS),
        number=number,
        fine=array(np.float32, 30, ROWS, COLUMNS),
        deep=(0.1 * number, (np.arange(ROWS) == 1, False)),
        keys=array(np.uint64, 40, ROWS),
        numbers=array(np.int64, 50, ROWS),
        short=array(np.int32, 60, ROWS),
        signs=array(np.int8, 70, ROWS),
        bytes_=array(np.uint8, 80, ROWS),
    )


def _text(value: object) -> str:
    """Return a text of numbers that differs where their types or any of their bits do."""
    if isinstance(value, tuple):
        return f"{type(value).__name__}({','.join(map(_text, value))})"
    return repr(value.tolist() if isinstance(value, np.ndarray) else value)
