"""Warnings, in the name of the code that has called vtray."""

import sys


def warn_caller(message: str) -> None:
    """Warn in the place where something that is not vtray has called it, however far away.

    That is a line of a user's program, which is where the remedy belongs; `warnings` shows it
    beside the message, and shows each such place once.
    """
    import warnings

    frame, level = sys._getframe(1), 2  # noqa: SLF001 - as `warnings` itself looks for it
    while frame.f_back is not None and _is_own(frame.f_globals.get("__name__", "")):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, stacklevel=level)


def _is_own(module: str) -> bool:
    return module.partition(".")[0] == "vtray"
