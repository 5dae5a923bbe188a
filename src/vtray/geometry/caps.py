"""How much light comes from the directions that are within several caps, in closed form.

A cap is a part of the unit sphere that a plane cuts off: the directions in which a round lamp is
seen, those above a horizon, or those that pass by a ball. What is within all of some caps is a
patch whose border are arcs of their circles, and Lambert's formula adds up light along a border:
from a patch that is equally bright everywhere, a surface with the normal n gets half the integral
of n * (r x dr). Along an arc about the axis a of a cap, from s to e, through the angle t, that is

    sine^2 t (n * a) + cosine n * (a x (e - s)).

The arcs need not be put in order: of the ends e and starts s on a circle their sums are enough, and
of the angles between them the sum modulo a turn, which is that of all arcs.

References
----------
Lambert, "Photometria", 1760 (polygons); Snyder, "Area Light Sources for Real-Time Graphics",
Microsoft Research, 1996 (a disc cut by a horizon).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.circle import PI, angle_of
from vtray.geometry.vector import Vec, add, cross, dot, scale, sub

MOST_CAPS = 8
"""So many caps can be put together."""

UNKNOWN = -1.0
"""In place of light that rounding could change much."""

CLOSE = 1e-9
"""Nearer than this, it is not told on which side of a circle something is, or arcs that are much
longer or shorter."""

LEAST_SINE = 1e-3
"""Caps that are smaller lose too many digits."""


class Caps(NamedTuple):
    """Some caps, and notes on the arcs of their circles, each (``MOST_CAPS``,).

    Attributes
    ----------
    x, y, z
        The unit vectors in their middles.
    cosine, sine
        Those of the angle from there to their border. What is less than a quarter turn from the
        middle has a cosine above 0; the sine is never below.
    from_x, from_y, from_z
        The first end or start on a circle, from its middle.
    along, across
        The vector whose angle is that of all arcs on it; 0 if it has neither ends nor starts.
    open
        How many ends of arcs there are more than starts.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    cosine: NDArray[np.float64]
    sine: NDArray[np.float64]
    from_x: NDArray[np.float64]
    from_y: NDArray[np.float64]
    from_z: NDArray[np.float64]
    along: NDArray[np.float64]
    across: NDArray[np.float64]
    open: NDArray[np.int64]


def new_caps() -> Caps:
    """Return the scratch memory of one thread."""

    def numbers() -> NDArray[np.float64]:
        return np.zeros(MOST_CAPS)

    return Caps(
        x=numbers(),
        y=numbers(),
        z=numbers(),
        cosine=numbers(),
        sine=numbers(),
        from_x=numbers(),
        from_y=numbers(),
        from_z=numbers(),
        along=numbers(),
        across=numbers(),
        open=np.zeros(MOST_CAPS, np.int64),
    )


@device
def set_cap(caps: Caps, k: int, axis: Vec, cosine: float, sine: float) -> None:
    """Set a cap, by the unit vector in its middle and its angle."""
    caps.x[k], caps.y[k], caps.z[k] = axis
    caps.cosine[k], caps.sine[k] = cosine, sine


@device
def swap_caps(caps: Caps, one: int, other: int) -> None:
    """Let two caps change places."""
    axis, cosine, sine = _axis(caps, one), caps.cosine[one], caps.sine[one]
    set_cap(caps, one, _axis(caps, other), caps.cosine[other], caps.sine[other])
    set_cap(caps, other, axis, cosine, sine)


@device
def light_within(caps: Caps, count: int, normal: Vec) -> float:
    """Return the light that comes from the directions within all of some caps.

    Parameters
    ----------
    caps, count
        The caps, so many; one of them is what is above the horizon of the surface, or all of
        another is above it.
    normal
        The unit normal of the surface.

    Returns
    -------
    float
        The integral of the cosine between normal and direction over the patch, pi for all that is
        above the horizon; or ``UNKNOWN``.
    """
    for k in range(count):
        caps.open[k], caps.along[k], caps.across[k] = 0, 0.0, 0.0
        if caps.sine[k] < LEAST_SINE:
            return UNKNOWN
    total = 0.0
    for one in range(1, count):
        for other in range(one):
            added = _add_corners(caps, count, one, other, normal)
            if math.isinf(added):
                return UNKNOWN
            total += added
    for k in range(count):
        turn = _turn_on(caps, count, k)
        if turn < 0.0:
            return UNKNOWN
        total += caps.sine[k] * caps.sine[k] * turn * dot(normal, _axis(caps, k))
    return max(0.5 * total, 0.0)


@device
def _axis(caps: Caps, k: int) -> Vec:
    """Return the middle of a cap."""
    return caps.x[k], caps.y[k], caps.z[k]


@device
def _add_corners(caps: Caps, count: int, one: int, other: int, normal: Vec) -> float:
    """Note the corners of the patch where two circles cross; return what they add to its border.

    That is infinite if it cannot be told which corners there are.
    """
    a, b = _axis(caps, one), _axis(caps, other)
    cosine, cosine_b = caps.cosine[one], caps.cosine[other]
    sines, apart = caps.sine[one] * caps.sine[other], dot(a, b)
    across = cross(a, b)
    across2, beside = dot(across, across), apart - cosine * cosine_b
    height2 = sines * sines - beside * beside
    if across2 < CLOSE * sines:
        return math.inf if height2 > -CLOSE * sines * sines else 0.0
    if height2 <= 0.0:
        return 0.0
    inverse = 1.0 / across2
    foot = add(
        scale((cosine - cosine_b * apart) * inverse, a),
        scale((cosine_b - cosine * apart) * inverse, b),
    )
    height = math.sqrt(height2) * inverse
    arm, total = sub(scale(cosine, a), scale(cosine_b, b)), 0.0
    for side in range(2):
        # Counter-clockwise about its middle, the circle of the one leaves the cap of the other at
        # the first corner, and enters it at the second; that of the other does it the other way.
        sign = 1.0 - 2.0 * side
        corner = add(foot, scale(sign * height, across))
        nearest = _inside(caps, count, corner, one, other)
        if abs(nearest) < CLOSE:
            return math.inf
        if nearest > 0.0:
            total += sign * dot(normal, cross(arm, corner))
            _note_corner(caps, one, corner, 1 - 2 * side)
            _note_corner(caps, other, corner, 2 * side - 1)
    return total


@device
def _inside(caps: Caps, count: int, place: Vec, one: int, other: int) -> float:
    """Return how far a direction is within all caps but two, below 0 if it is not within one."""
    least = 1.0
    for k in range(count):
        if k not in (one, other):
            least = min(least, dot(_axis(caps, k), place) - caps.cosine[k])
    return least


@device
def _note_corner(caps: Caps, k: int, corner: Vec, sign: int) -> None:
    """Note an end (1) or a start (-1) of an arc on the circle of a cap."""
    axis, inverse = _axis(caps, k), 1.0 / caps.sine[k]
    arm = scale(inverse, sub(corner, scale(caps.cosine[k], axis)))
    caps.open[k] += sign
    along, across = caps.along[k], caps.across[k]
    if along == 0.0 and across == 0.0:
        caps.from_x[k], caps.from_y[k], caps.from_z[k] = arm
        caps.along[k] = 1.0
        return
    first = caps.from_x[k], caps.from_y[k], caps.from_z[k]
    x, y = dot(arm, first), sign * dot(arm, cross(axis, first))
    # Vectors of length 1, as complex numbers, are multiplied by adding their angles.
    caps.along[k], caps.across[k] = along * x - across * y, along * y + across * x


@device
def _turn_on(caps: Caps, count: int, k: int) -> float:
    """Return the angle of all arcs on the circle of a cap, below 0 if it is too close to call."""
    along, across = caps.along[k], caps.across[k]
    if along == 0.0 and across == 0.0:
        # All of the circle is within the other caps, or nothing.
        axis = _axis(caps, k)
        place = add(scale(caps.cosine[k], axis), scale(caps.sine[k], _square_to(axis)))
        nearest = _inside(caps, count, place, k, k)
        if abs(nearest) < CLOSE:
            return UNKNOWN
        return 2.0 * PI if nearest > 0.0 else 0.0
    if caps.open[k] != 0 or (along > 0.0 and abs(across) < CLOSE):
        return UNKNOWN
    angle = angle_of(along, across)
    return angle if angle > 0.0 else angle + 2.0 * PI


@device
def _square_to(axis: Vec) -> Vec:
    """Return a unit vector square to another."""
    x, y, z = axis
    if abs(x) < 0.5:
        inverse = 1.0 / math.sqrt(y * y + z * z)
        return 0.0, -z * inverse, y * inverse
    inverse = 1.0 / math.sqrt(x * x + z * z)
    return -z * inverse, 0.0, x * inverse
