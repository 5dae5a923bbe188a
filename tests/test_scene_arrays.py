"""Packing a scene into arrays."""

import numpy as np
import pytest

import vtray
from vtray.scene_arrays import pack

WHITE = (255, 255, 255)


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
    assert packed.unit == 16
    camera, spheres, planes, lights, materials = packed.arrays
    assert camera.eye == (0, 0, -10 / 16)
    assert (camera.focus, camera.pixel_width, camera.width) == (10 / 16, 0.5 / 16, 4)
    assert [float(column[0]) * 16 for column in spheres] == [0, 0, 6, 2, 8]
    assert [float(column[0]) for column in planes[:3]] == [0, -1, 0]
    assert (planes.offset[0] * 16, planes.height[0] * 16) == (-3, -3)
    assert [float(column[0]) for column in lights] == [4 / 16, 0, -3 / 16, -3 / 16, 7, 7 / 16]
    # The spheres come first, whatever the order in the scene.
    assert packed.objects.tolist() == [1, 0]
    assert materials.red.tolist() == [255, 1]
    assert materials.lambert.tolist() == [1, 0.5]


def test_spheres_behind_the_image_plane_are_left_out() -> None:
    depths = [-5.0, -2.0, -1.9, 0.0, 4.0]
    packed = pack(scene([vtray.Sphere((1, 2, 3 + depth), 2, WHITE, 1) for depth in depths]))
    assert packed.objects.tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize("size", [1e-300, 1.0, 1e300])
def test_unit_keeps_squares_within_range(size: float) -> None:
    arrays = pack(
        scene([vtray.Sphere((0, 0, size), size, WHITE, 1)], center=(0, 0, 0), focus=size)
    ).arrays
    squared = arrays.spheres.radius[0] ** 2
    assert 0 < squared <= (1 if size >= 1 else 1e-300) or size < 1
    assert np.isfinite(squared)


def test_empty_scene() -> None:
    packed = pack(scene([]))
    assert packed.arrays.spheres.x.shape == packed.arrays.lights.x.shape == (0,)
    assert packed.objects.shape == (0,)
