"""vtray: an exact and fast ray tracer for spheres and planes.

import vtray

scene = vtray.load("scene.json")
image = vtray.render(scene)
image.save("scene.png")
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from vtray import colors, lights
    from vtray.color_scale import ColorScale
    from vtray.comparison import compare
    from vtray.errors import OutputError, ProvenanceError, RenderError, SceneError, VtrayError
    from vtray.image import Image
    from vtray.pixel_rays import trace_pixel
    from vtray.provenance import Provenance, read_provenance
    from vtray.renderer import render
    from vtray.scene import Camera, Color, Direction, Light, Plane, Scene, Sphere, Vector
    from vtray.scene_dict import load_dict
    from vtray.scene_file import load, loads
    from vtray.settings import RenderSettings
    from vtray.spheres import Spheres
    from vtray.version import __version__

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

# Nothing is loaded before it is first needed: neither NumPy nor the compiler, and for the command
# not even what reads a scene, so that Ctrl-C is taken care of first.
_MODULES = {
    "Camera": "cameras",
    "Color": "triples",
    "ColorScale": "color_scale",
    "Direction": "triples",
    "Image": "image",
    "Light": "objects",
    "OutputError": "errors",
    "Plane": "objects",
    "Provenance": "provenance",
    "ProvenanceError": "errors",
    "RenderError": "errors",
    "RenderSettings": "settings",
    "Scene": "scene",
    "SceneError": "errors",
    "Sphere": "objects",
    "Spheres": "spheres",
    "Vector": "triples",
    "VtrayError": "errors",
    "__version__": "version",
    "colors": "colors",
    "compare": "comparison",
    "lights": "lights",
    "load": "scene_file",
    "load_dict": "scene_dict",
    "loads": "scene_file",
    "read_provenance": "provenance",
    "render": "renderer",
    "trace_pixel": "pixel_rays",
}
"""The module that each public name comes from."""


def __getattr__(name: str) -> object:
    if name not in _MODULES:
        message = f"module 'vtray' has no attribute {name!r}"
        raise AttributeError(message)
    from importlib import import_module

    module = import_module(f"vtray.{_MODULES[name]}")
    return module if name == _MODULES[name] else getattr(module, name)


def __dir__() -> list[str]:
    """List what there is, loaded or not."""
    return sorted({*globals(), *__all__})
