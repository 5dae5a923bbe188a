"""Renders spheres under a sky of one colour with Mitsuba 3, by its own integrator `path`.

    python mitsuba_paths.py THREADS SCENE OUTPUT SAMPLES PICTURES SURFACES

As `mitsuba_soft.py`, but that paths go over so many surfaces, and that the samples of a pixel are
spread over it.
"""

import sys
from pathlib import Path

import drjit as dr
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.mitsuba.mitsuba_soft import SoftScene, main, mi, sampler_of


def trace(
    scene: mi.Scene, given: SoftScene, starts: mi.Point3f, samples: int, seed: int
) -> np.ndarray:
    """Return the light of all pixels, (n, 3)."""
    sampler, pixel = sampler_of(dr.width(starts), samples, seed)
    corner = given.starts[0, 0]
    right, down = given.starts[0, 1] - corner, given.starts[1, 0] - corner
    place = sampler.next_2d() - 0.5
    start = dr.gather(mi.Point3f, starts, pixel)
    start += place.x * mi.Vector3f(right.tolist()) + place.y * mi.Vector3f(down.tolist())
    ray = mi.Ray3f(start, mi.Vector3f(given.way.tolist()))
    light, _, _ = scene.integrator().sample(scene, sampler, mi.RayDifferential3f(ray))
    means = [np.array(dr.block_sum(channel, samples)) / samples for channel in light]
    return np.stack(means, axis=1)


if __name__ == "__main__":
    surfaces = int(sys.argv.pop())
    path = {"type": "path", "max_depth": surfaces + 1, "rr_depth": 100, "hide_emitters": True}
    main(trace, path)
