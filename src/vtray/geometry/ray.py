"""Rays, the ways between two points, and how wide a ray's pixel is.

All places are in the kernels' space, whose origin is the centre of the image plane. Nothing behind
the image plane exists: what a ray meets at a plane depth of 0 or less is not there.
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, scale, sub

CORNER = 1.5
"""How far beyond its edges a shape reaches that is larger by 1 to all sides: more than √2."""


EVERYWHERE = 2.0**500
"""The plane depth of everything where there is no image plane: far more than any other."""


class Ray(NamedTuple):
    """A half-line.

    Attributes
    ----------
    origin
        Where it starts.
    direction
        Its unit direction.
    plane_depth
        How far before the image plane it starts; below 0 if behind.
    forward
        By how much the plane depth grows with each unit of length along the ray.
    error_scale
        What the rounding error of a point of the ray is relative to, beside the distance and what
        is met there.
    error_bound
        How far rounding may have moved the start from the surface on which it lies; 0 for a ray
        that starts anywhere, as those of a camera do.
    """

    origin: Vec
    direction: Vec
    plane_depth: float
    forward: float
    error_scale: float
    error_bound: float


class Segment(NamedTuple):
    """The way from a point on a surface to where light comes from.

    Attributes
    ----------
    start, end
        The point, and the light.
    start_plane_depth, end_plane_depth
        Their distances in front of the image plane.
    start_scale, end_scale
        What their rounding errors are relative to, beside what stands in the way.
    """

    start: Vec
    end: Vec
    start_plane_depth: float
    end_plane_depth: float
    start_scale: float
    end_scale: float


class Footprint(NamedTuple):
    """How wide the part of the scene is around a ray that its pixel is made of.

    Attributes
    ----------
    width
        At the start of the ray.
    growth
        By how much it grows with each unit of length along the ray.
    """

    width: float
    growth: float


@device
def ray_point(ray: Ray, distance: float) -> Vec:
    """Return the point of a ray at a distance from its start."""
    return add(ray.origin, scale(distance, ray.direction))


class Way(NamedTuple):
    """The part of the way between two points that lies in front of the image plane.

    Attributes
    ----------
    way, end
        From its start to its end, and where that is.
    end_bound
        How far rounding may have moved the end.
    """

    way: Vec
    end: Vec
    end_bound: float


@device
def way_in_front(segment: Segment, error_bound: float, end_bound: float) -> Way:
    """Return the way from a point up to where it passes through the image plane, if it does.

    Parameters
    ----------
    segment
        The way to where light comes from.
    error_bound, end_bound
        How far rounding may have moved its start and its end.
    """
    way, end = sub(segment.end, segment.start), segment.end
    if segment.end_plane_depth < 0.0:
        share = segment.start_plane_depth / (segment.start_plane_depth - segment.end_plane_depth)
        way = scale(share, way)
        end = add(segment.start, way)
        end_bound = error_bound + share * end_bound
    return Way(way, end, end_bound)


@device
def has_width(footprint: Footprint | None) -> bool:
    """Tell whether a footprint is more than the ray itself."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if footprint is None:
        return False
    return (footprint.width > 0.0) | (footprint.growth > 0.0)


@device
def some_footprint(footprint: Footprint | None) -> Footprint:
    """Return a footprint, without width for None, for code that is the same for both."""
    if footprint is None:
        return Footprint(0.0, 0.0)
    return footprint


@device
def width_at(footprint: Footprint | None, distance: float) -> float:
    """Return how far from a ray its pixel's part of the scene reaches at a distance."""
    if footprint is None:
        return 0.0
    return footprint.width + footprint.growth * distance


@device
def growth_of(footprint: Footprint | None) -> float:
    """Return by how much a footprint grows with each unit of length along the ray."""
    if footprint is None:
        return 0.0
    return footprint.growth


@device
def reach_at(footprint: Footprint | None, distance: float) -> float:
    """Return how far from a ray a shape may be that the ray would meet if it were a width larger.

    Larger to all sides, it reaches farther than that beyond its edges.
    """
    return CORNER * width_at(footprint, distance)
