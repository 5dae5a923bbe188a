"""Clip planes and slices between others: they turn the shortest way, and move evenly."""

import math
from collections.abc import Sequence
from typing import TypeVar

from vtray.animation.keyframes import BEFORE, ApartError, part_way, straight
from vtray.scene.clip import ClipPlane, Slice
from vtray.scene.placing.directions import Vec, dot, unit
from vtray.scene.vectors import Direction, Vector

Plane_ = TypeVar("Plane_", ClipPlane, Slice)

OPPOSITE = 1e-9 - 1.0
"""The cosine of the angle from which on no way between two normals is the shortest."""


def between_clips(
    one: Sequence[ClipPlane], other: Sequence[ClipPlane], share: float
) -> tuple[ClipPlane, ...]:
    """Return the planes at a share of the way from some to as many others, from 0 to 1.

    Raises
    ------
    ApartError
        There are not as many, or there is no way from one to its partner.
    """
    if len(one) != len(other):
        words = f"as many planes as {BEFORE} has, {len(one)}"
        raise ApartError(f"expected {words}, got {len(other)}")
    return tuple(_between(a, b, share) for a, b in zip(one, other, strict=True))


def between_slices(one: Slice, other: Slice, share: float) -> Slice:
    """Return the slab at a share of the way from one to another, from 0 to 1; see above."""
    found = _between(one, other, share)
    return found.replace(thickness=straight(one.thickness, other.thickness, share))


def _between(one: Plane_, other: Plane_, share: float) -> Plane_:
    """Return the plane at a share of the way from one to another."""
    if one.objects != other.objects:
        words = f"a plane that cuts the objects that {BEFORE} cuts, {_shown(one.objects)}"
        raise ApartError(f"expected {words}, got {_shown(other.objects)}")
    if _place(one) != _place(other):
        words = f"a plane with {_place(one)}, as {BEFORE} has"
        raise ApartError(f"expected {words}, got {_place(other)}")
    distance, center = one.distance, one.center
    if distance is not None and other.distance is not None:
        distance = straight(distance, other.distance, share)
    if center is not None and other.center is not None:
        start, end = center, other.center
        x, y, z = (straight(getattr(start, i), getattr(end, i), share) for i in "xyz")
        center = Vector(x, y, z)
    normal = _turned(one.normal, other.normal, share)
    return one.replace(normal=normal, distance=distance, center=center)


def _turned(one: Direction, other: Direction, share: float) -> Direction:
    """Return the direction at a share of the shortest turn from one to another."""
    if one == other or share >= 1.0:
        return other
    start, end = unit(one), unit(other)
    if dot(start, end) < OPPOSITE:
        words = "a normal that is not opposite to that of"
        raise ApartError(f"expected {words} {BEFORE}; put a keyframe between them")
    return Direction(*part_way(start, end, share, _middle))


def _middle(one: Vec, other: Vec) -> Vec:
    """Return the unit vector in the middle of two that are not opposite."""
    x, y, z = (a + b for a, b in zip(one, other, strict=True))
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def _place(plane: ClipPlane | Slice) -> str:
    """Say in what way it is said where a plane is."""
    if plane.distance is not None:
        return "a distance"
    return "no distance" if plane.center is None else "a center"


def _shown(objects: tuple[int, ...] | None) -> str:
    return "all" if objects is None else str([*objects])
