"""Scenes with mirrors and glass in POV-Ray's language, and their pictures in linear light.

vtray's glass throws a full shadow, and its floor ends at the image plane, behind which mirrors
would show it. POV-Ray's glass lets light through, straight on, as a film does, and its floor goes
on. Where POV-Ray is to follow the same rules, the shadow is that of a black ball which is not seen,
and the floor is clipped.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import vtray as vt
from vtray.geometry.vector import Vec, scale, sub
from vtray.scene.placing.directions import unit, view_axes
from vtray.scene.vectors import Direction, Vector
from vtray.transport.integrators.whitted import LEAST

MATT = "finish { ambient 0 diffuse 1 }"
MIRROR = "finish { ambient 0 diffuse 0 reflection { 1 } }"
GLASS = "finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }"
BLOCKER = "pigment { rgb 0 } no_image no_reflection"


FINE = ("-D", "-A", "-V", "+FP16", "File_Gamma=1")
"""A picture of 16 bits of each channel, in linear light."""


class Rules(NamedTuple):
    """Where POV-Ray follows vtray's rules, and not its own.

    Attributes
    ----------
    full_shadows
        Glass throws a full shadow.
    floor_ends
        The floor ends at the image plane.
    """

    full_shadows: bool
    floor_ends: bool


def fine_command(scene: Path, picture: Path, side: int) -> list[str]:
    """Return the command that makes a .ppm of 16 bits."""
    return ["povray", *FINE, f"+I{scene}", f"+O{picture}", f"+W{side}", f"+H{side}"]


def read_fine(picture: Path, side: int) -> NDArray[np.float64]:
    """Return the light of a .ppm of 16 bits, (side, side, 3), 1 for white."""
    values = np.fromfile(picture, ">u2", offset=picture.stat().st_size - 6 * side * side)
    return values.reshape(side, side, 3) / 65535.0


def write_scene(scene: vt.Scene, path: Path, depth: int, rules: Rules) -> None:
    """Write a scene of spheres, planes and points."""
    lines = [
        "#version 3.7;",
        f"global_settings {{ assumed_gamma 1 max_trace_level {depth + 1} adc_bailout {LEAST!r} }}",
        _camera(scene.camera),
    ]
    lines += [
        f"light_source {{ {_vector(_triple(light.location))}, rgb {light.intensity!r} }}"
        for light in scene.lights
        if isinstance(light, vt.Light)
    ]
    for item in scene.objects:
        is_glass = rules.full_shadows and isinstance(item.material, vt.Glass)
        is_floor = rules.floor_ends and isinstance(item, vt.Plane)
        lines.append(
            _object(item, "no_shadow" if is_glass else _clip(scene.camera) if is_floor else "")
        )
        if is_glass:
            lines.append(f"sphere {{ {_vector(_triple(item.center))}, {item.radius!r} {BLOCKER} }}")
    path.write_text("\n".join(lines) + "\n")


def _camera(camera: vt.Camera) -> str:
    """Write the camera, half a pixel aside: POV-Ray's rays go through the middle of a pixel."""
    forward = unit(camera.normal)
    right, down = view_axes(forward, _triple(camera.up)) if camera.up else (None, None)
    assert right is not None and down is not None  # noqa: S101, PT018 - scenes here say what is up
    eye = sub(_triple(camera.center), scale(camera.focus, forward))
    (width, height), (x, y) = camera.size, camera.resolution
    far = scale(camera.focus, forward)
    aside = tuple(a - 0.5 * x * r - 0.5 * y * d for a, r, d in zip(far, right, down, strict=True))
    return (
        f"camera {{ location {_vector(eye)} direction {_vector(aside)} "
        f"right {_vector(scale(width * x, right))} up {_vector(scale(-height * y, down))} }}"
    )


def _clip(camera: vt.Camera) -> str:
    """Write that nothing exists behind the image plane."""
    behind = scale(-1.0, unit(camera.normal))
    distance = math.fsum(n * c for n, c in zip(behind, _triple(camera.center), strict=True))
    return f"clipped_by {{ plane {{ {_vector(behind)}, {distance!r} }} }}"


def _object(item: vt.Sphere | vt.Plane, more: str) -> str:
    """Write an object with what it is made of."""
    pigment, look = _material(item)
    center = _triple(item.center)
    if isinstance(item, vt.Plane):
        normal = unit(item.normal)
        distance = math.fsum(n * c for n, c in zip(normal, center, strict=True))
        return f"plane {{ {_vector(normal)}, {distance!r} {pigment} {look} {more} }}"
    return f"sphere {{ {_vector(center)}, {item.radius!r} {pigment} {look} {more} }}"


def _material(item: vt.Sphere | vt.Plane) -> tuple[str, str]:
    """Write the pigment of an object, and its finish."""
    material = item.material
    own = _color((item.color.r, item.color.g, item.color.b), item.lambert)
    if material == "mirror":
        return f"pigment {{ {own} }}", MIRROR
    if isinstance(material, vt.Glass):
        return "pigment { rgbf 1 }", f"{GLASS} interior {{ ior {material.ior!r} }}"
    pattern = getattr(material, "pattern", None)
    if isinstance(pattern, vt.Checker):
        first, second = (_color((c.r, c.g, c.b), item.lambert) for c in pattern.colors if c)
        # Cubes in space, of which half a one is below the floor.
        moved = f"scale {pattern.size!r} translate {_vector((0, 0, 0.5 * pattern.size))}"
        return f"pigment {{ checker {first}, {second} {moved} }}", MATT
    return f"pigment {{ {own} }}", MATT


def _color(color: tuple[int, int, int], share: float) -> str:
    return f"rgb {_vector(scale(share / 255, color))}"


def _triple(vector: Vector | Direction) -> Vec:
    return vector.x, vector.y, vector.z


def _vector(vector: Vec) -> str:
    return "<{!r}, {!r}, {!r}>".format(*vector)
