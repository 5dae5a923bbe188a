"""Writes scene files, and the files of arrays beside them."""

import itertools
import os
from collections.abc import Callable, Container, Iterable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import msgspec

from vtray.base.atomic_file import write_whole
from vtray.base.errors import OutputError
from vtray.base.file_name import file_name
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.checks.limits import Byte
from vtray.scene.copies import Copies
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.files.in_file import (
    HOLDERS_IN_FILE,
    HolderInFile,
    SceneInFile,
    without_integrator,
)
from vtray.scene.materials import is_default
from vtray.scene.pictures.pattern_image import PatternImage
from vtray.scene.pictures.sky_image import SkyImage
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.scene.vectors import Color
from vtray.scene.written_lights import as_written
from vtray.scene.written_objects import object_as_written

if TYPE_CHECKING:
    from vtray.scene.scene import Scene


def save(scene: "Scene", path: str | os.PathLike[str]) -> None:
    """Write a valid scene as `Scene.save` does."""
    target = Path(file_name(path, OutputError))
    arrays: dict[str, dict[str, object]] = {}
    named_before = cache(partial(_arrays_of, target))

    def in_file(item: Any) -> Any:  # noqa: ANN401
        """Return what stands of an object in the scene file; keep the arrays for other files."""
        if not isinstance(item, ArrayHolder):
            return object_as_written(item)
        shared: dict[str, Any] = {}
        if isinstance(item, Copies):
            shared["objects"] = [in_file(part) for part in item.objects]
        name = _unused_name(target, arrays)
        _check_own(target, name, item.sources(), named_before)
        entry, arrays[name] = _split(item, name, shared)
        return entry

    images: dict[int, str] = {}

    def write_image(image: SkyImage | PatternImage) -> str:
        """Return the name of the file of a picture; keep its pixels for it."""
        if id(image) not in images:
            name = images[id(image)] = _unused_name(target, arrays)
            _check_own(target, name, image.sources(), named_before)
            arrays[name] = {"image": image.pixels}
        return images[id(image)]

    objects = [in_file(item) for item in scene.objects]
    lights: list[Any] = [as_written(light, write_image) for light in lights_of(scene)]
    found = SceneInFile(scene.camera, lights, objects)
    render, found.integrator = without_integrator(settings_of(scene))
    if render != RenderSettings():
        found.render = render
    if scene.style != Style():
        found.style = scene.style
    data = msgspec.json.format(_encode(found, target, write_image), indent=2) + b"\n"

    def write(file: BinaryIO) -> None:
        file.write(data)

    for name, columns in arrays.items():
        from vtray.scene.array_file import write_arrays

        write_arrays(target.with_name(name), columns)
    write_whole(target, write)


def _unused_name(scene: Path, used: Container[str]) -> str:
    """Give the name for the next arrays of a scene."""
    numbers = itertools.chain([""], (f"-{number}" for number in itertools.count(2)))
    names = (f"{scene.stem}{number}.npz" for number in numbers)
    return next(name for name in names if name not in used and name != scene.name)


def _check_own(
    scene: Path, name: str, sources: Iterable[Path], named_before: Callable[[], list[str]]
) -> None:
    """Raise OutputError if a file in the place of a scene's arrays is not its own."""
    file = scene.with_name(name)
    if not file.exists():
        return
    is_own = any(source.exists() and file.samefile(source) for source in sources)
    if not is_own and name not in named_before():
        remedy = "save the scene under another name, or delete that file first"
        raise OutputError(f"{file}: is there already and does not belong to {scene.name}; {remedy}")


def _arrays_of(scene: Path) -> list[str]:
    """Return what files of arrays a scene file names, none if it is no scene file."""
    from vtray.base.input_file import read_input

    try:
        return list(_named_in(msgspec.json.decode(read_input(scene))))
    except (OSError, msgspec.DecodeError, RecursionError):
        return []


def _named_in(found: Any) -> Iterator[str]:  # noqa: ANN401
    """Give the names of files that what stands in a scene file names."""
    if isinstance(found, list):
        for item in found:
            yield from _named_in(item)
    elif isinstance(found, dict):
        for key, item in found.items():
            if key in ("data", "image") and isinstance(item, str):
                yield item
            else:
                yield from _named_in(item)


def _split(
    item: ArrayHolder, name: str, shared: dict[str, Any]
) -> tuple[HolderInFile, dict[str, object]]:
    """Split an object into what stands in a scene file, and the arrays of a file of this name."""
    (kind,) = (kind for kind in HOLDERS_IN_FILE if kind.MADE is type(item))
    arrays: dict[str, object] = {}
    for key, column in item.COLUMNS.items():
        value = getattr(item, key)
        if isinstance(value, float):
            shared[key] = value
        elif column.kind is Byte and value is not None and value.ndim == 1:
            shared[key] = Color(*value.tolist())
        elif value is not None:
            arrays[key] = value
    if isinstance(item, Arrays) and not is_default(item.material):
        shared["material"] = item.material
    return kind(data=name, **shared), arrays


def _encode(scene: SceneInFile, target: Path, write_image: Callable[[PatternImage], str]) -> bytes:
    """Write a scene as JSON, with what stands for the pictures of patterns."""
    try:
        return msgspec.json.encode(scene, enc_hook=write_image)
    except UnicodeEncodeError:
        message = f"{target}: cannot be written: the name is not UTF-8, as JSON needs it"
        raise OutputError(message) from None
