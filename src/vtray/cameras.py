"""The camera of a scene: its type, which is part of the scene file's definition."""

from typing import TYPE_CHECKING, Literal

import msgspec

from vtray.checked import Checked
from vtray.directions import are_parallel, unit
from vtray.kinds import FieldError, Positive, PositivePair, SizePair
from vtray.triples import Direction, Vector

if TYPE_CHECKING:
    from vtray.triples import Triple

Projection = Literal["perspective", "orthographic"]


class Camera(msgspec.Struct, metaclass=Checked, frozen=True, gc=False, omit_defaults=True):
    """A pinhole camera: an image plane and an eye behind it.

    Attributes
    ----------
    center : Vector
        Centre of the image plane, in world space.
    normal : Direction
        Where the camera looks, in world space, square to the image plane.
    focus : float
        Distance from the eye to the image plane, in scene units, > 0.
    size : tuple of int
        Width and height of the image, in pixels.
    resolution : tuple of float
        Width and height of one pixel on the image plane, in scene units, > 0.
    up : Direction, optional
        What points up in the image, as far as it is square to `normal`, to which it must not be
        parallel. Without it, the axes are those of the format's first rule.
    projection : str, optional
        "perspective": all rays start in the eye. "orthographic": each ray runs along `normal`, from
        the plane through the eye through its pixel.
    """

    center: Vector
    normal: Direction
    focus: Positive
    size: SizePair
    resolution: PositivePair
    up: Direction | None = None
    projection: Projection = "perspective"

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            focus: float,
            size: tuple[int, int],
            resolution: tuple[float, float],
            up: "Direction | Vector | Triple | None" = None,
            projection: Projection = "perspective",
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold the size as integers, also where it was written as 256.0, and look at `up`."""
        width, height = self.size
        msgspec.structs.force_setattr(self, "size", (int(width), int(height)))
        if self.up is not None and are_parallel(unit(self.up), unit(self.normal)):
            raise FieldError("up", "a direction that is not parallel to normal")
