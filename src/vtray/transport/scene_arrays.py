"""The scene as arrays: what the kernels read."""

from typing import NamedTuple

from vtray.geometry.world import World
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.lights.light import Lights, no_lights
from vtray.transport.materials.material import Materials


class SceneArrays(NamedTuple):
    """A scene as kernels see it."""

    camera: CameraFrame
    world: World
    lights: Lights
    materials: Materials


def without_light(scene: SceneArrays) -> SceneArrays:
    """Return the same without its lights, where only surfaces are asked for.

    So their kernel is the same whatever the lights.
    """
    return scene._replace(lights=no_lights())
