"""Columns of several sources as one, in which a row may stand for all of a source."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import input_array


def rows_of(parts: list[NDArray[Any]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first row of each part when they are joined, and the step from row to row."""
    sizes = np.array([len(part) for part in parts])
    return np.cumsum(sizes) - sizes, (sizes > 1).astype(np.int64)


def joined(parts: list[NDArray[Any]], dtype: type[np.generic]) -> NDArray[Any]:
    """Return parts as one array, which is no copy where there is only one."""
    filled = [part for part in parts if len(part)] or parts[:1]
    return input_array(filled[0] if len(filled) == 1 else np.concatenate(filled), dtype)
