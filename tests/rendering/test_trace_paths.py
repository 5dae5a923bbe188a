"""Paths of a pixel that are told ray by ray, beside the pictures that they make."""

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray.commands import cli
from vtray.commands.explain import explain_pixel
from vtray.figures.ray_tree import PathRay, RayTree

WHITE = (255, 255, 255)

SIZE = (24, 20) if JIT else (7, 6)
MIDDLE = SIZE[0] // 2, SIZE[1] // 2

LIGHTS: list[Any] = [
    vtray.Sky(0.5),
    vtray.SphereLight((2, 2, 3), 0.5, radiance=3),
    vtray.Light((1, -3, 4), 0.4),
    vtray.Sun((1, 1, -3), 0.3, angle=4),
    vtray.RectangleLight((-2, 0, 3), ((1, 0, 0), (0, 1, 0)), radiance=2, visible=True),
    vtray.Sky(0.2, gradient=vtray.Gradient((95, 143, 216), (244, 239, 230), (138, 128, 120))),
]


def all_materials(lights: list[Any] = LIGHTS) -> vtray.Scene:
    """Return some balls on a floor, each of another material."""
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, WHITE, material=vtray.Glass(absorption=(0.5, 0.1, 0))),
        vtray.Sphere((0.6, 0.1, 0.4), 0.4, (200, 99, 71), material=vtray.Plastic(roughness=0.3)),
        vtray.Sphere(
            (0.1, -0.7, 0.3), 0.3, (200, 199, 71), material=vtray.Blend("mirror", "lambert", 0.6)
        ),
        vtray.Sphere((0.1, 0.7, 0.3), 0.3, WHITE, material=vtray.Metal("gold", roughness=0.3)),
        vtray.Sphere((-0.6, -0.8, 0.2), 0.2, (255, 180, 90), material=vtray.Emissive(2)),
        vtray.Sphere((-0.6, 0.9, 0.2), 0.2, WHITE, material=vtray.Glass(roughness=0.4)),
        vtray.Sphere((0.8, -0.8, 0.2), 0.2, WHITE, material=vtray.Glass(thin=True)),
        vtray.Sphere(
            (0.1, 0, 0.25), 0.25, (255, 99, 71), material=vtray.Blend("emissive", "plastic", 0.7)
        ),
        vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208), lambert=0.8),
    ]
    scene.lights = lights
    scene.camera = vtray.Camera.look_at(
        (0, -3, 4), target=(0, 0, 0.3), up=(0, 0, 1), fov_degrees=30, size=SIZE
    )
    return scene


def rendered(scene: vtray.Scene, integrator: str, **settings: Any) -> vtray.Image:
    """Return a picture; that rough surfaces are shown as smooth needs no warning."""
    return vtray.render(scene, integrator=integrator, warn=[].append, **settings)


def some_pixels(step: int = 3) -> list[tuple[int, int]]:
    """Return pixels all over the picture."""
    return [(x, y) for y in range(0, SIZE[1], step) for x in range(0, SIZE[0], step)]


def parts_of(ray: PathRay) -> Any:
    """Return the sum of all that a ray is said to add."""
    return np.sum([ray.met, ray.shines, *(way.adds for way in ray.lights)], axis=0)


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
@pytest.mark.parametrize("lights", [len(LIGHTS), 20, 140])
def test_what_is_told_is_what_the_picture_shows(integrator: str, lights: int) -> None:
    """To the last bit; and the parts of it are all of it."""
    scene = all_materials()
    if lights > len(LIGHTS):
        places = np.random.default_rng(3).uniform((-3, -3, 2), (3, 3, 5), (lights, 3))
        scene.lights = [vtray.SphereLight(tuple(place), 0.2, 2) for place in places.tolist()]
    image = rendered(scene, integrator, samples=1)
    surfaces = 0
    for x, y in some_pixels(4):
        tree = vtray.trace_pixel(image, x, y)
        assert tree.light == tuple(image.linear[y, x])
        for ray in tree.path:
            assert parts_of(ray) == pytest.approx(ray.light, rel=1e-9, abs=1e-9)
            surfaces += ray.hit is not None
        assert tree.path[0].hit == tree.hit
        assert tree.path[0].lights == tree.lights
    assert surfaces > 1.3 * len(some_pixels(4))


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_a_pixel_is_the_mean_of_its_samples(integrator: str) -> None:
    scene = all_materials()
    scene.camera = scene.camera.replace(lens=vtray.Lens(0.05, 4.5))
    samples = 6
    image = rendered(scene, integrator, samples=samples, filter="box")
    for x, y in some_pixels(6):
        told = [vtray.trace_pixel(image, x, y, k) for k in range(samples)]
        assert len({tree.origin for tree in told}) == samples
        mean = np.mean([tree.light for tree in told], axis=0)
        assert mean == pytest.approx(image.linear[y, x], rel=1e-12, abs=1e-12)
        assert [tree.sample for tree in told] == list(range(samples))


@once
def test_what_is_seen_follows_from_what_was_chosen() -> None:
    """Each ray is seen as much as the one before, by what its surface leaves of the light."""
    image = vtray.render(all_materials(), integrator="path", samples=4)
    checked = set()
    for x, y in some_pixels(2):
        for sample in (0, 3):
            path = vtray.trace_pixel(image, x, y, sample).path
            assert [ray.parent for ray in path] == [None, *range(len(path) - 1)]
            for before, ray in pairwise(path):
                assert before.hit is not None
                assert before.choice is not None
                assert ray.how == before.choice.how
                surface, kind = before.hit.surface, type(before.material).__name__
                share = np.array(before.seen) * before.passes / before.choice.goes_on
                cosine = float(np.dot(ray.direction, before.hit.normal))
                assert (cosine < 0) == (ray.how == "refracted")
                if kind == "Lambert":
                    share *= surface.lambert * np.array(surface.color) / 255
                    assert before.choice.density == pytest.approx(cosine / math.pi)
                elif kind == "Mirror":
                    share *= np.array(surface.color) / 255
                elif kind != "Glass" or before.material.roughness > 0:
                    continue
                assert ray.seen == pytest.approx(share)
                checked.add(kind)
    assert checked == {"Lambert", "Mirror", "Glass"}


@once
def test_smooth_glass_refracts_as_snell_says() -> None:
    image = rendered(all_materials(), "whitted")
    x, y = int(0.36 * SIZE[0]), SIZE[1] // 2
    tree = vtray.trace_pixel(image, x, y)
    inner = [ray for ray in tree.path if ray.parent == 0 and ray.how == "refracted"]
    outer = [ray for ray in tree.path if ray.parent == 0 and ray.how == "mirrored"]
    assert tree.hit is not None
    sines = [
        float(np.linalg.norm(np.cross(ray.direction, tree.hit.normal)))
        for ray in (*inner, *outer, tree.path[0])
    ]
    assert sines == pytest.approx([sines[2] / 1.5, sines[2], sines[2]])
    # What both see is all there is; glass leaves less of red the farther light goes through it.
    assert np.add(inner[0].seen, outer[0].seen) == pytest.approx([1, 1, 1])
    left = [math.exp(-share * inner[0].distance) for share in (0.5, 0.1, 0)]
    assert inner[0].passes == pytest.approx(left)
    assert outer[0].passes == (1, 1, 1)


def mirror_and_floor() -> vtray.Scene:
    """Return a mirror that stands upright on a floor, seen in the middle of the picture."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color=(200, 100, 50))
    scene.add_plane((0, 4, 0), normal=(0, -1, 0), material="mirror")
    scene.add_light((0, 0, 4))
    scene.camera = vtray.Camera.look_at(
        (0, -8, 5), target=(0, 4, 2), up=(0, 0, 1), fov_degrees=1, size=(2, 2)
    )
    return scene


def test_words_of_a_tree() -> None:
    scene = mirror_and_floor()
    image = vtray.render(scene, integrator="whitted", exposure=1)
    text = str(vtray.trace_pixel(image, 1, 1))
    expected = """\
hit          objects[1], a plane, 12.36931688 away
  point      (0, 4, 2)
  normal     (0, -1, 0), on the ray's side
  material   color (255, 255, 255), mirror
ray 1        mirrored where the first ray hits, towards (0, -0.970143, -0.242536)
  seen       1 of its light
hit          objects[0], a plane, 8.246211251 away
  point      (0, -4, 0)
  normal     (0, 0, 1), on the ray's side
  material   color (200, 100, 50), lambert 1
lights[0]    towards (0, 0.707107, 0.707107), 5.656854249 away
  adds       (141.421, 70.7107, 35.3553) = cosine 0.707107 x lambert 1 x intensity 1 x color
light        (141.421, 70.7107, 35.3553), the sum over all rays
exposure     floor(255 x light / 255), 255 is what becomes 255
value        (141, 70, 35)"""
    assert text.split("\n", 2)[2] == expected
    assert explain_pixel(scene, image, 1, 1) == f"{text}\n"


@once
@pytest.mark.parametrize(
    ("depth", "words"),
    [
        (0, "  ends       after 0 bounces, the depth of the picture"),
        (1, "  ends       after 1 bounce, the depth of the picture"),
        (8, "  ends       by chance: it would have gone on with chance 0."),
    ],
)
def test_words_of_the_end_of_a_path(depth: int, words: str) -> None:
    scene = all_materials()
    scene.render = vtray.RenderSettings(integrator="path", depth=depth, samples=16)
    assert any(words in str(vtray.trace_pixel(scene, *MIDDLE, sample)) for sample in range(16))


@once
def test_words_of_each_material() -> None:
    samples = 2
    image = vtray.render(all_materials(), integrator="path", samples=samples)
    lines = {
        line.strip()
        for x, y in some_pixels(2)
        for sample in range(samples)
        for line in str(vtray.trace_pixel(image, x, y, sample)).splitlines()
    }
    starts = (
        "material   color (255, 255, 255), glass, ior 1.5, absorption (0.5, 0.1, 0)",
        "material   color (200, 99, 71), plastic, ior 1.5, roughness 0.3",
        "material   color (200, 199, 71), mirror",
        "chosen     of two blended materials, with chance 0.4",
        "chosen     of two blended materials, with chance 0.6",
        "material   color (255, 255, 255), metal gold, roughness 0.3",
        "material   color (255, 180, 90), emissive, radiance 2",
        "onward     refracted, with chance 0.9",
        "onward     scattered, density ",
        "glass      leaves (",
    )
    for start in starts:
        assert any(line.startswith(start) for line in lines), start


@once
def test_words_of_blended_and_thin_materials() -> None:
    image = rendered(all_materials(), "whitted")
    blend = "material   color (200, 199, 71), mirror blended with 0.6 of lambert"
    missing = {blend, "glass, ior 1.5, thin"}
    for x, y in some_pixels(2):
        if missing:
            text = str(vtray.trace_pixel(image, x, y))
            missing = {words for words in missing if words not in text}
    assert not missing


@once
def test_fireflies_are_told_as_they_are_limited() -> None:
    scene = all_materials()
    image = vtray.render(scene, integrator="path", firefly=0.25)
    x, y = MIDDLE
    told = vtray.trace_pixel(image, x, y)
    assert max(told.light) == pytest.approx(0.25 * 255)
    assert told.light == pytest.approx(image.linear[y, x])
    assert "the sum over all rays, limited to a brightest channel of 63.75" in str(told)


def test_which_samples_there_are(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    scene = mirror_and_floor()
    image = vtray.render(scene, integrator="path", samples=4)
    for sample in (4, -1):
        words = f"trace_pixel: expected a sample from 0 to 3, got {sample}"
        with pytest.raises(vtray.RenderError, match=words):
            vtray.trace_pixel(image, 0, 0, sample)
    with pytest.raises(vtray.RenderError, match="samples have whole numbers, got 0.5; round it"):
        vtray.trace_pixel(image, 0, 0, 0.5)
    with pytest.raises(vtray.RenderError, match="samples are told where rays go on from surfaces"):
        vtray.trace_pixel(scene, 0, 0, 0)
    one = vtray.render(scene, integrator="path")
    assert vtray.trace_pixel(one, 0, 0, 0) == vtray.trace_pixel(one, 0, 0)
    scene.render = scene.render.replace(integrator="path", samples=4)
    file = tmp_path / "scene.json"
    scene.save(file)
    assert cli.run(["--pixel", "0,0:2", str(file)]) == 0
    assert capfd.readouterr().out == f"{vtray.trace_pixel(image, 0, 0, 2)}\n"
    assert cli.run(["--pixel", "0,0:7", str(file)]) == 1
    assert "--pixel: expected a sample from 0 to 3, got 7" in capfd.readouterr().err


def words_in(tree: RayTree) -> list[str]:
    """Return all that is written in a drawing."""
    ax = tree.draw()
    ax.figure.draw_without_rendering()
    return [text.get_text() for text in ax.texts]


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_drawings_show_the_rays_that_go_on(integrator: str) -> None:
    pytest.importorskip("matplotlib")
    image = rendered(all_materials(), integrator)
    drawn = 0
    for x, y in some_pixels(5 if JIT else 3):
        tree = vtray.trace_pixel(image, x, y)
        words = words_in(tree)
        goes_on = len(tree.path) > 1
        assert any("and the ray that goes on first" in text for text in words) == goes_on
        if len(tree.path) <= 12:
            numbers = [text for text in words if text.isdigit()]
            assert numbers[: len(tree.path) - 1] == [f"{k}" for k in range(1, len(tree.path))]
            drawn += goes_on
    assert drawn
    # A light that is asked for decides, as without such rays.
    trees = (vtray.trace_pixel(image, *at) for at in some_pixels(2))
    lit = next(tree for tree in trees if tree.lights)
    ax = lit.draw(light=lit.lights[0].light)
    assert not any("goes on first" in text.get_text() for text in ax.texts)


def test_a_path_that_meets_nothing() -> None:
    scene = all_materials()
    scene.objects = scene.objects[:1]
    image = vtray.render(scene, integrator="path")
    tree = vtray.trace_pixel(image, 0, 0)
    assert (len(tree.path), tree.hit, tree.lights, tree.light) == (1, None, (), (0, 0, 0))
    assert "hit          nothing in front of the image plane" in str(tree)
    assert "and the ray that goes on" not in " ".join(words_in(tree))


@pytest.mark.parametrize("kind", ["balls", "plane"])
def test_what_is_not_shown_is_not_told(kind: str) -> None:
    scene = mirror_and_floor()
    if kind == "balls":
        scene.add_spheres([(0, 0, 2)], 0.5, opacity=0.5)
    else:
        scene.add_plane((0, 0, 9), normal=(0, 0, -1), opacity=0.5)
    scene.render = vtray.RenderSettings(integrator="path")
    with pytest.raises(vtray.RenderError, match='opacity: not between 0 and 1 with integrator="p'):
        vtray.trace_pixel(scene, 1, 1)
