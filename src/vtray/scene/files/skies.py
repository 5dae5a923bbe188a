"""Turns what a scene file says of skies into `Sky`, with the pictures it names."""

from collections.abc import Iterable
from pathlib import Path

import msgspec

from vtray.scene.checks.checked import make_unchecked
from vtray.scene.checks.json_tree import short
from vtray.scene.files.in_file import LightInFile, SkyInFile
from vtray.scene.light_types import AnyLight, Sky
from vtray.scene.pictures.sky_image import read_sky_image


def with_skies(lights: Iterable[LightInFile], folder: str) -> list[AnyLight]:
    """Read the pictures of all skies that name one.

    Parameters
    ----------
    lights
        The lights of a scene as they stand in a file.
    folder
        What paths are relative to.

    Raises
    ------
    SceneError
        If a picture cannot be read, or is not right.
    """
    return [
        _sky_of(light, folder, f"lights[{index}]") if isinstance(light, SkyInFile) else light
        for index, light in enumerate(lights)
    ]


def names_images(lights: Iterable[LightInFile]) -> bool:
    """Tell whether any light names the file of a picture."""
    return any(isinstance(light, SkyInFile) and light.image is not None for light in lights)


def _sky_of(light: SkyInFile, folder: str, place: str) -> Sky:
    """Return a sky with its picture."""
    values = msgspec.structs.asdict(light)
    if light.image is not None:
        where = f"{place}.image: {short(light.image, 100)}"
        values["image"] = read_sky_image(Path(folder) / light.image, where)
    sky: Sky = make_unchecked(Sky, **values)
    return sky
