"""From a scene to the arrays that kernels read."""

import math
import sys
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_NUMBERS
from vtray.base.compiler.compiled import input_array
from vtray.geometry.bvh.tree import Frame, no_bvh
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.vector import Vec
from vtray.geometry.world import NO_TREE, PLANE, Groups, Places, ToBoxes, World
from vtray.rendering.acceleration import Acceleration, Shapes
from vtray.rendering.pack_lights import pack_lights, points_of
from vtray.rendering.pack_skies import up_of
from vtray.rendering.placed import Placed
from vtray.scene.light_types import Lamp, Light, RectangleLight, SphereLight
from vtray.scene.placing.directions import camera_axes, view_axes
from vtray.scene.placing.directions import unit as unit_vector
from vtray.scene.scene import Camera, Plane, Scene
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.materials.material import Materials
from vtray.transport.scene_arrays import SceneArrays

Floats = NDArray[np.float64]

FARTHEST_START = 2.0**30
"""Rays start no farther before the image plane than so many times its width and height.

An eye that is farther away sees the scene along rays that differ by less than 1e-9: they start side
by side, where they pass a plane nearby. Started at the eye, rounding would move what they meet, and
lose what is near the image plane: from 1e15 times the size of the scene on, all of it.
"""

LARGEST_SHIFT = 2.0**300
"""Copies so tiny beside how far they are moved that this is exceeded, as lengths in the space of
their boxes, are traced without their hierarchy."""

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
    origin = points_of([scene.camera.center], unit)[0]
    x, y, z = map(float, origin)
    arrays = SceneArrays(
        camera,
        _pack_world(planes, kept, unit, (x, y, z)),
        pack_lights(scene.lights, origin, unit, camera, up_of(scene.camera)),
        _pack_materials(kept, planes),
    )
    return Packed(arrays, unit, scene.camera.focus - start_distance(scene.camera))


def _pack_world(planes: list[Plane], kept: Acceleration, unit: float, origin: Vec) -> World:
    """Return what rays can meet."""
    reach = float(np.abs(kept.placed.shift).max()) if kept.placed else 0.0
    rows = [_Row(PLANE, 0, len(planes), NO_TREE, kept.count, _IN_KERNELS)]
    rows += [_pack_group(shapes, origin, unit) for shapes in kept.shapes]
    rows = [row for row in rows if row.begin < row.end]
    ends = [len(rows)]
    for of_one in filter(None, kept.copied):
        rows += [_pack_group(shapes, origin, unit, reach) for shapes in of_one]
        ends.append(len(rows))
    places = _pack_places(kept.placed, ends, origin, unit) if kept.placed else None
    spheres, *others = kept.columns
    cylinders, cones = (columns if columns.number.size else None for columns in others)
    has_trees = any(row.root != NO_TREE for row in rows) or (places and places.root != NO_TREE)
    return World(
        _pack_groups(rows),
        _pack_planes(planes),
        spheres,
        cylinders,
        cones,
        kept.bvh if has_trees else no_bvh(),
        places,
        1.0 / unit,
        origin,
    )


class _Row(NamedTuple):
    """A group of shapes, as in `Groups`."""

    kind: int
    begin: int
    end: int
    root: int
    number: int
    frame: ToBoxes


_IN_KERNELS = ToBoxes(0.0, (0.0, 0.0, 0.0), 0.0)
"""That of a group without boxes."""


def _pack_group(shapes: Shapes, origin: Vec, unit: float, reach: float = 0.0) -> _Row:
    """Return a group; `reach` is how far its shapes are moved at the most, in world space."""
    to_boxes = _pack_to_boxes(shapes.frame, origin, unit)
    is_far = reach > LARGEST_SHIFT / shapes.frame.scale
    root = NO_TREE if to_boxes.ratio >= LARGEST_RATIO or is_far else shapes.root
    end = shapes.begin + shapes.count
    return _Row(shapes.kind.shape, shapes.begin, end, root, shapes.first, to_boxes)


def _pack_groups(rows: list[_Row]) -> Groups:
    """Return groups, a row for each."""
    columns = np.array([row[:5] for row in rows], np.int64).reshape(-1, 5).T
    kind, begin, end, root, number = np.ascontiguousarray(columns)
    frames = np.array([(row.frame.ratio, *row.frame.offset) for row in rows]).reshape(-1, 4)
    return Groups(kind, begin, end, root, number, frames)


def _pack_places(placed: Placed, rows: list[int], origin: Vec, unit: float) -> Places:
    """Return where copies stand, whose groups are in these rows."""
    to_boxes = _pack_to_boxes(placed.frame, origin, unit)
    root = NO_TREE if to_boxes.ratio >= LARGEST_RATIO else placed.root
    shift = placed.shift.reshape(-1)
    return Places(shift, placed.item, placed.copy, np.array(rows, np.int64), root, to_boxes)


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
    lamps = [light for light in scene.lights if isinstance(light, Light | Lamp)]
    places += [lamp.location for lamp in lamps]
    places += [edge for lamp in lamps if isinstance(lamp, RectangleLight) for edge in lamp.edges]
    lengths = [lamp.radius for lamp in lamps if isinstance(lamp, SphereLight)]
    coordinates = max(max(abs(p.x), abs(p.y), abs(p.z), *lengths) for p in places)
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
    return ToBoxes(ratio, (x * ratio - a, y * ratio - b, z * ratio - c), 0.0)


def _pack_materials(kept: Acceleration, planes: list[Plane]) -> Materials:
    """Return the materials of all primitives, by ranges of their numbers."""
    sources = [shapes.source for shapes in (*kept.shapes, *chain.from_iterable(kept.copied))]
    colors = [source.color for source in sources]
    of_planes = [(plane.color.r, plane.color.g, plane.color.b) for plane in planes]
    colors.append(np.array(of_planes, np.uint8).reshape(-1, 3))
    ends = [source.color_end for source in sources if source.color_end is not None]
    lamberts = [source.lambert for source in sources]
    lamberts.append(np.array([plane.lambert for plane in planes], np.float64))
    row, step = _rows([*colors, *ends])
    color_row, color_step = row[: len(colors)], step[: len(colors)]
    end_row, end_step = color_row.copy(), color_step.copy()
    halved = [k for k, source in enumerate(sources) if source.color_end is not None]
    end_row[halved], end_step[halved] = row[len(colors) :], step[len(colors) :]
    lambert_row, lambert_step = _rows(lamberts)
    ranges = kept.ranges
    k = np.where(ranges.copied < 0, ranges.kind, len(kept.shapes) + ranges.copied)
    k, begin = np.append(k, len(sources)), np.append(ranges.begin, 0)
    return Materials(
        np.append(ranges.first, kept.count),
        np.append(ranges.each, MAX_NUMBERS),
        color_row[k] + begin * color_step[k],
        color_step[k],
        end_row[k] + begin * end_step[k],
        end_step[k],
        lambert_row[k] + begin * lambert_step[k],
        lambert_step[k],
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
