"""What the ray of a pixel sees: layers of faded bodies, and what is behind, as users get it."""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import uncompiled
from vtray.figures.traced_rays import Hit, Layer, WayToLight
from vtray.geometry.packets.layer_notes import AT_ONCE, new_layers, new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, add
from vtray.geometry.world import body_count
from vtray.rendering.pixel import Pixel, hit_of, ways_to_lights
from vtray.transport.fog import fog_share
from vtray.transport.integrators.reference import TracedPixel, trace_pixel
from vtray.transport.integrators.reference_layers import (
    list_pixel,
    trace_dimmed_pixel,
    trace_layer,
)
from vtray.transport.lights.light import light_count


class Behind(NamedTuple):
    """What is behind all layers.

    Attributes
    ----------
    traced
        The ray, and what it hits.
    hit, lights
        That, and the ways to all lights; None and empty where nothing is hit.
    share
        How much of the light from there is seen: what passes all layers, and fog if anything in the
        scene is faded.
    """

    traced: TracedPixel
    hit: Hit | None
    lights: tuple[WayToLight, ...]
    share: float


def look_through(pixel: Pixel) -> tuple[tuple[Layer, ...], Behind, Vec]:
    """Return the layers of a pixel, the nearest first, what is behind them, and all their light."""
    arrays = pixel.packed.arrays
    bodies, points = body_count(arrays.world), uncompiled(light_count)(arrays.lights)
    cosines, blockers = np.zeros(points), np.full(points, NOTHING)
    stack, walk, notes = new_stack(), new_walk(bodies), new_layers(bodies)
    scene = pixel.packed.given
    traced = trace_pixel(scene, *pixel.place, stack, cosines, blockers, walk)
    found: list[Layer] = []
    share, light = 1.0, (0.0, 0.0, 0.0)
    if arrays.world.faded is not None:
        given = scene, arrays.world.faded, *pixel.place, traced.distance, traced.primitive
        count = AT_ONCE
        while len(found) < count:
            count = list_pixel(*given, len(found), notes, walk, stack)
            for k in range(int(notes.listed[0])):
                fog = _fog_before(pixel, notes.distance[k])
                notes.share[k] *= 1.0 - fog
                layer = trace_layer(scene, *pixel.place, notes, k, stack, cosines, blockers, walk)
                hit = hit_of(pixel, layer, pixel.packed.before)
                ways, light_of_layer = ways_to_lights(pixel, layer, hit, cosines, blockers)
                found.append(Layer(hit, layer.share, ways, light_of_layer, fog))
                light = uncompiled(add)(light, light_of_layer)
            share = float(notes.passed[0])
            if not count:
                break
        if is_met(traced):
            share *= 1.0 - _fog_before(pixel, traced.distance)
        traced = trace_dimmed_pixel(scene, *pixel.place, share, stack, cosines, blockers, walk)
    if traced.primitive == NOTHING:
        behind = Behind(traced, None, (), share)
        return tuple(found), behind, uncompiled(add)(light, traced.value)
    hit = hit_of(pixel, traced, pixel.packed.before)
    ways, light_behind = ways_to_lights(pixel, traced, hit, cosines, blockers)
    return tuple(found), Behind(traced, hit, ways, share), uncompiled(add)(light, light_behind)


def is_met(traced: TracedPixel) -> bool:
    """Tell whether the ray of a pixel meets a surface or a lamp."""
    return bool(traced.primitive != NOTHING or traced.lamp != NOTHING)


def _fog_before(pixel: Pixel, distance: float) -> float:
    """Return how much of what is seen at a distance, in the arrays' units, is fog."""
    fog = pixel.packed.arrays.fog
    return 0.0 if fog is None else uncompiled(fog_share)(fog, float(distance))
