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
    from vtray import colors, lights
    from vtray.color_scale import ColorScale
    from vtray.comparison import compare
    from vtray.image import Image
    from vtray.pixel_rays import trace_pixel
    from vtray.provenance import Provenance, read_provenance
    from vtray.renderer import render
    from vtray.scene_dict import load_dict

__all__ = [
    "Camera",
    "Color",
    "ColorScale",
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
    "colors",
    "compare",
    "lights",
    "load",
    "load_dict",
    "loads",
    "read_provenance",
    "render",
    "trace_pixel",
]

# NumPy is loaded when it is first needed, and the compiler when the first picture is rendered.
_LAZY = {
    "ColorScale": "vtray.color_scale",
    "Image": "vtray.image",
    "Provenance": "vtray.provenance",
    "compare": "vtray.comparison",
    "load_dict": "vtray.scene_dict",
    "read_provenance": "vtray.provenance",
    "render": "vtray.renderer",
    "trace_pixel": "vtray.pixel_rays",
}
_LAZY_MODULES = ("colors", "lights")


def __getattr__(name: str) -> object:
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    if name in _LAZY_MODULES:
        return import_module(f"vtray.{name}")
    message = f"module 'vtray' has no attribute {name!r}"
    raise AttributeError(message)


def __dir__() -> list[str]:
    """List what there is, loaded or not."""
    return sorted({*globals(), *__all__})
