"""Particles on the boundary of a cell, shown on its far faces, too."""

from itertools import product
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.base.errors import SceneError
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.particles import drawing
from vtray.scene.particles.bonds import find_bonds
from vtray.scene.particles.made_of import made_of
from vtray.scene.particles.particles import Particles

SKEW = np.array([[8.0, 0, 0], [5.5, 7, 0], [-4, 5, 6]])
CUBE = 4 * np.eye(3)


def drawn_of(particles: Particles, **options: Any) -> Any:
    options = {"radii": 0.3, "bonds": False, "boundary": True, "cell": False, **options}
    return vtray.Scene().add_particles(particles, **options)


def rounded(points: Any) -> list[tuple[float, ...]]:
    """Return points in order, to be compared."""
    return sorted(tuple(row) for row in (np.round(points, 6) + 0.0).tolist())


def shown(drawn: Any) -> list[tuple[float, ...]]:
    """Return the places of all balls, in order."""
    return rounded(np.concatenate([drawn.spheres.center, drawn.boundary[0].center]))


def test_corner_edge_face_and_inside() -> None:
    particles = Particles([(0, 0, 0), (2, 0, 4), (4, 2, 2), (1, 2, 3)], cell=CUBE)
    corner = list(product((0, 4), repeat=3))
    edge = [(2, 0, 0), (2, 0, 4), (2, 4, 0), (2, 4, 4)]
    assert shown(drawn_of(particles)) == rounded([*corner, *edge, (0, 2, 2), (4, 2, 2), (1, 2, 3)])


@pytest.mark.parametrize(
    "periodic", [(True, True, True), (True, False, True), (False, True, False)]
)
@pytest.mark.parametrize("times", [(1, 1, 1), (2, 1, 3)])
@pytest.mark.parametrize("tolerance", [True, 0.3])
def test_skew_cells(
    periodic: tuple[bool, bool, bool], times: tuple[int, int, int], tolerance: float
) -> None:
    times = tuple(n if on else 1 for n, on in zip(times, periodic, strict=True))  # type: ignore[assignment]
    generator = np.random.default_rng(2)
    fractions = generator.choice([0, 1e-5, 0.2, 0.5, 0.75, 0.9995, 1, 1.4], (60, 3))
    origin = np.array([1.0, -2, 3])
    particles = Particles(origin + fractions @ SKEW, cell=SKEW, origin=origin, periodic=periodic)
    drawn = drawn_of(particles, boundary=tolerance, replicate=times)
    most = 0.001 if tolerance is True else tolerance
    expected = []
    for f in fractions:
        inside = all(-most <= f[k] <= 1 + most for k in range(3) if periodic[k])
        for s in product(*(range(-1, n + 1) for n in times)):
            in_block = all(0 <= s[k] < times[k] for k in range(3))
            near = all(
                -most <= f[k] + s[k] <= times[k] + most if periodic[k] else s[k] == 0
                for k in range(3)
            )
            if in_block or (inside and near):
                expected.append(origin + (f + s) @ SKEW)
    assert len(expected) > 60 * np.prod(times)
    assert shown(drawn) == rounded(expected)


def test_wrapped_particles_are_repeated_and_others_outside_are_not() -> None:
    particles = Particles([(8, 1, 1), (5, 0, 0)], cell=CUBE)
    assert len(drawn_of(particles).boundary[0]) == 0
    expected = [(0, 1, 1), (4, 1, 1), (1, 0, 0), (1, 4, 0), (1, 0, 4), (1, 4, 4)]
    assert shown(drawn_of(particles, wrap=True)) == rounded(expected)


def test_on_a_face_is_what_is_a_thousandth_of_the_edge_away() -> None:
    near = [(1.3333, 2, 0.0039), (1, 1, -0.0039), (2, 2, 3.9961)]
    particles = Particles([*near, (1, 3, 3.9959), (3, 3, 0.0041)], cell=CUBE)
    again = drawn_of(particles).boundary[0].center
    assert rounded(again) == rounded([(1.3333, 2, 4.0039), (1, 1, 3.9961), (2, 2, -0.0039)])


def halves_of(item: Cylinders) -> list[tuple[float, ...]]:
    return rounded(np.concatenate([item.start, item.end], axis=1))


def test_bonds_join_what_is_shown_and_lead_nowhere_else() -> None:
    atoms = [(0, 2, 2), (1, 2, 2), (3, 2, 2), (2, 3.5, 2), (2, 0.5, 2)]
    particles = Particles(atoms, {"element": list("HFOCC")}, cell=CUBE)
    drawn = drawn_of(particles, bonds=1.2, style="ball-and-stick")
    assert halves_of(drawn.bonds) == rounded([(0, 2, 2, 1, 2, 2)])
    assert drawn.boundary[0].center.tolist() == [[4, 2, 2]]
    # To the first one shown again; carbons across the border, inside the cell, are not bound.
    assert halves_of(drawn.boundary[1]) == rounded([(4, 2, 2, 3, 2, 2)])
    assert (drawn.boundary[1].color == drawn.spheres.color[0]).all()
    assert (drawn.boundary[1].color_end == drawn.spheres.color[2]).all()
    source = made_of(drawn.boundary[1])
    assert source is not None
    assert (source.kind, source.indices.tolist()) == ("bond", [[0, 2]])
    assert drawn.boundary[2] is None


def standing(objects: Any, kind: str) -> list[tuple[float, ...]]:
    """Return where all cylinders of a kind are, those of copies too, in order."""
    found = []
    for item in objects:
        places = item.at if isinstance(item, Copies) else np.zeros((1, 3))
        for part in item.objects if isinstance(item, Copies) else [item]:
            source = made_of(part)
            if source is not None and source.kind == kind:
                for place in places:
                    found.extend(
                        halves_of(part.replace(start=part.start + place, end=part.end + place))
                    )
    return sorted(found)


@once
@pytest.mark.parametrize("written_out", [True, False])
@pytest.mark.parametrize("times", [(1, 1, 1), (2, 1, 3)])
@pytest.mark.parametrize("tolerance", [True, 0.35])
def test_bonds_of_skew_cells(
    written_out: bool,
    times: tuple[int, int, int],
    tolerance: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if not written_out:
        monkeypatch.setattr(drawing, "WRITTEN_OUT", 0)
    generator = np.random.default_rng(5)
    fractions = generator.choice([0, 0.1, 0.3, 0.5, 0.75, 0.9995, 1.4], (30, 3))
    fractions = np.unique(fractions, axis=0)
    particles = Particles(fractions @ SKEW, cell=SKEW)
    scene = vtray.Scene()
    scene.add_particles(
        particles, radii=0.3, bonds=3.1, boundary=tolerance, replicate=times, cell=False
    )
    bonds = find_bonds(particles, cutoff=3.1)
    most = 0.001 if tolerance is True else tolerance
    shown = {
        (k, *s)
        for k, f in enumerate(fractions)
        for s in product(*(range(-1, n + 1) for n in times))
        if all(0 <= i < n for i, n in zip(s, times, strict=True))
        or (
            all(f >= -most)
            and all(f <= 1 + most)
            and all(f + s >= -most)
            and all(f + s <= np.array(times) + most)
        )
    }
    expected = []
    for (one, two), shift in zip(bonds.pairs.tolist(), bonds.shifts, strict=True):
        for s in product(*(range(-3, n + 3) for n in times)):
            if {(one, *s), (two, *(shift + s).tolist())} <= shown:
                ends = fractions[one] + s, fractions[two] + s + shift
                expected.append(np.concatenate([end @ SKEW for end in ends]))
    assert len(expected) > 40
    assert standing(scene.objects, "bond") == rounded(expected)


def test_only_bonds_that_are_shown_are_made(monkeypatch: pytest.MonkeyPatch) -> None:
    made = []
    real = Cylinders.from_arrays.__func__  # type: ignore[attr-defined]
    monkeypatch.setattr(
        Cylinders,
        "from_arrays",
        classmethod(lambda cls, values, place: made.append(real(cls, values, place)) or made[-1]),
    )
    chain = [(0, 2, 2), *((0.5 + 0.03 * k, 2, 2) for k in range(100))]
    drawn_of(Particles(chain, cell=CUBE), bonds=0.035)
    assert max(map(len, made)) == 99


def test_hydrogen_bonds_of_repeated_particles() -> None:
    water = [(2, 0, 2), (2.76, 0.59, 2), (1.24, 0.59, 2), (2, -2.5, 2), (2, -1.55, 2)]
    cell = np.diag([8.0, 8, 8])
    particles = Particles(water, {"element": list("OHHOH")}, cell=cell)
    options: dict[str, Any] = {"bonds": True, "hydrogen_bonds": True}
    drawn = drawn_of(particles, **options)
    # The molecule outside the cell is not shown again, and nothing leads to it.
    assert (len(drawn.hydrogen_bonds), len(drawn.boundary[2])) == (6, 0)
    drawn = drawn_of(particles, wrap=True, **options)
    assert len(drawn.hydrogen_bonds) == 0
    again = drawn.boundary[2]
    ends = rounded(np.concatenate([again.start, again.end]))
    assert ends == rounded(
        [(2, 6.45 + 1.55 * k / 24, 2) for k in (1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23)]
    )
    source = made_of(again)
    assert source is not None
    assert [sorted(source.indices[:, k].tolist()) for k in (0, 1)] == [[0, 0, 0, 4, 4, 4]] * 2


def test_what_is_drawn_and_in_which_colours() -> None:
    columns = {"element": np.array(list("HFO")), "heat": np.array([0.0, 1, 2])}
    particles = Particles([(0, 2, 2), (2, 0, 2), (2, 2, 0)], columns, cell=CUBE)
    drawn = drawn_of(particles, select="element != 'F'", color="heat", cmap="viridis")
    again = drawn.boundary[0]
    assert rounded(again.center) == rounded([(4, 2, 2), (2, 2, 4)])
    order = np.argsort(made_of(again).indices)
    assert (again.color[order] == drawn.spheres.color).all()
    assert again.color_scale == drawn.spheres.color_scale
    pale = drawn_of(particles, highlight="index == 0")
    which = made_of(pale.boundary[0]).indices
    assert (pale.boundary[0].color == pale.spheres.color[which]).all()
    sizes = drawn_of(particles, radii=np.array([0.1, 0.2, 0.3]))
    assert (
        sizes.boundary[0].radius == sizes.spheres.radius[made_of(sizes.boundary[0]).indices]
    ).all()


def test_among_copies_and_as_one_body(monkeypatch: pytest.MonkeyPatch) -> None:
    particles = Particles([(0, 2, 2), (1, 2, 2)], cell=CUBE)
    options: dict[str, Any] = {"bonds": 1.2, "radii": 0.3, "cell": False, "boundary": True}
    scene = vtray.Scene()
    drawn = scene.add_particles(particles, opacity=0.5, **options)
    assert scene.objects == [drawn.copies]
    assert [len(part) for part in drawn.copies.objects] == [2, 1, 1]
    assert drawn.boundary[0].opacity == 0.5
    monkeypatch.setattr(drawing, "WRITTEN_OUT", 0)
    scene = vtray.Scene()
    drawn = scene.add_particles(particles, replicate=(1, 2, 1), **options)
    assert scene.objects == [drawn.copies, drawn.boundary[0]]
    assert drawn.boundary[0].center.tolist() == [[4, 2, 2], [4, 6, 2]]
    scene = vtray.Scene()
    assert len(scene.add_particles([(9, 9, 9)], cell=False).spheres) == 1
    inside = Particles([(2, 2, 2)], cell=CUBE)
    scene.add_particles(inside, **{**options, "bonds": False})
    assert len(scene.objects) == 2


def test_points_are_as_large_as_pixels_on_far_faces() -> None:
    scene = vtray.Scene()
    scene.camera = vtray.Camera.look_at((2, -9, 2), (2, 2, 2), up=(0, 0, 1), size=(80, 60))
    particles = Particles([(2, 0, 2)], cell=CUBE)
    near = scene.add_particles(particles, "points").spheres.radius
    both = scene.add_particles(particles, "points", boundary=True)
    assert both.boundary is not None
    assert both.boundary[0].radius.tolist() == both.spheres.radius.tolist()
    assert both.spheres.radius[0] == pytest.approx(near[0] * 13 / 9)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"boundary": 0.7}, "boundary: expected True, False, or a part of the cell's edge above 0"),
        ({"boundary": -1}, "boundary: expected True, False, or a part .* at most 0.5, got -1"),
        ({"boundary": "x"}, "boundary: expected True, False, or a part .*, got "),
        ({"emission": 1.0}, "boundary: points that shine have none; leave out it or emission"),
    ],
)
def test_wrong_arguments(options: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        vtray.Scene().add_particles(
            Particles([(0, 0, 0)], cell=CUBE), **{"boundary": True, **options}
        )


def test_a_cell_is_needed() -> None:
    for particles in ([(0, 0, 0)], Particles([(0, 0, 0)], cell=CUBE, periodic=(False,) * 3)):
        with pytest.raises(SceneError, match="boundary: there is no cell that repeats"):
            vtray.Scene().add_particles(particles, boundary=True, cell=False)
