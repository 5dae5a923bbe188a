"""Reads files of data: `vtray.read`, and frame by frame `vtray.read_frames`."""

import contextlib
import operator
import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.file_name import file_name
from vtray.base.file_series import files_of
from vtray.base.input_file import is_given, open_input
from vtray.base.memory import available_memory, readable
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.particles.from_columns import renamed
from vtray.scene.particles.particles import POSITION, Particles
from vtray.scene.readers.frames import Steps, no_such_frame
from vtray.scene.readers.reader_table import Given, reader_of
from vtray.scene.readers.unpacked import unpacked
from vtray.scene.readers.which_frames import which_frames

if TYPE_CHECKING:
    from vtray.scene.readers.which_frames import Frames

    AnyPath = str | os.PathLike[str]

_SLOW = ("ase_file", "cif_file")
"""The readers that pass over a frame by reading it."""

_BY_NAME = ("table_file", "ply_file", "hdf5_file")
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
        The file; or a pattern such as "dump.*", for files whose frames follow each other, in the
        order of the numbers in their names. The ending of a name says what a file is, or else how
        it begins; where neither does, the error lists the endings that are known. After that of a
        text, .gz, .bz2 or .xz may follow.
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
    name = file_name(path, SceneError)
    with _explained(name):
        number = _whole(frame)
    files = files_of(name)
    if len(files) > 1:
        chosen = read_frames(path, [number], format=format, columns=columns, trajectory=trajectory)
        return next(chosen)
    (file,) = files
    with _explained(file), _opened(file, format, columns, trajectory) as (module, given):
        found: Particles = module.read(given._replace(frame=number))
        return _finished(found, given, file)


@explain_unknown
def read_frames(
    path: "AnyPath",
    frames: "Frames" = None,
    *,
    format: str | None = None,  # noqa: A002
    columns: Mapping[str, str] | None = None,
    trajectory: "AnyPath | None" = None,
) -> Iterator[Particles]:
    """Read frames of a file, one after the other: each when it is asked for.

    The file is gone through once, however many frames there are, and one frame is in memory.

    Parameters
    ----------
    path, format, columns, trajectory
        As for `read`.
    frames
        Which ones: ``"0:500:5"``, a slice or a range for those that there are among them, as Python
        takes slices; or their numbers, in a list. All by default. Those before another are found by
        going through the file again.

    Yields
    ------
    Particles
        As `read` returns them.

    Raises
    ------
    SceneError
        As `read` does; the first frame that cannot be read ends it.

    Examples
    --------
    >>> import vtray
    >>> for particles in vtray.read_frames("run.xyz", "::10"):  # doctest: +SKIP
    ...     print(particles.frame, len(particles))
    """
    wanted = iter(numbers_of(path, frames, format=format, columns=columns, trajectory=trajectory))
    yield from read_numbers(path, wanted, format=format, columns=columns, trajectory=trajectory)


def read_numbers(
    path: "AnyPath",
    wanted: Iterator[int],
    *,
    format: str | None = None,  # noqa: A002
    columns: Mapping[str, str] | None = None,
    trajectory: "AnyPath | None" = None,
) -> Iterator[Particles]:
    """Read frames by their numbers from 0, each of which is asked for when the last is read.

    The other arguments, and what is given, are those of `read_frames`.
    """
    name = file_name(path, SceneError)
    number = next(wanted, None)
    while number is not None:
        at = -1
        with contextlib.closing(_frames_in(name, format, columns, trajectory)) as frames:
            for at, read_frame in enumerate(frames):
                if at == number:
                    found = read_frame()
                    yield found if found.frame == at else replace(found, frame=at)
                    number = next(wanted, None)
                    # What follows the last frame that is wanted is not looked at.
                    if number is None or number <= at:
                        break
            else:
                with _explained(name):
                    raise no_such_frame(number, at + 1)


def numbers_of(
    path: "AnyPath",
    frames: "Frames" = None,
    *,
    format: str | None = None,  # noqa: A002
    columns: Mapping[str, str] | None = None,
    trajectory: "AnyPath | None" = None,
) -> Sequence[int]:
    """Return the numbers of frames of a file, from 0; the arguments are those of `read_frames`."""
    name = file_name(path, SceneError)
    wrong: list[SceneError] = []  # what is wrong with a file, whose name it has already

    def count() -> int:
        if is_given(path) and not os.path.isfile(path):
            problem = "frames of a pipe cannot be counted, as it is read once"
            raise SceneError(f"{problem}; expected a file, or numbers of frames such as 0")
        try:
            return sum(1 for _ in _frames_in(name, format, columns, trajectory))
        except SceneError as error:
            wrong.append(error)
            raise

    try:
        return which_frames(frames, count)
    except SceneError as error:
        raise error if error in wrong else SceneError(f"{name}: {error}") from None


def is_slow(
    path: "AnyPath",
    *,
    format: str | None = None,  # noqa: A002
    columns: Mapping[str, str] | None = None,  # noqa: ARG001
    trajectory: "AnyPath | None" = None,
) -> bool:
    """Tell whether a frame is only passed over by reading it; the arguments are those of `read`."""
    name = file_name(path, SceneError)
    with _explained(name):
        _, reader = reader_of(files_of(name)[0], format if trajectory is None else "mdanalysis")
    return reader.module in _SLOW


def _frames_in(
    name: str,
    format: str | None,  # noqa: A002
    columns: Mapping[str, str] | None,
    trajectory: "AnyPath | None",
) -> Generator[Callable[[], Particles], None, None]:
    """Give what reads each frame of the files that a name stands for, one after the other."""

    def finished(step: Callable[[], Particles], given: Given, file: str) -> Particles:
        with _explained(file):
            return _finished(step(), given, file)

    files = files_of(name)
    read: set[str] = set()
    for file in files:
        if file in read:  # with another, as a part of its frame
            continue
        with _explained(file), _opened(file, format, columns, trajectory) as (module, given):
            if len(files) > 1 and hasattr(module, "read_as_one"):
                read.update(module.read_as_one(given))
            for step in _steps(module, given):
                yield partial(finished, step, given, file)


def _steps(module: Any, given: Given) -> Steps:  # noqa: ANN401
    """Give what reads each frame of a file; most formats have one."""
    if hasattr(module, "steps"):
        found: Steps = module.steps(given)
        return found
    return iter([lambda: module.read(given)])


@contextlib.contextmanager
def _opened(
    path: "AnyPath",
    format: str | None,  # noqa: A002
    columns: Mapping[str, str] | None,
    trajectory: "AnyPath | None",
) -> "Iterator[tuple[Any, Given]]":
    """Give the module that reads a file, and what it is given, for its first frame."""
    name = file_name(path, SceneError)
    kind, reader = reader_of(name, format if trajectory is None else "mdanalysis")
    module = import_module(f"vtray.scene.readers.{reader.module}")
    second = None if trajectory is None else file_name(trajectory, SceneError, "trajectory")
    called = _names(columns)
    with open_input(path) as file:
        named = Given(file, name, kind, 0, called, second)
        with unpacked(named, reader.module, reader.what) as given:
            yield module, given


@contextlib.contextmanager
def _explained(name: str) -> Iterator[None]:
    """Turn what goes wrong with a file into a SceneError that begins with its name."""
    try:
        yield
    except SceneError as error:
        raise SceneError(f"{name}: {error}") from None
    except MemoryError as error:
        raise SceneError(f"{name}: {_too_large(error)}") from None
    except (OSError, ValueError) as error:  # a path with a null byte is a ValueError
        raise SceneError(f"{name}: {why_unreadable(error, 'file of data')}") from None


def _finished(found: Particles, given: Given, file: str) -> Particles:
    """Return what was read with the names that were asked for, and where it comes from."""
    _, reader = reader_of(given.path, given.format)
    if given.columns and reader.module not in _BY_NAME:
        found = _with_names(found, given.columns)
    return replace(found, source=Path(file))


def _names(columns: Mapping[str, str] | None) -> Mapping[str, str]:
    """Return what files call columns, by what these are to be called."""
    if columns is None:
        return {}
    if not isinstance(columns, Mapping) or not all(
        isinstance(name, str) for pair in columns.items() for name in pair
    ):
        example = "{'x': 'px'}"
        raise SceneError(f"columns: expected names, such as {example}, got {short(repr(columns))}")
    return columns


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
    whole = columns.pop("position") if "position" in called else found.positions
    positions = whole.copy()
    for index, name in enumerate(POSITION):
        if name in columns:
            positions[:, index] = columns.pop(name)
    return replace(found, positions=positions, columns=columns)
