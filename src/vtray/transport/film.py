"""The film: what is recorded of each pixel, and how the samples of a pixel become its light."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BLOCK,
    COLOR,
    COVER,
    DISTANCE,
    FOGGED,
    GATHERED,
    HALF,
    LAMBERT,
    LANES,
    LIGHT,
    MET,
    MIXED,
    NO_PRIMITIVE,
    NOISE,
    NORMAL,
    PRIMITIVE,
    SEEN,
    SOURCE,
    TOWARDS,
    VALUE,
    WEIGHT,
    Block,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.workspace import Pixels, Sums
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.world import Faded, World
from vtray.transport.fog import FogFrame, lane_share
from vtray.transport.interaction import comes_from_within
from vtray.transport.light_buffer import KeptLight, keep_ray, nothing_kept
from vtray.transport.materials.look import Looks
from vtray.transport.materials.material import Materials, load_look
from vtray.transport.materials.reflectance import reflectance

Rows = Any
"""An array, or None for what is not wanted: as an argument of its own it is known to the compiler,
which drops all that follows ``if rows is None: return``."""


class Film(NamedTuple):
    """What kernels write of each pixel; what is not wanted is None, and no code is compiled for it.

    Attributes
    ----------
    left, top
        The pixel of the image at which it begins: 0, 0 where it is that of the whole image.
    linear
        Linear light, (height, width, 3).
    coverage
        Share of the pixel in which something is hit, (height, width); None for one ray a pixel,
        unless there are faded bodies.
    covered
        Whether the middle ray meets anything, lamps too, (height, width).
    fog
        Share of the pixel in which fog is seen, (height, width).
    error
        The standard error of light, that of the channel that has the largest, (height, width).
    mixed
        Whether what its filter weighs may not all look like the middle, (height, width); None
        likewise.
    distance
        Along the middle ray, in the unit of the arrays, infinite for no hit, (height, width).
    normal
        At the middle ray's hit, on its side, 0 for no hit, (height, width, 3).
    primitive
        What the middle ray hits, -1 for nothing, (height, width).
    met
        Where to find that, as `join_met` says it, of no meaning for nothing, (height, width).
    half
        As in field ``HALF`` of a packet, 0 where nothing is hit, (height, width).
    albedo
        The share of light that what the middle ray hits sends on, (height, width, 3); of faded
        bodies that of all layers, for films without `linear`.
    orders
        Linear light that surfaces scattered not at all, once, and more often: three channels for
        each, (height, width, 9). Arrays of no length say that it is not wanted; so it is with
        `kept`: both share their code with films that have none.
    kept
        What is kept of all rays to change lights and colours afterwards.
    """

    left: int
    top: int
    linear: Rows
    coverage: Rows
    covered: Rows
    fog: Rows
    error: Rows
    mixed: Rows
    distance: Rows
    normal: Rows
    primitive: Rows
    met: Rows
    half: Rows
    albedo: Rows
    orders: NDArray[np.float64]
    kept: KeptLight


def new_film(width: int, height: int, *wanted: str, left: int = 0, top: int = 0) -> Film:
    """Return a film for what is wanted, of no certain content."""

    def rows(name: str, kind: Any = np.float64, *more: int) -> Any:  # noqa: ANN401
        return np.empty((height, width, *more), kind) if name in wanted else None

    return Film(
        left=left,
        top=top,
        linear=rows("linear", np.float64, 3),
        coverage=rows("coverage"),
        covered=rows("covered", np.bool_),
        fog=rows("fog"),
        error=rows("error"),
        mixed=rows("mixed", np.bool_),
        distance=rows("distance"),
        normal=rows("normal", np.float64, 3),
        primitive=rows("primitive", np.int32),
        met=rows("met", np.int64),
        half=rows("half", np.int8),
        albedo=rows("albedo", np.float64, 3),
        orders=np.empty((height, width, 9) if "orders" in wanted else (0, 0, 9)),
        kept=nothing_kept(has_fog="fog" in wanted),
    )


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
    fog: FogFrame | None,
) -> None:
    """Keep what the samples from `first` to before `last` of listed pixels hit, if anything is."""
    if kept.first.shape[0] == 0:
        return
    samples = last - first
    for lane in range((end - begin) * samples):
        row, column = place_of(block, pixels[begin + lane // samples])
        keep_ray(packet, lane, kept.first[row, column] + first + lane % samples, kept, fog)


@device
def clear_sums(sums: Sums, pixels: int, coverage: Rows) -> None:
    """Start to add up the samples of some pixels."""
    if coverage is None:
        return
    for k in range(pixels):
        sums.light[k] = 0.0
        sums.light[k + LANES] = 0.0
        sums.light[k + 2 * LANES] = 0.0
        sums.covered[k] = 0.0
        sums.fogged[k] = 0.0
        sums.weight[k] = 0.0
        store(sums.plain, 0, k, (0.0, 0.0, 0.0))
        store(sums.squares, 0, k, (0.0, 0.0, 0.0))


@device
def add_samples(
    packet: Packet,
    lanes: int,
    hits: int,
    samples: int,
    sums: Sums,
    coverage: Rows,
    fog: FogFrame | None,
    faded: Faded | None,
) -> None:
    """Add the samples of a packet to their pixels, always in the order of their numbers."""
    if coverage is None:
        return
    _bring_back(packet, lanes, hits)
    for k in range(lanes // samples):
        light = load(sums.light, 0, k)
        covered = sums.covered[k]
        total = sums.weight[k]
        plain, squares = load(sums.plain, 0, k), load(sums.squares, 0, k)
        for lane in range(k * samples, (k + 1) * samples):
            weight = packet[WEIGHT + lane]
            value = load(packet, LIGHT, lane)
            light = add(light, scale(weight, value))
            plain = add(plain, value)
            squares = add(squares, (value[0] * value[0], value[1] * value[1], value[2] * value[2]))
            covered += weight * _cover_of(packet, lane, faded)
            total += weight
        store(sums.light, 0, k, light)
        sums.covered[k] = covered
        sums.weight[k] = total
        store(sums.plain, 0, k, plain)
        store(sums.squares, 0, k, squares)
    _add_fog(packet, lanes, samples, sums, fog, faded)


@device
def _add_fog(
    packet: Packet,
    lanes: int,
    samples: int,
    sums: Sums,
    fog: FogFrame | None,
    faded: Faded | None,
) -> None:
    """Add what the samples of a packet see of fog to their pixels."""
    if fog is None:
        return
    for k in range(lanes // samples):
        fogged = sums.fogged[k]
        for lane in range(k * samples, (k + 1) * samples):
            fogged += packet[WEIGHT + lane] * _fog_of(packet, lane, fog, faded)
        sums.fogged[k] = fogged


@device
def _cover_of(packet: Packet, lane: int, faded: Faded | None) -> float:
    """Return how much of what is behind everything the ray of a lane does not see."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is not None:
        cover: float = packet[COVER + lane]
        return cover
    return 1.0 if integers(packet)[PRIMITIVE + lane] != NO_PRIMITIVE else 0.0


@device
def _fog_of(packet: Packet, lane: int, fog: FogFrame, faded: Faded | None) -> float:
    """Return how much of what the ray of a lane sees is fog."""
    if faded is not None:
        fogged: float = packet[FOGGED + lane]
        return fogged
    return lane_share(packet, lane, fog)


@device
def _bring_back(packet: Packet, lanes: int, hits: int) -> None:
    """Bring the light of the hits back to the lanes of their rays; that of lamps is there."""
    numbers = integers(packet)
    for lane in range(lanes):
        if numbers[PRIMITIVE + lane] >= NO_PRIMITIVE:
            store(packet, LIGHT, lane, (0.0, 0.0, 0.0))
    for hit in range(hits):
        store(packet, LIGHT, numbers[SOURCE + hit], load(packet, VALUE, hit))


@device
def write_pixels(
    block: Block,
    begin: int,
    end: int,
    pixels: Pixels,
    sums: Sums,
    samples: int,
    linear: Rows,
    coverage: Rows,
    fog: Rows,
    error: Rows,
) -> float:
    """Write the sums of pixels of a block's list to the film; return their largest channel."""
    peak = 0.0
    if linear is None or coverage is None:
        return peak
    for k in range(end - begin):
        row, column = place_of(block, pixels[begin + k])
        weight = sums.weight[k]
        red, green, blue = load(sums.light, 0, k)
        linear[row, column, 0] = red / weight
        linear[row, column, 1] = green / weight
        linear[row, column, 2] = blue / weight
        peak = max(peak, red / weight, green / weight, blue / weight)
        _write_error(row, column, sums, k, samples, error)
        # Filters with negative sides go a little beyond.
        coverage[row, column] = min(max(sums.covered[k] / weight, 0.0), 1.0)
        _write_share(row, column, sums.fogged[k] / weight, fog)
    return peak


@device
def _write_share(row: int, column: int, share: float, rows: Rows) -> None:
    """Write the share of a pixel, from 0 to 1, that is something, if it is wanted."""
    if rows is not None:
        rows[row, column] = min(max(share, 0.0), 1.0)


@device
def _write_error(row: int, column: int, sums: Sums, k: int, samples: int, error: Rows) -> None:
    """Write the standard error of a pixel: that of independent samples, which is too much.

    Each sample x with the weight w, which is 1 or -1, adds ``w * (x - mean) / weights`` to what the
    mean is wrong by, so all add the sum of the squares of ``x - mean`` to its variance.
    """
    if error is None:
        return
    weight = sums.weight[k]
    most = 0.0
    for channel in range(3):
        place = channel * LANES + k
        mean = sums.light[place] / weight
        plain, squares = sums.plain[place], sums.squares[place]
        most = max(most, squares - 2.0 * mean * plain + samples * mean * mean)
    error[row, column] = math.sqrt(most) / abs(weight)


@device
def write_middles(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    film: Film,
    fog: FogFrame | None,
    world: World,
    materials: Materials,
) -> float:
    """Write what is wanted of pixels with one ray, a lane for each; return the largest channel."""
    peak = _write_light(packet, block, begin, end, hits, pixels, film.linear)
    _write_normals(packet, block, begin, end, hits, pixels, film.normal)
    _write_distances(packet, block, begin, end, pixels, film.distance)
    _write_primitives(packet, block, begin, end, pixels, film.primitive, film.mixed)
    _write_met(packet, block, begin, end, pixels, film.met)
    _write_halves(packet, block, begin, end, pixels, film.half)
    _write_albedos(
        packet,
        block,
        begin,
        end,
        hits,
        pixels,
        world,
        materials,
        materials.looks,
        world.faded,
        film.albedo,
    )
    _write_coverage(packet, block, begin, end, pixels, film.coverage, world.faded)
    _write_covered(packet, block, begin, end, pixels, film.covered)
    _write_fog(packet, block, begin, end, pixels, film.fog, fog, world.faded)
    _write_mixed(packet, block, begin, end, pixels, film.mixed)
    _write_noise(packet, block, begin, end, hits, pixels, film.error)
    return peak


@device
def _write_distances(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, distance: Rows
) -> None:
    """Write how far the rays go."""
    if distance is None:
        return
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        distance[row, column] = packet[DISTANCE + lane]


@device
def _write_primitives(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    pixels: Pixels,
    primitive: Rows,
    mixed: Rows,
) -> None:
    """Write what the rays hit."""
    if primitive is None:
        return
    field = PRIMITIVE if mixed is None else SEEN
    numbers = integers(packet)
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        primitive[row, column] = numbers[field + lane]


@device
def _write_met(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, met: Rows
) -> None:
    """Write where to find what the rays hit."""
    if met is None:
        return
    numbers = integers(packet)
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        met[row, column] = numbers[MET + lane]


@device
def _write_halves(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, half: Rows
) -> None:
    """Write which half of a shape the rays hit."""
    if half is None:
        return
    numbers = integers(packet)
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        is_hit = numbers[PRIMITIVE + lane] > NO_PRIMITIVE
        half[row, column] = numbers[HALF + lane] if is_hit else 0


@device
def _write_coverage(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    pixels: Pixels,
    coverage: Rows,
    faded: Faded | None,
) -> None:
    """Write how much of what is behind everything the rays do not see."""
    if coverage is None:
        return
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        coverage[row, column] = _cover_of(packet, lane, faded)


@device
def _write_covered(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, covered: Rows
) -> None:
    """Write whether the rays meet anything."""
    if covered is None:
        return
    numbers = integers(packet)
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        covered[row, column] = numbers[PRIMITIVE + lane] != NO_PRIMITIVE


@device
def _write_fog(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    pixels: Pixels,
    rows: Rows,
    fog: FogFrame | None,
    faded: Faded | None,
) -> None:
    """Write how much of what the rays see is fog."""
    if rows is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if fog is not None:
            for lane in range(end - begin):
                row, column = place_of(block, pixels[begin + lane])
                rows[row, column] = _fog_of(packet, lane, fog, faded)


@device
def _write_mixed(
    packet: Packet, block: Block, begin: int, end: int, pixels: Pixels, mixed: Rows
) -> None:
    """Write which pixels get samples."""
    if mixed is None:
        return
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        mixed[row, column] = packet[MIXED + lane] != 0.0


@device
def place_of(block: Block, pixel: int) -> tuple[int, int]:
    """Return row and column of a pixel of a block in the film."""
    return block.row + pixel // BLOCK, block.column + (pixel & (BLOCK - 1))


@device
def _clear(
    block: Block, begin: int, end: int, pixels: Pixels, vectors: NDArray[np.float64]
) -> None:
    """Write zeros for pixels of a block's list."""
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        vectors[row, column, 0] = 0.0
        vectors[row, column, 1] = 0.0
        vectors[row, column, 2] = 0.0


@device
def _write_light(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    linear: Rows,
) -> float:
    """Write the light of the pixels; return the largest channel."""
    peak = 0.0
    if linear is None:
        return peak
    numbers = integers(packet)
    if hits < end - begin:
        _clear(block, begin, end, pixels, linear)
        for lane in range(end - begin):
            if numbers[PRIMITIVE + lane] < NO_PRIMITIVE:
                light = load(packet, LIGHT, lane)
                peak = max(peak, _write_pixel(block, pixels[begin + lane], light, linear))
    for hit in range(hits):
        light = load(packet, VALUE, hit)
        pixel = pixels[begin + numbers[SOURCE + hit]]
        peak = max(peak, _write_pixel(block, pixel, light, linear))
    return peak


@device
def _write_pixel(block: Block, pixel: int, light: Vec, linear: NDArray[np.float64]) -> float:
    """Write the light of a pixel; return its largest channel."""
    row, column = place_of(block, pixel)
    linear[row, column, 0] = light[0]
    linear[row, column, 1] = light[1]
    linear[row, column, 2] = light[2]
    return max(light[0], light[1], light[2])


@device
def _write_normals(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    normals: Rows,
) -> None:
    """Write the normals of the hits, 0 for the others."""
    if normals is None:
        return
    _clear(block, begin, end, pixels, normals)
    numbers = integers(packet)
    for hit in range(hits):
        row, column = place_of(block, pixels[begin + numbers[SOURCE + hit]])
        for axis in range(3):
            normals[row, column, axis] = packet[NORMAL + axis * LANES + hit]


@device
def _write_albedos(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    world: World,
    materials: Materials,
    looks: Looks | None,
    faded: Faded | None,
    albedo: Rows,
) -> None:
    """Write what share of light the hits send on, 0 for the others."""
    if albedo is None:
        return
    if faded is not None:
        for lane in range(end - begin):
            _write_albedo(block, pixels[begin + lane], load(packet, GATHERED, lane), albedo)
        return
    _clear(block, begin, end, pixels, albedo)
    numbers = integers(packet)
    for hit in range(hits):
        pixel = pixels[begin + numbers[SOURCE + hit]]
        _write_albedo(block, pixel, _albedo_of(packet, hit, world, materials, looks), albedo)


@device
def _write_albedo(block: Block, pixel: int, shares: Vec, albedo: NDArray[np.float64]) -> None:
    """Write what share of light a pixel sends on, from 0 to 1."""
    row, column = place_of(block, pixel)
    albedo[row, column, 0] = min(max(shares[0], 0.0), 1.0)
    albedo[row, column, 1] = min(max(shares[1], 0.0), 1.0)
    albedo[row, column, 2] = min(max(shares[2], 0.0), 1.0)


@device
def _albedo_of(
    packet: Packet, hit: int, world: World, materials: Materials, looks: Looks | None
) -> Vec:
    """Return what share of light a hit sends on."""
    tint, lambert = scale(1.0 / 255.0, load(packet, COLOR, hit)), packet[LAMBERT + hit]
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if looks is not None:
        lane = int(integers(packet)[SOURCE + hit])
        look = load_look(materials, looks, integers(packet)[PRIMITIVE + lane])
        cosine = -dot(load(packet, TOWARDS, hit), load(packet, NORMAL, hit))
        is_inner = comes_from_within(packet, hit, lane, world)
        return reflectance(looks, look, tint, lambert, cosine, is_inner)
    return scale(lambert, tint)


@device
def _write_noise(
    packet: Packet,
    block: Block,
    begin: int,
    end: int,
    hits: int,
    pixels: Pixels,
    error: Rows,
) -> None:
    """Write the standard errors of the light of the hits, 0 for the others."""
    if error is None:
        return
    numbers = integers(packet)
    for lane in range(end - begin):
        row, column = place_of(block, pixels[begin + lane])
        error[row, column] = 0.0
    for hit in range(hits):
        row, column = place_of(block, pixels[begin + numbers[SOURCE + hit]])
        error[row, column] = math.sqrt(packet[NOISE + hit])
