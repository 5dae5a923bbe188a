"""Copies of objects made in code."""

import copy
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from test_cylinders import POINTS
from test_cylinders import columns as columns_of_cylinders
from test_spheres import CAMERA, COUNT, INF, NAN, OnlyArray, OnlyDLPack, columns

import vtray
from vtray import (
    Cone,
    Cones,
    Copies,
    Cylinder,
    Cylinders,
    Plane,
    Scene,
    SceneError,
    Sphere,
    Spheres,
)
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.arrays import check_spares_data
from vtray.scene.copies import PARTS
from vtray.scene.edits import recolored
from vtray.scene.fingerprint import scene_hash

BALL = Sphere((0, 0, 5), 1)
STICK = Cylinder((0, 0, 0), (0, 0, 1), 0.5)
HAT = Cone((0, 0, 0), (0, 0, 1), 0.5)
AT = np.arange(12.0).reshape(4, 3)


def all_kinds() -> list[Any]:
    """Return objects of all kinds that can be placed."""
    cones = Cones([(0, 0, 0)], [(0, 0, 1)], 0.5)
    return [Spheres(**columns()), BALL, Cylinders(**columns_of_cylinders()), STICK, cones, HAT]


def test_all_kinds_can_be_placed() -> None:
    assert {type(item) for item in all_kinds()} == set(PARTS)
    assert [item for item in PARTS if not hasattr(item, "hull")] == []
    copies = Copies(all_kinds(), AT)
    assert copies.objects == tuple(all_kinds())
    assert isinstance(copies, ArrayHolder)
    assert len(copies) == 4


def test_one_object_needs_no_list() -> None:
    assert Copies(BALL, AT) == Copies([BALL], AT) == Copies((BALL,), at=AT.tolist())
    none = Copies(Spheres([], 1), [])
    assert (none.at.shape, len(none)) == ((0, 3), 0)


@pytest.mark.parametrize("wrap", [np.asarray, OnlyDLPack, OnlyArray, np.asfortranarray])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_places_are_shared_and_read_only(wrap: Any, dtype: Any) -> None:
    given = AT.astype(dtype, order="F" if wrap is np.asfortranarray else "C")
    copies = Copies(BALL, wrap(given))
    assert (copies.at.dtype, np.shares_memory(copies.at, given)) == (dtype, True)
    assert np.array_equal(copies.at, AT)
    with pytest.raises(ValueError, match="read-only"):
        copies.at[:] = 0
    assert Copies(BALL, given.astype("i4")).at.dtype == np.float64


def test_equality_is_that_of_objects_and_places() -> None:
    copies = Copies(all_kinds(), AT)
    assert copies == Copies(all_kinds(), AT.astype("f4"))
    assert (copies != Copies(all_kinds(), AT)) is False
    assert copies != Copies(all_kinds()[:3], AT)
    assert copies != Copies(all_kinds()[::-1], AT)
    assert copies != Copies(all_kinds(), AT[1:])
    assert copies != Copies(all_kinds(), AT + 1)
    assert copies != "copies"
    with pytest.raises(TypeError, match="unhashable"):
        hash(copies)


def test_pickle_and_copies() -> None:
    copies = Copies(all_kinds(), AT)
    for copied in (pickle.loads(pickle.dumps(copies)), copy.copy(copies), copy.deepcopy(copies)):
        assert copied == copies
        assert not copied.at.flags.writeable
    assert not np.shares_memory(copy.deepcopy(copies).at, AT)


def test_repr_is_short() -> None:
    assert repr(Copies(BALL, AT)) == f"Copies(objects=({BALL!r},), at=<float64 (4, 3)>)"
    shown = ", ".join([repr(BALL)] * 4)
    assert repr(Copies([BALL] * 4, AT)) == f"Copies(objects=({shown}), at=<float64 (4, 3)>)"
    assert repr(Copies([BALL] * 9, AT)) == f"Copies(objects=({shown}, ...), at=<float64 (4, 3)>)"


def test_they_do_not_change() -> None:
    copies = Copies(BALL, AT)
    assert copies.replace(at=AT[:2]) == Copies(BALL, AT[:2])
    with pytest.raises(AttributeError, match=r"Copies.at: cannot be changed; make a new one"):
        copies.at = AT  # type: ignore[misc]
    with pytest.raises(TypeError, match="lacks the arguments at"):
        Copies(BALL)  # type: ignore[call-arg]


KINDS = "expected Sphere, Cylinder, Cone, Spheres, Cylinders or Cones"
FAR = "expected a number whose sums with all coordinates of the objects are doubles, up to 1.8e308"
NEARER = "move the objects, or their places, nearer to the origin"
FLOOR = Plane((0, 0, 0), (0, 0, 1))
BAD: list[tuple[Any, Any, str]] = [
    ([], AT, "objects: expected at least one object, got none"),
    (3, AT, f"objects: {KINDS}, or a list of such, got 3"),
    ({"a": BALL}, AT, f"objects: {KINDS}, or a list of such, got {{'a'"),
    ([BALL, None], AT, f"objects[1]: {KINDS}, got None"),
    ([BALL, FLOOR], AT, f"objects[1]: {KINDS}, got Plane("),
    (FLOOR, AT, f"objects: {KINDS}, or a list of such, got Plane("),
    ([Copies(BALL, AT)], AT, f"objects[0]: {KINDS}, got Copies("),
    (BALL, (1, 2, 3), f"at: {POINTS} shape (3,)"),
    (BALL, AT.T, f"at: {POINTS} shape (3, 4) (transpose it)"),
    (BALL, None, f"at: {POINTS} None"),
    (BALL, [(0, 0, 0), (0, NAN, 0)], "at[1, 1]: expected a finite number, got nan"),
    (BALL, np.full((2, 3), -INF, "f4"), "at[0, 0]: expected a finite number, got -inf"),
    (
        [BALL, Sphere((0, -1e308, 0), 1)],
        [(0, 1e308, 0), (0, -1e308, 0)],
        f"at[1, 1]: {FAR}, got -1e+308 for -1e+308; {NEARER}",
    ),
    (
        [BALL, Cylinder((0, 0, 0), (0, 0, 1.5e308), 1)],
        [(0, 0, 0), (0, 1e308, 1e308)],
        f"at[1, 2]: {FAR}, got 1e+308 for 1.5e+308; {NEARER}",
    ),
    (
        Spheres([(1e308, 0, 0), (0, 0, 0)], 1),
        [(1e308, 0, 0)],
        f"at[0, 0]: {FAR}, got 1e+308 for 1e+308; {NEARER}",
    ),
]


@pytest.mark.parametrize(("objects", "at", "message"), BAD, ids=range(len(BAD)))
def test_bad_copies(objects: Any, at: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Copies(objects, at)
    assert str(caught.value).startswith(f"Copies.{message}")
    scene = Scene()
    with pytest.raises(SceneError) as caught:
        scene.add_copies(objects, at)
    assert str(caught.value).startswith(f"add_copies: {message}")
    assert scene.objects == []


@pytest.mark.parametrize(
    ("wrong", "remedy"),
    [
        (FLOOR, "a plane has no edge: add it to the scene itself"),
        (Copies(BALL, AT), "place its objects themselves, at the sums of both translations"),
    ],
)
def test_what_to_do_with_others(wrong: Any, remedy: str) -> None:
    for objects in (wrong, [wrong]):
        with pytest.raises(SceneError, match=remedy):
            Copies(objects, AT)


def test_the_sums_that_the_remedy_names_are_copies_of_copies() -> None:
    at, other = AT, Copies(BALL, AT[:2])
    sums = (at[:, None] + other.at).reshape(-1, 3)
    assert len(Copies(other.objects, sums)) == 8


HUGE = st.sampled_from([0.0, 1.0, -9e307, 9e307, 1.7e308, -1.7e308])


@given(*[arrays_of.arrays("f8", st.tuples(st.integers(0, 3), st.just(3)), elements=HUGE)] * 2)
def test_all_sums_are_doubles_or_it_is_an_error(points: np.ndarray, at: np.ndarray) -> None:
    with np.errstate(over="ignore"):
        sums = points[:, None] + at
    try:
        Copies([Spheres(points, 1), Cylinders(points / 2, points / 4, 1)], at)
    except SceneError as problem:
        assert FAR in str(problem)
        assert not np.isfinite(sums).all()
    else:
        assert np.isfinite(sums).all()


def test_scene_looks_again_at_arrays_within() -> None:
    radius, at = np.ones(COUNT), AT.copy()
    copies = Copies([BALL, Spheres(**columns(radius=radius))], at)
    scene = Scene(CAMERA, [], [BALL, copies])
    scene.check()
    radius[3] = -1
    place = r"Scene.objects\[1\]"
    with pytest.raises(SceneError, match=rf"^{place}.objects\[1\].radius\[3\]: expected a number"):
        scene.check()
    with pytest.raises(SceneError, match=r"^Copies.objects\[1\].radius\[3\]: expected a number ≥"):
        copies.check()
    radius[3] = 1
    at[2, 1] = NAN
    with pytest.raises(SceneError, match=rf"^{place}.at\[2, 1\]: expected a finite number"):
        scene.check()
    at[2, 1] = 0
    copies.check()
    huge = np.full((1, 3), 1e308)
    copies = Copies(Spheres(np.zeros((1, 3)), 1), huge)
    huge *= 1.5
    copies.check()
    copies = Copies(Spheres(centers := np.zeros((1, 3)), 1), huge)
    centers += 1e308
    with pytest.raises(SceneError, match=r"^Copies.at\[0, 0\]: expected a number whose sums"):
        copies.check()


def test_they_are_added_to_a_scene() -> None:
    scene = Scene()
    added = scene.add_copies(all_kinds(), at=AT)
    assert scene.objects == [added] == [Copies(all_kinds(), AT)]
    assert np.shares_memory(added.at, AT)
    assert vtray.scene.scene.Copies is vtray.Copies is Copies  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match=r"add_copies\(\) argument 'place' is unknown"):
        scene.add_copies(BALL, place=AT)  # type: ignore[call-arg]


def test_the_hash_tells_all_that_they_hold() -> None:
    spheres, cylinders = Spheres(**columns()), Cylinders(**columns_of_cylinders())
    moved = AT.copy()
    moved[3, 2] = np.nextafter(moved[3, 2], 99)
    lists: list[list[Any]] = [
        [Copies([spheres, BALL], AT)],
        [Copies([BALL, spheres], AT)],
        [Copies([spheres, BALL], AT[:3])],
        [Copies([spheres, BALL], moved)],
        [Copies([spheres, BALL, BALL], AT)],
        [Copies([spheres, STICK], AT)],
        [Copies([Spheres(**columns(radius=2)), BALL], AT)],
        [Copies([cylinders, BALL], AT)],
        [Copies(spheres, AT), BALL],
        [spheres, Copies(BALL, AT)],
        [spheres, BALL],
    ]
    hashes = [scene_hash(Scene(CAMERA, [], objects)) for objects in lists]
    assert len(set(hashes)) == len(lists)
    again = Scene(CAMERA, [], [Copies([Spheres(**columns()), BALL], AT)])
    assert scene_hash(again, threads=1) == hashes[0]


def test_all_arrays_of_copies() -> None:
    spheres = Spheres(**columns(radius=2))
    found = Copies([BALL, spheres], AT).arrays()
    assert np.shares_memory(found[0], AT)
    assert [array.shape for array in found[1:]] == [(COUNT, 3), (), (COUNT, 3), (COUNT,)]
    assert found[2] == 2


def test_files_of_all_arrays_are_spared(tmp_path: Path) -> None:
    inner, outer = tmp_path / "inner.npz", tmp_path / "outer.npy"
    for path in (inner, outer):
        path.touch()
    spheres = Spheres(**columns()).read_from(inner)
    copies = Copies([BALL, spheres], AT).read_from(outer)
    assert copies.sources() == [outer, inner]
    for path in (inner, outer):
        with pytest.raises(vtray.OutputError, match=f"{path.name}: holds arrays of the scene"):
            check_spares_data(path, [BALL, copies])
    check_spares_data(tmp_path / "other.npz", [BALL, copies])


# ---- other colours

RED, BLUE, GREEN = (255, 0, 0), (0, 0, 255), (0, 128, 0)
VALUES = np.linspace(0, 1, COUNT)
SPHERES, CYLINDERS = Spheres(**columns()), Cylinders(**columns_of_cylinders(color_end=None))


def recolor(objects: Any, color: Any, **options: Any) -> tuple[Any, ...]:
    """Return the objects of copies in other colours."""
    scene = Scene(None, [], [BALL, Copies(objects, AT)])
    ball, copies = recolored(scene, 1, color, **options).objects
    assert ball == BALL
    assert isinstance(copies, Copies)
    assert np.shares_memory(copies.at, AT)
    return copies.objects


def test_a_single_object_is_recolored_as_if_it_stood_alone() -> None:
    (found,) = recolor(SPHERES, VALUES, cmap="viridis")
    assert found.color_scale == vtray.ColorScale("viridis", 0, 1)
    assert np.shares_memory(found.center, SPHERES.center)
    (found,) = recolor(CYLINDERS, "red", color_end=["blue"] * COUNT)
    assert found == CYLINDERS.replace(color=RED, color_end=BLUE)
    assert recolor(BALL, "red") == (BALL.replace(color=RED),)


@pytest.mark.parametrize("color", ["red", RED, np.array(RED), [1.0, 0.0, 0.0], vtray.Color(*RED)])
def test_one_color_is_that_of_all_objects(color: Any) -> None:
    objects = (SPHERES, BALL, STICK)
    expected = tuple(item.replace(color=RED) for item in objects)  # type: ignore[attr-defined]
    assert recolor(objects, color) == expected


def test_each_object_has_its_color() -> None:
    objects = (SPHERES, BALL, CYLINDERS)
    each = recolor(objects, ["red", "blue", "green"])
    assert each == (
        SPHERES.replace(color=RED),
        BALL.replace(color=BLUE),
        CYLINDERS.replace(color=GREEN),
    )
    assert recolor(objects, np.array([RED, BLUE, GREEN])) == each
    assert recolor(objects, [["red"] * COUNT, BLUE, "green"]) == each
    two = CYLINDERS.replace(color=GREEN, color_end=RED)
    for color_end in ("red", [None, None, "red"], RED):
        assert recolor(objects, ["red", "blue", "green"], color_end=color_end) == (*each[:2], two)
    spheres, bonds = recolor([SPHERES, CYLINDERS], [VALUES, -VALUES], cmap="viridis", clim=(-1, 1))
    scale = vtray.ColorScale("viridis", -1, 1)
    assert spheres.color_scale == bonds.color_scale == scale
    assert bonds.color.tolist() == scale.colors(-VALUES).tolist()


@pytest.mark.parametrize(
    ("objects", "color", "options", "message"),
    [
        (
            [BALL, STICK],
            ["red"],
            {},
            "color: expected one colour, or a list of 2, one for each object of the copies, got 1",
        ),
        (
            [BALL, STICK],
            5,
            {},
            "color: expected one colour, or a list of 2, one for each object of the copies, got 5",
        ),
        ([BALL, STICK], ["red", "rde"], {}, "objects[1]: color: expected a name such as"),
        (
            [BALL, SPHERES],
            ["red", ["red"]],
            {},
            "objects[1]: color: expected one colour, or 5, one",
        ),
        (
            [BALL, STICK],
            "red",
            {"color_end": "red"},
            "color_end: expected None, as only Cylinders and Cones have two colours, got 'red'",
        ),
        (
            [CYLINDERS, STICK],
            "red",
            {"color_end": ["red", "blue"]},
            "objects[1]: color_end: expected None, as only Cylinders and Cones have two colours, "
            "got 'blue'",
        ),
        (
            [SPHERES, CYLINDERS],
            [VALUES, VALUES],
            {"cmap": "viridis"},
            "clim: expected the limits (low, high) that all objects of the copies share, got None",
        ),
        (SPHERES, ["red"], {}, "color: expected one colour, or 5, one for each position, got 1"),
    ],
)
def test_bad_colors(objects: Any, color: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        recolor(objects, color, **options)
    assert str(caught.value).startswith(f"recolor: {message}")
