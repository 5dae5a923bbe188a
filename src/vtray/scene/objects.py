"""What a scene shows: single objects, many as arrays, and copies of these."""

from typing import TypeAlias

from vtray.scene.cones import Cones
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.single import Cone, Cylinder, Plane, Sphere
from vtray.scene.spheres import Spheres
from vtray.scene.stars import Stars

__all__ = ["ARRAY_KINDS", "Cone", "Cylinder", "Object", "Plane", "Sphere"]

Object: TypeAlias = Sphere | Cylinder | Cone | Plane | Spheres | Cylinders | Cones | Copies | Stars

ARRAY_KINDS = {str(kind.__struct_config__.tag): kind for kind in (Spheres, Cylinders, Cones)}
"""The kinds of many objects as arrays, by what a file calls them."""
