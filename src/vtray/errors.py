"""The errors that a user may see."""


class VtrayError(Exception):
    """Base of all errors whose message is meant for the user."""


class SceneError(VtrayError, ValueError):
    """A scene, or a part of one, is not valid.

    The message names the place, what is wrong and what would be right.
    """


class RenderError(VtrayError):
    """A scene cannot be rendered."""


class OutputError(VtrayError):
    """A file cannot be written."""


class UsageError(VtrayError):
    """The command was called wrongly."""
