"""A rectangle as it is seen from a point: how large it is, and directions that fill it evenly.

All is said in a frame of the rectangle whose origin is the point: x and y along the edges, and z
towards the plane of the rectangle. With the longitude of a direction, tan(longitude) = x / z, and
its latitude, the line of one longitude in the rectangle spans latitudes from ``lower`` to
``upper``, of which sines are y / sqrt(x^2 + y^2 + z^2). The *excess* of a line is the solid angle
between it and the middle of the frame, x = 0: it grows evenly as directions fill the rectangle.
With ``a`` and ``b`` the latitudes of the two edges that are parallel to x, where x is 0, and with
``e`` the excess, Girard's theorem gives ::

    tan(longitude) = sin(e) / sqrt((cos(e) + cos(a + b)) * (cos(e) - cos(b - a)))

which is the map of Ureña and others in a form without differences of numbers that are nearly the
same: 1 - cosine is what is worked with. So a small or distant rectangle keeps its digits.

References
----------
Ureña, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles", Computer
Graphics Forum 32 (4), 2013; van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", IEEE
Transactions on Biomedical Engineering 30 (2), 1983.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.circle import PI, angle_of, cosine_sine
from vtray.geometry.vector import Vec


class SphericalRectangle(NamedTuple):
    """A rectangle as it is seen from a point, lengths in any unit.

    Attributes
    ----------
    across, up, toward
        The frame: unit vectors along the edges, and from the point to the rectangle's plane.
    left, right, bottom, top
        Where the edges are along `across` and along `up`.
    height
        How far away the plane is, > 0.
    solid_angle
        That of the whole rectangle, in steradians.
    first
        The excess of the edge `left`.
    widest, narrowest
        1 - the cosines of the largest excess that a line could have, were the rectangle endless to
        both sides: of what is left to the poles, and of what is between the edges.
    """

    across: Vec
    up: Vec
    toward: Vec
    left: float
    right: float
    bottom: float
    top: float
    height: float
    solid_angle: float
    first: float
    widest: float
    narrowest: float


@device
def spherical_rectangle(
    frame: tuple[Vec, Vec, Vec], middle: tuple[float, float, float], half: tuple[float, float]
) -> SphericalRectangle:
    """Return how a rectangle is seen.

    Parameters
    ----------
    frame
        As in `SphericalRectangle`.
    middle
        The rectangle's middle in that frame; its plane is at some distance, > 0.
    half
        Half the lengths of the edges, > 0.
    """
    x, y, height = middle
    left, right = x - half[0], x + half[0]
    bottom, top = y - half[1], y + half[1]
    solid_angle = _solid_angle(left, right, bottom, top, height, half)
    # Where x is 0, how far the edges are, and sine and cosine of what lies between them.
    low, high = _length(0.0, bottom, height), _length(0.0, top, height)
    wide = 2.0 * half[1] * height / (low * high)
    narrowest = _versine(wide, (height * height + bottom * top) / (low * high))
    slant = (bottom + top) * height / (low * high)
    widest = _versine(slant, (bottom * top - height * height) / (low * high))
    first = _excess(left, bottom, top, height, half[1])
    across, up, toward = frame
    return SphericalRectangle(
        across,
        up,
        toward,
        left,
        right,
        bottom,
        top,
        height,
        solid_angle,
        first,
        widest,
        narrowest,
    )


@device
def rectangle_direction(u: float, v: float, seen: SphericalRectangle) -> Vec:
    """Return a direction to a rectangle, uniform by solid angle, for a point of the unit square."""
    cosine, sine = cosine_sine((seen.first + u * seen.solid_angle) * (1.0 / PI))
    # Of a fourth of the excess; now of half of it.
    sine, cosine = 2.0 * sine * cosine, 1.0 - 2.0 * sine * sine
    versine = 2.0 * sine * sine
    rest = (seen.widest - versine) * (seen.narrowest - versine)
    slope = 2.0 * sine * cosine / math.sqrt(max(rest, LEAST))
    x = min(max(slope * seen.height, seen.left), seen.right)
    distance2 = x * x + seen.height * seen.height
    lower = seen.bottom / math.sqrt(distance2 + seen.bottom * seen.bottom)
    upper = seen.top / math.sqrt(distance2 + seen.top * seen.top)
    latitude = lower + v * (upper - lower)
    y = latitude * math.sqrt(distance2 / max(1.0 - latitude * latitude, LEAST))
    y = min(max(y, seen.bottom), seen.top)
    per_length = 1.0 / math.sqrt(distance2 + y * y)
    x, y, z = per_length * x, per_length * y, per_length * seen.height
    across, up, toward = seen.across, seen.up, seen.toward
    return (
        x * across[0] + y * up[0] + z * toward[0],
        x * across[1] + y * up[1] + z * toward[1],
        x * across[2] + y * up[2] + z * toward[2],
    )


LEAST = 1e-300
"""Keeps divisors from 0, where rounding makes them so; the result is beyond the edges then."""


@device
def square_integral(height: float, half: tuple[float, float]) -> float:
    """Return the integral of the cosine over a rectangle, for a surface squarely below its middle.

    Parameters
    ----------
    height
        How far away the rectangle is.
    half
        Half the lengths of the edges, > 0.

    References
    ----------
    Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 (four times).
    """
    a, b = half
    from_a, from_b = _length(0.0, a, height), _length(0.0, b, height)
    return 2.0 * (a / from_a * angle_of(from_a, b) + b / from_b * angle_of(from_b, a))


@device
def _solid_angle(
    left: float,
    right: float,
    bottom: float,
    top: float,
    height: float,
    half: tuple[float, float],
) -> float:
    """Return the solid angle of a rectangle: that of the two triangles at a diagonal."""
    volume = height * (2.0 * half[0]) * (2.0 * half[1])
    near, far = _length(left, bottom, height), _length(right, top, height)
    together = left * right + bottom * top + height * height
    total = 0.0
    for corner in range(2):
        x, y = (right, bottom) if corner == 0 else (left, top)
        length = _length(x, y, height)
        beside = left * x + bottom * y + height * height
        beyond = right * x + top * y + height * height
        along = near * far * length + together * length + beside * far + beyond * near
        total += 2.0 * angle_of(along, volume)
    return total


@device
def _excess(x: float, bottom: float, top: float, height: float, half: float) -> float:
    """Return the excess of a line at x between two edges, which are twice `half` apart."""
    low, high = _length(x, bottom, height), _length(x, top, height)
    apart = top * low - bottom * high
    if bottom * top > 0.0:  # the same without a difference
        aside = x * x + height * height
        apart = 2.0 * half * (bottom + top) * aside / (top * low + bottom * high)
    return angle_of(height * height * low * high + x * x * bottom * top, x * height * apart)


@device
def _length(x: float, y: float, z: float) -> float:
    """Return the length of a vector."""
    return math.sqrt(x * x + y * y + z * z)


@device
def _versine(sine: float, cosine: float) -> float:
    """Return 1 - the cosine of an angle, also a small one, to nearly the last digit."""
    return sine * sine / (1.0 + cosine) if cosine > 0.0 else 1.0 - cosine
