"""From the lights of a scene to the arrays that kernels read."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.vector import Vec
from vtray.rendering.pack_crowd import order_by_place
from vtray.rendering.pack_rectangles import join_rectangles, pack_rectangle
from vtray.rendering.pack_skies import changes_color, pack_skies
from vtray.rendering.pack_surroundings import towards_sun
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.light_types import (
    Ambient,
    AnyLight,
    Lamp,
    Light,
    RectangleLight,
    Sky,
    SphereLight,
    Sun,
    falls_off,
    strength_of,
)
from vtray.scene.vectors import Vector
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import Lights
from vtray.transport.lights.rectangle import SIZE as RECTANGLE_SIZE
from vtray.transport.lights.soft_light import AROUND, NO_SKY, RECTANGLE, SPHERE, SUN, SoftLights
from vtray.transport.lights.surroundings import Surroundings, spread_of
from vtray.transport.lights.visible import SIZE as LAMP_SIZE
from vtray.transport.lights.visible import VisibleLamps

Floats = NDArray[np.float64]

FEW = 128
"""So many soft lights have fans of their own; more share them. Around here small ones take as long
either way, and wide ones less if they share."""

FAR = 2.0**221
"""How long shadow rays are that end nowhere: two million times as far as all that is given."""


def pack_lights(
    lights: Sequence[AnyLight],
    origin: Floats,
    unit: float,
    camera: CameraFrame,
    up: Vec,
    tonemap: ToneMapName = "linear",
    surroundings: Surroundings | None = None,
) -> Lights:
    """Return the arrays of all lights.

    Parameters
    ----------
    lights
        The lights, in any order.
    origin
        The origin of the kernels' space, in units.
    unit
        The length in scene units of length 1 in the arrays.
    camera
        The camera.
    up
        What is up for skies that do not say it, a unit vector in world space.
    tonemap
        The tone map, which says what colours are as light.
    surroundings
        What rays from surfaces see far away; None where no such rays go.
    """
    hard = [light for light in lights if isinstance(light, Light)]
    soft = [light for light in lights if not isinstance(light, Light)]
    points = points_of([light.location for light in hard], unit) - origin
    x, y, z = _columns(points)
    ordered = *hard, *soft
    parts = [part for light in ordered for part in _components_of(light, tonemap)]
    are_mirrored = surroundings is not None
    are_seen = are_mirrored or any(isinstance(light, Lamp) and light.visible for light in soft)
    packed = _pack_soft(soft, len(hard), origin, unit, up, tonemap) if soft else None
    return Lights(
        x,
        y,
        z,
        plane_depth=_dot((x, y, z), camera.forward) + camera.middle_depth,
        error_scale=_magnitude(x, y, z) + _magnitude(*origin),
        points=len(hard) if hard or not soft else None,
        soft=packed,
        crowd=_pack_crowd(packed) if packed else None,
        visible=_pack_lamps(soft, packed, only_visible=True) if packed and are_seen else None,
        mirrored=_pack_lamps(soft, packed) if packed and are_mirrored else None,
        surroundings=surroundings,
        intensity=np.array([intensity for intensity, _ in parts], float),
        color=np.array([color for _, color in parts], float).reshape(-1, 3) / 255.0,
    )


def _components_of(light: AnyLight, tonemap: ToneMapName) -> list[tuple[float, Vec]]:
    """Return the strengths and colours, 255 for white, of the components of a light."""
    color, strength = light_of(light.color, tonemap), strength_of(light)
    if not changes_color(light):
        return [(strength, color)]
    parts = (color[0], 0.0, 0.0), (0.0, color[1], 0.0), (0.0, 0.0, color[2])
    return [(strength, part) for part in parts]


def _pack_soft(
    lights: Sequence[AnyLight],
    first: int,
    origin: Floats,
    unit: float,
    up: Vec,
    tonemap: ToneMapName,
) -> SoftLights:
    """Return the arrays of the lights that are no points; `first` is the row of the first."""
    x, y, z, size, error_scale = np.zeros((5, len(lights)))
    kind = np.zeros(len(lights), np.int64)
    rectangles = {
        k: pack_rectangle(light, unit)
        for k, light in enumerate(lights)
        if isinstance(light, RectangleLight)
    }
    for k, light in enumerate(lights):
        place: Floats | Vec = (0.0, 0.0, 0.0)
        if isinstance(light, Sun):
            kind[k], size[k] = SUN, spread_of(light.angle)
            place = towards_sun(light)
        elif isinstance(light, SphereLight):
            kind[k], size[k] = SPHERE, light.radius / unit
            place = points_of([light.location], unit)[0] - origin
            error_scale[k] = float(_magnitude(*place) + _magnitude(*origin)) + size[k]
        elif isinstance(light, RectangleLight):
            one, other = rectangles[k][-2:]
            kind[k], size[k] = RECTANGLE, one + other
            place = points_of([light.location], unit)[0] - origin
            error_scale[k] = float(_magnitude(*place) + _magnitude(*origin)) + size[k]
        else:
            distance = light.distance if isinstance(light, Ambient) else math.inf
            kind[k], size[k] = AROUND, min(distance / unit, FAR)
        x[k], y[k], z[k] = place
    skies = [light for light in lights if isinstance(light, Sky) and changes_color(light)]
    changes = np.array([changes_color(light) for light in lights])
    counts = np.where(changes, 3, 1)
    are_rare = bool(rectangles or skies)
    return SoftLights(
        kind,
        x,
        y,
        z,
        size,
        error_scale,
        np.array(list(map(falls_off, lights))),
        np.where(changes, np.cumsum(changes) - 1, NO_SKY),
        first + np.cumsum(counts) - counts,
        FAR,
        join_rectangles(len(lights), rectangles) if are_rare else None,
        pack_skies(skies, up, tonemap) if are_rare else None,
    )


def _pack_crowd(soft: SoftLights) -> Crowd | None:
    """Return what is known of many soft lights; None where there are few."""
    if len(soft.kind) <= FEW:
        return None
    return Crowd(order_by_place(soft))


def _pack_lamps(
    lights: Sequence[AnyLight], soft: SoftLights, *, only_visible: bool = False
) -> VisibleLamps:
    """Return the lamps among the soft lights, or those that the camera sees.

    A lamp without a size is met by no ray.
    """
    rectangles = soft.rectangles or join_rectangles(len(lights), {})
    rows = [
        k
        for k, light in enumerate(lights)
        if isinstance(light, Lamp) and soft.size[k] > 0.0 and (light.visible or not only_visible)
    ]
    seen = np.array(rows, np.int64)
    data = np.zeros((len(seen), LAMP_SIZE))
    for row, k in zip(data, seen, strict=True):
        row[:3] = soft.x[k], soft.y[k], soft.z[k]
        row[3] = soft.size[k]
        row[4:] = rectangles.data[RECTANGLE_SIZE * k : RECTANGLE_SIZE * (k + 1)]
    return VisibleLamps(soft.row[seen], data.reshape(-1), soft.error_scale[seen], seen)


def points_of(places: list[Vector], unit: float) -> Floats:
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
