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
from vtray.commands.explain import explain_pixel
from vtray.figures.ray_tree import RayTree

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
    with pytest.raises(TypeError):
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


def test_lights_that_do_not_exist() -> None:
    tree: RayTree = vtray.trace_pixel(lit_floor(), *floor_pixel())
    for number in (-1, 3):
        with pytest.raises(vtray.RenderError, match="light: expected one of the 3 shadow rays"):
            tree.draw(light=number)


def test_lights_that_are_no_points_are_left_out_and_counted() -> None:
    plain, world = lit_floor(), lit_floor()
    lights = plain.lights
    soft = [vtray.Sky(0.5), vtray.Sun((0, 1, 0)), vtray.SphereLight((0, -9, 5), 1), vtray.Ambient()]
    world.lights = [soft[0], lights[0], soft[1], soft[2], lights[1], lights[2], soft[3]]
    tree, alone = (vtray.trace_pixel(one, *floor_pixel()) for one in (world, plain))
    assert [ray.light for ray in tree.lights] == [1, 4, 5]
    assert [dataclasses.replace(ray, light=k) for k, ray in enumerate(tree.lights)] == [
        *alone.lights
    ]
    assert (tree.light, tree.hit, alone.left_out) == (alone.light, alone.hit, 0)
    *_, light_line, last = str(tree).splitlines()
    assert light_line.endswith(", the sum over the points")
    assert last == "not shown    4 lights: only points are shown ray by ray"
    ax = tree.draw(light=4)
    assert any("lights[4]" in text.get_text() for text in ax.texts)
    assert any("Of 7 lights, only points are shown." in text.get_text() for text in ax.texts)
    with pytest.raises(vtray.RenderError, match="expected one of the 3 shadow rays, got 2, which"):
        tree.draw(light=2)
    world.lights = [*lights, soft[0]]
    assert "not shown    1 light: only" in str(vtray.trace_pixel(world, *floor_pixel()))
    world.lights = soft
    tree = vtray.trace_pixel(world, *floor_pixel())
    assert (tree.lights, tree.light, tree.hit) == ((), (0, 0, 0), alone.hit)
    tree.draw().figure.draw_without_rendering()
    assert "not shown" not in str(vtray.trace_pixel(world, 0, 0))


def test_light_in_the_picture_is_that_of_all_lights() -> None:
    world = lit_floor()
    tree = vtray.trace_pixel(vtray.render(world), *floor_pixel())
    assert tree.exposed is not None
    scene = vtray.Scene(world.camera, [*world.lights, vtray.Sky()], world.objects)
    exposed = dataclasses.replace(tree.exposed, light=(1.0, 2.0, 3.0))
    lines = str(dataclasses.replace(tree, scene=scene, exposed=exposed)).splitlines()
    assert "all lights   (1, 2, 3), the light of the pixel in the picture" in lines


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
