"""The rays from what the ray of a pixel hits to many lights that share them, as users get them."""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import pinned
from vtray.figures.traced_rays import FanRay, ShadowFan, WayToLight
from vtray.geometry.packets.cone import new_touching
from vtray.geometry.packets.fan import BLOCKED, FAN, WEIGHT, Fan, new_fan
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.packets.workspace import UNKNOWN, new_shared
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec
from vtray.geometry.world import body_count
from vtray.rendering.pack import Packed
from vtray.rendering.pack_skies import changes_color
from vtray.rendering.pixel_lights import Lit, SpreadRay, added, asked_lights, fan_ray, shadow_fan
from vtray.scene.light_types import AnyLight
from vtray.transport.integrators.reference import TracedPixel, trace_crowd, trace_shared_fan
from vtray.transport.sampling.fans import Fans


class _Cast(NamedTuple):
    """A ray that was cast to one of the lights, and the light that it brings if none stops it."""

    ray: FanRay
    brought: Vec


def trace_shared(
    lit: Lit,
    packed: Packed,
    traced: TracedPixel,
    pixel: tuple[int, int],
    fans: Fans,
    seed: int,
) -> tuple[list[WayToLight], Vec]:
    """Trace the rays that lights share; parameters and results are those of `trace_fans`.

    Each light gets those that go to it. One that was asked as a whole has none.
    """
    crowd, lamps, lights = packed.arrays.lights.crowd, packed.given_lights, asked_lights(lit.scene)
    assert crowd is not None  # noqa: S101 - lights share fans
    assert lamps is not None  # noqa: S101
    fan, stack = new_fan(), new_stack()
    shared, blockers = new_shared(len(lights)), np.full(fans.rays, NOTHING)
    given = packed.given, lamps, pinned(crowd), traced, *pixel, pinned(fans)
    walk = new_walk(body_count(packed.arrays.world))
    found = trace_crowd(*given, seed, stack, fan, blockers, shared, new_touching(), walk)
    cast: list[list[_Cast]] = [[] for _ in lights]
    for number in range(found.fans):
        trace_shared_fan(*given, number, seed, stack, fan, blockers, shared, walk)
        for ray, blocker in enumerate(blockers.tolist()):
            place = int(shared.light[ray])
            spread = SpreadRay(fan, ray, traced.interaction.point, packed.unit, 3)
            shown = fan_ray(lit, lights[place][1], spread, blocker)
            cast[place].append(_Cast(shown, _brought(fan, ray, blocker)))
    rays = found.fans * fans.rays
    ways: list[WayToLight] = []
    for (k, light), rays_to, known in zip(lights, cast, shared.known.tolist(), strict=True):
        if known == UNKNOWN:
            ways.append(_fan_of(lit, k, light, rays_to, rays))
        else:
            ways.append(shadow_fan(lit, k, light, (), (known,)))
    return ways, found.value


def _brought(fan: Fan, ray: int, blocker: int) -> Vec:
    """Return the light that a ray brings if nothing stops it."""
    if blocker == NOTHING and fan[BLOCKED + ray] != 0.0:
        return 0.0, 0.0, 0.0
    red, green, blue = map(float, fan[WEIGHT + ray : WEIGHT + ray + 3 * FAN : FAN])
    return red, green, blue


def _fan_of(lit: Lit, number: int, light: AnyLight, cast: list[_Cast], rays: int) -> ShadowFan:
    """Return the rays to a light, of so many that all lights have."""
    full = added(lit, light, (1.0, 1.0, 1.0))
    channels = [0, 1, 2] if changes_color(light) else [full.index(max(full))]
    shares = [0.0 for _ in channels]
    shown = []
    for ray, brought in cast:
        # What it adds to the share of the light, channel by channel.
        parts = [brought[k] / full[k] / rays if full[k] else 0.0 for k in channels]
        count = len(cast) * sum(parts) / len(parts)
        shown.append(FanRay(ray.direction, ray.length, count, ray.blocker))
        if ray.blocker is None:
            shares = [share + part for share, part in zip(shares, parts, strict=True)]
    return shadow_fan(lit, number, light, tuple(shown), tuple(shares))
