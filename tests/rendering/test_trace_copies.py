"""The rays of a pixel that meet copies: as data, in words, and drawn."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from copied import molecules
from test_trace_pixel import floor_pixel, lit_floor, marks, texts
from written_out import Origin, write_out

import vtray
from conftest import once
from vtray.figures.ray_tree import RayTree, Surface

pytest.importorskip("matplotlib", reason="needs the extra vtray[figure]")
from matplotlib.figure import Figure

RED, BLUE = (200, 10, 20), (20, 10, 200)


def as_copied(tree: RayTree, origins: list[Origin]) -> RayTree:
    """Return the rays in a scene that is written out, with the names that copies have."""

    def renamed(surface: Surface) -> Surface:
        place, copy, part = origins[surface.object]
        return dataclasses.replace(surface, object=place, copy=copy, part=part)

    lights = [
        ray if ray.blocker is None else dataclasses.replace(ray, blocker=renamed(ray.blocker))
        for ray in tree.lights
    ]
    hit = tree.hit and dataclasses.replace(tree.hit, surface=renamed(tree.hit.surface))
    return dataclasses.replace(tree, hit=hit, lights=tuple(lights))


@once
def test_rays_are_those_of_copies_written_out() -> None:
    scene = molecules(size=(36, 27))
    written, origins = write_out(scene)
    image, other = vtray.render(scene), vtray.render(written)
    seen = other.ids[..., 0]
    pixels = [pixel for k in np.unique(seen) for pixel in np.argwhere(seen == k)[::4]]
    hits, blockers = set(), set()
    for row, column in pixels:
        tree = vtray.trace_pixel(image, column, row)
        assert tree == as_copied(vtray.trace_pixel(other, column, row), origins)
        if tree.hit is not None:
            hits.add((tree.hit.surface.object, tree.hit.surface.part))
        blockers |= {(ray.blocker.object, ray.blocker.part) for ray in tree.lights if ray.blocker}
    assert hits == {(0, None), *((1, k) for k in range(4)), (2, None), (3, 1), (5, None)}
    assert blockers >= {(1, 0), (1, 1), (1, 3), (2, None), (3, 1)}


def in_lines(name: str) -> str:
    """Return a name as drawings have it: that of a part of a copy in two lines."""
    return name.replace(", ", ",\n") if "of copy" in name else name


def floor_with(*parts: Any) -> vtray.Scene:
    """Return a floor with copies in place of spheres; the second is above `floor_pixel`."""
    scene = lit_floor()
    scene.objects[1:] = [vtray.Copies(parts, [(60, 0, 0), (0, -3, 5), (-90, 0, 0)])]
    return scene


ATOMS = vtray.Spheres([(9, 0, 0), (0, 0, 0)], [0.5, 1], [BLUE, RED])
BOND = vtray.Cylinders([(8, 0, 0), (-3, 0, 0)], [(9, 0, 0), (5, 0, 0)], 1, RED, color_end=BLUE)


@pytest.mark.parametrize(
    ("parts", "name", "color"),
    [
        ([vtray.Sphere((9, 0, 0), 1), ATOMS], "objects[1].objects[1], sphere 1 of copy 1", RED),
        ([vtray.Sphere((0, 0, 0), 1, BLUE)], "objects[1].objects[0], a sphere of copy 1", BLUE),
        ([vtray.Spheres([], 1), BOND], "objects[1].objects[1], cylinder 1 of copy 1", RED),
    ],
)
def test_names_and_drawings_of_what_blocks(
    parts: list[Any], name: str, color: tuple[int, int, int]
) -> None:
    tree = vtray.trace_pixel(floor_with(*parts), *floor_pixel())
    blocker = tree.lights[0].blocker
    assert blocker is not None
    assert (str(blocker), blocker.color) == (name, color)
    assert f"adds       nothing: {name}, is in the way" in str(tree)
    ax = tree.draw(light=0)
    ax.figure.draw_without_rendering()
    assert f"lights[0]\nblocked by {in_lines(name)}" in texts(ax)
    assert marks(ax, "X") == [pytest.approx((10, 2))]


def test_text_says_where_the_copy_that_is_hit_stands() -> None:
    scene = floor_with(vtray.Sphere((0.5, 0, 0), 1, RED))
    image = vtray.render(scene)
    row, column = np.argwhere(image.copies == 1)[0]
    tree = vtray.trace_pixel(image, int(column), int(row))
    lines = str(tree).splitlines()
    assert lines[2].startswith("hit          objects[1].objects[0], a sphere of copy 1, ")
    assert lines[3] == "  copy       moved by (0, -3, 5)"
    assert "  copy       moved by (0, -3, 5)" in tree._repr_markdown_()
    assert "copy" not in str(vtray.trace_pixel(image, *floor_pixel())).splitlines()[3]


def surfaces(tree: RayTree) -> list[Surface]:
    """Return all that the rays of a pixel meet."""
    found = [tree.hit.surface] if tree.hit else []
    return found + [ray.blocker for ray in tree.lights if ray.blocker]


def outlines(ax: Any) -> list[Any]:
    """Return the corners of all shapes in a drawing, (n, 2) each, in an order of their own."""
    paths = [path for collection in ax.collections for path in collection.get_paths()]
    paths += [patch.get_path().transformed(patch.get_patch_transform()) for patch in ax.patches]
    return sorted((path.vertices for path in paths), key=lambda xy: (len(xy), *np.round(xy[0], 6)))


@once
@pytest.mark.parametrize("pixel", [(18, 13), (12, 15), (14, 9), (25, 15), (7, 25)])
def test_drawings_are_those_of_copies_written_out(pixel: tuple[int, int]) -> None:
    scene = molecules(size=(36, 27))
    written, origins = write_out(scene)
    tree, other = vtray.trace_pixel(scene, *pixel), vtray.trace_pixel(written, *pixel)
    ax, beside = tree.draw(), other.draw()
    pairs = zip(surfaces(other), surfaces(as_copied(other, origins)), strict=True)
    names = {str(old): in_lines(str(new)) for old, new in pairs}
    found = texts(beside)
    for old, new in names.items():
        found = [text.replace(old, new) for text in found]
    assert sorted(texts(ax)) == sorted(found)
    for shown, expected in zip(outlines(ax), outlines(beside), strict=True):
        assert shown == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("inches", [3, 5, 8])
def test_names_are_within_the_drawing(inches: float) -> None:
    tree = vtray.trace_pixel(molecules(size=(36, 27)), 18, 13)
    ax = Figure(figsize=(inches, 0.7 * inches), dpi=100).add_axes((0.02, 0.08, 0.96, 0.82))
    tree.draw(ax)
    assert tree.hit is not None
    (name,) = [text for text in ax.texts if text.get_text() == in_lines(str(tree.hit.surface))]
    box = name.get_window_extent()
    assert 0 <= box.x0 < box.x1 <= ax.figure.bbox.x1
