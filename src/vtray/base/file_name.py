"""Names of files, as they are given."""

import os

from vtray.base.errors import VtrayError


def file_name(given: object, error: type[VtrayError], place: str = "path") -> str:
    """Return the name of a file.

    Parameters
    ----------
    given
        A text, bytes, or what stands for a path.
    error
        What is raised if no file can have such a name.
    place
        What messages begin with where there is no name.
    """
    try:
        name = os.fsdecode(given)  # type: ignore[arg-type]
    except TypeError:
        kind = type(given).__name__
        raise error(f"{place}: expected the name of a file, got an object of {kind}") from None
    if not name:
        raise error(f"{place}: expected the name of a file, got an empty one")
    try:
        os.fsencode(name)
    except UnicodeEncodeError as problem:
        wrong = name[problem.start]
        raise error(f"{name}: no file name may hold the character {wrong!r}") from None
    return name
