"""The scene as arrays: what the kernels read."""

from typing import NamedTuple

from vtray.geometry.world import World
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.lights.light import Lights
from vtray.transport.materials.material import Materials


class SceneArrays(NamedTuple):
    """A scene as kernels see it."""

    camera: CameraFrame
    world: World
    lights: Lights
    materials: Materials
