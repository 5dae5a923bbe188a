"""Renders spheres under a sky of one colour with Mitsuba 3: see mitsuba_soft.py for the arguments.

Only what rays meet is found by Mitsuba, and all else written in Dr.Jit, which compiles it together
with that: one ray from the eye for each pixel, and of those to the sky only whether they arrive.
That is several times as fast as the integrator `direct`, which casts a ray from the eye for each
sample and asks all rays what they meet.
"""

import sys
from pathlib import Path

import drjit as dr
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.mitsuba.mitsuba_soft import SoftScene, main, mi, sampler_of

NEAR = 0.01
"""Where rays to the sky start, in radii: rounding, with room to spare."""


def trace(
    scene: mi.Scene, given: SoftScene, starts: mi.Point3f, samples: int, seed: int
) -> np.ndarray:
    """Return the light of all pixels, (n, 3)."""
    way = mi.Vector3f(given.way.tolist())
    found = scene.ray_intersect(mi.Ray3f(starts, way))
    normal = mi.Vector3f(dr.select(dr.dot(found.n, way) > 0, -found.n, found.n))
    point, is_hit = mi.Point3f(found.p + NEAR * normal), found.is_valid()
    dr.eval(point, normal, is_hit)

    sampler, pixel = sampler_of(dr.width(starts), samples, seed)
    frame = mi.Frame3f(dr.gather(mi.Vector3f, normal, pixel))
    to_sky = frame.to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d()))
    ray = mi.Ray3f(dr.gather(mi.Point3f, point, pixel), to_sky)
    asked = dr.gather(mi.Bool, is_hit, pixel)
    arrives = asked & ~scene.ray_test(ray, active=asked)
    share = np.array(dr.block_sum(dr.select(arrives, mi.Float(1), 0), samples)) / samples
    return given.reflectance * np.repeat(share[:, None], 3, axis=1)


if __name__ == "__main__":
    main(trace)
