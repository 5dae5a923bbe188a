"""POV-Ray: how it is given a scene, run and timed."""

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

from peers.camera_space import Cloud, Surface, View
from peers.peer import Peer, answer
from timing.jobs import Phases, seconds_after
from vtray.geometry.vector import Vec

# No display, no antialiasing, no progress; linear light in the file, as vtray writes it.
OPTIONS = ("-D", "-A", "-V", "+FN", "File_Gamma=1")


def command(scene: Path, picture: Path, threads: int, size: tuple[int, int]) -> list[str]:
    """Return the command that renders a scene file."""
    width, height = size
    files = [f"+I{scene}", f"+O{picture}", f"+W{width}", f"+H{height}"]
    return ["povray", *OPTIONS, *files, f"+WT{threads}"]


def phases(output: str) -> Phases:
    """Return the seconds that POV-Ray says its steps took, from what it printed."""
    return Phases(*(_seconds(step, output) for step in ("Parse", "Bounding", "Trace")))


def trace_seconds(output: str) -> float:
    """Return the seconds that POV-Ray says it traced rays, from what it printed."""
    return phases(output).trace


def _seconds(step: str, output: str) -> float:
    return seconds_after(rf"{step} Time:.*\(([0-9.]+) seconds\)", output)


def version() -> str | None:
    """Return the version, or None if it is not installed."""
    found = re.search(r"POV-Ray ([0-9.]*[0-9])", answer(["povray", "--version"]) or "")
    return found[1] if found else None


def write_scene(view: View, folder: Path) -> Path:
    """Write a scene into a folder."""
    path = folder / "scene.pov"
    with path.open("w") as file:
        file.writelines(_parts(view))
    return path


def export(view: View) -> str:
    """Return a scene in POV-Ray's language."""
    return "".join(_parts(view))


def _parts(view: View) -> Iterator[str]:
    """Write a scene, many lines at a time."""
    lines = [
        "#version 3.7;",
        "global_settings { assumed_gamma 1 }",
        "#default { finish { ambient 0 diffuse 1 } }",
        _camera(view),
        *(f"light_source {{ {_vector(place)}, rgb {power!r} }}" for place, power in view.lights),
        *(_object(surface) for surface in view.surfaces),
    ]
    yield "\n".join(lines) + "\n"
    yield from itertools.chain.from_iterable(map(_cloud, view.clouds))


def _cloud(cloud: Cloud) -> Iterator[str]:
    line = "sphere { <%r, %r, %r>, %r pigment { rgb <%r, %r, %r> } }\n"
    return cloud.formatted(line)


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


PEER = Peer(
    name="POV-Ray",
    version=version,
    write_scene=write_scene,
    command=command,
    phases=phases,
    options=" ".join(OPTIONS),
)
