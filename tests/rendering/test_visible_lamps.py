"""Lamps that the camera sees: where, how bright, with which edges, and what they leave as it is."""

import math
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray import RectangleLight, SphereLight, render

SIZE = (48, 36) if JIT else (12, 9)
Point = tuple[float, float, float]


def looking_down(*lamps: Any, projection: Any = "perspective") -> vtray.Scene:
    """Return a floor with a ball on it, seen from above: 4 wide, and 3 high."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#808080")
    scene.add_sphere((-1, 0, 0.5), 0.5, color="#e07a5f")
    pixel = 4 / SIZE[0]
    scene.camera = vtray.Camera(
        (0, 0, 10), (0, 0, -1), 1e3, SIZE, (pixel, pixel), (0, 1, 0), projection
    )
    scene.lights = [vtray.Ambient(0.5), *lamps]
    return scene


def seen(scene: vtray.Scene, *light: float, **options: Any) -> np.ndarray:
    """Return the pixels that show this light, (height, width)."""
    linear = render(scene, exposure=1.0, **options).linear
    return (linear == 255 * np.array(light)).all(axis=2)


PANEL = RectangleLight((1.01, 0.013, 3), ((1, 0, 0), (0, 1.5, 0)), radiance=2, visible=True)
BALL = SphereLight((0.2, 0.5, 4), 0.6, 3, (255, 0, 51), visible=True)


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_as_large_as_they_are(projection: Any) -> None:
    scene = looking_down(PANEL, projection=projection)
    area = seen(scene, 2, 2, 2).mean() * 4 * 3
    assert area == pytest.approx(1.5, rel=0.1)
    scene = looking_down(BALL, projection=projection)
    area = seen(scene, 3, 0, 0.6).mean() * 4 * 3
    assert area == pytest.approx(math.pi * 0.36, rel=0.1)


@compiled_only
def test_what_else_is_seen_stays_as_it_is() -> None:
    scene = looking_down(PANEL, BALL)
    unseen = looking_down(PANEL.replace(visible=False), BALL.replace(visible=False))
    image, other = render(scene, exposure=1.0), render(unseen, exposure=1.0)
    is_lamp = seen(scene, 2, 2, 2) | seen(scene, 3, 0, 0.6)
    assert 0.1 < is_lamp.mean() < 0.5
    np.testing.assert_array_equal(image.linear[~is_lamp], other.linear[~is_lamp])
    for name in ("ids", "depth", "normals"):
        np.testing.assert_array_equal(getattr(image, name), getattr(other, name))


@compiled_only
def test_the_nearest_is_seen() -> None:
    behind = PANEL.replace(location=(1, 0, 2), edges=((2, 0, 0), (0, 3, 0)), radiance=1)
    both, alone = looking_down(behind, PANEL), looking_down(PANEL)
    np.testing.assert_array_equal(seen(both, 2, 2, 2), seen(alone, 2, 2, 2))
    np.testing.assert_array_equal(seen(looking_down(PANEL, behind), 2, 2, 2), seen(both, 2, 2, 2))
    # The ball on the floor is before one below it, and behind one above.
    assert not seen(looking_down(PANEL.replace(location=(-1, 0, -1))), 2, 2, 2).any()
    hidden = looking_down(PANEL.replace(location=(-1, 0, 0.5), edges=((0.5, 0, 0), (0, 0.5, 0))))
    assert not seen(hidden, 2, 2, 2).any()
    assert seen(looking_down(PANEL.replace(location=(-1, 0, 1.5))), 2, 2, 2).any()


@once
def test_nothing_behind_the_image_plane_is_seen() -> None:
    assert not seen(looking_down(PANEL.replace(location=(1, 0, 10.5))), 2, 2, 2).any()
    assert not seen(looking_down(PANEL.replace(location=(1, 0, 10))), 2, 2, 2).any()
    assert seen(looking_down(PANEL.replace(location=(1, 0, 9.99))), 2, 2, 2).any()


@pytest.mark.parametrize("shift", [0.0, 1e5])
def test_a_panel_in_a_wall_is_before_it(shift: float) -> None:
    normal = np.array([0.2, -0.3, 1.0])
    one = np.cross(normal, (1, 2, 0))
    other = np.cross(normal, one)
    place = (0.7 + shift, 0.1 - shift, 3.0)
    scene = vtray.Scene()
    scene.add_plane((place - 3 * one + 0.1 * other).tolist(), normal=normal.tolist())
    scene.camera = vtray.Camera.look_at(
        (shift, -2 - shift, 9), place, up=(0, 1, 0), size=SIZE, fov_degrees=10
    )
    scene.lights = [RectangleLight(place, (one, other), visible=True)]
    assert seen(scene, 1, 1, 1).all()


@once
def test_edge_on_a_panel_is_not_seen() -> None:
    upright = RectangleLight((0, 0, 3), ((1, 0, 0), (0, 0, 1)), visible=True)
    assert seen(looking_down(upright, projection="orthographic"), 1, 1, 1).sum() == 0
    tiny = RectangleLight((0, 0, 3), ((1e-300, 0, 0), (0, 5e-324, 0)), 0.5, visible=True)
    assert seen(looking_down(tiny), 0.5, 0.5, 0.5).sum() <= 1


@compiled_only
@pytest.mark.parametrize("lamp", [PANEL, BALL, PANEL.replace(edges=((0.3, 0.4, 5), (-4, 3, 0)))])
def test_edges_are_smooth_and_all_marked(lamp: Any) -> None:
    scene = looking_down(lamp.replace(color=(255, 255, 255)))
    options: dict[str, Any] = {"samples": 64, "exposure": 1.0, "filter": "box"}
    image = render(scene, **options)
    # As a picture of eleven times as many pixels each way says.
    large = render(scene, exposure=1.0, size=(11 * SIZE[0], 11 * SIZE[1])).linear[..., 0]
    rows, columns = np.arange(-5, 6), np.arange(-5, 6)
    height, width = image.linear.shape[:2]
    expected = np.zeros((height, width))
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            part = large[np.ix_(11 * row + rows, 11 * column + columns)]
            expected[row, column] = part.mean()
    inside = np.s_[1:-1, 1:-1]
    off = np.abs(image.linear[..., 0] - expected)[inside]
    assert off.max() < 0.12 * 255


@compiled_only
def test_they_cover_a_transparent_background() -> None:
    scene = looking_down(PANEL, BALL)
    scene.objects = scene.objects[1:]
    for samples in (1, 16):
        image = render(scene, background="transparent", exposure=1.0, samples=samples, filter="box")
        lamps = seen(scene, 2, 2, 2) | seen(scene, 3, 0, 0.6)
        sure = lamps & np.roll(lamps, 1, 0) & np.roll(lamps, -1, 0) & np.roll(lamps, 1, 1)
        sure &= np.roll(lamps, -1, 1)
        assert (image.alpha[sure] == 1).all()
        assert (image.pixels[sure][:, 3] == 255).all()
        assert (image.alpha == 0).any()
    assert ((image.alpha > 0) & (image.alpha < 1)).any()


@once
@pytest.mark.parametrize("samples", [1, 4])
def test_relit_lamps_are_seen_as_they_shine(samples: int) -> None:
    scene = looking_down(PANEL, vtray.Light((0, 0, 9), 0.1), BALL)
    options: dict[str, Any] = {"samples": samples, "exposure": 1.0, "keep_lights": True}
    image = render(scene, **options)
    relit = image.relight([0.2, 5.0, 0.4, 0.5])
    np.testing.assert_array_equal(relit.linear, render(relit.scene, **options).linear)
    assert relit.linear[SIZE[1] // 2, SIZE[0] * 3 // 4].max() > 4 * 255
    colored = image.recolor(1, "navy")
    np.testing.assert_array_equal(colored.linear, render(colored.scene, **options).linear)


@once
def test_rays_of_a_pixel_name_the_lamp() -> None:
    scene = looking_down(PANEL, vtray.Light((0, 0, 9), 0.1), BALL)
    image = render(scene, exposure=1.0)
    named = set()
    for row in range(0, SIZE[1], 3):
        for column in range(0, SIZE[0], 3):
            tree = vtray.trace_pixel(image, column, row)
            assert tree.light == tuple(image.linear[row, column])
            named.add(tree.lamp)
            if tree.lamp is not None:
                assert tree.hit is None
    assert named == {None, 1, 3}
    text = str(vtray.trace_pixel(image, SIZE[0] * 3 // 4, SIZE[1] // 2))
    assert "lamp         lights[1], a rectangle of radiance 2\n" in text
    assert "light        (510, 510, 510), that of the lamp\n" in text
