"""vtray: how it is run and timed, as a process like the others."""

import sys
from pathlib import Path

from timing.jobs import Phases, seconds_after

NAME = "vtray"


def executable() -> list[str]:
    """Return the command as installed beside this Python, or else as a module."""
    installed = Path(sys.executable).with_name("vtray")
    return [str(installed)] if installed.exists() else [sys.executable, "-m", "vtray"]


def command(scene: Path, picture: Path, threads: int) -> list[str]:
    """Return the command that renders a scene file."""
    return [*executable(), "--stats", "-t", str(threads), str(scene), str(picture)]


def phases(output: str) -> Phases:
    """Return the seconds of the steps that ``--stats`` printed; loading is reading and packing."""
    load = _seconds("read", output) + _seconds("pack", output)
    return Phases(load, _seconds("build", output), _seconds("trace", output))


def trace_seconds(output: str) -> float:
    """Return the seconds of tracing that ``--stats`` printed."""
    return _seconds("trace", output)


def compile_seconds(output: str) -> float:
    """Return the seconds of compiling, or of loading compiled kernels, that were printed."""
    return _seconds("compile", output)


def _seconds(step: str, output: str) -> float:
    return seconds_after(rf"^{step} +([0-9.]+) s$", output)
