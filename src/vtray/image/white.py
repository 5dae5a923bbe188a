"""The light that becomes white in a picture, as its exposure says."""

import math
import reprlib
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.base.exact_math import power_of_2
from vtray.base.number import is_number, number_of
from vtray.scene.settings import RenderSettings

USUAL = (99, 100)
"""The share of the pixels with light that are no brighter than white, with an exposure "auto"."""


class Exposed(NamedTuple):
    """What a render can be locked to instead of a picture: the light that becomes white.

    Stops are in it already; they may be told beside it to stand in the new picture too.
    """

    white: float


def locked_white(lock: object, exposure: object = None, stops: object = None) -> float:
    """Return the white of the picture whose exposure another one shall have.

    Parameters
    ----------
    lock
        The picture, or what has its `white`. Beside `Exposed`, stops may be told.
    exposure, stops
        What was asked for beside it.

    Raises
    ------
    RenderError
        It is no picture, or an exposure or stops were asked for too.
    """
    told = None if isinstance(lock, Exposed) else stops
    for name, given in (("exposure", exposure), ("stops", told)):
        if given is not None:
            words = f"lock and {name} {reprlib.repr(given)}"
            raise RenderError(f"{words}: expected one of them; leave out the other")
    white = getattr(lock, "white", None)
    if is_number(white):
        return number_of(white)
    message = f"lock: expected a picture that was rendered, or None, got {reprlib.repr(lock)}"
    raise RenderError(message)


def known_white(settings: RenderSettings, lock: object = None) -> float | None:
    """Return the light that becomes white, if that is known before the light of the picture is."""
    if lock is None and isinstance(settings.exposure, str):
        return None
    return white_of(settings, np.zeros((0, 3)), lock)


def white_of(
    settings: RenderSettings,
    linear: NDArray[np.float64],
    lock: object = None,
    peak: float | None = None,
) -> float:
    """Return the light that becomes white; 0 if there is no light.

    Parameters
    ----------
    settings
        Exposure and stops.
    linear
        The light of the picture, (..., 3).
    lock
        A picture whose exposure is taken instead, with its stops, or None.
    peak
        The largest channel of light, ≥ 0, if it is known.
    """
    if lock is not None:
        return locked_white(lock)
    if settings.exposure == "max":
        white = max(float(linear.max(initial=0.0)), 0.0) if peak is None else peak
    elif settings.exposure == "auto":
        white = usual_brightness(linear)
    else:
        white = 255.0 / settings.exposure
    # Never 0 where there is light, which would be black.
    return max(white / power_of_2(settings.stops), math.ulp(0.0)) if white > 0.0 else 0.0


def usual_brightness(linear: NDArray[np.float64]) -> float:
    """Return the brightness that most pixels with light do not exceed; 0 if none has any.

    Of the n pixels whose brightest channel is above 0, in the order of that channel, it is that of
    the one of rank ceil(0.99 n).

    Parameters
    ----------
    linear
        Light, (..., 3).
    """
    brightest = linear.reshape(-1, 3).max(axis=1)
    lit = brightest[brightest > 0.0]
    if not len(lit):
        return 0.0
    rank = (len(lit) * USUAL[0] - 1) // USUAL[1]
    return float(np.partition(lit, rank)[rank])
