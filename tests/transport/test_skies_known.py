"""Skies of many colours against what integrals say of them, over many pixels or many seeds."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray import render

pytestmark = compiled_only  # means over many rays

SIDE = 32

NEAR = 2e-3
"""How near means over so many pixels come to integrals."""

Point = tuple[float, float, float]
BASIC = vtray.Gradient((255, 0, 0), (0, 255, 0), (0, 0, 255))
"""Each of its parts is a channel of its own."""


def facing(normal: Point, sky: vtray.Sky, *walls: Point) -> vtray.Scene:
    """Return a scene whose pixels see one point of a white plane that faces a sky."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=normal)
    for wall in walls:
        scene.add_plane(tuple(-1e-3 * part for part in wall), normal=wall)
    scene.camera = vtray.Camera(
        tuple(1e3 * part for part in normal),
        tuple(-part for part in normal),
        1.0,
        (SIDE, SIDE),
        (1e-9, 1e-9),
    )
    scene.lights = [sky]
    return scene


def shares(scene: vtray.Scene, **options: Any) -> np.ndarray:
    """Return red, green and blue of white where a scene is seen, on average over the pixels."""
    linear = render(scene, exposure=1.0, **options).linear
    return linear.mean(axis=(0, 1)) / 255


UP, DOWN, ASIDE = (0, 0, 1), (0, 0, -1), (1, 0, 0)

# The mean over cosines of h (2 - h) is 5/6, and that of (1 - h)**8 is 1/45.
FROM_ABOVE, FROM_BELOW = (5 / 6, 1 / 6, 0), (0, 1 / 45, 44 / 45)


@pytest.mark.parametrize(("normal", "expected"), [(UP, FROM_ABOVE), (DOWN, FROM_BELOW)])
def test_what_a_gradient_gives_to_level_surfaces(normal: Point, expected: Point) -> None:
    found = shares(facing(normal, vtray.Sky(gradient=BASIC, up=UP)))
    np.testing.assert_allclose(found, expected, atol=NEAR)


def test_what_a_gradient_gives_to_an_upright_surface() -> None:
    # Half of it sees the sky, where directions of height h count 2/pi times sqrt(1 - h^2).
    height = (np.arange(20000) + 0.5) / 20000
    counts = 2 / np.pi * np.sqrt(1 - height**2)
    zenith, ground = (counts * height * (2 - height)).mean(), (counts * (1 - height) ** 8).mean()
    found = shares(facing(ASIDE, vtray.Sky(gradient=BASIC, up=UP)))
    np.testing.assert_allclose(found, [zenith, 0.5 - zenith + ground, 0.5 - ground], atol=NEAR)


def test_radiance_and_color_are_factors() -> None:
    sky = vtray.Sky(0.5, (255, 51, 102), BASIC, up=UP)
    found = shares(facing(UP, sky))
    np.testing.assert_allclose(found, [5 / 12, 0.1 / 6, 0], atol=NEAR)


def test_up_is_that_of_the_camera_unless_it_is_given() -> None:
    given, left_out = (vtray.Sky(gradient=BASIC, up=up) for up in (ASIDE, None))
    scene, other = facing(UP, given), facing(UP, left_out)
    other.camera = other.camera.replace(up=ASIDE)
    scene.camera = other.camera
    np.testing.assert_array_equal(render(scene).linear, render(other).linear)
    other.camera = other.camera.replace(up=None)
    # For a camera that looks down along z, by the first rule of the picture.
    scene.lights = [vtray.Sky(gradient=BASIC, up=(0, -1, 0))]
    scene.camera = other.camera
    np.testing.assert_array_equal(render(scene).linear, render(other).linear)


def test_one_color_all_around_is_a_plain_sky() -> None:
    orange = (255, 128, 0)
    same = vtray.Sky(0.7, gradient=vtray.Gradient(orange, orange, orange))
    scene = facing(UP, same, ASIDE)
    scene.add_sphere((0.5, 0.5, 0.5), 0.3)
    plain = facing(UP, vtray.Sky(0.7, orange))
    plain.objects = scene.objects
    linear, expected = render(scene, exposure=1.0).linear, render(plain, exposure=1.0).linear
    np.testing.assert_allclose(linear, expected, rtol=1e-6)


def picture(height: int, dark: float = 0.0) -> np.ndarray:
    """Return a picture of a dark sky, twice as wide as high."""
    return np.full((height, 2 * height, 3), dark, np.float32)


def rows_and_columns(height: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the heights of rows above the horizon and the turns of columns, in radians."""
    rows = np.pi / 2 - (np.arange(height) + 0.5) / height * np.pi
    return rows[:, None], (np.arange(2 * height) + 0.5) / height * np.pi


def irradiance(pixels: np.ndarray, normal: Point = UP) -> np.ndarray:
    """Return what a picture gives to a surface, by a sum over fine cells, (3,)."""
    height, width, _ = pixels.shape
    down, across = (
        (np.arange(n * fine) + 0.5) / fine
        for n, fine in ((height, -(-800 // height)), (width, -(-1600 // width)))
    )
    row = np.clip(down - 0.5, 0, height - 1)
    above = np.minimum(row.astype(int), max(height - 2, 0))
    column = (across - 0.5) % width
    left = column.astype(int)
    y, x = (row - above)[:, None, None], (column - left)[:, None]
    below, right = np.minimum(above + 1, height - 1), (left + 1) % width
    light = (1 - y) * ((1 - x) * pixels[above][:, left] + x * pixels[above][:, right])
    light += y * ((1 - x) * pixels[below][:, left] + x * pixels[below][:, right])
    polar, turn = np.pi * down[:, None] / height, 2 * np.pi * across / width
    # The middle is towards x, and columns go to the right as seen from within.
    ways = -np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)
    cosine = np.maximum(sum(w * n for w, n in zip(ways, normal, strict=True)), 0)
    counts = cosine * np.sin(polar) * (np.pi / len(down)) * (2 * np.pi / len(across)) / np.pi
    return (light * counts[..., None]).sum(axis=(0, 1))


@pytest.mark.parametrize("normal", [UP, ASIDE, (0.36, -0.48, 0.8)])
@pytest.mark.parametrize("kind", ["noise", "spots", "sun", "east", "one pixel", "one row"])
def test_pictures_of_all_kinds(kind: str, normal: Point) -> None:
    random = np.random.default_rng(4)
    pixels = {
        "noise": random.random((9, 16, 3)),
        "spots": random.lognormal(sigma=1.2, size=(12, 24, 3)),
        "sun": picture(64, 0.3),
        "east": picture(16),
        "one pixel": np.full((1, 1, 3), 0.7),
        "one row": random.random((1, 32, 3)) ** 8,
    }[kind]
    if kind == "sun":
        pixels[14, 60:62] = (1e4, 8e3, 5e3)
    if kind == "east":
        pixels[:, 8:24] = (1, 2, 3)  # the half around x
    found = shares(facing(normal, vtray.Sky(image=pixels, up=UP)))
    np.testing.assert_allclose(found, irradiance(pixels, normal), rtol=4 * NEAR, atol=NEAR)


def test_a_bright_disc_in_a_picture_is_a_sun() -> None:
    # Its axis is 35 degrees from the zenith, to the left of x; it is 10 degrees wide.
    height, half = 512, np.radians(5)
    above, turns = rows_and_columns(height)
    ways = -np.cos(above) * np.cos(turns), np.cos(above) * np.sin(turns), np.sin(above) + 0 * turns
    tilt, around = np.radians(35), np.radians(40)
    axis = np.sin(tilt) * np.cos(around), np.sin(tilt) * np.sin(around), np.cos(tilt)
    pixels = picture(height)
    # By as much brighter as makes the sun 1 where it is square above.
    strength = 1 / (np.pi * np.sin(half) ** 2) * np.pi
    pixels[sum(w * a for w, a in zip(ways, axis, strict=True)) > np.cos(half)] = strength
    way = tuple(-a for a in axis)
    scene, same = facing(UP, vtray.Sky(image=pixels, up=UP)), facing(UP, vtray.Sun(way, angle=10))
    assert shares(scene) == pytest.approx(shares(same), rel=5 * NEAR)
    for light in (scene, same):
        # Nearly a half-plane, which hides some of it.
        light.add_sphere(tuple(40 * a + 30 * b for a, b in zip(axis, ASIDE, strict=True)), 28.9)
    assert 0.2 < shares(same)[0] < 0.7
    assert shares(scene) == pytest.approx(shares(same), rel=10 * NEAR)


def test_rotation_turns_a_picture_counterclockwise() -> None:
    pixels = np.random.default_rng(5).random((8, 16, 3))
    # The middle, which was towards x, is towards y then.
    turned = vtray.Sky(image=pixels, up=UP, rotation=90)
    same = vtray.Sky(image=np.roll(pixels, -4, axis=1), up=UP)
    scene, other = facing(ASIDE, turned), facing(ASIDE, same)
    np.testing.assert_allclose(shares(scene), shares(other), rtol=1e-6)
    assert abs(shares(scene) - shares(facing(ASIDE, turned.replace(rotation=0)))).max() > 0.01


def test_a_picture_of_one_color_is_a_plain_sky() -> None:
    scene = facing(UP, vtray.Sky(image=np.full((4, 8, 3), (1.0, 0.5, 0.25)), up=UP))
    scene.add_sphere((0.5, 0.5, 0.5), 0.3)
    plain = facing(UP, vtray.Sky())
    plain.objects = scene.objects
    linear, expected = render(scene, exposure=1.0).linear, render(plain, exposure=1.0).linear
    np.testing.assert_allclose(linear, expected * (1.0, 0.5, 0.25), rtol=1e-6)


def test_a_small_sun_leaves_little_noise() -> None:
    pixels = picture(256, 1.0)
    pixels[80, 250] = 1e4
    linear = render(facing(UP, vtray.Sky(image=pixels, up=UP)), exposure=1.0).linear
    assert np.isfinite(linear).all()
    assert linear.std() < 2e-3 * linear.mean()


def test_means_over_many_seeds_come_to_the_integral() -> None:
    pixels = np.random.default_rng(6).lognormal(sigma=1.5, size=(6, 12, 3))
    scene = facing(UP, vtray.Sky(image=pixels, up=UP))
    scene.camera = scene.camera.replace(size=(8, 8))
    means = [shares(scene, seed=seed) for seed in range(100)]
    error = np.std(means, axis=0) / np.sqrt(len(means))
    difference = np.mean(means, axis=0) - irradiance(pixels)
    # The sum over cells is right to 1e-3.
    assert (abs(difference) < 4 * error + 1e-3 * irradiance(pixels)).all()


@pytest.mark.parametrize("samples", [1, 4])
def test_kept_light_has_three_numbers_of_a_gradient(samples: int) -> None:
    scene = facing(UP, vtray.Sky(gradient=vtray.Gradient(), up=(1, 0, 1)))
    scene.add_sphere((1e-9, 0, 3e-9), 2e-9, color="orange")
    spots = np.random.default_rng(7).lognormal(sigma=2, size=(8, 16, 3))
    scene.lights += [vtray.Sun((0.2, 0, -1)), vtray.Sky(0.1), vtray.Sky(image=spots)]
    scene.add_light((3, 3, 3))
    options: dict[str, Any] = {"samples": samples, "keep_lights": True}
    image = render(scene, **options)
    relit = image.relight([0.3, 0.8, 0.0, 0.2, 1.5])
    np.testing.assert_array_equal(relit.linear, render(relit.scene, **options).linear)
    colored = image.recolor(1, "teal")
    np.testing.assert_array_equal(colored.linear, render(colored.scene, **options).linear)
