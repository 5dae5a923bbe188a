"""What a scene file holds where it differs from a scene: objects whose arrays stand elsewhere."""

import typing
from typing import Annotated, ClassVar, TypeAlias

import msgspec
from msgspec import UNSET, Meta, UnsetType

from vtray.base.errors import SceneError
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import Arrays
from vtray.scene.camera import Camera
from vtray.scene.checks.limits import (
    DataPath,
    FieldError,
    Fraction,
    ImagePath,
    NonNegative,
    NpzPath,
    Real,
)
from vtray.scene.cones import Cones
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.light_types import WHITE, Ambient, Light, RectangleLight, SphereLight, Sun
from vtray.scene.materials import AnyMaterial, AnyMaterials
from vtray.scene.objects import Cone, Cylinder, Plane, Sphere
from vtray.scene.settings import DEPTH, Depth, IntegratorName, RenderSettings
from vtray.scene.sky_types import Gradient, check_one_of
from vtray.scene.spheres import Spheres
from vtray.scene.style import Style
from vtray.scene.vectors import Color, Direction, Vector


class HolderInFile(msgspec.Struct, frozen=True, omit_defaults=True):
    """What holds arrays, and may name a file of NumPy arrays, by its key `data`."""

    MADE: ClassVar[type[ArrayHolder]]
    """What this is in a scene."""

    ALONE: ClassVar[str] = ""
    """What the array of a .npy file is; "" if the kind needs more than one."""


class ArraysInFile(HolderInFile, frozen=True, omit_defaults=True):
    """Many objects of one kind, whose numbers stand in a file of NumPy arrays.

    Its keys are `data`, and those arrays for which one value may stand.
    """

    MADE: ClassVar[type[Arrays]]

    ONE: ClassVar[type[msgspec.Struct]]
    """What one of them is in a scene."""

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
    opacity : float, optional
        Share of the light that they take on its way through, 1 if left out; for a .npz file, it
        may stand there.
    roughness, metalness : float, optional
        How rough they are, and how much metal of their colour, instead of what their material says;
        these may stand in the file of arrays.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str, optional
        What all of them are made of, or its name; lambert if left out. Or an array of these, of
        which the array material_index in the file of arrays says who is made of which, from 0.
    """

    data: DataPath
    radius: NonNegative | UnsetType = UNSET
    color: Color | UnsetType = UNSET
    lambert: Fraction | UnsetType = UNSET
    opacity: Fraction | UnsetType = UNSET
    roughness: Fraction | UnsetType = UNSET
    metalness: Fraction | UnsetType = UNSET
    material: AnyMaterials | UnsetType = UNSET

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
        and, where they are not keys of this object, radius, color and lambert; color_end and
        opacity may be in neither.
    radius : float, optional
        Radius of all cylinders, in scene units; it may stand in the file of arrays.
    color : Color, optional
        Colour of all cylinders, or of their halves at start if there is color_end; it may
        stand in the file of arrays.
    color_end : Color, optional
        Colour of the halves at end; it may stand in the file of arrays, or be left out.
    lambert : float, optional
        Share of the light that the surfaces scatter; it may stand in the file of arrays.
    opacity : float, optional
        Share of the light that they take on its way through; it may stand in the file of arrays,
        and is 1 if left out.
    roughness, metalness : float, optional
        How rough they are, and how much metal of their colour, instead of what their material says;
        these may stand in the file of arrays.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str, optional
        What all of them are made of, or its name; lambert if left out. Or an array of these, of
        which the array material_index in the file of arrays says who is made of which, from 0.
    """

    data: NpzPath
    radius: NonNegative | UnsetType = UNSET
    color: Color | UnsetType = UNSET
    color_end: Color | UnsetType = UNSET
    lambert: Fraction | UnsetType = UNSET
    opacity: Fraction | UnsetType = UNSET
    roughness: Fraction | UnsetType = UNSET
    metalness: Fraction | UnsetType = UNSET
    material: AnyMaterials | UnsetType = UNSET

    MADE = Cylinders
    ONE = Cylinder


class ConesInFile(ArraysInFile, frozen=True, omit_defaults=True, tag_field="type", tag="cones"):
    """Many cones, whose numbers stand in a file of NumPy arrays.

    Attributes
    ----------
    data : str
        Path of the arrays, relative to the scene file: a .npz file with the arrays start, end
        and, where they are not keys of this object, radius, radius_end, color and lambert;
        color_end and opacity may be in neither.
    radius : float, optional
        Radius of all cones at their starts, in scene units; it may stand in the file of arrays.
    radius_end : float, optional
        Radius of all cones at their ends, in scene units; it may stand in the file of arrays.
    color : Color, optional
        Colour of all cones, or of their halves at start if there is color_end; it may stand in
        the file of arrays.
    color_end : Color, optional
        Colour of the halves at end; it may stand in the file of arrays, or be left out.
    lambert : float, optional
        Share of the light that the surfaces scatter; it may stand in the file of arrays.
    opacity : float, optional
        Share of the light that they take on its way through; it may stand in the file of arrays,
        and is 1 if left out.
    roughness, metalness : float, optional
        How rough they are, and how much metal of their colour, instead of what their material says;
        these may stand in the file of arrays.
    material : Lambert, Mirror, Glass, Metal, Plastic, Emissive, Blend or str, optional
        What all of them are made of, or its name; lambert if left out. Or an array of these, of
        which the array material_index in the file of arrays says who is made of which, from 0.
    """

    data: NpzPath
    radius: NonNegative | UnsetType = UNSET
    radius_end: NonNegative | UnsetType = UNSET
    color: Color | UnsetType = UNSET
    color_end: Color | UnsetType = UNSET
    lambert: Fraction | UnsetType = UNSET
    opacity: Fraction | UnsetType = UNSET
    roughness: Fraction | UnsetType = UNSET
    metalness: Fraction | UnsetType = UNSET
    material: AnyMaterials | UnsetType = UNSET

    MADE = Cones
    ONE = Cone


PartInFile: TypeAlias = Sphere | Cylinder | Cone | SpheresInFile | CylindersInFile | ConesInFile


class CopiesInFile(HolderInFile, frozen=True, omit_defaults=True, tag_field="type", tag="copies"):
    """The same spheres, cylinders and cones at many places.

    Attributes
    ----------
    objects : list of Sphere, Cylinder, Cone, SpheresInFile, CylindersInFile or ConesInFile
        What is placed, at least one.
    at : list of Vector, optional
        Translations of the copies, in scene units; they stand here or in the file of data.
    data : str, optional
        Path of the translations, relative to the scene file: a .npz file with the array at,
        or a .npy file.
    """

    objects: Annotated[
        list[PartInFile], Meta(min_length=1, description="an array of at least one object")
    ]
    at: list[Vector] | UnsetType = UNSET
    data: DataPath | UnsetType = UNSET

    MADE = Copies
    ALONE = "at"

    def __post_init__(self) -> None:
        """Refuse places that are given twice, or not at all."""
        if self.at is not UNSET and self.data is not UNSET:
            field, message = "data", "the places here or in at, not both"
        elif self.at is self.data is UNSET:
            field = "at"
            message = "an array of places, or the key data with the path of a .npz or .npy file"
        else:
            return
        raise FieldError(field, message)


ObjectInFile: TypeAlias = (
    Sphere | Cylinder | Cone | Plane | SpheresInFile | CylindersInFile | ConesInFile | CopiesInFile
)

KINDS: tuple[type[msgspec.Struct], ...] = typing.get_args(ObjectInFile)
"""The types of objects, in the order of messages."""

ARRAYS_IN_FILE = [kind for kind in KINDS if issubclass(kind, ArraysInFile)]

HOLDERS_IN_FILE = [kind for kind in KINDS if issubclass(kind, HolderInFile)]


class SkyInFile(msgspec.Struct, frozen=True, omit_defaults=True, tag_field="type", tag="sky"):
    """Light from all directions: of one colour, or of colours that change with the direction.

    Attributes
    ----------
    radiance : float, optional
        Strength, ≥ 0, 1 by default: a white, fully scattering surface that sees nothing but a sky
        of radiance 1 shows 1.
    color : Color, optional
        Colour of the light, as for Light; that of a gradient or a picture is multiplied by it.
    gradient : Gradient, optional
        Colours by the height above the horizon.
    image : str, optional
        Path of a picture of the light from all directions, as a map of the globe, relative to the
        scene file: .exr, .hdr, .png or .jpg; a .npz file with the array image, or a .npy file. Not
        beside a gradient.
    up : Direction, optional
        What is up in the world; by default the camera's `up`, or where it has none, up in the
        picture.
    rotation : float, optional
        By how many degrees the sky is turned around `up`, counterclockwise as seen from above.
    """

    radiance: NonNegative = 1.0
    color: Color = WHITE
    gradient: Gradient | None = None
    image: ImagePath | None = None
    up: Direction | None = None
    rotation: Real = 0.0

    def __post_init__(self) -> None:
        """Refuse two answers to what the colours are."""
        check_one_of(self.gradient, self.image)


LightInFile: TypeAlias = Light | Sun | SphereLight | RectangleLight | SkyInFile | Ambient


class IntegratorInFile(msgspec.Struct, frozen=True, omit_defaults=True):
    """What light is followed, and how far.

    Attributes
    ----------
    type : str
        "direct", "whitted" or "path", as in the settings of the render.
    depth : int, optional
        Over how many surfaces light is followed at the most; 8 if left out.
    """

    type: IntegratorName
    depth: Depth = DEPTH


AnyIntegrator: TypeAlias = IntegratorName | IntegratorInFile
NamedMaterials: TypeAlias = Annotated[
    dict[str, AnyMaterial], Meta(description="an object with a material for each name")
]


class SceneInFile(msgspec.Struct, omit_defaults=True):
    """All that a picture is made from.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from.
    lights : list of Light, Sun, SphereLight, RectangleLight, SkyInFile or Ambient
        The lights; may be empty.
    objects : list of Sphere, Cylinder, Cone, Plane, SpheresInFile, CylindersInFile, ConesInFile \
or CopiesInFile
        The objects; may be empty.
    render : RenderSettings, optional
        How the picture is taken.
    style : Style, optional
        How the picture is drawn, beside its light.
    integrator : str or IntegratorInFile, optional
        What light is followed; it stands here or in `render`.
    materials : dict of str, optional
        Materials by names of their own, by which objects may name theirs.
    """

    camera: Camera
    lights: list[LightInFile]
    objects: list[ObjectInFile]
    render: RenderSettings | UnsetType = UNSET
    style: Style | UnsetType = UNSET
    integrator: AnyIntegrator | UnsetType = UNSET
    materials: NamedMaterials | UnsetType = UNSET


def with_integrator(
    render: RenderSettings | UnsetType, given: IntegratorName | IntegratorInFile | UnsetType
) -> RenderSettings | UnsetType:
    """Return settings with the integrator that a scene file names beside them.

    Raises
    ------
    SceneError
        If the settings name one, too.
    """
    if given is UNSET:
        return render
    found = IntegratorInFile(given) if isinstance(given, str) else given
    before = RenderSettings() if render is UNSET else render
    if (before.integrator, before.depth) != ("direct", DEPTH):
        twice = "given here and in render; expected it in one of them"
        raise SceneError(f"integrator: {twice}")
    return before.replace(integrator=found.type, depth=found.depth)


def without_integrator(
    render: RenderSettings,
) -> tuple[RenderSettings, IntegratorName | IntegratorInFile | UnsetType]:
    """Return settings as they are written, and the integrator that is written beside them."""
    rest, name = render.replace(integrator="direct", depth=DEPTH), render.integrator
    if render == rest:
        return rest, UNSET
    return rest, name if render.depth == DEPTH else IntegratorInFile(name, render.depth)
