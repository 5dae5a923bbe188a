"""What a file of particles is by how it begins, where its name does not say it.

Only what begins like nothing else is told. The rows of a table are, as three numbers or the names
x, y and z.
"""

import contextlib
import re
from collections.abc import Callable
from typing import BinaryIO

from vtray.base.errors import SceneError
from vtray.base.input_file import is_given, open_input
from vtray.scene.particles.column_names import components_among
from vtray.scene.particles.particles import POSITION
from vtray.scene.particles.plain_numbers import is_overflow
from vtray.scene.readers.csv_columns import first_entries, without_comments
from vtray.scene.readers.packing import unpacking

_BEGINNING = 1 << 14
"""Bytes that are looked at."""

_VTK = re.compile(rb"# vtk DataFile|\s*(?:<\?xml[^>]*>\s*)?(?:<!--.*?-->\s*)*<VTKFile\b", re.DOTALL)

_DUMP = re.compile(r"ITEM: ")

_CIF = re.compile(r"(?:\s*#.*\n|\s*\n)*data_", re.IGNORECASE)

_PDB = re.compile(r"(?:HEADER|TITLE|REMARK|COMPND|CRYST1|MODEL|ATOM|HETATM) .{4,79}\n")

_ATOMS = re.compile(r"^\s*[0-9]+\s+atoms\s*(?:#.*)?$", re.MULTILINE)

_BOX = re.compile(r"^.*\s(?:xlo\s+xhi|avec)\s*(?:#.*)?$", re.MULTILINE)

_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][-+]?[0-9]+)?"

_NONE = re.compile(r"nan|[-+]?inf(?:inity)?", re.IGNORECASE)

_XYZ = re.compile(rf"\s*[0-9]+[ \t]*\n.*\n[ \t]*\S+(?:[ \t]+{_NUMBER}){{3}}(?!\S)")


def kind_of_content(path: str, packing: str) -> str | None:
    """Return what a file is by its beginning; None where nothing tells it.

    Parameters
    ----------
    path
        Its name. A pipe is not looked at, as it is read once.
    packing
        The ending of its name that says how it is compressed; "" if it is not.
    """
    content = _beginning(path, packing)
    if _VTK.match(content):  # which need be no text
        return "vtk"
    begin = _text_of(content)
    if begin is None or begin.lstrip().startswith("{"):  # a scene file
        return None
    return next((kind for kind, is_so in _KINDS.items() if is_so(begin)), None)


def is_table(begin: str) -> bool:
    """Tell whether a text begins with three numbers or more, or with the names x, y and z.

    Of the numbers, some may be none, infinite, or the stars of Fortran.
    """
    entries = [entry.strip() for entry in first_entries(without_comments(begin))]
    if components_among(entries):
        return True
    are_numbers = [bool(re.fullmatch(_NUMBER, entry)) for entry in entries]
    others = [e for e, is_one in zip(entries, are_numbers, strict=True) if not is_one]
    return (
        len(entries) >= len(POSITION)
        and any(are_numbers)
        and all(_NONE.fullmatch(entry) or is_overflow(entry) for entry in others)
    )


def beginning_of(file: BinaryIO) -> str | None:
    """Return the first lines of a file; None if it is no text."""
    return _text_of(file.read(_BEGINNING))


def _text_of(begin: bytes) -> str | None:
    """Return the whole lines of what a file begins with; None if it is no text."""
    if len(begin) == _BEGINNING:
        begin = begin[: begin.rfind(b"\n") + 1]
    try:
        return begin.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        return None


def _beginning(path: str, packing: str) -> bytes:
    """Return what a file begins with; nothing if it cannot be read."""
    if is_given(path):
        return b""
    with (
        contextlib.suppress(OSError, ValueError, SceneError),
        open_input(path) as file,
        unpacking(file, packing) as content,
    ):
        return content.read(_BEGINNING)
    return b""


def _is_data_of_lammps(begin: str) -> bool:
    """Tell whether a text begins as data files of LAMMPS do: with the number of atoms and a box."""
    return bool(_ATOMS.search(begin) and _BOX.search(begin))


_KINDS: dict[str, Callable[[str], object]] = {
    "lammps-dump": _DUMP.match,
    "cif": _CIF.match,
    "pdb": _PDB.match,
    "lammps-data": _is_data_of_lammps,
    "xyz": _XYZ.match,
    "csv": is_table,
}
"""What is told by the beginning, by the names of `vtray.scene.readers.reader_table`."""
