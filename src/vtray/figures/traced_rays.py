"""The rays of one pixel as plain data: the camera ray, what it hits, and the rays to all lights."""

from collections import Counter
from dataclasses import dataclass, field
from typing import TypeAlias

from vtray.geometry.vector import Vec
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.materials import Material
from vtray.scene.patterns import Pattern
from vtray.scene.scene import Scene


@dataclass(frozen=True)
class Surface:
    """A sphere, a cylinder, a cone or a plane of the scene.

    Attributes
    ----------
    object
        Its place in ``scene.objects``, or that of the `Copies` which place it.
    index
        Its place in the arrays of `Spheres` and their like; None for a single object.
    center
        Centre of the sphere, start of the cylinder or cone, or a point of the plane, in world
        space.
    radius
        Radius of the sphere or the cylinder, or that of the cone at its start, in scene units; None
        for a plane.
    normal
        Unit normal of the plane in world space; None for others.
    color
        Red, green and blue, from 0 to 255; of a hit on a pattern, those of the pattern there.
    lambert
        Share of the light that it scatters, from 0 to 1.
    end
        End of the cylinder or cone in world space; None for others.
    copy
        Which copy it is a part of, a row of ``Copies.at``; None if it is not copied.
    part
        The place in ``Copies.objects`` of that which it belongs to; None if it is not copied.
    radius_end
        Radius of the cone at its end, in scene units; None for others.
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
    radius_end: float | None = None

    @property
    def kind(self) -> str:
        """What it is: "sphere", "cylinder", "cone" or "plane"."""
        if self.radius is None:
            return "plane"
        if self.end is None:
            return "sphere"
        return "cylinder" if self.radius_end is None else "cone"

    def __str__(self) -> str:
        which = f"a {self.kind}" if self.index is None else f"{self.kind} {self.index}"
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
    pattern
        The pattern of which it has the colour; None if that is the surface's own.
    """

    surface: Surface
    distance: float
    point: Vec
    normal: Vec
    pattern: Pattern | None = None


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
        Of the angle between the normal and the direction, times what passes faded bodies on the
        way; 0 if the light is behind the surface.
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

    @property
    def is_behind(self) -> bool:
        """Whether the light is behind the surface."""
        return self.cosine == 0.0

    @property
    def blockers(self) -> list[Surface]:
        """What is in the way: at most one surface."""
        return [] if self.blocker is None else [self.blocker]


@dataclass(frozen=True)
class FanRay:
    """One of the rays from a hit to a light that is no point.

    Attributes
    ----------
    direction
        Unit vector away from the hit, in world space.
    length
        How far away the light is that way, in scene units; ``inf`` if it is without end.
    weight
        What the ray counts if nothing stops it: 1 on average for a light that the surface faces
        squarely, 0 for a ray that goes below the surface. Of a sky whose colour changes with the
        direction, the mean of what it counts for red, green and blue.
    blocker
        A surface on its way, or None.
    """

    direction: Vec
    length: float
    weight: float
    blocker: Surface | None

    @property
    def arrives(self) -> bool:
        """Whether light comes to the side of the surface that is seen."""
        return self.weight > 0.0 and self.blocker is None


@dataclass(frozen=True)
class ShadowFan:
    """The rays from a hit to a light that is no point.

    Attributes
    ----------
    light
        Place in ``scene.lights``.
    kind
        What light it is, in the words of scene files: "sun", "sphere", "rectangle", "sky" or
        "ambient".
    intensity
        The strength of the light: its intensity or its radiance.
    direction
        Unit vector from the hit to the middle of the light, in world space; where light comes from
        all sides, the normal of the hit.
    rays
        The rays. With one sample a pixel, those of the picture. Many lights share them: then there
        are none if the light as a whole is known to arrive or not, or if it can bring little. To
        ambient light of distance 0, which nothing keeps off, there are none.
    share
        How much of the light arrives: the mean weight of its rays, 0 for those that do not. Of a
        sky whose colour changes with the direction, the mean over red, green and blue.
    adds
        The red, green and blue that the light adds to the pixel.
    color
        The red, green and blue of the light, from 0 to 255.
    measure
        What its strength is called: "intensity" or "radiance".
    shares
        How much arrives of red, green and blue of a sky whose colour changes with the direction;
        None for other lights.
    """

    light: int
    kind: str
    intensity: float
    direction: Vec
    rays: tuple[FanRay, ...]
    share: float
    adds: Vec
    color: Vec
    measure: str
    shares: Vec | None = None

    @property
    def arriving(self) -> int:
        """How many of its rays arrive."""
        return sum(ray.arrives for ray in self.rays)

    @property
    def arrives(self) -> bool:
        """Whether any of its light reaches the side of the surface that is seen."""
        return self.share > 0.0

    @property
    def outcome(self) -> str:
        """In words, how many of its rays arrive."""
        if self.rays:
            return f"{self.arriving} of {len(self.rays)} rays arrive"
        return "all of it arrives" if self.arrives else "no ray goes to it"

    @property
    def is_behind(self) -> bool:
        """Whether all of the light is behind the surface."""
        return all(ray.weight == 0.0 for ray in self.rays)

    @property
    def blockers(self) -> list[Surface]:
        """What is in the way, each surface once, first those that stop most rays."""
        found = Counter(ray.blocker for ray in self.rays if ray.blocker is not None)
        return [surface for surface, _ in found.most_common()]


WayToLight: TypeAlias = ShadowRay | ShadowFan


@dataclass(frozen=True)
class Layer:
    """Where the ray of a pixel passes a body that takes a share of the light.

    Attributes
    ----------
    hit
        Where it comes to the body, or leaves it if it starts inside.
    share
        How much of the light from there is seen: the opacity of the body times what passes all
        layers before it, and what fog leaves of that.
    lights
        The ways to all lights, as those of `RayTree`.
    light
        The red, green and blue that the layer adds to the pixel.
    fog
        How much of what is seen there is fog, from 0 to 1.
    """

    hit: Hit
    share: float
    lights: tuple[WayToLight, ...]
    light: Vec
    fog: float = 0.0


@dataclass(frozen=True)
class Choice:
    """How a path goes on from a surface.

    Attributes
    ----------
    how
        What the surface does: the path is "mirrored", "refracted" or "scattered".
    chance
        With which chance that was chosen of all that the surface does.
    density
        How densely directions like that of the path were chosen, per steradian; None where there is
        but one, as for a smooth mirror, or where the path ends.
    goes_on
        With which chance the path goes on at all, from 0 to 1.
    share
        With which chance the material was chosen, where two are blended; else 1.
    """

    how: str
    chance: float
    density: float | None
    goes_on: float
    share: float


@dataclass(frozen=True)
class PathRay:
    """A ray of a path over surfaces, what it meets, and what that adds to the pixel.

    Attributes
    ----------
    parent
        The place in ``RayTree.path`` of the ray from whose hit it goes on; None for the first.
    how
        How it goes on from there: "mirrored", "refracted" or "scattered"; "seen" for the first.
    origin
        Where it starts, in world space.
    direction
        Its unit direction in world space.
    seen
        How much of its light is seen, for red, green and blue. Where a path goes on by chance, this
        is more than 1 for what is seldom chosen.
    passes
        What is left of that by the glass through which it goes, for red, green and blue; 1 without.
    distance
        How far it goes, in scene units; ``inf`` if it meets nothing.
    lamp
        The place in ``scene.lights`` of the lamp that it meets, or None.
    met
        The red, green and blue that lamps and skies add which it meets.
    light
        The red, green and blue that the ray adds to the pixel: that, and the light of its hit.
    hit
        The surface that it meets and that is looked at; None if there is none.
    material
        What that is made of; of a blend, that one of both which the path chose.
    shines
        The red, green and blue that the surface adds by shining.
    lights
        The ways from there to all lights, as those of `RayTree`; empty where nothing is scattered.
    shown
        How much of the colour of the surface is seen that its lights are scattered in, for red,
        green and blue; None for a surface with a coat, of which each light shows something else.
    choice
        How the path goes on from the hit; None where there is none, or where all ways are followed.
    """

    parent: int | None
    how: str
    origin: Vec
    direction: Vec
    seen: Vec
    passes: Vec
    distance: float
    lamp: int | None
    met: Vec
    light: Vec
    hit: Hit | None = None
    material: Material | None = None
    shines: Vec = (0.0, 0.0, 0.0)
    lights: tuple[WayToLight, ...] = ()
    shown: Vec | None = None
    choice: Choice | None = None


@dataclass(frozen=True)
class View:
    """The camera in world space; for a panorama, one that looks along the ray that is told.

    Attributes
    ----------
    center
        Centre of the image plane.
    right, down, forward
        The unit axes x', y' and z'.
    focus
        Distance from the eye to the image plane, in scene units; 0 for a panorama, which has none.
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
        weighted mean, which is not that of the ray in the middle alone. That of stars is a part.
    stars
        The red, green and blue that points add which shine; None without any in the scene.
    white
        The light that becomes 255; 0 if the whole picture is black.
    brightest
        Whether that is the brightest channel of the picture.
    background
        The share of the pixel that shows the background, from 0 to 1; 0 if that is black.
    sky
        The red, green and blue that the sky adds where it is the background, else None.
    value
        The pixel's channels in the picture, from 0 to 255.
    overlays
        The red, green and blue of the value, from 0 to 255, that fog of its own colour and outlines
        add.
    drawn
        What outlines and eye-dome lighting leave of the light; None if that is all of it.
    tonemap
        What made numbers of the light.
    """

    light: Vec
    stars: Vec | None
    white: float
    brightest: bool
    background: float
    sky: Vec | None
    value: tuple[int, ...]
    overlays: tuple[Vec, ...] = ()
    drawn: Vec | None = None
    tonemap: ToneMapName = "linear"


@dataclass(frozen=True)
class Veil:
    """What fog does to the light along a ray.

    Attributes
    ----------
    distance
        How far the ray goes through it, from the eye, in scene units.
    share
        How much of what is seen is fog, from 0 to 1.
    light
        What is left of the light: linear red, green and blue.
    is_counted
        Whether the light of the pixel, and how much of it is seen, have that counted already, as in
        scenes with faded bodies, where each layer has fog of its own before it.
    """

    distance: float
    share: float
    light: Vec
    is_counted: bool = False


@dataclass(frozen=True)
class TracedRays:
    """All rays of one pixel; `RayTree` says what each attribute is."""

    pixel: tuple[int, int]
    origin: Vec
    direction: Vec
    hit: Hit | None
    lights: tuple[WayToLight, ...]
    light: Vec
    view: View
    exposed: Exposed | None
    lamp: int | None
    scene: Scene = field(repr=False, compare=False)
    layers: tuple[Layer, ...] = ()
    share: float = 1.0
    veil: Veil | None = None
    path: tuple[PathRay, ...] = ()
    sample: int | None = None
