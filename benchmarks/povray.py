"""POV-Ray: how it is given a scene, run and timed."""

import re
from pathlib import Path

from camera_space import Surface, View

from vtray.vector import Vec

NAME = "POV-Ray"
EXECUTABLE = "povray"
ENDING = ".pov"
COLUMN = 0
"""Which of vtray's columns its first one is."""
# No display, no antialiasing, no progress; linear light in the file, as vtray writes it.
OPTIONS: tuple[str, ...] = ("-D", "-A", "-V", "+FN", "File_Gamma=1")


def command(scene: Path, picture: Path, threads: int, size: tuple[int, int]) -> list[str]:
    """Return the command that renders a scene file."""
    width, height = size
    files = [f"+I{scene}", f"+O{picture}", f"+W{width}", f"+H{height}"]
    return [EXECUTABLE, *OPTIONS, *files, f"+WT{threads}"]


def trace_seconds(output: str) -> float:
    """Return the seconds that POV-Ray says it traced rays, from what it printed."""
    found = re.search(r"Trace Time:.*\(([0-9.]+) seconds\)", output)
    return float(found[1]) if found else float("nan")


def version(output: str) -> str:
    """Return the version, from what ``--version`` prints."""
    found = re.search(r"POV-Ray ([0-9.]*[0-9])", output)
    return found[1] if found else "of unknown version"


VERSION_OPTION = "--version"


def export(view: View) -> str:
    """Write a scene in POV-Ray's language."""
    lines = [
        "#version 3.7;",
        "global_settings { assumed_gamma 1 }",
        "#default { finish { ambient 0 diffuse 1 } }",
        _camera(view),
        *(f"light_source {{ {_vector(place)}, rgb {power!r} }}" for place, power in view.lights),
        *(_object(surface) for surface in view.surfaces),
    ]
    return "\n".join(lines) + "\n"


def _camera(view: View) -> str:
    """Write the camera, half a pixel aside: POV-Ray's rays go through the middle of a pixel."""
    direction = (-view.pixel_width / 2, view.pixel_height / 2, 1.0)
    right = (view.width * view.pixel_width, 0.0, 0.0)
    up = (0.0, view.height * view.pixel_height, 0.0)
    return (
        f"camera {{ location 0 direction {_vector(direction)} "
        f"right {_vector(right)} up {_vector(up)} }}"
    )


def _object(surface: Surface) -> str:
    look = f"pigment {{ rgb {_vector(surface.color)} }}"
    center, shape = surface.center, surface.shape
    if isinstance(shape, tuple):
        distance = sum(n * c for n, c in zip(shape, center, strict=True))
        return f"plane {{ {_vector(shape)}, {distance!r} {look} }}"
    return f"sphere {{ {_vector(center)}, {shape!r} {look} }}"


def _vector(vector: Vec) -> str:
    return "<{!r}, {!r}, {!r}>".format(*vector)
