"""What drawings show of cones, compared with what says of single points if they are inside."""

from typing import Any

import numpy as np
import pytest
from test_drawn_shapes import make_section

from vtray.figures.drawn.cones import DrawnCones

path = pytest.importorskip("matplotlib.path", reason="needs the extra vtray[figure]")

COUNT = 30


def is_inside(points: Any, start: Any, end: Any, radii: Any) -> Any:
    """Return how far inside a cone points are, as far as its radius goes, below 0 outside, (n,)."""
    length = np.linalg.norm(end - start)
    axis = (end - start) / length
    height = (points - start) @ axis
    aside = np.linalg.norm(points - start - height[:, None] * axis, axis=1)
    radius = radii[0] + (radii[1] - radii[0]) * height / length
    return np.minimum(radius - aside, np.minimum(height, length - height))


def make_cones(random: Any, section: Any, lying: str) -> tuple[Any, Any, Any]:
    """Return starts, ends and radii of cones that lie to a plane as it is said."""
    start, way = random.normal(size=(2, COUNT, 3))
    if lying == "along":
        way -= (way @ section.normal)[:, None] * section.normal
    elif lying == "across":
        way = (way @ section.normal)[:, None] * section.normal
    radii = random.uniform(0.1, 1.5, (COUNT, 2))
    radii[::3, 0], radii[1::3, 1] = 0, 0
    return start, start + way, radii


@pytest.mark.parametrize("lying", ["anyhow", "along", "across"])
def test_what_a_plane_cuts_out(lying: str) -> None:
    random = np.random.default_rng(1)
    section = make_section(random)
    start, end, radii = make_cones(random, section, lying)
    shapes = DrawnCones([start, end], radii)
    middle, reach = shapes.cut(section)
    places = random.uniform(-3, 3, (3000, 2))
    met = 0
    for k in range(COUNT):
        around = places + section((start[k] + end[k]) / 2)
        points = section.origin + around @ np.array([section.across, section.up])
        depth = is_inside(points, start[k], end[k], radii[k])
        if np.isnan(reach[k]):
            assert depth.max() <= 0
            continue
        met += 1
        (patch,) = shapes.some(np.array([k])).sections(section)
        inside = path.Path(patch.get_xy()).contains_points(around)
        sure = np.abs(depth) > 5e-3
        np.testing.assert_array_equal(inside[sure], depth[sure] > 0)
        assert np.all(np.hypot(*(patch.get_xy() - middle[k]).T) <= reach[k] * (1 + 1e-9))
        corners = section.origin + patch.get_xy() @ np.array([section.across, section.up])
        assert np.abs(is_inside(corners, start[k], end[k], radii[k])).max() < 1e-6
    assert 3 < met < COUNT


@pytest.mark.parametrize("lying", ["anyhow", "along", "across"])
def test_outline_is_the_hull_of_the_caps(lying: str) -> None:
    random = np.random.default_rng(2)
    section = make_section(random)
    start, end, radii = make_cones(random, section, lying)
    turn = np.linspace(0, 2 * np.pi, 720)[:, None]
    for k in range(COUNT):
        shape = DrawnCones([start[k : k + 1], end[k : k + 1]], radii[k : k + 1])
        corners = shape.outline(section).get_xy()
        axis = (end[k] - start[k]) / np.linalg.norm(end[k] - start[k])
        side = np.linalg.svd(axis[None])[2][1]
        circle = np.cos(turn) * side + np.sin(turn) * np.cross(axis, side)
        rims = [c + r * circle for c, r in zip((start[k], end[k]), radii[k], strict=True)]
        points = section(np.concatenate(rims))
        for angle in np.linspace(0, 2 * np.pi, 17):
            way = np.array([np.cos(angle), np.sin(angle)])
            assert (corners @ way).max() == pytest.approx((points @ way).max(), abs=2e-3)


def test_lines_enter_and_leave() -> None:
    random = np.random.default_rng(3)
    section = make_section(random)
    start, end, radii = make_cones(random, section, "anyhow")
    met = 0
    for k in range(COUNT):
        shape = DrawnCones([start[k : k + 1], end[k : k + 1]], radii[k : k + 1])
        way = random.normal(size=3)
        way /= np.linalg.norm(way)
        origin = start[k] + (end[k] - start[k]) * 0.6 + 0.2 * random.normal(size=3) - 4 * way
        t = np.linspace(0, 8, 20001)
        depth = is_inside(origin + t[:, None] * way, start[k], end[k], radii[k])
        if depth.max() <= 1e-3:
            continue
        met += 1
        found = shape.inside(origin, way)
        inside = t[depth > 0]
        assert found == pytest.approx((inside[0], inside[-1]), abs=1e-3)
    assert met > 5


def test_halves_meet_in_the_middle() -> None:
    shape = DrawnCones([np.zeros((1, 3)), np.array([(0, 0, 2.0)])], np.array([(1.0, 0.0)]))
    first, second = shape.halves()
    assert (first.radius.tolist(), second.radius.tolist()) == ([[1, 0.5]], [[0.5, 0]])
    assert first.points[1].tolist() == second.points[0].tolist() == [[0, 0, 1]]
