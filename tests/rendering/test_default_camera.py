"""Scenes whose camera was never set are seen as a whole."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from clouds import cloud

import vtray
from conftest import once
from vtray import SceneError
from vtray.rendering import hierarchy
from vtray.scene.default_camera import with_camera

FLOORS = [((0, -1, 0), (0, 1, 0)), ((0, 0, -1), (0, 0, -2)), ((-4, 0, 0), (1, 0, 0))]


def flat() -> vtray.Scene:
    """Return spheres in a plane that is seen from one side only."""
    scene = vtray.Scene()
    places = np.random.default_rng(1).uniform(-1, 1, (30, 3)) * (3, 0.05, 2)
    scene.add_spheres(places, 0.1, lambert=0.8)
    return scene


@once
@pytest.mark.parametrize("size", [None, (60, 20), (20, 60)])
def test_the_shape_is_shown(size: Any) -> None:
    scene = flat()
    asked = {} if size is None else {"size": size}
    image = vtray.render(scene, **asked)
    assert scene.camera is None
    assert image.scene.camera == vtray.Camera.fit(scene, view="auto", **asked)
    scene.camera = image.scene.camera
    assert vtray.render(scene).pixels.tobytes() == image.pixels.tobytes()


@once
@pytest.mark.parametrize(("center", "normal"), FLOORS)
def test_a_floor_is_below(center: Any, normal: Any) -> None:
    scene = flat()
    scene.add_plane(center, normal, lambert=0.8)
    camera = vtray.render(scene, size=(16, 12), samples=1, tolerance=1).scene.camera
    places = camera.project(scene.objects[0].center)
    assert ((places[:, :2] > 0) & (places[:, :2] < (16, 12))).all()
    up = np.negative(normal) if np.dot(center, normal) > 0 else np.array(normal)
    up = up / np.linalg.norm(up)
    x, y, _ = (camera.project([up * 0.1]) - camera.project([(0, 0, 0)]))[0]
    assert abs(x) < 0.02 * abs(y)
    assert y < 0  # rows are counted from the top
    way = -np.array([camera.center.x, camera.center.y, camera.center.z])
    assert np.dot(way, up) < 0  # the floor is seen from above


def slab(**given: Any) -> vtray.Scene:
    """Return particles that lie flat in a cell."""
    scene = vtray.Scene()
    places = np.random.default_rng(2).uniform(0, 1, (20, 3)) * (5, 4, 0.2)
    scene.add_particles(vtray.Particles(places, cell=np.diag([5.0, 4.0, 9.0])), **given)
    return scene


def from_the_side(scene: vtray.Scene) -> bool:
    """Tell whether a scene without a camera is seen as cells are."""
    camera = with_camera(scene, (8, 8)).camera
    assert scene.camera is None
    return camera == vtray.Camera.fit(scene, view=(-65, 20), size=(8, 8))


@once
@pytest.mark.parametrize("given", [{}, {"cell": False}, {"emission": 1.0}, {"opacity": 0.5}])
def test_cells_are_seen_from_the_side(given: Any) -> None:
    assert from_the_side(slab(**given))


@once
def test_cells_are_known_of_scenes_made_of_others() -> None:
    scene = slab(cell=False)
    assert from_the_side(copy.deepcopy(scene))
    assert from_the_side(pickle.loads(pickle.dumps(scene)))
    moved = scene.objects[0].replace(center=scene.objects[0].center * 2, color=(255, 0, 0))
    assert from_the_side(vtray.Scene(objects=[moved]))
    assert from_the_side(vtray.Scene(objects=[vtray.Copies(moved, np.eye(3))]))
    scene.add_particles(np.eye(3))
    assert from_the_side(scene)
    del scene.objects[0]
    assert not from_the_side(scene)


@once
def test_a_floor_is_below_cells() -> None:
    scene = slab()
    scene.add_plane((0, 0, -1), (0, 0, 1))
    assert not from_the_side(scene)


@once
def test_points_that_shine_are_shown() -> None:
    scene = vtray.Scene()
    scene.add_particles([(0, 0, 0), (1, 2, 0), (3, 1, 0)], emission=1.0)
    image = vtray.render(scene, size=(16, 12))
    assert image.scene.camera == vtray.Camera.fit(scene, view="auto", size=(16, 12))
    assert image.pixels.any()
    with pytest.raises(SceneError, match=r"^Scene\.camera: there is none; set one"):
        scene.check()


@once
def test_hierarchies_stay_with_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = vtray.Scene()
    scene.objects = [cloud("uniform", 500, 1)]
    first = vtray.render(scene, size=(16, 12))
    monkeypatch.setattr(hierarchy, "_build", None)
    assert vtray.render(scene, size=(16, 12)).pixels.tobytes() == first.pixels.tobytes()


@once
def test_pixels_of_the_picture_are_told() -> None:
    image = vtray.render(flat(), size=(40, 30))
    light = vtray.trace_pixel(image, 20, 15).light
    assert light == pytest.approx(image.linear[15, 20], rel=1e-12)


@pytest.mark.parametrize("objects", [[], [vtray.Plane((0, 0, 0), (0, 1, 0))]])
def test_what_has_no_end_needs_a_camera(objects: list[Any]) -> None:
    scene = vtray.Scene(objects=objects)
    with pytest.raises(SceneError, match=r"^Scene\.camera: there is none; nothing has an end"):
        vtray.render(scene)


@pytest.mark.parametrize("objects", [3, [3], None])
def test_wrong_scenes_are_explained_first(objects: Any) -> None:
    scene = vtray.Scene()
    scene.objects = objects
    with pytest.raises(SceneError, match=r"^Scene\.objects"):
        vtray.render(scene)


def test_wrong_sizes() -> None:
    with pytest.raises(SceneError, match="size"):
        vtray.render(flat(), size=(0, 3))
