"""What the folder of another renderer says of it."""

import functools
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from peers.camera_space import View
from timing.jobs import Phases


@dataclass(frozen=True)
class Peer:
    """Another renderer.

    Attributes
    ----------
    name
        What the results call it; one of a kind.
    version
        Returns its version, or None if it is not installed.
    write_scene
        Writes a scene into a folder as the renderer reads it; returns the file.
    command
        Returns the command that renders a scene file: from the scene, the picture, the number of
        threads, and width and height in pixels.
    phases
        Finds, in what it prints, how long the parts of a render took.
    options
        How it is run, besides files, size and threads.
    column
        Which of vtray's columns its first one is.
    most_spheres
        With how many spheres it still fits into the memory of an ordinary computer.
    apart
        Why its picture cannot be vtray's, and its times stand apart; "" if it can.
    """

    name: str
    version: Callable[[], str | None]
    write_scene: Callable[[View, Path], Path]
    command: Callable[[Path, Path, int, tuple[int, int]], list[str]]
    phases: Callable[[str], Phases]
    options: str
    column: int = 0
    most_spheres: int = 1_000_000
    apart: str = ""


def answer(command: Sequence[str], statuses: Sequence[int] = (0,)) -> str | None:
    """Return what a program prints, or None if it is not there or ends with another status."""
    try:
        process = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
        )
    except OSError:
        return None
    return process.stdout + process.stderr if process.returncode in statuses else None


def python_of_peers() -> str:
    """Return the Python that has the peers' packages, in an environment of their own.

    `make peers` makes it; the variable VTRAY_PEERS names another.
    """
    folder = Path(os.environ.get("VTRAY_PEERS", Path(__file__).parents[1] / ".venv"))
    return str(folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python"))


@functools.cache
def version_of_host(script: Path) -> str | None:
    """Return the version that a script for the peers' Python prints, or None if it cannot run."""
    found = answer([python_of_peers(), str(script), "--version"])
    return found.split()[0] if found else None
