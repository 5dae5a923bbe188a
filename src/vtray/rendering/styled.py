"""The arrays of a scene with what a style says of them."""

from vtray.rendering.fog import with_fog
from vtray.rendering.pack import Packed
from vtray.scene.style import Style


def styled(packed: Packed, style: Style) -> Packed:
    """Return the arrays of a scene in a style whose fog has both its distances."""
    packed = with_fog(packed, style)
    world = packed.arrays.world
    if world.faded is None:
        return packed
    world = world._replace(faded=world.faded._replace(least=style.solid_from))
    return packed._replace(arrays=packed.arrays._replace(world=world))
