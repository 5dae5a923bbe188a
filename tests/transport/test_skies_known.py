"""Skies of many colours against what integrals say of them, over many pixels or many seeds."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, compiled_only
from vtray import render

SIDE = 32 if JIT else 6

NEAR = 2e-3 if JIT else 2e-2
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


@compiled_only
@pytest.mark.parametrize("samples", [1, 4])
def test_kept_light_has_three_numbers_of_a_gradient(samples: int) -> None:
    scene = facing(UP, vtray.Sky(gradient=vtray.Gradient(), up=(1, 0, 1)))
    scene.add_sphere((1e-9, 0, 3e-9), 2e-9, color="orange")
    scene.lights += [vtray.Sun((0.2, 0, -1)), vtray.Sky(0.1), vtray.Light((3, 3, 3))]
    image = render(scene, samples=samples, keep_lights=True)
    relit = image.relight([0.3, 0.8, 0.0, 1.5])
    np.testing.assert_array_equal(relit.linear, render(relit.scene, samples=samples).linear)
    colored = image.recolor(1, "teal")
    np.testing.assert_array_equal(colored.linear, render(colored.scene, samples=samples).linear)
