"""The scene as arrays: what the kernels read."""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import Packet, new_packet
from vtray.geometry.packets.workspace import Workspace, new_workspace
from vtray.geometry.vector import Vec
from vtray.geometry.world import World
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.fog import FogFrame
from vtray.transport.lights.crowd import sharing_lights
from vtray.transport.lights.light import Lights, Powers, no_lights, powers_of
from vtray.transport.materials.material import Materials


class SceneArrays(NamedTuple):
    """A scene as kernels see it; its fog is None if there is none."""

    camera: CameraFrame
    world: World
    lights: Lights
    materials: Materials
    fog: FogFrame | None = None


class LitWorld(NamedTuple):
    """What lights need of a scene, whatever kinds of lights it has.

    Attributes
    ----------
    world
        What rays can meet.
    forward
        The unit direction in which the camera looks.
    powers
        How strong the lights are.
    """

    world: World
    forward: Vec
    powers: Powers


class PathWorld(NamedTuple):
    """What paths need of a scene, whatever kind of camera it has.

    Attributes
    ----------
    world, lights, materials
        Those of the scene.
    forward
        The unit direction in which the camera looks.
    """

    world: World
    lights: Lights
    materials: Materials
    forward: Vec


@device
def lit_world(scene: SceneArrays) -> LitWorld:
    """Return what lights need of a scene."""
    return LitWorld(scene.world, scene.camera.forward, powers_of(scene.lights))


@device
def path_world(scene: SceneArrays) -> PathWorld:
    """Return what paths need of a scene."""
    return PathWorld(scene.world, scene.lights, scene.materials, scene.camera.forward)


def without_light(scene: SceneArrays) -> SceneArrays:
    """Return the same without lights, fog and a lens, where only surfaces are asked for.

    So their kernel is the same whatever the lights.
    """
    return with_pinhole(scene)._replace(lights=no_lights(), fog=None)


def with_pinhole(scene: SceneArrays) -> SceneArrays:
    """Return the same with a pinhole in the place of the lens, where all is sharp."""
    return scene._replace(camera=scene.camera._replace(lens=None))


def new_memory(scene: SceneArrays) -> tuple[Packet, Workspace]:
    """Return the memory in which one thread follows the rays of a scene."""
    looks = scene.materials.looks
    # Over how many surfaces; -1 if over none.
    depth = -1 if looks is None else looks.depth
    return new_packet(), new_workspace(scene.world, sharing_lights(scene.lights.crowd), depth)
