"""Many cones as arrays."""

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


class Cones(Arrays, frozen=True, eq=False, dict=True, tag_field="type", tag="cones"):
    """Many solid cones with flat caps and matt surfaces, as arrays: heads of arrows, for instance.

    An array may be anything that NumPy makes an array of, and is shared, as for `Spheres`. Cones
    are pointed, the colour is white and `lambert` 1 unless they are given.

    Attributes
    ----------
    start, end : array (n, 3)
        Middles of the caps in world space, finite; float64 or float32 as given, all else becomes
        float64. There may be none. A cone of length 0 is never hit.
    radius : array (n,) or float
        Radii at `start` in scene units, ≥ 0, or one for all; float64 or float32 as given.
    radius_end : array (n,) or float
        Radii at `end`, likewise: 0 for a tip, which is the default, and less than `radius` for a
        cone that is cut off. A cone whose radii are both 0 is never hit.
    color : array (n, 3) or (3,)
        Colours, or one for all, as uint8; whole numbers from 0 to 255 of any other dtype are
        converted, and `Color` is one colour. If there is `color_end`, they are those of the halves
        at `start`.
    lambert : array (n,) or float
        Share of the light that each surface scatters, from 0 to 1, or one for all; float64 or
        float32 as given.
    color_end : array (n, 3) or (3,), or None
        Colours of the halves at `end`, as `color`; None if each cone has one colour.
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
        names the place, for instance ``Cones.end[17, 2]``.

    Examples
    --------
    >>> Cones(start=[(0, 0, 5)], end=[(1, 0, 5)], radius=0.2, color=(255, 0, 0))
    Cones(start=<float64 (1, 3)>, end=<float64 (1, 3)>, radius=0.2, radius_end=0.0, \
color=<uint8 (3,)>, lambert=1.0, color_end=None)
    """

    start: Floats
    end: Floats
    radius: Floats | float
    radius_end: Floats | float
    color: Bytes
    lambert: Floats | float
    color_end: Bytes | None = None
    opacity: Floats | float | None = None
    roughness: Floats | float | None = None
    metalness: Floats | float | None = None
    material_index: Bytes | None = None
    material: AnyMaterials = "lambert"

    COLUMNS = MappingProxyType(
        {
            "start": POINT,
            "end": POINT,
            "radius": RADIUS,
            "radius_end": RADIUS._replace(table=("radius_end",)),
            "color": COLOR,
            "lambert": LAMBERT,
            "color_end": COLOR._replace(stand_in="color"),
            "opacity": OPACITY,
            "roughness": ROUGHNESS,
            "metalness": METALNESS,
            "material_index": MATERIAL_INDEX,
        }
    )
    EACH = "cone"
    _in_code = MappingProxyType({"radius_end": 0.0, "color": (255, 255, 255), "lambert": 1.0})

    def hull(self) -> list[tuple[Floats, Floats | float, Floats | None]]:
        """Return the discs whose hulls these are: their caps."""
        return [(self.start, self.radius, self.end), (self.end, self.radius_end, self.start)]

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            start: ArrayLike,
            end: ArrayLike,
            radius: ArrayLike,
            radius_end: ArrayLike = 0.0,
            color: ArrayLike = ...,
            lambert: ArrayLike = 1.0,
            color_end: ArrayLike | None = None,
            opacity: ArrayLike | None = None,
            roughness: ArrayLike | None = None,
            metalness: ArrayLike | None = None,
            material_index: ArrayLike | None = None,
            material: AnyMaterial | Sequence[AnyMaterial] = "lambert",
        ) -> None: ...
