"""Renders spheres in the light of one lamp with Mitsuba 3, by its own integrator `direct`.

    python mitsuba_soft.py THREADS SCENE OUTPUT SAMPLES PICTURES

SCENE is a file as `soft_scene.py` describes it; OUTPUT is a .npy file for the light of so many
pictures with other random numbers, (pictures, height, width, 3), float32. All samples of a pixel
are of the same ray through its middle. How long the last picture took goes to standard output:
what is compiled is there by then.

Runs in the peers' own Python environment, without vtray.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.host.soft_scene import REACH, SoftScene, read_scene

mi.set_variant("llvm_ad_rgb")

FEW = 1000
"""Up to so many spheres are a shape each, which is more exact than ellipsoids are."""

Trace = Callable[[mi.Scene, SoftScene, mi.Point3f, int, int], np.ndarray]
"""Returns the light of all pixels, (n, 3): the mean of so many samples each, by a seed."""


def main(trace: Trace, integrator: dict[str, Any] | None = None) -> None:
    """Do what the arguments say, by an integrator other than `direct` if one is given."""
    threads, path, output, samples, pictures = sys.argv[1:]
    dr.set_thread_count(int(threads))
    given = read_scene(Path(path))
    scene = build(given, integrator or direct(given))
    starts = mi.Point3f(given.starts.reshape(-1, 3).T.astype(np.float32))
    found = []
    for seed in range(int(pictures)):
        begin = time.perf_counter()
        light = trace(scene, given, starts, int(samples), seed)
        seconds = time.perf_counter() - begin
        found.append(light.reshape(given.starts.shape))
    print(f"trace {seconds:8.4f} s")
    np.save(output, np.stack(found))


def direct(given: SoftScene) -> dict[str, Any]:
    """Return the integrator `direct`."""
    return {
        "type": "direct",
        "emitter_samples": given.emitter_samples,
        "bsdf_samples": 1,
        "hide_emitters": True,
    }


def build(given: SoftScene, integrator: dict[str, Any]) -> mi.Scene:
    """Give the scene to Mitsuba."""
    matt = {"type": "diffuse", "reflectance": {"type": "rgb", "value": given.reflectance}}
    level = mi.ScalarTransform4f().translate([0, given.floor, 0]).rotate([1, 0, 0], -90)
    floor = level.scale(REACH * given.size)
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": integrator,
            "floor": {"type": "rectangle", "to_world": floor, "bsdf": matt},
            "lamp": lamp(given),
            **spheres(given.spheres, matt),
        }
    )


def lamp(given: SoftScene) -> dict[str, Any]:
    """Return the lamp, with what JSON cannot hold."""
    plugin: dict[str, Any] = json.loads(given.lamp)
    if "to_world" in plugin:
        plugin["to_world"] = mi.ScalarTransform4f(np.array(plugin["to_world"]))
    if given.sky.size:
        plugin["bitmap"] = mi.Bitmap(given.sky)
    return plugin


def spheres(given: np.ndarray, matt: dict[str, Any]) -> dict[str, Any]:
    """Return shapes for the spheres."""
    if len(given) <= FEW:
        return {
            f"sphere{k}": {"type": "sphere", "center": place, "radius": radius, "bsdf": matt}
            for k, (*place, radius) in enumerate(given.tolist())
        }
    ellipsoids = {
        "type": "ellipsoids",
        "centers": mi.TensorXf(given[:, :3].astype(np.float32)),
        "scales": mi.TensorXf(np.repeat(given[:, 3:], 3, axis=1).astype(np.float32)),
        "quaternions": mi.TensorXf(np.tile(np.float32([0, 0, 0, 1]), (len(given), 1))),
        "extent": 1.0,
        "bsdf": matt,
    }
    return {"spheres": ellipsoids}


def sampler_of(pixels: int, samples: int, seed: int) -> tuple[mi.Sampler, mi.UInt32]:
    """Return random numbers for so many samples of each pixel, and which pixel each is of.

    Of Mitsuba's samplers, this one leaves about half the noise of independent samples. Their number
    is a square.
    """
    sampler = mi.load_dict({"type": "multijitter", "sample_count": samples})
    sampler.set_samples_per_wavefront(samples)
    sampler.seed(seed, pixels * samples)
    return sampler, dr.arange(mi.UInt32, pixels * samples) // samples


def trace_direct(
    scene: mi.Scene, given: SoftScene, starts: mi.Point3f, samples: int, seed: int
) -> np.ndarray:
    """Return the light as the integrator finds it, sample by sample from the eye on."""
    sampler, pixel = sampler_of(dr.width(starts), samples, seed)
    ray = mi.Ray3f(dr.gather(mi.Point3f, starts, pixel), mi.Vector3f(given.way.tolist()))
    light, _, _ = scene.integrator().sample(scene, sampler, mi.RayDifferential3f(ray))
    means = [np.array(dr.block_sum(channel, samples)) / samples for channel in light]
    return np.stack(means, axis=1)


if __name__ == "__main__":
    main(trace_direct)
