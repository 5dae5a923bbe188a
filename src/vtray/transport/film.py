"""The film: what is recorded of each pixel, and how the samples of a pixel become its light."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BLOCK,
    DISTANCE,
    HALF,
    LANES,
    LIGHT,
    NO_PRIMITIVE,
    NORMAL,
    PRIMITIVE,
    RIM,
    SHADOWS,
    SOURCE,
    VALUE,
    WEIGHT,
    Block,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.workspace import Pixels, Sums
from vtray.geometry.vector import add, scale
from vtray.transport.light_buffer import KeptLight, keep_ray, nothing_kept


class Film(NamedTuple):
    """What kernels write of each pixel; what is not wanted has no rows and no columns.

    Attributes
    ----------
    left, top
        The pixel of the image at which it begins: 0, 0 where it is that of the whole image.
    linear
        Linear light, (height, width, 3).
    coverage
        Share of the pixel in which something is hit, (height, width).
    distance
        Along the middle ray, in the unit of the arrays, infinite for no hit, (height, width).
    normal
        At the middle ray's hit, on its side, 0 for no hit, (height, width, 3).
    primitive
        What the middle ray hits, -1 for nothing, (height, width).
    half
        1 where that is the second half of a shape that has two, else 0, (height, width).
    shadows
        A number for the lights that something keeps from the middle ray's hit, (height, width).
    rims
        Whether the outline of a sphere passes near the middle ray, (height, width).
    kept
        What is kept of all rays to change lights and colours afterwards.
    """

    left: int
    top: int
    linear: NDArray[np.float64]
    coverage: NDArray[np.float64]
    distance: NDArray[np.float64]
    normal: NDArray[np.float64]
    primitive: NDArray[np.int32]
    half: NDArray[np.int8]
    shadows: NDArray[np.float64]
    rims: NDArray[np.bool_]
    kept: KeptLight


def new_film(width: int, height: int, *wanted: str, left: int = 0, top: int = 0) -> Film:
    """Return a film for what is wanted, of no certain content."""

    def rows(name: str, kind: Any = np.float64, *more: int) -> NDArray[Any]:  # noqa: ANN401
        size = (height, width) if name in wanted else (0, 0)
        return np.empty((*size, *more), kind)

    return Film(
        left=left,
        top=top,
        linear=rows("linear", np.float64, 3),
        coverage=rows("coverage"),
        distance=rows("distance"),
        normal=rows("normal", np.float64, 3),
        primitive=rows("primitive", np.int32),
        half=rows("half", np.int8),
        shadows=rows("shadows"),
        rims=rows("rims", np.bool_),
        kept=nothing_kept(),
    )


@device
def is_wanted(rows: NDArray[np.generic]) -> bool:
    """Tell whether a part of a film is to be written."""
    count: int = rows.shape[0]
    return count > 0


@device
def keep_rays(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    first: int,
    last: int,
    pixels: Pixels,
    kept: KeptLight,
) -> None:
    """Keep what the samples from `first` to before `last` of pixels of a block's list hit."""
    samples = last - first
    for lane in range((end - begin) * samples):
        row, column = _place(block, pixels[begin + lane // samples])
        keep_ray(packet, lane, kept.first[row, column] + first + lane % samples, kept)


@device
def clear_sums(sums: Sums, pixels: int) -> None:
    """Start to add up the samples of some pixels."""
    for k in range(pixels):
        sums.light[k] = 0.0
        sums.light[k + LANES] = 0.0
        sums.light[k + 2 * LANES] = 0.0
        sums.covered[k] = 0.0
        sums.weight[k] = 0.0


@device
def add_samples(packet: Packet, lanes: int, hits: int, samples: int, sums: Sums) -> None:
    """Add the samples of a packet to their pixels, always in the order of their numbers."""
    numbers = packet.view(np.int64)
    _bring_back(packet, lanes, hits)
    for k in range(lanes // samples):
        light = load(sums.light, 0, k)
        covered = sums.covered[k]
        total = sums.weight[k]
        for lane in range(k * samples, (k + 1) * samples):
            weight = packet[WEIGHT + lane]
            light = add(light, scale(weight, load(packet, LIGHT, lane)))
            covered += weight if numbers[PRIMITIVE + lane] != NO_PRIMITIVE else 0.0
            total += weight
        store(sums.light, 0, k, light)
        sums.covered[k] = covered
        sums.weight[k] = total


@device
def _bring_back(packet: Packet, lanes: int, hits: int) -> None:
    """Bring the light of the hits back to the lanes of their rays."""
    numbers = packet.view(np.int64)
    for lane in range(lanes):
        store(packet, LIGHT, lane, (0.0, 0.0, 0.0))
    for hit in range(hits):
        store(packet, LIGHT, numbers[SOURCE + hit], load(packet, VALUE, hit))


@device
def write_pixels(
    block: Block, begin: int, end: int, pixels: Pixels, sums: Sums, film: Film
) -> float:
    """Write the sums of pixels of a block's list to the film; return their largest channel."""
    peak = 0.0
    for k in range(end - begin):
        row, column = _place(block, pixels[begin + k])
        weight = sums.weight[k]
        if is_wanted(film.linear):
            red, green, blue = load(sums.light, 0, k)
            film.linear[row, column, 0] = red / weight
            film.linear[row, column, 1] = green / weight
            film.linear[row, column, 2] = blue / weight
            peak = max(peak, red / weight, green / weight, blue / weight)
        if is_wanted(film.coverage):
            # Filters with negative sides go a little beyond.
            film.coverage[row, column] = min(max(sums.covered[k] / weight, 0.0), 1.0)
    return peak


@device
def write_middles(
    packet: Packet, block: Block, begin: int, end: int, hits: int, pixels: Pixels, film: Film
) -> float:
    """Write what is wanted of pixels with one ray, a lane for each; return the largest channel."""
    peak = 0.0
    if is_wanted(film.linear):
        if hits < end - begin:
            _clear(block, begin, end, pixels, film.linear)
        peak = _write_light(packet, block, begin, hits, pixels, film.linear)
    if is_wanted(film.normal):
        _clear(block, begin, end, pixels, film.normal)
        _write_normals(packet, block, begin, hits, pixels, film.normal)
    _write_rays(packet, block, begin, end, pixels, film)
    if is_wanted(film.shadows):
        _write_shadows(packet, block, begin, end, hits, pixels, film.shadows)
    return peak


@device
def _write_rays(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, film: Film
) -> None:
    """Write what is wanted of the rays themselves."""
    numbers = packet.view(np.int64)
    if is_wanted(film.distance):
        for lane in range(end - begin):
            row, column = _place(block, pixels[begin + lane])
            film.distance[row, column] = packet[DISTANCE + lane]
    if is_wanted(film.primitive):
        for lane in range(end - begin):
            row, column = _place(block, pixels[begin + lane])
            film.primitive[row, column] = numbers[PRIMITIVE + lane]
    if is_wanted(film.half):
        for lane in range(end - begin):
            row, column = _place(block, pixels[begin + lane])
            is_hit = numbers[PRIMITIVE + lane] != NO_PRIMITIVE
            film.half[row, column] = numbers[HALF + lane] if is_hit else 0
    if is_wanted(film.rims):
        for lane in range(end - begin):
            row, column = _place(block, pixels[begin + lane])
            rim = packet[RIM + lane]
            # Where neither is, both are infinite.
            film.rims[row, column] = (rim <= packet[DISTANCE + lane]) & (rim < math.inf)


@device
def _place(block: Block, pixel: int) -> tuple[int, int]:
    """Return row and column of a pixel of a block in the film."""
    return block.row + pixel // BLOCK, block.column + (pixel & (BLOCK - 1))


@device
def _clear(
    block: Block, begin: int, end: int, pixels: Pixels, vectors: NDArray[np.float64]
) -> None:
    """Write zeros for pixels of a block's list."""
    for lane in range(end - begin):
        row, column = _place(block, pixels[begin + lane])
        vectors[row, column, 0] = 0.0
        vectors[row, column, 1] = 0.0
        vectors[row, column, 2] = 0.0


@device
def _write_light(
    packet: Packet,
    block: Block,
    begin: int,
    hits: int,
    pixels: Pixels,
    linear: NDArray[np.float64],
) -> float:
    """Write the light of the hits; return the largest channel."""
    numbers = packet.view(np.int64)
    peak = 0.0
    for hit in range(hits):
        row, column = _place(block, pixels[begin + numbers[SOURCE + hit]])
        red, green, blue = load(packet, VALUE, hit)
        linear[row, column, 0] = red
        linear[row, column, 1] = green
        linear[row, column, 2] = blue
        peak = max(peak, red, green, blue)
    return peak


@device
def _write_normals(
    packet: Packet,
    block: Block,
    begin: int,
    hits: int,
    pixels: Pixels,
    normals: NDArray[np.float64],
) -> None:
    """Write the normals of the hits."""
    numbers = packet.view(np.int64)
    for hit in range(hits):
        row, column = _place(block, pixels[begin + numbers[SOURCE + hit]])
        for axis in range(3):
            normals[row, column, axis] = packet[NORMAL + axis * LANES + hit]


@device
def _write_shadows(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    shadows: NDArray[np.float64],
) -> None:
    """Write the numbers of the lights that something keeps from the hits."""
    numbers = packet.view(np.int64)
    for lane in range(end - begin):
        row, column = _place(block, pixels[begin + lane])
        shadows[row, column] = 0.0
    for hit in range(hits):
        row, column = _place(block, pixels[begin + numbers[SOURCE + hit]])
        shadows[row, column] = packet[SHADOWS + hit]
