"""What the kernels must know of the samples of a pixel."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.base.exact_math import tangent
from vtray.geometry.packets.packet import BLOCK, COLUMN, LANES, ROW, WEIGHT, Block, Packet
from vtray.geometry.packets.workspace import Pixels
from vtray.geometry.ray import Footprint
from vtray.scene.settings import RenderSettings
from vtray.transport.camera_rays import CameraFrame, LensFrame
from vtray.transport.sampling.fans import Fans
from vtray.transport.sampling.filters import FILTERS, filter_places, place_in_filter
from vtray.transport.sampling.lens_places import place_in_lens
from vtray.transport.sampling.paths import Paths, paths_of
from vtray.transport.sampling.sobol import IMAGE_PLACE, pixel_keys, scrambled, sobol_points

WIDEST = 2.0**400
"""A growth of footprints by which each holds the whole scene."""


STEEP = 60.0
"""Half the angle, in degrees, from which on all pixels of a panorama get samples."""

ABOVE = 1.0 + 2.0**-30
"""More than rounding adds to a tangent."""


class Sampling(NamedTuple):
    """Which rays are cast for which pixels.

    Attributes
    ----------
    rays
        Rays of a pixel; 1 is the ray through its middle.
    seed
        Chooses among equally good places.
    points
        Their places before they are scrambled, (2, count); None where no pixel has more than one
        ray, so that no code is compiled for samples.
    fans
        Which rays are cast to soft lights; None where there are none.
    places
        The table of the filter.
    positive
        Up to which distance the filter is not negative.
    footprint
        What belongs to the pixel of a ray, where it is asked whether all of it looks the same;
        else without width, or None where no pixel has more than one ray.
    thickest
        The radius of the thickest solid, as kernels count, where that is asked.
    marks
        The pixels that are traced, (height, width), or (0, 0) for all.
    paths
        How paths choose; None where none are followed.
    lens
        Points that are dealt to the samples as their places in the lens; None without a lens.
    """

    rays: int
    seed: int
    points: NDArray[np.int64] | None
    fans: Fans | None
    places: NDArray[np.float64]
    positive: float
    footprint: Footprint | None
    thickest: float
    marks: NDArray[np.bool_]
    paths: Paths | None = None
    lens: Paths | None = None


_NO_FOOTPRINT = Footprint(0.0, 0.0)


def middle_rays(
    footprint: Footprint = _NO_FOOTPRINT,
    thickest: float = 0.0,
    *,
    before_samples: bool = False,
    fans: Fans | None = None,
    paths: Paths | None = None,
    lens: Paths | None = None,
    seed: int = 0,
) -> Sampling:
    """Return one ray for each pixel, through its middle; if samples follow, for the same kernel."""
    none = np.zeros((0, 0), np.bool_)
    points = sobol_points(1) if before_samples else None
    wide = footprint if before_samples else None
    return Sampling(1, seed, points, fans, np.zeros(2), math.inf, wide, thickest, none, paths, lens)


def filter_samples(
    settings: RenderSettings,
    marks: NDArray[np.bool_],
    fans: Fans | None,
    paths: Paths | None = None,
    lens: Paths | None = None,
) -> Sampling:
    """Return the samples of the pixels that are marked."""
    return Sampling(
        int(settings.samples),
        int(settings.seed),
        sobol_points(int(settings.samples)),
        fans,
        filter_places(settings.filter),
        FILTERS[settings.filter].positive,
        _NO_FOOTPRINT,
        0.0,
        marks,
        paths,
        lens,
    )


def lens_points(camera: CameraFrame, samples: int) -> Paths | None:
    """Return the points that are dealt to samples as their places in the lens, if there is one."""
    return None if camera.lens is None else paths_of(samples)


def filter_footprint(settings: RenderSettings, camera: CameraFrame) -> Footprint:
    """Return how wide the part of the scene is that a pixel is made of."""
    reach = FILTERS[settings.filter].radius * math.sqrt(2.0)
    if camera.turn is not None:
        # Angles add up along any way over the sphere; 45 degrees are an eighth of a turn.
        degrees = 45.0 * reach * max(camera.turn.across, camera.turn.below)
        return Footprint(0.0, ABOVE * tangent(degrees) if degrees < STEEP else WIDEST)
    width, height, distance = camera.pixel
    slope = min(reach * max(width, height) / distance, 1.0)
    # Seen askew, it is wider beside the middle ray than seen squarely, by no more than that.
    growth = slope / (1.0 - 0.25 * slope * slope) if slope < 1.0 else WIDEST
    return Footprint(reach * max(camera.shift), growth)


@device
def list_pixels(block: Block, marks: NDArray[np.bool_], curve: Pixels, pixels: Pixels) -> int:
    """List the pixels of a block that are traced along its curve; return how many there are."""
    count = 0
    if marks.shape[0] == 0 and block.width == BLOCK and block.height == BLOCK:
        for k in range(BLOCK * BLOCK):
            pixels[k] = curve[k]
        return BLOCK * BLOCK
    for k in range(BLOCK * BLOCK):
        pixel = curve[k]
        column, row = pixel % BLOCK, pixel // BLOCK
        inside = column < block.width and row < block.height
        if inside and (marks.shape[0] == 0 or marks[block.top + row, block.left + column]):
            pixels[count] = pixel
            count += 1
    return count


@part
def place_samples(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    sampling: Sampling,
    first: int,
    last: int,
    pixels: Pixels,
    lens: LensFrame | None,
) -> int:
    """Set where the rays of a packet go through the image and the lens, and what they weigh.

    Parameters
    ----------
    packet
        Its rows ``COLUMN``, ``ROW`` and ``WEIGHT`` are set, for all lanes; with a lens, so are
        ``LENS_RIGHT`` and ``LENS_DOWN``.
    block, begin, end
        The pixels are those from `begin` to before `end` in the block's list.
    sampling, first, last
        Of each the samples from `first` to before `last`, one after the other.
    pixels
        The list.
    lens
        The lens; None for a pinhole.

    Returns
    -------
    int
        How many lanes are used; the others repeat the last.
    """
    lanes = (end - begin) * (last - first)
    if sampling.rays == 1:
        for lane in range(lanes):
            pixel = pixels[begin + lane]
            packet[COLUMN + lane] = block.left + (pixel & (BLOCK - 1))
            packet[ROW + lane] = block.top + pixel // BLOCK
            packet[WEIGHT + lane] = 1.0
    else:
        _place_in_pixels(packet, block, begin, end, sampling, sampling.points, first, last, pixels)
    for lane in range(lanes, LANES):
        packet[COLUMN + lane] = packet[COLUMN + lanes - 1]
        packet[ROW + lane] = packet[ROW + lanes - 1]
    place_in_lens(
        packet,
        block,
        begin,
        end,
        sampling.rays,
        first,
        last,
        pixels,
        sampling.seed,
        sampling.lens,
        lens,
    )
    return lanes


@device
def _place_in_pixels(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    sampling: Sampling,
    points: NDArray[np.int64] | None,
    first: int,
    last: int,
    pixels: Pixels,
) -> None:
    """Set the places and weights of samples of pixels of a block's list."""
    if points is None:
        return
    for k in range(begin, end):
        pixel = pixels[k]
        column, row = block.left + pixel % BLOCK, block.top + pixel // BLOCK
        lane = (k - begin) * (last - first)
        _place_in_pixel(packet, lane, column, row, sampling, points, first, last)
        _keep_positive(packet, lane, last - first)


@device
def _place_in_pixel(
    packet: Packet,
    lane: int,
    column: int,
    row: int,
    sampling: Sampling,
    points: NDArray[np.int64],
    first: int,
    last: int,
) -> None:
    """Set the places and weights of samples of one pixel."""
    key_x, key_y = pixel_keys(column, row, IMAGE_PLACE, sampling.seed)
    # A loop for each step: only so are they vectorised.
    _scramble(packet, COLUMN + lane, points, 0, first, last, key_x)
    _scramble(packet, ROW + lane, points, 1, first, last, key_y)
    _put_in_filter(packet, lane, last - first, sampling)
    for k in range(lane, lane + last - first):
        packet[COLUMN + k] += column
        packet[ROW + k] += row


@device
def _scramble(
    packet: Packet,
    to: int,
    points: NDArray[np.int64],
    axis: int,
    first: int,
    last: int,
    key: int,
) -> None:
    """Set a coordinate of samples from `first` to before `last`, from 0 to below 1."""
    for k in range(last - first):
        packet[to + k] = scrambled(points[axis, first + k], key)


@device
def _put_in_filter(packet: Packet, lane: int, samples: int, sampling: Sampling) -> None:
    """Turn coordinates from 0 to 1 into distances from the pixel; set what each sample weighs."""
    for k in range(lane, lane + samples):
        x = place_in_filter(sampling.places, packet[COLUMN + k])
        y = place_in_filter(sampling.places, packet[ROW + k])
        packet[COLUMN + k] = x
        packet[ROW + k] = y
        counts = (abs(x) <= sampling.positive) == (abs(y) <= sampling.positive)
        packet[WEIGHT + k] = 1.0 if counts else -1.0


@device
def _keep_positive(packet: Packet, lane: int, samples: int) -> None:
    """Let samples of a pixel in a packet count the same if half their weight would cancel."""
    total = 0.0
    for k in range(samples):
        total += packet[WEIGHT + lane + k]
    if total < 0.5 * samples:
        for k in range(samples):
            packet[WEIGHT + lane + k] = 1.0
