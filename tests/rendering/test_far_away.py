"""A few shapes far beyond all others, and scenes far from the origin: the same, and as fast."""

from collections.abc import Callable

import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray.geometry.bvh import build as bvh_build
from vtray.rendering.hierarchy import accelerate

RANDOM = np.random.default_rng(4)
BALLS = RANDOM.uniform(-5, 5, (600, 3))
CLOUD = RANDOM.uniform(-0.4, 0.4, (20, 3))
FAR = np.array([[1e7, 0, 0], [0, -3e6, 4e6], [0, 0, -1e8 - 6], [2e5, 2e5, 1e5]])
FAR_RADIUS = np.array([0.4, 5e4, 1e8, 9e4])


def balls() -> vtray.Scene:
    scene = vtray.Scene()
    radius = np.concatenate([np.full(len(BALLS), 0.4), FAR_RADIUS])
    scene.add_spheres(np.concatenate([BALLS, FAR]), radius)
    return scene


def sticks() -> vtray.Scene:
    scene = vtray.Scene()
    start = np.concatenate([BALLS, FAR])
    length = np.concatenate([np.full(len(BALLS), 0.6), FAR_RADIUS])
    scene.add_cylinders(start, start + length[:, np.newaxis] * (0.5, 0.6, 0.62), length / 4)
    return scene


def copies() -> vtray.Scene:
    scene = vtray.Scene()
    cloud = vtray.Spheres(CLOUD, 0.2, (200, 90, 90))
    scene.add_copies(cloud, np.concatenate([BALLS, FAR]))
    return scene


POINT = vtray.Light((-40, -60, 90))
LIGHTS = {
    "point": [POINT],
    "behind": [vtray.Light((9e6, 9e6, 4.5e6))],
    "soft": [vtray.Sun((0.2, 0.5, -1), angle=5), vtray.Ambient(0.4, distance=3)],
}


@compiled_only
@pytest.mark.parametrize("lights", LIGHTS)
@pytest.mark.parametrize("make", [balls, sticks, copies])
@pytest.mark.parametrize("target", [(0, 0, 0), (0, -3e6, 4e6)])
def test_what_is_far_away_is_found_and_hides_light(
    make: Callable[[], vtray.Scene],
    lights: str,
    target: tuple[float, float, float],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    eye = (3.0, -14.0, 6.0) if target == (0, 0, 0) else (1e5, -3.2e6, 4.1e6)

    def render() -> vtray.Image:
        scene = make()
        scene.camera = vtray.Camera.look_at(eye, target, up=(0, 0, 1), size=(24, 18))
        scene.lights = LIGHTS[lights]
        return vtray.render(scene, samples=2, exposure=1.0)

    image = render()
    monkeypatch.setattr(bvh_build, "MOST_BEYOND", -1)
    coarse = render()
    np.testing.assert_array_equal(image.ids, coarse.ids)
    np.testing.assert_array_equal(image.linear, coarse.linear)


def test_a_few_far_away_do_not_make_boxes_coarse() -> None:
    alone = vtray.Scene()
    alone.add_spheres(BALLS, 0.4)
    near = accelerate(alone).shapes[0].frame.scale
    assert accelerate(balls()).shapes[0].frame.scale >= near / 64
    many = vtray.Scene()
    many.add_spheres(np.concatenate([BALLS, np.repeat(FAR, 20, axis=0)]), 0.4)
    assert accelerate(many).shapes[0].frame.scale < near / 1000


@compiled_only
@pytest.mark.parametrize("offset", [(4.5e5, 5.2e6, 300.0), (-(2.0**40), 2.0**41, 0.0)])
def test_a_scene_far_from_the_origin_is_the_same(offset: tuple[float, float, float]) -> None:
    # Of few bits, so that moving them rounds nothing.
    centers = np.round(BALLS * 64) / 64

    def render(by: np.ndarray) -> vtray.Image:
        scene = vtray.Scene()
        scene.add_spheres(centers + by, 0.375)
        scene.lights = [vtray.Light(tuple(np.array((-40, -60, 90)) + by)), vtray.Ambient(0.5)]
        scene.camera = vtray.Camera.look_at(
            np.array((4, -16, 8)) + by, by, up=(0, 0, 1), size=(40, 30)
        )
        return vtray.render(scene, exposure=1.0)

    np.testing.assert_array_equal(render(np.array(offset)).ids, render(np.zeros(3)).ids)
