"""Packages that are only needed for some things, and come with an extra of vtray."""

import sys
from importlib import import_module
from types import ModuleType

from vtray.base.errors import VtrayError

PACKAGES = {
    "atoms": ("ase", "gemmi", "gsd", "MDAnalysis"),
    "dask": ("distributed",),
    "denoise": ("pyoidn",),
    "diff": ("flip-evaluator",),
    "figure": ("matplotlib",),
    "formats": ("OpenEXR", "tifffile"),
    "movies": ("imageio-ffmpeg",),
    "points": ("laspy", "lazrs", "lz4", "plyfile"),
    "sky": ("OpenImageIO",),
    "tables": ("h5py", "pyarrow"),
}
"""What the extras install."""


class ExtraError(VtrayError, ImportError):
    """A package is needed that is not installed."""


def pip_install(*packages: str) -> str:
    """Return the command that installs packages where this Python finds them.

    It names neither vtray, which need not come from an index, nor the ``pip`` of the shell, which
    may be that of another Python.
    """
    import shlex

    return shlex.join([sys.executable or "python", "-m", "pip", "install", *packages])


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
        message = f"{user} needs {package}, which is not installed: {pip_install(*PACKAGES[extra])}"
        raise ExtraError(message) from error
