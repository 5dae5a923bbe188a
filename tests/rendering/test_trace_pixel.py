"""The rays of a pixel: as data, in words, and drawn."""

import dataclasses
import json
import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, one_sphere, plane, scene, sphere
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import may_be_dark, scenes
from test_documents import ROOT, blocks

import vtray
from conftest import JIT, compiled_only, once
from vtray.commands.explain import explain_pixel
from vtray.figures.ray_tree import RayTree, ShadowFan

figure = pytest.importorskip("matplotlib.figure", reason="needs the extra vtray[figure]")


def load(document: dict[str, Any]) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def lit_floor() -> vtray.Scene:
    """Return a floor below two spheres, with a light that one of them blocks and one that not."""
    document = scene(
        [
            plane((0, 1, 0), (0, -2, 0), lambert=0.5),
            sphere((0, -3, 5), 1, color={"r": 9, "g": 0, "b": 0}),
            sphere((30, 0, 5), 1),
        ],
        [light(0, -9, 5), light(3, -2, 5, intensity=0.5), light(0, 5, 5)],
        center={"x": 0, "y": 0, "z": 0},
        focus=5,
        resolution=[0.05, 0.05],
    )
    return load(document)


def floor_pixel() -> tuple[int, int]:
    """Return the pixel that sees (0, 1, 5): from 10 away, 2 pixels of 0.05 for each 0.2 down."""
    return 32, 24 + 10


def test_values_worked_out_by_hand() -> None:
    tree = vtray.trace_pixel(lit_floor(), *floor_pixel())
    assert tree.origin == (0, 0, -5)
    np.testing.assert_allclose(tree.direction, np.array([0, 0.5, 5]) / math.hypot(0.5, 5))
    hit = tree.hit
    assert hit is not None
    assert (hit.surface.object, hit.surface.index, hit.surface.radius) == (0, None, None)
    assert (hit.surface.color, hit.surface.lambert) == ((255, 255, 255), 0.5)
    assert hit.surface.normal == (0, -1, 0)
    np.testing.assert_allclose(hit.point, (0, 1, 5), atol=1e-14)
    np.testing.assert_allclose(hit.distance, math.hypot(10, 1))
    np.testing.assert_allclose(hit.normal, (0, -1, 0))
    above, beside, below = tree.lights
    assert [ray.arrives for ray in tree.lights] == [False, True, False]
    assert above.blocker is not None
    assert (above.blocker.object, above.blocker.center, above.blocker.radius) == (1, (0, -3, 5), 1)
    np.testing.assert_allclose((above.distance, above.cosine), (10, 1))
    assert above.adds == (0, 0, 0)
    assert beside.blocker is None
    np.testing.assert_allclose(beside.direction, (math.sqrt(0.5), -math.sqrt(0.5), 0), atol=1e-15)
    np.testing.assert_allclose(beside.adds, [math.sqrt(0.5) * 0.5 * 0.5 * 255] * 3)
    assert (below.cosine, below.adds) == (0, (0, 0, 0))
    assert tree.light == beside.adds
    assert tree.exposed is None


def test_a_missed_pixel_has_no_hit() -> None:
    tree = vtray.trace_pixel(load(one_sphere()), 0, 0)
    assert (tree.hit, tree.lights, tree.light) == (None, (), (0, 0, 0))
    assert "hit          nothing in front of the image plane" in str(tree)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_a_sphere_of_an_array_has_an_index(dtype: type) -> None:
    center = np.array([(9, 9, 9), (0, 0, 6), (0, 0, 5)], dtype)
    spheres = vtray.Spheres(center, np.array([1, 2, 0.5], dtype), [(1, 2, 3)] * 3, 1)
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 4, (3, 3), (0.1, 0.1))
    ball = vtray.Sphere((5, 5, 5), 1, (255, 0, 0), 1)
    hit = vtray.trace_pixel(vtray.Scene(camera, [], [ball, spheres]), np.int64(1), 1).hit
    assert hit is not None
    assert (hit.surface.object, hit.surface.index) == (1, 1)
    assert (hit.surface.center, hit.surface.radius) == ((0, 0, 6), 2)
    assert hit.surface.color == (1, 2, 3)
    assert str(hit.surface) == "objects[1], sphere 1"


@once
@may_be_dark
@settings(max_examples=60)
@given(scenes(), st.data())
def test_random_scenes_agree_with_the_picture_and_the_oracle(
    document: dict[str, Any], data: st.DataObject
) -> None:
    world = load(document)
    image = vtray.render(world, threads=1)
    width, height = world.camera.size
    x, y = data.draw(st.integers(0, width - 1)), data.draw(st.integers(0, height - 1))
    tree = vtray.trace_pixel(image, x, y)
    # What the lights add comes to the pixel's light, to the last bit.
    total = (0.0, 0.0, 0.0)
    for ray in tree.lights:
        total = (total[0] + ray.adds[0], total[1] + ray.adds[1], total[2] + ray.adds[2])
    assert total == tree.light == tuple(image.linear[y, x])
    assert tree.exposed is not None
    assert tree.exposed.value == tuple(image.pixels[y, x])
    seen = oracle.look(document, x, y)
    if seen.ids < 0:
        assert tree.hit is None
        return
    assert tree.hit is not None
    assert tree.hit.surface.object == seen.ids
    assert tree.hit.distance == pytest.approx(seen.depth, rel=1e-12)
    assert tree.direction == tuple(oracle.directions(document, x, y))
    for ray, blocked in zip(tree.lights, seen.shadows, strict=True):
        if ray.cosine > 0:
            assert (ray.blocker is not None) == blocked


@compiled_only
@pytest.mark.parametrize("block", blocks("output").items(), ids=["first"])
def test_text_is_that_of_the_command(block: tuple[str, str]) -> None:
    command, text = block
    column, row = map(int, command.split()[2].split(","))
    world = vtray.load(ROOT / command.split()[3])
    image = vtray.render(world)
    assert f"{vtray.trace_pixel(image, column, row)}\n" == text
    assert explain_pixel(world, image, column, row) == text
    alone = str(vtray.trace_pixel(world, column, row))
    assert text.startswith(alone)
    assert alone.splitlines()[-1].endswith("the sum over all lights")
    markdown = vtray.trace_pixel(image, column, row)._repr_markdown_()
    assert markdown == f"```text\n{text}```"
    assert text in (ROOT / "docs" / "command.md").read_text()


@pytest.mark.parametrize("place", [(-1, 0), (0, -1), (64, 0), (0, 48)])
def test_pixels_that_do_not_exist(place: tuple[int, int]) -> None:
    with pytest.raises(vtray.RenderError, match=r"trace_pixel: expected 0,0 to 63,47, got "):
        vtray.trace_pixel(load(one_sphere()), *place)
    words = r"trace_pixel: a pixel has a whole column and row, got 1\.5; round it, as by int\(\)"
    with pytest.raises(vtray.RenderError, match=words):
        vtray.trace_pixel(load(one_sphere()), 1.5, 0)


def test_scene_changed_in_code_is_checked() -> None:
    world = load(one_sphere())
    world.objects.append("cube")
    with pytest.raises(vtray.SceneError, match="Scene.objects"):
        vtray.trace_pixel(world, 0, 0)


def test_data_does_not_change() -> None:
    world = lit_floor()
    tree = vtray.trace_pixel(world, *floor_pixel())
    with pytest.raises(dataclasses.FrozenInstanceError):
        tree.light = (1, 1, 1)
    assert tree == vtray.trace_pixel(world, *floor_pixel())
    world.objects.clear()
    assert tree.scene is not None
    assert len(tree.scene.objects) == 3


def texts(ax: Any) -> list[str]:
    """Return all that is written in a drawing."""
    return [text.get_text() for text in ax.texts if text.get_text()]


def marks(ax: Any, marker: str) -> list[tuple[float, float]]:
    """Return where a drawing has a marker."""
    lines = [line for line in ax.lines if line.get_marker() == marker]
    return [(float(line.get_xdata()[0]), float(line.get_ydata()[0])) for line in lines]


def test_drawing_of_lit_and_blocked_rays() -> None:
    tree = vtray.trace_pixel(lit_floor(), *floor_pixel())
    ax = tree.draw(light=0)
    ax.figure.draw_without_rendering()
    written = texts(ax)
    assert {"eye", "image plane", "normal", "objects[0], a plane"} <= set(written)
    assert "lights[0]\nblocked by objects[1], a sphere" in written
    assert any(text.startswith("lights[1]\nadds (45.1, 45.1, 45.1)") for text in written)
    assert "lights[2]\nbehind the surface" in written
    # The blocker is met at its lower side, (0, -2, 5), which is 10 in front of the eye.
    assert marks(ax, "X") == [pytest.approx((10, 2))]
    dashed = [line for line in ax.lines if line.get_linestyle() == "--" or line.is_dashed()]
    assert len(dashed) == 3
    circles = [patch for patch in ax.patches if type(patch).__name__ == "Circle"]
    assert [(*circle.center, circle.radius) for circle in circles] == [pytest.approx((10, 3, 1))]


@pytest.mark.parametrize("number", [0, 1, 2])
def test_plane_of_the_drawing_holds_the_rays(number: int) -> None:
    """What lies in the plane keeps its lengths: camera ray, shadow ray, and image plane."""
    tree = vtray.trace_pixel(lit_floor(), 40, 36)
    ax = tree.draw(light=number)
    hit = tree.hit
    assert hit is not None
    lines = [np.array(line.get_xydata()) for line in ax.lines]
    lengths = [np.hypot(*(line[1] - line[0])) for line in lines if len(line) == 2]
    assert any(length == pytest.approx(hit.distance) for length in lengths)
    (pixel,) = marks(ax, "s")
    slope = np.dot(tree.direction, tree.view.forward)
    assert np.hypot(*pixel) == pytest.approx(tree.view.focus / slope)
    assert any(len(line) == 2 and line[0, 0] == line[1, 0] == pixel[0] for line in lines)
    if tree.lights[number].arrives:
        assert any(length == pytest.approx(tree.lights[number].distance) for length in lengths)


def test_drawing_of_a_missed_pixel() -> None:
    tree = vtray.trace_pixel(vtray.render(load(one_sphere())), 0, 0)
    ax = tree.draw()
    assert "hits nothing" in texts(ax)
    assert "pixel (0, 0)  ·  value (0, 0, 0)" in texts(ax)


def test_drawing_on_given_axes_and_apart_from_pyplot(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)  # of another test
    ax = figure.Figure(figsize=(4, 4)).add_subplot()
    assert vtray.trace_pixel(lit_floor(), *floor_pixel()).draw(ax) is ax
    assert "matplotlib.pyplot" not in sys.modules
    low, high = ax.get_xlim()
    bottom, top = ax.get_ylim()
    assert high - low == pytest.approx((top - bottom) * ax.bbox.width / ax.bbox.height)


@pytest.mark.parametrize(
    "change",
    [
        lambda world: world.lights.extend([vtray.Light((k, -9, 0), 1) for k in range(30)]),
        lambda world: world.lights.clear(),
        lambda world: world.lights.insert(0, vtray.Light((0, 0, -5), 1)),  # at the eye
        lambda world: world.lights.insert(0, vtray.Light((0, -1e9, 0), 1)),
        lambda world: world.objects.append(vtray.Spheres(np.zeros((0, 3)), 1, (1, 1, 1), 1)),
        lambda world: world.objects.append(vtray.Sphere((0, 0, 5), 1e6, (9, 9, 9), 1)),
        lambda world: world.objects.append(vtray.Plane((0, 0, 3), (1, 0, 0), (9, 9, 9), 1)),
    ],
)
def test_unusual_scenes_can_be_drawn(change: Callable[[vtray.Scene], None]) -> None:
    world = lit_floor()
    change(world)
    for pixel in (floor_pixel(), (0, 0), (63, 47), (32, 24)):
        ax = vtray.trace_pixel(world, *pixel).draw()
        ax.figure.draw_without_rendering()
        assert all(np.isfinite([*ax.get_xlim(), *ax.get_ylim()]))


def test_what_is_no_scene() -> None:
    with pytest.raises(vtray.SceneError, match="^scene: expected a vtray.Scene, got None$"):
        vtray.trace_pixel(None, 1, 2)  # type: ignore[arg-type]


def test_a_scene_whose_camera_was_never_set_is_seen_as_in_pictures() -> None:
    scene = vtray.Scene()
    scene.add_sphere((1, 2, 3), 2)
    tree, told = vtray.trace_pixel(scene, 400, 300), vtray.Camera.fit(scene, view="auto")
    assert scene.camera is None
    assert tree.scene.camera == told
    assert tree.hit is not None


def test_lights_that_do_not_exist() -> None:
    tree: RayTree = vtray.trace_pixel(lit_floor(), *floor_pixel())
    for number in (-1, 3, np.arange(2)):
        with pytest.raises(vtray.RenderError, match="light: expected one of the 3 lights of the"):
            tree.draw(light=number)


POINT = vtray.Light((3, -2, 5), 0.5, color=(255, 208, 160))
SOFT: dict[str, Any] = {
    "sun": vtray.Sun((0.3, 1, 0.2), 0.7, angle=40, color=(255, 224, 192)),
    "sphere": vtray.SphereLight((2, -4, 4), 1.5, 0.4),
    "sky": vtray.Sky(0.2, color=(160, 192, 255)),
    "ambient": vtray.Ambient(0.4),
    "near": vtray.Ambient(0.3, distance=3.5),
}


def softly_lit(*lights: Any) -> vtray.Scene:
    """Return the floor below spheres, a bond and copies, in light of any kind, by one fan each."""
    world = lit_floor()
    world.add_cylinders([(-1.5, 0, 4)], [(1.5, -1, 6)], 0.2, color="tomato", color_end="#4a90d9")
    world.add_copies([vtray.Sphere((0, 0, 0), 0.3)], at=[(-1, 0.5, 5), (1, 0.4, 4.5)])
    world.lights = list(lights)
    world.render = vtray.RenderSettings(tolerance=100)
    return world


@once
@pytest.mark.parametrize(
    "lights",
    [
        (SOFT["ambient"],),
        (SOFT["sun"], POINT, SOFT["sky"]),
        (POINT, *SOFT.values(), vtray.Light((0, 5, 5))),
        (*SOFT.values(), SOFT["sky"]),
    ],
    ids=["one", "around a point", "after a point", "no point"],
)
def test_light_of_all_lights_is_that_of_the_picture(lights: tuple[Any, ...]) -> None:
    world = softly_lit(*lights)
    world.camera = world.camera.replace(size=(8, 6), resolution=(0.4, 0.4))
    world.render = vtray.RenderSettings(seed=7)
    image = vtray.render(world)
    for x, y in [(4, 4), (0, 0), (2, 3), (4, 3), (6, 5), (3, 2), (3, 4)][: 7 if JIT else 2]:
        tree = vtray.trace_pixel(image, x, y)
        assert tree.light == tuple(image.linear[y, x])
        alone = vtray.trace_pixel(world, x, y)
        assert (alone.lights, alone.light) == (tree.lights, tree.light)
        # In the order of the sum: points come first.
        total = (0.0, 0.0, 0.0)
        for way in sorted(tree.lights, key=lambda way: isinstance(way, ShadowFan)):
            total = (total[0] + way.adds[0], total[1] + way.adds[1], total[2] + way.adds[2])
        assert total == tree.light
        if tree.hit is not None:
            assert [way.light for way in tree.lights] == list(range(len(lights)))
            lines = str(tree).splitlines()
            assert sum(line.startswith("lights[") for line in lines) == len(lights)


def fan_of(world: vtray.Scene, number: int = 0) -> ShadowFan:
    """Return the rays to a light from the floor below a sphere."""
    way = vtray.trace_pixel(world, *floor_pixel()).lights[number]
    assert isinstance(way, ShadowFan)
    return way


@once
@pytest.mark.parametrize("kind", SOFT)
def test_rays_to_lights_that_are_no_points(kind: str) -> None:
    light = SOFT[kind]
    fan = fan_of(softly_lit(POINT, light), 1)
    assert (fan.kind, fan.light) == ("ambient" if kind == "near" else kind, 1)
    color = light.color
    assert (fan.intensity, fan.color) == (light.intensity, (color.r, color.g, color.b))
    assert len(fan.rays) == 64
    directions = np.array([ray.direction for ray in fan.rays])
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    cosines = directions @ (0, -1, 0)
    weights = np.array([ray.weight for ray in fan.rays])
    arrives = np.array([ray.arrives for ray in fan.rays])
    assert fan.arriving == arrives.sum() > 0
    assert fan.share == pytest.approx((weights * arrives).sum() / 64)
    ends = (0, 1, 5) + directions * [[ray.length] for ray in fan.rays]
    if kind == "sphere":
        np.testing.assert_allclose(np.linalg.norm(ends - (2, -4, 4), axis=1), 1.5)
        to_middle = np.array([2, -5, -1]) / math.hypot(2, 5, 1)
    elif kind == "sun":
        assert np.isinf(ends).any(axis=1).all()
        to_middle = -np.array([0.3, 1, 0.2]) / math.hypot(0.3, 1, 0.2)
        assert (directions @ to_middle >= math.cos(math.radians(20)) - 1e-12).all()
    else:
        assert {ray.length for ray in fan.rays} == {3.5 if kind == "near" else math.inf}
        to_middle = np.array([0, -1, 0])
        assert (weights == 1).all()
        assert (cosines >= 0).all()
    np.testing.assert_allclose(fan.direction, to_middle, atol=1e-15)
    if kind in ("sun", "sphere"):
        np.testing.assert_allclose(weights / cosines, weights[0] / cosines[0])
    # What is named as blocking a ray is on its way.
    for ray in fan.rays:
        if ray.blocker is not None and ray.blocker.radius is not None and ray.blocker.end is None:
            way = np.array(ray.blocker.center) - (0, 1, 5)
            along = np.dot(way, ray.direction)
            assert 0 < along < ray.length + ray.blocker.radius
            assert np.linalg.norm(way - along * np.array(ray.direction)) <= ray.blocker.radius
    if kind == "near":
        assert 1 in {surface.object for surface in fan.blockers}
    assert len(set(fan.blockers)) == len(fan.blockers)


def test_words_on_lights_that_are_no_points() -> None:
    world = lit_floor()
    world.objects[2:] = []
    world.lights = [
        vtray.Sun((0, 1, 0), angle=5),
        vtray.Light((3, -2, 5), 0.5),
        vtray.Sky(0.5, color=(255, 51, 0)),
        vtray.Sun((0, -1, 0)),
        vtray.Ambient(distance=2.5),
    ]
    # A small picture in which (1, 3) is the pixel of the floor.
    world.camera = world.camera.replace(size=(2, 4), resolution=(0.5, 0.5))
    image = vtray.render(world, seed=1)
    tree = vtray.trace_pixel(image, 1, 3)
    sky = tree.lights[2]
    assert isinstance(sky, ShadowFan)
    assert sky.adds == (0.25 * sky.share * 255, 0.25 * sky.share * 255 * 0.2, 0)
    share, adds = f"{sky.share:.6g}", ", ".join(f"{part:.6g}" for part in sky.adds)
    text, tint = str(tree), " x (1, 0.2, 0) of the light"
    assert (
        f"""
lights[0]    sun: 0 of 64 rays arrive, 0 of its light
  adds       nothing: objects[1], a sphere, is in the way
lights[1]    towards (0.707107, -0.707107, 0), 4.242640687 away
  adds       (45.0781, 45.0781, 45.0781) = cosine 0.707107 x lambert 0.5 x intensity 0.5 x color
lights[2]    sky: {sky.arriving} of 64 rays arrive, {share} of its light
  adds       ({adds}) = share {share} x lambert 0.5 x radiance 0.5 x color{tint}
lights[3]    sun: 0 of 64 rays arrive, 0 of its light
  adds       nothing: it is behind the surface
lights[4]    ambient: 64 of 64 rays arrive, 1 of its light
  adds       (127.5, 127.5, 127.5) = share 1 x lambert 0.5 x intensity 1 x color
light        """
        in text
    )
    assert "the sum over all lights\nexposure " in text
    assert explain_pixel(world, image, 1, 3) == f"{text}\n"


def test_several_surfaces_in_the_way() -> None:
    world = lit_floor()
    world.objects[1:] = [vtray.Sphere((x, -3, 5), 1.1) for x in (-1, 1)]
    world.lights = [vtray.Sun((0, 1, 0), angle=5)]
    fan = fan_of(world)
    assert (fan.share, fan.arriving, fan.adds) == (0, 0, (0, 0, 0))
    assert sorted(surface.object for surface in fan.blockers) == [1, 2]
    text = str(vtray.trace_pixel(world, *floor_pixel()))
    assert "  adds       nothing: 2 surfaces are in the way" in text


def lines_from_hit(ax: Any) -> list[np.ndarray]:
    """Return the ends of the thin lines of each bundle, (n, 2)."""
    collections = [item for item in ax.collections if type(item).__name__ == "LineCollection"]
    return [np.array([path.vertices[-1] for path in item.get_paths()]) for item in collections]


@once
@pytest.mark.parametrize("kind", SOFT)
def test_drawing_of_a_light_that_is_no_point(kind: str) -> None:
    tree = vtray.trace_pixel(softly_lit(POINT, SOFT[kind]), *floor_pixel())
    _, fan = tree.lights
    assert isinstance(fan, ShadowFan)
    ax = tree.draw(light=1)
    ax.figure.draw_without_rendering()
    arriving, stopped = lines_from_hit(ax)
    assert len(arriving) == fan.arriving
    assert len(stopped) == sum(ray.blocker is not None for ray in fan.rays)
    low, high = np.array([ax.get_xlim(), ax.get_ylim()]).T
    ends = np.concatenate([ends.reshape(-1, 2) for ends in (arriving, stopped)])
    assert ((low <= ends) & (ends <= high)).all()
    assert any(
        text.startswith(f"lights[1], {fan.kind}: {fan.arriving} of 64") for text in texts(ax)
    )
    assert any("lights[0]" in text for text in texts(ax))
    is_around = fan.kind in ("sky", "ambient")
    plane = "the normal" if is_around else "the middle of lights[1]"
    assert any(f"along the camera ray and {plane};" in text for text in texts(ax))
    if kind == "sphere":
        circles = [patch for patch in ax.patches if type(patch).__name__ == "Circle"]
        (place,) = {tuple(circle.center) for circle in circles if circle.radius == 1.5}
        # The plane of the drawing holds the eye and the middle of the ball.
        (eye, *_) = marks(ax, "o")
        assert math.dist(place, eye) == pytest.approx(math.hypot(2, 4, 9))


def test_drawing_of_lights_of_which_nothing_arrives() -> None:
    world = lit_floor()
    world.lights = [vtray.Sun((0, 1, 0), angle=5), vtray.Sun((0, -1, 0))]
    ax = vtray.trace_pixel(world, *floor_pixel()).draw()
    assert "lights[0], sun: blocked by objects[1], a sphere" in texts(ax)
    assert "lights[1], sun: behind the surface" in texts(ax)
    assert [len(ends) for ends in lines_from_hit(ax)] == [0, 64, 0, 0]
    world.objects[1:] = [vtray.Sphere((x, -3, 5), 1.1) for x in (-1, 1)]
    ax = vtray.trace_pixel(world, *floor_pixel()).draw()
    assert "lights[0], sun: blocked by 2 surfaces" in texts(ax)


@once
def test_the_light_that_adds_most_chooses_the_drawing() -> None:
    weak, strong = vtray.Light((3, -2, 5), 0.1), vtray.Ambient(2.0)
    tree = vtray.trace_pixel(softly_lit(weak, strong), *floor_pixel())
    assert any("and the normal;" in text for text in texts(tree.draw()))
    tree = vtray.trace_pixel(softly_lit(strong, vtray.Light((3, -2, 5), 9.0)), *floor_pixel())
    assert any("and the ray to lights[1];" in text for text in texts(tree.draw()))


@once
@pytest.mark.parametrize(
    "light",
    [
        vtray.Ambient(distance=1e-300),
        vtray.Sun((0, -1, 0)),
        vtray.Sun((1, 0, 0), angle=180),
        vtray.Sun((0, 0, 1), angle=0),
        vtray.SphereLight((0, 0, 5), 50),
        vtray.SphereLight((0, 1, 5), 0.5),
        vtray.SphereLight((0, 1, 5), 0.0),
        vtray.SphereLight((0, -1e9, 0), 1e6),
        vtray.SphereLight((9, 3, 5), 1),
    ],
)
def test_unusual_lights_can_be_drawn(light: Any) -> None:
    for others in ((), (vtray.Light((0, -9, 2)),), (vtray.Sky(),) * 5)[: 3 if JIT else 1]:
        world = softly_lit(light, *others)
        for pixel in (floor_pixel(), (0, 0), (32, 20)):
            tree = vtray.trace_pixel(world, *pixel)
            for number in {0, len(others)} if tree.hit else {None}:
                ax = tree.draw(light=number)
                ax.figure.draw_without_rendering()
                assert all(np.isfinite([*ax.get_xlim(), *ax.get_ylim()]))
                assert all(np.isfinite(ends).all() for ends in lines_from_hit(ax))
            assert str(tree)


def test_missing_matplotlib_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(vtray.VtrayError, match=r" -m pip install matplotlib$"):
        vtray.trace_pixel(lit_floor(), 0, 0).draw()


def test_orthographic_rays_start_side_by_side() -> None:
    world = lit_floor()
    camera = world.camera
    world.camera = vtray.Camera(
        camera.center, camera.normal, 5, (64, 48), (0.05, 0.05), projection="orthographic"
    )
    tree = vtray.trace_pixel(world, 42, 30)
    np.testing.assert_allclose(tree.origin, (0.5, 0.3, -5))
    assert tree.direction == (0, 0, 1)
    ax = tree.draw()
    assert "start of the ray" in texts(ax)
    (pixel,) = marks(ax, "s")
    np.testing.assert_allclose(pixel, (5, 0), atol=1e-12)


@once
def test_text_of_pictures_with_settings() -> None:
    world = lit_floor()
    x, y = floor_pixel()
    image = vtray.render(world, exposure=0.5, background="white")
    last = str(vtray.trace_pixel(image, x, y)).splitlines()[-2:]
    assert last[0] == "exposure     floor(255 x light / 510), 510 is what becomes 255"
    assert last[1] == "value        (22, 22, 22)"
    empty = str(vtray.trace_pixel(image, 0, 0)).splitlines()
    assert empty[-1] == "value        (255, 255, 255), 100 % of it background"
    many = vtray.render(load(one_sphere()), samples=16)
    edges = np.argwhere((many.alpha > 0.2) & (many.alpha < 0.8))
    tree = vtray.trace_pixel(many, edges[0][1], edges[0][0])
    assert "\nsamples      (" in str(tree)
    assert str(tree).splitlines()[-1] == f"value        {tuple(map(int, many.pixels[*edges[0]]))}"


@once
def test_picture_of_another_size() -> None:
    image = vtray.render(lit_floor(), size=(128, 96))
    tree = vtray.trace_pixel(image, 100, 80)
    assert tree.view.size == (128, 96)
    assert tree.light == tuple(image.linear[80, 100])
    with pytest.raises(vtray.RenderError, match="expected 0,0 to 127,95, got 128,0"):
        vtray.trace_pixel(image, 128, 0)


def test_image_plane_at_the_eye_gives_way_to_the_edges_of_the_view() -> None:
    world = lit_floor()
    world.camera = vtray.Camera((0, 0, -5), (0, 0, 1), 1e-6, (64, 48), (1e-8, 1e-8))
    for pixel in (floor_pixel(), (32, 0)):
        ax = vtray.trace_pixel(world, *pixel).draw()
        assert "eye\nimage plane 1e-06 in front" in texts(ax)
        assert "image plane" not in texts(ax)
        assert not marks(ax, "s")


def test_words_on_skies_of_many_colors() -> None:
    world = lit_floor()
    spots = np.random.default_rng(1).lognormal(sigma=2, size=(8, 16, 3))
    world.lights = [
        vtray.Sky(gradient=vtray.Gradient(), color=(255, 51, 255)),
        vtray.Sky(0.5, image=spots),
    ]
    world.camera = world.camera.replace(size=(2, 4), resolution=(0.5, 0.5))
    image = vtray.render(world, seed=1)
    tree = vtray.trace_pixel(image, 1, 3)
    text = str(tree)
    for number, fan in enumerate(tree.lights):
        assert isinstance(fan, ShadowFan)
        assert fan.shares is not None
        assert fan.share == pytest.approx(sum(fan.shares) / 3)
        weights = [ray.weight for ray in fan.rays if ray.arrives]
        assert fan.share == pytest.approx(sum(weights) / 64)
        shares, adds = (
            f"({', '.join(f'{part:.6g}' for part in parts)})" for parts in (fan.shares, fan.adds)
        )
        first = f"lights[{number}]    sky: {fan.arriving} of 64 rays arrive, {shares} of its light"
        assert f"{first}\n  adds       {adds} = share {shares} x lambert 0.5 x radiance" in text
    total = np.sum([fan.adds for fan in tree.lights], axis=0)
    np.testing.assert_allclose(image.linear[3, 1], total, rtol=1e-12)


@once
def test_shown_in_a_line() -> None:
    scene = lit_floor()
    hit = vtray.trace_pixel(scene, 40, 36).hit
    assert hit is not None
    words = f"a hit at {hit.distance:.6g}, 3 ways to lights"
    assert repr(vtray.trace_pixel(scene, 40, 36)) == f"<RayTree of pixel (40, 36), {words}>"
    scene.objects.clear()
    empty = repr(vtray.trace_pixel(scene, 40, 36))
    assert empty == "<RayTree of pixel (40, 36), nothing, 0 ways to lights>"
