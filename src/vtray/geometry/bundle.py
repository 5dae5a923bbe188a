"""Bundles: all rays beside one, and from where to where they meet a shape.

A bundle is what proves that rays beside each other tell the same: those of all samples that a pixel
may have, or those from a patch of a surface to a light. At a distance ``t`` along its middle ray,
its rays are at ``origin + t * direction + width(t) * e``, each with an offset ``e`` of its own. For
the rays of a camera the offsets fill a disc of radius 1, square to the middle ray. For shadow rays
they fill an ellipse: the shadow that such a disc around a ray of the camera throws along this ray
on the surface where they start.

Whatever is left open counts as touched: the bounds may be wide, but are never too narrow.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.ray import EVERYWHERE, Footprint, Ray
from vtray.geometry.vector import Vec, dot, scale, sub


class Bundle(NamedTuple):
    """The rays beside one.

    Attributes
    ----------
    origin, direction
        The ray in the middle.
    width, growth
        How wide the bundle is at its start, and by how much it grows with each unit of length.
    stretch
        The length of the longest offset.
    sight, slant
        Of an ellipse, the direction of the ray of the camera, and the normal of the surface divided
        by its product with that; None for a disc. The surface that rays of a disc meet is looked
        at, so that its edges and halves count.
    first, last
        What the rays meet counts from there on, for each of them from somewhere between the two.
    is_cut
        Whether a shape may begin before that.
    """

    origin: Vec
    direction: Vec
    width: float
    growth: float
    stretch: float
    sight: Vec | None
    slant: Vec | None
    first: float
    last: float
    is_cut: bool


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


class Passage(NamedTuple):
    """From where to where the rays of a bundle enter a solid, and where they leave it.

    Attributes
    ----------
    enters, leaves
        Where they do.
    covers
        Whether all of them meet it; if not, the far end of `enters` and the near one of `leaves`
        say nothing.
    """

    enters: Crossing
    leaves: Crossing
    covers: bool


@device
def image_plane_range(ray: Ray, footprint: Footprint) -> tuple[float, float]:
    """Return from where to where the rays of a pixel pass through the image plane.

    Without one, that is their start.
    """
    height, descent = -ray.plane_depth, ray.forward
    spread = math.sqrt(max(1.0 - descent * descent, 0.0))
    least, most = descent - footprint.growth * spread, descent + footprint.growth * spread
    end = (height + footprint.width * spread) / least if least > 0.0 else math.inf
    start = (height - footprint.width * spread) / most
    has_plane = ray.plane_depth < EVERYWHERE
    return start if has_plane else 0.0, end if has_plane else 0.0


@device
def bundle_width(bundle: Bundle, distance: float) -> float:
    """Return how wide a bundle is at a distance along its middle ray."""
    return max(bundle.width + bundle.growth * distance, 0.0)


@device
def spread_along(bundle: Bundle, direction: Vec) -> float:
    """Return how far the offsets of a bundle reach in a direction."""
    return _spread_along(bundle.direction, bundle.sight, bundle.slant, direction)


@device
def _spread_along(middle: Vec, sight: Vec | None, slant: Vec | None, direction: Vec) -> float:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if sight is not None:  # noqa: SIM102
        if slant is not None:
            offset = sub(direction, scale(dot(sight, direction), slant))
            return math.sqrt(dot(offset, offset))
    offset = sub(direction, scale(dot(middle, direction), middle))
    return math.sqrt(dot(offset, offset))


@device
def spread_beside(bundle: Bundle, beside: Vec, gap: float) -> float:
    """Return how far the offsets reach in the direction of a vector square to the middle ray.

    `gap` is the length of the vector; any direction will do for one of length 0.
    """
    return _spread_beside(bundle.sight, bundle.slant, beside, gap)


@device
def _spread_beside(sight: Vec | None, slant: Vec | None, beside: Vec, gap: float) -> float:
    if sight is not None:  # noqa: SIM102
        if slant is not None:
            offset = sub(beside, scale(dot(sight, beside), slant))
            return math.sqrt(dot(offset, offset)) / gap if gap > 0.0 else 0.0
    return 1.0


@device
def spread_ahead(bundle: Bundle) -> float:
    """Return how far the offsets reach along the middle ray."""
    return _spread_ahead(bundle.direction, bundle.sight, bundle.slant)


@device
def _spread_ahead(middle: Vec, sight: Vec | None, slant: Vec | None) -> float:
    if sight is not None:  # noqa: SIM102
        if slant is not None:
            return _spread_along(middle, sight, slant, middle)
    return 0.0


@device
def is_looked_at(sight: Vec | None) -> bool:
    """Tell whether edges and halves of what a bundle meets count, given its `sight`."""
    return sight is None


@device
def first_crossing(passage: Passage, bundle: Bundle) -> Crossing:
    """Return where the rays of a bundle first meet a solid, of all that counts."""
    enters, leaves, covers = passage
    is_before = covers & (enters.near > bundle.last)
    is_within = covers & (enters.far < bundle.first) & (leaves.near > bundle.last)
    is_behind = leaves.far <= bundle.first
    near = enters.near if is_before else leaves.near if is_within else enters.near
    near = math.inf if is_behind else max(near, bundle.first)
    far = enters.far if is_before else leaves.far if is_within else math.inf
    return Crossing(near, math.inf if is_behind else far)
