"""The other renderers, beside which vtray is measured."""

import embree
import mitsuba_peer
import ovito_peer
import povray
import tachyon
from peer import Peer

PEERS: tuple[Peer, ...] = (povray.PEER, tachyon.PEER, embree.PACKETS, mitsuba_peer.PEER)
"""Those that render every scene."""
CUBE_PEERS: tuple[Peer, ...] = (
    embree.PACKETS,
    embree.SINGLE,
    embree.OWN,
    mitsuba_peer.PEER,
    tachyon.PEER,
    povray.PEER,
    ovito_peer.OSPRAY,
    ovito_peer.TACHYON,
)
"""Those that render the cube of many spheres."""


def is_installed(peer: Peer) -> bool:
    """Tell whether a renderer is there."""
    return peer.version() is not None


def describe(peer: Peer) -> str:
    """Return the version of a renderer, or that it is missing."""
    return peer.version() or "not installed"
