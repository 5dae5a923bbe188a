"""Where the samples of a pixel go through the lens.

They have the points of a Sobol sequence as their places in the image have, scrambled by other keys
and dealt anew, so that where a sample goes through the pixel says nothing of where it goes through
the lens.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import BLOCK, LANES, LENS_DOWN, LENS_RIGHT, Block, Packet
from vtray.geometry.packets.workspace import Pixels
from vtray.geometry.warps import disc_point
from vtray.transport.camera_rays import LensFrame
from vtray.transport.sampling.paths import Paths, dealt_point
from vtray.transport.sampling.sobol import (
    LENS_ORDER,
    LENS_PLACE,
    pixel_keys,
)


@device
def place_in_lens(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    rays: int,
    first: int,
    last: int,
    pixels: Pixels,
    seed: int,
    deal: Paths | None,
    lens: LensFrame | None,
) -> None:
    """Set where the rays of a packet go through the lens, if there is one.

    Parameters
    ----------
    packet
        Its rows ``LENS_RIGHT`` and ``LENS_DOWN`` are set, for all lanes.
    block, begin, end, first, last, pixels
        Which samples of which pixels the lanes belong to, as in `place_samples`.
    rays
        How many rays pixels have; that of one goes through the middle of the lens.
    seed
        That of the picture.
    deal
        Points of Sobol's sequence, which are dealt to the samples.
    lens
        The lens.
    """
    # Arguments that are None are known to the compiler, which drops what depends on them alone.
    if lens is None or deal is None:
        return
    if rays == 1:
        for lane in range(LANES):
            packet[LENS_RIGHT + lane] = 0.0
            packet[LENS_DOWN + lane] = 0.0
        return
    samples = last - first
    for k in range(begin, end):
        pixel = pixels[k]
        column, row = block.left + pixel % BLOCK, block.top + pixel // BLOCK
        order, _ = pixel_keys(column, row, LENS_ORDER, seed)
        one, other = pixel_keys(column, row, LENS_PLACE, seed)
        for sample in range(samples):
            u, v = dealt_point(deal, first + sample, order, one, other)
            lane = (k - begin) * samples + sample
            right, down = place_in_opening(lens.corners, u, v)
            packet[LENS_RIGHT + lane] = right
            packet[LENS_DOWN + lane] = down
    lanes = (end - begin) * samples
    for lane in range(lanes, LANES):
        packet[LENS_RIGHT + lane] = packet[LENS_RIGHT + lanes - 1]
        packet[LENS_DOWN + lane] = packet[LENS_DOWN + lanes - 1]


@device
def place_in_opening(corners: NDArray[np.float64], u: float, v: float) -> tuple[float, float]:
    """Return a point of an opening of radius 1, uniform by area, for one of the unit square.

    A polygon is a fan of triangles around its middle: v goes around its edge, and the root of u
    from the middle to there.

    Parameters
    ----------
    corners
        As in `LensFrame`.
    u, v
        The point, from 0 to below 1.
    """
    sides = corners.shape[0] - 1
    if sides < 0:
        return disc_point(u, v)
    around = v * sides
    # The product may be rounded up to the number of sides.
    side = min(int(around), sides - 1)
    along, out = around - side, math.sqrt(u)
    right = corners[side, 0] + along * (corners[side + 1, 0] - corners[side, 0])
    down = corners[side, 1] + along * (corners[side + 1, 1] - corners[side, 1])
    return out * right, out * down
