"""vtray: an exact and fast ray tracer for spheres, cylinders, cones and planes.

import vtray

scene = vtray.load("scene.json")
image = vtray.render(scene)
image.save("scene.png")
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from vtray import colors, lights
    from vtray.animation.animate import animate, turntable
    from vtray.base.errors import OutputError, ProvenanceError, RenderError, SceneError, VtrayError
    from vtray.base.version import __version__
    from vtray.figures.comparison import compare
    from vtray.image.image import Image
    from vtray.image.provenance import Provenance, read_provenance
    from vtray.rendering.pixel_rays import trace_pixel
    from vtray.rendering.renderer import render
    from vtray.scene.clip import ClipPlane, Slice
    from vtray.scene.colors.color_scale import ColorScale
    from vtray.scene.cones import Cones
    from vtray.scene.copies import Copies
    from vtray.scene.cylinders import Cylinders
    from vtray.scene.files.scene_dict import load_dict
    from vtray.scene.files.scene_file import load, loads
    from vtray.scene.lens import Lens
    from vtray.scene.materials import Blend, Emissive, Glass, Lambert, Metal, Mirror, Plastic
    from vtray.scene.particles.from_objects import from_ase, from_mdanalysis
    from vtray.scene.particles.particles import Particles
    from vtray.scene.patterns import Checker, ImagePattern, Stripes
    from vtray.scene.readers.read import read, read_frames
    from vtray.scene.scene import (
        Ambient,
        Camera,
        Color,
        Cone,
        Cylinder,
        Direction,
        Gradient,
        Light,
        Plane,
        RectangleLight,
        Scene,
        Sky,
        Sphere,
        SphereLight,
        Sun,
        Vector,
    )
    from vtray.scene.settings import RenderSettings
    from vtray.scene.spheres import Spheres
    from vtray.scene.stars import Stars
    from vtray.scene.style import EyeDome, Fog, Outline, Style
else:  # whoever checks types would take any name for one of an object

    def __getattr__(name: str) -> object:
        if name not in _MODULES:
            message = f"module 'vtray' has no attribute {name!r}"
            raise AttributeError(message)
        from importlib import import_module

        module = import_module(f"vtray.{_MODULES[name]}")
        return module if name == _MODULES[name] else getattr(module, name)


__all__ = [
    "Ambient",
    "Blend",
    "Camera",
    "Checker",
    "ClipPlane",
    "Color",
    "ColorScale",
    "Cone",
    "Cones",
    "Copies",
    "Cylinder",
    "Cylinders",
    "Direction",
    "Emissive",
    "EyeDome",
    "Fog",
    "Glass",
    "Gradient",
    "Image",
    "ImagePattern",
    "Lambert",
    "Lens",
    "Light",
    "Metal",
    "Mirror",
    "Outline",
    "OutputError",
    "Particles",
    "Plane",
    "Plastic",
    "Provenance",
    "ProvenanceError",
    "RectangleLight",
    "RenderError",
    "RenderSettings",
    "Scene",
    "SceneError",
    "Sky",
    "Slice",
    "Sphere",
    "SphereLight",
    "Spheres",
    "Stars",
    "Stripes",
    "Style",
    "Sun",
    "Vector",
    "VtrayError",
    "__version__",
    "animate",
    "colors",
    "compare",
    "from_ase",
    "from_mdanalysis",
    "lights",
    "load",
    "load_dict",
    "loads",
    "read",
    "read_frames",
    "read_provenance",
    "render",
    "trace_pixel",
    "turntable",
]

# Nothing is loaded before it is first needed: neither NumPy nor the compiler, and for the command
# not even what reads a scene, so that Ctrl-C is taken care of first.
_MODULES = {
    "Ambient": "scene.light_types",
    "Blend": "scene.materials",
    "Camera": "scene.camera",
    "Checker": "scene.patterns",
    "ClipPlane": "scene.clip",
    "Color": "scene.vectors",
    "ColorScale": "scene.colors.color_scale",
    "Cone": "scene.objects",
    "Cones": "scene.cones",
    "Copies": "scene.copies",
    "Cylinder": "scene.objects",
    "Cylinders": "scene.cylinders",
    "Direction": "scene.vectors",
    "Emissive": "scene.materials",
    "EyeDome": "scene.style",
    "Fog": "scene.style",
    "Glass": "scene.materials",
    "Gradient": "scene.sky_types",
    "Image": "image.image",
    "ImagePattern": "scene.patterns",
    "Lambert": "scene.materials",
    "Lens": "scene.lens",
    "Light": "scene.light_types",
    "Metal": "scene.materials",
    "Mirror": "scene.materials",
    "Outline": "scene.style",
    "OutputError": "base.errors",
    "Particles": "scene.particles.particles",
    "Plane": "scene.objects",
    "Plastic": "scene.materials",
    "Provenance": "image.provenance",
    "ProvenanceError": "base.errors",
    "RectangleLight": "scene.light_types",
    "RenderError": "base.errors",
    "RenderSettings": "scene.settings",
    "Scene": "scene.scene",
    "SceneError": "base.errors",
    "Sky": "scene.light_types",
    "Slice": "scene.clip",
    "Sphere": "scene.objects",
    "SphereLight": "scene.light_types",
    "Spheres": "scene.spheres",
    "Stars": "scene.stars",
    "Stripes": "scene.patterns",
    "Style": "scene.style",
    "Sun": "scene.light_types",
    "Vector": "scene.vectors",
    "VtrayError": "base.errors",
    "__version__": "base.version",
    "animate": "animation.animate",
    "colors": "colors",
    "compare": "figures.comparison",
    "from_ase": "scene.particles.from_objects",
    "from_mdanalysis": "scene.particles.from_objects",
    "lights": "lights",
    "load": "scene.files.scene_file",
    "load_dict": "scene.files.scene_dict",
    "loads": "scene.files.scene_file",
    "read": "scene.readers.read",
    "read_frames": "scene.readers.read",
    "read_provenance": "image.provenance",
    "render": "rendering.renderer",
    "trace_pixel": "rendering.pixel_rays",
    "turntable": "animation.animate",
}
"""The module that each public name comes from."""


def __dir__() -> list[str]:
    """List what there is, loaded or not."""
    return sorted({*globals(), *__all__})
