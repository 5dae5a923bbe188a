"""What the surfaces of a scene are made of."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec
from vtray.transport.materials.lambert import lambert_light

Floats = NDArray[np.float64]
Bytes = NDArray[np.uint8]


class Materials(NamedTuple):
    """Colours, (n, 3), and Lambert coefficients, (n,), by the numbers of the primitives.

    Attributes
    ----------
    color, lambert
        Those of bounded shapes; one row may stand for all.
    plane_color, plane_lambert
        Those of planes.
    planes
        The number of the first plane.
    """

    color: Bytes
    lambert: Floats
    plane_color: Bytes
    plane_lambert: Floats
    planes: int


class Material(NamedTuple):
    """What a surface is made of: its colour, 0 to 255, and the share of light it scatters."""

    color: Vec
    lambert: float


@device
def load_material(materials: Materials, primitive: int) -> Material:
    """Return the material of a primitive."""
    plane = primitive - materials.planes
    if plane >= 0:
        return Material(_triple(materials.plane_color, plane), materials.plane_lambert[plane])
    color, lambert = materials.color, materials.lambert
    # One row may stand for all.
    row = min(primitive, color.shape[0] - 1)
    return Material(_triple(color, row), lambert[min(primitive, lambert.shape[0] - 1)])


@device
def scattered(material: Material, cosine: float, intensity: float) -> Vec:
    """Return the light that a surface scatters to the viewer.

    Parameters
    ----------
    material
        What it is made of.
    cosine
        That of the angle at which the light comes, 0 where none does.
    intensity
        The light's intensity.
    """
    return lambert_light(material.color, material.lambert, cosine, intensity)


@device
def _triple(rows: Bytes, k: int) -> Vec:
    """Return a row of an (n, 3) array as numbers."""
    return float(rows[k, 0]), float(rows[k, 1]), float(rows[k, 2])
