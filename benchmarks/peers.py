"""The other renderers, beside which vtray is measured."""

import shutil
import subprocess
from pathlib import Path
from typing import Protocol

import povray
import tachyon
from camera_space import View


class Peer(Protocol):
    """What a module about another renderer has."""

    NAME: str
    EXECUTABLE: str
    ENDING: str
    COLUMN: int
    OPTIONS: tuple[str, ...]
    VERSION_OPTION: str

    def export(self, view: View) -> str:
        """Write a scene in its language."""

    def command(self, scene: Path, picture: Path, threads: int, size: tuple[int, int]) -> list[str]:
        """Return the command that renders a scene file."""

    def trace_seconds(self, output: str) -> float:
        """Return the seconds that it says it traced rays, from what it printed."""

    def version(self, output: str) -> str:
        """Return the version, from what it prints when asked."""


_POVRAY: Peer = povray
_TACHYON: Peer = tachyon
PEERS = (_POVRAY, _TACHYON)


def is_installed(peer: Peer) -> bool:
    """Tell whether a renderer is there."""
    return shutil.which(peer.EXECUTABLE) is not None


def describe(peer: Peer) -> str:
    """Return the version of a renderer, or that it is missing."""
    if not is_installed(peer):
        return "not installed"
    asked = [peer.EXECUTABLE, peer.VERSION_OPTION]
    process = subprocess.run(asked, capture_output=True, text=True, check=False)
    return peer.version(process.stdout + process.stderr)
