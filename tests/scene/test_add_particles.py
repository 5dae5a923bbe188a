"""Particles as objects of a scene: styles, sizes, colours, and what they are made of."""

import copy
import re
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest
from ase.data import atomic_numbers
from ase.data.vdw_alvarez import vdw_radii

import vtray
from vtray.base.errors import SceneError
from vtray.base.exact_math import logarithm
from vtray.scene.particles.coloring import PALETTE
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.radii import filled_boxes, mean_spacing
from vtray.scene.placing.directions import unit

WATER = Particles(
    [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)],
    {
        "element": np.array(["O", "H", "H"]),
        "charge": np.array([-0.8, 0.4, 0.4]),
        "residue": np.array([7, 7, 9]),
        "name": np.array(["O", "H1", "H2"]),
        "force": np.array([[0, 3, 4], [0, 0, 1], [1, 0, 0.0]]),
    },
)


def drawn(particles: Any = WATER, **options: Any) -> Any:
    return vtray.Scene().add_particles(particles, **options)


@pytest.mark.parametrize(
    ("options", "style", "radius", "stick"),
    [
        ({}, "spacefill", [1.5, 1.2, 1.2], None),
        ({"scale": 0.5}, "spacefill", [0.75, 0.6, 0.6], None),
        ({"radii": "covalent"}, "spacefill", [0.66, 0.31, 0.31], None),
        ({"bonds": True}, "ball-and-stick", [0.396, 0.186, 0.186], 0.1),
        ({"style": "ball-and-stick", "scale": 2}, "ball-and-stick", [0.792, 0.372, 0.372], 0.2),
        ({"bonds": [(0, 1)], "radii": 0.5}, "ball-and-stick", 0.5, 0.15),
        ({"style": "licorice"}, "licorice", 0.2, 0.2),
        ({"bonds": 1.0, "bond_radius": 0.3, "radii": "vdw"}, "ball-and-stick", None, 0.3),
        ({"radii": [1, 2, 3]}, "spacefill", [1, 2, 3], None),
    ],
)
def test_styles(options: dict[str, Any], style: str, radius: Any, stick: float | None) -> None:
    found = drawn(**options)
    assert found.style == style
    if radius is not None:
        assert np.allclose(found.spheres.radius, radius)
    assert (found.bonds is None) == (stick is None)
    assert stick is None or found.bonds.radius == pytest.approx(stick)


@pytest.mark.parametrize(
    ("elements", "first"),
    [
        ("Sr Ti O O O", 1.95),
        ("Au", 1.36),
        ("Si O O", 1.11),
        ("Na Cl", 1.66),
        ("Mg O O H H", 1.41),
        ("Mg O O H H H", 2.51),
        ("Zn C C C C C C C C C C N N N", 2.39),
        ("Ar", 1.83),
        ("N N", 1.66),
    ],
)
def test_balls_of_solids_touch(elements: str, first: float) -> None:
    names = elements.split()
    atoms = Particles(np.arange(3.0 * len(names)).reshape(-1, 3), {"element": names})
    assert drawn(atoms, style="spacefill").spheres.radius[0] == pytest.approx(first)
    whole = drawn(atoms, style="spacefill", radii="vdw").spheres.radius[0]
    assert whole == pytest.approx(float(vdw_radii[atomic_numbers[names[0]]]))


def test_known_bonds_of_few_atoms_are_drawn() -> None:
    known = Particles(WATER.positions, {"element": WATER["element"]}, bonds=[(0, 1)])
    assert drawn(known).style == "ball-and-stick"
    assert len(drawn(known).bonds) == 1
    assert drawn(known, bonds=False).style == "spacefill"
    assert drawn(known, style="licorice", bonds=False).bonds is None


def test_bonds_change_colour_in_the_middle_of_what_is_seen() -> None:
    pair = {"element": np.array(["Ti", "O"])}
    both = Particles([(0, 0, 0), (2, 0, 0)], pair)
    large, small = drawn(both, bonds=True).spheres.radius.tolist()
    sticks = drawn(both, bonds=True).bonds
    start, end = sticks.start[0, 0], sticks.end[0, 0]
    assert (start + end) / 2 == pytest.approx((large + 2 - small) / 2)
    assert 0 < start < large
    assert end == 2
    cut = Particles([(0, 0, 0), (6, 0, 0)], pair, cell=np.diag([8.0] * 3))
    halves = drawn(cut, bonds=True).bonds
    assert halves.start[:, 0].tolist() == [0, 6]
    middle = (large + 2 - small) / 2
    assert halves.end[:, 0].tolist() == pytest.approx([-middle, 8 - middle])


def test_size_is_that_of_a_column_or_of_the_mean_distance() -> None:
    lattice = np.stack(np.meshgrid(*[np.arange(5.0)] * 3), axis=-1).reshape(-1, 3)
    assert mean_spacing(Particles(lattice)) == pytest.approx(4 / 5)
    assert mean_spacing(Particles(lattice * [1, 1, 0])) == pytest.approx(np.sqrt(16 / 125))
    assert mean_spacing(Particles(lattice * [0, 1, 0])) == pytest.approx(4 / 125)
    assert mean_spacing(Particles(np.zeros((3, 3)))) == 1.0
    assert drawn(lattice).spheres.radius == pytest.approx(0.4)
    sized = Particles(lattice, {"radius": np.full(125, 0.3), "size": np.full(125, 0.1)})
    assert drawn(sized).spheres.radius[7] == 0.3
    assert drawn(sized, radii="size", scale=2).spheres.radius[7] == 0.2


def test_mean_distance_is_that_where_particles_are() -> None:
    x, y = (side.ravel() for side in np.meshgrid(*[np.arange(60.0)] * 2))
    hills = np.stack([x, y, 15 * np.sin(x / 10) * np.sin(y / 10)], axis=1)
    assert mean_spacing(Particles(hills)) == pytest.approx(1.2, abs=0.3)
    turn = np.arange(2000.0) / 2000
    helix = np.stack([300 * np.cos(9 * turn), 300 * np.sin(9 * turn), 700 * turn], axis=1)
    assert mean_spacing(Particles(helix)) == pytest.approx(1.4, rel=0.5)
    far = np.concatenate([hills, hills + 1e5])
    assert mean_spacing(Particles(far)) == pytest.approx(1.2, abs=0.3)
    assert mean_spacing(Particles(np.repeat([(0.0, 0, 0), (1, 1, 1)], 500, axis=0))) > 0


@pytest.mark.parametrize("side", [50.0, 7.0, 1.0, 0.01])
def test_filled_boxes_are_counted(side: float) -> None:
    points = np.random.default_rng(7).uniform(-40, 60, (300, 3))
    boxes = {tuple(row) for row in np.floor((points - points.min(axis=0)) / side).tolist()}
    assert filled_boxes(points, side) == len(boxes)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_points_are_as_large_as_pixels(projection: Any) -> None:
    scene = vtray.Scene()
    points = np.random.default_rng(2).normal(size=(50, 3)) * 30
    with pytest.raises(SceneError, match="which needs a camera; set scene.camera first"):
        scene.add_particles(points, "points")
    camera = vtray.Camera.fit(points, projection=projection, size=(40, 30))
    radius = np.broadcast_to(
        scene.add_particles(points, "points", camera=camera).spheres.radius, 50
    )
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    far = (points - center) @ unit(camera.normal) / camera.focus + 1
    pixels = radius / camera.resolution[0] / (far if projection == "perspective" else 1)
    assert np.allclose(pixels, 0.75)


def test_colors_of_elements() -> None:
    found = drawn()
    assert found.spheres.color.tolist() == [[255, 13, 13], [228] * 3, [228] * 3]
    assert found.legend == [("H", (228, 228, 228)), ("O", (255, 13, 13))]
    assert found.categories == ["H", "O"]
    more = drawn(categories=["O", "C", "none", 7])
    assert [name for name, _ in more.legend] == ["H", "C", "O"]
    assert (more.spheres.color == found.spheres.color).all()
    assert drawn(colors="cpk").spheres.color[0].tolist() == [240, 0, 0]


def test_colors_by_columns() -> None:
    charge = drawn(color="charge", norm="centered", cmap="coolwarm")
    assert (charge.color_scale.low, charge.color_scale.high) == (-0.8, 0.8)
    assert charge.spheres.color.tolist() == charge.color_scale.colors([-0.8, 0.4, 0.4]).tolist()
    force = drawn(color="force")
    assert (force.color_scale.low, force.color_scale.high) == (1, 5)
    residue = drawn(color="residue")
    assert [label for label, _ in residue.legend] == ["7", "9"]
    first, second = (list(vtray.colors.to_rgb(color)) for color in PALETTE[:2])
    assert residue.spheres.color.tolist() == [first, first, second]
    assert drawn(color="residue", cmap="viridis").color_scale.high == 9
    assert len(drawn(color="name").legend) == 3
    assert drawn(color=[1.0, 2.0, 3.0], cmap="viridis").color_scale.high == 3
    assert drawn(color="z", clim=(0, 1)).color_scale.low == 0
    assert drawn(color="tomato").spheres.color.tolist() == [255, 99, 71]
    assert drawn(np.zeros((2, 3)), color=[(1.0, 0, 0), (0, 0, 1.0)]).spheres.color[1, 2] == 255


@pytest.mark.parametrize("count", [2, 3, 4, 5])
@pytest.mark.parametrize("kind", [tuple, list, np.array])
def test_three_numbers_are_one_colour(count: int, kind: Any) -> None:
    places = np.arange(3.0 * count).reshape(-1, 3)
    assert drawn(places, color=kind([255, 0, 0])).spheres.color.tolist() == [255, 0, 0]
    assert drawn(places, color=kind([0.0, 0.0, 1.0])).spheres.color.tolist() == [0, 0, 255]
    with pytest.raises(
        SceneError, match=f"^add_particles: color: .*{'; for' if count == 4 else ''}"
    ):
        drawn(places, color=kind([255, 0, 0, 9]))


def test_three_numbers_are_values_where_there_is_a_colour_map() -> None:
    for asked in ({"cmap": "viridis"}, {"clim": (0, 1)}, {"norm": "linear"}):
        assert drawn(color=[0.0, 0.5, 1.0], **asked).color_scale.low == 0
    assert drawn(WATER.with_columns(q=[0.0, 0.5, 1.0]), color="q").color_scale.high == 1
    assert drawn(color=[True, False, True], cmap="gray").color_scale.high == 1
    with pytest.raises(SceneError, match=r"got -0.8 in .*; for values, give a colour map too, for"):
        drawn(color=[-0.8, 0.4, 0.4])


@pytest.mark.parametrize(
    "values",
    [
        [0, 1, 0, 1, 2],
        [0.5, 1.0, 0.5, 2.0, 2.0],
        [0, 1, 0, 1, 200],
        [True, False, True, False, True],
        [b"u", b"v", b"u", b"x", b"v"],
        np.array([1, 2, None, 1, 1], object),
        np.array([1, 2, 2, 1, 1], object),
        pd.Categorical(list("uvuxv")),
        pl.Series(list("uvuxv")),
    ],
    ids=repr,
)
@pytest.mark.parametrize("options", [{}, {"cmap": "magma"}, {"categories": ["v", "u", 1]}])
def test_arrays_have_the_colours_of_columns(values: Any, options: dict[str, Any]) -> None:
    places = np.arange(15.0).reshape(5, 3)

    def told(color: Any) -> Any:
        try:
            found = drawn(Particles(places, {"c": values}), color=color, **options)
        except SceneError as error:
            return str(error).replace("column 'c'", "the array").replace('column "c"', "the array")
        return found.legend, found.color_scale, found.categories, found.spheres.color.tolist()

    assert told(values) == told("c")


def test_names_of_colours_in_arrays_are_colours() -> None:
    places = np.arange(9.0).reshape(3, 3)
    red_and_blue = [[255, 0, 0], [0, 0, 255], [255, 0, 0]]
    for given in (
        ["red", "#00f", "r"],
        ["red", (0, 0, 255), "r"],
        [vtray.Color(*row) for row in red_and_blue],
        pd.Series([tuple(row) for row in red_and_blue]),
        pl.Series(red_and_blue),
    ):
        assert drawn(places, color=given).spheres.color.tolist() == red_and_blue
    for given in (["w", "u", "v"], pd.Categorical(["w", "u", "v"])):
        words = r"^add_particles: color\[1\]: .* got 'u'; to colour by names, .*=\['w', \.\.\.\]$"
        with pytest.raises(SceneError, match=words):
            drawn(places, color=given)
        assert len(drawn(places, color=given, categories=["u", "v"]).legend) == 3


def test_a_column_of_colours_has_no_other_names() -> None:
    def of(*names: str) -> Any:
        return Particles(np.arange(3.0 * len(names)).reshape(-1, 3), {"color": np.array(names)})

    assert drawn(of("red", "#00f")).spheres.color.tolist() == [[255, 0, 0], [0, 0, 255]]
    assert [name for name, _ in drawn(of("warm", "cold")).legend] == ["cold", "warm"]
    for wrong, hint in {"bleu": '; did you mean "blue"?', "": ""}.items():
        words = re.escape("add_particles: color[3]: expected a name such as")
        for options in ({}, {"select": "index == 3"}):
            with pytest.raises(SceneError, match=f"^{words}.*{re.escape(hint)}$"):
                drawn(of("red", "blue", "red", wrong), **options)


def test_some_are_drawn_and_some_highlighted() -> None:
    found = drawn(select="element == 'H'", color="residue", bonds=True)
    assert found.indices.tolist() == [1, 2]
    assert len(found.spheres) == 2
    assert len(found.bonds) == 0
    # A category keeps its colour, whatever is drawn.
    assert drawn(select=[False, False, True], color="residue").legend[0][1] == (230, 159, 0)
    pale = drawn(highlight="x > 0", color="black", background=(100, 100, 100))
    assert pale.spheres.color.tolist() == [[80] * 3, [0] * 3, [80] * 3]
    near = drawn(highlight="x > 0", color="black", background=np.array([1.0, 1.0, 1.0]))
    assert near.spheres.color.tolist() == [[204] * 3, [0] * 3, [204] * 3]


FOUR_SITES = Particles(
    [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0), (0, 0.15, 0)],
    {"element": [*"OHHX"], "name": ["OW", "HW1", "HW2", "MW"], "charge": [0, 0.5, 0.5, -1.0]},
    bonds=[(0, 1), (0, 2), (0, 3)],
)


@pytest.mark.parametrize("style", ["spacefill", "ball-and-stick", "licorice"])
def test_sites_beside_atoms_are_not_drawn(style: str) -> None:
    found = drawn(FOUR_SITES, style=style, bonds=None if style == "spacefill" else "file")
    assert found.indices.tolist() == [0, 1, 2]
    assert [name for name, _ in found.legend] == ["H", "O"]
    assert found.bonds is None or set(found.bonds.end[:, 0]) == {0.76, -0.76}
    alone = drawn(FOUR_SITES.with_columns(name=[*"abcd"]), style=style)
    assert alone.indices.tolist() == [0, 1, 2, 3]


def test_sites_are_drawn_where_nothing_else_is_chosen() -> None:
    assert drawn(FOUR_SITES, select="charge < -0.5").indices.tolist() == [3]
    assert drawn(FOUR_SITES, select="charge != 0.5").indices.tolist() == [0]
    assert drawn(FOUR_SITES, select="charge > 5").indices.tolist() == []


def test_categories_in_their_order() -> None:
    kinds = Particles(np.zeros((3, 3)), {"kind": ["b", "c", "b"], "number": [7, 70, 7]})
    found = drawn(kinds, color="kind", categories=["c", "a", "b"])
    assert [name for name, _ in found.legend] == ["c", "a", "b"]
    assert found.spheres.color[1].tolist() == [0, 114, 178]
    assert found.spheres.color[0].tolist() == [0, 158, 115]
    # What is not among them has a colour of its own, wherever it is met.
    other = drawn(kinds, color="kind", categories=["a"])
    alone = drawn(kinds.select([1]), color="kind", categories=["a"])
    assert other.legend[0] == ("a", (0, 114, 178))
    assert other.spheres.color[1].tolist() == alone.spheres.color[0].tolist() != [0, 114, 178]
    assert [name for name, _ in other.legend] == ["a", "b", "c"]
    assert drawn(kinds, color="number", categories=[70, 7]).categories == [70, 7]
    assert drawn(kinds, color="number", categories=range(9)).color_scale is None
    assert drawn(kinds, color="number", categories=[7], cmap="viridis").color_scale.high == 70


def test_each_of_many_categories_has_a_color_of_its_own() -> None:
    names = [f"residue {k:02}" for k in range(25)]
    many = Particles(np.zeros((25, 3)), {"kind": names})
    for count in (8, 9, 24):
        some = many.select(range(count))
        colors = drawn(some, color="kind").spheres.color
        assert len(np.unique(colors, axis=0)) == count
        assert colors[:8].tolist() == [list(vtray.colors.to_rgb(color)) for color in PALETTE]
        found = drawn(many, color="kind", categories=names[:count])
        assert found.spheres.color[:count].tolist() == colors.tolist()
        assert [color for _, color in found.legend[:count]] == list(map(tuple, colors.tolist()))
        # One that is not known has none of theirs, while there are others.
        assert (tuple(found.spheres.color[24]) in map(tuple, colors)) == (count == 24)
    assert len(np.unique(drawn(many, color="kind").spheres.color, axis=0)) == 24


def test_objects_remember_particles_until_they_are_saved() -> None:
    scene = vtray.Scene()
    found = scene.add_particles(WATER, bonds=True, select="x >= 0")
    assert found.spheres.__dict__["made_of_"].indices.tolist() == [0, 1]
    assert found.spheres == vtray.Spheres(
        found.spheres.center, found.spheres.radius, found.spheres.color
    )


def test_particles_shine() -> None:
    scene = vtray.Scene()
    boxed = Particles([(1, 1, 1), (2, 1, 1)], {"mass": [1.0, 3.0]}, cell=np.eye(3) * 4)
    found = scene.add_particles(boxed, emission="mass", replicate=(2, 1, 1), select="x > 1")
    assert (found.style, len(found.spheres), found.cell) == ("points", 0, None)
    assert scene.objects == [found.stars]
    assert found.stars.center.tolist() == [[2, 1, 1], [6, 1, 1]]
    assert found.stars.emission.tolist() == [3, 3]
    assert found.stars.color.tolist() == [255, 255, 255]
    charged = WATER.with_columns(light=[1.0, 2.0, 3.0])
    colored = drawn(charged, emission="light", color="charge", highlight="index == 0")
    assert colored.stars.color_scale.high == 0.4
    assert colored.stars.color[1].tolist() == (colored.color_scale.colors([0.4])[0] // 5).tolist()


OUTSIDE = [(x, -3.0, 1.0) for x in range(7)]


def test_a_cell_beside_its_particles_is_not_drawn() -> None:
    away = Particles([*OUTSIDE, (1, 1, 1)], cell=np.eye(3) * 8)
    words = r"^cell: not drawn, .* a quarter of the particles; wrap=True \(--wrap\) brings"
    with pytest.warns(UserWarning, match=words) as found:
        assert drawn(away).cell is None
    assert len(found) == 1
    with pytest.warns(UserWarning, match="cell: not drawn") as found:
        vtray.Scene().add_particles(away, replicate=(2, 1, 1))
    assert found[0].filename == __file__
    # What is asked for, or brought in, needs no words.
    assert drawn(away, cell=True).cell is not None
    assert drawn(away, cell=False).cell is None
    assert drawn(away, wrap=True).cell is not None
    assert drawn(away, emission=1.0).cell is None


@pytest.mark.parametrize(
    ("positions", "cell"),
    [
        ([*OUTSIDE[:3], (1, 1, 1)], np.eye(3) * 8),
        ([(0, 0, -1e-4), (8, 8, 0), (8, 0, 8.004)], np.eye(3) * 8),
        ([(1, 1, 50), (1, 1, -50)], np.diag([8.0, 8, 0])),
        (np.zeros((0, 3)), np.eye(3) * 8),
    ],
)
def test_a_cell_with_its_particles_is_drawn(positions: Any, cell: Any) -> None:
    assert drawn(Particles(positions, cell=cell)).cell is not None


def test_cell_is_drawn_where_there_is_one() -> None:
    boxed = Particles([(1, 1, 1)], cell=np.eye(3) * 4)
    edges, corners = drawn(boxed).cell
    assert (len(edges), len(corners)) == (12, 8)
    assert edges.radius == corners.radius == pytest.approx(0.014)
    assert drawn(boxed, cell=False).cell is None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"style": "ball"},
            'style: expected "spacefill", "ball-and-stick", "licorice" or "points"',
        ),
        ({"scale": 0}, "scale: expected a number from 1e-20 to 1e20, got 0"),
        ({"scale": 1e200}, "scale: expected a number from 1e-20 to 1e20, got 1e+200"),
        ({"bonds": True, "bond_radius": 0}, "bond_radius: expected a number > 0, got 0"),
        ({"color": "chrage"}, "expected a colour or the name of a column, got 'chrage'; did you"),
        ({"color": "name", "cmap": "viridis"}, "holds names, which no colour map is for"),
        ({"color": "red", "cmap": "viridis", "clim": (0, 1)}, "leave cmap and clim out"),
        ({"color": "element", "norm": "log"}, "holds names, which no colour map is for"),
        ({"stretch": "log"}, "stretch: is for points that shine; give emission, or leave it out"),
        ({"peak": 2.0, "style": "points"}, "peak: is for points that shine; give emission"),
        ({"colors": "rasmol"}, 'colors: expected "jmol" or "cpk"'),
        ({"color": "charge", "norm": "sqrt"}, 'norm: expected "linear", "log" or "centered"'),
        ({"color": "charge", "norm": "log", "clim": (0, 1)}, "expected numbers above 0"),
        ({"color": [1.0, 2.0]}, "add_particles: color"),
        ({"emission": "chrage"}, "emission: expected a number or the name of a column, got"),
        ({"style": "points", "radii": 0.7}, "radii: points have none, as they are as large as pix"),
        ({"emission": 1.0, "style": "licorice"}, 'style: expected "points" with emission'),
        ({"emission": 1.0, "cmap": "magma"}, "cmap: is for the column that color names"),
        ({"emission": 1.0, "radii": 2.0}, "radii: points that shine have none; leave out"),
        ({"emission": [1.0, 2.0]}, "add_particles: emission: expected a number or an array of"),
        ({"emission": 1.0, "stretch": "root"}, "add_particles: stretch: expected"),
        ({"select": [True]}, "select: expected an expression, or an array of 3 bool"),
        ({"select": "x >"}, "select"),
        ({"replicate": (2, 1, 1)}, "replicate: there is no cell that repeats"),
        ({"highlight": "heat > 1"}, "highlight 'heat > 1': at 1: no column 'heat'"),
        ({"bonds": [(0, 3)]}, r"bonds[0]: expected indices from 0 to 2, got [0, 3]"),
        ({"bonds": "yes"}, "bonds: expected indices of shape (m, 2), got 'yes'"),
        ({"radii": "size"}, "radii: expected covalent, vdw, a number, or a column"),
        ({"radii": [1, -2, 1]}, "radii[1]: expected a number ≥ 0, got -2.0"),
        ({"style": ["ball"]}, 'style: expected "spacefill", "ball-and-stick", "licorice" or "po'),
        ({"emission": 1.0, "style": np.arange(2)}, 'style: expected "points" with emission'),
        ({"colors": np.array(["jmol", "cpk"])}, 'colors: expected "jmol" or "cpk", got array('),
        ({"categories": 3}, "categories: expected a list of names or integers, got 3"),
        ({"categories": "OH"}, "categories: expected a list of names or integers, got 'OH'"),
        ({"stretch": np.arange(2)}, "stretch: is for points that shine; give emission"),
        ({"cell": "off"}, "cell: expected True or False, got 'off'"),
        ({"cell": np.arange(2)}, "cell: expected True or False, got array([0, 1])"),
        ({"wrap": "no"}, "wrap: expected True or False, got 'no'"),
        ({"unwrap": 1}, "unwrap: expected True or False, got 1"),
        ({"camera": 5}, "add_particles: camera: expected Camera, got 5"),
    ],
)
def test_wrong_arguments(options: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=re.escape(message)):
        drawn(**options)


def test_categories_may_be_an_array() -> None:
    names = ["H", "O", "N"]
    legend = drawn(categories=names).legend
    for given in (np.array(names), tuple(names), iter(names)):
        assert drawn(categories=given).legend == legend


@pytest.mark.parametrize("length", [1e308, 2**64])
def test_bonds_in_a_cell_are_never_too_long_to_say_so(length: float) -> None:
    boxed = Particles([(0, 0, 0), (1, 0, 0)], cell=(4, 4, 4))
    with pytest.raises(SceneError, match="^bonds: there are more than 64 bonds for each particle"):
        drawn(boxed, bonds=length)


@pytest.mark.parametrize(
    "given", [0.5 + 0j, np.full(3, 0.5 + 1j), ["0.5"] * 3, b"0.5", "when", [None, "x", 0.5]]
)
def test_opacities_are_real_numbers(given: Any) -> None:
    days = np.array([0, 1, 1], "M8[D]")
    particles = Particles(np.eye(3), {"when": days, "share": np.array([1, 0, 1])})
    with pytest.raises(SceneError, match="^opacity: expected a number from 0 to 1, one for each"):
        vtray.Scene().add_particles(particles, opacity=given)
    for right in ("share", [True, False, True], np.float32(0.5), 1):
        vtray.Scene().add_particles(particles, opacity=right)


def test_what_has_no_values_has_no_colour_map() -> None:
    with pytest.raises(SceneError, match='clim: is for values; give color, such as color="x"'):
        drawn(np.zeros((2, 3)), clim=(0, 1))


def test_logarithms_are_exact_enough() -> None:
    values = np.concatenate([np.geomspace(1e-300, 1e300, 999), [1.0, 0.5, 2.0, np.nextafter(1, 2)]])
    found = logarithm(values)
    assert np.allclose(found, np.log(values), rtol=2**-50, atol=0)
    special = logarithm(np.array([0.0, -1.0, np.nan, np.inf]))
    assert np.isnan(special[:3]).all()
    assert special[3] == np.inf


def test_color_scale_by_logarithms() -> None:
    scale = drawn(np.zeros((4, 3)), color=[0.0, 1.0, 10.0, 100.0], norm="log").color_scale
    assert (scale.low, scale.high, scale.norm) == (1.0, 100.0, "log")
    colors = scale.colors([1.0, 10.0, 100.0, 0.0])
    table = scale.table[[0, 128, 255]].tolist()
    assert colors.tolist() == [*table, list(scale.nan_color)]
    assert repr(scale).endswith(", norm='log')")
    assert copy.deepcopy(scale) == scale
    assert scale != vtray.ColorScale("viridis", 1.0, 100.0)


@pytest.mark.parametrize("options", [{"bonds": True}, {"style": "licorice"}])
def test_bonds_without_elements(options: dict[str, Any]) -> None:
    with pytest.raises(
        SceneError, match=r"no column element; give a length, as bonds=2.5 or --cut"
    ):
        vtray.Scene().add_particles([(0, 0, 0)], **options)
    assert vtray.Scene().add_particles(np.zeros((0, 3)), **options).spheres.center.size == 0


def many(**columns: Any) -> Particles:
    """Return twelve particles in a row."""
    return Particles([(k, 0, 0) for k in range(12)], columns)


def test_types_are_categories_however_many_there_are() -> None:
    types = many(type=np.arange(12), count=np.arange(12))
    legend = drawn(types).legend
    assert [name for name, _ in legend] == [str(k) for k in range(12)]
    assert drawn(types, color="count").legend == []


def test_legends_sort_as_people_do_and_name_what_has_no_name() -> None:
    names = [f"c{k}" for k in range(11)] + [""]
    legend = drawn(many(kind=np.array(names)), color="kind").legend
    assert [name for name, _ in legend] == ["(none)", *names[:-1]]


def test_colors_may_be_worked_out() -> None:
    force = np.random.default_rng(1).normal(size=(12, 3))
    found = many(force=force)
    for text, values in {
        "force.x": force[:, 0],
        "force[1] + 2": force[:, 1] + 2,
        "norm(force)": np.sqrt((force**2).sum(axis=1)),
    }.items():
        np.testing.assert_array_equal(
            drawn(found, color=text).spheres.color, drawn(found, color=values).spheres.color
        )
    assert [name for name, _ in drawn(found, color="force.x > 0").legend] == ["False", "True"]
    for text, values in {
        "index": np.arange(12.0),
        "x%2": found["x"] % 2,
        "x - y": found["x"] - found["y"],
        "-x": -found["x"],
    }.items():
        scale = drawn(found, color=text, cmap="viridis").color_scale
        assert (scale.low, scale.high) == (values.min(), values.max())
    for text in ("(x > 3) & (y < 1)", "x>3 or y>0", "not (x > 3)", "~(x>3)"):
        assert [name for name, _ in drawn(found, color=text).legend] == ["False", "True"]
    for text, problem in {
        "x or y": "at 1: 'x' is neither true nor false; put comparisons in brackets",
        "position": "at 1: a vector; expected a component, or norm(position)",
        "light-bleu": "at 1: no column 'light'; there are x, y, z, position, index, force",
    }.items():
        words = f"color {text!r}: {problem}"
        with pytest.raises(SceneError, match=f"^{re.escape(words)}.*nor is it a colour or a col"):
            drawn(found, color=text)
    for text in ("5", "0.5", "'red'", "light bleu", "1,0,0"):
        with pytest.raises(SceneError, match="^color: expected a colour or the name of a column"):
            drawn(found, color=text)
    with pytest.raises(SceneError, match=r"color 'forc.x': at 1: no column 'forc'; did you mean"):
        drawn(found, color="forc.x")
    with pytest.raises(SceneError, match="a vector; expected a component, or norm"):
        drawn(found, color="force * 2")


def test_balls_of_types_leave_room_for_their_bonds() -> None:
    chain = Particles([(1.4 * k, 0, 0) for k in range(5)], {"type": np.ones(5, int)})
    found = drawn(chain, style="ball-and-stick", bonds=1.5)
    assert found.spheres.radius == pytest.approx(0.42)
    assert found.bonds.radius == pytest.approx(0.3 * 0.42)
    across = Particles(
        chain.positions[[0, 4]],
        {"type": [1, 1]},
        bonds=[(0, 1)],
        cell=np.diag([7.0, 9, 9]),
    )
    assert drawn(across, bonds=True).spheres.radius == pytest.approx(0.42)


def test_what_rounding_puts_before_a_cell_stays_there() -> None:
    found = Particles([(-1e-16, 0, 0), (6.5, 0, 0), (-0.1, 0, 0)], cell=6 * np.eye(3))
    places = drawn(found, wrap=True).spheres.center[:, 0]
    np.testing.assert_allclose(places, [0, 0.5, 5.9], atol=1e-12)


def test_lengths_of_a_cell_are_its_edges() -> None:
    found = Particles([(0, 0, 0)], cell=[1, 2, 3])
    np.testing.assert_array_equal(found.cell, np.diag([1.0, 2, 3]))


def test_rows_are_no_columns() -> None:
    with pytest.raises(SceneError, match="expected the name of a column, got slice"):
        WATER[:2]  # type: ignore[index]
    with pytest.raises(SceneError, match="rename them, as in table.rename"):
        drawn({"px": [0.0], "py": [0.0], "pz": [0.0]})


def test_light_may_be_a_column_by_the_name_of_the_file() -> None:
    particles = vtray.Particles(np.eye(3), columns={"charge": np.array([1.0, 2.0, 3.0])})
    one, other = vtray.Scene(), vtray.Scene()
    one.add_particles(particles, emission="q")
    other.add_particles(particles, emission="charge")
    assert np.array_equal(one.objects[0].emission, other.objects[0].emission)


def test_dates_are_names() -> None:
    days = np.array(["2020-01-01", "2021-01-01", "2020-01-01"], "datetime64[s]")
    drawn = vtray.Scene().add_particles(
        vtray.Particles(np.eye(3), columns={"when": days}), color="when"
    )
    assert [name for name, _ in drawn.legend] == ["2020-01-01T00:00:00", "2021-01-01T00:00:00"]


@pytest.mark.parametrize("length", [0, -1, float("inf")])
def test_lengths_of_bonds_that_cannot_be(length: float) -> None:
    with pytest.raises(SceneError, match=r"bonds: expected a length > 0, got"):
        vtray.Scene().add_particles(np.eye(3), bonds=length)
