"""The rays of a pixel that meet cylinders: as data, in words, and drawn."""

import numpy as np
import pytest
from test_trace_pixel import floor_pixel, lit_floor, marks, texts

import vtray
from conftest import once

pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")

RED, BLUE = (200, 10, 20), (20, 10, 200)


def floor_with(*cylinders: vtray.Cylinder | vtray.Cylinders) -> vtray.Scene:
    """Return a floor with cylinders above it, in place of spheres."""
    scene = lit_floor()
    scene.objects[1:] = cylinders
    return scene


def bond(start: float, end: float) -> vtray.Cylinders:
    """Return a bond between two ends at x, 4 above a place on the floor; another is far away."""
    return vtray.Cylinders(
        [(50, 0, 5), (start, -3, 5)], [(60, 0, 5), (end, -3, 5)], 1, RED, color_end=BLUE
    )


@pytest.mark.parametrize(("ends", "color"), [((-3, 5), RED), ((-5, 3), BLUE), ((3, -5), RED)])
def test_what_blocks_has_the_color_of_its_half(
    ends: tuple[float, float], color: tuple[int, int, int]
) -> None:
    tree = vtray.trace_pixel(floor_with(bond(*ends)), *floor_pixel())
    blocker = tree.lights[0].blocker
    assert blocker is not None
    assert (blocker.object, blocker.index, blocker.radius) == (1, 1, 1)
    assert (blocker.center, blocker.end) == ((ends[0], -3, 5), (ends[1], -3, 5))
    assert blocker.color == color
    assert "adds       nothing: objects[1], cylinder 1, is in the way" in str(tree)


@once
@pytest.mark.parametrize(("column", "color"), [(22, RED), (42, BLUE)])
def test_what_is_hit_has_the_color_of_its_half(column: int, color: tuple[int, int, int]) -> None:
    scene = floor_with(vtray.Cylinder((30, 0, 5), (30, 9, 5), 1), bond(-9, 9))
    image = vtray.render(scene)
    tree = vtray.trace_pixel(image, column, 24 - 30 + 6)
    assert tree.hit is not None
    assert tree.hit.surface.color == color
    assert tree.light == tuple(image.linear[0, column])
    assert "objects[2], cylinder 1, " in str(tree)
    assert f"material   color {color}, lambert 1" in tree._repr_markdown_()
    # Cut across: a part of a circle that is one half of the bond.
    ax = tree.draw()
    ax.figure.draw_without_rendering()
    assert "objects[2], cylinder 1" in texts(ax)


def test_drawing_of_a_cylinder_cut_across() -> None:
    tree = vtray.trace_pixel(floor_with(vtray.Cylinder((-3, -3, 5), (5, -3, 5), 1)), *floor_pixel())
    ax = tree.draw(light=0)
    ax.figure.draw_without_rendering()
    assert "lights[0]\nblocked by objects[1], a cylinder" in texts(ax)
    assert marks(ax, "X") == [pytest.approx((10, 2))]
    (circle,) = [
        p.get_xy() for p in ax.patches if type(p).__name__ == "Polygon" and len(p.get_xy()) > 9
    ]
    assert np.hypot(*(circle - (10, 3)).T) == pytest.approx(1)


def test_drawing_of_a_cylinder_cut_along() -> None:
    item = vtray.Cylinders([(0, -3, 3)], [(0, -3, 9)], 1, RED, color_end=BLUE)
    tree = vtray.trace_pixel(floor_with(item), *floor_pixel())
    ax = tree.draw(light=0)
    halves = [p for p in ax.patches if type(p).__name__ == "Polygon" and len(p.get_xy()) > 9]
    # Seen from the eye at z = -5, in the order of their colours.
    for half, near, color in zip(halves, (8, 11), (RED, BLUE), strict=True):
        corners = half.get_xy()
        assert [*corners.min(axis=0), *corners.max(axis=0)] == pytest.approx([near, 2, near + 3, 4])
        assert half.get_facecolor()[:3] == pytest.approx(np.array(color) / 255)


@once
def test_box_of_a_drawing_includes_the_cylinder_that_is_hit() -> None:
    item = vtray.Cylinder((-1, -3, 5), (1, 0.5, 5), 0.4)
    scene = floor_with(item)
    image = vtray.render(scene)
    row, column = np.argwhere(image.ids[..., 0] == 1)[0]
    ax = vtray.trace_pixel(image, int(column), int(row)).draw()
    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    corners = [
        p.get_xy() for p in ax.patches if type(p).__name__ == "Polygon" and len(p.get_xy()) > 9
    ]
    assert corners
    for places in corners:
        assert (places > (low, bottom)).all()
        assert (places < (high, top)).all()


@once
@pytest.mark.parametrize(
    "item",
    [
        vtray.Cylinders(np.zeros((0, 3)), np.zeros((0, 3)), 1),
        vtray.Cylinder((0, -3, 5), (0, -3, 5), 1),
        vtray.Cylinder((0, -3, 5), (0, -1, 5), 0),
        vtray.Cylinder((-1e6, -3, 5), (1e6, -3, 5), 1),
        vtray.Cylinder((0, 0, -90), (0, 0, 90), 30),
        vtray.Cylinder((0, -1, 3), (0, -1, 90), 1),
    ],
)
def test_unusual_cylinders_can_be_drawn(item: vtray.Cylinder | vtray.Cylinders) -> None:
    for pixel in (floor_pixel(), (0, 0), (63, 47), (32, 20)):
        ax = vtray.trace_pixel(floor_with(item), *pixel).draw()
        ax.figure.draw_without_rendering()
        assert all(np.isfinite([*ax.get_xlim(), *ax.get_ylim()]))
