"""What drawings show of copies: what their plane cuts of those written out."""

import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from copied import molecules
from test_drawn_shapes import make_section
from written_out import write_out

import vtray
from conftest import once
from vtray.figures.drawn import objects
from vtray.figures.drawn.cylinders import DrawnCylinders
from vtray.figures.drawn.objects import MOST_CUTS, _near, cut_shapes, placed_shapes
from vtray.figures.drawn.spheres import DrawnSpheres
from vtray.figures.section import Section

pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")

EVERYWHERE = np.array([(-99.0, -99.0), (99.0, 99.0)])
FLAT = Section(np.zeros(3), *np.eye(3))


def cut(scene: vtray.Scene, section: Section, box: Any) -> list[Any]:
    """Return the corners of what a plane cuts out, as `corners` does."""
    return corners(cut_shapes(scene, section, np.asarray(box, float)))


def cut_each(scene: vtray.Scene, section: Section, box: Any) -> list[Any]:
    """Return the same, found plainly: copies are written out, and all shapes are cut."""
    patches: list[Any] = []
    for item in write_out(scene)[0].objects:
        if isinstance(item, vtray.Plane):
            continue
        points = [np.array(rows(center)) for center, *_ in item.hull()]
        kind = DrawnSpheres if len(points) == 1 else DrawnCylinders
        shapes = kind(points, np.broadcast_to(item.radius, len(points[0])))
        middle, reach = shapes.cut(section)
        for k in np.flatnonzero(reach > 0):
            if (middle[k] > box[0] - reach[k]).all() and (middle[k] < box[1] + reach[k]).all():
                patches += [(reach[k], *shapes.some(np.array([k])).sections(section))]
    patches.sort(key=lambda pair: -pair[0])
    return corners([patch for _, patch in patches[:MOST_CUTS]])


def rows(points: Any) -> Any:
    """Return points, or one, as rows of doubles."""
    return [(points.x, points.y, points.z)] if isinstance(points, vtray.Vector) else points


def corners(patches: list[Any]) -> list[Any]:
    """Return the corners of patches, (n, 2) each, in an order of their own."""
    paths = [patch.get_path().transformed(patch.get_patch_transform()) for patch in patches]
    return sorted((path.vertices for path in paths), key=lambda xy: (len(xy), *np.round(xy[0], 6)))


def placed(item: Any, at: Any) -> vtray.Scene:
    """Return a scene of copies alone."""
    scene = vtray.Scene()
    scene.add_copies(item, at)
    return scene


def spread() -> vtray.Scene:
    """Return copies whose objects reach far beyond each other, and are long."""
    random = np.random.default_rng(5)
    balls = vtray.Spheres(random.uniform(-3, 3, (20, 3)), random.uniform(0.1, 0.4, 20))
    sticks = vtray.Cylinders(*random.uniform(-3, 3, (2, 9, 3)), radius=0.1)
    return placed([balls, sticks], random.uniform(-4, 4, (6, 3)))


@once
@pytest.mark.parametrize("make", [molecules, spread])
@pytest.mark.parametrize("pairs", [objects.PAIRS, 40, 1])
def test_a_plane_cuts_what_it_cuts_of_copies_written_out(
    make: Callable[[], vtray.Scene], pairs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(objects, "PAIRS", pairs)
    random = np.random.default_rng(1)
    scene = make()
    counts = []
    for box in [EVERYWHERE, *random.uniform([(-3, -3), (0, 0)], [(0, 0), (3, 3)], (20, 2, 2))]:
        section = make_section(random)
        found, expected = cut(scene, section, box), cut_each(scene, section, box)
        for shown, wanted in zip(found, expected, strict=True):
            assert shown == pytest.approx(wanted, abs=1e-9)
        counts.append(len(found))
    assert counts[0] > 8
    assert len(set(counts)) > 5


def test_the_largest_of_many_are_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(objects, "PAIRS", 300)
    random = np.random.default_rng(2)
    small = vtray.Spheres(random.uniform(-1, 1, (60, 3)) * (1, 1, 0), random.uniform(0.1, 0.3, 60))
    large = vtray.Sphere((0, 0, 0.1), 0.25)
    scene = placed([small, large], random.uniform(-9, 9, (30, 3)) * (1, 1, 1e-3))
    found, expected = cut(scene, FLAT, EVERYWHERE), cut_each(scene, FLAT, EVERYWHERE)
    assert len(found) == MOST_CUTS < len(small) * 30
    assert np.array(found) == pytest.approx(np.array(expected), abs=1e-9)


@pytest.mark.parametrize("at", [[], [(0, 0, 1.01)], [(9, 0, 0)], [(0, -9, 0.5)]])
def test_places_out_of_reach_are_left_out(at: Any) -> None:
    scene, box = placed([vtray.Sphere((0, 0, 0), 1), vtray.Spheres([], 1)], at), EVERYWHERE / 99
    assert cut(scene, FLAT, box) == []
    shown = list(placed_shapes(scene.objects))
    assert len(shown) == min(len(at), 1)
    assert [near for group in shown for near in _near(*group, FLAT, box)] == []


def test_many_copies_are_not_written_out() -> None:
    random = np.random.default_rng(4)
    ball = vtray.Spheres(random.uniform(0, 6, (10_000, 3)), random.uniform(0.01, 0.08, 10_000))
    at = np.stack(np.meshgrid(*[np.arange(0, 60, 6.0)] * 3), axis=-1).reshape(-1, 3)
    section = Section(np.full(3, 29.7), *np.linalg.qr(random.normal(size=(3, 3)))[0].T)
    tracemalloc.start()
    try:
        found = cut(placed(ball, at), section, EVERYWHERE)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(found) == MOST_CUTS
    assert peak < 30e6, "a double for each would take 80 MB"
