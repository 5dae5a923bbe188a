"""Snapshots that simulations write into several files, such as ``snap_010.0.hdf5``."""

import os
import re

from vtray.base.errors import SceneError

_NAME = re.compile(r"(.*\.)(0|[1-9][0-9]*)(\.[^.]+)", re.DOTALL)


def files_of_snapshot(path: str, count: int) -> list[str]:
    """Return the files of a snapshot by the name of one of them.

    Parameters
    ----------
    path
        Of one file, whose number from 0 stands before the ending.
    count
        How many there are.

    Returns
    -------
    files : list of str
        In the order of their numbers; the one that was named if it has no such number, or no other
        is beside it.

    Raises
    ------
    SceneError
        Some are beside it, and one is missing.
    """
    name = os.path.basename(path)
    before = path[: len(path) - len(name)]
    match = _NAME.fullmatch(name)
    if count < 2 or match is None or int(match[2]) >= count:
        return [path]
    stem, _, ending = match.groups()
    # A file that is broken may claim to be one of any number.
    there = _numbers_in(before, stem, ending, count)
    if len(there) == 1:
        return [path]
    if len(there) < count:
        missing = next(k for k in range(count) if k not in there)
        others = count - len(there) - 1
        more = f", nor are {others} others" if others > 1 else ", nor is another" if others else ""
        problem = f"is one of the {count} files of its snapshot"
        raise SceneError(f"{problem}, of which {stem}{missing}{ending} is not beside it{more}")
    return [f"{before}{stem}{k}{ending}" for k in range(count)]


def _numbers_in(folder: str, stem: str, ending: str, count: int) -> set[int]:
    """Return which of so many numbers are in the names of files between a stem and an ending."""
    found = set()
    for name in os.listdir(folder or os.curdir):
        match = _NAME.fullmatch(name)
        if match is not None and (match[1], match[3]) == (stem, ending) and int(match[2]) < count:
            found.add(int(match[2]))
    return found
