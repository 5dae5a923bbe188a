"""Which image formats there are."""

from pathlib import Path

from vtray.errors import OutputError

FORMATS = (".png",)
"""The endings of the formats that can be written; the first is for a name without an ending."""


def check_format(path: Path) -> str:
    """Return the format of a file by its ending; raise OutputError if there is none."""
    ending = path.suffix.lower() or FORMATS[0]
    if ending not in FORMATS:
        known = ", ".join(FORMATS)
        message = f'{path}: cannot write "{path.suffix}" files; the formats are {known}'
        raise OutputError(message)
    return ending
