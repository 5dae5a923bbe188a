"""What is painted on each picture of a movie: the same, but for the frame and its time."""

import inspect
import re
from collections.abc import Iterator, Mapping
from string import Formatter
from typing import Any

from vtray.base.errors import OutputError
from vtray.image.image import Image
from vtray.scene.checks.scene_words import show
from vtray.scene.checks.unknown_names import unknown_argument

_HUNDREDS = re.compile("[0-9]{3}")
"""What would ask for texts of any length, where it is said how a number is written."""

VARYING = ("title", "time")
"""Texts that may name the frame and its time."""


def annotated(
    given: Mapping[str, Any], frame: int | None, time: float | None, marks: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the keywords of `vtray.Image.annotated` for a picture.

    Parameters
    ----------
    given
        Those for all pictures. In ``title`` and ``time``, ``{frame}`` and ``{time}`` are replaced,
        formatted as by Python's ``str.format``; ``time=True`` and ``frame=True`` show just that.
    frame, time
        Which frame it is, and its time; None where there is none.
    marks
        Those for this picture alone; labels are added.

    Raises
    ------
    OutputError
        A text names something else, or what is not known.
    """
    found = {**given, **marks}
    if "labels" in given and "labels" in marks:
        found["labels"] = [*given["labels"], *marks["labels"]]
    known = {"frame": frame, "time": time}
    for name, value in known.items():
        if found.get(name) is True:
            found[name] = _known(name, name, value)
    for name in VARYING:
        if isinstance(found.get(name), str) and "{" in found[name]:
            found[name] = _formatted(name, found[name], known)
    return found


def check_annotate(given: object) -> dict[str, Any]:
    """Return what is painted on all pictures; raise OutputError if it cannot be."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise OutputError(f"annotate: expected keywords of Image.annotated, got {show(given)}")
    _self, *known = inspect.signature(Image.annotated).parameters
    for name in given:
        if name not in known:
            raise OutputError(f"annotate: {unknown_argument('Image.annotated', str(name), known)}")
    for name in VARYING:
        if isinstance(given.get(name), str):
            _formatted(name, given[name], {"frame": 0, "time": 0.0})
    # What can be gone through but once is for all pictures, and for another run to compare.
    return {
        name: [*value] if isinstance(value, Iterator) else value for name, value in given.items()
    }


def _formatted(name: str, text: str, known: Mapping[str, Any]) -> str:
    """Return a text with what is known put in."""
    words = "expected {frame} and {time} alone in braces, such as {time:.1f} ps"
    wrong = OutputError(f"{name}: {words}, got {text}")
    try:
        asked = [(key, how) for _, key, how, _ in Formatter().parse(text) if key is not None]
    except ValueError:
        raise wrong from None
    for key, how in asked:
        if key not in known or _HUNDREDS.search(how or ""):
            raise wrong
        _known(name, key, known[key])
    try:
        return text.format(**known)
    except (KeyError, IndexError, ValueError, AttributeError, TypeError):
        raise wrong from None


def _known(name: str, key: str, value: Any) -> Any:  # noqa: ANN401
    """Return the frame or the time; raise OutputError if it is not known."""
    if value is None:
        raise OutputError(f"{name}: the data do not say the {key} of a picture; leave it out")
    return value
