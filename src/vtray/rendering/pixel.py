"""One pixel of a scene, and what is told of anything that its rays meet."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import uncompiled
from vtray.figures.traced_rays import Hit, WayToLight
from vtray.geometry.packets.packet import CAP, SECOND
from vtray.geometry.vector import Vec
from vtray.rendering.numbering import Numbering
from vtray.rendering.pack import Packed
from vtray.rendering.pack_looks import materials_by_row
from vtray.rendering.pixel_crowd import trace_shared
from vtray.rendering.pixel_lights import Lit, shadow_rays, trace_fans
from vtray.rendering.pixel_surfaces import as_vec, find_surface
from vtray.scene.colors.color_light import as_light, numbers_of_light
from vtray.scene.patterns import Pattern
from vtray.scene.scene import Scene
from vtray.transport.integrators.reference import TracedPixel
from vtray.transport.materials.material import pattern_of
from vtray.transport.sampling.estimate import AS_NEEDED
from vtray.transport.sampling.fans import Fans


class Pixel(NamedTuple):
    """A pixel of a scene.

    Attributes
    ----------
    scene, numbering
        The scene, and the numbers of its primitives.
    packed
        Its arrays.
    place
        The column and the row of the pixel.
    fans, are_shared
        Which rays are cast to soft lights, None without any; and whether all lights share them.
    seed
        The seed of the picture.
    fan_count
        How many fans each soft light has from a hit, if it is not ``AS_NEEDED``.
    """

    scene: Scene
    numbering: Numbering
    packed: Packed
    place: tuple[int, int]
    fans: Fans | None
    are_shared: bool
    seed: int
    fan_count: int = AS_NEEDED


def in_world(pixel: Pixel, point: Vec) -> Vec:
    """Return a point of the arrays in world space."""
    center, unit = pixel.scene.camera.center, pixel.packed.unit
    return (
        center.x + float(point[0]) * unit,
        center.y + float(point[1]) * unit,
        center.z + float(point[2]) * unit,
    )


def hit_of(pixel: Pixel, traced: TracedPixel, before: float = 0.0) -> Hit:
    """Return what is hit; its distance is longer by `before`, in scene units."""
    half, packed = traced.interaction.half, pixel.packed
    is_second = half & SECOND != 0
    surface = find_surface(pixel.scene, pixel.numbering, traced.primitive, is_second=is_second)
    tonemap, color, pattern = pixel.scene.render.tonemap, as_vec(traced.color), None
    if color != as_light(surface.color, tonemap):
        surface = replace(surface, color=numbers_of_light(color, tonemap))
        pattern = None if half & CAP else _pattern_of(packed, traced.primitive)
    distance = traced.distance * packed.unit + before
    point, normal, _, _ = traced.interaction
    return Hit(surface, distance, in_world(pixel, point), as_vec(normal), pattern)


def _pattern_of(packed: Packed, primitive: int) -> Pattern | None:
    """Return the pattern of a primitive."""
    patterns = packed.arrays.materials.paints.patterns
    if patterns is None:
        return None
    row = uncompiled(pattern_of)(packed.arrays.materials, patterns, primitive)
    return materials_by_row(packed.made)[row].pattern


def ways_to_lights(
    pixel: Pixel,
    traced: TracedPixel,
    hit: Hit,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
) -> tuple[tuple[WayToLight, ...], Vec]:
    """Return the ways from a hit to all lights, and the light that they bring.

    Parameters
    ----------
    pixel, traced, hit
        The hit, with the light of points.
    cosines, blockers
        What `reference.trace_pixel` writes of these.
    """
    lit = Lit(pixel.scene, pixel.numbering, hit, traced.material.color)
    known = lit, pixel.packed, traced, pixel.place
    if pixel.fans is not None and pixel.are_shared:
        fans, light = trace_shared(*known, pixel.fans, pixel.seed)
    else:
        fans, light = trace_fans(*known, pixel.fans, pixel.fan_count, pixel.seed)
    ways = [*shadow_rays(lit, cosines, blockers), *fans]
    return tuple(sorted(ways, key=lambda way: way.light)), light
