"""More samples for the pixels in which edges are sharpest."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, compiled_only, once
from vtray.rendering.edge_pixels import BUSY, MOST, SHARP

SIZE = (48, 36) if JIT else (16, 12)


def rods(*lights: Any, color: str = "black") -> vtray.Scene:
    """Return thin rods before nothing, and a ball."""
    scene = vtray.Scene()
    scene.add_cylinders([(-3, -2, 8), (-2, 2, 9)], [(3, 1, 8), (3, -1, 9)], 0.03, color=color)
    scene.add_sphere((0, 0, 10), 0.8, color=color)
    scene.camera = vtray.Camera((0, 0, 0), (0, 0, 1), 4, SIZE, (4 / SIZE[0], 3 / SIZE[1]))
    scene.lights = list(lights)
    return scene


def lit(color: str = "black") -> vtray.Scene:
    """Return the same in hard light."""
    return rods(vtray.Light((3, -5, -2), 1), vtray.Light((-4, -1, 1), 0.5), color=color)


WHITE: dict[str, Any] = {"background": "white", "exposure": 1.0}


@once
@pytest.mark.parametrize("filter_name", ["box", "mitchell"])
@pytest.mark.parametrize("settings", [WHITE, {}, {"exposure": "auto", "background": "navy"}])
def test_pixels_are_those_of_so_many_samples(settings: dict[str, Any], filter_name: str) -> None:
    options = {**settings, "filter": filter_name}
    image = vtray.render(lit("orange"), samples=4, edge_samples=16, **options)
    assert set(np.unique(image.samples)) == {1, 4, 16}
    for count in (4, 16):
        plain = vtray.render(lit("orange"), samples=count, **options)
        own = image.samples == count
        np.testing.assert_array_equal(image.linear[own], plain.linear[own])
        np.testing.assert_array_equal(image.alpha[own], plain.alpha[own])
        np.testing.assert_array_equal(image.error[own], plain.error[own])
        np.testing.assert_array_equal((image.samples == 1), plain.samples == 1)
    if "exposure" not in settings:
        assert image.white == image.linear.max()


def test_pixels_are_those_that_differ_most() -> None:
    """Of black things on white, the light of n samples differs by how many of them are covered."""
    scene = lit("black")
    options: dict[str, Any] = {"filter": "box", **WHITE}
    before = vtray.render(scene, samples=4, **options).alpha
    image = vtray.render(scene, samples=4, edge_samples=16, **options)
    differs, picked = np.sqrt(before * (1 - before) / 4), image.samples == 16
    assert picked.any()
    assert (differs[picked] > SHARP).all()
    assert picked.mean() <= MOST
    # Those that are left differ no more, and there are as many as may be.
    least, left = differs[picked].min(), differs[~picked].max()
    assert left <= least
    assert left <= SHARP or picked.mean() > allowed((differs > SHARP).mean()) - 0.02


def allowed(share: float) -> float:
    """Return which share of all pixels may have more samples, given that with sharp edges."""
    return float(np.interp(share, [MOST, BUSY], [MOST, 0]))


@once
@pytest.mark.parametrize("count", [3, 12, 20, 200] if JIT else [3, 20])
def test_fewer_have_more_the_more_there_are(count: int) -> None:
    random = np.random.default_rng(1)
    scene = lit("black")
    ends = [random.uniform((-5, -4, 9), (5, 4, 11), (count, 3)) for _ in range(2)]
    scene.add_cylinders(*ends, 0.04, color="black")
    options: dict[str, Any] = {"filter": "box", **WHITE}
    before = vtray.render(scene, samples=4, **options).alpha
    sharp = (np.sqrt(before * (1 - before) / 4) > SHARP).mean()
    share = (vtray.render(scene, samples=4, edge_samples=16, **options).samples == 16).mean()
    assert share <= allowed(sharp)
    if count == 200:
        assert sharp > BUSY


@once
@pytest.mark.parametrize("color", ["black", "white"])
@pytest.mark.parametrize("background", ["black", "white", "transparent"])
def test_what_is_behind_counts(color: str, background: str) -> None:
    """Black rods on black have no edges, nor do white ones whose light is that behind them."""
    scene = rods(vtray.Ambient(1.0), color=color)
    scene.objects.clear()
    scene.add_cylinders([(-3, -2, 8)], [(3, 1, 8)], 0.03, color=color)  # all open to the light
    options: dict[str, Any] = {"exposure": 1.0, "tolerance": 1e6, "background": background}
    shares = vtray.render(scene, samples=4, edge_samples=16, **options).samples == 16
    is_like_that = color == background or (color, background) == ("white", "transparent")
    assert shares.any() == (not is_like_that)


def test_few_differences_count_for_nothing() -> None:
    dark = vtray.render(lit("gray"), samples=4, edge_samples=16, exposure=1.0, stops=-6)
    assert dark.samples.max() == 4
    bright = vtray.render(lit("gray"), samples=4, edge_samples=16, exposure=1.0)
    assert bright.samples.max() == 16


@once
@pytest.mark.parametrize(
    "options",
    [
        {"samples": 1},
        {"samples": 16},
        {"samples": 4, "keep_lights": True},
        {"samples": 4, "integrator": "whitted"},
        {"samples": 4, "integrator": "path"},
    ],
)
def test_where_there_are_none(options: dict[str, Any]) -> None:
    image = vtray.render(lit("red"), edge_samples=16, **WHITE, **options)
    assert image.samples.max() == options["samples"]
    plain = vtray.render(lit("red"), **WHITE, **options)
    np.testing.assert_array_equal(image.linear, plain.linear)


def test_none_through_a_lens() -> None:
    scene = lit("red")
    scene.camera = scene.camera.replace(lens=vtray.Lens(0.1, focus_distance=8))
    image = vtray.render(scene, samples=4, edge_samples=16, **WHITE)
    assert (image.samples == 4).all()


@once
def test_in_default_light() -> None:
    scene = lit("red")
    scene.lights = vtray.Scene().lights
    image = vtray.render(scene)
    assert (image.settings.samples, image.settings.edge_samples) == (4, 16)
    assert 0 < (image.samples == 16).mean() <= MOST
    for asked, most in (({"samples": 2}, 16), ({"edge_samples": 9}, 9), ({"samples": 1}, 1)):
        assert vtray.render(scene, **asked).samples.max() == most
    assert vtray.render(scene, edge_samples=1).samples.max() == 4


@compiled_only
def test_threads_tiles_and_who_looks_change_nothing() -> None:
    scene = lit("red")
    scene.lights = vtray.Scene().lights
    seen: list[vtray.Image] = []
    done: list[tuple[str, int, int]] = []
    image = vtray.render(scene, threads=1)
    other = vtray.render(
        scene,
        threads=3,
        tile=7,
        progress=lambda *step: done.append(step),
        on_update=seen.append,
        update_seconds=0.0,
    )
    np.testing.assert_array_equal(image.linear, other.linear)
    np.testing.assert_array_equal(image.pixels, other.pixels)
    np.testing.assert_array_equal(image.samples, other.samples)
    assert seen
    assert done[-1][1] == done[-1][2]
    assert [share for _, share, _ in done] == sorted(share for _, share, _ in done)


@compiled_only
def test_lines_have_less_error() -> None:
    """Beside the mean of very many samples, where there are more."""
    scene = lit("black")
    truth, few, more = (
        vtray.render(scene, samples=samples, edge_samples=16, **WHITE) for samples in (1024, 4, 16)
    )
    plain = vtray.render(scene, samples=4, **WHITE)
    picked = few.samples == 16
    assert (few.alpha == more.alpha)[picked].all()
    off, before = (
        np.sqrt(np.mean((image.alpha - truth.alpha)[picked] ** 2)) for image in (few, plain)
    )
    assert before > SHARP
    assert off < 0.45 * before
