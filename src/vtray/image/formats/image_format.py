"""The formats of pictures, and what each can hold."""

import importlib.util
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO, NamedTuple

from vtray.base.errors import OutputError
from vtray.base.extras import PACKAGES, pip_install
from vtray.base.number import number_of
from vtray.image.aovs import AOVS
from vtray.image.formats.exr_file import read_exr, write_exr
from vtray.image.formats.npz_file import read_npz, write_npz
from vtray.image.formats.picture import How, Picture, has_alpha
from vtray.image.formats.pillow_file import read_exif, write_jpeg, write_webp
from vtray.image.formats.png_file import read_png, write_png
from vtray.image.formats.tiff_file import write_tiff
from vtray.scene.checks.limits import MAX_SIZE


class Format(NamedTuple):
    """A format, and what it can hold.

    Attributes
    ----------
    write
        Writes a picture to an open file.
    read
        Returns what an open file says of how it was made, None if nothing.
    bits
        The bits that a channel may have; the first unless said otherwise.
    alpha
        Whether a pixel may be transparent.
    aov
        Whether it holds AOVs too.
    needs
        The module of another package that is needed, by the bits of a channel.
    side
        The largest width and height.
    memory
        Bytes of memory that a pixel takes while it is written, by the bits of a channel, as
        measured, its light and its 8 bits included.
    """

    write: Callable[[Picture, How, BinaryIO], None]
    read: Callable[[BinaryIO], str | None]
    bits: tuple[int, ...]
    alpha: bool
    aov: bool
    needs: Mapping[int, str] = MappingProxyType({})
    side: int = MAX_SIZE
    memory: Mapping[int, int] = MappingProxyType({8: 31, 16: 120, 32: 80})


_TIFF = Format(write_tiff, read_exif, (8, 16), alpha=True, aov=False, needs={16: "tifffile"})
_JPEG = Format(write_jpeg, read_exif, (8,), alpha=False, aov=False, side=65500)

FORMATS = {
    ".png": Format(write_png, read_png, (8, 16), alpha=True, aov=False),
    ".tif": _TIFF,
    ".tiff": _TIFF,
    ".jpg": _JPEG,
    ".jpeg": _JPEG,
    ".webp": Format(write_webp, read_exif, (8,), alpha=True, aov=False, side=16383, memory={8: 60}),
    ".exr": Format(write_exr, read_exr, (32,), alpha=True, aov=True, needs={32: "OpenEXR"}),
    ".npz": Format(write_npz, read_npz, (8, 16), alpha=True, aov=True),
}
"""The formats by the endings of files; the first is for a name without an ending."""

DEFAULT = ".png"


def find_format(path: Path) -> Format:
    """Return the format of a file by its ending; raise OutputError if there is none."""
    ending = path.suffix.lower() or DEFAULT
    if ending not in FORMATS:
        known = ", ".join(FORMATS)
        message = f'{path}: cannot write "{path.suffix}" files; the formats are {known}'
        raise OutputError(message)
    return FORMATS[ending]


def check_format(
    path: Path,
    bits: int | None = None,
    aov: Collection[str] = (),
    background: object = "black",
    size: Collection[float] = (),
) -> How:
    """Check, before any work is done, that a format can hold what is asked for.

    Parameters
    ----------
    path
        The file; its ending says the format.
    bits
        Bits of each channel; None for what is usual in the format.
    aov
        What to write beside the picture, of `AOVS`.
    background
        The background of the picture.
    size
        Its width and height.

    Returns
    -------
    How
        The bits, and the AOVs in their usual order.

    Raises
    ------
    OutputError
        If it cannot, or a package is missing that is needed for it.
    """
    form = find_format(path)
    names = check_aov(aov)
    bits = form.bits[0] if bits is None else bits
    number = number_of(bits)
    if number not in form.bits:
        expected = " or ".join(map(str, form.bits))
        others = _endings(lambda other: number in other.bits)
        hint = f"; {others} can hold {bits}" if others else ""
        message = f"{path}: bits: expected {expected} for this format, got {bits!r}{hint}"
        raise OutputError(message)
    if names and not form.aov:
        able = _endings(lambda other: other.aov)
        message = f"{path}: aov: this format cannot hold {', '.join(names)}; {able} can"
        raise OutputError(message)
    if has_alpha(background) and not form.alpha:
        able = _endings(lambda other: other.alpha)
        message = (
            f"{path}: background: this format cannot be transparent; {able} can, "
            "or choose a color as the background"
        )
        raise OutputError(message)
    if max(size, default=1) > form.side:
        able = _endings(lambda other: max(size) <= other.side)
        message = (
            f"{path}: size: this format holds up to {form.side} pixels across and down, "
            f"got {max(size):.0f}; {able} can"
        )
        raise OutputError(message)
    _check_package(path, form.needs.get(bits))
    return How(int(bits), names)


def check_plain_format(path: Path, reason: str = "") -> None:
    """Raise OutputError if a format is not one for pixels of 8 bits and nothing else.

    Parameters
    ----------
    path
        The file.
    reason
        What the message ends with.
    """
    form = find_format(path)
    if form.aov:
        able = _endings(lambda other: not other.aov)
        message = f"{path}: this format is not for pixels alone; {able} are{reason}"
        raise OutputError(message)


def check_annotated_format(path: Path, bits: int | None = None) -> None:
    """Raise OutputError if a file cannot hold a picture with annotations, which has 8 bits."""
    check_plain_format(path, ", and a title, axes and all other annotations are such pixels")
    if bits is not None and number_of(bits) != 8:
        message = f"{path}: annotations: expected 8 bits with them, got {bits}"
        raise OutputError(message)


def check_aov(aov: Collection[str]) -> tuple[str, ...]:
    """Return the names of AOVs in their usual order, each once.

    Raises
    ------
    OutputError
        If one is none of them.
    """
    given = _listed(aov)
    for name in given:
        if not (isinstance(name, str) and name in AOVS):
            message = f"aov: expected names of {', '.join(AOVS)}, got {name!r}"
            raise OutputError(message)
    return tuple(name for name in AOVS if name in given)


def _listed(aov: object) -> list[object]:
    """Return what names of AOVs are given, or the one thing that is."""
    if isinstance(aov, str):
        return [aov]
    try:
        return list(aov)  # type: ignore[call-overload, no-any-return]
    except TypeError:
        return [aov]


def _check_package(path: Path, module: str | None) -> None:
    """Raise OutputError if a package is missing that a format needs."""
    if module is not None and importlib.util.find_spec(module) is None:
        raise OutputError(needs_package(path, module))


def needs_package(path: Path, module: str) -> str:
    """Return the message that a package is missing, and how to get it."""
    return f"{path}: this needs {module}; {pip_install(*PACKAGES['formats'])}"


def _endings(able: Callable[[Format], bool]) -> str:
    """Return the endings of the formats that are able to do something."""
    return ", ".join(ending for ending, form in FORMATS.items() if able(form))
