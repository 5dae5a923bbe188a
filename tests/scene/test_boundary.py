"""Particles on the boundary of a cell, shown on its far faces, too."""

from itertools import product
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.cylinders import Cylinders
from vtray.scene.particles import drawing
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


def test_bonds_of_repeated_particles_are_halves() -> None:
    particles = Particles([(0, 2, 2), (1, 2, 2), (3, 2, 2)], {"element": list("HFO")}, cell=CUBE)
    drawn = drawn_of(particles, bonds=1.2, style="ball-and-stick")
    # The whole bond, then the halves toward the border; beyond it, those of the repeated one.
    assert halves_of(drawn.bonds) == rounded(
        [(0, 2, 2, 1, 2, 2), (0, 2, 2, -0.5, 2, 2), (3, 2, 2, 3.5, 2, 2)]
    )
    assert drawn.boundary[0].center.tolist() == [[4, 2, 2]]
    assert halves_of(drawn.boundary[1]) == rounded([(4, 2, 2, 3.5, 2, 2), (4, 2, 2, 4.5, 2, 2)])
    assert (drawn.boundary[1].color == drawn.spheres.color[0]).all()
    source = made_of(drawn.boundary[1])
    assert source is not None
    assert (source.kind, source.indices.tolist()) == ("bond", [[0, 0], [0, 0]])
    assert drawn.boundary[2] is None


def test_hydrogen_bonds_of_repeated_particles() -> None:
    water = [(2, 0, 2), (2.76, 0.59, 2), (1.24, 0.59, 2), (2, -2.5, 2), (2, -1.55, 2)]
    cell = np.diag([8.0, 8, 8])
    particles = Particles(water, {"element": list("OHHOH")}, cell=cell)
    drawn = drawn_of(particles, bonds=True, hydrogen_bonds=True)
    dashes, again = drawn.hydrogen_bonds, drawn.boundary[2]
    assert (len(dashes), len(again)) == (6, 3)
    mine = np.array([k for k, (owner, _) in enumerate(made_of(dashes).indices) if owner == 0])
    assert np.allclose(again.start, dashes.start[mine] + [0, 8, 0])


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
    assert [len(part) for part in drawn.copies.objects] == [2, 1, 1, 1]
    assert drawn.boundary[0].opacity == 0.5
    monkeypatch.setattr(drawing, "WRITTEN_OUT", 0)
    scene = vtray.Scene()
    drawn = scene.add_particles(particles, replicate=(1, 2, 1), **options)
    assert scene.objects == [drawn.copies, *drawn.boundary[:2]]
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
