"""The errors that a user may see."""


def printable(text: str) -> str:
    r"""Return a text as one line that a terminal shows and does not obey.

    File names, arguments and what files say may hold escapes, line breaks, or marks that turn the
    direction of writing; these become what Python writes for them, such as ``\x1b``.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


class VtrayError(Exception):
    """Base of all errors whose message is meant for the user: one line, and printable."""

    def __init__(self, message: str = "") -> None:
        super().__init__(printable(message))


class SceneError(VtrayError, ValueError):
    """A scene, or a part of one, is not valid.

    The message names the place, what is wrong and what would be right.
    """


class RenderError(VtrayError):
    """A scene cannot be rendered."""


class OutputError(VtrayError):
    """A file cannot be written."""


class ProvenanceError(VtrayError, ValueError):
    """A picture does not say how it was made, or nothing that is understood."""


class UsageError(VtrayError):
    """The command was called wrongly."""


class UnfitFileError(OSError):
    """A file is not of a kind or a size that can be read; its second argument says so."""


def why_unreadable(error: Exception, wanted: str) -> str:
    """Say why a file cannot be read, to follow its name.

    Parameters
    ----------
    error
        What opening or reading it raised.
    wanted
        What was expected instead, such as "scene file".
    """
    if isinstance(error, IsADirectoryError):
        return f"is a directory; expected a {wanted}"
    if isinstance(error, FileNotFoundError):
        return f"no such file; expected a {wanted}"
    if isinstance(error, PermissionError):
        return f"may not be read: permission denied; expected a readable {wanted}"
    if isinstance(error, UnfitFileError):
        return f"{error.strerror}; expected a {wanted}"
    if isinstance(error, MemoryError):
        return "is too large to hold in memory"
    return f"cannot be read: {getattr(error, 'strerror', None) or error}"
