"""vtray: an exact and fast ray tracer for spheres and planes.

import vtray

scene = vtray.load("scene.json")
image = vtray.render(scene)
image.save("scene.png")
"""

from importlib import import_module
from typing import TYPE_CHECKING

from vtray.errors import OutputError, ProvenanceError, RenderError, SceneError, VtrayError
from vtray.scene import Camera, Color, Direction, Light, Plane, Scene, Sphere, Vector
from vtray.scene_file import load, loads
from vtray.settings import RenderSettings
from vtray.spheres import Spheres
from vtray.version import __version__

if TYPE_CHECKING:
    from vtray.image import Image
    from vtray.provenance import Provenance, read_provenance
    from vtray.renderer import render

__all__ = [
    "Camera",
    "Color",
    "Direction",
    "Image",
    "Light",
    "OutputError",
    "Plane",
    "Provenance",
    "ProvenanceError",
    "RenderError",
    "RenderSettings",
    "Scene",
    "SceneError",
    "Sphere",
    "Spheres",
    "Vector",
    "VtrayError",
    "__version__",
    "load",
    "loads",
    "read_provenance",
    "render",
]

# The compiler is loaded when the first picture is rendered, not before.
_LAZY = {
    "Image": "vtray.image",
    "Provenance": "vtray.provenance",
    "read_provenance": "vtray.provenance",
    "render": "vtray.renderer",
}


def __getattr__(name: str) -> object:
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    message = f"module 'vtray' has no attribute {name!r}"
    raise AttributeError(message)
