"""What a ray of a pixel sees over many surfaces: all rays of one path, as users get them."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.figures.traced_rays import Choice, Hit, PathRay, WayToLight
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.packet import (
    BOUNCES,
    DIRECTION,
    DISTANCE,
    GATHERED,
    LANES,
    NO_PRIMITIVE,
    ORIGIN,
    PRIMITIVE,
)
from vtray.geometry.packets.pending import NUMBERS
from vtray.geometry.queries import NOTHING
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.world import body_count
from vtray.rendering.pack_looks import materials_by_row
from vtray.rendering.pixel import Pixel, hit_of, in_world, ways_to_lights
from vtray.rendering.pixel_coat import Coat, coat_lights
from vtray.rendering.pixel_lights import place_of_lamp, variance_on_trial
from vtray.rendering.pixel_surfaces import as_vec
from vtray.scene.materials import Lambert
from vtray.transport.integrators.path import MIRRORED, REFRACTED, SCATTERED
from vtray.transport.integrators.reference import TracedPixel
from vtray.transport.integrators.single_path import Choice as Chosen
from vtray.transport.integrators.single_path import (
    Followed,
    Glossy,
    Place,
    begin_path,
    follow_ray,
    leave_hit,
    light_matt,
)
from vtray.transport.integrators.soft_trial import fans_for
from vtray.transport.lights.light import light_count
from vtray.transport.sampling.estimate import AS_NEEDED
from vtray.transport.sampling.paths import Step, seed_of_step
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import new_memory

BLACK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)

WORDS = {MIRRORED: "mirrored", REFRACTED: "refracted", SCATTERED: "scattered"}


def follow_path(pixel: Pixel, sampling: Sampling, sample: int) -> tuple[tuple[PathRay, ...], Vec]:
    """Return the rays of one path, or of the tree of rays that whitted follows, and their light.

    Parameters
    ----------
    pixel
        The pixel.
    sampling, sample
        How its rays are cast, and the number of the one that is told.
    """
    follower = _Follower(pixel, sampling, sample, _fans_of_hits(pixel, sampling, sample))
    return tuple(follower.follow()), follower.light()


def _fans_of_hits(pixel: Pixel, sampling: Sampling, sample: int) -> list[int]:
    """Return how many fans each soft light has from each hit of a sample, as all samples decide.

    The list is empty where each decides by itself.
    """
    fans, count = pixel.fans, int(sampling.rays)
    if fans is None or pixel.are_shared or sampling.paths is not None or count == 1:
        return []
    first = sample // LANES * LANES
    tried = []
    for each in range(first, min(first + LANES, count)):
        follower = _Follower(pixel, sampling, each, None)
        follower.follow()
        tried.append(follower.tried)
    longest = max(map(len, tried))
    hits = zip(*(each + [0.0] * (longest - len(each)) for each in tried), strict=True)
    return [uncompiled(fans_for)(_sum(hit) / len(tried), fans.fans) for hit in hits]


def _sum(values: Iterable[float]) -> float:
    """Return a sum with the bits of the kernels, which add one after the other."""
    total = 0.0
    for value in values:
        total += value
    return total


class _Waiting(NamedTuple):
    """A ray that waits: its numbers as in `Pending`, where it comes from, and how."""

    numbers: NDArray[np.float64]
    parent: int
    how: str


class _Lit(NamedTuple):
    """The ways from a hit to lights; what they bring to a matt surface, and how that is shown."""

    ways: tuple[WayToLight, ...]
    light: Vec
    shown: Vec | None


class _Follower:
    """Follows the rays of a path, one after the other, in the first lane of a packet.

    Each soft light has so many fans from each hit as is given. Where that is None, it has one on
    trial, of which the variance is noted, and nothing is told.
    """

    def __init__(
        self, pixel: Pixel, sampling: Sampling, sample: int, fans: Sequence[int] | None
    ) -> None:
        arrays = pixel.packed.arrays
        assert arrays.materials.looks is not None  # noqa: S101 - rays go on
        self._pixel, self._arrays = pixel, arrays
        self._looks, self._sampling = arrays.materials.looks, sampling
        self._materials = materials_by_row(pixel.packed.made)
        self._place = Place(*pixel.place, sample)
        self._packet, self._work = new_memory(arrays)
        scene, looks, cast = pixel.packed.given, pinned(self._looks), pinned(sampling)
        # What kernels are given for each ray.
        self._given = scene, looks, cast, self._place, self._packet, pinned(self._work)
        self._waiting: list[_Waiting] = []
        self._rays: list[PathRay] = []
        self._light = BLACK
        self._fans = fans
        self.tried: list[float] = []
        self._steps = 0

    def follow(self) -> list[PathRay]:
        """Return all rays, in the order in which a packet follows them."""
        self._arrive(self._begin(), self._pixel.packed.before)
        while self._waiting:
            self._arrive(self._go_on(self._waiting.pop()), 0.0)
        return self._rays

    def light(self) -> Vec:
        """Return the light of all rays, no brighter than the picture shows it."""
        if self._rays[0].lamp is not None:  # which is seen as bright as it is
            return self._light
        peak, brightest = max(self._light), self._looks.brightest
        return uncompiled(scale)(brightest / peak if peak > brightest else 1.0, self._light)

    def _begin(self) -> PathRay:
        """Cast the ray of the camera."""
        pixel, packet = self._pixel, self._packet
        begun = begin_path(*self._given)
        x, y, z = direction = self._vector(DIRECTION)
        start, before = in_world(pixel, self._vector(ORIGIN)), pixel.packed.before
        eye = start[0] - before * x, start[1] - before * y, start[2] - before * z
        length = float(packet[DISTANCE]) * pixel.packed.unit + before
        lamp, met, passes = self._lamp(begun.lamp), as_vec(begun.light), as_vec(begun.passes)
        self._light = met
        return PathRay(None, "seen", eye, direction, WHITE, passes, length, lamp, met, met)

    def _go_on(self, waiting: _Waiting) -> PathRay:
        """Let a ray go on from a surface."""
        pixel = self._pixel
        # First for what it adds, and then for the sum, whose last bits depend on the order.
        met, found = self._follow(waiting, BLACK)
        self._light, _ = self._follow(waiting, self._light)
        return PathRay(
            waiting.parent,
            waiting.how,
            in_world(pixel, found.waiting.ray.origin),
            as_vec(found.waiting.ray.direction),
            as_vec(found.waiting.seen),
            as_vec(found.passes),
            float(found.distance) * pixel.packed.unit,
            self._lamp(found.lamp),
            met,
            met,
        )

    def _follow(self, waiting: _Waiting, light: Vec) -> tuple[Vec, Followed]:
        """Let a ray go on, and return the light with what it adds, and what it meets."""
        pending = self._work.pending
        pending.numbers[:NUMBERS], pending.waiting[0] = waiting.numbers, 1
        self._put_light(light)
        scene, looks, _, _, packet, work = self._given
        found = follow_ray(scene, looks, packet, work)
        return self._vector(GATHERED), found

    def _arrive(self, ray: PathRay, before: float) -> None:
        """Keep a ray with what it meets, and let rays go on from there."""
        self._rays.append(ray)
        if int(self._packet.view(np.int64)[PRIMITIVE]) <= NO_PRIMITIVE:
            return
        self._put_light(BLACK)
        scene, *_ = self._given
        chosen = leave_hit(*self._given)
        # What a surface shines by itself, or what a coat shows of lights.
        own = self._vector(GATHERED)
        points = uncompiled(light_count)(self._arrays.lights)
        asked = np.zeros(points), np.full(points, NOTHING)
        walk, stack = new_walk(body_count(self._arrays.world)), self._work.stack
        traced = light_matt(scene, self._place, self._packet, stack, *asked, walk)
        hit = hit_of(self._pixel, traced, before)
        lit = self._lit(chosen, traced, hit, asked)
        onward = self._take_waiting(len(self._rays) - 1, hit)
        self._steps += 1
        sums = uncompiled(add)
        self._light = sums(sums(self._light, own), lit.light)
        self._rays[-1] = replace(
            ray,
            hit=hit,
            material=self._materials[int(chosen.row)],
            shines=BLACK if chosen.has_coat else own,
            lights=lit.ways,
            light=sums(sums(ray.met, own), lit.light),
            shown=lit.shown,
            choice=self._choice(chosen, hit, onward),
        )

    def _lit(
        self,
        chosen: Chosen,
        traced: TracedPixel,
        hit: Hit,
        asked: tuple[NDArray[np.float64], NDArray[np.int64]],
    ) -> _Lit:
        """Return the ways from a hit to lights, given what `light_matt` says of points."""
        row, seed = int(chosen.row), int(uncompiled(seed_of_step)(self._pixel.seed, self._steps))
        if self._fans is None:
            self._try(traced, seed)
            return _Lit((), BLACK, None)
        if chosen.has_coat:
            return _Lit(coat_lights(self._coat(hit, row)), BLACK, None)
        is_matt = isinstance(self._materials[row], Lambert)
        if not (is_matt or max(traced.material.color) > 0.0):
            return _Lit((), BLACK, None)
        count = self._fans[self._steps] if self._fans else AS_NEEDED
        pixel = self._pixel._replace(seed=seed, fan_count=count)
        ways, light = ways_to_lights(pixel, traced, hit, *asked)
        return _Lit(ways, light, _shown(traced))

    def _try(self, traced: TracedPixel, seed: int) -> None:
        """Note how noisy one fan to each soft light is."""
        place, packed, fans = self._pixel.place, self._pixel.packed, self._pixel.fans
        assert fans is not None  # noqa: S101 - there is something to be tried
        self.tried.append(variance_on_trial(packed, traced, place, fans, seed))

    def _take_waiting(self, parent: int, hit: Hit) -> Vec | None:
        """Keep the rays that go on from a hit; return the direction of the last, if any."""
        pending, direction = self._work.pending, None
        for k in range(int(pending.waiting[0])):
            numbers = pending.numbers[k * NUMBERS : (k + 1) * NUMBERS].copy()
            direction = as_vec(numbers[3:6])
            is_mirrored = uncompiled(dot)(direction, hit.normal) > 0.0
            how = WORDS[MIRRORED if is_mirrored else REFRACTED]
            self._waiting.append(_Waiting(numbers, parent, how))
        pending.waiting[0] = 0
        return direction

    def _choice(self, chosen: Chosen, hit: Hit, onward: Vec | None) -> Choice | None:
        """Return what a path chose at a hit; None where all ways are followed."""
        if self._sampling.paths is None:
            return None
        how, density = WORDS[int(chosen.how)], None
        if onward is not None:
            last = self._waiting[-1]
            self._waiting[-1] = last._replace(how=how)
            density = float(chosen.density) or None
            if how == WORDS[SCATTERED] and density is None:
                density = uncompiled(dot)(onward, hit.normal) / math.pi
        return Choice(
            how, float(chosen.chance), density, float(chosen.goes_on), float(chosen.share)
        )

    def _coat(self, hit: Hit, row: int) -> Coat:
        """Return a glossy hit, given the row of its material."""
        looks, paths = self._looks, self._sampling.paths
        assert paths is not None  # noqa: S101 - only paths go on from coats by chance
        assert looks.albedos is not None  # noqa: S101 - there are coats
        number = int(self._packet.view(np.int64)[BOUNCES])
        step = Step(*self._place, number, paths, self._sampling.seed)
        glossy = Glossy(looks, looks.albedos, row)
        return Coat(self._pixel, step, self._packet, hit, glossy, self._work.stack)

    def _lamp(self, row: int) -> int | None:
        """Return the place of a lamp in the scene, given its row."""
        return place_of_lamp(self._pixel.scene, self._arrays.lights, row)

    def _vector(self, field: int) -> Vec:
        """Return a field of the first lane."""
        return as_vec(self._packet[field : field + 3 * LANES : LANES])

    def _put_light(self, light: Vec) -> None:
        """Set the light of the first lane."""
        self._packet[GATHERED : GATHERED + 3 * LANES : LANES] = light


def _shown(traced: TracedPixel) -> Vec:
    """Return how much is seen of the colour of a surface."""
    red, green, blue = (
        float(seen) / float(of) if of else 0.0
        for seen, of in zip(traced.material.color, traced.color, strict=True)
    )
    return red, green, blue
