"""Which rays of a fan may meet a ball: all are asked at once, in single precision.

Sets of rays are the bits of an integer. A ray that is left out misses the ball, whatever rounding
does; of the others, nearly all meet it.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, written_in_llvm
from vtray.geometry.bvh.boxes import Singles
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh
from vtray.geometry.packets.beam import NEVER
from vtray.geometry.packets.fan import BLOCKED, DIRECTION, FAN, SINGLES, Fan, Spot
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.vector import Vec, magnitude

OCTET = 8
"""Rays that are asked at once."""

NONE = np.uint64(0)
"""The set of no rays."""

ONE = np.uint64(1)

SINGLE_ERROR = 2.0**-20
"""Bound on the error of a product of a direction and a way in single precision, relative to the
way: four times the six roundings of half 2**-23."""

SINGLE_TINY = 1e-43
"""The same where numbers are so small that they have fewer digits."""

SINGLE_HUGE = 1e15
"""Up to this size, squares and what comes of them are numbers of single precision."""

REACH = 8.0
"""No ball around a box has a larger radius, in the space of the boxes."""

FAR_SHARE = 2.001
"""More than the square of a sum is of the sum of two squares, in single precision."""


class View(NamedTuple):
    """Where rays start, as the boxes of a hierarchy see it, in their space and single precision.

    Attributes
    ----------
    apex, normal
        The point, and the unit normal above which all rays are.
    margin
        How far rounding, and that they start apart, may have moved the boxes against the rays.
    limit2
        ``FAR_SHARE`` times the square of how far from there they end.
    below, tilt
        How far below the plane through the point what they meet may be, and by how much more for
        each unit of distance.
    """

    apex: Singles
    normal: Singles
    margin: np.float32
    limit2: np.float32
    below: np.float32
    tilt: np.float32


@device
def view_from(apex: Vec, spot: Spot, ratio: float, margin: float, longest: float) -> View:
    """Return how boxes are seen from a spot, which is no farther away than ``SINGLE_HUGE``.

    Parameters
    ----------
    apex, ratio
        The middle of the spot in the space of the boxes, and how large a unit is there.
    spot, longest
        The spot, and how long rays are at the most.
    margin
        How far rounding may have moved what the rays are tested for in that space, in doubles.
    """
    extent = ratio * spot.extent
    length = min(ratio * longest + extent, SINGLE_HUGE)
    error = margin + 2.0 * SINGLE_ERROR * (magnitude(apex) + REACH)
    return View(
        narrow(apex),
        narrow(spot.normal),
        np.float32(error + extent),
        np.float32(FAR_SHARE * length * length),
        np.float32(4.0 * error + ratio * spot.sunk),
        np.float32((1.0 + SINGLE_ERROR) * spot.tilt),
    )


@device
def narrow(vector: Vec) -> Singles:
    """Return a vector in single precision."""
    return np.float32(vector[0]), np.float32(vector[1]), np.float32(vector[2])


@written_in_llvm("vtray.geometry.packets.fan_in_llvm:write_balls_seen")
def balls_seen(bvh: Bvh, first: int, view: View, balls: NDArray[np.float32]) -> int:
    """Return a bit for each box of a node that rays may meet, by what is known of all of them.

    Parameters
    ----------
    bvh, first
        The node, by where its sides begin.
    view
        Where the rays start.
    balls
        Out: what `rays_along` is given for the ball around each box: the ways, x, y, z, and how far
        rays must go along them, (32,).
    """
    low, high = bvh.sides[first : first + SIDES].reshape(2, 3, WIDTH)
    single = np.float32
    half, middle = single(0.5) * (high - low), single(0.5) * (low + high)
    way = middle - np.array(view.apex, single)[:, None]
    normal = np.array(view.normal, single)[:, None]
    rise, tall = _sum(way * normal), _sum(half * abs(normal))
    margin = view.margin
    # The sum of the three is more than the radius.
    radius2 = _sum(half * half) + margin * (single(2.0) * _sum(half) + margin)
    distance2 = _sum(way * way)
    tangent2 = distance2 * single(1.0 - SINGLE_ERROR) - radius2 * single(1.0 + SINGLE_ERROR)
    tangent = np.sqrt(np.where(tangent2 > 0.0, tangent2, single(0.0)))
    error = single(SINGLE_ERROR) * _sum(abs(way))
    balls[: 3 * WIDTH] = way.reshape(-1)
    balls[3 * WIDTH :] = np.where(tangent2 > 0.0, tangent - error, single(-NEVER))
    lowest = view.below + view.tilt * (_sum(abs(way)) + _sum(half))
    rises = rise + tall >= -lowest
    is_near = distance2 <= view.limit2 + single(FAR_SHARE) * radius2
    seen = (low[0] <= high[0]) & rises & is_near
    return int(np.packbits(seen, bitorder="little")[0])


def _sum(rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the sum of three rows."""
    total: NDArray[np.float32] = rows[0] + rows[1] + rows[2]
    return total


@written_in_llvm("vtray.geometry.packets.packet_in_llvm:write_singles")
def singles_of(fan: Fan) -> NDArray[np.float32]:
    """Return the memory of a fan as numbers of single precision."""
    return fan.view(np.float32)


@device
def narrow_directions(fan: Fan, rays: int) -> None:
    """Set the directions in single precision."""
    singles = singles_of(fan)
    for ray in range(rays):
        singles[2 * SINGLES + ray] = fan[DIRECTION + ray]
        singles[2 * SINGLES + FAN + ray] = fan[DIRECTION + FAN + ray]
        singles[2 * SINGLES + 2 * FAN + ray] = fan[DIRECTION + 2 * FAN + ray]


@device
def open_rays(fan: Fan, rays: int) -> np.uint64:
    """Return the rays that nothing stops so far."""
    found = NONE
    for ray in range(rays):
        found |= (ONE if fan[BLOCKED + ray] == 0.0 else NONE) << np.uint64(ray)
    return found


@device
def set_ball(
    balls: NDArray[np.float32],
    k: int,
    way: Vec,
    tangent2: float,
    margin: float,
    starts_inside: bool,
) -> None:
    """Set what `rays_along` is given for a ball.

    Parameters
    ----------
    balls, k
        Out: the balls, and the place of this one; as those of `balls_seen`.
    way
        From where the rays start to the centre.
    tangent2
        The square of the distance to where a ray touches the ball: that to the centre less that of
        the radius, which is wider than rounding could explain. Below 0 they start within it.
    margin
        How far rounding, and that rays start apart, may have moved the ball against the rays.
    starts_inside
        Whether they may start inside the ball if they start within it, and not only on it: then
        those that lead away from its centre meet it, too.
    """
    # With m = way * direction, a ray meets the ball if m > 0 and way^2 - m^2 < radius^2. From
    # elsewhere, by a step s of no more than the margin, that is to say m > s * direction, and
    # way^2 - m^2 < (radius + the part of s square to the direction)^2. The wider ball, with the
    # margin in its radius, holds all those ways for which m may be below 0 then.
    tangent = math.sqrt(tangent2) if tangent2 > 0.0 else -margin
    least = tangent - SINGLE_ERROR * magnitude(way) - SINGLE_TINY
    x, y, z = narrow(way)
    balls[k] = x
    balls[WIDTH + k] = y
    balls[2 * WIDTH + k] = z
    balls[3 * WIDTH + k] = -NEVER if starts_inside & (tangent2 <= 0.0) else least


@device
def rays_along(fan: Fan, rays: int, way: Singles, least: np.float32) -> np.uint64:
    """Return the rays on which a unit of length is at least so far along a way.

    Where they are no whole octets, more may be among them than there are.
    """
    singles = singles_of(fan)
    found = NONE
    for octet in range((rays + OCTET - 1) // OCTET):
        met = octet_within(singles, 2 * SINGLES + OCTET * octet, FAN, way, least)
        found |= met << np.uint64(OCTET * octet)
    return found


@device
def rays_between(fan: Fan, rays: int, sides: Sides, slack: float) -> np.uint64:
    """Return the rays that are in all of some half-spaces, as far as single precision can tell.

    A ray may lead out of one by so much for each unit of length.
    """
    least = np.float32(-SINGLE_ERROR - slack)
    found = rays_along(fan, rays, narrow(sides.one), least)
    found &= rays_along(fan, rays, narrow(sides.other), least)
    return found & rays_along(fan, rays, narrow(sides.end), least)


@written_in_llvm("vtray.geometry.packets.fan_in_llvm:write_octet_within")
def octet_within(
    singles: NDArray[np.float32],
    first: int,
    step: int,
    way: Singles,
    least: np.float32,
) -> np.uint64:
    """Return a bit for each of eight directions along which a way goes at least so far.

    Parameters
    ----------
    singles, first, step
        Where the eight x stand, and how many numbers later y, and then z.
    way, least
        The way, and how far.
    """
    x, y, z = (singles[first + k * step :][:OCTET] * way[k] for k in range(3))
    return np.uint64(np.packbits(x + y + z >= least, bitorder="little")[0])
