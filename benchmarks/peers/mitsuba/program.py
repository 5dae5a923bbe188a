"""Mitsuba 3: how it is given a scene, run and timed, by a script of ours."""

from pathlib import Path

from peers.host import host
from peers.peer import Peer, python_of_peers, version_of_host

SCRIPT = Path(__file__).with_name("mitsuba_spheres.py")


def command(scene: Path, picture: Path, threads: int, _size: tuple[int, int]) -> list[str]:
    """Return the command that renders a scene file."""
    return [python_of_peers(), str(SCRIPT), str(threads), str(scene), str(picture)]


PEER = Peer(
    name="Mitsuba",
    version=lambda: version_of_host(SCRIPT),
    write_scene=host.write_scene,
    command=command,
    phases=host.phases,
    options="llvm_ad_rgb, ellipsoids, shading in Dr.Jit; lengths in radii",
    most_spheres=10_000_000,
)
