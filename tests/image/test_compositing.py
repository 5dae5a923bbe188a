"""Pixels made at once are those that are made step by step."""

from typing import Any

import numpy as np
import pytest
from pictures import SCENE, hand_made

import vtray
from conftest import JIT, once
from vtray.image.compositing import composite
from vtray.image.exposure import develop
from vtray.scene.style import Fog, Outline, Style

BACKGROUNDS = ["black", "transparent", vtray.Color(90, 60, 30), vtray.Color(255, 255, 255)]
SIZE = (70, 67) if JIT else (12, 11)
PEAKS = [1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7]
SHARES = [0.0, 0.1, 0.5, 1 / 3, 0.9999999, 1.0]


def picture(seed: int, background: object, *, lines: bool, shade: bool, fog: str) -> vtray.Image:
    """Return a picture of random light on which what is asked for is drawn."""
    made = hand_made(*SIZE, chance=seed, background=background)
    random = np.random.default_rng(seed)
    size = made.linear.shape[:2]
    alpha = random.choice([*SHARES, -0.01, 1.02], size)
    light = made.linear * (alpha > 0)[..., None] * random.choice([0, 0.01, 1], (*size, 1))
    light = np.where(
        random.random((*size, 3)) < 0.1, made.white * random.choice(PEAKS, (*size, 1)), light
    )
    light[random.random(size) < 0.02] = 7.0  # of what covers nothing
    given: dict[str, Any] = {"alpha": alpha, "shade": None, "lines": None, "fog": None}
    if shade:
        given["shade"] = random.choice(SHARES, size).astype(np.float32)
    if lines:
        given["lines"] = random.choice(SHARES, size).astype(np.float32)
    if fog:
        given["fog"] = random.choice(SHARES, size)
    fogs: dict[str, Any] = {"": False, "clear": Fog(), "blue": Fog(color=(0, 0, 255))}
    style = Style(outline=Outline(1, (200, 100, 0)) if lines else False, fog=fogs[fog])
    return vtray.Image(
        light,
        None,
        made.white,
        SCENE,
        made.settings,
        {},
        look=made._look,
        albedo=made._albedo,
        orders=made._orders_of,
        style=style,
        **given,
    )


@once
@pytest.mark.parametrize("background", BACKGROUNDS, ids=str)
@pytest.mark.parametrize("fog", ["", "clear", "blue"])
@pytest.mark.parametrize("lines", [False, True])
@pytest.mark.parametrize("shade", [False, True])
def test_all_at_once_is_step_by_step(
    background: object, fog: str, lines: bool, shade: bool
) -> None:
    seed = 10 * len(fog) + 2 * lines + shade
    image = picture(seed, background, lines=lines, shade=shade, fog=fog)
    for white in (*(peak * image.white for peak in PEAKS), 0.0, 5e-324, 1e304, np.inf):
        image.white = white
        expected = develop(
            image.with_sky, white, background, lambda: image.alpha, 2, 8, image.overlays
        )
        for threads in (1, 3):
            found = composite(
                image.linear, white, background, lambda: image._covered, image._drawn, threads
            )
            np.testing.assert_array_equal(found, expected)
        assert found.shape[2] == (4 if background == "transparent" else 3)


def test_images_are_made_so() -> None:
    image = picture(3, vtray.Color(1, 2, 3), lines=True, shade=False, fog="")
    expected = develop(
        image.with_sky, image.white, vtray.Color(1, 2, 3), lambda: image.alpha, 1, 8, image.overlays
    )
    np.testing.assert_array_equal(image.pixels, expected)
