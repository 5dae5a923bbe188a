"""OVITO: how it is given spheres, run and timed, by a script of ours."""

from collections.abc import Callable
from pathlib import Path

from peers.host import host
from peers.peer import Peer, python_of_peers, version_of_host

SCRIPT = Path(__file__).with_name("ovito_spheres.py")


def _command(renderer: str) -> Callable[[Path, Path, int, tuple[int, int]], list[str]]:
    """Return what makes the command that renders a scene file."""

    def command(scene: Path, picture: Path, threads: int, _size: tuple[int, int]) -> list[str]:
        arguments = [renderer, str(threads), str(scene), str(picture)]
        return [python_of_peers(), str(SCRIPT), *arguments]

    return command


def _peer(name: str, renderer: str, options: str) -> Peer:
    return Peer(
        name=name,
        version=lambda: version_of_host(SCRIPT),
        write_scene=host.write_scene,
        command=_command(renderer),
        phases=host.phases,
        options=options,
        apart="it has no lights of one's own and no floor",
    )


TACHYON = _peer("OVITO, Tachyon", "tachyon", "1 ray per pixel, shadows, no ambient occlusion")
OSPRAY = _peer("OVITO, OSPRay", "ospray", "1 ray per pixel, 1 bounce, no denoising")
