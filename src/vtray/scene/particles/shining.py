"""Particles that shine: points smaller than pixels, whose light adds up."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.choices import is_one_of
from vtray.scene.checks.scene_words import show
from vtray.scene.particles.coloring import Coloring, columns_like
from vtray.scene.particles.column_names import column_called
from vtray.scene.particles.particles import POSITION
from vtray.scene.stars import Stars

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

PLACE = "add_particles: "

UNSAID = {"stretch": "asinh", "softening": None, "peak": None}
"""What is said of how light adds up where nothing is."""


def check_shining(
    style: str | None, coloring: Mapping[str, Any], asked: Mapping[str, object]
) -> Mapping[str, Any]:
    """Return how particles are coloured that shine: white, unless something else is asked for.

    Parameters
    ----------
    style, coloring
        What is said of both.
    asked
        By name what else is asked for, which must be None or False.

    Raises
    ------
    SceneError
        Something is asked for that points do not have.
    """
    if style is not None and not is_one_of(style, ("points",)):
        words = 'expected "points" with emission, as only points shine'
        raise SceneError(f"style: {words}, got {show(style)}")
    for name, value in asked.items():
        if value is not None and value is not False:
            raise SceneError(f"{name}: points that shine have none; leave out it or emission")
    if coloring["color"] is not None:
        return coloring
    if coloring["cmap"] is not None:
        words = "is for the column that color names, as that of emission says how bright points are"
        raise SceneError(f"cmap: {words}; give color, or leave it out")
    return {**coloring, "color": "white"}


def check_dull(stretched: Mapping[str, Any]) -> None:
    """Raise SceneError if it is said how light adds up of particles that give none.

    Parameters
    ----------
    stretched
        As for `shining`.
    """
    for name, value in stretched.items():
        if value is not None and not (isinstance(value, str) and value == UNSAID[name]):
            raise SceneError(f"{name}: is for points that shine; give emission, or leave it out")


def shining(
    particles: "Particles",
    rows: NDArray[np.int64],
    positions: NDArray[Any],
    places: NDArray[np.float64],
    emission: Any,  # noqa: ANN401
    found: Coloring,
    stretched: Mapping[str, Any],
) -> Stars:
    """Return particles as points that shine.

    Parameters
    ----------
    particles
        All particles.
    rows
        Which of them are drawn, (k,).
    positions
        Where these are, (k, 3).
    places
        Translations of the copies of all, (m, 3).
    emission
        How much light they give: the name of a column, a number, or an array (n,).
    found
        Their colours.
    stretched
        How light becomes brightness: ``stretch``, ``softening`` and ``peak``, as for `Stars`.

    Raises
    ------
    SceneError
        There is no such column, or a value is not right.
    """
    given = emission
    if isinstance(emission, str):
        called = column_called(emission, particles.columns)
        if called not in particles.columns and emission not in POSITION:
            words = f"expected a number or the name of a column, got {show(emission)}"
            raise SceneError(f"emission: {words}; {columns_like(emission, particles)}")
        given = particles[emission]
    # All are checked, so that a message has the number of the particle.
    values = {"center": particles.positions, "emission": given, "color": (0, 0, 0), **stretched}
    light: Any = Stars.from_arrays(values, PLACE).emission
    colors = found.colors
    if not isinstance(light, float):
        light = np.tile(light[rows], len(places))
    if colors.ndim == 2:
        colors = np.tile(colors, (len(places), 1))
    if len(places) > 1:
        positions = (places[:, None] + positions).reshape(-1, 3)
    stars = Stars(positions, light, colors, **stretched)
    return stars.with_scale(found.scale)
