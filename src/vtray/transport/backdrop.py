"""The sky as the camera sees it where nothing is hit."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.packets.packet import LANES, WEIGHT, Block, Packet
from vtray.geometry.packets.workspace import Pixels
from vtray.geometry.vector import Vec, add, scale
from vtray.transport.camera_rays import CameraFrame, sample_ray
from vtray.transport.lights.sky import Skies
from vtray.transport.sampling.pixel_samples import Sampling, place_samples
from vtray.transport.sampling.sky_map import light_towards


@kernel
def see_sky(
    camera: CameraFrame,
    skies: Skies,
    sky: int,
    sampling: Sampling,
    cover: NDArray[np.float64],
    top: int,
    bottom: int,
    packet: Packet,
    pixels: Pixels,
    seen: NDArray[np.float64],
) -> None:
    """Look at a sky of many colours through the pixels of some rows.

    Parameters
    ----------
    camera
        The camera.
    skies, sky
        The sky.
    sampling
        Which rays go through a pixel.
    cover
        How much of each pixel is covered, (height, width); where all is, nothing is written.
    top, bottom
        The rows from the first to before the last.
    packet, pixels
        Scratch memory.
    seen
        Out: red, green and blue, 1 for the radiance of the sky, ≥ 0, (height, width, 3).
    """
    for row in range(top, bottom):
        for column in range(camera.width):
            if cover[row, column] < 1.0:
                light = _light_of_pixel(camera, skies, sky, sampling, column, row, packet, pixels)
                for channel in range(3):
                    # Filters with negative sides go below 0 beside what is very bright.
                    seen[row, column, channel] = max(light[channel], 0.0)


@device
def _light_of_pixel(
    camera: CameraFrame,
    skies: Skies,
    sky: int,
    sampling: Sampling,
    column: int,
    row: int,
    packet: Packet,
    pixels: Pixels,
) -> Vec:
    """Return the mean of a sky over the rays of a pixel, weighted as samples are."""
    block = Block(column, row, 1, 1, 0, 0)
    pixels[0] = 0
    light, total = (0.0, 0.0, 0.0), 0.0
    for first in range(0, sampling.rays, LANES):
        last = min(first + LANES, sampling.rays)
        place_samples(packet, block, 0, 1, sampling, first, last, pixels, camera.lens)
        for lane in range(last - first):
            direction = sample_ray(camera, packet, lane).direction
            weight = packet[WEIGHT + lane]
            light = add(light, scale(weight, light_towards(skies, sky, direction)))
            total += weight
    return light[0] / total, light[1] / total, light[2] / total
