"""Reads the pictures that surfaces show in a scene file."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from vtray.scene.pictures.pattern_image import PatternImage, read_pattern_image

NONE: Mapping[str, object] = MappingProxyType({})


class PatternImages:
    """Gives decoders what stands for the paths of pictures, each of which is read once.

    Parameters
    ----------
    folder
        What paths are relative to.
    given
        Arrays in the place of files, by what stands for their paths.
    """

    def __init__(self, folder: str, given: Mapping[str, object] = NONE) -> None:
        self._folder = Path(folder)
        self._given = given
        self._made: dict[str, PatternImage] = {}

    def __call__(self, kind: type, found: object) -> PatternImage:
        """Return the picture of a path, or of an array, as ``dec_hook`` of msgspec.

        Raises
        ------
        SceneError
            If it cannot be read, or is not right.
        TypeError
            If it is none.
        """
        if not issubclass(kind, PatternImage):
            raise TypeError(kind.__name__)
        if hasattr(found, "__array__"):
            return PatternImage(found, "")
        if not isinstance(found, str):
            raise TypeError(type(found).__name__)
        if found not in self._made:
            self._made[found] = self._make(found)
        return self._made[found]

    def _make(self, path: str) -> PatternImage:
        if path in self._given:
            return PatternImage(self._given[path], "")
        return read_pattern_image(self._folder / path, path)


def without_image(image: object) -> str:
    """Return what stands for a picture where only keys count, as ``enc_hook`` of msgspec."""
    if not isinstance(image, PatternImage):
        raise TypeError(type(image).__name__)
    return ""
