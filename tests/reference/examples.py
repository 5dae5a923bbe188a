"""Small scenes that several tests use, as decoded JSON."""

import copy
from typing import Any

Scene = dict[str, Any]


def xyz(x: float, y: float, z: float) -> dict[str, float]:
    """Return a point or a direction."""
    return {"x": x, "y": y, "z": z}


def sphere(center: tuple[float, ...], radius: float, **more: Any) -> Scene:
    """Return a white sphere."""
    return {"type": "sphere", "center": xyz(*center), "radius": radius, **_material(), **more}


def plane(center: tuple[float, ...], normal: tuple[float, ...], **more: Any) -> Scene:
    """Return a white plane."""
    return {"type": "plane", "center": xyz(*center), "normal": xyz(*normal), **_material(), **more}


def cylinder(start: tuple[float, ...], end: tuple[float, ...], radius: float, **more: Any) -> Scene:
    """Return a white cylinder."""
    ends = {"start": xyz(*start), "end": xyz(*end)}
    return {"type": "cylinder", **ends, "radius": radius, **_material(), **more}


def cone(
    start: tuple[float, ...],
    end: tuple[float, ...],
    radius: float,
    radius_end: float = 0.0,
    **more: Any,
) -> Scene:
    """Return a white cone."""
    item = cylinder(start, end, radius, **more)
    return item | {"type": "cone", "radius_end": radius_end}


def light(*location: float, intensity: float = 1.0) -> Scene:
    """Return a light."""
    return {"location": xyz(*location), "intensity": intensity}


def scene(objects: list[Scene], lights: list[Scene], **camera: Any) -> Scene:
    """Return a scene seen along z from (0, 0, -10), 64 x 48 pixels unless `camera` says else."""
    return {
        "camera": {
            "center": xyz(0, 0, 0),
            "normal": xyz(0, 0, 1),
            "focus": 10,
            "size": [64, 48],
            "resolution": [0.1, 0.1],
            **camera,
        },
        "lights": lights,
        "objects": copy.deepcopy(objects),
    }


def one_sphere() -> Scene:
    """Return a red sphere, lit from the right and from above."""
    red = {"r": 255, "g": 0, "b": 0}
    return scene([sphere((0, 0, 5), 1, color=red)], [light(5, -5, 0)])


def _material() -> Scene:
    return {"color": {"r": 255, "g": 255, "b": 255}, "lambert": 1}
