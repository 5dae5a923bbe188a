"""Reads files of data: `vtray.read`."""

import operator
import os
from collections.abc import Mapping
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, SupportsIndex

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.input_file import open_input
from vtray.base.memory import available_memory, readable
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.particles.from_columns import renamed
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers.reader_table import Given, reader_of
from vtray.scene.readers.unpacked import unpacked

if TYPE_CHECKING:
    AnyPath = str | os.PathLike[str]

_BY_NAME = ("table_file", "ply_file")
"""The readers that find the places by the names of their columns."""


@explain_unknown
def read(
    path: "AnyPath",
    frame: int = 0,
    *,
    format: str | None = None,  # noqa: A002  as NumPy, ASE and others call it
    columns: Mapping[str, str] | None = None,
    trajectory: "AnyPath | None" = None,
) -> Particles:
    """Read particles from a file of data: atoms, colloids, stars, points of a scan.

    Parameters
    ----------
    path
        The file. The ending of its name says what it is; an unknown one is an error that lists
        those that are known. After that of a text, .gz, .bz2 or .xz may follow.
    frame
        Which of its frames, from 0; a negative one counts from the end, so that -1 is the last.
    format
        What the file is, where its name does not say so: "xyz", for instance.
    columns
        For some columns, what the file calls them: ``{"x": "px", "radius": "r"}``.
    trajectory
        A file with the places of all frames, where `path` says only what the atoms are, such as
        "run.xtc" beside "top.pdb"; read by MDAnalysis.

    Returns
    -------
    Particles
        In the units of the file, and in its order.

    Raises
    ------
    SceneError
        The file cannot be read, is not right, or has no such frame. The message names the file, the
        line or the frame, and what was expected.
    ExtraError
        A package is needed that is not installed. The message has the command that installs it.

    Examples
    --------
    >>> import vtray
    >>> particles = vtray.read("water.xyz")  # doctest: +SKIP
    >>> last = vtray.read("run.xyz", frame=-1)  # doctest: +SKIP
    """
    name = os.fsdecode(path)
    try:
        kind, reader = reader_of(name, format if trajectory is None else "mdanalysis")
        module = import_module(f"vtray.scene.readers.{reader.module}")
        second = None if trajectory is None else os.fsdecode(trajectory)
        with open_input(path) as file:
            named = Given(file, name, kind, _whole(frame), columns or {}, second)
            with unpacked(named, reader.module, reader.what) as given:
                found: Particles = module.read(given)
        if columns and reader.module not in _BY_NAME:
            found = _with_names(found, columns)
    except SceneError as error:
        raise SceneError(f"{name}: {error}") from None
    except MemoryError as error:
        raise SceneError(f"{name}: {_too_large(error)}") from None
    except (OSError, ValueError) as error:  # a path with a null byte is a ValueError
        raise SceneError(f"{name}: {why_unreadable(error, 'file of data')}") from None
    return replace(found, source=Path(name))


def _whole(frame: SupportsIndex) -> int:
    """Return a number of a frame as an integer."""
    try:
        return operator.index(frame)
    except TypeError:
        raise SceneError(f"frame: expected an integer, got {short(repr(frame))}") from None


def _too_large(error: MemoryError) -> str:
    """Say how much memory was asked for, as far as that is known, and how much there is."""
    # NumPy says: "Unable to allocate 7.28 TiB for an array with shape ...".
    _, _, asked = str(error).partition("Unable to allocate ")
    needed = f"it needs {' '.join(asked.split()[:2])} at least, " if asked else ""
    there = f"{readable(available_memory())} of memory is available"
    return f"is too large to hold in memory: {needed}{there}"


def _with_names(found: Particles, called: Mapping[str, str]) -> Particles:
    """Give columns the names that were asked for, those of the places too."""
    columns = renamed(found.columns, called)
    positions = found.positions.copy()
    for index, name in enumerate(POSITION):
        if name in columns:
            positions[:, index] = columns.pop(name)
    return replace(found, positions=positions, columns=columns)
