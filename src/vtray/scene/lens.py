"""The lens of a camera: what is not at the distance of its focus is blurred."""

from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import FieldError, NonNegative, Positive
from vtray.scene.placing.directions import dot, unit
from vtray.scene.vectors import Vector

if TYPE_CHECKING:
    from vtray.scene.placing.moved import HasView
    from vtray.scene.vectors import Triple

Blades = Annotated[
    Annotated[int, Meta(ge=3, le=64)] | Annotated[float, Meta(ge=3, le=64, multiple_of=1)],
    Meta(description="an integer from 3 to 64"),
]


class Lens(Frozen, frozen=True, gc=False, omit_defaults=True):
    """A thin lens in the place of a camera's pinhole, where its eye is: depth of field.

    Attributes
    ----------
    radius : float
        Radius of the opening, in scene units, at most the distance of the focus; 0 for a pinhole.
    focus_distance : float, optional
        Distance from the eye, along the direction in which the camera looks, to the plane that is
        sharp, in scene units, > 0.
    focus_on : Vector, optional
        A point in world space through which that plane goes, instead of its distance.
    blades : int, optional
        From 3 to 64 for an opening that is a regular polygon, one corner up in the picture, with
        its corners at `radius`; without it, the opening is a disc.
    """

    radius: NonNegative
    focus_distance: Positive | None = None
    focus_on: Vector | None = None
    blades: Blades | None = None

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            radius: float,
            focus_distance: float | None = None,
            focus_on: "Vector | Triple | None" = None,
            blades: int | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Refuse a focus that is given twice, or not at all, or nearer than the lens is wide."""
        if self.blades is not None:
            msgspec.structs.force_setattr(self, "blades", int(self.blades))
        if (self.focus_distance is None) == (self.focus_on is None):
            if self.focus_on is None:
                raise FieldError("focus_distance", "this or focus_on, as one says what is sharp")
            raise FieldError("focus_on", "either this or focus_distance, not both")
        if self.focus_distance is not None and not self.radius <= self.focus_distance:
            raise FieldError("radius", "a number from 0 to focus_distance")


def sharp_distance(lens: Lens, camera: "HasView") -> float:
    """Return how far from the eye of a camera, along its view, what is sharp is, in scene units."""
    if lens.focus_distance is not None:
        return lens.focus_distance
    return sharp_ahead(lens, camera) + camera.focus


def sharp_ahead(lens: Lens, camera: "HasView") -> float:
    """Return the same from the image plane, below 0 behind it."""
    if lens.focus_distance is not None:
        return lens.focus_distance - camera.focus
    assert lens.focus_on is not None  # noqa: S101 - one of the two is given
    point, center = lens.focus_on, camera.center
    way = point.x - center.x, point.y - center.y, point.z - center.z
    return dot(way, unit(camera.normal))


def check_lens(lens: Lens, camera: "HasView") -> None:
    """Raise FieldError if a camera cannot have a lens."""
    if camera.projection == "panorama":
        raise FieldError("lens", 'none beside the projection "panorama", in which all is sharp')
    if lens.focus_on is None:
        return
    distance = sharp_distance(lens, camera)
    if not 0 < distance < float("inf"):
        raise FieldError("lens", "a focus_on in front of the eye")
    if not lens.radius <= distance:
        words = f"a radius up to the distance from the eye to focus_on, which is {distance:.6g}"
        raise FieldError("lens", words)
