"""Tachyon: how it is given a scene, run and timed."""

import re
from pathlib import Path

from camera_space import Surface, View

from vtray.vector import Vec

NAME = "Tachyon"
EXECUTABLE = "tachyon"
ENDING = ".dat"
COLUMN = 1
"""Which of vtray's columns its first one is: its rays go through the right edges of pixels."""
OPTIONS: tuple[str, ...] = ("-fullshade", "-aasamples", "0", "-format", "PNG")


def command(scene: Path, picture: Path, threads: int, size: tuple[int, int]) -> list[str]:
    """Return the command that renders a scene file."""
    width, height = map(str, size)
    files = [str(scene), "-o", str(picture), "-res", width, height]
    return [EXECUTABLE, *files, *OPTIONS, "-numthreads", str(threads)]


def trace_seconds(output: str) -> float:
    """Return the seconds that Tachyon says it traced rays, from what it printed."""
    found = re.search(r"Ray Tracing Time: *([0-9.]+) seconds", output)
    return float(found[1]) if found else float("nan")


def version(output: str) -> str:
    """Return the version, from what ``-version`` prints."""
    found = re.search(r"[0-9]+\.[0-9.]*[0-9]", output)
    return found[0] if found else "of unknown version"


VERSION_OPTION = "-version"


def export(view: View) -> str:
    """Write a scene in Tachyon's language."""
    lines = [
        "BEGIN_SCENE",
        f"RESOLUTION {view.width} {view.height}",
        *_camera(view),
        "BACKGROUND 0.0 0.0 0.0",
        *(_light(place, power) for place, power in view.lights),
        *(line for i, surface in enumerate(view.surfaces) for line in _object(surface, f"look{i}")),
        "END_SCENE",
    ]
    return "\n".join(lines) + "\n"


def _camera(view: View) -> list[str]:
    """Write the camera."""
    return [
        "CAMERA",
        f"  ZOOM {1 / (view.height * view.pixel_height)!r}",
        f"  ASPECTRATIO {view.pixel_width / view.pixel_height!r}",
        "  ANTIALIASING 0",
        "  RAYDEPTH 1",
        "  CENTER 0.0 0.0 0.0",
        "  VIEWDIR 0.0 0.0 1.0",
        "  UPDIR 0.0 1.0 0.0",
        "END_CAMERA",
    ]


def _light(place: Vec, power: float) -> str:
    # The format demands a radius; it is tiny so that the lamp itself cannot be seen.
    return f"LIGHT CENTER {_vector(place)} RAD 1e-9 COLOR {_vector((power, power, power))}"


def _object(surface: Surface, look: str) -> list[str]:
    color = _vector(surface.color)
    texture = f"TEXDEF {look} AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR {color} TEXFUNC 0"
    center, shape = _vector(surface.center), surface.shape
    if isinstance(shape, tuple):
        return [texture, f"PLANE CENTER {center} NORMAL {_vector(shape)} {look}"]
    return [texture, f"SPHERE CENTER {center} RAD {shape!r} {look}"]


def _vector(vector: Vec) -> str:
    return "{!r} {!r} {!r}".format(*vector)
