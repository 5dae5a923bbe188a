"""Cameras in glass: it takes light on the way to the first surface, too."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once

TAKES = (0.5, 0.1, 0.0)
GLASS = vtray.Glass(1.0, absorption=TAKES)
LAMP = vtray.Emissive(1)
PLACES: dict[str, Any] = {
    "ball": (0, 0, 0),
    "cylinder": (20, 0, 0),
    "cone": (40, 0, 0),
    "copies": (60, 20, 0),
    "nowhere": (80, 0, 0),
}
SIZE = (9, 7)
X, Y = SIZE[0] // 2, SIZE[1] // 2


def bodies() -> vtray.Scene:
    """Return bodies of glass, and lamps in front of the places within them."""
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((0, 0, 0), 4, material=GLASS),
        vtray.Cylinder((20, 0, -3), (20, 0, 3), 4, material=GLASS),
        vtray.Cone((40, 0, -3), (40, 0, 5), 5, 3, material=GLASS),
        vtray.Copies([vtray.Sphere((60, 0, 0), 4, material=GLASS)], [(0, 0, 0), (0, 20, 0)]),
    ]
    for x, y, z in PLACES.values():
        scene.add_sphere((x, y + 2, z), 0.5, material=LAMP)
    return scene


def looking(place: Any) -> vtray.Camera:
    """Return a camera that looks along y."""
    x, y, z = place
    return vtray.Camera.look_at(
        place, target=(x, y + 2, z), up=(0, 0, 1), fov_degrees=40, size=SIZE
    )


def left(length: float, error: float = 1e-5) -> Any:
    """Return what is left of white light over a length in glass."""
    return pytest.approx(255 * np.exp(-length * np.array(TAKES)), rel=error)


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
@pytest.mark.parametrize("samples", [1, 4])
def test_glass_around_the_camera_takes_light(integrator: str, samples: int) -> None:
    scene = bodies()
    for name, place in PLACES.items():
        scene.camera = looking(place)
        image = vtray.render(scene, integrator=integrator, samples=samples, filter="box")
        length = 0.0 if name == "nowhere" else image.depth[Y, X]
        assert image.linear[Y, X] == left(length, 1e-5 if samples == 1 else 0.03)
        told = [vtray.trace_pixel(image, X, Y, k) for k in range(samples)]
        assert np.mean([one.light for one in told], axis=0) == pytest.approx(
            image.linear[Y, X], rel=1e-15
        )
        assert told[0].light == tuple(image.linear[Y, X]) or samples > 1
        text = str(told[0])
        assert ("glass      leaves" in text) == (name != "nowhere")


@once
def test_glass_counts_from_the_image_plane_on() -> None:
    scene = bodies()
    scene.camera = looking((0, 0, 0)).replace(center=(0, 1, 0), focus=2, resolution=(0.1, 0.1))
    image = vtray.render(scene, integrator="whitted")
    assert image.linear[Y, X] == left(image.depth[Y, X] - 2, 0.01)
    # Where the plane cuts a ball, some rays start within it, and others do not.
    scene.objects[0] = vtray.Sphere((0.2, 1, 0), 0.2, material=GLASS)
    scene.objects[4] = vtray.Plane((0, 2, 0), (0, -1, 0), material=LAMP)
    image = vtray.render(scene, integrator="whitted")
    assert image.linear[Y, X + 2] == left(0.2, 0.03)
    assert (image.linear[Y, X - 2] == 255).all()


@once
def test_panorama_in_glass() -> None:
    scene = bodies()
    scene.camera = vtray.Camera.panorama((0, 0, 0), target=(0, 1, 0), up=(0, 0, 1), size=(64, 32))
    image = vtray.render(scene, integrator="whitted", samples=1)
    seen = image.linear.reshape(-1, 3)[image.depth.argmin()]
    assert seen == left(image.depth.min())


@once
def test_innermost_glass_counts() -> None:
    scene = bodies()
    scene.objects.insert(0, vtray.Sphere((0, 0, 0), 3, material=vtray.Glass(1.0)))
    scene.camera = looking(PLACES["ball"])
    image = vtray.render(scene, integrator="whitted")
    assert (image.linear[Y, X] == 255).all()


def test_lamps_are_seen_through_glass() -> None:
    scene = bodies()
    scene.objects[4:] = []
    scene.lights = [vtray.SphereLight((0, 2, 0), 0.5, radiance=1, visible=True)]
    scene.camera = looking(PLACES["ball"])
    image = vtray.render(scene, integrator="path")
    assert image.linear[Y, X] == left(1.5, 0.01)
    assert vtray.trace_pixel(image, X, Y).light == tuple(image.linear[Y, X])
    assert (image.emission == image.linear).all()


@once
def test_under_water() -> None:
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material=GLASS)
    scene.add_plane((0, 0, -3), normal=(0, 0, 1), material=LAMP)
    for eye, below in ((-1.0, 2.0), (4.0, 3.0)):
        scene.camera = vtray.Camera.look_at(
            (0, 0, eye), target=(0, 0, -3), up=(0, 1, 0), fov_degrees=40, size=SIZE
        )
        image = vtray.render(scene, integrator="whitted")
        assert image.linear[Y, X] == left(below, 0.01)


@once
def test_cut_glass() -> None:
    scene = bodies()
    scene.objects = [item for item in scene.objects if isinstance(item, vtray.Sphere)]
    for place, length in (((0, 0, 0), 1.5), ((0, -2, 0), 2.5)):
        scene.camera = looking(place)
        image = vtray.render(scene, integrator="whitted", samples=1, clip=(0, -1, 0, 1), cap=True)
        assert image.linear[Y, X] == left(length, 0.06)
