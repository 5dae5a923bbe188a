"""Lights that are no points: what arrives, ray by ray, and against what is known."""

import math
import time
from typing import Any

import numpy as np
import pytest
from single_rays import lit_pixel

import vtray
from conftest import JIT, compiled_only, once
from vtray import render
from vtray.geometry.queries import NOTHING
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.transport.sampling.fans import fans_of_middles

SIZE = (28, 21) if JIT else (8, 6)
STEP = 4
SMALL = (16, 16) if JIT else (4, 4)
TOLERANCE = 0.008  # a few fans from each point, not all


def spotted() -> np.ndarray:
    """Return the picture of a sky with bright spots."""
    return np.random.default_rng(8).lognormal(sigma=2, size=(16, 32, 3))


def soft_lights() -> list[Any]:
    return [
        vtray.Ambient(0.4),
        vtray.Light((3, -4, 9), 0.3, color=(255, 208, 160)),
        vtray.Sun((0.5, 0.6, -1), 0.5, angle=8, color=(255, 224, 192)),
        vtray.SphereLight((-4, -2, 5), 1.5, 0.4),
        vtray.RectangleLight((1, -1, 6), ((2, 0, 1), (0, 1.5, 0)), 0.3, color=(255, 240, 200)),
        vtray.RectangleLight((-1, 0.5, 2), ((0.4, 0, 0), (0, 0.3, 0)), radiance=2),
        vtray.SphereLight((2, 1, 3), 0.3, radiance=4),
        vtray.Sky(0.2, color=(160, 192, 255)),
        vtray.Sky(0.3, (255, 200, 180), vtray.Gradient(), up=(0, 0.2, 1)),
        vtray.Sky(0.1, image=spotted(), rotation=-70),
        vtray.Ambient(0.3, distance=0.7),
        vtray.Ambient(0.1, distance=0, color=(255, 208, 160)),
    ]


def scene_of(kind: str) -> vtray.Scene:
    """Return a scene of many shapes on a floor."""
    random = np.random.default_rng(3)
    scene = vtray.Scene()
    count = {"few": 12, "many": 600, "bonds": 60, "copies": 9}[kind]
    centers = random.uniform((-2, -2, 0.3), (2, 2, 4.3), (count, 3))
    scene.add_spheres(centers, random.uniform(0.05, 0.3, count), color="#c0d0e0")
    if kind in ("bonds", "copies"):
        ends = centers + random.normal(size=(count, 3)) * 0.4
        scene.add_cylinders(centers, ends, 0.06, color="white", color_end="#e07a5f")
    if kind == "copies":
        scene.objects = [vtray.Copies(scene.objects, random.uniform(-1, 1, (7, 3)))]
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#f4f1de")
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=SIZE)
    scene.lights = soft_lights()
    return scene


@once
@pytest.mark.parametrize("kind", ["few", "many", "bonds", "copies"])
def test_bundles_tell_what_each_ray_alone_would(kind: str) -> None:
    scene = scene_of(kind)
    image = render(scene, seed=5, tolerance=TOLERANCE)
    arrays = pack(scene, accelerate(scene)).arrays
    assert image.noise is not None
    fans = fans_of_middles(image.noise)
    hits = most = 0
    for y in range(1, SIZE[1], STEP):
        for x in range(1, SIZE[0], STEP):
            traced, count = lit_pixel(arrays, x, y, fans, seed=5)
            hits, most = hits + (traced.primitive != NOTHING), max(most, count)
            assert tuple(image.linear[y, x]) == traced.value
    assert hits > 10
    assert most > 2


@once
@pytest.mark.parametrize("kind", ["many", "copies"])
def test_samples_near_each_other_tell_what_each_alone_would(kind: str) -> None:
    scene = scene_of(kind)
    # A mirror, so that each sample can be traced by itself.
    scene.add_sphere((1.5, -1.5, 0.5), 0.5, material="mirror")
    samples = 4
    image = render(scene, integrator="whitted", samples=samples, filter="box", tolerance=TOLERANCE)
    hits = 0
    for y in range(1, SIZE[1], 2 * STEP):
        for x in range(1, SIZE[0], STEP):
            told = [vtray.trace_pixel(image, x, y, k) for k in range(samples)]
            mean = np.mean([tree.light for tree in told], axis=0)
            assert mean == pytest.approx(image.linear[y, x], rel=1e-12, abs=1e-12)
            hits += told[0].hit is not None
    assert hits > 10


@compiled_only
@pytest.mark.parametrize("samples", [1, 9])
def test_threads_and_tiles_change_nothing(samples: int) -> None:
    scene = scene_of("bonds")
    image = render(scene, threads=1, samples=samples)
    other = render(scene, threads=3, samples=samples, tile=16)
    np.testing.assert_array_equal(image.linear, other.linear)
    assert not np.array_equal(image.linear, render(scene, samples=samples, seed=1).linear)


@compiled_only
@pytest.mark.parametrize("kind", ["many", "copies"])
def test_pixels_asked_together_tell_what_each_alone_would(kind: str) -> None:
    scene = scene_of(kind)
    scene.lights = vtray.lights.studio(scene)
    images = [vtray.render(scene, size=(90, 66), samples=4, tile=tile) for tile in (64, 7, 1)]
    assert 0.1 < (images[0].samples == 4).mean() < 0.9
    for image in images[1:]:
        np.testing.assert_array_equal(image.samples, images[0].samples)
        np.testing.assert_array_equal(image.linear, images[0].linear)


@compiled_only
@pytest.mark.parametrize("samples", [1, 4])
def test_relit_and_recolored_pictures_are_those_rendered_anew(samples: int) -> None:
    options: dict[str, Any] = {"samples": samples, "keep_lights": True}
    image = render(scene_of("copies" if samples == 1 else "bonds"), **options)
    relit = image.relight([0.1, 0.9, 0.0, 2.0, 0.3, 5.0, 0.0, 0.5, 0.7, 0.1, 0.2, 0.4])
    np.testing.assert_array_equal(relit.linear, render(relit.scene, **options).linear)
    assert not np.array_equal(relit.linear, image.linear)
    colored = image.recolor(1, "purple")
    np.testing.assert_array_equal(colored.linear, render(colored.scene, **options).linear)


panel = vtray.RectangleLight


def floor(light: Any, *walls: tuple[float, float, float]) -> vtray.Scene:
    """Return a small part of a white floor near (1, 1, 0), with walls through the origin."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    for normal in walls:
        scene.add_plane((0, 0, 0), normal=normal)
    scene.camera = vtray.Camera((1, 1, 1e3), (0, 0, -1), 1.0, SMALL, (1e-7, 1e-7), up=(0, 1, 0))
    scene.lights = [light]
    return scene


def share(scene: vtray.Scene) -> float:
    """Return how bright a white floor is, on average, 1 for what a light of 1 makes it."""
    return float(render(scene, exposure=1.0).linear.mean()) / 255


@compiled_only
def test_noise_of_neighbours_cancels() -> None:
    """What 4 x 4 pixels are off by on the mean is less than a quarter of what one is off by."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    places = [(x, y, 1.2) for x in range(-4, 5) for y in range(-4, 5)]
    scene.add_spheres(places, 0.35)
    scene.lights = [vtray.Ambient()]
    # Between the balls, onto the floor.
    scene.camera = vtray.Camera.orthographic((0.5, 0.5, 3), (0.5, 0.5, 0), 0.2, size=(32, 32))
    pictures = np.array(
        [render(scene, exposure=1, tolerance=100, seed=seed).linear for seed in range(16)]
    )
    off = (pictures - pictures.mean(axis=0))[..., 0]
    of_squares = off.reshape(16, 8, 4, 8, 4).mean(axis=(2, 4))
    assert of_squares.std() < 0.2 * off.std()


@pytest.mark.parametrize("light", [vtray.Sky(), vtray.Ambient(), vtray.Ambient(distance=2)])
def test_nothing_near_leaves_all_the_light(light: Any) -> None:
    assert share(floor(light)) == 1.0
    scene = floor(light)
    scene.objects = []
    scene.add_sphere((1, 1, 0.25), 0.05)
    assert share(scene) == 1.0


@compiled_only
@pytest.mark.parametrize("light", [vtray.Sky(), vtray.Ambient(), vtray.Ambient(distance=1e6)])
def test_each_wall_of_a_corner_takes_half_of_the_light(light: Any) -> None:
    assert share(floor(light, (1, 0, 0))) == pytest.approx(0.5, abs=2e-3)
    assert share(floor(light, (1, 0, 0), (0, 1, 0))) == pytest.approx(0.25, abs=2e-3)


@compiled_only
def test_ambient_light_under_a_sphere() -> None:
    scene = floor(vtray.Ambient())
    scene.add_sphere((1, 0, 0.8), 0.8)
    # The form factor of a sphere that lies above the horizon is r^2 h / d^3.
    blocked = 0.8**3 / math.hypot(1, 0.8) ** 3
    assert share(scene) == pytest.approx(1 - blocked, abs=3e-3)
    scene.lights = [vtray.Ambient(distance=0.3)]
    assert share(scene) == 1.0
    scene.lights = [vtray.Ambient(distance=0.6)]
    assert 1 - blocked < share(scene) < 1.0


@pytest.mark.parametrize("radius", [0.1, 1.0, 2.9])
def test_a_sphere_that_nothing_hides_shines_as_its_middle(radius: float) -> None:
    scene = floor(vtray.Light((1, 3, 3)))
    soft = floor(vtray.SphereLight((1, 3, 3), radius))
    assert share(soft) == pytest.approx(share(scene), rel=2e-3)


@once
@pytest.mark.parametrize(
    ("light", "point"),
    [
        (vtray.SphereLight((1, 3, 3), 0.0), vtray.Light((1, 3, 3))),
        (vtray.SphereLight((1, 3, 3), 1e-9), vtray.Light((1, 3, 3))),
        # Far away, so that it is seen squarely from everywhere.
        (panel((0, 1e6, 2e6), ((1e-300, 0, 0), (0, 2e-9, -1e-9))), vtray.Light((0, 1e6, 2e6))),
        (panel((0, 1e6, 2e6), ((1, 0, 0), (0, 2, -1))), vtray.Light((0, 1e6, 2e6))),
        (vtray.Sun((0, -1, -2), angle=0), vtray.Light((1, 1e6, 2e6))),
        (vtray.Sun((0, -1, -2), angle=1e-6), vtray.Light((1, 1e6, 2e6))),
    ],
)
def test_lights_without_size_are_points(light: Any, point: vtray.Light) -> None:
    scene = scene_of("bonds")
    scene.lights = [light]
    soft = render(scene, exposure=1.0).linear
    scene.lights = [point]
    hard = render(scene, exposure=1.0).linear
    # Edges of shadows may lie on the other side of a pixel's middle.
    assert np.mean(np.abs(soft - hard).max(axis=2) > 0.01) < 0.01


def test_half_of_a_sun_behind_an_edge_gives_half_its_light() -> None:
    scene = floor(vtray.Sun((-1, 0, -1), angle=1))
    unhidden = share(scene)
    # Nearly a half-plane, whose edge the middle of the sun's rays touches at (301, 1, 300).
    down = 1e4 / math.sqrt(2)
    scene.add_sphere((301 + down, 1, 300 - down), 1e4)
    assert share(scene) == pytest.approx(unhidden / 2, abs=0.01)


def test_what_lies_behind_the_image_plane_stops_no_light() -> None:
    scene = floor(vtray.Ambient())
    bare = render(scene).linear
    scene.add_sphere((1, 1, 1002.0), 1.5)
    assert share(scene) == 1.0
    np.testing.assert_array_equal(render(scene).linear, bare)


def test_colors_of_lights() -> None:
    scene = floor(vtray.Ambient(color=(255, 128, 0)))
    scene.add_light((1, 1, 5), 0.5, color="blue")
    linear = render(scene, exposure=1.0).linear
    np.testing.assert_allclose(linear.mean(axis=(0, 1)), [255, 128, 127.5], rtol=1e-6)


ODD_PANELS: list[tuple[str, Any, Any]] = [
    ("in the floor", (1, 1, 0), ((1, 0, 0), (0, 1, 0))),
    ("upright in the floor", (1, 1, 0), ((1, 0, 0), (0, 0, 1))),
    ("below the floor", (1, 1, -3), ((1, 0, 0), (0, 1, 0))),
    ("tiny", (0, 0, 5), ((1e-300, 0, 0), (0, 5e-324, 0))),
    ("tiny, on the floor", (1, 1, 0), ((1e-300, 0, 0), (0, 0, 5e-324))),
    ("huge", (0, 0, 9), ((1e300, 0, 0), (0, 1e300, 0))),
    ("huge, through all", (0, 0, 2), ((1e300, 0, 0), (0, 0, 1e300))),
    ("a line", (0, 0, 2), ((5, 0, 0), (0, 0, 1e-200))),
    ("far away", (1e200, -1e200, 1e200), ((1, 0, 0), (0, 1, 0))),
]


@once
@pytest.mark.parametrize(
    "light",
    [
        pytest.param(vtray.SphereLight((1, 1, 0), 0.5), id="half in the floor"),
        pytest.param(vtray.SphereLight((1, 1, -3), 0.5), id="below the floor"),
        pytest.param(vtray.SphereLight((0, 0, 2.3), 50), id="around everything"),
        pytest.param(vtray.SphereLight((1, 1, 0), 1e-300), id="tiny, on the floor"),
        pytest.param(vtray.Sun((0, 0, 1), angle=180), id="from below"),
        pytest.param(vtray.Sun((1, 0, 0), angle=180), id="half below the horizon"),
        pytest.param(vtray.Ambient(distance=1e-300), id="as near as nothing"),
        pytest.param(vtray.Sky(0.0), id="a black sky"),
        *(
            pytest.param(panel(place, edges, **strength), id=f"{words} {strength}")
            for strength in ({}, {"radiance": 1.0})
            for words, place, edges in ODD_PANELS
        ),
    ],
)
def test_odd_lights_give_finite_light(light: Any) -> None:
    scene = scene_of("few")
    scene.lights = [light, vtray.Light((0, -9, 9))]
    linear = render(scene).linear
    assert np.isfinite(linear).all()
    assert (linear >= 0).all()


@pytest.mark.parametrize("place", [(0.0, 0.0, 2.0), (1e6, -1e6, 1e6)])
def test_a_ball_with_a_lamp_of_its_own_size_shines(place: tuple[float, float, float]) -> None:
    scene = vtray.Scene()
    scene.add_sphere(place, 0.5)
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=SIZE)
    scene.lights = [vtray.SphereLight(place, 0.5)]
    image = render(scene, exposure=1.0)
    np.testing.assert_array_equal(image.linear[image.ids[..., 0] == 0], 255.0)


@compiled_only
def test_edges_of_the_shadow_of_a_small_sun_get_samples() -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 2), 0.7)
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.camera = vtray.Camera((0, 0, 9), (0, 0, -1), 1.0, (48, 36), (0.01, 0.01), up=(0, 1, 0))
    scene.lights = [vtray.Sun((0, -1, -1), angle=0.53)]
    soft = render(scene, samples=64, exposure=1.0).linear
    stairs = render(scene, exposure=1.0).linear
    scene.lights = [vtray.Light((0, 1e6, 1e6))]
    hard = render(scene, samples=64, exposure=1.0).linear
    # Its half-shadows are a fifth of a pixel wide here.
    assert np.abs(soft - hard).max() < 0.1 * 255
    assert np.abs(stairs - hard).max() > 0.15 * 255


@compiled_only
def test_half_shadows_of_a_million_spheres_take_no_time() -> None:
    """Most of them lie beside the rays from a patch of the floor to the lamp."""
    places = np.stack(np.meshgrid(*3 * [np.arange(100.0)], indexing="ij"), axis=-1).reshape(-1, 3)
    scene = vtray.Scene()
    scene.add_spheres(places, 0.5)
    scene.add_plane((0, 0, -0.5), (0, 0, 1))
    scene.camera = vtray.Camera.fit(scene, direction=(-3, 4, -2.4), size=(64, 48))
    scene.lights = [vtray.SphereLight((60, -220, 220), 50)]
    render(scene, samples=4, size=(2, 2))  # kernels and the hierarchy are there then
    for size in ((8, 6), (64, 48), (256, 192)):  # balls are smaller than pixels, or larger
        begin = time.process_time()
        render(scene, samples=4, size=size)
        assert time.process_time() - begin < 4, "it takes 15 s where all are looked at"


@compiled_only
def test_what_only_some_searches_would_leave_out_decides_nothing() -> None:
    # A ball that a patch does not reach, but bounds on its bundle do; which points are searched for
    # together depends on the tiles.
    generator = np.random.default_rng(0)
    generator.uniform(-2, 2, (60, 3))
    scene = vtray.Scene()
    scene.add_spheres(generator.uniform(-2, 2, (60, 3)), 0.5)
    scene.add_plane((0, 0, -2.5), (0, 0, 1))
    scene.lights = [vtray.Light((3, -5, 6), 0.7), vtray.Sky(0.3)]
    eye = {"up": (0, 0, 1), "size": (120, 90)}
    scene.camera = vtray.Camera.look_at((0, -9, 3), (0, 0, 0), **eye)
    image, other = (vtray.render(scene, samples=4, tile=tile) for tile in (64, 17))
    np.testing.assert_array_equal(image.samples, other.samples)
    np.testing.assert_array_equal(image.linear, other.linear)


@compiled_only
@pytest.mark.parametrize("kind", ["faded", "mirrored"])
def test_samples_decide_without_those_of_other_pixels(kind: str) -> None:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1, "skyblue", opacity=0.3 if kind == "faded" else 1.0)
    scene.add_sphere((1.6, 0, -0.4), 0.8, material="mirror" if kind == "mirrored" else "lambert")
    scene.add_plane((0, 0, -1.2), normal=(0, 0, 1))
    scene.camera = vtray.Camera.look_at((1, -7, 3), (0, 0, -0.3), fov_degrees=32, size=(90, 70))
    scene.lights = [vtray.Sky(0.5), vtray.SphereLight((2, -3, 4), 0.4, 0.02)]
    options: dict[str, Any] = {"samples": 4, "tolerance": 0.001, "exposure": 1.0}
    if kind == "mirrored":
        options |= {"integrator": "whitted"}
    images = [vtray.render(scene, tile=tile, **options) for tile in (64, 100, 7)]
    for image in images[1:]:
        np.testing.assert_array_equal(image.linear, images[0].linear)
        np.testing.assert_array_equal(image.error, images[0].error)


@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("opacity", [None, 0.5])
def test_nothing_keeps_off_ambient_light_of_no_distance(
    samples: int, opacity: float | None
) -> None:
    scene = vtray.Scene(lights=[vtray.Ambient(0.25, distance=0, color=(255, 204, 153))])
    random = np.random.default_rng(5)
    scene.add_spheres(random.uniform(-1, 1, (40, 3)), 0.3, color="#c0d0e0", opacity=opacity)
    scene.camera = vtray.Camera.fit(scene, size=SIZE)
    settings = {"samples": samples, "exposure": 1.0}
    image = render(scene, **settings)
    if opacity is None:
        expected = 0.25 * np.array([0xC0, 0xD0, 0xE0]) * np.array([255, 204, 153]) / 255
        np.testing.assert_allclose(image.linear.max(axis=(0, 1)), expected, rtol=1e-12)
    # As with rays, which nothing can be in the way of.
    scene.lights = [vtray.Ambient(0.25, distance=1e-9, color=(255, 204, 153))]
    asked = render(scene, **settings)
    np.testing.assert_array_equal(asked.linear, image.linear)
    assert image.stats["rays"] < asked.stats["rays"]


@once
@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_what_is_everywhere_is_seen_in_mirrors_and_ends_paths(integrator: str) -> None:
    scene = vtray.Scene(lights=[vtray.Ambient(0.5, distance=0), vtray.Ambient(0.5)])
    scene.add_sphere((0, 0, 0), 1, material="mirror", color="white")
    scene.camera = vtray.Camera.fit(scene, size=SMALL)
    image = render(scene, integrator=integrator, exposure=1.0, warn=str)
    seen = image.linear[image.ids[..., 0] == 0]
    np.testing.assert_allclose(seen, 255, rtol=1e-12)


@once
def test_paths_take_what_is_everywhere_for_a_sky() -> None:
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0), (1.9, 0, 0), (1, 1, 1)], 1, color="#c0d0e0")
    scene.camera = vtray.Camera.fit(scene, size=SMALL)
    images = []
    for distance in (0, math.inf):
        scene.lights = [vtray.Ambient(0.5, distance)]
        images.append(render(scene, integrator="path", samples=4, exposure=1.0))
    np.testing.assert_array_equal(images[0].linear, images[1].linear)
    assert images[0].linear.any()


@once
def test_pixels_tell_that_all_arrives_of_what_is_everywhere() -> None:
    scene = vtray.Scene(lights=[vtray.Ambient(0.5, distance=0)])
    scene.add_sphere((0, 0, 0), 1)
    scene.camera = vtray.Camera.fit(scene, size=SMALL)
    traced = vtray.trace_pixel(scene, SMALL[0] // 2, SMALL[1] // 2)
    (way,) = traced.lights
    assert way.rays == ()
    assert way.arrives
    assert "ambient: all of it arrives, 1 of its light" in str(traced)
