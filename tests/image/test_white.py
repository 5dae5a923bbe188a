"""The light that becomes white: the brightest, most of it, a number, and stops."""

import json
from typing import Any

import numpy as np
import pytest
from examples import light, plane, scene, sphere

import vtray
from conftest import once
from vtray.image.white import Exposed, known_white, locked_white, usual_brightness, white_of
from vtray.scene.settings import RenderSettings


def render(**options: Any) -> vtray.Image:
    document = scene(
        [sphere((0, 0, 5), 1), plane((0, 0, 9), (0, 0, -1), color={"r": 200, "g": 100, "b": 50})],
        [light(5, -5, 0), light(-3, -4, -2, intensity=0.5)],
        size=[20, 15],
        resolution=[0.2, 0.2],
    )
    return vtray.render(vtray.loads(json.dumps(document)), **{"threads": 1, **options})


def pixels_of(*brightest: float) -> np.ndarray:
    """Return light of pixels with these largest channels, in another channel each."""
    linear = np.zeros((len(brightest), 3))
    for k, value in enumerate(brightest):
        linear[k] = value / 4
        linear[k, k % 3] = value
    return linear


@pytest.mark.parametrize(
    ("brightest", "expected"),
    [
        ([], 0.0),
        ([0.0, 0.0], 0.0),
        ([-1.0, 0.0], 0.0),
        ([7.0], 7.0),
        ([0.0, 0.0, 7.0, 0.0], 7.0),  # what nothing is seen in does not count
        ([1.0, 2.0], 2.0),  # rank ceil(0.99 * 2)
        ([*range(1, 101)], 99.0),
        ([*range(100, 0, -1)], 99.0),
        ([*range(1, 102)], 100.0),  # ceil(99.99)
        ([*range(1, 1001)], 990.0),
        ([*([0.0] * 5000), *range(1, 1001)], 990.0),
        ([*([3.0] * 99), 1e300], 3.0),
    ],
)
def test_most_pixels_with_light_are_no_brighter(brightest: list[float], expected: float) -> None:
    assert usual_brightness(pixels_of(*brightest)) == expected


def test_auto_cuts_off_the_brightest() -> None:
    image = render(exposure="auto")
    brightest = np.sort(image.linear.max(axis=2), axis=None)
    lit = brightest[brightest > 0.0]
    rank = -(-len(lit) * 99 // 100)
    assert image.white == lit[rank - 1] < lit[-1]
    # The picture is that of this white as any other.
    assert np.array_equal(image.pixels, render(exposure=255 / image.white).pixels)
    for options in ({"threads": 3}, {"tile": 7}):
        assert np.array_equal(render(exposure="auto", **options).pixels, image.pixels)
    assert np.array_equal(render().expose("auto").pixels, image.pixels)
    assert np.array_equal(image.expose().pixels, render().pixels)


@once
@pytest.mark.parametrize("exposure", ["max", "auto", 0.75])
def test_stops_double_the_light(exposure: Any) -> None:
    plain = render(exposure=exposure)
    for stops, factor in [(0, 1.0), (1, 2.0), (3.0, 8.0), (-2, 0.25)]:
        image = render(exposure=exposure, stops=stops)
        assert image.white == plain.white / factor
        assert np.array_equal(image.linear, plain.linear)
        assert np.array_equal(plain.expose(exposure, stops=stops).pixels, image.pixels)
        # Alone, they leave the exposure as it is.
        assert np.array_equal(plain.expose(stops=stops).pixels, image.pixels)
    half = render(exposure=exposure, stops=0.5)
    assert abs(half.white * 2**0.5 / plain.white - 1.0) < 1e-13
    assert half.expose(exposure).settings.stops == 0.0


def test_stops_never_make_light_black() -> None:
    for stops in (100, -100):
        settings = RenderSettings(exposure=1.7e308, stops=stops)
        assert white_of(settings, np.ones((1, 3))) > 0.0
    assert (render(stops=100).pixels[render().linear > 0.0] == 255).all()
    assert not render(stops=-100).pixels.any()
    assert white_of(RenderSettings(stops=3), np.zeros((4, 3))) == 0.0


def test_white_that_is_known_before() -> None:
    assert known_white(RenderSettings()) is None
    assert known_white(RenderSettings(exposure="auto", stops=3)) is None
    assert known_white(RenderSettings(exposure=2.0)) == 127.5
    assert known_white(RenderSettings(exposure=2.0, stops=-1)) == 255.0
    assert known_white(RenderSettings(), render(exposure=2.0, stops=1)) == 63.75


def test_lock_takes_stops_too() -> None:
    first = render(stops=1)
    assert render(lock=first).white == first.white
    message = "^lock and stops 2: expected one of them; leave out the other$"
    with pytest.raises(vtray.RenderError, match=message):
        render(lock=first, stops=2)
    with pytest.raises(vtray.RenderError, match=message):
        first.expose(lock=first, stops=2)
    locked = first.expose(lock=first)
    with pytest.raises(vtray.RenderError, match="^stops: .* of another one, .*; give an exposure"):
        locked.expose(stops=1)
    assert locked.expose("max", stops=1).white == first.white


@pytest.mark.parametrize(("name", "value"), [("exposure", "mean"), ("stops", 1e3), ("stops", "1")])
def test_wrong_exposures(name: str, value: Any) -> None:
    with pytest.raises(vtray.SceneError, match=f"{name}: expected "):
        render(**{name: value})
    with pytest.raises(vtray.SceneError, match=f"{name}: expected "):
        render().expose(**{name: value})


def test_soft_light_is_as_exact_as_white_asks_for() -> None:
    found = vtray.loads(json.dumps(scene([sphere((0, 0, 5), 1)], [], size=[9, 7])))
    found.add_light(vtray.RectangleLight((3, -3, 0), ((0, 0, 2), (1, 1, 0))))
    rays = {
        stops: vtray.render(found, exposure="auto", stops=stops, tolerance=0.05).stats["rays"]
        for stops in (-4, 0, 4)
    }
    assert rays[-4] <= rays[0] < rays[4]


def test_stops_are_told_beside_a_white_that_has_them() -> None:
    assert locked_white(Exposed(7.0), stops=1) == 7.0
    image = render(lock=Exposed(7.0), stops=1)
    assert (image.white, image.settings.stops) == (7.0, 1)
    with pytest.raises(vtray.RenderError, match="lock and exposure 'max': expected one of them"):
        locked_white(Exposed(7.0), "max")
