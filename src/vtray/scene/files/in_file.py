"""What a scene file holds where it differs from a scene: objects whose arrays stand elsewhere."""

import typing
from typing import ClassVar, TypeAlias

import msgspec
from msgspec import UNSET, UnsetType

from vtray.scene.arrays import Arrays
from vtray.scene.camera import Camera
from vtray.scene.checks.limits import DataPath, Fraction, NonNegative, NpzPath
from vtray.scene.cylinders import Cylinders
from vtray.scene.objects import Cylinder, Light, Plane, Sphere
from vtray.scene.settings import RenderSettings
from vtray.scene.spheres import Spheres
from vtray.scene.vectors import Color


class ArraysInFile(msgspec.Struct, frozen=True, omit_defaults=True):
    """Many objects of one kind, whose numbers stand in a file of NumPy arrays.

    Its keys are `data`, and those arrays for which one value may stand.
    """

    MADE: ClassVar[type[Arrays]]
    """What these are in a scene."""

    ONE: ClassVar[type[msgspec.Struct]]
    """What one of them is in a scene."""

    ALONE: ClassVar[str] = ""
    """What the array of a .npy file is; "" if the kind needs more than one."""

    data: str


class SpheresInFile(ArraysInFile, frozen=True, omit_defaults=True, tag_field="type", tag="spheres"):
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

    MADE = Spheres
    ONE = Sphere
    ALONE = "center"


class CylindersInFile(
    ArraysInFile, frozen=True, omit_defaults=True, tag_field="type", tag="cylinders"
):
    """Many cylinders, whose numbers stand in a file of NumPy arrays.

    Attributes
    ----------
    data : str
        Path of the arrays, relative to the scene file: a .npz file with the arrays start, end
        and, where they are not keys of this object, radius, color and lambert; color_end may be
        in neither.
    radius : float, optional
        Radius of all cylinders, in scene units; it may stand in the file of arrays.
    color : Color, optional
        Colour of all cylinders, or of their halves at start if there is color_end; it may
        stand in the file of arrays.
    color_end : Color, optional
        Colour of the halves at end; it may stand in the file of arrays, or be left out.
    lambert : float, optional
        Share of the light that the surfaces scatter; it may stand in the file of arrays.
    """

    data: NpzPath
    radius: NonNegative | UnsetType = UNSET
    color: Color | UnsetType = UNSET
    color_end: Color | UnsetType = UNSET
    lambert: Fraction | UnsetType = UNSET

    MADE = Cylinders
    ONE = Cylinder


ObjectInFile: TypeAlias = Sphere | Cylinder | Plane | SpheresInFile | CylindersInFile

KINDS: tuple[type[msgspec.Struct], ...] = typing.get_args(ObjectInFile)
"""The types of objects, in the order of messages."""

ARRAYS_IN_FILE = [kind for kind in KINDS if issubclass(kind, ArraysInFile)]


class SceneInFile(msgspec.Struct, omit_defaults=True):
    """All that a picture is made from.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from.
    lights : list of Light
        The lights; may be empty.
    objects : list of Sphere, Cylinder, Plane, SpheresInFile or CylindersInFile
        The objects; may be empty.
    render : RenderSettings, optional
        How the picture is taken.
    """

    camera: Camera
    lights: list[Light]
    objects: list[ObjectInFile]
    render: RenderSettings | UnsetType = UNSET
