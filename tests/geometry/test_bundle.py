"""Where bundles meet shapes: no ray of theirs meets one before, and all have met it by then."""

import math

import numpy as np
import pytest

from conftest import JIT
from vtray.geometry.bundle import Bundle
from vtray.geometry.ray import Ray
from vtray.geometry.shapes.cylinder import CylinderShape, cylinder_crossing, cylinder_distance
from vtray.geometry.shapes.plane import PlaneShape, plane_crossing, plane_distance
from vtray.geometry.shapes.sphere import SphereShape, sphere_crossing, sphere_distance

Point = tuple[float, float, float]
RAYS = 40
CASES = 400 if JIT else 60


def vec(values: np.ndarray) -> Point:
    x, y, z = map(float, values)
    return x, y, z


def unit(values: np.ndarray) -> np.ndarray:
    return values / np.sqrt(values @ values)


def sphere(random: np.random.Generator) -> SphereShape:
    return SphereShape(vec(random.normal(size=3)), 10 ** random.uniform(-2, 0.5), 4.0)


def plane(random: np.random.Generator) -> PlaneShape:
    point, normal = random.normal(size=3), unit(random.normal(size=3))
    return PlaneShape(vec(point), vec(normal), float(point @ normal), 4.0)


def cylinder(random: np.random.Generator) -> CylinderShape:
    start, axis = random.normal(size=3), unit(random.normal(size=3))
    length, radius = 10 ** random.uniform(-1, 0.7), 10 ** random.uniform(-2, 0.3)
    ball = math.hypot(length / 2, radius)
    center = start + length / 2 * axis
    return CylinderShape(vec(start), vec(axis), length, radius, vec(center), ball, 8.0)


SHAPES = {
    "sphere": (sphere, sphere_crossing, sphere_distance),
    "plane": (plane, plane_crossing, plane_distance),
    "cylinder": (cylinder, cylinder_crossing, cylinder_distance),
}


def camera_rays(random: np.random.Generator) -> tuple[Bundle, np.ndarray, np.ndarray]:
    """Return a bundle of a camera, and starts and ways of some of its rays."""
    origin, direction = 4 * unit(random.normal(size=3)), unit(random.normal(size=3))
    direction = unit(-origin + 0.7 * direction)
    width, growth = 0.02 * random.integers(0, 2), 10 ** random.uniform(-3, -0.7)
    across = unit(np.cross(direction, random.normal(size=3)))
    down = np.cross(direction, across)
    angle, radius = random.uniform(0, 2 * np.pi, RAYS), np.sqrt(random.uniform(0, 1, RAYS))
    radius[: RAYS // 2] = 1
    offsets = (radius * np.cos(angle))[:, None] * across + (radius * np.sin(angle))[:, None] * down
    bundle = Bundle(
        vec(origin), vec(direction), float(width), float(growth), 1.0, None, None, 0.0, 0.0, True
    )
    return bundle, origin + width * offsets, direction + growth * offsets


def shadow_rays(random: np.random.Generator) -> tuple[Bundle, np.ndarray, np.ndarray]:
    """Return a bundle from a patch to a point of light, and starts and ways of its rays."""
    camera, starts, _ = camera_rays(random)
    sight, origin = np.array(camera.direction), np.array(camera.origin)
    normal = unit(random.normal(size=3))
    normal *= -np.sign(normal @ sight)
    width, end = 10 ** random.uniform(-3, -0.5), 4 * unit(random.normal(size=3))
    length = float(np.sqrt((end - origin) @ (end - origin)))
    cosine = float(-(normal @ sight))
    disc = starts - origin
    disc = random.normal(size=(RAYS, 3)) if not disc.any() else disc
    disc -= (disc @ sight)[:, None] * sight
    disc /= np.sqrt((disc**2).sum(axis=1))[:, None]
    patch = disc - (disc @ normal)[:, None] / (normal @ sight) * sight
    bundle = Bundle(
        vec(origin),
        vec((end - origin) / length),
        width,
        -width / length,
        1 / cosine,
        vec(sight),
        vec(normal / (normal @ sight)),
        0.0,
        0.0,
        True,
    )
    return bundle, origin + width * patch, (end - origin - width * patch) / length


@pytest.mark.parametrize("make", [camera_rays, shadow_rays])
@pytest.mark.parametrize("kind", SHAPES)
def test_all_rays_meet_a_shape_between_the_bounds(kind: str, make: object) -> None:
    shape_of, crossing_of, distance_to = SHAPES[kind]
    random = np.random.default_rng(3)
    met_by_all = 0
    for _ in range(CASES):
        shape, (bundle, starts, ways) = shape_of(random), make(random)
        near, far = crossing_of(shape, bundle)
        assert near <= far
        # What is beyond a light does not matter.
        end = -bundle.width / bundle.growth if bundle.growth < 0 else math.inf
        met_by_all += far < math.inf
        for start, way in zip(starts, ways, strict=True):
            speed = float(np.sqrt(way @ way))
            # From the start on: as if the image plane were there.
            ray = Ray(vec(start), vec(way / speed), 0.0, 1.0, 0.0, 0.0)
            distance = distance_to(shape, ray) / speed
            if distance < end:
                assert distance >= near - 1e-9
            if far < end:
                assert distance <= far + 1e-9
    assert met_by_all > CASES / 60
