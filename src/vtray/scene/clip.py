"""Clip planes and slices, as scene files define them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

from msgspec import Meta

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import FieldError, Positive, Real
from vtray.scene.vectors import Direction, Vector

if TYPE_CHECKING:
    from vtray.scene.vectors import Triple


Places = Annotated[
    tuple[Annotated[int, Meta(ge=0, description="an integer ≥ 0")], ...],
    Meta(description="an array of places in the scene's objects, integers ≥ 0"),
]


class ClipPlane(Frozen, frozen=True, omit_defaults=True, gc=False):
    """A plane on one side of which nothing exists.

    Attributes
    ----------
    normal : Direction
        Direction square to the plane. What lies on the side that it points to is left out.
    distance : float, optional
        How far the plane is from the world's origin, along the normal, in scene units.
    center : Vector, optional
        Any point of the plane, in world space, instead of its distance. Without either, it goes
        through the middle of the box around the centres of all bounded shapes.
    objects : tuple of int, optional
        The places in the scene's objects of those that it cuts, counted from 0; by default all.
    """

    normal: Direction
    distance: Real | None = None
    center: Vector | None = None
    objects: Places | None = None

    if TYPE_CHECKING:

        def __init__(
            self,
            normal: "Direction | Vector | Triple",
            distance: float | None = None,
            center: "Vector | Triple | None" = None,
            objects: "Sequence[int] | None" = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Refuse a plane that is said in two ways."""
        _check_place(self.distance, self.center)


class Slice(Frozen, frozen=True, omit_defaults=True, gc=False):
    """A slab outside of which nothing exists.

    Attributes
    ----------
    normal : Direction
        Direction square to the slab.
    thickness : float
        How thick it is, in scene units, > 0.
    distance : float, optional
        How far its middle is from the world's origin, along the normal.
    center : Vector, optional
        Any point of the plane in its middle, in world space, instead of that. Without either, that
        is the middle of the box around the centres of all bounded shapes.
    objects : tuple of int, optional
        The places in the scene's objects of those that are cut, counted from 0; by default all.
    """

    normal: Direction
    thickness: Positive
    distance: Real | None = None
    center: Vector | None = None
    objects: Places | None = None

    if TYPE_CHECKING:

        def __init__(
            self,
            normal: "Direction | Vector | Triple",
            thickness: float,
            distance: float | None = None,
            center: "Vector | Triple | None" = None,
            objects: "Sequence[int] | None" = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Refuse a slab that is said in two ways."""
        _check_place(self.distance, self.center)


def _check_place(distance: float | None, center: Vector | None) -> None:
    """Raise FieldError if a plane has both a distance and a point."""
    if center is not None and distance is not None:
        field, message = "center", "either a center or a distance, not both"
        raise FieldError(field, message)
