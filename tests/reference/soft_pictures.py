"""Soft lights of pictures beside those of the oracle, ray by ray."""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from cylinder_pictures import load
from oracle import WHITE
from oracle_lights import Fan, Hit, SoftOracle
from oracle_sky import SkyOracle
from written_out import written_out_file

import vtray
from vtray.base.compiler.compiled import kernel, uncompiled
from vtray.geometry.caps import UNKNOWN, Caps, new_caps
from vtray.geometry.packets.cone import Touching, new_touching
from vtray.geometry.packets.fan import (
    BLOCKED,
    DIRECTION,
    END,
    FAN,
    WEIGHT,
    Start,
    new_fan,
)
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec
from vtray.geometry.world import World
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.rendering.pack_lights import FAR
from vtray.transport.camera_rays import plane_depth_of
from vtray.transport.integrators import reference
from vtray.transport.integrators.soft_known import share_at
from vtray.transport.lights.soft_light import SoftLights, aim_at
from vtray.transport.sampling.estimate import AS_NEEDED
from vtray.transport.sampling.fans import Fans, Noise, fan_of, fan_point, fans_of_middles
from vtray.transport.scene_arrays import SceneArrays

Scene = dict[str, Any]


class Compared(NamedTuple):
    """How many rays were compared, how many of them arrive, and how many were in doubt."""

    rays: int
    arrive: int
    doubtful: int


def compare_fans(
    document: Scene, pixels: list[tuple[int, int]], seed: int, image: vtray.Image | None = None
) -> Compared:
    """Compare all rays from some pixels to the soft lights with those of the oracle.

    Parameters
    ----------
    document
        The scene, as a file says it.
    pixels
        The pixels, each its column and row.
    seed
        What chooses the rays.
    image
        A picture of the scene with this seed and one fan to each light, which is compared as well.
    """
    by_rules = SoftOracle(written_out_file(document))
    scene = load(document)
    packed = pack(scene, accelerate(scene))
    fans = fans_of_middles(Noise(math.inf, by_light=True))
    arrays, unit = packed.arrays, packed.unit
    soft = arrays.lights.soft
    if soft is None:
        return Compared(0, 0, 0)
    points = sum(item.get("type", "point") == "point" for item in document["lights"])
    stack, fan, stopped = new_stack(), new_fan(), np.zeros(FAN, np.int64)
    cosines, blockers = np.zeros(points), np.full(points, NOTHING)
    rays = arrive = doubtful = 0
    for column, row in pixels:
        hit = by_rules.hit(column, row)
        traced = reference.trace_pixel(arrays, column, row, stack, cosines, blockers, new_walk(0))
        if hit is None or traced.primitive == NOTHING:
            continue
        point = np.array(traced.interaction.point) * unit
        if not is_same(hit, point, np.array(traced.interaction.normal)):
            continue
        hit = hit._replace(point=point, normal=np.array(traced.interaction.normal))
        shares = []
        for light in range(len(by_rules.lights)):
            found, spread = reference.trace_fan(
                arrays,
                soft,
                traced,
                column,
                row,
                light,
                fans,
                AS_NEEDED,
                0,
                seed,
                stack,
                fan,
                stopped,
                new_walk(0),
            )
            expected = by_rules.fan(hit, light, column, row, seed, fans.rays)
            share = np.array(found[: expected.weights.shape[1]])
            shares.append(_known_share(arrays, traced, light, fans, share, spread))
            sky = by_rules.skies.get(light)
            own = fan_of(fans, 0, 1, 0, column, row, light, seed)
            order = _order(fans.points, own, expected.points)
            is_lamp = by_rules.lights[light]["type"] in ("sphere", "rectangle")
            longest = np.inf if is_lamp else FAR * unit
            _compare(fan, order, hit, expected, unit, longest, sky)
            peak = 1.0 if sky is None else 1e4 * float(sky.picture.max())
            bound = expected.doubted_shares + 1e-9 * peak
            assert (abs(share - expected.shares) <= bound).all(), (column, row, light)
            rays += len(order)
            arrive += int(expected.arrives.sum())
            doubtful += int(expected.doubt.sum())
        if image is not None:
            light_of_all = _light_of(hit, traced.interaction.half & 1 != 0, shares, by_rules.lights)
            total = traced.value + light_of_all
            np.testing.assert_allclose(image.linear[row, column], total, rtol=1e-12, atol=1e-12)
    return Compared(rays, arrive, doubtful)


def _known_share(
    arrays: SceneArrays,
    traced: reference.TracedPixel,
    light: int,
    fans: Fans,
    told: np.ndarray,
    spread: float,
) -> np.ndarray:
    """Return what is known of a light without rays, which is about what they told, or else that."""
    point, normal, error_scale, _ = traced.interaction
    soft, camera = arrays.lights.soft, arrays.camera
    assert soft is not None
    start = Start(point, uncompiled(plane_depth_of)(camera, point), error_scale)
    around = new_touching(), new_caps(), new_stack()
    known = _share_at(soft, light, start, normal, camera.forward, arrays.world, fans, *around)
    if known == UNKNOWN:
        return told
    assert known == pytest.approx(told[0], abs=6 * math.sqrt(spread) + 0.05), light
    return np.array([known])


@kernel
def _share_at(
    soft: SoftLights,
    light: int,
    start: Start,
    normal: Vec,
    forward: Vec,
    world: World,
    fans: Fans,
    touching: Touching,
    caps: Caps,
    stack: Stack,
) -> float:
    """Return what is known of a light at a point."""
    aim = aim_at(soft, light, start, normal)
    return share_at(aim, start, normal, forward, world, fans, touching, caps, stack)


def is_same(hit: Hit, point: np.ndarray, normal: np.ndarray) -> bool:
    """Tell whether two hits are the same as far as rounding allows."""
    away = np.abs(hit.point - point).max()
    return bool(away <= 2.0**-30 * hit.error and hit.normal @ normal > 1 - 2.0**-20)


def _order(
    points: np.ndarray, own: tuple[tuple[int, int], tuple[int, int]], expected: np.ndarray
) -> np.ndarray:
    """Return which of the points expected vtray's rays have, (rays,): the same, in any order.

    What `fan_of` returns makes them of the points of all fans.
    """
    found = np.array([fan_point(points, k, *own) for k in range(len(expected))])
    one, other = (np.lexsort(item.T) for item in (found, expected))
    np.testing.assert_array_equal(found[one], expected[other])
    order = np.empty(len(one), int)
    order[one] = other
    return order


def _compare(
    fan: np.ndarray,
    order: np.ndarray,
    hit: Hit,
    expected: Fan,
    unit: float,
    longest: float,
    sky: SkyOracle | None,
) -> None:
    """Compare the rays of a fan, of which `order` says which of those expected they are."""
    rays = len(order)
    directions = np.stack([fan[DIRECTION + k * FAN :][:rays] for k in range(3)], axis=-1)
    ends = np.stack([fan[END + k * FAN :][:rays] for k in range(3)], axis=-1) * unit
    lengths = np.sqrt(np.square(ends - hit.point).sum(axis=-1))
    components = range(expected.weights.shape[1])
    weights = np.stack([fan[WEIGHT + k * FAN :][:rays] for k in components], axis=-1)
    arrives = fan[BLOCKED:][:rays] == 0
    turn = np.maximum(expected.turns[order], 1e-15)
    off = np.abs(directions - expected.directions[order]).max(axis=-1)
    assert (off <= turn).all(), f"direction off by {off.max()}"
    off = np.abs(lengths - np.minimum(expected.lengths[order], longest))
    bound = expected.length_errors[order] + 1e-12 * lengths * (lengths > longest / 2)
    assert (off <= bound).all(), f"length off by {off.max()}"
    wanted, peak = expected.weights[order], 0.0
    if sky is not None:  # in the very direction that was found: its light may be of steep slopes
        wanted, peak = sky.weights(directions, hit.normal), float(sky.picture.max())
    off = np.abs(weights - wanted)
    assert (off <= 2 * turn[:, None] + 1e-12 + 1e-5 * peak).all(), f"weight off by {off.max()}"
    wrong = (arrives != expected.arrives[order]) & ~expected.doubt[order]
    assert not wrong.any(), f"{wrong.sum()} of {rays} rays, {arrives.sum()} arrive"


def _light_of(
    hit: Hit, is_second: bool, shares: list[np.ndarray], lights: list[Scene]
) -> np.ndarray:
    """Return what soft lights add to a pixel, if so much of them arrives, (3,)."""
    color = hit.item.get("color_end", hit.item["color"]) if is_second else hit.item["color"]
    surface = np.array([color[c] for c in "rgb"]) * hit.item["lambert"]
    total = np.zeros(3)
    for share, light in zip(shares, lights, strict=True):
        tint = np.array([light.get("color", WHITE)[c] for c in "rgb"]) / 255
        total += share * light.get("radiance", light.get("intensity", 1.0)) * tint * surface
    return total
