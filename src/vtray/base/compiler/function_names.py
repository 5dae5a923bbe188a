"""Names of functions."""

from collections.abc import Callable

OWN = "vtray."
"""What the names of vtray's own functions begin with."""

_LOCAL = "<locals>"


class UnnamedError(Exception):
    """A function, or a type that holds one, has no name that is the same in all processes."""


def full_name(function: Callable[..., object]) -> str:
    """Return the name of a function with that of its module."""
    return f"{function.__module__}.{function.__qualname__}"


def check_own(name: str) -> None:
    """Raise UnnamedError if a name is not that of one of vtray's functions."""
    if not name.startswith(OWN) or _LOCAL in name:
        raise UnnamedError
