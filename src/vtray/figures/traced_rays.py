"""The rays of one pixel as plain data: the camera ray, what it hits, and the rays to all lights."""

from dataclasses import dataclass, field

from vtray.geometry.vector import Vec
from vtray.scene.light_types import Light
from vtray.scene.scene import Scene


@dataclass(frozen=True)
class Surface:
    """A sphere, a cylinder or a plane of the scene.

    Attributes
    ----------
    object
        Its place in ``scene.objects``, or that of the `Copies` which place it.
    index
        Its place in the arrays of `Spheres` or `Cylinders`; None for a single object.
    center
        Centre of the sphere, start of the cylinder, or a point of the plane, in world space.
    radius
        Radius of the sphere or the cylinder in scene units; None for a plane.
    normal
        Unit normal of the plane in world space; None for others.
    color
        Red, green and blue, from 0 to 255.
    lambert
        Share of the light that it scatters, from 0 to 1.
    end
        End of the cylinder in world space; None for others.
    copy
        Which copy it is a part of, a row of ``Copies.at``; None if it is not copied.
    part
        The place in ``Copies.objects`` of that which it belongs to; None if it is not copied.
    """

    object: int
    index: int | None
    center: Vec
    radius: float | None
    normal: Vec | None
    color: Vec
    lambert: float
    end: Vec | None = None
    copy: int | None = None
    part: int | None = None

    def __str__(self) -> str:
        name = "plane" if self.radius is None else "sphere" if self.end is None else "cylinder"
        which = f"a {name}" if self.index is None else f"{name} {self.index}"
        if self.copy is None:
            return f"objects[{self.object}], {which}"
        return f"objects[{self.object}].objects[{self.part}], {which} of copy {self.copy}"


@dataclass(frozen=True)
class Hit:
    """Where a camera ray meets a surface.

    Attributes
    ----------
    surface
        What is hit.
    distance
        From the ray's origin to the hit, in scene units.
    point
        The hit in world space.
    normal
        Unit normal there, in world space, on the side that the ray comes from.
    """

    surface: Surface
    distance: float
    point: Vec
    normal: Vec


@dataclass(frozen=True)
class ShadowRay:
    """The ray from a hit to a point light.

    Attributes
    ----------
    light
        Place in ``scene.lights``.
    location
        Where the light is, in world space.
    intensity
        The strength of the light.
    direction
        Unit vector from the hit to the light, in world space; 0 if the light is at the hit.
    distance
        From the hit to the light, in scene units.
    cosine
        Of the angle between the normal and the direction; 0 if the light is behind the surface.
    blocker
        A surface between the hit and the light, or None.
    adds
        The red, green and blue that the light adds to the pixel.
    color
        The red, green and blue of the light, from 0 to 255.
    """

    light: int
    location: Vec
    intensity: float
    direction: Vec
    distance: float
    cosine: float
    blocker: Surface | None
    adds: Vec
    color: Vec

    @property
    def arrives(self) -> bool:
        """Whether the light reaches the side of the surface that is seen."""
        return self.cosine > 0.0 and self.blocker is None


@dataclass(frozen=True)
class View:
    """The camera in world space.

    Attributes
    ----------
    center
        Centre of the image plane.
    right, down, forward
        The unit axes x', y' and z'.
    focus
        Distance from the eye to the image plane, in scene units.
    size
        Width and height of the image in pixels.
    resolution
        Width and height of a pixel on the image plane, in scene units.
    """

    center: Vec
    right: Vec
    down: Vec
    forward: Vec
    focus: float
    size: tuple[int, int]
    resolution: tuple[float, float]


@dataclass(frozen=True)
class Exposed:
    """What a picture made of the light of a pixel.

    Attributes
    ----------
    light
        Linear red, green and blue in the picture; with more than one ray for a pixel their
        weighted mean, which is not that of the ray in the middle alone.
    white
        The light that becomes 255; 0 if the whole picture is black.
    brightest
        Whether that is the brightest channel of the picture.
    background
        The share of the pixel that shows the background, from 0 to 1; 0 if that is black.
    value
        The pixel's channels in the picture, from 0 to 255.
    """

    light: Vec
    white: float
    brightest: bool
    background: float
    value: tuple[int, ...]


@dataclass(frozen=True)
class TracedRays:
    """All rays of one pixel; `RayTree` says what each attribute is."""

    pixel: tuple[int, int]
    origin: Vec
    direction: Vec
    hit: Hit | None
    lights: tuple[ShadowRay, ...]
    light: Vec
    view: View
    exposed: Exposed | None
    scene: Scene = field(repr=False, compare=False)

    @property
    def left_out(self) -> int:
        """How many lights are not shown where something is hit, as they are no points."""
        return sum(not isinstance(light, Light) for light in self.scene.lights if self.hit)
