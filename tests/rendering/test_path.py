"""Pictures by paths, beside what is known of them without tracing."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray.scene.materials import Emissive, Glass, Material, Metal

WHITE = (255, 255, 255)


def looking_down(objects: list[Any], lights: list[Any], size: int = 6) -> vtray.Scene:
    """Return a scene that is seen from above, as far as 1 around (0, 0)."""
    scene = vtray.Scene()
    scene.objects, scene.lights = objects, lights
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=12, size=(size, size)
    )
    return scene


def light_of(scene: vtray.Scene, **settings: Any) -> Any:
    """Return the light of a picture, 1 for white."""
    settings = {"integrator": "path", "samples": 16, "depth": 32, **settings}
    return vtray.render(scene, **settings).linear / 255


@once
@pytest.mark.parametrize("sky", [vtray.Sky(1), vtray.Ambient(1)])
@pytest.mark.parametrize(
    "material", ["lambert", "mirror", "glass", Glass(0.7), Glass(1.0), Glass(2.4), "metal"]
)
def test_white_furnaces_are_white(material: Material | str, sky: Any) -> None:
    """Where everything is white and the light the same from everywhere, nothing is seen."""
    balls = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, WHITE, material=material),
        vtray.Sphere((0.6, 0.1, 0.4), 0.4, WHITE),
        vtray.Plane((0, 0, 0), (0, 0, 1), WHITE),
    ]
    assert light_of(looking_down(balls, [sky])) == pytest.approx(1, abs=1e-9)


@once
@pytest.mark.parametrize("share", [0.25, 0.75])
@pytest.mark.parametrize("depth", [0, 1, 3, 7, 40])
def test_a_hollow_ball_is_lit_by_itself(share: float, depth: int) -> None:
    """A light in the middle lights all of it alike, and each bounce a share of that again.

    Only a little of the ball, 1 of 360, is behind the image plane, and so not there.
    """
    ball = vtray.Sphere((0, 0, 0), 9, WHITE, lambert=share)
    scene = looking_down([ball], [vtray.Light((0, 0, 0), 1)])
    scene.camera = vtray.Camera.look_at(
        (0, 0, 8.95), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=12, size=(4, 4)
    )
    expected = sum(share ** (k + 1) * (1 - 1 / 360) ** k for k in range(depth + 1))
    found = light_of(scene, samples=64, depth=depth)
    assert found.mean() == pytest.approx(expected, rel=0.03 if depth > 3 else 0.004)


@once
@pytest.mark.parametrize("height", [1.5, 2.0, 4.0])
def test_what_shines_lights_what_is_near(height: float) -> None:
    """Below a ball that shines, a surface gets what its form factor says: (r / d)**2 * cosine."""
    ball = vtray.Sphere((3, 0, height), 1, WHITE, material=Emissive(4))
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), (255, 128, 0))
    scene = looking_down([ball, floor], [], size=1)
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=0.1, size=(1, 1)
    )
    found = light_of(scene, samples=4096, depth=1)[0, 0]
    distance2 = 9 + height * height
    factor = height / (distance2 * math.sqrt(distance2))
    assert found == pytest.approx([4 * factor, 4 * factor * 128 / 255, 0], rel=0.05)


@once
def test_what_shines_is_seen_as_bright_as_it_is() -> None:
    ball = vtray.Sphere((0, 0, 0), 3, (255, 51, 0), material=Emissive(2.5))
    for integrator in ("whitted", "path"):
        light = light_of(looking_down([ball], [vtray.Sky(7)]), integrator=integrator)
        assert light == pytest.approx(np.broadcast_to([2.5, 0.5, 0], light.shape))


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_glass_absorbs_by_its_thickness(integrator: str) -> None:
    """Through the middle of a ball without refraction goes exp(-absorption * diameter)."""
    glass = Glass(1.0, absorption=(0.0, 0.25, 2.0))
    ball = vtray.Sphere((0, 0, 0), 1.5, WHITE, material=glass)
    scene = looking_down([ball], [vtray.Sky(1)], size=9)
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=0.01, size=(9, 9)
    )
    expected = [math.exp(-3 * share) for share in glass.absorption]
    assert light_of(scene, integrator=integrator)[4, 4] == pytest.approx(expected, rel=1e-4)


@once
def test_glass_as_thin_as_air_changes_nothing() -> None:
    """Also not the light of a lamp on what is below: paths find it through the glass."""
    lamp = vtray.SphereLight((2, 0, 3), 1.5, radiance=3)
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE)
    clear = vtray.Sphere((0, 0, 1.2), 1.1, WHITE, material=Glass(1.0))
    without, through = (
        light_of(looking_down(objects, [lamp], size=2), samples=1024, depth=8)
        for objects in ([floor], [floor, clear])
    )
    assert through.mean() == pytest.approx(without.mean(), rel=0.05)


@once
def test_metal_mirrors_what_its_measured_indices_say() -> None:
    """Of light that falls squarely: ((n - 1)**2 + k**2) / ((n + 1)**2 + k**2)."""
    from vtray.scene.metals import METALS

    for name, (indices, extinctions) in METALS.items():
        ball = vtray.Sphere((0, 0, 0), 1.5, WHITE, material=Metal(name))
        scene = looking_down([ball], [vtray.Sky(1)], size=1)
        scene.camera = vtray.Camera.look_at(
            (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=0.1, size=(1, 1)
        )
        squarely = [
            ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)
            for n, k in zip(indices, extinctions, strict=True)
        ]
        assert light_of(scene, integrator="whitted")[0, 0] == pytest.approx(squarely, rel=1e-3)


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_mirrors_show_what_is_before_them(integrator: str) -> None:
    """Not what lies on the way back of a ray: a lamp behind a mirror is not seen in it."""
    mirror = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE, material="mirror")
    sides = (8, 0, 0), (0, 8, 0)
    above, below = (vtray.RectangleLight((0, 0, z), sides, radiance=2) for z in (3, -3))
    for lamp, seen in ((above, 2), (below, 0)):
        light = light_of(looking_down([mirror], [lamp]), integrator=integrator)
        assert light == pytest.approx(seen)


@once
def test_mirrors_throw_the_light_of_suns_onto_floors() -> None:
    """A floor at a wall that is a mirror is lit by two suns."""
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE, lambert=0.5)
    wall = vtray.Plane((-1, 0, 0), (1, 0, 0), WHITE, material="mirror")
    sun = vtray.Sun((-1, 0.3, -1), angle=30)
    alone = light_of(looking_down([floor], [sun]), samples=256)
    both = light_of(looking_down([floor, wall], [sun]), samples=4096)
    assert both.mean() == pytest.approx(2 * alone.mean(), rel=0.02)


def test_without_bounces_paths_see_what_direct_light_shows() -> None:
    objects = [
        vtray.Sphere((0, 0, 0.6), 0.5, (255, 99, 71)),
        vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208), 0.8),
    ]
    scene = looking_down(objects, [vtray.Light((4, -6, 8), 1), vtray.Light((-5, 3, 4), 0.5)])
    direct = light_of(scene, integrator="direct")
    assert light_of(scene, depth=0) == pytest.approx(direct, abs=0.02)


@once
@pytest.mark.parametrize("samples", [1, 4])
def test_threads_and_tiles_change_nothing(samples: int) -> None:
    objects = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, WHITE, material="glass"),
        vtray.Sphere((0.6, 0.1, 0.4), 0.4, (200, 99, 71)),
        vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208)),
    ]
    scene = looking_down(
        objects, [vtray.Sky(0.5), vtray.SphereLight((2, 2, 3), 0.5)], size=20 if JIT else 6
    )
    one, other = (
        vtray.render(scene, integrator="path", samples=samples, threads=n, tile=tile)
        for n, tile in ((1, 64), (2, 8 if JIT else 3))
    )
    assert one.linear.tobytes() == other.linear.tobytes()


@once
def test_more_samples_are_less_noisy() -> None:
    """The error falls faster than by the root of the samples, or as fast; seeds are unlike."""
    objects = [
        vtray.Sphere((0, 0, 0.6), 0.5, (200, 99, 71)),
        vtray.Plane((0, 0, 0), (0, 0, 1), (230, 230, 230)),
    ]
    scene = looking_down(objects, [vtray.Sky(1)], size=4)
    best = light_of(scene, samples=1024, depth=4)
    few, many = (
        float(np.sqrt(np.mean((light_of(scene, samples=samples, depth=4) - best) ** 2)))
        for samples in (4, 64)
    )
    assert many < few / 3.5
    other = light_of(scene, samples=4, depth=4, seed=1)
    assert other.tobytes() != light_of(scene, samples=4, depth=4).tobytes()


@once
def test_materials_may_change_from_render_to_render() -> None:
    ball = vtray.Sphere((0, 0, 0), 3, (255, 51, 0))
    scene = looking_down([ball], [vtray.Sky(1)])
    colors = []
    for material in ("lambert", Emissive(0.25), "lambert"):
        scene.objects[0] = ball.replace(material=material)
        colors.append(light_of(scene)[3, 3, 0])
    assert colors == pytest.approx([1, 0.25, 1])


@once
def test_fireflies_are_cut_where_that_is_asked() -> None:
    """A lamp in a mirror on which a matt floor lies: some paths are far brighter than the mean."""
    ball = vtray.Sphere((0, 0, 0.5), 0.5, WHITE, material="mirror")
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE)
    lamp = vtray.SphereLight((1.5, 0, 3), 0.4, radiance=60)
    scene = looking_down([ball, floor], [lamp], size=12)
    scene.render = vtray.RenderSettings(exposure=1)
    plain = light_of(scene, samples=1)
    assert plain.max() > 4
    for firefly in (0.5, 3):
        found = light_of(scene, samples=1, firefly=firefly)
        ratio = np.minimum(1, firefly / np.maximum(plain.max(axis=2, keepdims=True), 1e-9))
        assert found == pytest.approx(plain * ratio)
    assert light_of(scene, samples=1, firefly="off").tobytes() == plain.tobytes()
    assert light_of(scene, samples=1, firefly=1e9).tobytes() == plain.tobytes()
