"""Renders spheres and planes with Mitsuba 3: the host of a peer beside which vtray is measured.

    python mitsuba_spheres.py THREADS SCENE OUTPUT

SCENE is a file as `host_scene.py` describes it; OUTPUT is a PNG. What took how long goes to
standard output. Spheres are Mitsuba's `ellipsoids`; a `sphere` for each would take 2 GB for
100,000. Mitsuba's point lights fade with distance and its cameras look through the middle of
pixels, so rays, planes and shading are written in Dr.Jit, which compiles them together with
Mitsuba's intersection.

Runs in the peers' own Python environment, without vtray.
"""

import itertools
import sys
import time
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.host.host_scene import HostScene, read_scene

mi.set_variant("llvm_ad_rgb")

NEAR = 5e-3
"""Where a shadow ray starts, in radii: rounding, with room to spare."""


def main() -> None:
    """Do what the arguments say."""
    if sys.argv[1:] == ["--version"]:
        dr.eval(dr.arange(mi.Float, 2) + 1)  # fails without LLVM
        print(mi.__version__)
        return
    threads, path, output = sys.argv[1:]
    dr.set_thread_count(int(threads))
    times = [time.perf_counter()]
    scene = in_radii(read_scene(Path(path)))
    times.append(time.perf_counter())
    world = build(scene)
    dr.sync_thread()
    times.append(time.perf_counter())
    pixels = trace(scene, world)
    times.append(time.perf_counter())
    mi.Bitmap(pixels).write(output)
    times.append(time.perf_counter())
    steps = ("load", "build", "trace", "write")
    for step, (start, end) in zip(steps, itertools.pairwise(times), strict=True):
        print(f"{step:6}{end - start:8.4f} s")


def in_radii(scene: HostScene) -> HostScene:
    """Scale a scene so that the spheres have a radius of about 1.

    Mitsuba's ellipsoids are right then. With a radius of 0.026, 4 units away, a third of the rays
    that pass within two radii of the centre get the wrong answer.
    """
    if len(scene.spheres) == 0:  # which Mitsuba cannot have: one behind the eye
        scene = scene._replace(
            spheres=np.array([[0, 0, -2, 1]], np.float32), color=np.zeros((1, 3), np.uint8)
        )
    radii = scene.spheres[:, 3]
    unit = np.float32(np.median(radii) or 1)
    planes, lights = scene.planes.copy(), scene.lights.copy()
    planes[:, 3] /= unit
    lights[:, :3] /= unit
    return scene._replace(planes=planes, lights=lights, spheres=scene.spheres / unit)


def build(scene: HostScene) -> mi.Scene:
    """Give the spheres to Mitsuba."""
    count = len(scene.spheres)
    spheres = {
        "type": "ellipsoids",
        "centers": mi.TensorXf(scene.spheres[:, :3]),
        "scales": mi.TensorXf(np.repeat(scene.spheres[:, 3:], 3, axis=1)),
        "quaternions": mi.TensorXf(np.tile(np.float32([0, 0, 0, 1]), (count, 1))),
        "extent": 1.0,
    }
    return mi.load_dict({"type": "scene", "spheres": spheres})


def trace(scene: HostScene, world: mi.Scene) -> np.ndarray:
    """Return the picture, (height, width, 3)."""
    # A ray for each pixel, and the nearest sphere on it.
    index = dr.arange(mi.UInt32, scene.width * scene.height)
    column, row = mi.Float(index % scene.width), mi.Float(index // scene.width)
    across = (column - scene.width / 2) * scene.pixel_width
    above = (scene.height / 2 - row) * scene.pixel_height
    ray = dr.normalize(mi.Vector3f(across, above, 1))
    found = world.ray_intersect_preliminary(mi.Ray3f(mi.Point3f(0), ray), coherent=True)
    is_sphere = found.is_valid()
    distance = dr.select(is_sphere, found.t, dr.inf)
    hit = mi.Bool(is_sphere)

    # A plane that is nearer.
    normal, color = mi.Vector3f(0), mi.Color3f(0)
    for plane in scene.planes.tolist():
        upright = mi.Vector3f(*plane[:3])
        at = plane[3] / dr.dot(upright, ray)
        is_nearer = (at > 0) & (at < distance)
        distance = dr.select(is_nearer, at, distance)
        normal = dr.select(is_nearer, upright, normal)
        color = dr.select(is_nearer, mi.Color3f(*plane[4:7]), color)
        hit |= is_nearer
        is_sphere &= ~is_nearer
    point = ray * dr.select(hit, distance, 0)

    # The look of the sphere.
    flat = mi.UInt8(scene.color.ravel())
    ball = dr.gather(mi.Vector4f, mi.Float(scene.spheres.ravel()), found.prim_index, is_sphere)
    channels = (dr.gather(mi.UInt8, flat, 3 * found.prim_index + i, is_sphere) for i in range(3))
    own = mi.Color3f(*(mi.Float(channel) * scene.lambert for channel in channels))
    color = dr.select(is_sphere, own, color)
    normal = dr.select(is_sphere, dr.normalize(point - ball.xyz), normal)

    # Light that nothing blocks.
    light = mi.Float(0)
    for x, y, z, intensity in scene.lights.tolist():
        towards = mi.Vector3f(x, y, z) - point
        far = dr.norm(towards)
        towards /= far
        cosine = dr.dot(normal, towards)
        is_lit = hit & (cosine > 0)
        shadow = mi.Ray3f(mi.Point3f(point + NEAR * towards), towards)
        shadow.maxt = far
        is_lit &= ~world.ray_test(shadow, active=is_lit)
        light += dr.select(is_lit, intensity * cosine, 0)
    value = color * light
    picture = mi.UInt8(dr.ravel(dr.select(value < 255, value, 255)))
    return np.array(picture).reshape(scene.height, scene.width, 3)


if __name__ == "__main__":
    main()
