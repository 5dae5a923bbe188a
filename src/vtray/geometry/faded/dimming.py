"""How much of the light of lamps the faded bodies on its way take."""

from vtray.base.compiler.compiled import device, part
from vtray.geometry.faded.fan_chords import can_go_together, collect_fan
from vtray.geometry.faded.layers import passed_share, share_of_list
from vtray.geometry.faded.nearby import Tube, touches_faded
from vtray.geometry.faded.shadow_rays import dim_some, list_open
from vtray.geometry.packets.cone import Cone
from vtray.geometry.packets.fan import BLOCKED as RAY_BLOCKED
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.layer_notes import MOST, SIDE_BY_SIDE, Walk
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    AIM,
    AIM_LENGTH,
    ERROR_SCALE,
    POINT,
    REACH,
    UNEVEN,
    Packet,
    load,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Segment
from vtray.geometry.stopped import Bundle, way_of
from vtray.geometry.vector import Vec
from vtray.geometry.world import Faded, World


@device
def dim_points(
    packet: Packet, hits: int, world: World, target: Target, is_wide: bool | None, work: Workspace
) -> None:
    """Let faded bodies take their share of a light, in field ``BLOCKED``.

    Parameters
    ----------
    packet, hits
        The hits, of which opaque shapes block some.
    world
        What is in the way.
    target
        The light.
    is_wide
        Whether it is asked if pixels look the same everywhere; None where it never is.
    work
        Scratch memory.
    """
    _dim_points(packet, hits, world, world.faded, target, is_wide, work)


@device
def _dim_points(
    packet: Packet,
    hits: int,
    world: World,
    faded: Faded | None,
    target: Target,
    is_wide: bool | None,
    work: Workspace,
) -> None:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is not None:
        waiting = work.walk.beside.hit
        count = list_open(packet, hits, target, work.walk.beside)
        for begin in range(0, count, SIDE_BY_SIDE):
            rays = min(SIDE_BY_SIDE, count - begin)
            dim_some(packet, begin, rays, world, faded, target, work.walk, work.stack)
        for k in range(count):
            _ask_around(packet, waiting[k], world, faded, is_wide, work.stack)


@device
def _ask_around(
    packet: Packet, hit: int, world: World, faded: Faded, is_wide: bool | None, stack: Stack
) -> None:
    """Mark a patch from which a light may be seen through a faded body, if that is asked."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide and packet[UNEVEN + hit] == 0.0:
            tube = Tube(
                load(packet, POINT, hit),
                load(packet, AIM, hit),
                packet[REACH + hit],
                0.0,
                packet[AIM_LENGTH + hit],
                packet[ERROR_SCALE + hit],
            )
            packet[UNEVEN + hit] = 1.0 if touches_faded(world, faded, tube, stack) else 0.0


@device
def blocked_share(world: World, segment: Segment, walk: Walk, stack: Stack) -> float:
    """Return which share of light the faded bodies between two points take."""
    return _blocked_share(world, world.faded, segment, walk, stack)


@device
def _blocked_share(
    world: World, faded: Faded | None, segment: Segment, walk: Walk, stack: Stack
) -> float:
    if faded is not None:
        return 1.0 - passed_share(world, faded, segment, walk, stack)
    return 0.0


@device
def may_be_dimmed(cone: Cone, world: World, stack: Stack) -> bool:
    """Tell whether a faded body may be in a cone of rays."""
    tangent = cone.sine / cone.cosine
    return is_tube_dimmed(world, cone.start, cone.axis, 0.0, tangent, cone.longest, stack)


@device
def is_tube_dimmed(
    world: World,
    start: Start,
    axis: Vec,
    width: float,
    growth: float,
    length: float,
    stack: Stack,
) -> bool:
    """Tell whether a faded body may be beside a way; see `Tube` for the parameters."""
    return _is_tube_dimmed(world, world.faded, start, axis, width, growth, length, stack)


@device
def _is_tube_dimmed(
    world: World,
    faded: Faded | None,
    start: Start,
    axis: Vec,
    width: float,
    growth: float,
    length: float,
    stack: Stack,
) -> bool:
    if faded is not None:
        tube = Tube(start.point, axis, width, growth, length, start.error_scale)
        return touches_faded(world, faded, tube, stack)
    return False


@device
def dim_fan(bundle: Bundle, world: World, walk: Walk, stack: Stack) -> None:
    """Let faded bodies take their share of the rays of a fan, in its field ``BLOCKED``.

    Parameters
    ----------
    bundle
        The rays, of which opaque shapes stop some.
    world
        What is in the way.
    walk, stack
        Scratch memory.
    """
    _dim_fan(bundle, world, world.faded, walk, stack)


@device
def _dim_fan(bundle: Bundle, world: World, faded: Faded | None, walk: Walk, stack: Stack) -> None:
    if faded is not None:
        dim_fan_by(bundle, world, faded, walk, stack)


@part
def dim_fan_by(bundle: Bundle, world: World, faded: Faded, walk: Walk, stack: Stack) -> None:
    """Let some faded bodies take their share of the rays of a fan."""
    fan, chords = bundle.fan, walk.chords
    together = can_go_together(bundle, world, faded)
    if together:
        collect_fan(bundle, world, faded, chords, stack)
    for ray in range(bundle.rays):
        if fan[RAY_BLOCKED + ray] == 0.0:
            if together and chords.found[ray] < MOST:
                passed = share_of_list(faded.bodies, ray, walk)
            else:
                segment = way_of(bundle, ray)
                passed = passed_share(world, faded, segment, walk, stack)
            fan[RAY_BLOCKED + ray] = 1.0 - passed
