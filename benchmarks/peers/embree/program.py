"""Embree: how it is given a scene, run and timed, by a small program of ours."""

import atexit
import functools
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from peers.host import host
from peers.peer import Peer, answer

HOST = Path(__file__).parents[1] / "host"
SOURCE = Path(__file__).with_name("embree_spheres.cpp")
COMPILER = ("g++", "-std=c++17", "-O3", "-march=native", "-mprefer-vector-width=512")
# Not -ffast-math: rays go to infinity.
FLAGS = ("-fno-math-errno", "-fno-trapping-math", "-fopenmp-simd")
LIBRARIES = ("-lembree3", "-lz", "-lpthread")


@functools.cache
def program() -> str | None:
    """Compile our program; return it, or None if the compiler or Embree is not there."""
    folder = tempfile.mkdtemp(prefix="vtray-embree-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    path = str(Path(folder) / "embree_spheres")
    done = answer([*COMPILER, *FLAGS, f"-I{HOST}", str(SOURCE), "-o", path, *LIBRARIES])
    return None if done is None else path


def version() -> str | None:
    """Return the version, or None if it is not installed."""
    path = program()
    found = answer([path, "--version"]) if path else None
    return found.split()[1] if found else None


def _command(*words: str) -> Callable[[Path, Path, int, tuple[int, int]], list[str]]:
    """Return what makes the command that renders a scene file."""

    def command(scene: Path, picture: Path, threads: int, _size: tuple[int, int]) -> list[str]:
        return [str(program()), "-t", str(threads), *words, str(scene), str(picture)]

    return command


def _peer(name: str, words: tuple[str, ...], how: str) -> Peer:
    return Peer(
        name=name,
        version=version,
        write_scene=host.write_scene,
        command=_command(*words),
        phases=host.phases,
        options=f"{how}; {' '.join(COMPILER)}",
        most_spheres=10_000_000,
    )


PACKETS = _peer("Embree", (), "rtcIntersect16, coherent; spheres are geometry of ours")
SINGLE = _peer("Embree, single rays", ("--single",), "rtcIntersect1; spheres are geometry of ours")
OWN = _peer("Embree, its own spheres", ("--own",), "rtcIntersect16, coherent; SPHERE_POINT")
