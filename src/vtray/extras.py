"""Packages that are only needed for some things, and come with an extra of vtray."""

from importlib import import_module
from types import ModuleType

from vtray.errors import VtrayError


class ExtraError(VtrayError, ImportError):
    """A package is needed that is not installed."""


def need(module: str, extra: str, user: str) -> ModuleType:
    """Import a module of an extra.

    Parameters
    ----------
    module
        Its name, for instance ``"matplotlib.figure"``.
    extra
        The extra of vtray that installs it.
    user
        What needs it, to begin the message with.

    Raises
    ------
    ExtraError
        It is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        message = f"{user} needs {package}, which is not installed: pip install 'vtray[{extra}]'"
        raise ExtraError(message) from error
