"""The distance at which scale bars are right, where no point is given: that of what is seen."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.figures.scale_bar import ScaleBar, scale_bar

WORDS = "{length} at {distance}"


def taken(scene: vtray.Scene, size: tuple[int, int] = (36, 24), **camera: Any) -> vtray.Image:
    """Return a picture of a scene from the origin along z, in light that takes no time."""
    scene.lights = [vtray.Light((0, 0, 0))]
    scene.camera = vtray.Camera.look_at((0, 0, 0), target=(0, 0, 1), size=size, **camera)
    return vtray.render(scene)


def distance_of(image: vtray.Image) -> float:
    """Return the distance that a bar tells."""
    bar = scale_bar(image, WORDS, None)
    assert bar is not None
    return float(bar.text.split()[-1])


def bar_of(image: vtray.Image) -> ScaleBar:
    bar = scale_bar(image, True, None)
    assert bar is not None
    return bar


@once
def test_a_ball_measures_its_diameter() -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 9), 1.83)
    image = taken(scene, (80, 60), fov_degrees=40)
    bar = bar_of(image)
    across = int((image.ids[..., 0] == 0).any(axis=0).sum())
    assert across * bar.length / bar.pixels == pytest.approx(3.66, rel=0.06)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_balls_are_where_their_centres_are(dtype: type) -> None:
    scene = vtray.Scene()
    scene.add_spheres(np.array([(0, 0, 10), (3, 3, 20)], dtype), [2, 0.1])
    assert distance_of(taken(scene, fov_degrees=60)) == pytest.approx(10)


def test_balls_of_copies_are_where_these_stand() -> None:
    scene = vtray.Scene()
    parts = [vtray.Sphere((0, 0, 1), 0.1), vtray.Spheres([(9, 0, 0), (0, 0, 2)], 1)]
    scene.objects.append(vtray.Copies(parts, at=[(0, 0, 40), (0, 0, 10)]))
    assert distance_of(taken(scene, fov_degrees=30)) == pytest.approx(12)


def test_other_shapes_are_where_they_are_seen() -> None:
    scene = vtray.Scene()
    scene.add_cylinder((0, 0, 10), (0, 0, 12), 3)
    assert distance_of(taken(scene, fov_degrees=30)) == pytest.approx(10)


def test_a_ball_like_a_floor_is_where_it_is_seen() -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 1000, 0), 999)
    assert 1 < distance_of(taken(scene, fov_degrees=40)) < 40


def test_points_that_shine_are_measured_where_nothing_else_is_seen() -> None:
    scene = vtray.Scene()
    scene.objects.append(
        vtray.Stars([(0, 0, 8), (1, 0, 9), (0, 1, 10), (99, 0, 1), (0, 0, -5)], 1.0)
    )
    assert distance_of(taken(scene, fov_degrees=40)) == pytest.approx(9)
    scene.add_sphere((0, 0, 20), 1)
    assert distance_of(taken(scene, fov_degrees=40)) == pytest.approx(20)


def test_a_bar_with_a_unit_is_not_left_out_in_silence() -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, -9), 1)
    image = taken(scene, fov_degrees=40)
    with pytest.warns(UserWarning, match="scalebar: nothing is seen whose distance"):
        assert scale_bar(image, "nm", None) is None
    assert scale_bar(image, True, None) is None
    assert scale_bar(image, "nm", (0, 0, 3)) is not None


@once
def test_what_is_faint_counts_where_nothing_is_solid() -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 10), 3, opacity=0.3)
    scene.add_sphere((0, 0, 20), 9, opacity=0.2)
    assert distance_of(taken(scene, fov_degrees=20)) == pytest.approx(10)
    scene.add_sphere((0, 0, 40), 2)
    image = taken(scene, fov_degrees=20)
    assert distance_of(image) == pytest.approx(40)
    assert distance_of(vtray.render(scene, solid_from=0.25)) == pytest.approx(10)
    assert image.shown.ids is image.ids
