"""Rays that wait to be followed: those that go on from what the rays of a packet meet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import LANES
from vtray.geometry.ray import Ray
from vtray.geometry.vector import Vec

NUMBERS = 20
"""Numbers of a ray that waits: those of the ray, and what `Waiting` says of it."""


class Waiting(NamedTuple):
    """A ray that waits.

    Attributes
    ----------
    ray
        The ray.
    seen
        How much of the light along it is seen, for red, green and blue, from 0 to 1.
    bounces
        How many surfaces lie between it and the camera.
    sees_lights
        Whether it sees lamps and skies; else their light was added where it comes from.
    within
        The row of the material within which it goes, -1 for none.
    density
        That with which its direction was chosen, where light that it meets is looked for by shadow
        rays, too; else 0.
    normal
        The unit normal of the surface that it comes from.
    """

    ray: Ray
    seen: Vec
    bounces: int
    sees_lights: bool
    within: int
    density: float
    normal: Vec


class Pending(NamedTuple):
    """The rays that wait, a stack for each lane of a packet.

    Attributes
    ----------
    numbers
        All of them, (lanes * depth * ``NUMBERS``,).
    waiting
        How many wait in each lane, (lanes,).
    depth
        How many may wait in a lane.
    """

    numbers: NDArray[np.float64]
    waiting: NDArray[np.int64]
    depth: int


def new_pending(bounces: int) -> Pending:
    """Return the stacks for so many bounces, -1 for none at all.

    Each bounce leaves at most three rays behind, that on a blend of two glasses.
    """
    depth = 3 * bounces + 1 if bounces >= 0 else 0
    lanes = LANES if depth > 0 else 0
    return Pending(np.zeros(lanes * depth * NUMBERS), np.zeros(lanes, np.int64), depth)


@device
def clear_pending(pending: Pending, lanes: int) -> None:
    """Begin with no ray in any lane."""
    for lane in range(lanes):
        pending.waiting[lane] = 0


@device
def push_ray(pending: Pending, lane: int, waiting: Waiting) -> None:
    """Let a ray wait in a lane."""
    begin = (lane * pending.depth + pending.waiting[lane]) * NUMBERS
    numbers, ray = pending.numbers, waiting.ray
    for k in range(3):
        numbers[begin + k] = ray.origin[k]
        numbers[begin + 3 + k] = ray.direction[k]
        numbers[begin + 6 + k] = waiting.seen[k]
        numbers[begin + 17 + k] = waiting.normal[k]
    numbers[begin + 9] = ray.plane_depth
    numbers[begin + 10] = ray.forward
    numbers[begin + 11] = ray.error_scale
    numbers[begin + 12] = ray.error_bound
    numbers[begin + 13] = waiting.bounces
    numbers[begin + 14] = 1.0 if waiting.sees_lights else 0.0
    numbers[begin + 15] = waiting.within
    numbers[begin + 16] = waiting.density
    pending.waiting[lane] += 1


@device
def pop_ray(pending: Pending, lane: int) -> Waiting:
    """Take the ray that came last in a lane, in which at least one waits."""
    pending.waiting[lane] -= 1
    begin = (lane * pending.depth + pending.waiting[lane]) * NUMBERS
    numbers = pending.numbers
    ray = Ray(
        (numbers[begin], numbers[begin + 1], numbers[begin + 2]),
        (numbers[begin + 3], numbers[begin + 4], numbers[begin + 5]),
        numbers[begin + 9],
        numbers[begin + 10],
        numbers[begin + 11],
        numbers[begin + 12],
    )
    seen = numbers[begin + 6], numbers[begin + 7], numbers[begin + 8]
    bounces, within = int(numbers[begin + 13]), int(numbers[begin + 15])
    normal = numbers[begin + 17], numbers[begin + 18], numbers[begin + 19]
    sees_lights = numbers[begin + 14] != 0.0
    return Waiting(ray, seen, bounces, sees_lights, within, numbers[begin + 16], normal)
