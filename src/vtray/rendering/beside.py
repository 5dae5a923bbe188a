"""Cameras that leave room for what is painted beside, above and below what they show."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from vtray.figures.annotations import Annotations
from vtray.figures.brightness_scale import BrightnessScale
from vtray.figures.caption import frame_caption
from vtray.figures.painted.layout import MOST_BESIDE
from vtray.figures.painted.picture import share_above, share_below, share_beside
from vtray.rendering.starlight import peak_of
from vtray.scene.camera import Camera
from vtray.scene.objects import Object
from vtray.scene.stars import Stars

MARKS = ("legend", "colorbar")
"""What stands beside what is shown, as keywords of `vtray.Image.annotated`."""

SOME = 1000
"""Stands for times and numbers of frames that are only known with each picture of a movie."""

MOST_ABOVE = 0.3
"""The share of the height from which on texts, or a scale bar, stand on what is shown."""

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
    """Return a camera that leaves room for a legend, colour bars, texts above, and a scale bar.

    Parameters
    ----------
    fit
        Gives the camera, by what stays free at the sides of the picture.
    objects
        What is shown.
    annotate
        What is painted on the picture, as keywords of `vtray.Image.annotated`; a time or a frame
        may be True where it is that of each picture.
    size
        Width and height of the picture in pixels; by default those of the camera.

    Raises
    ------
    FigureError
        The legend, the colour bars or the texts are not right.
    """
    camera = fit(MARGIN)
    width, height = map(int, size or camera.size)
    fontsize = annotate.get("fontsize")
    above = below = right = 0.0
    if has_beside(annotate):
        given = {name: annotate[name] for name in MARKS if annotate.get(name)}
        brightness = (
            _brightness(objects, camera.resized((width, height))) if "colorbar" in given else []
        )
        wanted = Annotations(**given)
        right = share_beside(objects, wanted, (width, height), brightness, fontsize)
    title = str(annotate.get("title") or "")
    time, frame = (
        SOME if annotate.get(name) is True else annotate.get(name) for name in ("time", "frame")
    )
    caption = frame_caption(time, frame)
    if title or caption:
        above = share_above(title, caption, (width, height), fontsize)
    if annotate.get("scalebar"):
        below = share_below((width, height), fontsize)
    free = (
        MARGIN,
        _free(above, MOST_ABOVE),
        _free(right, MOST_BESIDE),
        _free(below, MOST_ABOVE),
    )
    return camera if set(free) == {MARGIN} else fit(free)


def _free(share: float, most: float) -> float:
    """Return what stays free at a side, if marks take such a share of it; no more than most."""
    return share if MARGIN < share < most else MARGIN


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
