"""Tachyon: how it is given a scene, run and timed."""

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

from peers.camera_space import Cloud, Surface, View
from peers.peer import Peer, answer
from timing.jobs import Phases, seconds_after
from vtray.geometry.vector import Vec

OPTIONS = ("-fullshade", "-aasamples", "0", "-format", "PNG")


def command(scene: Path, picture: Path, threads: int, size: tuple[int, int]) -> list[str]:
    """Return the command that renders a scene file."""
    width, height = map(str, size)
    files = [str(scene), "-o", str(picture), "-res", width, height]
    return ["tachyon", *files, *OPTIONS, "-numthreads", str(threads)]


def phases(output: str) -> Phases:
    """Return the seconds that Tachyon says its steps took, from what it printed."""
    steps = ("Scene Parsing", "Preprocessing", "Ray Tracing")
    return Phases(*(seconds_after(rf"{step} Time: *([0-9.]+) seconds", output) for step in steps))


def trace_seconds(output: str) -> float:
    """Return the seconds that Tachyon says it traced rays, from what it printed."""
    return phases(output).trace


def version() -> str | None:
    """Return the version, or None if it is not installed."""
    # Some builds end with an error although they answer.
    found = re.search(r"[0-9]+\.[0-9.]*[0-9]", answer(["tachyon", "-version"], (0, 255)) or "")
    return found[0] if found else None


def write_scene(view: View, folder: Path) -> Path:
    """Write a scene into a folder."""
    path = folder / "scene.dat"
    with path.open("w") as file:
        file.writelines(_parts(view))
    return path


def export(view: View) -> str:
    """Return a scene in Tachyon's language."""
    return "".join(_parts(view))


def _parts(view: View) -> Iterator[str]:
    """Write a scene, many lines at a time."""
    lines = [
        "BEGIN_SCENE",
        f"RESOLUTION {view.width} {view.height}",
        *_camera(view),
        "BACKGROUND 0.0 0.0 0.0",
        *(_light(place, power) for place, power in view.lights),
        *(line for i, surface in enumerate(view.surfaces) for line in _object(surface, f"look{i}")),
    ]
    yield "\n".join(lines) + "\n"
    yield from itertools.chain.from_iterable(map(_cloud, view.clouds))
    yield "END_SCENE\n"


def _cloud(cloud: Cloud) -> Iterator[str]:
    look = "TEXTURE AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR %r %r %r TEXFUNC 0"
    return cloud.formatted(f"SPHERE CENTER %r %r %r RAD %r {look}\n")


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


PEER = Peer(
    name="Tachyon",
    version=version,
    write_scene=write_scene,
    command=command,
    phases=phases,
    options=" ".join(OPTIONS),
    column=1,  # its rays go through the right edges of pixels
)
