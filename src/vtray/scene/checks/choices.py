"""Arguments that are one of a few: words, true or false, or several in an order."""

from collections.abc import Container, Iterable, Mapping
from collections.abc import Set as AbstractSet
from typing import Any, TypeGuard

from vtray.base.errors import SceneError
from vtray.scene.checks.scene_words import show


def is_one_of(given: object, known: Container[str]) -> TypeGuard[str]:
    """Tell whether something is one of the words that there are, whatever it is."""
    return isinstance(given, str) and given in known


def yes_or_no(given: object, place: str, remedy: str = "") -> bool:
    """Return what is true or false, NumPy's too, as Python's own; a message ends with a remedy.

    Raises
    ------
    SceneError
        It is neither.
    """
    found = given.item() if getattr(given, "shape", None) == () else given  # type: ignore[attr-defined]
    if not isinstance(found, bool):
        raise SceneError(f"{place}: expected True or False, got {show(given)}{remedy}")
    return found


def listed(given: object, place: str, words: str) -> list[Any]:
    """Return what comes in an order as a list, an array as one of Python's own objects.

    Raises
    ------
    SceneError
        Nothing does.
    """
    found = given.tolist() if hasattr(given, "tolist") else given
    if not isinstance(found, Iterable) or isinstance(found, (str, bytes, Mapping, AbstractSet)):
        raise SceneError(f"{place}: expected {words}, got {show(given)}")
    return list(found)
