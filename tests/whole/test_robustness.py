"""No speckle and no lost digits, in scenes made to provoke them."""

import json
from typing import Any

import numpy as np
import oracle
import pytest
from examples import cylinder, light, plane, scene, sphere, xyz
from oracle_cylinder import Cylinder
from plain import NOTHING, trace_pixel

import vtray
from conftest import compiled_only
from vtray.geometry.rounding import ROUNDING
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack

pytestmark = compiled_only

TILTED = (0.3, -0.8, 0.52)

HARD = {
    "floor to the horizon": scene([plane((0, 5, 0), (0, -1, 0))], [light(5, -5, 0)]),
    "tilted floor to the horizon": scene(
        [plane((0, 5, 0), (0, -1, 0))], [light(5, -5, 0)], normal=xyz(0.6, 0.1, 0.7)
    ),
    "floor that meets the horizon in a pixel row": scene(
        [plane((0, 5, 0), (0, -1, 0))], [light(5, -5, 3)], normal=xyz(0.6, 0, 0.8)
    ),
    "horizon in a pixel row of a tilted camera": scene(
        [plane((0, 1, 0), (0, -1, 0))],
        [light(-6, -9, -6)],
        center=xyz(0, -2, -4),
        normal=xyz(0, 0.3, 1),
        focus=6,
        size=[40, 400],
        resolution=[0.01, 0.01],
    ),
    "tilted plane": scene([plane((1, 2, 7), TILTED)], [light(5, 5, 0), light(-7, -20, 3)]),
    "plane through the eye": scene(
        [plane((0, 1, 0), (0.2, -1, 0.1)), sphere((0, 0, 5), 2)], [light(5, -5, 0)]
    ),
    "huge sphere as ground": scene([sphere((0, 1e9 + 3, 0), 1e9)], [light(5, -5, 0)]),
    "tiny spheres": scene(
        [sphere((1e-6 * k, 0, 5e-6), 0.45e-6) for k in range(-3, 4)],
        [light(5e-6, -5e-6, 0)],
        focus=1e-5,
        resolution=[1.2e-7, 1.2e-7],
    ),
    "sphere on a plane": scene(
        [sphere((0, 0, 5), 1), plane((0, 1, 0), (0, -1, 0))], [light(5, -5, 0), light(-1, -9, 2)]
    ),
    "planes and spheres that cross": scene(
        [
            sphere((0, 0, 5), 1.5),
            sphere((1, 0.5, 5), 1.5),
            plane((0, 1, 0), (0.2, -1, 0.1)),
            plane((0, 0, 6), TILTED),
        ],
        [light(5, -5, 0), light(-4, -8, -2)],
    ),
    "coincident spheres and planes": scene(
        [sphere((0, 0, 5), 1), sphere((0, 0, 5), 1), *[plane((0, 1, 0), TILTED)] * 3],
        [light(5, -5, 0), light(-4, -3, 2)],
    ),
    "eye and light inside a sphere": scene(
        [sphere((0, 0, 0), 20), sphere((1, 0, 5), 1)], [light(2, -3, -4), light(0, 5, 8)]
    ),
    "spheres cut by the image plane": scene(
        [sphere((0, 0, 0), 2), sphere((2, 1, 0.5), 1.5)], [light(3, -4, -6), light(0.5, 0, 0.5)]
    ),
    "light on the surfaces": scene(
        [sphere((0, 0, 5), 1), plane((0, 1, 0), (0, -1, 0))],
        [light(0, -1, 5), light(3, 1, 4), light(0, -6, 3)],
    ),
    "cylinders that cross, on a floor": scene(
        [
            cylinder((-2, 1, 4), (2, -1, 7), 0.7),
            cylinder((-1, -2, 6), (1, 1.5, 5), 0.5),
            plane((0, 1.5, 0), (0, -1, 0.1)),
        ],
        [light(5, -5, 0), light(-4, -8, -2)],
    ),
    "a long thin cylinder to the horizon": scene(
        [cylinder((-1, 1, 1), (30, -2, 1e4), 0.3), cylinder((1, 1, 1), (-3e5, 2e5, 1e6), 0.5)],
        [light(5, -5, 0)],
    ),
    "huge cylinders as ground and wall": scene(
        [
            cylinder((-1e9, 1e8 + 3.3, 20.1), (1e9, 1e8 + 3.3, 20.1), 1e8),
            cylinder((0.2, 0, 60), (1.3, 0.4, 1e7), 1e6),
        ],
        [light(5, -5, 0)],
    ),
    "tiny cylinders": scene(
        [cylinder((1e-6 * k, -1e-6, 5e-6), (1e-6 * k, 1e-6, 6e-6), 0.3e-6) for k in range(-3, 4)],
        [light(5e-6, -5e-6, 0)],
        focus=1e-5,
        resolution=[1.3e-7, 1.3e-7],
    ),
    "eye and light inside a cylinder": scene(
        [cylinder((-3, 0.2, -30), (4, 0.5, 40), 9), cylinder((1, 0, 5), (1.5, 1, 6), 1)],
        [light(2, -3, -4), light(0, 5, 8)],
    ),
    "cylinders cut by the image plane": scene(
        [cylinder((0, 0, -1), (0.4, 0.3, 2), 1.5), cylinder((2, 1, -3), (1.5, -1, 3), 0.5)],
        [light(3, -4, -6), light(0.5, 0, 0.5)],
    ),
    "thin discs, and coincident cylinders": scene(
        [
            cylinder((0, 0.3, 5), (0.001, 0.301, 5.003), 2),
            *[cylinder((-2, -1.3, 6), (2, -1, 5), 0.4)] * 2,
        ],
        [light(5, -5, 0), light(-4, -3, 2)],
    ),
    "light on a cylinder": scene(
        [cylinder((-1, 0.5, 5), (1, 0.5, 5), 0.5)],
        [light(0.25, 0, 5), light(1, 0.6, 5.1), light(0, -6, 3)],
    ),
}
# Seen edge-on, or from the side that no light reaches.
BLACK = {
    "floor to the horizon",
    "floor that meets the horizon in a pixel row",
    "huge sphere as ground",
    "planes and spheres that cross",
}

HARD |= {
    f"{name}, orthographic": {
        **document,
        "camera": document["camera"] | {"projection": "orthographic", "up": xyz(0.2, 1, 0.1)},
    }
    for name, document in HARD.items()
    if name not in BLACK
}


def render(document: dict[str, Any]) -> vtray.Image:
    return vtray.render(vtray.loads(json.dumps(document)))


def shifted(document: dict[str, Any], by: float) -> dict[str, Any]:
    """Return a scene moved as a whole."""
    moved = json.loads(json.dumps(document))
    names = {"center", "start", "end"}
    places = [moved["camera"]["center"]]
    places += [item[name] for item in moved["objects"] for name in names & item.keys()]
    for place in [*places, *(item["location"] for item in moved["lights"])]:
        for axis in "xyz":
            place[axis] += by
    return moved


@pytest.mark.parametrize("name", HARD)
def test_equals_the_truth(name: str) -> None:
    # The oracle in extended precision stands for the truth: a pixel may differ from it only where
    # the last bit decides, on an edge or at a step of exposure.
    truth = oracle.develop(oracle.render(HARD[name], np.longdouble)).astype(int)
    difference = np.abs(render(HARD[name]).pixels - truth).max(axis=2)
    assert truth.max() == 255
    assert render(HARD[name]).linear.min() >= 0
    assert np.count_nonzero(difference > 1) <= 2
    assert np.count_nonzero(difference) <= 6


@pytest.mark.parametrize("by", [1e6, -1e6, 12345.678])
@pytest.mark.parametrize("name", [name for name in HARD if "tiny" not in name])
def test_stays_the_same_when_the_scene_is_moved(name: str, by: float) -> None:
    difference = np.abs(
        render(HARD[name]).pixels.astype(int) - render(shifted(HARD[name], by)).pixels
    ).max(axis=2)
    assert np.count_nonzero(difference > 1) <= 12
    assert np.count_nonzero(difference) <= 40


@pytest.mark.parametrize("exponent", [-600, -60, 60, 600])
@pytest.mark.parametrize("name", HARD)
def test_stays_the_same_when_the_scene_is_scaled(name: str, exponent: int) -> None:
    document = json.loads(json.dumps(HARD[name]))
    factor = 2.0**exponent
    for item in [document["camera"], *document["objects"], *document["lights"]]:
        for key in {"focus", "radius"} & item.keys():
            item[key] *= factor
        for key in {"center", "location", "start", "end"} & item.keys():
            item[key] = {axis: value * factor for axis, value in item[key].items()}
    camera = document["camera"]
    camera["resolution"] = [length * factor for length in camera["resolution"]]
    np.testing.assert_array_equal(render(document).linear, render(HARD[name]).linear)


@pytest.mark.parametrize("far", [1e20, 1e60, 1e100])
def test_light_as_far_as_can_be_shines_from_its_direction(far: float) -> None:
    objects = [sphere((0, 0, 5), 1), sphere((1, -2, 4), 0.5), plane((0, 1, 0), (0, -1, 0))]
    near = render(scene(objects, [light(3e6, -4e6, -2e6)])).linear
    difference = np.abs(render(scene(objects, [light(3 * far, -4 * far, -2 * far)])).linear - near)
    assert np.count_nonzero(difference > 0.01) <= 3


def test_camera_does_not_vanish_beside_something_huge() -> None:
    wall = plane((0, 0, 1e200), (0.1, 0, -1))
    picture = render(scene([wall], [light(0, 0, 0)])).pixels
    assert (picture > 200).all()


@pytest.mark.parametrize("by", [0.0, 1e6, -12345.678])
@pytest.mark.parametrize("normal", [TILTED, (0, -1, 0), (1e-9, 1, -1e-9)])
def test_light_in_a_plane_gives_it_nothing(normal: tuple[float, ...], by: float) -> None:
    # The light grazes the plane: rounding alone would decide which pixels it reaches.
    across = (normal[1], -normal[0], 0.0)
    place = tuple(p + 3 * a for p, a in zip((0, 1, 6), across, strict=True))
    document = scene([plane((0, 1, 6), normal)], [light(*place)])
    assert render(shifted(document, by)).linear.max() == 0


@pytest.mark.parametrize("normal", [TILTED, (0, 0, 1), (0.1, 0, -0.9)])
def test_light_in_a_plane_shines_on_the_rest(normal: tuple[float, ...]) -> None:
    camera = {"normal": xyz(*normal), "center": xyz(3, 2, 1)}
    ball = sphere(tuple(c + 6 * n for c, n in zip((3, 2, 1), normal, strict=True)), 1)
    wall = plane((3, 2, 1), (normal[1], -normal[0], 0) if normal[0] else (0, 1, 0))
    lamp = [light(3, 2, 1)]
    with_wall = render(scene([ball, wall], lamp, **camera)).linear
    without = render(scene([ball], lamp, **camera)).linear
    assert without.max() > 0
    # The plane through the light hides half of the ball at most, and never speckles it.
    lit = (without.max(axis=2) > 0) & (with_wall.max(axis=2) > 0)
    np.testing.assert_array_equal(with_wall[lit], without[lit])


@pytest.mark.parametrize("normal", [(0, 0, 1), TILTED, (-0.7, 0.1, -0.4)])
@pytest.mark.parametrize("by", [0.0, 1e6])
def test_plane_in_the_image_plane_is_behind_it(normal: tuple[float, ...], by: float) -> None:
    camera = {"normal": xyz(*normal)}
    ball = sphere(tuple(6 * n for n in normal), 1)
    wall = plane((0, 0, 0), normal)
    lamp = [light(*(-4 * n + 0.5 for n in normal))]
    with_wall = render(shifted(scene([ball, wall], lamp, **camera), by)).linear
    without = render(shifted(scene([ball], lamp, **camera), by)).linear
    assert without.max() > 0
    np.testing.assert_array_equal(with_wall, without)


@pytest.mark.parametrize("normal", [(0, 0, 1), TILTED, (-0.7, 0.1, -0.4)])
@pytest.mark.parametrize("radius", [1e3, 6.371e6, 1e10])
def test_the_ground_under_the_image_plane_is_behind_it(
    normal: tuple[float, ...], radius: float
) -> None:
    unit = np.array(normal) / np.sqrt(np.square(normal).sum())
    camera = {"normal": xyz(*normal), "center": xyz(*(radius * unit)), "focus": 2}
    ground = scene([sphere((0, 0, 0), radius)], [light(0, 0, 0)], **camera)
    assert (render(ground).ids == -1).all()


@pytest.mark.parametrize("name", HARD)
def test_rounding_stays_within_its_bound(name: str) -> None:
    document = HARD[name]
    loaded = vtray.loads(json.dumps(document))
    packed = pack(loaded, accelerate(loaded))
    kinds = ["sphere", "cylinder", "plane"]
    primitives = sorted(document["objects"], key=lambda item: kinds.index(item["type"]))
    camera = packed.arrays.camera
    cosines = np.zeros(len(loaded.lights))
    blockers = np.zeros(len(loaded.lights), np.int64)
    worst = 0.0
    for row in range(0, camera.height, 3):
        for column in range(0, camera.width, 3):
            traced = trace_pixel(packed.arrays, column, row, cosines, blockers)
            if traced.primitive == NOTHING:
                continue
            found = traced.interaction
            off = distance_from_surface(
                primitives[traced.primitive],
                [np.longdouble(p) * packed.unit for p in found.point],
                document["camera"]["center"],
            )
            worst = max(worst, float(off / packed.unit) / found.error_scale)
    assert worst < ROUNDING / 4


def distance_from_surface(
    item: dict[str, Any], point: list[np.longdouble], origin: dict[str, float]
) -> np.longdouble:
    """Return how far a point, relative to the origin, is from an object's surface."""
    center = item["start" if item["type"] == "cylinder" else "center"]
    arm = [
        p + np.longdouble(origin[axis]) - center[axis] for p, axis in zip(point, "xyz", strict=True)
    ]
    if item["type"] == "cylinder":
        way = [np.longdouble(item["end"][axis]) - center[axis] for axis in "xyz"]
        return abs(Cylinder(np.zeros(3), np.array(way), item["radius"]).outside(np.array([arm]))[0])
    if item["type"] == "sphere":
        return abs(np.sqrt(sum(a * a for a in arm)) - item["radius"])
    normal = [np.longdouble(item["normal"][axis]) for axis in "xyz"]
    length = np.sqrt(sum(n * n for n in normal))
    return abs(sum(a * n for a, n in zip(arm, normal, strict=True))) / length
