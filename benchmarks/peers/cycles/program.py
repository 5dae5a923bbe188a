"""Cycles, Blender's path tracer: how it is run, by a script of ours."""

import os
from pathlib import Path

from peers.peer import answer

NAME = "Cycles"
SCRIPT = Path(__file__).with_name("cycles_paths.py")


def python() -> str:
    """Return the Python that has Blender, whose NumPy is older than that of the other peers.

    `make cycles` makes it; the variable VTRAY_CYCLES names another.
    """
    folder = Path(os.environ.get("VTRAY_CYCLES", Path(__file__).parents[2] / ".venv-cycles"))
    return str(folder / "bin" / "python")


def version() -> str | None:
    """Return the version of Blender, or None if it is not installed."""
    found = answer([python(), str(SCRIPT), "--version"])
    return found.split()[0] if found else None
