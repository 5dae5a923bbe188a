"""The scene: plain typed objects that are also the definition of the scene file.

The file format, its checks, the words of its error messages and the JSON Schema all come
from the annotations in this module.
"""

import itertools
import os
from collections.abc import Container, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import msgspec
from msgspec import UNSET, UnsetType

from vtray.checked import Checked
from vtray.errors import OutputError
from vtray.kinds import (
    Byte,
    DataPath,
    Fraction,
    NonNegative,
    Positive,
    PositivePair,
    Real,
    SizePair,
)
from vtray.spheres import Spheres

if TYPE_CHECKING:
    from numpy.typing import NDArray


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


class SpheresInFile(
    msgspec.Struct, frozen=True, tag_field="type", tag="spheres", omit_defaults=True
):
    """Many spheres, whose numbers stand in a file of NumPy arrays.

    Attributes
    ----------
    data : str
        Path of the arrays, relative to the scene file: a .npz file with the arrays center
        and, where they are not keys of this object, radius, color and lambert; or a .npy
        file with the centres alone.
    radius : float, optional
        Radius of all spheres, in scene units; for a .npz file, it may stand there.
    color : Color, optional
        Colour of all spheres; for a .npz file, it may stand there.
    lambert : float, optional
        Share of the light that the surfaces scatter; for a .npz file, it may stand there.
    """

    data: DataPath
    radius: NonNegative | UnsetType = UNSET
    color: Color | UnsetType = UNSET
    lambert: Fraction | UnsetType = UNSET


Object = Sphere | Plane | Spheres

if TYPE_CHECKING:
    Triple = Sequence[float] | NDArray[Any]


class SceneInFile(msgspec.Struct):
    """All that a picture is made from.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from.
    lights : list of Light
        The lights; may be empty.
    objects : list of Sphere, Plane or SpheresInFile
        The objects; may be empty.
    """

    camera: Camera
    lights: list[Light]
    objects: list[Sphere | Plane | SpheresInFile]


class Scene(msgspec.Struct, metaclass=Checked, dict=True):
    """All that a picture is made from.

    Its attributes may be replaced, its lists changed, and so may arrays that `Spheres` share;
    `check` looks at them again.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from.
    lights : list of Light
        The lights; may be empty.
    objects : list of Sphere, Plane or Spheres
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
        if Spheres in map(type, self.objects):
            for index, item in enumerate(self.objects):
                if isinstance(item, Spheres):
                    item.check(f"Scene.objects[{index}]")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as indented JSON that `vtray.load` reads back as an equal scene.

        The arrays of `Spheres` go to files beside it: for scene.json to scene.npz, those of
        further `Spheres` to scene-2.npz and so on. Files of these names are replaced.

        Parameters
        ----------
        path : str or path
            The file to write. Each file is replaced as a whole, or left as it was; arrays are
            written first, and the JSON last.

        Raises
        ------
        SceneError
            If the scene is not valid any more.
        OutputError
            If a file cannot be written.
        """
        from vtray.atomic_file import write_whole

        self.check()
        target = Path(path)
        objects: list[Sphere | Plane | SpheresInFile] = []
        arrays: dict[str, dict[str, object]] = {}
        for item in self.objects:
            if isinstance(item, Spheres):
                name = _unused_name(target, arrays)
                entry, arrays[name] = _split_spheres(item, name)
                objects.append(entry)
            else:
                objects.append(item)
        found = SceneInFile(self.camera, self.lights, objects)
        data = msgspec.json.format(_encode(found, target), indent=2) + b"\n"

        def write(file: BinaryIO) -> None:
            file.write(data)

        for name, columns in arrays.items():
            from vtray.array_file import write_arrays

            write_arrays(target.with_name(name), columns)
        write_whole(target, write)


def _unused_name(scene: Path, used: Container[str]) -> str:
    """Give the name for the next arrays of a scene."""
    numbers = itertools.chain([""], (f"-{number}" for number in itertools.count(2)))
    names = (f"{scene.stem}{number}.npz" for number in numbers)
    return next(name for name in names if name not in used and name != scene.name)


def _split_spheres(spheres: Spheres, name: str) -> tuple[SpheresInFile, dict[str, object]]:
    """Split spheres into what stands in a scene file, and the arrays of a file of this name."""
    arrays = msgspec.structs.asdict(spheres)
    shared: dict[str, Any] = {}
    if spheres.color.ndim == 1:
        shared["color"] = Color(*arrays.pop("color").tolist())
    for key in ("radius", "lambert"):
        if isinstance(arrays[key], float):
            shared[key] = arrays.pop(key)
    return SpheresInFile(name, **shared), arrays


def _encode(scene: SceneInFile, target: Path) -> bytes:
    """Write a scene as JSON."""
    try:
        return msgspec.json.encode(scene)
    except UnicodeEncodeError:
        message = f"{target}: cannot be written: the name is not UTF-8, as JSON needs it"
        raise OutputError(message) from None
