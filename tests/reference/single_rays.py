"""The light of a pixel as rays tell it that are traced one at a time."""

import numpy as np

from vtray.geometry.caps import new_caps
from vtray.geometry.packets.cone import new_touching
from vtray.geometry.packets.fan import new_fan
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.transport.integrators import reference
from vtray.transport.sampling.estimate import AS_NEEDED
from vtray.transport.sampling.fans import Fans
from vtray.transport.scene_arrays import SceneArrays


def lit_pixel(
    arrays: SceneArrays, x: int, y: int, fans: Fans, seed: int
) -> tuple[reference.TracedPixel, int]:
    """Return a pixel with the light of all lamps, and the most fans that one of them took."""
    points, soft = arrays.lights.points or 1, arrays.lights.soft
    assert soft is not None
    stack, cosines, blockers = new_stack(), np.zeros(points), np.full(points, NOTHING)
    fan, on_ways = new_fan(), np.full(fans.rays, NOTHING)
    traced = reference.trace_pixel(arrays, x, y, stack, cosines, blockers, new_walk(0))
    most, spent = 0, 0.0
    if traced.primitive != NOTHING:
        for light in range(len(soft.kind)):
            lamp = reference.trace_lamp(
                arrays,
                soft,
                traced,
                x,
                y,
                light,
                fans,
                AS_NEEDED,
                spent,
                seed,
                stack,
                fan,
                on_ways,
                new_walk(0),
                new_touching(),
                new_caps(),
            )
            traced, spent = traced._replace(value=lamp.value), spent + lamp.counted
            most = max(most, lamp.fans)
    return traced, most
