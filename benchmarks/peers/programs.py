"""The other renderers, beside which vtray is measured."""

from peers.embree import program as embree
from peers.mitsuba import program as mitsuba
from peers.ovito import program as ovito
from peers.peer import Peer
from peers.povray import program as povray
from peers.tachyon import program as tachyon

PEERS: tuple[Peer, ...] = (povray.PEER, tachyon.PEER, embree.PACKETS, mitsuba.PEER)
"""Those that render every scene."""
CUBE_PEERS: tuple[Peer, ...] = (
    embree.PACKETS,
    embree.SINGLE,
    embree.OWN,
    mitsuba.PEER,
    tachyon.PEER,
    povray.PEER,
    ovito.OSPRAY,
    ovito.TACHYON,
)
"""Those that render the cube of many spheres."""


def is_installed(peer: Peer) -> bool:
    """Tell whether a renderer is there."""
    return peer.version() is not None


def describe(peer: Peer) -> str:
    """Return the version of a renderer, or that it is missing."""
    return peer.version() or "not installed"
