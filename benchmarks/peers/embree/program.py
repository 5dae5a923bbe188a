"""Embree: how it is given a scene, run and timed, by small programs of ours."""

import atexit
import functools
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from peers.host import host, host_scene
from peers.host.soft_scene import SoftScene
from peers.peer import Peer, answer

HOST = Path(__file__).parents[1] / "host"
SPHERES, PATHS = "embree_spheres", "embree_paths"
"""Our programs: their sources are files of these names."""
COMPILER = ("g++", "-std=c++17", "-O3", "-march=native", "-mprefer-vector-width=512")
# Not -ffast-math: rays go to infinity.
FLAGS = ("-fno-math-errno", "-fno-trapping-math", "-fopenmp-simd")
LIBRARIES = ("-lembree3", "-lz", "-lpthread")


@functools.cache
def program(name: str = SPHERES) -> str | None:
    """Compile a program of ours; return it, or None if the compiler or Embree is not there."""
    folder = tempfile.mkdtemp(prefix="vtray-embree-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    source, path = Path(__file__).with_name(f"{name}.cpp"), str(Path(folder) / name)
    done = answer([*COMPILER, *FLAGS, f"-I{HOST}", str(source), "-o", path, *LIBRARIES])
    return None if done is None else path


def version() -> str | None:
    """Return the version, or None if it is not installed."""
    path = program()
    found = answer([path, "--version"]) if path else None
    return found.split()[1] if found else None


def write_paths_scene(given: SoftScene, path: Path) -> None:
    """Write a scene for `PATHS`, whose camera space is that of the picture's parallel rays."""
    corner = given.starts[0, 0]
    height, width, _ = given.starts.shape
    right, down = given.starts[0, 1] - corner, given.starts[1, 0] - corner
    across, along = np.linalg.norm(right), np.linalg.norm(down)
    axes = np.stack([right / across, -down / along, given.way])
    eye = corner + right * (width / 2) + down * (height / 2)
    spheres = np.column_stack([(given.spheres[:, :3] - eye) @ axes.T, given.spheres[:, 3]])
    floor = [*axes[:, 1], given.floor - eye[1], *(3 * [given.reflectance]), 0]
    scene = host_scene.HostScene(
        *(width, height, float(across), float(along), given.reflectance),
        planes=np.array([floor], np.float32),
        lights=np.zeros((0, 4), np.float32),
        spheres=spheres.astype(np.float32),
        color=np.zeros((0, 3), np.uint8),
    )
    host_scene.write_scene(scene, path)


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
