"""From a scene to the arrays that kernels read."""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.capacity import MAX_NUMBERS
from vtray.base.compiler.compiled import pinned
from vtray.geometry.bvh.tree import Frame, no_bvh
from vtray.geometry.ray import EVERYWHERE
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.vector import Vec
from vtray.geometry.world import (
    CUT,
    NO_TREE,
    PLANE,
    Clip,
    Faded,
    Groups,
    Hierarchy,
    Places,
    Solids,
    ToBoxes,
    World,
)
from vtray.rendering.acceleration import Acceleration, Shapes, used_places
from vtray.rendering.joined import joined, rows_of
from vtray.rendering.pack_bodies import pack_bodies
from vtray.rendering.pack_lens import pack_lens
from vtray.rendering.pack_lights import pack_lights, points_of
from vtray.rendering.pack_looks import MadeOf, made_of, pack_looks, rows_of_ranges
from vtray.rendering.pack_patterns import pack_patterns
from vtray.rendering.pack_skies import up_of
from vtray.rendering.pack_surroundings import is_even, pack_surroundings
from vtray.rendering.placed import Placed, count_places
from vtray.rendering.rooms import Rooms
from vtray.scene.colors.color_light import light_of, light_of_numbers
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.light_types import Lamp, Light, RectangleLight, SphereLight
from vtray.scene.materials import material_of
from vtray.scene.objects import Object
from vtray.scene.placing.directions import camera_axes, view_axes
from vtray.scene.placing.directions import unit as unit_vector
from vtray.scene.scene import Camera, Plane, Scene
from vtray.scene.style import Style
from vtray.transport.camera_rays import CameraFrame, TurnFrame
from vtray.transport.lights.soft_light import SoftLights
from vtray.transport.materials.material import Materials, Paints
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


@dataclass(frozen=True)
class Packed:
    """The arrays of a scene, and what leads back from them to the scene.

    Attributes
    ----------
    arrays
        What the kernels read.
    unit
        Length in scene units of length 1 in the arrays, a power of two.
    before
        Length in scene units of each ray from the eye to where it starts in the arrays.
    made
        What its primitives are made of, by parts as in `pack_looks`.
    """

    arrays: SceneArrays
    unit: float
    before: float
    made: list[MadeOf]

    @cached_property
    def given(self) -> SceneArrays:
        """The arrays as kernels are given them in many calls; see `pinned`."""
        return pinned(self.arrays)

    @cached_property
    def given_lights(self) -> SoftLights | None:
        """The lights that are no points, in the same way."""
        soft = self.arrays.lights.soft
        return None if soft is None else pinned(soft)


def pack(scene: Scene, kept: Acceleration) -> Packed:
    """Return the arrays of a scene, whose spheres are ready for tracing.

    The tone map of its settings says what its colours are as light.
    """
    planes = [item for item in scene.objects if isinstance(item, Plane)]
    unit = _unit_length(scene, planes, kept)
    camera = _pack_camera(scene.camera, unit)
    origin = points_of([scene.camera.center], unit)[0]
    x, y, z = map(float, origin)
    made = [shapes.source.made for shapes in (*kept.shapes, *kept.copied)]
    made.append(made_of(material_of(plane.material) for plane in planes))
    materials = _pack_materials(kept, planes, made, unit, scene)
    lights = scene.lights
    if scene.render.integrator == "path":
        lights = [light for light in lights if not is_even(light)]
    arrays = SceneArrays(
        camera,
        _pack_world(scene.objects, kept, unit, (x, y, z)),
        pack_lights(
            lights,
            origin,
            unit,
            camera,
            up_of(scene.camera),
            scene.render.tonemap,
            pack_surroundings(scene) if materials.looks is not None else None,
        ),
        materials,
    )
    is_panorama = scene.camera.projection == "panorama"
    before = 0.0 if is_panorama else scene.camera.focus - start_distance(scene.camera)
    return Packed(arrays, unit, before, made)


def _pack_world(objects: Sequence[Object], kept: Acceleration, unit: float, origin: Vec) -> World:
    """Return what rays can meet."""
    (_, whole, solid), *cut = _planes_by_room(objects, kept.rooms)
    flats, begin = [(PLANE, 0, solid, len(whole.number), -1)], 0
    for room, flat, opaque in cut:
        flats.append((CUT + PLANE, begin, begin + opaque, begin + len(flat.number), room))
        begin += len(flat.number)
    rows = [_plane_row(kind, first, mid, kept.count, room) for kind, first, mid, _, room in flats]
    standing = [one for one in (*kept.shapes, *kept.copied) if not one.is_placed]
    rows += [_pack_group(one, origin, unit) for one in standing]
    rows += [_pack_group(one, origin, unit, room=room) for room, one in kept.cut]
    rows = [row for row in rows if row.begin < row.end]
    given = len(rows)
    rows += [_plane_row(kind, mid, end, kept.count, room) for kind, _, mid, end, room in flats]
    still = [(-1, one) for one in kept.faded if not one.is_placed]
    for room, one in (*still, *kept.faded_cut):
        rows.append(_pack_group(one, origin, unit, room=room, is_faded=True))
    rows = [row for row in rows if row.begin < row.end]
    ends = [len(rows)]
    for placed, shapes in kept.placed_shapes:
        reach, is_faded = float(np.abs(placed.shift).max()), placed is kept.faded_placed
        items = kept.items_of(shapes)
        plain = [(-1, parts) for parts in items]
        # The same shapes where clip planes may cut them.
        cut_items = [(_room_of(kept, parts[0].place), parts) for parts in items]
        for room, parts in (*plain, *(cut_items if kept.rooms else ())):
            rows += [_pack_group(one, origin, unit, reach, room, is_faded) for one in parts]
            ends.append(len(rows))
    spheres, *others = kept.columns
    cylinders, cones = (columns if columns.number.size else None for columns in others)
    places = _pack_places(kept, ends, origin, unit)
    faded_places = _faded_places(kept, origin, unit)
    roots = [row.root for row in rows]
    roots += [places.root, faded_places.root] if places else []
    has_trees = any(root != NO_TREE for root in roots)
    bodies = pack_bodies(kept, [item for item in objects if isinstance(item, Plane)])
    return World(
        _pack_groups(rows),
        whole,
        spheres,
        Solids(
            spheres,
            cylinders,
            cones,
            _pack_clip(kept.rooms, rows, [flat for _, flat, _ in cut]),
        ),
        kept.bvh if has_trees else no_bvh(),
        places,
        given,
        None if bodies is None else Faded(given, ends[0], faded_places, bodies, Style().solid_from),
        1.0 / unit,
        origin,
    )


def _plane_row(kind: int, begin: int, end: int, number: int, room: int) -> "_Row":
    """Return a group of planes."""
    return _Row(kind, begin, end, NO_TREE, number, 0, _IN_KERNELS, room)


def _room_of(kept: Acceleration, place: int) -> int:
    """Return the room of the object in a place among those that have shapes."""
    return kept.room_of[place] if kept.room_of else 0


def _planes_by_room(
    objects: Sequence[Object], rooms: Rooms | None
) -> list[tuple[int, Columns, int]]:
    """Return the planes that no clip plane cuts, and then those of each room.

    Those through which some light passes come last; beside the columns is told how many come before
    them.
    """
    found: dict[int, list[tuple[int, Plane]]] = {-1: []}
    number = 0
    for place, item in enumerate(objects):
        if isinstance(item, Plane):
            room = rooms.room_of(place) if rooms else -1
            is_cut = rooms is not None and rooms.walls[room]
            found.setdefault(room if is_cut else -1, []).append((number, item))
            number += 1
    made = []
    for room, numbered in found.items():
        solid = [pair for pair in numbered if pair[1].opacity == 1.0]
        faded = [pair for pair in numbered if 0.0 < pair[1].opacity < 1.0]
        made.append((room, _pack_planes([*solid, *faded]), len(solid)))
    return made


def _pack_clip(rooms: Rooms | None, rows: Sequence["_Row"], flat: Sequence[Columns]) -> Clip | None:
    """Return what clip planes leave; None if there are none, or if they cut nothing."""
    if rooms is None or all(row.kind < CUT for row in rows):
        return None
    room = np.array([max(row.room, 0) for row in rows], np.int64)
    columns = Columns(*map(np.concatenate, zip(*flat, strict=True))) if flat else None
    is_capped = np.array([rooms.is_capped or row.is_faded for row in rows])
    return Clip(rooms.planes, rooms.begin, room, is_capped, columns)


class _Row(NamedTuple):
    """A group of shapes, as in `Groups`."""

    kind: int
    begin: int
    end: int
    root: int
    number: int
    each: int
    frame: ToBoxes
    room: int = -1
    is_faded: bool = False


_IN_KERNELS = ToBoxes(0.0, (0.0, 0.0, 0.0), 0.0)
"""That of a group without boxes."""


def _pack_group(
    shapes: Shapes,
    origin: Vec,
    unit: float,
    reach: float = 0.0,
    room: int = -1,
    is_faded: bool = False,
) -> _Row:
    """Return a group.

    Parameters
    ----------
    shapes
        Its shapes.
    origin, unit
        Those of the kernels' space.
    reach
        How far they are moved at the most, in world space.
    room
        The room that may cut them; -1 if none does.
    is_faded
        Whether some light passes them.
    """
    to_boxes = _pack_to_boxes(shapes.frame, origin, unit)
    is_far = reach > LARGEST_SHIFT / shapes.frame.scale
    root = NO_TREE if to_boxes.ratio >= LARGEST_RATIO or is_far else shapes.root
    end = shapes.begin + shapes.count
    each = len(shapes.source.geometry[0])
    kind = shapes.kind.shape + (CUT if room >= 0 else 0)
    return _Row(kind, shapes.begin, end, root, shapes.first, each, to_boxes, room, is_faded)


def _pack_groups(rows: list[_Row]) -> Groups:
    """Return groups, a row for each."""
    columns = np.array([row[:6] for row in rows], np.int64).reshape(-1, 6).T
    kind, begin, end, root, number, each = np.ascontiguousarray(columns)
    frames = np.array([(row.frame.ratio, *row.frame.offset) for row in rows]).reshape(-1, 4)
    return Groups(kind, begin, end, root, number, each, frames)


def _pack_places(kept: Acceleration, rows: list[int], origin: Vec, unit: float) -> Places | None:
    """Return where copies stand, whose groups are in these rows; None if there are none."""
    if not kept.all_placed:
        return None
    placed = kept.placed
    end = count_places(placed)
    hierarchy = _hierarchy_of(placed, 0, origin, unit)
    # Groups of faded shapes follow those of the others.
    items = len(used_places(kept.copied)) * (2 if kept.rooms else 1) if placed else 0
    item = [one.item + (items if one is not placed else 0) for one in kept.all_placed]
    return Places(
        joined([one.shift.reshape(-1) for one in kept.all_placed], np.float64),
        joined(item, np.int32),
        joined([one.copy for one in kept.all_placed], np.int32),
        np.array(rows, np.int64),
        hierarchy.root,
        hierarchy.to_boxes,
        end,
    )


def _faded_places(kept: Acceleration, origin: Vec, unit: float) -> Hierarchy:
    """Return the hierarchy over the places of faded shapes."""
    return _hierarchy_of(kept.faded_placed, count_places(kept.placed), origin, unit)


def _hierarchy_of(placed: Placed | None, begin: int, origin: Vec, unit: float) -> Hierarchy:
    """Return the hierarchy over places that stand from there on, if there are any."""
    if placed is None:
        return Hierarchy(NO_TREE, begin, begin, _IN_KERNELS)
    to_boxes = _pack_to_boxes(placed.frame, origin, unit)
    root = NO_TREE if to_boxes.ratio >= LARGEST_RATIO else placed.root
    return Hierarchy(root, begin, begin + len(placed.shift), to_boxes)


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
    # A plane that cuts nothing may be anywhere.
    lengths += [kept.rooms.largest] if kept.rooms and (planes or kept.is_cut) else []
    coordinates = max(max(abs(p.x), abs(p.y), abs(p.z), *lengths) for p in places)
    lens = _exponent(camera.lens.radius if camera.lens else 0.0)
    highest = max(_start_exponent(camera), lens, _exponent(coordinates), _exponent(kept.largest))
    # The unit itself and its inverse must be ordinary doubles.
    return math.ldexp(1.0, max(highest - 200, -1000))


def _start_exponent(camera: Camera) -> int:
    """Return an e with all coordinates below 2**e at which rays start, and not far below."""
    if camera.projection == "panorama":
        return _exponent(0.0)
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
    if camera.projection == "panorama":
        return _pack_panorama(camera, right, down, forward)
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
        lens=pack_lens(camera, start, unit),
    )


def _pack_panorama(camera: Camera, right: Vec, down: Vec, forward: Vec) -> CameraFrame:
    """Return the frame of a panorama with these axes."""
    width, height = map(int, camera.size)
    across, below = 8.0 / width, 4.0 / height
    nowhere = 0.0, 0.0, 0.0
    return CameraFrame(
        eye=nowhere,
        right=right,
        down=down,
        forward=nowhere,
        image_distance=0.0,
        pixel=(0.0, 0.0, 1.0),
        shift=(0.0, 0.0),
        extent=0.0,
        width=width,
        height=height,
        turn=TurnFrame(forward, across, below, 0.5 * across, 0.5 * below),
        middle_depth=EVERYWHERE,
        unbounded=True,
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


def _pack_materials(
    kept: Acceleration, planes: list[Plane], made: list[MadeOf], unit: float, scene: Scene
) -> Materials:
    """Return the materials of all primitives, by ranges of their numbers."""
    sources = [shapes.source for shapes in (*kept.shapes, *kept.copied)]
    colors = [source.color for source in sources]
    of_planes = [(plane.color.r, plane.color.g, plane.color.b) for plane in planes]
    colors.append(np.array(of_planes, np.uint8).reshape(-1, 3))
    ends = [source.color_end for source in sources if source.color_end is not None]
    lamberts = [source.lambert for source in sources]
    lamberts.append(np.array([plane.lambert for plane in planes], np.float64))
    row, step = rows_of([*colors, *ends])
    color_row, color_step = row[: len(colors)], step[: len(colors)]
    end_row, end_step = color_row.copy(), color_step.copy()
    halved = [k for k, source in enumerate(sources) if source.color_end is not None]
    end_row[halved], end_step[halved] = row[len(colors) :], step[len(colors) :]
    lambert_row, lambert_step = rows_of(lamberts)
    ranges = kept.ranges
    k = np.where(ranges.copied < 0, ranges.kind, len(kept.shapes) + ranges.copied)
    k, begin = np.append(k, len(sources)), np.append(ranges.begin, 0)
    rows = rows_of_ranges(made, k, begin)
    return Materials(
        np.append(ranges.first, kept.count),
        np.append(ranges.each, MAX_NUMBERS),
        color_row[k] + begin * color_step[k],
        color_step[k],
        end_row[k] + begin * end_step[k],
        end_step[k],
        lambert_row[k] + begin * lambert_step[k],
        lambert_step[k],
        Paints(
            joined([*colors, *ends], np.uint8),
            light_of_numbers(scene.render.tonemap),
            joined(lamberts, np.float64),
            _cap_color(kept.rooms, scene.render.tonemap),
            pack_patterns(made, rows, unit, scene),
        ),
        pack_looks(made, rows, unit, scene),
    )


def _cap_color(rooms: Rooms | None, tonemap: ToneMapName) -> Vec | None:
    """Return the colour of what closes shapes that are cut, as in `Materials`."""
    if rooms is None:
        return None
    color = rooms.color
    return light_of(color, tonemap) if color else (-1.0, -1.0, -1.0)


def _pack_planes(planes: Sequence[tuple[int, Plane]]) -> Columns:
    """Return the columns of planes with their numbers."""
    data = np.empty((len(planes), 6))
    for row, (_, plane) in zip(data, planes, strict=True):
        row[:3] = plane.center.x, plane.center.y, plane.center.z
        row[3:] = unit_vector(plane.normal)
    return Columns(data.reshape(-1), np.array([number for number, _ in planes], np.int32))
