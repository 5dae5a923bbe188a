"""A picture made again: the settings that its file tells, and what has changed since."""

import argparse
from collections.abc import Iterator

from vtray.base.errors import ProvenanceError
from vtray.base.version import __version__
from vtray.image.formats.image_format import find_format
from vtray.image.provenance import Provenance, read_provenance
from vtray.image.white import Exposed
from vtray.scene.scene import Scene
from vtray.scene.style import PICTURE


def take_over(options: argparse.Namespace) -> Provenance:
    """Set what the options leave open as the picture says that is replayed.

    Raises
    ------
    ProvenanceError
        If the picture does not say it, or something that is not understood.
    """
    told = read_provenance(options.replay)
    if told.lock is not None and options.exposure is None:
        if options.stops is not None:
            words = "its exposure is that of another picture, with its stops; give --exposure too"
            raise ProvenanceError(f"{options.replay}: {words}, or leave out --stops")
        options.lock = Exposed(told.lock)
    for name in PICTURE:
        decided = name == "exposure" and options.lock is not None
        if getattr(options, name) is None and not decided:
            setattr(options, name, told.told(name))
    if told.keep_lights and options.integrator == "direct":
        options.keep_lights = True
    if options.output is not None:
        # Another format than that of the picture may have other bits, and hold nothing beside it.
        held = find_format(options.output)
        if options.bits is None and told.bits in held.bits:
            options.bits = told.bits
        if options.aov is None and held.aov:
            options.aov = told.aov
    return told


def differences(told: Provenance, scene: Scene, *, is_painted: bool) -> Iterator[str]:
    """Say what is not as it was, so that the picture may be another.

    Parameters
    ----------
    told
        How the picture was made.
    scene
        The scene.
    is_painted
        Whether something is painted on the picture that is made now, or none is made.
    """
    from vtray.scene.fingerprint import scene_hash

    if told.partial is not None:
        share = f"{100 * told.partial:.0f} %"
        yield f"is a part of a picture, of whose tiles {share} were done: this one will be whole"
    if told.painted and not is_painted:
        words = "are not made again; give them too, by --title, --axes and the like, or in Python"
        yield f"title, legend and whatever else is painted on it {words} by image.annotated"
    if told.version != __version__:
        yield f"was made by vtray {told.version}, this is {__version__}: the picture may differ"
    if scene_hash(scene) not in (told.scene, told.shown):
        yield "was made from another scene, or this one has changed since: the picture will differ"
