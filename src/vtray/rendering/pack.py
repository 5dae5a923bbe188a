"""From a scene to the arrays that kernels read."""

import math
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import input_array
from vtray.geometry.bvh.tree import Frame, no_bvh
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.vector import Vec
from vtray.geometry.world import CYLINDER, NO_TREE, PLANE, SPHERE, Groups, ToBoxes, World
from vtray.rendering.hierarchy import Acceleration
from vtray.scene.placing.directions import camera_axes, view_axes
from vtray.scene.placing.directions import unit as unit_vector
from vtray.scene.scene import Camera, Plane, Scene, Vector
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.lights.light import Lights
from vtray.transport.materials.material import Materials
from vtray.transport.scene_arrays import SceneArrays

Floats = NDArray[np.float64]

FARTHEST_START = 2.0**30
"""Rays start no farther before the image plane than so many times its width and height.

An eye that is farther away sees the scene along rays that differ by less than 1e-9: they start side
by side, where they pass a plane nearby. Started at the eye, rounding would move what they meet, and
lose what is near the image plane: from 1e15 times the size of the scene on, all of it.
"""

LARGEST_RATIO = 2.0**100
"""Spheres so tiny beside all else that this is exceeded are traced without their hierarchy."""


class Packed(NamedTuple):
    """The arrays of a scene, and what leads back from them to the scene.

    Attributes
    ----------
    arrays
        What the kernels read.
    unit
        Length in scene units of length 1 in the arrays, a power of two.
    before
        Length in scene units of each ray from the eye to where it starts in the arrays.
    """

    arrays: SceneArrays
    unit: float
    before: float


def pack(scene: Scene, kept: Acceleration) -> Packed:
    """Return the arrays of a scene, whose spheres are ready for tracing."""
    planes = [item for item in scene.objects if isinstance(item, Plane)]
    unit = _unit_length(scene, planes, kept)
    camera = _pack_camera(scene.camera, unit)
    origin = _points([scene.camera.center], unit)[0]
    x, y, z = map(float, origin)
    arrays = SceneArrays(
        camera,
        _pack_world(planes, kept, unit, (x, y, z)),
        _pack_lights(scene, origin, unit, camera),
        _pack_materials(kept, planes),
    )
    return Packed(arrays, unit, scene.camera.focus - start_distance(scene.camera))


def _pack_world(planes: list[Plane], kept: Acceleration, unit: float, origin: Vec) -> World:
    """Return what rays can meet."""
    rows: list[tuple[tuple[int, ...], tuple[float, ...]]] = []
    columns: dict[int, Columns] = {}
    number = 0
    for shapes in kept.shapes:
        to_boxes = _pack_to_boxes(shapes.frame, origin, unit)
        root = shapes.root if to_boxes.ratio < LARGEST_RATIO else NO_TREE
        frame = 0.0, 0.0, 0.0, to_boxes.ratio, *to_boxes.offset
        rows.append(((shapes.kind.shape, 0, shapes.count, root, number), frame))
        columns[shapes.kind.shape] = shapes.columns
        number += shapes.count
    rows.insert(0, ((PLANE, 0, len(planes), NO_TREE, number), (0.0,) * 7))
    return World(
        _pack_groups([row for row in rows if row[0][2]]),
        _pack_planes(planes),
        columns[SPHERE],
        columns[CYLINDER] if columns[CYLINDER].number.size else None,
        kept.bvh if any(row[3] != NO_TREE for row, _ in rows) else no_bvh(),
        1.0 / unit,
        origin,
    )


def _pack_groups(rows: list[tuple[tuple[int, ...], tuple[float, ...]]]) -> Groups:
    """Return groups, a row for each: its integers, and where it stands."""
    columns = np.array([integers for integers, _ in rows], np.int64).reshape(-1, 5).T
    kind, begin, end, root, number = np.ascontiguousarray(columns)
    frames = np.array([frame for _, frame in rows]).reshape(-1, 7)
    return Groups(kind, begin, end, root, number, frames)


def start_distance(camera: Camera) -> float:
    """Return how far before the image plane rays start, in scene units."""
    across, below = (n * length for n, length in zip(camera.size, camera.resolution, strict=True))
    view = across + below
    return camera.focus if camera.focus <= FARTHEST_START * view else view


def _exponent(value: float) -> int:
    """Return the smallest e with abs(value) < 2**e, very low for 0."""
    return math.frexp(value)[1] if value else -2000


def _unit_length(scene: Scene, planes: list[Plane], kept: Acceleration) -> float:
    """Return the power of two by which the lengths of a scene are divided."""
    camera = scene.camera
    places = [camera.center, *(plane.center for plane in planes)]
    places += [light.location for light in scene.lights]
    coordinates = max(max(abs(p.x), abs(p.y), abs(p.z)) for p in places)
    highest = max(_start_exponent(camera), _exponent(coordinates), _exponent(kept.largest))
    # The unit itself and its inverse must be ordinary doubles.
    return math.ldexp(1.0, max(highest - 200, -1000))


def _start_exponent(camera: Camera) -> int:
    """Return an e with all coordinates below 2**e at which rays start, and not far below."""
    start = start_distance(camera)
    together = camera.projection != "orthographic" and start == camera.focus
    return _exponent(start) if together else max(_exponent(start), _view_exponent(camera))


def _view_exponent(camera: Camera) -> int:
    """Return an e with width and height of the view below 2**e, and the larger not far below."""
    return max(
        _exponent(camera.resolution[0]) + _exponent(camera.size[0]),
        _exponent(camera.resolution[1]) + _exponent(camera.size[1]),
    )


def _pack_camera(camera: Camera, unit: float) -> CameraFrame:
    """Return the camera's frame, lengths in units."""
    forward = unit_vector(camera.normal)
    if camera.up is None:
        right, down = camera_axes(forward)
    else:
        right, down = view_axes(forward, unit_vector(camera.up))
    start = start_distance(camera)
    image_distance = start / unit
    width, height = camera.resolution
    if camera.projection == "orthographic":
        share, pixel = 1.0, (0.0, 0.0, 1.0)
    else:
        # How much of the way from the eye to the image plane lies before the start of the rays.
        share = 1.0 - start / camera.focus
        pixel = _pack_pixel(camera)
    shift = share * width / unit, share * height / unit
    extent = camera.size[0] * shift[0] + camera.size[1] * shift[1]
    return CameraFrame(
        eye=(
            -image_distance * forward[0],
            -image_distance * forward[1],
            -image_distance * forward[2],
        ),
        right=right,
        down=down,
        forward=forward,
        image_distance=image_distance,
        pixel=pixel,
        shift=shift,
        extent=extent,
        width=int(camera.size[0]),
        height=int(camera.size[1]),
    )


def _pack_pixel(camera: Camera) -> Vec:
    """Return a pixel's width and height and the focus, in a unit in which they make directions."""
    # Far above 1, so that what is far smaller keeps its digits.
    own = 500 - max(_view_exponent(camera), _exponent(camera.focus))
    width, height = (math.ldexp(length, own) for length in camera.resolution)
    # Not 0: there is a ray in the middle, however near the eye is.
    return width, height, max(math.ldexp(camera.focus, own), sys.float_info.min)


def _pack_to_boxes(frame: Frame, origin: Vec, unit: float) -> ToBoxes:
    """Return what leads to the space of the boxes."""
    ratio = frame.scale * unit
    (x, y, z), (a, b, c) = origin, frame.origin
    return ToBoxes(ratio, (x * ratio - a, y * ratio - b, z * ratio - c))


def _pack_materials(kept: Acceleration, planes: list[Plane]) -> Materials:
    """Return the materials of all primitives, a range for each kind of shape."""
    plane_color = [(plane.color.r, plane.color.g, plane.color.b) for plane in planes]
    plane_lambert = [plane.lambert for plane in planes]
    sources = [shapes.source for shapes in kept.shapes]
    colors = [source.color for source in sources]
    colors.append(np.array(plane_color, np.uint8).reshape(-1, 3))
    ends = [source.color_end for source in sources if source.color_end is not None]
    lamberts = [source.lambert for source in sources]
    lamberts.append(np.array(plane_lambert, np.float64))
    counts = np.array([*(shapes.count for shapes in kept.shapes), len(planes)])
    row, step = _rows([*colors, *ends])
    color_row, color_step = row[: len(colors)], step[: len(colors)]
    end_row, end_step = color_row.copy(), color_step.copy()
    halved = [k for k, source in enumerate(sources) if source.color_end is not None]
    end_row[halved], end_step[halved] = row[len(colors) :], step[len(colors) :]
    lambert_row, lambert_step = _rows(lamberts)
    return Materials(
        np.cumsum(counts) - counts,
        color_row,
        color_step,
        end_row,
        end_step,
        lambert_row,
        lambert_step,
        _joined([*colors, *ends], np.uint8),
        _joined(lamberts, np.float64),
    )


def _rows(parts: list[NDArray[Any]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first row of each part when they are joined, and the step from row to row."""
    sizes = np.array([len(part) for part in parts])
    return np.cumsum(sizes) - sizes, (sizes > 1).astype(np.int64)


def _joined(parts: list[NDArray[Any]], dtype: type[np.generic]) -> NDArray[Any]:
    """Return parts as one array, which is no copy where there is only one."""
    filled = [part for part in parts if len(part)] or parts[:1]
    return input_array(filled[0] if len(filled) == 1 else np.concatenate(filled), dtype)


def _pack_planes(planes: list[Plane]) -> Columns:
    """Return the columns of all planes."""
    data = np.empty((len(planes), 6))
    for row, plane in zip(data, planes, strict=True):
        row[:3] = plane.center.x, plane.center.y, plane.center.z
        row[3:] = unit_vector(plane.normal)
    return Columns(data.reshape(-1), np.arange(len(planes), dtype=np.int32))


def _pack_lights(scene: Scene, origin: Floats, unit: float, camera: CameraFrame) -> Lights:
    """Return the arrays of all lights."""
    points = _points([light.location for light in scene.lights], unit) - origin
    x, y, z = _columns(points)
    return Lights(
        x,
        y,
        z,
        depth=_dot((x, y, z), camera.forward),
        intensity=np.array([light.intensity for light in scene.lights], float),
        error_scale=_magnitude(x, y, z) + _magnitude(*origin),
    )


def _points(places: list[Vector], unit: float) -> Floats:
    """Return places as an (n, 3) array, lengths in units."""
    return np.array([(p.x, p.y, p.z) for p in places], float).reshape(-1, 3) / unit


def _columns(rows: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the columns of an (n, 3) array, each contiguous."""
    columns = np.ascontiguousarray(rows.T)
    return columns[0], columns[1], columns[2]


def _magnitude(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return the sums of the absolute coordinates, always in this order."""
    sums: Floats = np.abs(x) + np.abs(y) + np.abs(z)
    return sums


def _dot(a: Sequence[Floats] | Floats, b: Sequence[Floats] | Vec) -> Floats:
    """Return the scalar products of vectors, each given as its three coordinates."""
    products: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return products
