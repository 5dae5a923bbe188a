"""Labels: text at points of the scene."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import hypotenuse
from vtray.figures.point import point_of
from vtray.figures.projection import project
from vtray.figures.scale_bar import depth_along_view
from vtray.figures.sheet import FigureError
from vtray.figures.subject import Floats, Subject
from vtray.scene.copies import Copies
from vtray.scene.placing.directions import Vec, along, dot
from vtray.scene.vectors import Vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    LabelsGiven: TypeAlias = Mapping[str, ArrayLike] | Iterable[tuple[str, ArrayLike]]

WANTED = 'pairs of a text and a point, such as ("O", (0, 0, 1))'


class Label(NamedTuple):
    """A text at a place of a picture.

    Attributes
    ----------
    text
        What is written, its middle at the place.
    column, row
        In pixels from the left and from the top; those of a pixel itself are integers.
    depth
        How far from the eye along the view it is, in scene units.
    """

    text: str
    column: float
    row: float
    depth: float


def shown_labels(image: Subject, labels: "LabelsGiven", *, hide: bool) -> list[Label]:
    """Return the labels that are in a picture, those of far points first.

    Parameters
    ----------
    image
        The picture.
    labels
        A text and a point in world space each; or points by their texts.
    hide
        Whether to leave out those of points that are behind something. The sphere or cylinder in
        which a point lies does not count.

    Raises
    ------
    FigureError
        A label is not one.
    """
    texts, points = _read(labels)
    camera = image.scene.camera
    column, row, depth = project(camera, points)
    height, width = image.linear.shape[:2]
    with np.errstate(invalid="ignore"):
        inside = (column >= -0.5) & (column < width - 0.5) & (row >= -0.5) & (row < height - 0.5)
    nearest = camera.focus
    if camera.projection == "panorama":  # which shows all directions, those at its edges, too
        inside, nearest = np.isfinite(column), 0.0
    shown = np.flatnonzero(inside & (depth > nearest))
    if hide and len(shown):
        shown = shown[~_hidden(image, points[shown], column[shown], row[shown], depth[shown])]
    shown = shown[np.argsort(-depth[shown], kind="stable")]
    return [
        Label(texts[k], float(column[k]), float(row[k]), float(depth[k])) for k in shown.tolist()
    ]


def _read(labels: Any) -> tuple[list[str], Floats]:  # noqa: ANN401
    """Return the texts of labels, and their points, (n, 3)."""
    try:
        pairs = list(labels.items() if isinstance(labels, Mapping) else labels)
    except TypeError:
        message = f"labels: expected {WANTED}, got {labels!r}"
        raise FigureError(message) from None
    texts, points = [], np.zeros((len(pairs), 3))
    for k, pair in enumerate(pairs):
        try:
            text, point = pair
        except (TypeError, ValueError):
            text, point = "", None
        place = point_of(point)
        if not isinstance(text, str) or not text.strip() or place is None:
            message = f"labels[{k}]: expected {WANTED}, got {pair!r}"
            raise FigureError(message)
        texts.append(text)
        points[k] = place
    return texts, points


def _hidden(
    image: Subject, points: Floats, column: Floats, row: Floats, depth: Floats
) -> NDArray[np.bool_]:
    """Tell of points that are in the picture which are behind something, (n,)."""
    across, down = (
        np.minimum(np.floor(place + 0.5).astype(np.intp), size - 1)
        for place, size in zip((column, row), reversed(image.depth.shape), strict=True)
    )
    seen = depth_along_view(image.scene.camera, image.depth)[down, across]
    hidden: NDArray[np.bool_] = seen < depth
    for k in np.flatnonzero(hidden):
        hidden[k] = not _is_within(image, int(down[k]), int(across[k]), points[k])
    return hidden


def _is_within(image: Subject, row: int, column: int, point: Floats) -> bool:
    """Tell whether a point lies in the sphere or cylinder that a pixel shows.

    Cylinders count as if their ends were round.
    """
    place, index = image.ids[row, column].tolist()
    item: Any = image.scene.objects[place]
    if isinstance(item, Copies):
        point = point - np.asarray(item.at, np.float64)[image.copies[row, column]]
        place, index = item.locate(index)
        item = item.objects[place]
    if not hasattr(item, "hull"):
        return False
    hull = item.hull()
    start, end = (_row(hull[k][0], index) for k in (0, -1))
    radius = max(_number(radius, index) for _, radius, _ in hull)
    x, y, z = point.tolist()
    axis = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    arm = (x - start[0], y - start[1], z - start[2])
    square = dot(axis, axis)
    share = min(max(dot(arm, axis) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return hypotenuse(*along(arm, -share, axis)) <= radius


def _number(values: Any, index: int) -> float:  # noqa: ANN401
    """Return one of some numbers, (n,), or the one that there is for all."""
    each = np.atleast_1d(values)
    return float(each[index if len(each) > 1 else 0])


def _row(points: Any, index: int) -> Vec:  # noqa: ANN401
    """Return one of points, (n, 3), or the one that there is."""
    if isinstance(points, Vector):
        return points.x, points.y, points.z
    x, y, z = np.asarray(points[index], np.float64).tolist()
    return x, y, z
