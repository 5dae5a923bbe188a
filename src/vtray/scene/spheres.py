"""Many spheres as arrays."""

from types import MappingProxyType
from typing import TYPE_CHECKING

from vtray.scene.arrays import Arrays, Bytes, Floats
from vtray.scene.checks.columns import (
    COLOR,
    LAMBERT,
    MATERIAL_INDEX,
    METALNESS,
    OPACITY,
    POINT,
    RADIUS,
    ROUGHNESS,
)
from vtray.scene.materials import AnyMaterials

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from vtray.scene.materials import AnyMaterial


class Spheres(Arrays, frozen=True, eq=False, dict=True, tag_field="type", tag="spheres"):
    """Many spheres with matt surfaces, as arrays.

    An array may be anything that NumPy makes an array of: its own arrays, those of other packages
    (by ``__array__`` or ``__dlpack__``), or lists. An array of a dtype named below is not copied,
    in whatever order it lies in memory: the attribute is then a read-only view of it, and changes
    when it is changed; `Scene.check` looks at it again. The colour is white and `lambert` 1 unless
    they are given.

    Attributes
    ----------
    center : array (n, 3)
        Centres in world space, finite; float64 or float32 as given, all else becomes float64.
        There may be none.
    radius : array (n,) or float
        Radii in scene units, ≥ 0, or one for all; float64 or float32 as given.
    color : array (n, 3) or (3,)
        Colours, or one for all, as uint8; whole numbers from 0 to 255 of any other dtype are
        converted, and `Color` is one colour.
    lambert : array (n,) or float
        Share of the light that each surface scatters, from 0 to 1, or one for all; float64 or
        float32 as given.
    opacity : array (n,) or float, or None
        Share of the light that each takes on its way through, from 0 to 1, or one for all; float64
        or float32 as given. None for 1. Those of one opacity that overlap are one body.
    roughness, metalness : array (n,) or float, or None
        How rough each is, from 0 to 1, and how much it is metal of its colour, from 0 to 1, as in
        glTF; float64 or float32 as given. None for what its material says: metal, plastic and glass
        may be rough, and plastic may be metal.
    material_index : array (n,), or None
        Which of the materials each is made of, from 0, as uint8. None for the first.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str, or a tuple of these
        What they are made of, or its name: "lambert" (the default), "mirror", "glass", "metal",
        "plastic" or "emissive"; or several, of which `material_index` says who is made of which.

    Raises
    ------
    SceneError
        If an array has the wrong shape, the wrong dtype, or holds a wrong number. The message
        names the place, for instance ``Spheres.radius[17]``.

    Examples
    --------
    >>> Spheres(center=[(0, 0, 5), (1, 0, 5)], radius=0.5, color=(255, 0, 0), lambert=1)
    Spheres(center=<float64 (2, 3)>, radius=0.5, color=<uint8 (3,)>, lambert=1.0)
    """

    center: Floats
    radius: Floats | float
    color: Bytes
    lambert: Floats | float
    opacity: Floats | float | None = None
    roughness: Floats | float | None = None
    metalness: Floats | float | None = None
    material_index: Bytes | None = None
    material: AnyMaterials = "lambert"

    COLUMNS = MappingProxyType(
        {
            "center": POINT,
            "radius": RADIUS,
            "color": COLOR,
            "lambert": LAMBERT,
            "opacity": OPACITY,
            "roughness": ROUGHNESS,
            "metalness": METALNESS,
            "material_index": MATERIAL_INDEX,
        }
    )
    EACH = "position"
    _in_code = MappingProxyType({"color": (255, 255, 255), "lambert": 1.0})

    def hull(self) -> list[tuple[Floats, Floats | float, Floats | None]]:
        """Return the balls whose hulls these are: themselves."""
        return [(self.center, self.radius, None)]

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: ArrayLike,
            radius: ArrayLike,
            color: ArrayLike = ...,
            lambert: ArrayLike = 1.0,
            opacity: ArrayLike | None = None,
            roughness: ArrayLike | None = None,
            metalness: ArrayLike | None = None,
            material_index: ArrayLike | None = None,
            material: AnyMaterial | Sequence[AnyMaterial] = "lambert",
        ) -> None: ...
