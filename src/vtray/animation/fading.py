"""How opaque the objects of a picture are, where a movie says that."""

from collections.abc import Iterable, Sequence
from itertools import repeat
from typing import Any

import numpy as np

from vtray.animation.keyframes import BEFORE, ApartError, straight
from vtray.base.errors import SceneError
from vtray.base.number import number_of
from vtray.scene.checks.scene_words import show
from vtray.scene.copies import Copies
from vtray.scene.objects import Object
from vtray.scene.stars import Stars

Opacity = float | tuple[float | None, ...]
"""That of all, or one for each; None where it is that which an object has of its own."""


def opacity_of(given: Any, place: str) -> Opacity:  # noqa: ANN401
    """Return opacities as they are given.

    Parameters
    ----------
    given
        A number, or one for each, some of which may be None.
    place
        What it is called in messages.

    Raises
    ------
    SceneError
        It is neither.
    """
    each = given.tolist() if isinstance(given, np.ndarray) else given
    if not isinstance(each, Sequence) or isinstance(each, (str, bytes)):
        return _number(each, place)
    return tuple(
        None if one is None else _number(one, f"{place}[{k}]") for k, one in enumerate(each)
    )


def between_opacities(one: Opacity, other: Opacity, share: float) -> Opacity:
    """Return opacities at a share of the way from some to others, from 0 to 1.

    Raises
    ------
    ApartError
        One is for other objects than its partner.
    """
    if isinstance(one, float) and isinstance(other, float):
        return straight(one, other, share)
    count = max(len(each) for each in (one, other) if not isinstance(each, float))
    starts, ends = _each(one, count), _each(other, count)
    if len(starts) != len(ends):
        words = f"opacities of as many objects as {BEFORE} has, {len(starts)}"
        raise ApartError(f"expected {words}, got {len(ends)}")
    found: list[float | None] = []
    for k, (a, b) in enumerate(zip(starts, ends, strict=True)):
        if a is None and b is None:
            found.append(None)
        elif a is None or b is None:
            words = "None" if a is None else "a number"
            raise ApartError(f"expected {words} for object {k}, as {BEFORE} has, got {show(b)}")
        else:
            found.append(straight(a, b, share))
    return tuple(found)


def faded(objects: Sequence[Object], opacity: Opacity) -> list[Object]:
    """Return objects with other opacities.

    Points that shine have none, and stay. Copies have that of what is copied.

    Raises
    ------
    SceneError
        There is not one for each.
    """
    if not isinstance(opacity, float) and len(opacity) != len(objects):
        words = f"a number, or one for each of {len(objects)} objects"
        raise SceneError(f"opacity: expected {words}, got {len(opacity)}")
    each: Iterable[float | None] = repeat(opacity) if isinstance(opacity, float) else opacity
    return [
        item if one is None else _faded(item, one) for item, one in zip(objects, each, strict=False)
    ]


def _faded(item: Any, opacity: float) -> Any:  # noqa: ANN401
    """Return an object with another opacity."""
    if isinstance(item, Stars):
        return item
    if isinstance(item, Copies):
        return item.replace(objects=[_faded(part, opacity) for part in item.objects])
    return item.replace(opacity=opacity)


def _each(opacity: Opacity, count: int) -> tuple[float | None, ...]:
    """Return one for each."""
    return (opacity,) * count if isinstance(opacity, float) else opacity


def _number(given: Any, place: str) -> float:  # noqa: ANN401
    """Return an opacity."""
    number = number_of(given)
    if not 0.0 <= number <= 1.0:
        raise _wrong(given, place)
    return number


def _wrong(given: object, place: str) -> SceneError:
    """Give the error for what is no opacity."""
    return SceneError(f"{place}: expected a number from 0 to 1, or one for each, got {show(given)}")
