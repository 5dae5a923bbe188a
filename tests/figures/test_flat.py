"""Flat pictures, whose colours can be read back."""

import numpy as np
import pytest
from copied import molecules
from hypothesis import given
from hypothesis import strategies as st
from written_out import write_out

import vtray
from conftest import once
from vtray.figures.flat import CONTRAST, DARKEST, lightness_range, lit_colors
from vtray.figures.oklab import oklab_to_linear, oklab_to_srgb, srgb_to_oklab

matplotlib = pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")

Array = np.ndarray


@pytest.mark.parametrize(
    ("color", "lab"),
    [
        ((0, 0, 0), (0, 0, 0)),
        ((255, 255, 255), (1, 0, 0)),
        # From the CSS Color Module Level 4 and its tests.
        ((255, 0, 0), (0.62796, 0.22486, 0.12585)),
        ((0, 255, 0), (0.86644, -0.23389, 0.17950)),
        ((0, 0, 255), (0.45201, -0.03246, -0.31153)),
    ],
)
def test_oklab_of_known_colors(color: tuple[int, ...], lab: tuple[float, ...]) -> None:
    np.testing.assert_allclose(srgb_to_oklab(np.array(color)), lab, atol=2e-5)


def test_oklab_there_and_back() -> None:
    colors = np.random.default_rng(1).integers(0, 256, (5000, 3), np.uint8)
    np.testing.assert_array_equal(oklab_to_srgb(srgb_to_oklab(colors)), colors)


@given(st.tuples(*[st.integers(0, 255)] * 3))
def test_all_light_is_within_what_a_monitor_shows(color: tuple[int, ...]) -> None:
    lab = srgb_to_oklab(np.array([color]))
    shadow, full = lightness_range(lab)
    assert DARKEST <= shadow <= full <= 1
    assert full - shadow <= CONTRAST + 1e-12
    steps = np.linspace(shadow[0], full[0], 20)
    shown = oklab_to_linear(np.column_stack([steps, *np.repeat(lab[:, 1:], 20, 0).T]))
    # Lines of equal a and b can bulge out of the gamut by less than 8 bits can tell.
    assert shown.min() > -0.001
    assert shown.max() < 1.001
    assert full[0] >= min(lab[0, 0], 1) - 1e-9 or shadow[0] > lab[0, 0] - CONTRAST


@given(st.tuples(*[st.integers(0, 255)] * 3), st.floats(0, 1), st.floats(0, 1))
def test_light_changes_lightness_only(color: tuple[int, ...], dim: float, bright: float) -> None:
    dim, bright = sorted((dim, bright))
    colors = np.array([color, color], np.uint8)
    lit = srgb_to_oklab(lit_colors(colors, np.array([dim, bright])))
    own = srgb_to_oklab(colors)
    np.testing.assert_allclose(lit[:, 1:], own[:, 1:], atol=0.0025)
    assert lit[1, 0] >= lit[0, 0] - 0.002


def test_full_light_shows_the_color_itself_where_it_can_be_darker() -> None:
    colors = np.array([(150, 150, 150), (140, 120, 110), (255, 255, 255)], np.uint8)
    np.testing.assert_array_equal(lit_colors(colors, np.ones(3)), colors)


READABLE = {
    "viridis": 2,
    "plasma": 1,
    "inferno": 3,
    "magma": 4,
    "turbo": 1,
    "cividis": 10,
    "Spectral": 2,
    "coolwarm": 5,
    "RdBu": 6,
    "twilight": 4,
    "YlGnBu": 5,
}
"""By how many of 256 colours a value that is read back may be wrong, at the most."""


def table(name: str) -> Array:
    """Return Matplotlib's 256 colours of a map."""
    return (matplotlib.colormaps[name](np.arange(256), bytes=True)[:, :3]).astype(np.uint8)


def read_back(colors: Array, pixels: Array) -> Array:
    """Return the place of the colour with the nearest a and b for each pixel, (n,)."""
    lab, seen = srgb_to_oklab(colors), srgb_to_oklab(pixels)
    apart = np.linalg.norm(seen[:, None, 1:] - lab[None, :, 1:], axis=2)
    return apart.argmin(axis=1)


@once
@pytest.mark.parametrize(("name", "most"), READABLE.items())
def test_values_are_read_back_in_all_light(name: str, most: int) -> None:
    colors = table(name)
    place, light = np.repeat(np.arange(256), 24), np.tile(np.linspace(0, 1, 24), 256)
    found = read_back(colors, lit_colors(colors[place], light))
    wrong = np.abs(found - place)
    if name == "twilight":  # it begins and ends with the same colour
        wrong = np.minimum(wrong, 255 - wrong)
    assert wrong.max() <= most
    assert wrong.mean() < 0.5


def test_gray_cannot_be_read_back() -> None:
    colors = table("gray")
    found = read_back(colors, lit_colors(colors, np.full(256, 0.3)))
    assert np.abs(found - np.arange(256)).max() > 50


@pytest.mark.parametrize("one_for_all", [True, False])
def test_halves_of_cylinders_have_their_colors(one_for_all: bool) -> None:
    first, second = (150, 90, 60), (60, 120, 140)
    more = {"color": first, "color_end": second}
    if not one_for_all:
        more = {"color": [first, (1, 2, 3)], "color_end": [second, (1, 2, 3)]}
    scene = vtray.Scene()
    scene.add_sphere((-9, 0, 0), 1)
    scene.add_cylinders([(-1, 0, 0), (0, 30, 0)], [(3, 0, 0), (0, 40, 0)], 1, **more)  # type: ignore[arg-type]
    scene.add_cylinder((0, 0, -5), (0, 1, -5), 0.1, color=first)
    scene.add_light((0, 0, 9))
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (1, 0, 0), 3, size=(40, 9))
    image = vtray.render(scene, background="white")
    seen = (image.ids == (1, 0)).all(axis=2)
    columns = np.nonzero(seen)[1]
    middle = int(columns.mean().round())
    lab = srgb_to_oklab(image.flat()[seen])
    own = srgb_to_oklab(np.array([first, second], np.uint8))
    halves = (columns > middle).astype(int)
    sure = columns != middle
    np.testing.assert_array_equal(image.halves[seen][sure], halves[sure])
    np.testing.assert_allclose(lab[sure, 1:], own[halves[sure], 1:], atol=0.0025)
    assert not image.halves[~seen].any()


@once
def test_copies_have_the_colors_of_what_is_copied() -> None:
    scene = molecules(size=(48, 36))
    image, written = vtray.render(scene), vtray.render(write_out(scene)[0])
    assert {1, 3} <= set(np.unique(image.ids[..., 0]))
    assert image.halves[image.copies >= 0].any()
    np.testing.assert_array_equal(image.flat(), written.flat())
    assert len(np.unique(image.flat().reshape(-1, 3), axis=0)) > 50


@once
def test_what_is_faint_has_its_color_where_nothing_is_solid() -> None:
    scene = vtray.Scene()
    scene.add_spheres(
        [(0, 0, 0), (0, 0, -4)], [1, 2], color=[(150, 90, 60), (60, 120, 140)], opacity=0.4
    )
    scene.add_cylinder((3, -2, 0), (3, 2, 0), 0.5, color=(60, 120, 140), opacity=0.2)
    scene.add_light((0, 0, 9))
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (1, 0, 0), 8, size=(40, 24))
    image = vtray.render(scene)
    assert (image.ids < 0).all()
    flat, shown = image.flat(), image.shown.ids
    assert image.expose(2.0).shown is image.shown, "it is traced more than once"
    own = srgb_to_oklab(np.array([(150, 90, 60), (60, 120, 140)], np.uint8))
    for place, color in (((0, 0), 0), ((0, 1), 1), ((1, 0), 1)):
        seen = (shown == place).all(axis=2)
        assert seen.sum() > 10
        np.testing.assert_allclose(
            srgb_to_oklab(flat[seen])[:, 1:], own[[color] * seen.sum(), 1:], atol=0.0025
        )
    assert not flat[shown[..., 0] < 0].any()
