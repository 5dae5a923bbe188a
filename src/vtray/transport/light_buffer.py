"""What is kept of every ray so that lights and colours can be changed without tracing again.

For each ray, that is what it hit, and for each component of a light the cosine with which it
arrives there, 0 where it does not. From these the light of the picture is added up anew, by the
same operations in the same order as in tracing, so that not a bit differs.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    HALF,
    KEPT,
    NO_PRIMITIVE,
    PRIMITIVE,
    SOURCE,
    WEIGHT,
    Packet,
    integers,
)
from vtray.geometry.vector import Vec, add, scale
from vtray.transport.fog import FogFrame, lane_share
from vtray.transport.lights.light import lamp_light, lamp_number, load_power
from vtray.transport.lights.lighting import arriving_cosine
from vtray.transport.materials.material import load_material, scattered
from vtray.transport.scene_arrays import SceneArrays


class KeptLight(NamedTuple):
    """What is kept of the rays of a pass; arrays of no length if nothing is.

    Attributes
    ----------
    first
        The place of the first ray of each pixel, -1 for a pixel without rays, (height, width).
    primitive
        What each ray hits, -1 for nothing, less for a lamp, (places,).
    half
        1 where that is the second half of a shape that has two, else 0, (places,).
    weight
        What each ray counts for its pixel, 1 or -1, (places,).
    cosines
        The cosine for each component of a light, (components, places).
    clear
        How much of its light fog leaves, (places,); None if there is none.
    """

    first: NDArray[np.int64]
    primitive: NDArray[np.int32]
    half: NDArray[np.int8]
    weight: NDArray[np.int8]
    cosines: NDArray[np.float64]
    clear: Any


def new_kept_light(
    first: NDArray[np.int64], places: int, components: int, *, has_fog: bool
) -> KeptLight:
    """Return what will be kept of a pass with so many rays."""
    return KeptLight(
        first,
        np.empty(places, np.int32),
        np.empty(places, np.int8),
        np.empty(places, np.int8),
        np.zeros((components, places)),
        np.ones(places) if has_fog else None,
    )


def nothing_kept(*, has_fog: bool) -> KeptLight:
    """Return what tells kernels to keep nothing: they are the same as those that keep light."""
    return new_kept_light(np.zeros((0, 0), np.int64), 0, 0, has_fog=has_fog)


@device
def keep_ray(packet: Packet, lane: int, place: int, kept: KeptLight, fog: FogFrame | None) -> None:
    """Keep what a ray hits and what it counts for."""
    numbers = integers(packet)
    numbers[KEPT + lane] = place
    kept.primitive[place] = numbers[PRIMITIVE + lane]
    kept.half[place] = numbers[HALF + lane]
    kept.weight[place] = int(packet[WEIGHT + lane])
    _keep_clear(packet, lane, place, kept.clear, fog)


@device
def _keep_clear(packet: Packet, lane: int, place: int, clear: Any, fog: FogFrame | None) -> None:  # noqa: ANN401
    """Keep how much of the light along a ray fog leaves, if there is any."""
    if clear is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if fog is not None:
            clear[place] = 1.0 - lane_share(packet, lane, fog)


@device
def keep_cosines(
    packet: Packet, hits: int, target: Target, light: int, cosines: NDArray[np.float64]
) -> None:
    """Keep the cosine of a light at the hits that it reaches, if it is kept."""
    if cosines.shape[0] == 0:
        return
    numbers = integers(packet)
    for hit in range(hits):
        place = numbers[KEPT + numbers[SOURCE + hit]]
        cosines[light, place] = arriving_cosine(packet, hit, target)


@kernel
def add_up_rows(
    scene: SceneArrays,
    kept: KeptLight,
    samples: int,
    top: int,
    bottom: int,
    linear: NDArray[np.float64],
) -> None:
    """Add up the light of the pixels of some rows.

    Parameters
    ----------
    scene
        The scene as it was traced, but for its materials and the intensities of its lights.
    kept
        What was kept of the rays.
    samples
        How many rays each pixel has, if it has any.
    top, bottom
        The rows from the first to before the last.
    linear
        Out: linear light, (height, width, 3).
    """
    for row in range(top, bottom):
        for column in range(linear.shape[1]):
            first = kept.first[row, column]
            if first < 0:
                continue
            light = (0.0, 0.0, 0.0)
            total = 0.0
            for place in range(first, first + samples):
                weight = float(kept.weight[place])
                value = _cleared(_light_of_ray(scene, kept, place), place, kept.clear)
                light = add(light, scale(weight, value))
                total += weight
            linear[row, column, 0] = light[0] / total
            linear[row, column, 1] = light[1] / total
            linear[row, column, 2] = light[2] / total


@device
def _cleared(light: Vec, place: int, clear: Any) -> Vec:  # noqa: ANN401
    """Return what fog leaves of the light along a ray."""
    return light if clear is None else scale(clear[place], light)


@device
def _light_of_ray(scene: SceneArrays, kept: KeptLight, place: int) -> Vec:
    """Return the light along a ray."""
    value = (0.0, 0.0, 0.0)
    primitive = int(kept.primitive[place])
    if primitive < NO_PRIMITIVE:
        return lamp_light(scene.lights, lamp_number(primitive))
    if primitive != NO_PRIMITIVE:
        material = load_material(scene.materials, primitive, int(kept.half[place]))
        for row in range(kept.cosines.shape[0]):
            cosine, power = kept.cosines[row, place], load_power(scene.lights, row)
            value = add(value, scattered(material, cosine, power))
    return value
