"""The camera's axes and rays."""

import math

import numpy as np
import pytest

from conftest import once
from vtray.scene.placing.directions import camera_axes, unit, view_axes
from vtray.scene.scene import Direction
from vtray.transport.camera_rays import CameraFrame, camera_ray

NORMALS = [
    (0, 0, 1),
    (0, 0, -1),
    (1, 0, 0),
    (0, -1, 0),
    (0.3, -0.8, 0.52),
    (-0.3, 0.1, -0.9),
    (1e-9, 0, -1),
    (0, 1e-160, -1),
    (1e-300, -2e-300, 3e-300),
    (1e308, 1.7e308, -1.7e308),
    (5e-324, 0, 0),
]


def frame(normal: tuple[float, float, float]) -> np.ndarray:
    """Return the axes as rows of a matrix."""
    forward = unit(Direction(*normal))
    return np.array([*camera_axes(forward), forward])


def smallest_rotation(forward: np.ndarray) -> np.ndarray:
    """Return the rotation from (0, 0, 1) to `forward` by axis and angle, as a matrix."""
    axis = np.cross([0, 0, 1], forward)
    sine = np.linalg.norm(axis)
    angle = math.atan2(sine, forward[2])
    x, y, z = axis / sine
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * (cross @ cross)


@pytest.mark.parametrize("normal", NORMALS)
def test_axes_are_right_handed_and_square(normal: tuple[float, float, float]) -> None:
    axes = frame(normal)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=4e-16)
    assert np.linalg.det(axes) == pytest.approx(1)


def test_axes_of_the_two_special_normals() -> None:
    np.testing.assert_array_equal(frame((0, 0, 5)), np.eye(3))
    np.testing.assert_array_equal(frame((0, 0, -5)), np.diag([-1, 1, -1]))


@pytest.mark.parametrize("normal", [n for n in NORMALS if n[0] or n[1] > 1e-100])
def test_axes_are_turned_by_the_smallest_rotation(normal: tuple[float, float, float]) -> None:
    axes = frame(normal)
    rotation = smallest_rotation(axes[2])
    np.testing.assert_allclose(axes, (rotation @ np.eye(3)).T, atol=1e-14)


@once
@pytest.mark.parametrize("angle", [1.0, 1e-3, 1e-6, 2e-9])
@pytest.mark.parametrize("normal", NORMALS)
def test_view_axes_are_square_however_near_up_is(
    normal: tuple[float, float, float], angle: float
) -> None:
    forward = np.array(unit(Direction(*normal)))
    for beside in np.random.default_rng(1).normal(size=(20, 3)):
        up = forward + angle * np.cross(forward, beside) / np.linalg.norm(beside)
        up /= np.linalg.norm(up)
        right, down = view_axes(tuple(forward.tolist()), tuple(up.tolist()))
        axes = np.array([right, down, forward])
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=8e-16)
        assert np.linalg.det(axes) == pytest.approx(1)
        assert np.dot(down, up) < 0


def test_view_axes_by_hand() -> None:
    look, up = (0.0, 0.0, 1.0), (0.0, 0.6, 0.8)
    assert view_axes(look, up) == ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    # Down is y, as without up: so the axes are, too.
    assert view_axes(look, (0.0, -1.0, 0.0)) == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def test_rays_of_an_orthographic_view_start_at_the_pixels() -> None:
    camera = CameraFrame(
        eye=(0.0, 0.0, -10.0),
        right=(0.6, 0.8, 0.0),
        down=(-0.8, 0.6, 0.0),
        forward=(0.0, 0.0, 1.0),
        image_distance=10.0,
        pixel=(0.0, 0.0, 1.0),
        width=5,
        height=4,
        shift=(0.5, 0.25),
        extent=3.5,
    )
    for column, row, x, y in [(0, 0, -1.25, -0.5), (4, 3, 0.75, 0.25), (2.5, 1.75, 0, -0.0625)]:
        ray = camera_ray(camera, column, row)
        assert ray.direction == (0.0, 0.0, 1.0)
        offset = np.subtract(ray.origin, camera.eye)
        assert offset == pytest.approx((0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, 0), abs=1e-15)


def test_rays_go_through_the_pixels() -> None:
    camera = CameraFrame(
        eye=(0.0, 0.0, -10.0),
        right=(1.0, 0.0, 0.0),
        down=(0.0, 1.0, 0.0),
        forward=(0.0, 0.0, 1.0),
        image_distance=10.0,
        pixel=(0.5 * 8, 0.25 * 8, 10.0 * 8),
        width=5,
        height=4,
        shift=(0.0, 0.0),
        extent=0.0,
    )
    # Half the width of 5 is 2.5, and there is no shift by half a pixel.
    for column, row, x, y in [(0, 0, -1.25, -0.5), (4, 3, 0.75, 0.25), (2, 2, -0.25, 0)]:
        length = math.sqrt(x * x + y * y + 100)
        expected = (x / length, y / length, 10 / length)
        ray = camera_ray(camera, column, row)
        assert (ray.origin, ray.plane_depth) == (camera.eye, -10.0)
        assert ray.direction == pytest.approx(expected, abs=1e-16)
