"""The arrays of a scene with what a style says of them."""

from dataclasses import replace

from vtray.rendering.fog import with_fog
from vtray.rendering.pack import Packed
from vtray.scene.style import Style


def styled(packed: Packed, style: Style) -> Packed:
    """Return the arrays of a scene in a style whose fog has both its distances."""
    return with_solid_from(with_fog(packed, style), style.solid_from)


def with_solid_from(packed: Packed, least: float) -> Packed:
    """Return the arrays of a scene in which what is more opaque than that counts as solid."""
    world = packed.arrays.world
    if world.faded is None:
        return packed
    world = world._replace(faded=world.faded._replace(least=least))
    return replace(packed, arrays=packed.arrays._replace(world=world))
