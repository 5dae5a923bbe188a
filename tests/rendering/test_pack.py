"""Packing a scene into arrays."""

import math

import numpy as np
import pytest

import vtray
from vtray.geometry.shapes.columns import Place
from vtray.geometry.shapes.plane import load_plane
from vtray.geometry.shapes.sphere import load_sphere
from vtray.geometry.world import PLANE, SPHERE, World, load_group
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import Packed
from vtray.rendering.pack import pack as pack_arrays
from vtray.transport.materials.material import load_material

WHITE = (255, 255, 255)


def pack(scene: vtray.Scene) -> Packed:
    return pack_arrays(scene, accelerate(scene))


def place_of(kind: int, world: World) -> Place:
    """Return where the shapes of a kind stand."""
    (row,) = np.flatnonzero(world.groups.kind == kind)
    return load_group(world, row).place


def scene(objects: list, lights: list | None = None, **camera: object) -> vtray.Scene:
    settings = {
        "center": (1, 2, 3),
        "normal": (0, 0, 2),
        "focus": 10,
        "size": (4, 3),
        "resolution": (0.5, 0.5),
        **camera,
    }
    return vtray.Scene(vtray.Camera(**settings), lights or [], objects)


def test_places_are_relative_to_the_image_plane_in_units_of_a_power_of_two() -> None:
    packed = pack(
        scene(
            [
                vtray.Plane((1, 5, 3), (0, -3, 0), (1, 2, 3), 0.5),
                vtray.Sphere((1, 2, 9), 2, WHITE, 1),
            ],
            [vtray.Light((5, 2, 0), 7)],
        )
    )
    assert packed.unit == 16 / 2**200
    camera, world, lights, materials, _ = packed.arrays
    plane = load_plane(world.planes, 0, place_of(PLANE, world))
    sphere = load_sphere(world.spheres, 0, place_of(SPHERE, world))

    def lengths(*values: float) -> list[float]:
        return [value * packed.unit for value in values]

    assert lengths(*camera.eye, camera.image_distance) == [0, 0, -10, 10]
    # In a unit of their own, in which the largest length is just below 2**500.
    assert [math.ldexp(length, 4 - 500) for length in camera.pixel] == [0.5, 0.5, 10]
    assert camera.width == 4
    assert lengths(*sphere.center, sphere.radius) == [0, 0, 6, 2]
    assert plane.normal == (0, -1, 0)
    assert lengths(*plane.point, plane.offset) == [0, 3, 0, -3]
    assert lengths(lights.x[0], lights.y[0], lights.z[0]) == [4, 0, -3]
    assert lengths(lights.plane_depth[0], lights.error_scale[0]) == [-3, 13]
    assert lights.intensity[0] == 7
    assert load_material(materials, 0, False) == ((255, 255, 255), 1)
    assert load_material(materials, 1, False) == ((1, 2, 3), 0.5)


@pytest.mark.parametrize("size", [1e-320, 1e-300, 1.0, 1e300, 1.7e308])
def test_unit_keeps_squares_of_squares_within_range(size: float) -> None:
    sphere = vtray.Sphere((0, 0, size), size / 2, WHITE, 1)
    packed = pack(scene([sphere], center=(0, 0, 0), focus=size, resolution=(size / 8, size / 8)))
    world = packed.arrays.world
    radius = load_sphere(world.spheres, 0, place_of(SPHERE, world)).radius
    assert 0 < radius**4 < 1e290
    assert all(0 < length**2 < 1e302 for length in packed.arrays.camera.pixel)


def test_empty_scene() -> None:
    packed = pack(scene([]))
    assert packed.arrays.world.spheres.number.shape == packed.arrays.lights.x.shape == (0,)
