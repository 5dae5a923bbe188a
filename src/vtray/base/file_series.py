"""Names that stand for several files, such as ``dump.*``."""

import glob
import os
import re

_PATTERN = re.compile(r"[*?\[]")

_NUMBER = re.compile("([0-9]+)")


def files_of(path: str) -> list[str]:
    """Return the files that a name stands for.

    Parameters
    ----------
    path
        A file; or, where there is none of that name, a pattern, in which ``*`` stands for any
        letters, ``?`` for one, and ``[0-4]`` for one of some.

    Returns
    -------
    files : list of str
        Those that match, by the numbers in their names, so that "dump.20" comes before "dump.100".
        The name itself if it is no pattern, or nothing matches.
    """
    if not stands_for_several(path) or "\0" in path or os.path.lexists(path):
        return [path]
    return sorted(filter(os.path.isfile, glob.glob(path)), key=_place) or [path]


def stands_for_several(path: str) -> bool:
    """Tell whether a name is a pattern, if no file has it."""
    return bool(_PATTERN.search(path))


def _place(path: str) -> list[tuple[str, int]]:
    """Return what files are ordered by: texts and numbers in turn; names that differ differ."""
    parts = [*_NUMBER.split(path), "0"]
    places = [(text, int(number)) for text, number in zip(parts[::2], parts[1::2], strict=True)]
    return [*places, (path, 0)]
