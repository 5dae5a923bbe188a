"""Mirrors and glass as users get them, beside an oracle that follows rays by recursion."""

from typing import Any

import numpy as np
import pytest
from oracle_whitted import Ball, Floor, View, seen

import vtray
from conftest import JIT, once
from vtray.scene.materials import AnyMaterial, Blend, Emissive, Glass, Metal, Plastic

A = np.array


def room(kinds: tuple[Any, ...], size: tuple[int, int] = (20, 15)) -> vtray.Scene:
    """Return a scene of three balls on a floor, and what each is made of."""
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((-1.1, 0, 1), 1, (255, 240, 220), material=kinds[0]),
        vtray.Sphere((1.1, 0, 1), 1, (200, 255, 255), material=kinds[1]),
        vtray.Sphere((0, -1.2, 0.5), 0.5, (255, 99, 71), material=kinds[2]),
        vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208), material=kinds[3]),
    ]
    scene.lights = [vtray.Light((4, -6, 8), 1), vtray.Light((-5, -3, 4), 0.5)]
    scene.camera = vtray.Camera.look_at(
        (0, -6, 2.2), target=(0, 0, 0.9), up=(0, 0, 1), fov_degrees=40, size=size
    )
    return scene


def expected(scene: vtray.Scene, depth: int) -> Any:
    """Return the light of a scene of balls and planes, as the oracle finds it."""

    def vector(found: Any) -> Any:
        return A([found.x, found.y, found.z])

    def look(material: AnyMaterial) -> tuple[str, float]:
        if isinstance(material, Glass):
            return "sheet" if material.thin else "glass", material.ior
        if isinstance(material, Plastic):
            return "plastic", material.ior
        if isinstance(material, Blend):
            return ("glass on matt" if material.weight == 0.75 else "plastic on a mirror"), 1.5
        return ("matt" if material == "lambert" else str(material)), 1.5

    shapes: list[Ball | Floor] = []
    for item in scene.objects:
        color = A([item.color.r, item.color.g, item.color.b], float)
        if isinstance(item, vtray.Sphere):
            ball = Ball(vector(item.center), item.radius, color, *look(item.material))
            shapes.append(ball)
        else:
            normal = vector(item.normal) / np.linalg.norm(vector(item.normal))
            shapes.append(Floor(vector(item.center), normal, color, *look(item.material)))
    lights = [(vector(light.location), light.intensity) for light in scene.lights]
    camera, (width, height) = scene.camera, scene.camera.size
    forward = vector(camera.normal) / np.linalg.norm(vector(camera.normal))
    right = np.cross(forward, vector(camera.up))
    right /= np.linalg.norm(right)
    down, center = np.cross(forward, right), vector(camera.center)
    eye, view = center - camera.focus * forward, View(center, forward)
    light = np.empty((height, width, 3))
    for row in range(height):
        for column in range(width):
            across = (column - width / 2) * camera.resolution[0] * right
            below = (row - height / 2) * camera.resolution[1] * down
            way = across + below + camera.focus * forward
            unit = way / np.linalg.norm(way)
            light[row, column] = seen(view, shapes, lights, eye, unit, np.ones(3), depth)
    return light


@once
@pytest.mark.parametrize("depth", [0, 1, 2, 6])
@pytest.mark.parametrize(
    "kinds",
    [
        ("mirror", "glass", "lambert", "lambert"),
        (Glass(1.5), Glass(0.7), "mirror", "lambert"),
        ("lambert", Glass(1.0), "glass", "mirror"),
        (Plastic(1.8), Glass(1.4, thin=True), "mirror", Plastic(1.5)),
        (Blend("glass", "lambert", 0.75), "lambert", "mirror", Blend("plastic", "mirror")),
    ],
)
def test_light_is_that_of_the_oracle(kinds: tuple[Any, ...], depth: int) -> None:
    scene = room(kinds)
    found = vtray.render(scene, integrator="whitted", depth=depth)
    assert np.abs(found.linear - expected(scene, depth)).max() < 1e-6


def test_matt_scenes_are_those_of_the_direct_integrator() -> None:
    scene = room(("lambert",) * 4)
    direct, whitted = (vtray.render(scene, integrator=name) for name in ("direct", "whitted"))
    assert direct.linear.tobytes() == whitted.linear.tobytes()


@once
@pytest.mark.parametrize("samples", [1, 4])
def test_threads_and_tiles_change_nothing(samples: int) -> None:
    scene = room(("mirror", "glass", "lambert", "lambert"), (40, 30) if JIT else (10, 8))
    one, other = (
        vtray.render(scene, integrator="whitted", samples=samples, threads=n, tile=tile)
        for n, tile in ((1, 64), (2, 16 if JIT else 5))
    )
    assert one.linear.tobytes() == other.linear.tobytes()


def test_direct_says_what_it_does_not_show() -> None:
    scene = room(("mirror", "glass", Glass(2), "lambert"))
    words = "material: mirror and glass are shown as matt by the integrator direct"
    with pytest.warns(UserWarning, match=words):
        matt = vtray.render(scene)
    plain = vtray.render(room(("lambert",) * 4))
    assert matt.linear.tobytes() == plain.linear.tobytes()


@once
def test_rough_surfaces_are_shown_as_smooth_and_said_to_be() -> None:
    kinds = (Metal(roughness=0.5), Plastic(roughness=0.3), Glass(roughness=0.1), "lambert")
    words = "material: metal and plastic and glass are shown as smooth by the integrator whitted; "
    with pytest.warns(UserWarning, match=words + 'give integrator="path"'):
        rough = vtray.render(room(kinds, (12, 9)), integrator="whitted")
    smooth = room(("metal", "plastic", "glass", "lambert"), (12, 9))
    assert rough.linear.tobytes() == vtray.render(smooth, integrator="whitted").linear.tobytes()


@once
def test_what_leaves_all_else_dark_is_warned_of() -> None:
    scene = room(("mirror", "lambert", "lambert", "lambert"), (32, 24))
    scene.lights = [vtray.Sun((0.3, 1, -0.8), angle=20)]
    words = r"exposure: the brightest pixel is \d+ times as bright as 99 of 100 are, which leaves "
    with pytest.warns(UserWarning, match=words + 'these dark; give exposure="auto"'):
        dark = vtray.render(scene, integrator="whitted")
    assert np.mean(dark.pixels > 30) < 0.01
    said: list[str] = []
    for known in ({"exposure": "auto"}, {"exposure": 1}, {"lock": dark}):
        vtray.render(scene, integrator="whitted", warn=said.append, **known)
    vtray.render(room(("lambert",) * 4), integrator="whitted", warn=said.append)
    assert not said


@pytest.mark.parametrize("kind", ["mirror", "lambert"])
def test_samples_are_no_brighter_than_is_asked(kind: str) -> None:
    scene = room((kind, "lambert", "lambert", "lambert"), (12, 9))
    plain = vtray.render(scene, integrator="whitted").linear
    image = vtray.render(scene, integrator="whitted", firefly=0.25)
    peak = np.maximum(plain.max(axis=2, keepdims=True), 1e-9)
    assert (peak > 100).any()
    assert image.linear == pytest.approx(plain * np.minimum(1, 0.25 * 255 / peak))
    assert vtray.trace_pixel(image, 6, 8).light == pytest.approx(image.linear[8, 6])


@once
@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_lamps_that_are_seen_are_as_bright_as_they_are(integrator: str, samples: int) -> None:
    scene = room(("lambert",) * 4, (12, 9))
    scene.lights = [vtray.SphereLight((0, 2, 1.5), 0.7, radiance=40, visible=True)]
    image = vtray.render(scene, integrator=integrator, samples=samples, exposure=1, firefly=1.5)
    x, y = 6, 3
    told = vtray.trace_pixel(image, x, y)
    for light in (image.linear[y, x], image.emission[y, x], told.light):
        assert max(light) == 40 * 255
    assert "limited" not in str(told)


@pytest.mark.parametrize("faded", [1, 3])
def test_what_does_not_go_together(faded: int) -> None:
    scene = room(("mirror", "lambert", "lambert", "lambert"))
    with pytest.raises(vtray.RenderError, match="keep_lights: light over many surfaces"):
        vtray.render(scene, integrator="whitted", keep_lights=True)
    scene.objects[faded] = scene.objects[faded].replace(opacity=0.5)
    with pytest.raises(vtray.RenderError, match="opacity: not between 0 and 1"):
        vtray.render(scene, integrator="whitted")


@pytest.mark.parametrize("material", [Emissive(1.7e308), Blend("glass", Emissive(1.7e308))])
def test_what_shines_is_no_brighter_than_a_double_holds(material: AnyMaterial) -> None:
    scene = room((material, "lambert", "lambert", "lambert"), (6, 5))
    words = r"^material\.radiance: expected at most 1\.37153e\+303, got 1\.7e\+308; give"
    for integrator in ("whitted", "path"):
        with pytest.raises(vtray.RenderError, match=words):
            vtray.render(scene, integrator=integrator)
    vtray.render(scene, integrator="direct", warn=str)
    scene.objects[0] = scene.objects[0].replace(material=Emissive(1e303))
    image = vtray.render(scene, integrator="whitted")
    assert np.isfinite(image.linear).all()
    assert image.pixels.max() == 255


def test_discs_of_suns_are_no_brighter_than_a_double_holds() -> None:
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material="mirror")
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=1, size=(2, 2)
    )
    scene.lights = [vtray.Sun((0, 0, -1), angle=5, intensity=6.5e300)]
    words = r"^lights: in mirrors, suns are as bright as 3\.4\d+e\+303, expected at most 1\.37"
    for integrator in ("whitted", "path"):
        with pytest.raises(vtray.RenderError, match=words):
            vtray.render(scene, integrator=integrator)
    vtray.render(scene, integrator="direct", warn=str)
    scene.lights = [vtray.Sun((0, 0, -1), angle=5, intensity=2.5e300)]
    image = vtray.render(scene, integrator="whitted", samples=9)
    assert np.isfinite(image.linear).all()
    assert image.linear.min() > 1e305
    assert image.pixels.max() == 255


@pytest.mark.parametrize(
    ("kind", "value", "message"),
    [
        ("material", "gold", "expected Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend"),
        ("material", 3, "expected Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend"),
        ("material", None, "expected Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend"),
    ],
)
def test_wrong_materials(kind: str, value: Any, message: str) -> None:
    with pytest.raises(vtray.SceneError, match=f"Sphere.{kind}: {message}"):
        vtray.Sphere((0, 0, 0), 1, **{kind: value})


@pytest.mark.parametrize("ior", [0, -1, 11, float("nan"), float("inf"), "thick"])
def test_wrong_indices(ior: Any) -> None:
    with pytest.raises(vtray.SceneError, match="Glass.ior: expected a .*number.*, got"):
        Glass(ior)


@once
def test_mirrors_show_skies() -> None:
    """A mirror ball in an empty sky looks like the sky, tinted; so does glass as thin as air."""
    scene = vtray.Scene()
    scene.objects = [vtray.Sphere((0, 0, 5), 1, (255, 128, 0), material="mirror")]
    scene.lights = [vtray.Sky(0.5, color=(200, 100, 50))]
    scene.camera = vtray.Camera.fit(scene, direction=(0, 0, 1), size=(9, 9))
    light = vtray.render(scene, integrator="whitted").linear[4, 4]
    assert light == pytest.approx([100, 50 * 128 / 255, 0])
    gradient = vtray.Gradient(zenith=(0, 0, 200), horizon=(100, 0, 0), ground=(0, 80, 0))
    scene.lights = [vtray.Sky(1, gradient=gradient)]
    scene.objects = [vtray.Sphere((0, 0, 5), 1, (255, 255, 255), material=Glass(1))]
    scene.camera = vtray.Camera.fit(scene, direction=(0, 1, 0), up=(0, 0, 1), size=(9, 9))
    known = {"exposure": 1, "background": "sky"}
    through = vtray.render(scene, integrator="whitted", depth=2, **known).pixels
    scene.objects = [vtray.Sphere((0, 0, 5), 0, (255, 255, 255))]
    beside = vtray.render(scene, **known).pixels
    assert np.abs(through.astype(int) - beside).max() <= 1
    assert len(np.unique(beside)) > 9


@pytest.mark.parametrize("lamp", ["ball", "panel"])
def test_mirrors_show_lamps_behind_the_camera(lamp: str) -> None:
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material="mirror")
    if lamp == "ball":
        scene.add_light(vtray.SphereLight((0, 0, 20), 1, radiance=0.7))
    else:
        scene.add_rectangle_light((0, 0, 20), [(1, 0, 0), (0, -1, 0)], radiance=0.7)
    for height in (10, 50):
        scene.camera = vtray.Camera.look_at(
            (0.002 * height, 0, height),
            target=(0, 0, 0),
            up=(0, 1, 0),
            fov_degrees=0.01,
            size=(2, 2),
        )
        image = vtray.render(scene, integrator="whitted", exposure=1)
        np.testing.assert_allclose(image.linear, 0.7 * 255, rtol=1e-12)
        assert vtray.trace_pixel(image, 0, 0).light == tuple(image.linear[0, 0])


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
@pytest.mark.parametrize("material", ["mirror", Glass(1, thin=True)])
@pytest.mark.parametrize(("angle", "shown"), [(5.01, 0.25), (40, 0.25), (4.99, 0)])
def test_mirrors_and_glass_show_wide_suns(
    integrator: str, material: AnyMaterial, angle: float, shown: float
) -> None:
    """As bright as they must be to light a floor as they do; narrow ones are as points."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material=material)
    sign = -1 if material == "mirror" else 1
    scene.add_sun((0.1, 0, sign), angle=angle, intensity=0.25, color=(255, 128, 0))
    for aside in (-0.9, 0.9, 1.1):  # of half the angle, from the middle
        tilt = np.arctan(0.1) + aside * np.radians(angle) / 2
        scene.camera = vtray.Camera.look_at(
            (20 * np.sin(tilt), 0, 20 * np.cos(tilt)),
            target=(0, 0, 0),
            up=(0, 1, 0),
            fov_degrees=0.01,
            size=(2, 2),
        )
        image = vtray.render(scene, integrator=integrator, exposure=1)
        radiance = (shown if aside < 1 else 0) / np.sin(np.radians(angle) / 2) ** 2
        expected = np.broadcast_to(A([255, 128, 0]) * radiance, (2, 2, 3))
        np.testing.assert_allclose(image.linear, expected, rtol=1e-9)
        assert vtray.trace_pixel(image, 0, 0).light == tuple(image.linear[0, 0])


ENDS = ((0, 0, 0.5), (0, 0, 1.5))


@pytest.mark.parametrize("ends", [ENDS, ENDS[::-1]])
@pytest.mark.parametrize("kind", ["cylinder", "cone"])
def test_glass_between_flat_caps(kind: str, ends: Any) -> None:
    """Light of 1 comes up through a column: a slab, whose light between its faces is a series."""
    scene = vtray.Scene()
    absorption = A([1.0, 0.5, 0.1])
    glass = Glass(1.5, absorption=tuple(absorption))
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material=Emissive(1))
    if kind == "cylinder":
        scene.add_cylinder(*ends, 0.5, material=glass)
    else:
        radii = (0.5, 0.4) if ends == ENDS else (0.4, 0.5)
        scene.add_cone(*ends, *radii, material=glass)
    scene.lights = []
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 0.1, up=(0, 1, 0), size=(3, 3))
    image = vtray.render(
        scene, integrator="whitted", depth=20, exposure=1, filter="box", warn=lambda _: None
    )
    reflected, passed = 0.04, np.exp(-absorption)
    light = (1 - reflected) ** 2 * passed / (1 - (reflected * passed) ** 2)
    np.testing.assert_allclose(image.linear[1, 1] / 255, light, rtol=1e-5)


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_ends_of_glass_may_be_swapped(integrator: str) -> None:
    def taken(*ends: tuple[float, float, float]) -> vtray.Image:
        scene = vtray.Scene()
        scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="red", material=Emissive(1))
        scene.add_cylinder(*ends, 0.4, material=Glass(1.33, absorption=(0.2, 0, 0)))
        scene.lights = []
        scene.camera = vtray.Camera.fit(scene, view="iso", size=(16, 12) if JIT else (8, 6))
        return vtray.render(scene, integrator=integrator, depth=8, samples=2)

    one, other = (0.2, -0.3, 0.4), (-0.3, 0.5, 1.6)
    found, expected_ = taken(one, other), taken(other, one)
    np.testing.assert_allclose(found.linear, expected_.linear, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(found.albedo, expected_.albedo)
