"""Bundles: all rays beside one, and from where to where they meet a shape.

A bundle is what proves that rays beside each other tell the same: those of all samples that a pixel
may have, or those from a patch of a surface to a light. At a distance ``t`` along its middle ray,
its rays are at ``origin + t * direction + width(t) * e``, each with an offset ``e`` of its own from
one ellipse: the shadow of a disc of radius 1, square to ``sight``, on a plane. For the rays of a
camera that plane is square to them; for shadow rays it is the surface on which they start.

Whatever is left open counts as touched: the bounds may be wide, but are never too narrow.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import Footprint, Ray
from vtray.geometry.vector import Vec, dot, scale, sub


class Bundle(NamedTuple):
    """The rays beside one.

    Attributes
    ----------
    origin, direction
        The ray in the middle.
    width, growth
        How wide the bundle is at its start, and by how much it grows with each unit of length.
    sight, slant
        Of the ellipse of offsets: the direction to which the disc is square, and the normal of the
        plane, divided by its product with that direction.
    stretch
        The length of the longest offset.
    first, last
        What the rays meet counts from there on, for each of them from somewhere between the two.
    is_seen
        Whether the surface that is met is looked at, so that its edges and halves count.
    """

    origin: Vec
    direction: Vec
    width: float
    growth: float
    sight: Vec
    slant: Vec
    stretch: float
    first: float
    last: float
    is_seen: bool


class Crossing(NamedTuple):
    """From where to where the rays of a bundle first meet a shape.

    Attributes
    ----------
    near
        None meets it before; infinite if none does.
    far
        All have met it by then; infinite if one may not.
    """

    near: float
    far: float


@device
def camera_bundle(ray: Ray, footprint: Footprint) -> Bundle:
    """Return the rays of a pixel, which count from the image plane on."""
    height, descent = -ray.plane_depth, ray.forward
    spread = math.sqrt(max(1.0 - descent * descent, 0.0))
    least, most = descent - footprint.growth * spread, descent + footprint.growth * spread
    end = (height + footprint.width * spread) / least if least > 0.0 else math.inf
    return Bundle(
        ray.origin,
        ray.direction,
        footprint.width,
        footprint.growth,
        ray.direction,
        ray.direction,
        1.0,
        (height - footprint.width * spread) / most,
        end,
        True,
    )


@device
def bundle_width(bundle: Bundle, distance: float) -> float:
    """Return how wide a bundle is at a distance along its middle ray."""
    return max(bundle.width + bundle.growth * distance, 0.0)


@device
def spread_along(bundle: Bundle, direction: Vec) -> float:
    """Return how far the offsets of a bundle reach in a direction."""
    offset = sub(direction, scale(dot(bundle.sight, direction), bundle.slant))
    return math.sqrt(dot(offset, offset))


@device
def first_crossing(enters: Crossing, leaves: Crossing, covers: bool, bundle: Bundle) -> Crossing:
    """Return where the rays of a bundle first meet a solid, of all that counts.

    Parameters
    ----------
    enters, leaves
        From where to where they enter and leave it.
    covers
        Whether all of them do.
    bundle
        The rays.
    """
    is_before = covers & (enters.near > bundle.last)
    is_within = covers & (enters.far < bundle.first) & (leaves.near > bundle.last)
    is_behind = leaves.far <= bundle.first
    near = enters.near if is_before else leaves.near if is_within else enters.near
    near = math.inf if is_behind else max(near, bundle.first)
    far = enters.far if is_before else leaves.far if is_within else math.inf
    return Crossing(near, math.inf if is_behind else far)
