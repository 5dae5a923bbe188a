"""How much of the light particles take on its way through."""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import array_of
from vtray.scene.cylinders import Cylinders
from vtray.scene.particles.made_of import made_of
from vtray.scene.particles.particles import Particles
from vtray.scene.spheres import Spheres

Floats = NDArray[np.float64]
Part = TypeVar("Part", Spheres, Cylinders)

WORDS = "expected a number from 0 to 1, one for each particle, or the name of a column of such"


def opacities(particles: Particles, given: Any, kept: NDArray[np.bool_] | None) -> Floats:  # noqa: ANN401
    """Return the opacities of particles, (n,).

    Parameters
    ----------
    particles
        The particles.
    given
        A number, one for each, or the name of a column.
    kept
        Those that stay opaque, (n,); None if none do.

    Raises
    ------
    SceneError
        These are no numbers from 0 to 1.
    """
    values = particles[given] if isinstance(given, str) else given
    array = array_of(values, "opacity", WORDS)
    try:
        found = np.broadcast_to(array, len(particles))
    except ValueError:
        raise SceneError(f"opacity: {WORDS}, got {_shown(given)}") from None
    if found.size and found.dtype.kind not in "biuf":
        raise SceneError(f"opacity: {WORDS}, got {_shown(given)}")
    found = found.astype(np.float64)
    wrong = np.flatnonzero(~((found >= 0.0) & (found <= 1.0)))
    if len(wrong):
        place = f"opacity[{wrong[0]}]" if np.ndim(values) else "opacity"
        raise SceneError(f"{place}: {WORDS}, got {found[wrong[0]]:g}")
    if kept is not None:
        found[kept] = 1.0
    return found


def see_through(part: Part, opacity: Floats) -> Part:
    """Return objects through which as much light passes as through the particles that they show.

    Between two particles, that is the more transparent one.
    """
    source = made_of(part)
    assert source is not None  # noqa: S101 - they are made of particles
    rows = opacity[source.indices if source.joined is None else source.joined]
    each = rows if rows.ndim == 1 else rows.min(axis=1)
    found = float(each[0]) if len(each) and (each == each[0]).all() else each
    return part.replace(opacity=found)


def _shown(given: Any) -> str:  # noqa: ANN401
    from vtray.scene.checks.scene_words import show

    return show(given)
