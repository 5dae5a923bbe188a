"""Points and directions that annotations are given."""

from typing import Any

import numpy as np

from vtray.base.errors import SceneError
from vtray.figures.subject import Floats
from vtray.scene.checks.given_array import array_of


def point_of(given: Any) -> Floats | None:  # noqa: ANN401
    """Return three finite numbers as an array, (3,); None for what is none."""
    try:
        found = array_of(given, "", "")
    except SceneError:
        return None
    if found.shape != (3,) or found.dtype.kind not in "biuf":
        return None
    point = found.astype(np.float64)
    return point if np.isfinite(point).all() else None
