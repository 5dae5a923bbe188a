"""What drawings show of cylinders: what their plane cuts out, outlines, and where lines meet them.

All is compared with what says of single points whether they are inside.
"""

from typing import Any

import numpy as np
import pytest

from vtray.figures.drawn.cylinders import DrawnCylinders
from vtray.figures.drawn.spheres import DrawnSpheres
from vtray.figures.section import Section

path = pytest.importorskip("matplotlib.path", reason="needs the extra vtray[figure]")


def is_inside(points: Any, start: Any, end: Any, radius: float) -> Any:
    """Return how far inside a cylinder points are, below 0 outside, (n,)."""
    axis = (end - start) / np.linalg.norm(end - start)
    height = (points - start) @ axis
    aside = np.linalg.norm(points - start - height[:, None] * axis, axis=1)
    return np.minimum(radius - aside, np.minimum(height, np.linalg.norm(end - start) - height))


def make_section(random: Any) -> Section:
    """Return a plane that lies anyhow."""
    across, up, _ = np.linalg.qr(random.normal(size=(3, 3)))[0].T
    return Section(random.normal(size=3), across, up, np.cross(across, up))


def make_cylinders(random: Any, section: Section, lying: str) -> tuple[Any, Any, Any]:
    """Return starts, ends and radii of cylinders that lie to a plane as it is said."""
    start, way = random.normal(size=(2, 40, 3))
    if lying == "along":
        way -= (way @ section.normal)[:, None] * section.normal
    elif lying == "across":
        way = (way @ section.normal)[:, None] * section.normal
    elif lying == "nearly along":
        way -= (1 - 1e-9) * (way @ section.normal)[:, None] * section.normal
    elif lying == "nearly across":
        way = 1e-9 * way + (way @ section.normal)[:, None] * section.normal
    return start, start + way, random.uniform(0.1, 1.5, 40)


@pytest.mark.parametrize("lying", ["anyhow", "along", "across", "nearly along", "nearly across"])
def test_what_a_plane_cuts_out(lying: str) -> None:
    random = np.random.default_rng(1)
    section = make_section(random)
    start, end, radius = make_cylinders(random, section, lying)
    shapes = DrawnCylinders([start, end], radius)
    middle, reach = shapes.cut(section)
    places = random.uniform(-3, 3, (4000, 2))
    places = np.concatenate([places, random.normal(scale=0.2, size=(500, 2))])
    met = 0
    for k in range(40):
        around = places + section((start[k] + end[k]) / 2)
        points = section.origin + around @ np.array([section.across, section.up])
        depth = is_inside(points, start[k], end[k], radius[k])
        if np.isnan(reach[k]):
            assert depth.max() <= 0
            continue
        met += 1
        one = shapes.some(np.array([k]))
        (patch,) = one.sections(section)
        inside = path.Path(patch.get_xy()).contains_points(around)
        sure = np.abs(depth) > 1e-3 * radius[k]
        np.testing.assert_array_equal(inside[sure], depth[sure] > 0)
        assert np.all(np.hypot(*(patch.get_xy() - middle[k]).T) <= reach[k] * (1 + 1e-9))
        # The corners are on its surface.
        corners = section.origin + patch.get_xy() @ np.array([section.across, section.up])
        assert np.abs(is_inside(corners, start[k], end[k], radius[k])).max() < 1e-6
    assert 5 < met < 40


@pytest.mark.parametrize("lying", ["anyhow", "along", "across"])
def test_outline_is_the_hull_of_the_caps(lying: str) -> None:
    random = np.random.default_rng(2)
    section = make_section(random)
    start, end, radius = make_cylinders(random, section, lying)
    turn = np.linspace(0, 2 * np.pi, 720)
    for k in range(40):
        shape = DrawnCylinders([start[k : k + 1], end[k : k + 1]], radius[k : k + 1])
        corners = shape.outline(section).get_xy()
        axis = (end[k] - start[k]) / np.linalg.norm(end[k] - start[k])
        side = np.linalg.svd(axis[None])[2][1]
        circle = np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * np.cross(axis, side)
        points = section(np.concatenate([c + radius[k] * circle for c in (start[k], end[k])]))
        for angle in np.linspace(0, np.pi, 9):
            way = np.array([np.cos(angle), np.sin(angle)])
            assert np.ptp(corners @ way) == pytest.approx(np.ptp(points @ way), rel=1e-3)
            assert (corners @ way).max() == pytest.approx((points @ way).max(), abs=2e-3)
        low, high = shape.bounds(section)
        assert [*low, *high] == pytest.approx([*corners.min(axis=0), *corners.max(axis=0)])


def test_share_of_the_outline_that_is_cut_out() -> None:
    section = Section(np.zeros(3), *np.eye(3))
    ball = DrawnSpheres([np.array([(0, 0, 0.6)])], np.ones(1))
    assert ball.share(section) == pytest.approx(0.8)
    upright = DrawnCylinders([np.array([(0, 0, -1.0)]), np.array([(0, 0, 1.0)])], np.ones(1))
    assert upright.share(section) == pytest.approx(1)
    lying = DrawnCylinders([np.array([(-1, 0, 0.6)]), np.array([(1.0, 0, 0.6)])], np.ones(1))
    assert lying.share(section) == pytest.approx(np.sqrt(0.8))
    away = DrawnCylinders([np.array([(-1, 0, 2.0)]), np.array([(1.0, 0, 2)])], np.ones(1))
    assert away.share(section) == 0


def test_lines_enter_and_leave() -> None:
    random = np.random.default_rng(3)
    way = np.concatenate([np.eye(3), random.normal(size=(60, 3))])
    way /= np.linalg.norm(way, axis=1)[:, None]
    start, end = np.array([(0.3, -1, 0.5)]), np.array([(0.3, 2, 0.5)])
    for direction in way:
        within = start[0] + random.uniform((-0.4, 0.1, -0.4), (0.4, 2.9, 0.4))
        origin = within - 5 * direction
        near, far = DrawnCylinders([start, end], np.array([0.7])).inside(origin, direction)
        assert near < 5 < far
        ends = origin + np.array([[near], [far]]) * direction
        assert is_inside(ends, start[0], end[0], 0.7) == pytest.approx([0, 0], abs=1e-9)
