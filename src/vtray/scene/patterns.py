"""Patterns of colours on surfaces, as the scene file defines them."""

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from msgspec import Meta

from vtray.scene.checks.checked import Checked, Frozen
from vtray.scene.checks.limits import Positive, Real
from vtray.scene.pictures.pattern_image import PatternImage, pattern_image
from vtray.scene.vectors import Color, Direction

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from vtray.scene.vectors import Triple, Vector

GREY = Color(64, 64, 64)

TwoColors = Annotated[
    tuple[Color | None, Color | None],
    Meta(description="two colours, null for that of the object"),
]

Runs = Literal["around", "along"]
"""How stripes run on a sphere, a cylinder or a cone: around its axis, or along it."""


class Checker(Frozen, frozen=True, gc=False, omit_defaults=True, tag_field="type", tag="checker"):
    """Squares of two colours in turn, as on a chessboard.

    On a plane they go on for ever. A sphere has them between circles of latitude and longitude, a
    cylinder or a cone around its side, and its flat ends show the colour of the object. There, the
    squares are a little larger or smaller than they are asked for, so that they close.

    Attributes
    ----------
    colors : tuple of Color, optional
        The two colours; None is that of the object. By default that, and a dark grey.
    size : float, optional
        The side of a square in scene units, > 0, along the surface; 1 by default. On spheres that
        is the width at the equator, on cones at the wider end.
    up : Direction, optional
        Where spheres have their upper pole, and planes the upper side of their squares; by default
        the camera's `up`, or where it has none, up in the picture.
    rotation : float, optional
        By how many degrees the pattern is turned around that pole, around the axis of cylinders and
        cones, and around the normal of planes.
    """

    colors: TwoColors = (None, GREY)
    size: Positive = 1.0
    up: Direction | None = None
    rotation: Real = 0.0

    if TYPE_CHECKING:

        def __init__(
            self,
            colors: "tuple[Color | Triple | None, Color | Triple | None]" = ...,
            size: float = 1.0,
            up: "Direction | Vector | Triple | None" = None,
            rotation: float = 0.0,
        ) -> None: ...


class Stripes(Frozen, frozen=True, gc=False, omit_defaults=True, tag_field="type", tag="stripes"):
    """Stripes of two colours in turn.

    Attributes
    ----------
    colors, size, up, rotation : optional
        As of Checker; the size is the width of a stripe.
    run : "around" or "along", optional
        Whether stripes run around the axis of spheres, cylinders and cones, the default, or along
        it, from pole to pole. On planes, those around run level, and those along run up.
    """

    colors: TwoColors = (None, GREY)
    size: Positive = 1.0
    up: Direction | None = None
    rotation: Real = 0.0
    run: Runs = "around"

    if TYPE_CHECKING:

        def __init__(
            self,
            colors: "tuple[Color | Triple | None, Color | Triple | None]" = ...,
            size: float = 1.0,
            up: "Direction | Vector | Triple | None" = None,
            rotation: float = 0.0,
            run: Runs = "around",
        ) -> None: ...


class _CheckedImage(Checked):
    """Makes construction in code take a picture in all ways that `ImagePattern` says."""

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what is given."""
        values["image"] = pattern_image(values["image"], f"{cls.__name__}.image")


class ImagePattern(
    Frozen,
    metaclass=_CheckedImage,
    frozen=True,
    gc=False,
    omit_defaults=True,
    tag_field="type",
    tag="image",
):
    """A picture on a surface, as on a globe, a label or a board.

    Its light is interpolated between pixels. Where it is not opaque, the object's own colour shows.

    Attributes
    ----------
    image : PatternImage
        The picture. In code, it may be given as an array (height, width, 3 or 4) of uint8, or as
        the path of a file: .png, .jpg and others that Pillow reads, a .npz file with the array
        image, or a .npy file. In a scene file it is such a path.
    size : float, optional
        How wide the picture is in scene units, > 0; it is there again and again, a little larger or
        smaller where a surface closes. By default it is once around spheres, cylinders and cones
        from end to end, as a map is around a globe, and 1 wide on planes.
    up : Direction, optional
        What is up on spheres and planes, as of Checker. Cylinders and cones have it towards their
        ends.
    rotation : float, optional
        By how many degrees it is turned, as of Checker. The middle of a picture is where spheres,
        cylinders and cones look to `up`, or if that is their axis, to the x axis for z, the y axis
        for x, and the z axis for y.
    """

    image: Annotated[PatternImage, Meta(description="the path of a picture")]
    size: Positive | None = None
    up: Direction | None = None
    rotation: Real = 0.0

    if TYPE_CHECKING:

        def __init__(
            self,
            image: "PatternImage | NDArray[Any] | str | os.PathLike[str]",
            size: float | None = None,
            up: "Direction | Vector | Triple | None" = None,
            rotation: float = 0.0,
        ) -> None: ...


Pattern: TypeAlias = Checker | Stripes | ImagePattern
"""Any pattern."""
