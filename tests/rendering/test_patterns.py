"""Patterns on surfaces, beside what schoolbook formulas say of them."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray.figures.ray_tree import RayTree
from vtray.scene.fingerprint import scene_hash

SIZE = (48, 40) if JIT else (16, 12)
RED, BLUE = (250, 10, 20), (10, 20, 250)
TILT = (0.3, -0.5, 0.8)
TWO = {"colors": (RED, BLUE), "up": TILT, "rotation": 25}


def picture_of(item: Any, **settings: Any) -> vtray.Image:
    """Return a picture of one object in a light from behind the camera."""
    scene = vtray.Scene(objects=[item], lights=[vtray.Light((1, -9, 4), 1)])
    eye = (1, -4, 2.5)
    scene.camera = vtray.Camera.look_at(
        eye, target=(0, 0, 0), up=(0, 0, 1), fov_degrees=40, size=SIZE
    )
    return vtray.render(scene, **{"warn": [].append, **settings})


def frame(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what is up beside an axis, turned by 25 degrees, and what is square to both."""
    up = np.array(TILT) / np.linalg.norm(TILT)
    first = up - (up @ axis) * axis
    if np.linalg.norm(first) < 1e-6:  # what follows z, which is nearest to the axis, is x
        first = np.array([1.0, 0, 0]) - axis[0] * axis
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    turn = math.radians(25)
    return (
        math.cos(turn) * first + math.sin(turn) * second,
        math.cos(turn) * second - math.sin(turn) * first,
    )


def around(offset: np.ndarray, axis: np.ndarray, radius: float) -> float:
    """Return how far around an axis an offset is."""
    first, second = frame(axis)
    return radius * (math.atan2(offset @ second, offset @ first) + math.pi)


def on_sphere(point: np.ndarray) -> tuple[float, float, float, float]:
    axis = np.array(TILT) / np.linalg.norm(TILT)
    down = 1.1 * math.acos(min(max(point @ axis / 1.1, -1), 1))
    return around(point, axis, 1.1), down, 2.2 * math.pi, 1.1 * math.pi


def on_cylinder(point: np.ndarray) -> tuple[float, float, float, float] | None:
    start, end = np.array([0.2, 0, -1]), np.array([0, 0.4, 1])
    axis = (end - start) / np.linalg.norm(end - start)
    down = (point - start) @ axis
    length = float(np.linalg.norm(end - start))
    if not 1e-9 < down < length - 1e-9:
        return None
    return around(point - start, axis, 0.8), length - down, 1.6 * math.pi, length


def on_cone(point: np.ndarray) -> tuple[float, float, float, float] | None:
    axis, height = np.array([0.0, 0, 1]), point[2] + 1
    if not 1e-9 < height < 2 - 1e-9:
        return None
    slope = math.hypot(2, 0.9) / 2
    return around(point, axis, 1.1), (2 - height) * slope, 2.2 * math.pi, 2 * slope


def on_plane(point: np.ndarray) -> tuple[float, float, float, float]:
    normal = np.array([0.1, -0.3, 1]) / np.linalg.norm([0.1, -0.3, 1])
    up, left = frame(normal)
    offset = point - np.array([0.1, 0.2, -0.3])
    return -offset @ left, -offset @ up, math.inf, math.inf


SHAPES = {
    "sphere": (lambda **more: vtray.Sphere((0, 0, 0), 1.1, (9, 9, 9), **more), on_sphere),
    "cylinder": (
        lambda **more: vtray.Cylinder((0.2, 0, -1), (0, 0.4, 1), 0.8, (9, 9, 9), **more),
        on_cylinder,
    ),
    "cone": (
        lambda **more: vtray.Cone((0, 0, -1), (0, 0, 1), 1.1, 0.2, (9, 9, 9), **more),
        on_cone,
    ),
    "plane": (
        lambda **more: vtray.Plane((0.1, 0.2, -0.3), (0.1, -0.3, 1), (9, 9, 9), **more),
        on_plane,
    ),
}


def cell(along: float, length: float, size: float, times: int) -> tuple[int, float]:
    """Return the number of a cell, and how far its border is, in cells."""
    if length < math.inf:
        size = length / (times * max(math.floor(length / (times * size) + 0.5), 1))
    number = along / size
    return math.floor(number), abs(number - round(number))


@once
@pytest.mark.parametrize("kind", ["checker", "around", "along"])
@pytest.mark.parametrize("shape", SHAPES)
def test_colors_are_where_formulas_say(shape: str, kind: str) -> None:
    make, place_on = SHAPES[shape]
    size = 0.37
    pattern = (
        vtray.Checker(size=size, **TWO)
        if kind == "checker"
        else vtray.Stripes(size=size, run=kind, **TWO)
    )
    image = picture_of(make(material=vtray.Lambert(pattern=pattern)))
    seen = set()
    for y in range(0, SIZE[1], 2):
        for x in range(0, SIZE[0], 2):
            hit = vtray.trace_pixel(image, x, y).hit
            if hit is None:
                continue
            place = place_on(np.array(hit.point))
            if place is None:
                expected = (9, 9, 9)
            else:
                across, down, width, height = place
                one, near_one = cell(across, width, size, 2) if kind != "around" else (0, 1.0)
                other, near_other = cell(down, height, size, 1) if kind != "along" else (0, 1.0)
                if min(near_one, near_other) < 1e-6:
                    continue
                expected = BLUE if (one + other) % 2 else RED
            assert image.albedo[y, x] * 255 == pytest.approx(expected), (x, y)
            seen.add(expected)
    assert {RED, BLUE} <= seen


RANDOM = np.random.default_rng(5).integers(0, 256, (5, 7, 4)).astype(np.uint8)


def mixed(place: float, count: int, repeats: bool) -> list[tuple[int, float]]:
    """Return between which rows of pixels a place is, with the share of each."""
    first = math.floor(place * count - 0.5)
    share = place * count - 0.5 - first
    rows = [first, first + 1]
    kept = [row % count if repeats else min(max(row, 0), count - 1) for row in rows]
    return [(kept[0], 1 - share), (kept[1], share)]


def shown(place: tuple[float, float, float, float], size: float | None) -> np.ndarray:
    """Return the colour of a place of a random picture on a grey surface."""
    across, down, width, height = place
    rows, columns, _ = RANDOM.shape
    asked = size or 1.0
    lengths, times = [asked, asked * rows / columns], [math.inf, math.inf]
    if width < math.inf:
        times = [
            max(math.floor(whole / length + 0.5), 1) if size else 1
            for whole, length in zip((width, height), lengths, strict=True)
        ]
        lengths = [width / times[0], height / times[1]]
    x, y = across / lengths[0] % 1, down / lengths[1] % 1
    color = np.zeros(3)
    for row, vertical in mixed(y, rows, times[1] > 1):
        for column, level in mixed(x, columns, repeats=True):
            pixel = RANDOM[row, column].astype(float)
            opacity = pixel[3] / 255
            over = opacity * pixel[:3] + (1 - opacity) * np.array([9.0, 9, 9])
            color += vertical * level * over
    return color


@once
@pytest.mark.parametrize("size", [None, 0.9])
@pytest.mark.parametrize("shape", SHAPES)
def test_pictures_are_where_formulas_say(shape: str, size: float | None) -> None:
    make, place_on = SHAPES[shape]
    pattern = vtray.ImagePattern(RANDOM, size=size, up=TILT, rotation=25)
    image = picture_of(make(material=vtray.Lambert(pattern=pattern)))
    seen = 0
    for y in range(0, SIZE[1], 2):
        for x in range(0, SIZE[0], 2):
            hit = vtray.trace_pixel(image, x, y).hit
            if hit is None:
                continue
            place = place_on(np.array(hit.point))
            expected = np.array([9.0, 9, 9]) if place is None else shown(place, size)
            assert image.albedo[y, x] * 255 == pytest.approx(expected, abs=1e-6), (x, y)
            seen += 1
    assert seen > 5


FRONT = {
    "sphere": vtray.Sphere((0, 0, 0), 1, (9, 9, 9)),
    "cylinder": vtray.Cylinder((0, 0, -1), (0, 0, 1), 1, (9, 9, 9)),
    "cone": vtray.Cone((0, 0, -1), (0, 0, 1), 1, 0.8, (9, 9, 9)),
    "plane": vtray.Plane((0, -1, 1), (1, 0, 0), (9, 9, 9)),
}


@pytest.mark.parametrize("shape", FRONT)
def test_pictures_are_upright_and_not_mirrored(shape: str) -> None:
    """The middle of a picture is towards x, and a plane's begins at its point."""
    red, green, blue, white = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
    corners = np.array([[red, green], [blue, white]], np.uint8).repeat(8, 0).repeat(8, 1)
    pattern = vtray.ImagePattern(corners, size=2 if shape == "plane" else None)
    item = FRONT[shape].replace(material=vtray.Lambert(pattern=pattern))
    scene = vtray.Scene(objects=[item], lights=[vtray.Light((9, 0, 0))])
    scene.camera = vtray.Camera.look_at(
        (9, 0, 0), target=(0, 0, 0), up=(0, 0, 1), fov_degrees=12, size=(8, 8)
    )
    albedo = vtray.render(scene).albedo
    for (y, x), color in {(2, 2): red, (2, 5): green, (5, 2): blue, (5, 5): white}.items():
        assert albedo[y, x].tolist() == pytest.approx([part / 255 for part in color])


@pytest.mark.parametrize("tonemap", ["linear", "srgb"])
def test_colors_of_pictures_are_those_of_objects(tonemap: str) -> None:
    even = vtray.Lambert(pattern=vtray.ImagePattern(np.full((2, 2, 3), RED, np.uint8)))
    painted = picture_of(vtray.Sphere((0, 0, 0), 1, BLUE, material=even), tonemap=tonemap)
    plain = picture_of(vtray.Sphere((0, 0, 0), 1, RED), tonemap=tonemap)
    assert painted.albedo == pytest.approx(plain.albedo)


def all_shapes(pattern: Any, **numbers: Any) -> list[Any]:
    """Return one object of each kind, with a pattern on another material each."""
    materials = [
        vtray.Lambert(pattern=pattern),
        vtray.Plastic(pattern=pattern, **numbers),
        vtray.Metal(pattern=pattern, **numbers),
        vtray.Blend("mirror", "lambert", pattern=pattern),
    ]
    places = [(-1, 0, 0), (1, 0, 0), (0, 0, 1), (0, 0, 0)]
    plane, white = vtray.Plane((0, 0, -1), (0, 0, 1), (200, 210, 220)), (255, 250, 245)
    return [
        plane.replace(material=vtray.Lambert(pattern=pattern)),
        vtray.Sphere(places[0], 0.7, white, material=materials[0]),
        vtray.Cylinder(places[1], (1, 0.3, 0.9), 0.6, white, material=materials[1]),
        vtray.Cone(places[2], (0, 0, 2), 0.5, 0, white, material=materials[2]),
        vtray.Sphere(places[3], 0.4, white, material=materials[3]),
    ]


def scene_of(objects: list[Any], *lights: Any) -> vtray.Scene:
    """Return a scene of some objects."""
    scene = vtray.Scene(objects=objects, lights=[vtray.Light((1, -9, 4), 1), *lights])
    scene.camera = vtray.Camera.look_at(
        (1, -5, 2.5), target=(0, 0, 0.3), up=(0, 0, 1), fov_degrees=40, size=SIZE
    )
    return scene


@once
@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_a_pattern_of_own_colors_changes_nothing(integrator: str) -> None:
    """Not a bit, where all pixels have as many samples."""
    settings: dict[str, Any] = {"integrator": integrator, "samples": 1, "warn": [].append}
    plain = vtray.render(scene_of(all_shapes(None)), **settings)
    own = vtray.render(scene_of(all_shapes(vtray.Checker((None, None)))), **settings)
    clear = vtray.ImagePattern(np.zeros((2, 2, 4), np.uint8))
    empty = vtray.render(scene_of(all_shapes(clear)), **settings)
    other = vtray.render(scene_of(all_shapes(vtray.Checker())), **settings)
    assert (empty.linear == plain.linear).all()
    assert (own.linear == plain.linear).all()
    assert (other.linear != plain.linear).any()


@once
@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_pixels_are_told_as_they_are(integrator: str) -> None:
    scene = scene_of(all_shapes(vtray.Stripes(size=0.2), roughness=0.3), vtray.Sky(0.3))
    image = vtray.render(scene, integrator=integrator, warn=[].append)
    for y in range(1, SIZE[1], 5):
        for x in range(1, SIZE[0], 5):
            assert vtray.trace_pixel(image, x, y).light == tuple(image.linear[y, x]), (x, y)


def lit_pattern(material: Any, integrator: str = "direct") -> RayTree:
    """Return the rays of a pixel that sees a plane with a pattern, with a light right above."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color=(200, 100, 50), material=material)
    scene.add_light((0.5, 0.5, 9))
    scene.camera = vtray.Camera.look_at((0.5, 0.5, 5), (0.5, 0.5, 0), size=(2, 2), fov_degrees=3)
    return vtray.trace_pixel(vtray.render(scene, integrator=integrator, exposure=1), 1, 1)


GREEN = (10, 240, 30)
PICTURE = vtray.ImagePattern(np.full((2, 2, 3), GREEN, np.uint8))


@pytest.mark.parametrize(
    ("material", "integrator", "line", "seen"),
    [
        (vtray.Lambert(pattern=vtray.Checker((GREEN, GREEN))), "direct", "checker, lambert 1", 1),
        (vtray.Lambert(pattern=vtray.Stripes((GREEN, GREEN))), "path", "stripes, lambert 1", 1),
        (vtray.Lambert(pattern=PICTURE), "direct", "image, lambert 1", 1),
        (vtray.Plastic(pattern=PICTURE), "whitted", "image, plastic, ior 1.5", 0.96),
        (vtray.Metal(pattern=PICTURE), "whitted", "image, metal", 0),
        (vtray.Emissive(pattern=PICTURE), "path", "image, emissive, radiance 1", 0),
    ],
)
def test_the_color_that_is_told_is_that_of_the_pattern(
    material: Any, integrator: str, line: str, seen: float
) -> None:
    tree = lit_pattern(material, integrator)
    hit = tree.hit or tree.path[0].hit
    assert hit is not None
    assert hit.surface.color == pytest.approx(GREEN)
    assert hit.pattern is material.pattern
    assert f"  material   color (10, 240, 30) of its {line}\n" in str(tree)
    if seen:
        (way,) = tree.lights or tree.path[0].lights
        assert way.adds == pytest.approx([seen * channel for channel in GREEN])
        more = " x 0.96 that is seen" if seen < 1 else ""
        assert f" = cosine 1 x lambert 1 x intensity 1 x color{more}\n" in str(tree)


def test_where_the_object_has_its_own_color_no_pattern_is_told() -> None:
    hit = lit_pattern(vtray.Lambert(pattern=vtray.Checker((None, None)))).hit
    assert hit is not None
    assert (hit.surface.color, hit.pattern) == ((200, 100, 50), None)


def test_colors_of_patterns_are_told_as_given_and_as_light() -> None:
    scene = lit_pattern(vtray.Lambert(pattern=PICTURE)).scene
    tree = vtray.trace_pixel(vtray.render(scene, tonemap="srgb", exposure=1), 1, 1)
    assert "color (10, 240, 30) of its image, as light (0.773994, " in str(tree)


def test_edges_of_colors_get_samples() -> None:
    image = vtray.render(scene_of(all_shapes(vtray.Checker(size=0.3))), samples=6, warn=[].append)
    assert (image.samples[image.ids[..., 0] >= 0] == 6).all()


@once
def test_any_threads_tell_the_same() -> None:
    scene = scene_of(all_shapes(vtray.Checker(size=0.3)))
    one, two = (vtray.render(scene, samples=3, threads=n, warn=[].append) for n in (1, 2))
    assert (one.linear == two.linear).all()


@once
def test_pictures_can_be_relit_and_recolored() -> None:
    scene = scene_of(all_shapes(vtray.Checker(size=0.3)))
    image = vtray.render(scene, samples=2, keep_lights=True, warn=[].append)
    scene.lights[0] = scene.lights[0].replace(intensity=0.4)
    assert (
        image.relight([0.4]).linear == vtray.render(scene, samples=2, warn=[].append).linear
    ).all()
    scene.objects[1] = scene.objects[1].replace(color=(9, 200, 100))
    recolored = image.relight([0.4]).recolor(1, color=(9, 200, 100))
    assert (recolored.linear == vtray.render(scene, samples=2, warn=[].append).linear).all()


def test_each_sphere_keeps_its_own_color() -> None:
    colors = np.array([(255, 0, 0), (0, 255, 0)], np.uint8)
    spheres = vtray.Spheres(
        np.array([(-0.8, 0, 0), (0.8, 0, 0)]),
        0.7,
        colors,
        material=vtray.Lambert(pattern=vtray.Stripes((None, (0, 0, 255)), size=0.2)),
    )
    albedo = picture_of(spheres).albedo
    found = {tuple(color) for color in albedo.reshape(-1, 3).tolist()}
    assert found == {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)}


def test_copies_are_like_what_is_copied() -> None:
    tiles = vtray.Lambert(pattern=vtray.Checker(size=0.2))
    ball = vtray.Sphere((0, 0, 0), 0.6, RED, material=tiles)
    moved = ball.replace(center=(0.4, 0.1, 0.3))
    copied = picture_of(vtray.Copies([ball], np.array([(0.4, 0.1, 0.3)])))
    assert (copied.albedo == picture_of(moved).albedo).all()


def test_what_clip_planes_close_is_plain() -> None:
    pattern = vtray.Checker((RED, BLUE), size=0.5)
    ball = vtray.Sphere((0, 0, 0), 1, (9, 9, 9), material=vtray.Lambert(pattern=pattern))
    scene = scene_of([ball])
    scene.style = vtray.Style(clip=(vtray.ClipPlane((1, -0.5, 0)),), cap=True)
    albedo = vtray.render(scene, warn=[].append).albedo * 255
    assert {tuple(color) for color in np.rint(albedo).astype(int).reshape(-1, 3).tolist()} == {
        (0, 0, 0),
        (9, 9, 9),
        RED,
        BLUE,
    }


def test_files_keep_patterns(tmp_path: Path) -> None:
    scene = scene_of(all_shapes(vtray.Checker((None, RED), size=0.3, rotation=10)))
    scene.save(tmp_path / "scene.json")
    again = vtray.load(tmp_path / "scene.json")
    assert again.objects == scene.objects
    assert scene_hash(again) == scene_hash(scene)
    other = vtray.Lambert(pattern=vtray.Checker((None, RED), size=0.3, rotation=11))
    scene.objects[1] = scene.objects[1].replace(material=other)
    assert scene_hash(again) != scene_hash(scene)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: vtray.Checker(size=0), "Checker.size: expected a number > 0, got 0"),
        (lambda: vtray.Checker(((1, 2, 3),)), "Checker.colors: expected two colours"),
        (lambda: vtray.Stripes(run="up"), "Stripes.run: expected"),
        (lambda: vtray.Stripes(up=(0, 0, 0)), "Stripes.up: expected"),
        (lambda: vtray.Lambert(pattern="checker"), "Lambert.pattern: expected Checker, Stripes"),
        (
            lambda: vtray.Blend(vtray.Metal(pattern=vtray.Checker()), "mirror"),
            "Blend.first: expected a material without a pattern",
        ),
    ],
)
def test_wrong_values_are_named(make: Any, message: str) -> None:
    with pytest.raises(vtray.SceneError, match=message.replace(".", r"\.")):
        make()


@once
@pytest.mark.parametrize("size", [5e-324, 1e-300, 1e300])
@pytest.mark.parametrize("shape", SHAPES)
def test_sizes_may_be_extreme(shape: str, size: float) -> None:
    for pattern in (vtray.Checker(size=size), vtray.ImagePattern(RANDOM, size=size)):
        item = SHAPES[shape][0](material=vtray.Lambert(pattern=pattern))
        assert np.isfinite(picture_of(item).linear).all()
