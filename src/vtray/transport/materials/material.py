"""What the surfaces of a scene are made of."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.compiler.unseen import apart
from vtray.geometry.packets.packet import CAP, SECOND
from vtray.geometry.vector import Vec
from vtray.transport.materials.lambert import lambert_light
from vtray.transport.materials.look import Look, Looks, look_of
from vtray.transport.materials.pattern import Patterns

Integers = NDArray[np.int64]


@apart
class Paints(NamedTuple):
    """Colours, and all else that is seen of a matt surface.

    Attributes
    ----------
    color
        Colours, (rows, 3).
    light
        What each number of a colour is as light, 255 for white, (256,).
    lambert
        Lambert coefficients, (rows,).
    cap
        The colour of all that closes what clip planes cut, as light, negative if it is that of what
        is cut; None where nothing is cut.
    patterns
        The patterns of surfaces; None where there are none.
    """

    color: NDArray[np.uint8]
    light: NDArray[np.float64]
    lambert: NDArray[np.float64]
    cap: Vec | None
    patterns: Patterns | None


class Materials(NamedTuple):
    """What primitives are made of, by ranges of their numbers.

    The colour of the k-th primitive of a range stands in row ``color_row + k * color_step``: the
    step is 0 where one row stands for all. Likewise for the others. Copies of the same primitives
    are one range, in which those of each copy begin anew with k = 0.

    Attributes
    ----------
    first
        The number of the first primitive of each range, from 0 on, (ranges,).
    each
        How many primitives one copy has, or more than there are in the range, (ranges,).
    color_row, color_step
        The rows of their colours, (ranges,).
    end_row, end_step
        Those of the colours of second halves; equal to the colours where there are no halves.
    lambert_row, lambert_step
        Those of their Lambert coefficients.
    paints
        What stands in these rows.
    looks
        How mirrors and glass look; None where there are none, or they are not shown as such.
    """

    first: Integers
    each: Integers
    color_row: Integers
    color_step: Integers
    end_row: Integers
    end_step: Integers
    lambert_row: Integers
    lambert_step: Integers
    paints: Paints
    looks: Looks | None


class Material(NamedTuple):
    """What a surface is made of: its colour as light, 0 to 255, and what share it scatters."""

    color: Vec
    lambert: float


class Power(NamedTuple):
    """How strong a light is, and its colour, 1 for white."""

    intensity: float
    color: Vec


@device
def _range_of(materials: Materials, primitive: int) -> tuple[int, int]:
    """Return the range of a primitive, and its place there."""
    k = materials.first.shape[0] - 1
    while primitive < materials.first[k]:
        k -= 1
    place = primitive - materials.first[k]
    if place >= materials.each[k]:
        place %= materials.each[k]
    return k, place


@device
def load_look(materials: Materials, looks: Looks, primitive: int) -> Look:
    """Return how a primitive looks."""
    k, place = _range_of(materials, primitive)
    return look_of(looks, k, place)


@device
def pattern_of(materials: Materials, patterns: Patterns, primitive: int) -> int:
    """Return the row of the pattern of a primitive."""
    k, place = _range_of(materials, primitive)
    return int(patterns.which[patterns.row[k] + place * patterns.step[k]])


@device
def load_material(materials: Materials, primitive: int, half: int) -> Material:
    """Return the material of a primitive, or of that part of it that `half` says, but for patterns.

    It is what stands in field ``HALF`` of a packet.
    """
    k, place = _range_of(materials, primitive)
    row = materials.color_row[k] + place * materials.color_step[k]
    if half & SECOND:
        row = materials.end_row[k] + place * materials.end_step[k]
    color, light, lambert = materials.paints.color, materials.paints.light, materials.paints.lambert
    own = light[color[row, 0]], light[color[row, 1]], light[color[row, 2]]
    return Material(
        _cap_color(materials.paints.cap, half, own),
        lambert[materials.lambert_row[k] + place * materials.lambert_step[k]],
    )


@device
def _cap_color(cap: Vec | None, half: int, own: Vec) -> Vec:
    """Return the colour of a surface that is maybe a cap, given that of what it belongs to."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if cap is not None:
        is_cap = (half & CAP != 0) & (cap[0] >= 0.0)
        return (
            cap[0] if is_cap else own[0],
            cap[1] if is_cap else own[1],
            cap[2] if is_cap else own[2],
        )
    return own


@device
def scattered(material: Material, cosine: float, power: Power) -> Vec:
    """Return the light that a surface scatters to the viewer.

    Parameters
    ----------
    material
        What it is made of.
    cosine
        That of the angle at which the light comes, 0 where none does.
    power
        The light's intensity and colour.
    """
    red, green, blue = lambert_light(material.color, material.lambert, cosine, power.intensity)
    return red * power.color[0], green * power.color[1], blue * power.color[2]
