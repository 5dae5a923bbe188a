"""How scenes reach the hosts, and what the hosts print."""

from pathlib import Path

import numpy as np

from peers.camera_space import Cloud, Surface, View
from peers.host import host_scene
from peers.host.host_scene import HostScene
from timing.jobs import Phases, seconds_after
from vtray.geometry.vector import Vec, dot


def write_scene(view: View, folder: Path) -> Path:
    """Write a scene into a folder."""
    path = folder / "scene.vts"
    host_scene.write_scene(to_host(view), path)
    return path


def to_host(view: View) -> HostScene:
    """Return a scene as hosts have it.

    Raises
    ------
    ValueError
        If spheres differ in their Lambert coefficient: hosts have one for all.
    """
    planes = [_plane(surface) for surface in view.surfaces if isinstance(surface.shape, tuple)]
    balls = [surface for surface in view.surfaces if not isinstance(surface.shape, tuple)]
    lights = [(*at, power) for at, power in view.lights if not _is_behind(at, planes)]
    clouds = [*view.clouds, *([_cloud(balls)] if balls else [])]
    if len({cloud.lambert for cloud in clouds}) > 1:
        raise ValueError("the spheres of a scene must have one Lambert coefficient")
    return HostScene(
        view.width,
        view.height,
        view.pixel_width,
        view.pixel_height,
        clouds[0].lambert if clouds else 1.0,
        np.array(planes, np.float32).reshape(-1, 8),
        np.array(lights, np.float32).reshape(-1, 4),
        _joined([cloud.spheres for cloud in clouds], np.zeros((0, 4), np.float32)),
        _joined([cloud.color for cloud in clouds], np.zeros((0, 3), np.uint8)),
    )


def phases(output: str) -> Phases:
    """Return the seconds of the steps of a host, from what it printed."""
    steps = ("load", "build", "trace")
    return Phases(*(seconds_after(rf"^{step} +([0-9.]+) s$", output) for step in steps))


def trace_seconds(output: str) -> float:
    """Return the seconds of tracing of a host, from what it printed."""
    return phases(output).trace


def _plane(surface: Surface) -> list[float]:
    """Return the unit normal of a plane, its product with a point of it, and the colour."""
    normal = np.array(surface.shape)
    return [*normal, float(normal @ surface.center), *(255 * c for c in surface.color), 0.0]


def _is_behind(place: Vec, planes: list[list[float]]) -> bool:
    """Tell whether a plane is between a place and the eye, which is at the origin.

    Then it is also between the place and all that the eye sees.
    """
    return any((dot(place, (x, y, z)) - at) * at > 0 for x, y, z, at, *_ in planes)


def _cloud(balls: list[Surface]) -> Cloud:
    """Return spheres as arrays; their colours are rounded to 8 bits."""
    spheres = np.array([(*ball.center, ball.shape) for ball in balls], np.float32)
    color = np.array([ball.color for ball in balls])
    return Cloud(spheres, np.rint(255 * color).astype(np.uint8), 1.0)


def _joined(arrays: list[np.ndarray], nothing: np.ndarray) -> np.ndarray:
    """Join arrays end to end; one alone is not copied."""
    return arrays[0] if len(arrays) == 1 else np.concatenate([nothing, *arrays])
