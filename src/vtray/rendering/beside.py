"""Cameras that leave room for a legend and colour bars beside what they show."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from vtray.figures.annotations import Annotations
from vtray.figures.brightness_scale import BrightnessScale
from vtray.figures.painted.picture import MOST_BESIDE, share_beside
from vtray.rendering.starlight import peak_of
from vtray.scene.camera import Camera
from vtray.scene.objects import Object
from vtray.scene.stars import Stars

MARKS = ("legend", "colorbar")
"""What stands beside what is shown, as keywords of `vtray.Image.annotated`."""

MARGIN = 0.05
"""What stays free at each side, as a share of width and height."""

Margin = float | tuple[float, float, float, float]
"""As for `Camera.fit`."""


def has_beside(annotate: Mapping[str, Any]) -> bool:
    """Tell whether something stands beside what is shown."""
    return any(annotate.get(name) for name in MARKS)


def fit_beside(
    fit: Callable[[Margin], Camera],
    objects: Sequence[Object],
    annotate: Mapping[str, Any],
    size: tuple[int, int] | None = None,
) -> Camera:
    """Return a camera that leaves room for a legend and colour bars.

    Parameters
    ----------
    fit
        Gives the camera, by what stays free at the sides of the picture.
    objects
        What is shown.
    annotate
        What is painted on the picture, as keywords of `vtray.Image.annotated`.
    size
        Width and height of the picture in pixels; by default those of the camera.

    Raises
    ------
    FigureError
        The legend or the colour bars are not right.
    """
    camera = fit(MARGIN)
    if not has_beside(annotate):
        return camera
    given = {name: annotate[name] for name in MARKS if annotate.get(name)}
    width, height = map(int, size or camera.size)
    brightness = (
        _brightness(objects, camera.resized((width, height))) if "colorbar" in given else []
    )
    wanted, fontsize = Annotations(**given), annotate.get("fontsize")
    right = share_beside(objects, wanted, (width, height), brightness, fontsize)
    if not MARGIN < right < MOST_BESIDE:
        return camera
    return fit((MARGIN, MARGIN, right, MARGIN))


def _brightness(objects: Sequence[Object], camera: Camera) -> list[BrightnessScale]:
    """Return how bright points are that shine, near enough to know how wide their bars are."""
    found = []
    for stars in objects:
        if isinstance(stars, Stars):
            peak = peak_of(stars, camera) if stars.peak is None else stars.peak
            if peak is not None:
                shades = np.zeros((1, 3), np.uint8)
                found.append(BrightnessScale(peak, stars.stretch, stars.soft, shades))
    return found
