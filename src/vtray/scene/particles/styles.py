"""Styles of drawing particles: how large balls and bonds are."""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.camera import Camera
from vtray.scene.checks.choices import is_one_of
from vtray.scene.checks.scene_words import either, nearest, quoted, show
from vtray.scene.particles.elements import RADII, are_of_solids
from vtray.scene.particles.hydrogen_bonds import steps_of
from vtray.scene.particles.radii import FILLED, mean_spacing, radii_of
from vtray.scene.placing.directions import dot, unit
from vtray.scene.placing.panorama import pixel_angle

if TYPE_CHECKING:
    from vtray.scene.particles.bonds import Bonds
    from vtray.scene.particles.particles import Particles
    from vtray.scene.particles.radii import Radii

Floats = NDArray[np.float64]

FEW = 5000
"""How many atoms are drawn as balls and sticks, at the most, without being asked."""

STICK = 0.1
"""Radius of bonds beside balls, in ångström."""

THICK = 0.2
"""Radius of bonds without balls, in ångström."""

SLIM = 0.3
"""Radius of bonds whose ends are no elements, in radii of the smallest ball."""

COVERED = 0.75
"""Radius of a point in pixels: from 0.71 on, a disc has the middle of a pixel in it wherever it
lies."""


SOLID = 0.2
"""Share of metals and semimetals from which on atoms are those of a solid: there are fewer in
molecules, in frameworks of these, and among molecules that ions are dissolved in."""

BESIDE = 0.3
"""Radius of balls beside sticks whose size is not known, in bond lengths of the usual bond: about
that of carbon."""


class Style(NamedTuple):
    """A style.

    Attributes
    ----------
    table
        Which radii of elements it uses unless it is told otherwise, but for solids of metals.
    shares
        What of these, and of others, is the radius of a ball.
    stick
        Radius of bonds in ångström; None if there are none unless they are asked for.
    """

    table: str
    shares: Mapping[str, float]
    stick: float | None


STYLES: Mapping[str, Style] = MappingProxyType(
    {
        "spacefill": Style("vdw", {"vdw": 1.0, "covalent": 1.0}, None),
        "ball-and-stick": Style("covalent", {"vdw": 0.25, "covalent": 0.6}, STICK),
        "licorice": Style("covalent", {}, THICK),
        "points": Style("covalent", {}, None),
    }
)


def style_of(name: str | None, particles: "Particles", bonds: object, hydrogen_bonds: bool) -> str:
    """Return the name of a style, or of that which fits the particles.

    Parameters
    ----------
    name
        The name; None for ball-and-stick if bonds or hydrogen bonds are asked for, or bonds known
        between at most `FEW` atoms, and else spacefill.
    particles
        The particles.
    bonds
        What was given for them: None for nothing, False for none.
    hydrogen_bonds
        Whether they are drawn: balls of spacefill would hide them.

    Raises
    ------
    SceneError
        There is no such style.
    """
    if name is None:
        known = particles.bonds is not None and len(particles.bonds) > 0
        few = "element" in particles.columns and len(particles) <= FEW
        has_bonds = (known and few) if bonds is None else bonds is not False
        return "ball-and-stick" if has_bonds or hydrogen_bonds else "spacefill"
    if not is_one_of(name, STYLES):
        close = nearest(name, list(STYLES), cutoff=0.6) if isinstance(name, str) else ""
        hint = f"; did you mean {close}?" if close else ""
        raise SceneError(f"style: expected {either(map(quoted, STYLES))}, got {show(name)}{hint}")
    return name


def ball_radii(
    particles: "Particles", style: str, radii: "Radii | None", scale: float
) -> Floats | float:
    """Return the radii of balls in the unit of the positions, (n,), or one for all.

    Parameters
    ----------
    particles
        The particles.
    style
        The name of a style whose balls have a size: not points.
    radii
        As for `radii_of`. None for the column ``radius``, those of the elements, or half the mean
        distance of particles, whichever is there first.
    scale
        What all are multiplied by.
    """
    known = STYLES[style]
    if radii is None:
        radii = default_radii(particles, known.table)
    if style == "licorice":
        return stick_radius(particles, style, radii, scale)
    share = known.shares.get(radii, 1.0) if isinstance(radii, str) else 1.0
    return radii_of(particles, radii, "radii") * (share * scale)


def default_radii(particles: "Particles", table: str) -> "Radii":
    """Return what the radii of particles are where nothing is said."""
    if "radius" in particles.columns:
        return "radius"
    if "element" not in particles.columns:
        return FILLED * mean_spacing(particles)
    return "covalent" if table == "covalent" or _is_solid(particles) else table


def _is_solid(particles: "Particles") -> bool:
    """Tell whether particles are a solid of metals, or of semimetals, by what they are made of.

    Its atoms are as near each other as covalent radii say. Balls of van der Waals radii, which tell
    how near molecules are, would be half within each other, and hide how they stand.
    """
    count = np.count_nonzero(are_of_solids(particles["element"]))
    return len(particles) > 0 and bool(count >= SOLID * len(particles))


def radius_beside(
    particles: "Particles", style: str, bonds: "Bonds", positions: NDArray[Any]
) -> float | None:
    """Return the radius of balls by how long bonds are; None where it is known otherwise.

    Parameters
    ----------
    particles, style
        The particles, and the name of the style.
    bonds, positions
        Those that are drawn, and where all particles are, (n, 3).
    """
    is_known = not {"radius", "element"}.isdisjoint(particles.columns)
    if is_known or STYLES[style].stick is None or not len(bonds):
        return None
    x, y, z = steps_of(particles, bonds, positions)
    squares = x * x + y * y + z * z
    usual = math.sqrt(np.partition(squares, len(squares) // 2)[len(squares) // 2])
    return BESIDE * usual if usual > 0.0 else None


def stick_radius(particles: "Particles", style: str, radii: "Radii | None", scale: float) -> float:
    """Return the radius of bonds in the unit of the positions.

    Parameters
    ----------
    particles, style, radii, scale
        As for `ball_radii`.
    """
    stick = STYLES[style].stick or STICK
    if radii is None:
        radii = default_radii(particles, STYLES[style].table)
    if isinstance(radii, str) and radii in RADII:
        return stick * scale
    found = np.asarray(radii_of(particles, radii, "radii"))
    least = found[found > 0.0]
    return (float(least.min()) if least.size else 1.0) * SLIM * (stick / STICK) * scale


def screen_radii(
    positions: NDArray[Any], camera: Camera, pixels: float, places: Floats
) -> Floats | float:
    """Return radii with which spheres are of one size in the picture, whatever their distance.

    Parameters
    ----------
    positions
        Their centres in world space, (n, 3).
    camera
        The camera of the picture, with its size.
    pixels
        The radius in pixels.
    places
        Translations of copies, (m, 3): the radius is that for the one farthest away.
    """
    if camera.projection == "panorama":
        return _radii_around(positions, camera, pixels, places)
    pixel = pixels * max(camera.resolution)
    if camera.projection == "orthographic":
        return pixel
    x, y, z = unit(camera.normal)
    center = camera.center
    ahead = (positions[:, 0] - center.x) * x
    ahead += (positions[:, 1] - center.y) * y
    ahead += (positions[:, 2] - center.z) * z
    farthest = max(dot((x, y, z), (a, b, c)) for a, b, c in places.tolist())
    # Behind the image plane nothing is seen.
    distance = np.maximum(ahead + (camera.focus + farthest), camera.focus)
    radii: Floats = distance * (pixel / camera.focus)
    return radii


def _radii_around(positions: NDArray[Any], camera: Camera, pixels: float, places: Floats) -> Floats:
    """Return such radii for a panorama."""
    center = camera.center
    farthest = np.zeros(len(positions))
    for place in places:
        x, y, z = (positions + place - (center.x, center.y, center.z)).T
        np.maximum(farthest, np.sqrt(x * x + y * y + z * z), out=farthest)
    return farthest * (pixels * pixel_angle(camera))
