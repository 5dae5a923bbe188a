"""Scale bars: lengths that read well, and how long they are in a picture."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import Decimal
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from vtray.base.caller_warning import warn_caller
from vtray.figures.point import point_of
from vtray.figures.projection import project
from vtray.figures.seen_objects import objects_seen
from vtray.figures.sheet import FigureError
from vtray.figures.subject import Subject
from vtray.scene.scene import Camera, Plane, Scene, Sphere, Spheres
from vtray.scene.stars import Stars

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Floats = NDArray[np.float64]

SHARE = 0.25
"""The share of the picture's width that a scale bar takes at most."""

ENOUGH = 2**18
"""So many points that shine, spread evenly over all, tell their median."""

PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f"))
"""The prefixes of SI for less than a metre."""


@dataclass(frozen=True)
class ScaleBar:
    """A scale bar.

    Attributes
    ----------
    length
        In scene units.
    pixels
        In pixels of the picture.
    text
        What is written beside it.
    note
        If it is right at one distance only, and the text does not say so, what says at which; ""
        otherwise.
    """

    length: float
    pixels: float
    text: str
    note: str = ""

    def written(self, write: Callable[[str], str]) -> Self:
        """Return it with what a function makes of its texts."""
        return replace(self, text=write(self.text), note=write(self.note))


def scale_bar(image: Subject, scalebar: object, at: "ArrayLike | None") -> ScaleBar | None:
    """Return the scale bar of an image, None if it should have none; see `vtray.Image.figure`."""
    if not isinstance(scalebar, (bool, str)):
        message = f'scalebar: expected True, False or a unit such as "nm", got {scalebar!r}'
        raise FigureError(message)
    depth = _depth_of(image, at)
    if scalebar is False:
        return None
    camera = image.scene.camera
    if camera.projection == "panorama":
        message = "scalebar: lengths differ from place to place in a panorama; give False"
        raise FigureError(message)
    own = isinstance(scalebar, str) and "{length}" in scalebar
    unit = "" if own or scalebar is True else str(scalebar)
    pattern = str(scalebar) if own else "{length}"
    if not own and camera.resolution[0] != camera.resolution[1]:
        pattern += " (horizontally)"
    everywhere = is_orthographic(camera)
    if depth is None and (not everywhere or "{distance}" in pattern):
        depth = _median_depth(image)
        if depth is None:
            if scalebar is not True:  # which is usual in figures, empty ones too
                words = "nothing is seen whose distance it could be right at, so it is left out"
                warn_caller(f"scalebar: {words}; give a point as at")
            return None
    pixel = pixel_width(camera, depth or 0.0)
    length = round_length(SHARE * camera.size[0] * pixel)
    text, note = pattern.replace("{length}", with_unit(length, unit)), ""
    if depth is not None:
        text = text.replace("{distance}", f"{depth:.4g}")
        if not (own or everywhere):
            note = f"at a distance of {with_unit(depth, unit)}"
    return ScaleBar(length, length / pixel, text, note)


def _median_depth(image: Subject) -> float | None:
    """Return the median distance of what is seen, along the view; None if nothing is.

    Planes, which have no end, only count where there is nothing else, and points that shine, which
    no pixel is that of, where no surface is seen.
    """
    places = image.shown.ids[..., 0]
    planes = [k for k, item in enumerate(image.scene.objects) if isinstance(item, Plane)]
    seen = (places >= 0) & ~np.isin(places, planes)
    if not seen.any():
        seen = places >= 0
    depths = _seen_depths(image, seen) if seen.any() else _depths_of_stars(image.scene)
    return float(np.median(depths)) if len(depths) else None


def _seen_depths(image: Subject, seen: NDArray[np.bool_]) -> Floats:
    """Return how far from the eye along z' what some pixels show is, (n,).

    That of a ball is where its centre is, and there it is as wide as its diameter. Other surfaces
    are where they are seen, and so are balls that are like a floor, with a centre that is not in
    the picture.
    """
    camera, shown = image.scene.camera, image.shown
    depths = depth_along_view(camera, shown.depth)[seen]
    copies = shown.copies[seen]
    for item, pixels, rows, among in objects_seen(image.scene.objects, shown.ids[seen]):
        if isinstance(item, (Sphere, Spheres)):
            centers = _centers(item)[rows]
            if among is not None:
                centers = centers + among.at[copies[pixels]]
            found, inside = _places_in(camera, centers)
            depths[pixels] = np.where(inside, found, depths[pixels])
    return depths


def _depths_of_stars(scene: Scene) -> Floats:
    """Return how far from the eye along z' points that shine are, if they are in the picture."""
    found = [np.zeros(0)]
    for item in scene.objects:
        if isinstance(item, Stars):
            depths, shown = _places_in(scene.camera, item.center[:: -(-len(item) // ENOUGH) or 1])
            found.append(depths[shown])
    return np.concatenate(found)


def _centers(item: Sphere | Spheres) -> NDArray[Any]:
    """Return the centres of balls, (n, 3)."""
    if isinstance(item, Spheres):
        return item.center
    return np.array([[item.center.x, item.center.y, item.center.z]])


def _places_in(camera: Camera, points: NDArray[Any]) -> tuple[Floats, NDArray[np.bool_]]:
    """Return how far from the eye along z' points are, and which are in the picture, (n,)."""
    column, row, depth = project(camera, points)
    width, height = camera.size
    # No comparison holds for a point behind the eye, whose place is not a number.
    across, down = abs(column - width / 2) <= width / 2, abs(row - height / 2) <= height / 2
    return depth, across & down


def _depth_of(image: Subject, at: "ArrayLike | None") -> float | None:
    """Return how far from the eye along z' a point lies."""
    if at is None:
        return None
    point = point_of(at)
    if point is None:
        message = f"at: expected a point of three finite numbers, or None, got {at!r}"
        raise FigureError(message)
    depth = float(project(image.scene.camera, point[None]).depth[0])
    if not depth > 0:
        message = f"at: expected a point in front of the eye, got {at!r}"
        raise FigureError(message)
    return depth


def round_length(limit: float) -> float:
    """Return the largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is at most `limit`."""
    exponent = math.floor(math.log10(limit))
    candidates = (
        float(f"{digit}e{power}") for power in (exponent + 1, exponent) for digit in (5, 2, 1)
    )
    below = float(f"5e{exponent - 1}")
    return next((length for length in candidates if length <= limit), below)


def length_text(length: float) -> str:
    """Return a length as people read it: 0.5, 20, 2e-9."""
    return f"{Decimal(repr(length)).normalize():f}" if 1e-4 < length < 1e6 else f"{length:g}"


def with_unit(length: float, unit: str) -> str:
    """Return a length of three digits with its unit, "" for none; few metres as nm, µm or mm."""
    scale, prefix = 1.0, ""
    if unit == "m":
        scale, prefix = next((row for row in PREFIXES if 10.0 * length >= row[0]), PREFIXES[-1])
    number = length_text(float(f"{length / scale:.3g}"))
    return f"{number} {prefix}{unit}" if unit else number


def is_orthographic(camera: Camera) -> bool:
    """Tell whether all rays of a camera are parallel."""
    return camera.projection == "orthographic"


def pixel_width(camera: Camera, depth: float) -> float:
    """Return how many scene units a pixel is wide, `depth` units from the eye along z'."""
    width = camera.resolution[0]
    return width if is_orthographic(camera) else width * depth / camera.focus


def depth_along_view(camera: Camera, distance: Floats) -> Floats:
    """Return how far from the eye along z' the hits of all pixels are.

    Parameters
    ----------
    camera
        The camera.
    distance
        From the origin of each pixel's ray to its hit, (height, width); in a panorama, that is
        what is returned.
    """
    if is_orthographic(camera) or camera.projection == "panorama":
        return distance
    height, width = distance.shape
    across = (np.arange(width) - width / 2) * (camera.resolution[0] / camera.focus)
    down = (np.arange(height) - height / 2) * (camera.resolution[1] / camera.focus)
    depth: Floats = distance / np.hypot(np.hypot(across, down[:, None]), 1.0)
    return depth
