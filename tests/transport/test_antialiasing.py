"""Pictures with samples: each pixel is the mean of an independent renderer's rays."""

import json
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere, xyz
from hierarchies import ALWAYS, NEVER
from hierarchies import render as render_scene
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_places import mean, sample_places
from strategies import crowd, may_be_dark, scenes

import vtray
from conftest import JIT, compiled_only, once
from vtray.rendering import hierarchy as acceleration
from vtray.scene.settings import FILTERS
from vtray.transport.sampling.filters import FILTERS as FILTERS_BY_NAME

COUNTS = [2, 3, 4, 5, 7, 16, 17, 100, 256]


def load(document: dict) -> vtray.Scene:
    return vtray.loads(json.dumps(document))


def render(document: dict, few: int = acceleration.FEW, **options: Any) -> vtray.Image:
    return render_scene(load(document), few, **options)


def marks_of(document: dict, samples: int = 2, **options: Any) -> np.ndarray:
    """Return which pixels have samples."""
    image = render(document, samples=samples, keep_lights=True, **options)
    return image._relighting._passes[1].first >= 0


def sampled(
    document: dict, marks: np.ndarray, samples: int, filter_name: str, seed: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Return the light and the cover of the pixels that are marked, by the oracle."""
    rows, columns = np.nonzero(marks)
    places = sample_places(columns, rows, samples, filter_name, seed)
    seen = oracle.look(document, places.columns, places.rows)
    covered = np.where(seen.ids[..., None] >= 0, 1.0, 0.0)
    return mean(seen.linear, places.weights), mean(covered, places.weights)[..., 0]


def assert_sampled(
    document: dict, samples: int, filter_name: str, seed: int = 0, **options: Any
) -> np.ndarray:
    """Check all pixels of a picture; return which have samples."""
    how = {"samples": samples, "filter": filter_name, "seed": seed}
    image = render(document, **how, **options)
    middle = render(document)
    marks = marks_of(document, **how)
    expected, cover = sampled(document, marks, samples, filter_name, seed)
    np.testing.assert_array_equal(image.linear[~marks], middle.linear[~marks])
    np.testing.assert_array_equal(image.alpha[~marks], middle.alpha[~marks])
    np.testing.assert_array_equal(image.linear[marks], expected)
    np.testing.assert_array_equal(image.alpha[marks], cover.clip(0, 1))
    assert image.white == max(image.linear.max(), 0)
    return marks


@once
@may_be_dark
@settings(max_examples=60)
@given(
    scenes(),
    st.sampled_from(COUNTS),
    st.sampled_from(FILTERS),
    st.sampled_from([0, 1, 2**32 - 1]),
)
def test_each_pixel_is_the_mean_of_its_samples(
    document: dict, samples: int, filter_name: str, seed: int
) -> None:
    if samples > 17:
        document["camera"]["size"] = [min(5, n) for n in document["camera"]["size"]]
    assert_sampled(document, samples, filter_name, seed)
    with_hierarchy = assert_sampled(document, samples, filter_name, seed, few=ALWAYS)
    np.testing.assert_array_equal(marks_of(document, filter=filter_name), with_hierarchy)


@compiled_only
@pytest.mark.parametrize("view", [{}, {"projection": "orthographic", "up": xyz(0.1, 1, 0.3)}])
@pytest.mark.parametrize("samples", [3, 16, 200])
@pytest.mark.parametrize("seed", range(2))
def test_hundreds_of_spheres(seed: int, samples: int, view: dict) -> None:
    document = crowd(seed + 20, **view)
    pixel = document["camera"]["resolution"]
    document["camera"].update(size=[23, 18], resolution=[4 * length for length in pixel])
    marks = assert_sampled(document, samples, FILTERS[(seed + samples) % 5], seed, threads=2)
    assert marks.any()


@compiled_only
@pytest.mark.parametrize("samples", [257, 300, 512, 1000])
def test_more_samples_than_go_into_a_packet(samples: int) -> None:
    document = crowd(3)
    document["camera"]["size"] = [6, 5]
    document["camera"]["resolution"] = [5 * n for n in document["camera"]["resolution"]]
    assert assert_sampled(document, samples, "gaussian").any()


CLOUD_VIEWS = [{}, {"projection": "orthographic"}, {"normal": xyz(0.4, -0.3, 1), "focus": 0.5}]


def apart(seed: int, view: dict) -> dict:
    """Return a scene of spheres of all sizes that do not touch, before a plane or nothing."""
    random = np.random.default_rng(seed)
    balls: list[dict] = []
    focus = view.get("focus", 10)
    forward = np.array(list(view.get("normal", xyz(0, 0, 1)).values()), float)
    forward /= np.linalg.norm(forward)
    while len(balls) < (40 if JIT else 8):
        center = 6 * forward + random.uniform(-4, 4, 3)
        radius = 10.0 ** random.uniform(-3, 0)
        gaps = [
            np.linalg.norm(center - list(b["center"].values())) - radius - b["radius"]
            for b in balls
        ]
        if center @ forward > 1 + radius and min(gaps, default=1) > 0:
            balls.append(sphere(tuple(center.tolist()), radius))
    wall = [plane(tuple((12 * forward).tolist()), tuple((-forward).tolist()))] * (seed % 2)
    size = [26, 20] if JIT else [6, 5]
    pixel = [8 / size[0], 6 / size[1]]
    if view.get("projection") != "orthographic":
        pixel = [p * focus / (focus + 6) for p in pixel]
    return scene(balls + wall, [light(5, -5, 0)], size=size, resolution=pixel, **view)


@once
@pytest.mark.parametrize("filter_name", ["box", "blackman-harris", "mitchell"])
@pytest.mark.parametrize("view", CLOUD_VIEWS)
@pytest.mark.parametrize("seed", range(3 if JIT else 1))
def test_pixels_in_which_several_things_are_seen_have_samples(
    seed: int, view: dict, filter_name: str
) -> None:
    document = apart(seed, view)
    radius = FILTERS_BY_NAME[filter_name].radius
    width, height = document["camera"]["size"]
    rows, columns = np.mgrid[0:height, 0:width]
    middle = oracle.look(document).ids
    several = np.zeros((height, width), bool)
    random = np.random.default_rng(seed)
    for across, below in random.uniform(-radius, radius, (60 if JIT else 40, 2)):
        several |= oracle.look(document, columns + across, rows + below).ids != middle
    assert several.any()
    for few in (ALWAYS, NEVER):
        assert not (several & ~marks_of(document, filter=filter_name, few=few)).any()


@once
def test_empty_pixels_and_the_inside_of_things_have_no_samples() -> None:
    ball = sphere((0, 0, 5), 1)
    document = scene([ball], [light(0, 0, 0)], size=[64, 48], resolution=[0.025, 0.025])
    marks = marks_of(document)
    rows, columns = np.mgrid[0:48, 0:64]
    # The outline seen from z = -10, in pixels from the middle; the filter reaches one pixel.
    outline = 10 * np.tan(np.arcsin(1 / 15)) / 0.025
    from_middle = np.hypot(columns - 32, rows - 24) - outline
    assert marks[np.abs(from_middle) < 0.7].all()
    assert not marks[from_middle > 2.2].any()
    # Near its outline, the surface turns too much within a pixel.
    assert not marks[from_middle < -3.2].any()


@pytest.mark.parametrize("filter_name", FILTERS)
@pytest.mark.parametrize("samples", [2, 3, 5, 7, 300] if JIT else [2, 3, 7])
def test_constant_light_stays_constant(samples: int, filter_name: str) -> None:
    # Two planes like a roof, which a light as far as can be meets at the same angle.
    roof = [plane((0, 0, 5), (slope, 0, -1)) for slope in (0.5, -0.5)]
    size = [8, 6] if JIT else [3, 2]
    document = scene(roof, [light(0, 0, -1e100)], size=size, projection="orthographic")
    options = {"filter": filter_name, "samples": samples, "seed": 3}
    assert marks_of(document, **options).any()
    linear = render(document, **options).linear
    np.testing.assert_allclose(linear, 255 / np.sqrt(1.25), rtol=1e-12)


@pytest.fixture(scope="module")
def scattered() -> dict:
    """Return a scene with edges of things and of shadows."""
    random = np.random.default_rng(4)
    balls = [
        sphere(
            tuple(random.uniform((-2.5, -1.8, 3), (2.5, 1.4, 7)).tolist()),
            random.uniform(0.2, 0.5),
            color=dict(zip("rgb", random.integers(0, 256, 3).tolist(), strict=True)),
        )
        for _ in range(20)
    ]
    floor = plane((0, 2, 0), (0, -1, 0))
    lights = [light(5, -5, 0), light(-3, -9, 2, intensity=0.5)]
    return scene([*balls, floor], lights, size=[48, 36], resolution=[0.1, 0.1])


@compiled_only
@pytest.mark.parametrize("filter_name", FILTERS)
def test_noise_falls_as_scrambled_nets_promise(scattered: dict, filter_name: str) -> None:
    truth = render(scattered, samples=8192, filter=filter_name, seed=99).linear
    marks = marks_of(scattered, filter=filter_name)
    counts = [4, 16, 64, 256]
    noise = [
        np.sqrt(
            np.mean(
                [
                    (render(scattered, samples=n, filter=filter_name, seed=seed).linear - truth)[
                        marks
                    ]
                    ** 2
                    for seed in range(4)
                ]
            )
        )
        for n in counts
    ]
    slope = np.polyfit(np.log(counts), np.log(noise), 1)[0]
    # Random samples give -0.5; at straight edges, nets give -0.75.
    assert slope < -0.7


@compiled_only
@pytest.mark.parametrize(
    ("threads", "tile"), [(1, 64), (2, 64), (7, 16), (3, 5), (5, 1), (2, 9999), (2, 33)]
)
@pytest.mark.parametrize("samples", [3, 17, 100, 257, 300])
def test_is_the_same_for_any_threads_and_tiles(
    scattered: dict, samples: int, threads: int, tile: int
) -> None:
    options = {"samples": samples, "filter": "mitchell"}
    expected = render(scattered, **options)
    image = render(scattered, threads=threads, tile=tile, **options)
    np.testing.assert_array_equal(image.linear, expected.linear)
    np.testing.assert_array_equal(image.pixels, expected.pixels)
    np.testing.assert_array_equal(image.alpha, expected.alpha)
    assert image.white == expected.white
    assert image.stats["rays"] == expected.stats["rays"]


@once
@pytest.mark.parametrize("samples", [2, 3, 5, 7, 33])
@pytest.mark.parametrize("filter_name", FILTERS)
def test_few_samples_of_each_filter(scattered: dict, filter_name: str, samples: int) -> None:
    camera = {"size": [24, 18], "resolution": [0.2, 0.2]}
    document = scattered | {"camera": scattered["camera"] | camera}
    for seed in (1, 2, 3):
        assert_sampled(document, samples, filter_name, seed)


@once
@pytest.mark.parametrize("filter_name", ["box", "gaussian"])
def test_pixels_with_another_thing_or_shadow_in_reach_have_samples(
    scattered: dict, filter_name: str
) -> None:
    radius = FILTERS_BY_NAME[filter_name].radius
    document = scattered
    if not JIT:
        camera = {"size": [12, 9], "resolution": [0.2, 0.2]}
        document = scattered | {"camera": scattered["camera"] | camera}
    width, height = document["camera"]["size"]
    rows, columns = np.mgrid[0:height, 0:width]

    def look(across: float, below: float) -> np.ndarray:
        seen = oracle.look(document, columns + across, rows + below)
        return np.concatenate([seen.ids[..., None], seen.shadows], axis=2)

    middle, beside = look(0, 0), np.zeros((height, width), bool)
    random = np.random.default_rng(1)
    for across, below in random.uniform(-radius, radius, (60 if JIT else 10, 2)):
        beside |= (look(across, below) != middle).any(axis=2)
    assert beside.any()
    assert not (beside & ~marks_of(document, filter=filter_name)).any()


@once
def test_seed_chooses_the_places(scattered: dict) -> None:
    document = scattered | {"camera": scattered["camera"] | ({} if JIT else {"size": [9, 7]})}
    one, again, other = (render(document, samples=4, seed=seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(one.linear, again.linear)
    difference = np.abs(one.linear - other.linear).max(axis=2)
    marks = marks_of(document)
    assert (difference[~marks] == 0).all()
    assert np.count_nonzero(difference) > 0.3 * marks.sum()
    assert difference.mean() < 0.05 * one.white


@once
@may_be_dark
@settings(max_examples=30)
@given(scenes(), st.sampled_from(FILTERS), st.integers(0, 2**32 - 1))
def test_one_sample_is_the_picture_of_the_format(
    document: dict, filter_name: str, seed: int
) -> None:
    image = render(document, samples=1, filter=filter_name, seed=seed)
    np.testing.assert_array_equal(image.linear, oracle.render(document))
    np.testing.assert_array_equal(image.pixels, oracle.develop(image.linear))
