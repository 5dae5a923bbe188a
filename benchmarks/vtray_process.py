"""vtray: how it is run and timed, as a process like the others."""

import re
import sys
from pathlib import Path

NAME = "vtray"


def executable() -> list[str]:
    """Return the command as installed beside this Python, or else as a module."""
    installed = Path(sys.executable).with_name("vtray")
    return [str(installed)] if installed.exists() else [sys.executable, "-m", "vtray"]


def command(scene: Path, picture: Path, threads: int) -> list[str]:
    """Return the command that renders a scene file."""
    return [*executable(), "--stats", "-t", str(threads), str(scene), str(picture)]


def trace_seconds(output: str) -> float:
    """Return the seconds of tracing that ``--stats`` printed."""
    return _seconds("trace", output)


def compile_seconds(output: str) -> float:
    """Return the seconds of compiling, or of loading compiled kernels, that were printed."""
    return _seconds("compile", output)


def _seconds(step: str, output: str) -> float:
    found = re.search(rf"^{step} +([0-9.]+) s$", output, re.MULTILINE)
    return float(found[1]) if found else float("nan")
