"""How a pixel got its value, in words: what ``vtray --pixel`` prints."""

import math
from typing import NamedTuple

import numpy as np

from vtray.acceleration import accelerate, locate
from vtray.errors import RenderError
from vtray.image import Image
from vtray.plain import NOTHING, TracedPixel, trace_pixel
from vtray.scene import Plane, Scene
from vtray.scene_arrays import Packed, pack
from vtray.spheres import Spheres
from vtray.vector import Vec


class Surface(NamedTuple):
    """What is said of a sphere or a plane: which one it is, and its material."""

    name: str
    color: Vec
    lambert: float


def explain_pixel(scene: Scene, image: Image, column: int, row: int) -> str:
    """Return how a pixel got its value, as text of some lines.

    Parameters
    ----------
    scene
        The scene.
    image
        Its picture: exposure needs the brightest channel of all pixels.
    column, row
        The pixel, from the left and from the top.

    Raises
    ------
    RenderError
        There is no such pixel.
    """
    width, height = (int(pixels) for pixels in scene.camera.size)
    if not (0 <= column < width and 0 <= row < height):
        message = f"--pixel: expected 0,0 to {width - 1},{height - 1}, got {column},{row}"
        raise RenderError(message)
    packed = pack(scene, accelerate(scene))
    cosines = np.zeros(len(scene.lights))
    blockers = np.full(len(scene.lights), NOTHING)
    traced = trace_pixel(packed.arrays, column, row, cosines, blockers)
    lines = [
        f"pixel        column {column}, row {row} of {width} x {height}",
        *_explain_ray(scene, packed, traced),
    ]
    if traced.primitive == NOTHING:
        lines.append("hit          nothing in front of the image plane")
    else:
        lines += _explain_hit(scene, packed, traced)
        lines += _explain_lights(scene, packed, traced, cosines, blockers)
    return "\n".join([*lines, *_explain_exposure(image, traced, column, row)]) + "\n"


def _explain_ray(scene: Scene, packed: Packed, traced: TracedPixel) -> list[str]:
    """Return the lines on the camera ray."""
    eye = _world(scene, packed, packed.arrays.camera.eye)
    return [f"ray          from {_vector(eye)} towards {_vector(traced.direction)}"]


def _explain_hit(scene: Scene, packed: Packed, traced: TracedPixel) -> list[str]:
    """Return the lines on what the ray hit."""
    surface = _surface(scene, traced.primitive)
    point = _world(scene, packed, traced.interaction.point)
    distance = traced.distance * packed.unit
    red, green, blue = surface.color
    return [
        f"hit          {surface.name}, {distance:.10g} away",
        f"  point      {_vector(point)}",
        f"  normal     {_vector(traced.interaction.normal)}, on the ray's side",
        f"  material   color ({red:g}, {green:g}, {blue:g}), lambert {surface.lambert:g}",
    ]


def _explain_lights(
    scene: Scene,
    packed: Packed,
    traced: TracedPixel,
    cosines: "np.typing.NDArray[np.float64]",
    blockers: "np.typing.NDArray[np.int64]",
) -> list[str]:
    """Return the lines on each light: its direction, what blocks it or what it adds."""
    lines = []
    surface = _surface(scene, traced.primitive)
    point = _world(scene, packed, traced.interaction.point)
    for k, light in enumerate(scene.lights):
        location = light.location
        way = (location.x - point[0], location.y - point[1], location.z - point[2])
        distance = math.hypot(*way)
        direction = tuple(part / distance for part in way) if distance else way
        name = f"lights[{k}]"
        lines.append(f"{name:12} towards {_vector(direction)}, {distance:.10g} away")
        if cosines[k] == 0.0:
            lines.append("  adds       nothing: it is behind the surface")
        elif blockers[k] != NOTHING:
            blocker = _surface(scene, int(blockers[k]))
            lines.append(f"  adds       nothing: {blocker.name}, is in the way")
        else:
            strength = cosines[k] * surface.lambert * light.intensity
            added = tuple(strength * channel for channel in surface.color)
            factors = f"cosine {cosines[k]:.6g} x lambert {surface.lambert:g}"
            factors += f" x intensity {light.intensity:g} x color"
            lines.append(f"  adds       {_vector(added)} = {factors}")
    return lines


def _explain_exposure(image: Image, traced: TracedPixel, column: int, row: int) -> list[str]:
    """Return the lines on the value before and after exposure."""
    peak = float(image.linear.max())
    exposure = (
        f"floor(255 x light / {peak:.10g}), {peak:.10g} is the brightest channel of the picture"
    )
    red, green, blue = (int(channel) for channel in image.pixels[row, column])
    return [
        f"light        {_vector(traced.value)}, the sum over all lights",
        f"exposure     {exposure if peak > 0.0 else 'the whole picture is black'}",
        f"value        ({red}, {green}, {blue})",
    ]


def _surface(scene: Scene, primitive: int) -> Surface:
    """Return what is to be said of a primitive."""
    kept = accelerate(scene)
    count = len(kept.leaves.number)
    if primitive >= count:
        planes = [place for place, item in enumerate(scene.objects) if isinstance(item, Plane)]
        place, index = planes[primitive - count], 0
    else:
        place, index = locate(scene, kept, primitive)
    item = scene.objects[place]
    if not isinstance(item, Spheres):
        kind, color = "sphere" if primitive < count else "plane", item.color
        name = f"objects[{place}], a {kind}"
        return Surface(name, (float(color.r), float(color.g), float(color.b)), item.lambert)
    red, green, blue = map(float, np.broadcast_to(item.color, (len(item), 3))[index])
    lambert = float(np.broadcast_to(item.lambert, len(item))[index])
    return Surface(f"objects[{place}], sphere {index}", (red, green, blue), lambert)


def _world(scene: Scene, packed: Packed, point: Vec) -> Vec:
    """Return a point of the arrays in world space."""
    center, unit = scene.camera.center, packed.unit
    return (
        center.x + point[0] * unit,
        center.y + point[1] * unit,
        center.z + point[2] * unit,
    )


def _vector(vector: tuple[float, ...]) -> str:
    """Return a vector as people read it."""
    return "(" + ", ".join(f"{part + 0.0:.6g}" for part in vector) + ")"
