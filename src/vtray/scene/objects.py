"""What a scene shows: single objects, many as arrays, and copies of these."""

from typing import TypeAlias

from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.single import Cylinder, Plane, Sphere
from vtray.scene.spheres import Spheres

__all__ = ["ARRAY_KINDS", "Cylinder", "Object", "Plane", "Sphere"]

Object: TypeAlias = Sphere | Cylinder | Plane | Spheres | Cylinders | Copies

ARRAY_KINDS = {str(kind.__struct_config__.tag): kind for kind in (Spheres, Cylinders)}
"""The kinds of many objects as arrays, by what a file calls them."""
