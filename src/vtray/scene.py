"""The scene: plain typed objects that are also the definition of the scene file.

The file format, its checks, the words of its error messages and the JSON Schema all come
from the annotations in this module.
"""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, BinaryIO

import msgspec
from msgspec import Meta

from vtray.checked import Checked

if TYPE_CHECKING:
    from numpy.typing import NDArray

# The kinds of value. Each description completes "expected ..." in an error message.
Real = Annotated[float, Meta(description="a finite number")]
Positive = Annotated[float, Meta(gt=0, description="a number > 0")]
NonNegative = Annotated[float, Meta(ge=0, description="a number ≥ 0")]
Fraction = Annotated[float, Meta(ge=0, le=1, description="a number from 0 to 1")]
# An integer may be written 255 or 255.0: JSON knows only numbers.
Byte = Annotated[
    Annotated[int, Meta(ge=0, le=255)] | Annotated[float, Meta(ge=0, le=255, multiple_of=1)],
    Meta(description="an integer from 0 to 255"),
]
MAX_SIZE = 2**31 - 1  # the largest side of a PNG
Size = Annotated[
    Annotated[int, Meta(ge=1, le=MAX_SIZE)]
    | Annotated[float, Meta(ge=1, le=MAX_SIZE, multiple_of=1)],
    Meta(description=f"an integer from 1 to {MAX_SIZE}"),
]
SizePair = Annotated[tuple[Size, Size], Meta(description="an array of two integers > 0")]
PositivePair = Annotated[tuple[Positive, Positive], Meta(description="an array of two numbers > 0")]


class Vector(msgspec.Struct, metaclass=Checked, frozen=True, gc=False):
    """A point or a displacement in world space.

    Wherever a `Vector`, `Direction` or `Color` is expected, code may also give a tuple, a
    list or a NumPy array of three numbers.

    Attributes
    ----------
    x, y, z : float
        Coordinates in scene units, finite.
    """

    x: Real
    y: Real
    z: Real


class Direction(msgspec.Struct, metaclass=Checked, frozen=True, gc=False):
    """A direction in world space, of any length but zero.

    Attributes
    ----------
    x, y, z : float
        Components, finite and not all zero.
    """

    x: Real
    y: Real
    z: Real

    def __post_init__(self) -> None:
        """Refuse the zero vector, which points nowhere."""
        if self.x == self.y == self.z == 0:
            message = "numbers x, y and z that are not all zero"
            raise ValueError(message)


class Color(msgspec.Struct, metaclass=Checked, frozen=True, gc=False):
    """The colour of a surface, in linear light.

    Attributes
    ----------
    r, g, b : int
        Red, green and blue, from 0 to 255.
    """

    r: Byte
    g: Byte
    b: Byte


class Camera(msgspec.Struct, metaclass=Checked, frozen=True, gc=False):
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
    """

    center: Vector
    normal: Direction
    focus: Positive
    size: SizePair
    resolution: PositivePair

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            focus: float,
            size: tuple[int, int],
            resolution: tuple[float, float],
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold the size as integers, also where it was written as 256.0."""
        width, height = self.size
        msgspec.structs.force_setattr(self, "size", (int(width), int(height)))


class Light(msgspec.Struct, metaclass=Checked, frozen=True, gc=False):
    """A point light; its light does not fall off with distance.

    Attributes
    ----------
    location : Vector
        Position in world space.
    intensity : float
        Strength, relative to the other lights, ≥ 0.
    """

    location: Vector
    intensity: NonNegative

    if TYPE_CHECKING:

        def __init__(self, location: "Vector | Triple", intensity: float) -> None: ...


class Sphere(
    msgspec.Struct, metaclass=Checked, frozen=True, gc=False, tag_field="type", tag="sphere"
):
    """A sphere with a matt surface, which can also be seen from inside.

    Attributes
    ----------
    center : Vector
        Centre in world space.
    radius : float
        Radius in scene units, ≥ 0; a sphere of radius 0 is never hit.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    """

    center: Vector
    radius: NonNegative
    color: Color
    lambert: Fraction

    if TYPE_CHECKING:

        def __init__(
            self, center: "Vector | Triple", radius: float, color: "Color | Triple", lambert: float
        ) -> None: ...


class Plane(
    msgspec.Struct, metaclass=Checked, frozen=True, gc=False, tag_field="type", tag="plane"
):
    """A plane without edges and with two matt sides.

    Attributes
    ----------
    center : Vector
        Any point of the plane, in world space.
    normal : Direction
        Direction square to the plane, in world space.
    color : Color
        Colour of the surface.
    lambert : float
        Share of the light that the surface scatters, from 0 to 1.
    """

    center: Vector
    normal: Direction
    color: Color
    lambert: Fraction

    if TYPE_CHECKING:

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            color: "Color | Triple",
            lambert: float,
        ) -> None: ...


Object = Sphere | Plane

if TYPE_CHECKING:
    Triple = Sequence[float] | NDArray[Any]


class Scene(msgspec.Struct, metaclass=Checked):
    """All that a picture is made from.

    Its attributes may be replaced and its lists changed; `check` looks at them again.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from.
    lights : list of Light
        The lights; may be empty.
    objects : list of Sphere or Plane
        The objects; may be empty.
    """

    camera: Camera
    lights: list[Light]
    objects: list[Object]

    def check(self) -> None:
        """Check the scene after changes made in code.

        Raises
        ------
        SceneError
            If the camera, a light or an object is not of its type.
        """
        Scene(self.camera, self.lights, self.objects)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as indented JSON that `vtray.load` reads back as an equal scene.

        Parameters
        ----------
        path : str or path
            The file to write. It is replaced as a whole, or left as it was.

        Raises
        ------
        SceneError
            If the scene is not valid any more.
        OutputError
            If the file cannot be written.
        """
        from vtray.atomic_file import write_whole

        self.check()
        data = msgspec.json.format(msgspec.json.encode(self), indent=2) + b"\n"

        def write(file: BinaryIO) -> None:
            file.write(data)

        write_whole(Path(path), write)
