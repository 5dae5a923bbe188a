"""What is kept of every ray so that lights and colours can be changed without tracing again.

For each ray, that is what it hit, and for each component of a light the cosine with which it
arrives there, 0 where it does not. From these the light of the picture is added up anew, by the
same operations in the same order as in tracing, so that not a bit differs.
"""

from typing import NamedTuple

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
)
from vtray.geometry.vector import add, scale
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
    """

    first: NDArray[np.int64]
    primitive: NDArray[np.int32]
    half: NDArray[np.int8]
    weight: NDArray[np.int8]
    cosines: NDArray[np.float64]


def new_kept_light(first: NDArray[np.int64], places: int, components: int) -> KeptLight:
    """Return what will be kept of a pass with so many rays."""
    return KeptLight(
        first,
        np.empty(places, np.int32),
        np.empty(places, np.int8),
        np.empty(places, np.int8),
        np.zeros((components, places)),
    )


def nothing_kept() -> KeptLight:
    """Return what tells kernels to keep nothing: they are the same as those that keep light."""
    return new_kept_light(np.zeros((0, 0), np.int64), 0, 0)


@device
def keep_ray(packet: Packet, lane: int, place: int, kept: KeptLight) -> None:
    """Keep what a ray hits and what it counts for."""
    numbers = packet.view(np.int64)
    numbers[KEPT + lane] = place
    kept.primitive[place] = numbers[PRIMITIVE + lane]
    kept.half[place] = numbers[HALF + lane]
    kept.weight[place] = int(packet[WEIGHT + lane])


@device
def keep_cosines(
    packet: Packet, hits: int, target: Target, light: int, cosines: NDArray[np.float64]
) -> None:
    """Keep the cosine of a light at the hits that it reaches, if it is kept."""
    if cosines.shape[0] == 0:
        return
    numbers = packet.view(np.int64)
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
                light = add(light, scale(weight, _light_of_ray(scene, kept, place)))
                total += weight
            linear[row, column, 0] = light[0] / total
            linear[row, column, 1] = light[1] / total
            linear[row, column, 2] = light[2] / total


@device
def _light_of_ray(scene: SceneArrays, kept: KeptLight, place: int) -> tuple[float, float, float]:
    """Return the light along a ray."""
    value = (0.0, 0.0, 0.0)
    primitive = int(kept.primitive[place])
    if primitive < NO_PRIMITIVE:
        return lamp_light(scene.lights, lamp_number(primitive))
    if primitive != NO_PRIMITIVE:
        material = load_material(scene.materials, primitive, kept.half[place] == 1)
        for row in range(kept.cosines.shape[0]):
            cosine, power = kept.cosines[row, place], load_power(scene.lights, row)
            value = add(value, scattered(material, cosine, power))
    return value
