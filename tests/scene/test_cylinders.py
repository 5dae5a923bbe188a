"""Cylinders, single ones and as arrays, made in code; and what all kinds of arrays share."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from test_spheres import BYTE, CAMERA, COUNT, INF, NAN, NUMERIC, OnlyArray, OnlyDLPack
from test_spheres import columns as columns_of_spheres

import vtray
from vtray import Cones, Cylinder, Cylinders, Scene, SceneError, Spheres
from vtray.scene.arrays import Arrays
from vtray.scene.edits import recolored
from vtray.scene.fingerprint import scene_hash
from vtray.scene.objects import ARRAY_KINDS

RED, BLUE, WHITE = (255, 0, 0), (0, 0, 255), (255, 255, 255)


def columns(**changed: object) -> dict[str, Any]:
    """Return arrays of five cylinders, with others in place of some."""
    return {
        "start": np.arange(3.0 * COUNT).reshape(COUNT, 3),
        "end": np.arange(3.0 * COUNT).reshape(COUNT, 3)[::-1].copy(),
        "radius": np.linspace(0, 1, COUNT),
        "color": np.arange(3 * COUNT, dtype=np.uint8).reshape(COUNT, 3),
        "lambert": np.linspace(1, 0, COUNT),
        "color_end": np.arange(50, 50 + 3 * COUNT, dtype=np.uint8).reshape(COUNT, 3),
        **changed,
    }


def columns_of_cones(**changed: object) -> dict[str, Any]:
    """Return arrays of five cones, with others in place of some."""
    first, second, third, *rest = columns().items()
    radius_end = ("radius_end", np.linspace(1, 0.7, COUNT))
    return dict([first, second, third, radius_end, *rest]) | changed


COLUMNS_OF: dict[type[Arrays], Callable[..., dict[str, Any]]] = {
    Spheres: columns_of_spheres,
    Cylinders: columns,
    Cones: columns_of_cones,
}
each_kind = pytest.mark.parametrize("kind", COLUMNS_OF, ids=lambda kind: kind.__name__)


# ---- what all kinds share


def test_every_kind_is_tested() -> None:
    assert list(COLUMNS_OF) == list(ARRAY_KINDS.values())


@each_kind
def test_columns_are_the_fields(kind: type[Arrays]) -> None:
    assert (*kind.COLUMNS, "material") == kind.__struct_fields__


@each_kind
@pytest.mark.parametrize("wrap", [np.asarray, OnlyDLPack, OnlyArray, np.asfortranarray])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_are_shared_and_read_only(kind: type[Arrays], wrap: Any, dtype: Any) -> None:
    order: Any = "F" if wrap is np.asfortranarray else "C"
    given = {
        name: array.astype(array.dtype if array.dtype == np.uint8 else dtype, order=order)
        for name, array in COLUMNS_OF[kind]().items()
    }
    made = kind(**{name: wrap(array) for name, array in given.items()})
    for name, array in given.items():
        attribute = getattr(made, name)
        assert np.array_equal(attribute, array)
        assert attribute.dtype == array.dtype
        assert np.shares_memory(attribute, array)
        assert array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            attribute[:] = 0
    assert len(made) == COUNT


@each_kind
@pytest.mark.parametrize("dtype", ["f2", ">f4", ">f8", "i1", "u2", "i8", "longdouble"])
def test_other_dtypes_become_doubles(kind: type[Arrays], dtype: str) -> None:
    ones = {name: np.ones_like(array, dtype) for name, array in COLUMNS_OF[kind]().items()}
    optional = "opacity", "roughness", "metalness", "material_index"
    one_each = {name: np.ones(COUNT, dtype) for name in optional}
    made = kind(**ones, **one_each, material=("plastic", "mirror"))
    bytes_ = "color", "color_end", "material_index"
    for name in kind.COLUMNS:
        assert getattr(made, name).dtype == (np.uint8 if name in bytes_ else np.float64)
        assert np.all(getattr(made, name) == 1)


@each_kind
def test_equality_is_that_of_the_objects(kind: type[Arrays]) -> None:
    columns_of = COLUMNS_OF[kind]
    made = kind(**columns_of())
    assert made == kind(**columns_of())
    assert (made != kind(**columns_of())) is False
    assert kind(**columns_of(radius=1)) == kind(**columns_of(radius=np.ones(COUNT, "f4")))
    assert made != "arrays"
    for name, array in columns_of().items():
        other = array.copy()
        other[-1] = 0.5 if other.ndim == 1 else 77
        assert made != kind(**columns_of(**{name: other}))
    assert made != kind(**{name: array[1:] for name, array in columns_of().items()})
    with pytest.raises(TypeError, match="unhashable"):
        hash(made)


def test_kinds_differ_even_if_empty() -> None:
    spheres, cylinders = Spheres([], 1), Cylinders([], [], 1)
    assert spheres != cylinders
    assert (spheres == cylinders) is False


@each_kind
def test_pickle_and_copies(kind: type[Arrays]) -> None:
    made = kind(**COLUMNS_OF[kind](radius=2))
    for copied in (pickle.loads(pickle.dumps(made)), copy.copy(made), copy.deepcopy(made)):
        assert type(copied) is kind
        assert copied == made
        assert not copied.color.flags.writeable


@each_kind
def test_scene_looks_again_at_shared_arrays(kind: type[Arrays]) -> None:
    radius = np.ones(COUNT)
    columns_of = COLUMNS_OF[kind]
    scene = Scene(CAMERA, [], [kind(**columns_of()), kind(**columns_of(radius=radius))])
    scene.check()
    radius[3] = -1
    with pytest.raises(SceneError, match=r"Scene.objects\[1\].radius\[3\]: expected a number ≥ 0"):
        scene.check()
    with pytest.raises(SceneError, match=rf"^{kind.__name__}.radius\[3\]: expected a number"):
        scene.objects[1].check()  # type: ignore[union-attr]


def test_hulls_of_objects() -> None:
    spheres = Spheres(**columns_of_spheres())
    ((center, radius, toward),) = spheres.hull()
    assert (center is spheres.center, radius is spheres.radius, toward) == (True, True, None)
    cylinders = Cylinders(**columns(radius=2))
    start, end = cylinders.start, cylinders.end
    for (center, radius, toward), ends in zip(
        cylinders.hull(), [(start, end), (end, start)], strict=True
    ):
        assert (center is ends[0], radius, toward is ends[1]) == (True, 2, True)
    sphere, cylinder = vtray.Sphere((0, 0, 5), 1), Cylinder((0, 0, 0), (0, 0, 1), 3)
    assert sphere.hull() == [(sphere.center, 1, None)]
    assert cylinder.hull() == [
        (cylinder.start, 3, cylinder.end),
        (cylinder.end, 3, cylinder.start),
    ]


# ---- arrays of cylinders


def test_one_value_for_all() -> None:
    cylinders = Cylinders([(0, 0, 5)], [(1, 0, 5)], np.float32(0.5), RED, np.array(1), BLUE)
    assert type(cylinders.radius) is type(cylinders.lambert) is float
    assert cylinders.color.tolist() == [255, 0, 0]
    assert cylinders.color_end is not None
    assert cylinders.color_end.tolist() == [0, 0, 255]


def test_no_cylinders() -> None:
    none = Cylinders([], [], [], [], [], [])
    assert none.start.shape == none.end.shape == none.color.shape == (0, 3)
    assert none == Cylinders(np.zeros((0, 3), "f4"), np.zeros((0, 3)), 1)


def test_what_may_be_left_out() -> None:
    cylinders = Cylinders([(0, 0, 5)], [(1, 0, 5)], 1)
    assert cylinders == Cylinders([(0, 0, 5)], [(1, 0, 5)], 1, WHITE, 1)
    assert cylinders.color_end is None
    assert cylinders.replace(radius=2).color_end is None
    with pytest.raises(TypeError, match="lacks the arguments end, radius"):
        Cylinders([])  # type: ignore[call-arg]
    with pytest.raises(TypeError, match='did you mean "color_end"'):
        Cylinders([], [], 1, colour_end=RED)  # type: ignore[call-arg]


def test_without_color_end_both_halves_have_the_color() -> None:
    plain = Cylinders(**columns(color_end=None))
    assert plain == Cylinders(**columns(color_end=columns()["color"]))
    assert plain != Cylinders(**columns())
    assert np.array_equal(plain.given_for("color_end"), columns()["color"])


def test_repr_is_short() -> None:
    arrays = "start=<float64 (5, 3)>, end=<float64 (5, 3)>, radius=2.0, color=<uint8 (5, 3)>"
    for color, shown in ((RED, "<uint8 (3,)>"), (None, "None")):
        assert repr(Cylinders(**columns(radius=2, color_end=color))) == (
            f"Cylinders({arrays}, lambert=<float64 (5,)>, color_end={shown})"
        )


def spoilt(name: str, index: Any, value: object, dtype: Any = None) -> Any:
    """Return an array with a wrong number in it."""
    array = columns()[name].astype(dtype or "f8")
    array[index] = value
    return array


POINTS = "expected an array of numbers of shape (n, 3), got"
FIVE = "as start has shape (5, 3), got shape"
ENDS = f"expected an array of numbers of shape (5, 3), {FIVE}"
NUMBERS = "expected a number or an array of numbers of shape"
COLORS = "expected three integers or an array of numbers of shape"
NAMES = "a name becomes numbers by vtray.colors.to_rgb"
BAD_ARRAYS: list[tuple[str, Any, str]] = [
    ("start", spoilt("start", (3, 1), INF), "start[3, 1]: expected a finite number, got inf"),
    ("start", np.zeros((3, 5)), f"start: {POINTS} shape (3, 5) (transpose it)"),
    ("start", np.zeros(3), f"start: {POINTS} shape (3,)"),
    ("start", None, f"start: {POINTS} None"),
    ("end", spoilt("end", (2, 0), NAN, "f4"), "end[2, 0]: expected a finite number, got nan"),
    ("end", np.zeros((4, 3)), f"end: {ENDS} (4, 3)"),
    ("end", np.zeros((3, 3)), f"end: {ENDS} (3, 3)"),
    ("end", np.zeros((3, 5)), f"end: {ENDS} (3, 5) (transpose it)"),
    ("end", (0, 0, 1), f"end: {ENDS} (3,)"),
    ("end", [], f"end: {ENDS} (0,)"),
    ("end", None, f"end: {POINTS} None"),
    ("radius", spoilt("radius", 2, -2.0), "radius[2]: expected a number ≥ 0, got -2.0"),
    ("radius", [1, 2], f"radius: {NUMBERS} (5,), {FIVE} (2,)"),
    ("radius", None, f"radius: {NUMBERS} (n,), got None"),
    ("color", spoilt("color", (1, 2), 256, "i4"), f"color[1, 2]: {BYTE} 256"),
    ("color", None, f"color: {COLORS} (n, 3), got None"),
    ("color_end", spoilt("color_end", (4, 0), 0.5), f"color_end[4, 0]: {BYTE} 0.5"),
    ("color_end", (0, 300, 0), f"color_end[1]: {BYTE} 300"),
    ("color_end", [(1, 2, 3)], f"color_end: {COLORS} (5, 3), {FIVE} (1, 3)"),
    ("color_end", "red", f"color_end: {COLORS} (n, 3), got 'red'; {NAMES}('red')"),
    ("color", ["red", "b"], f"color: {COLORS} (n, 3), got ['red', 'b']; {NAMES}('red')"),
    ("lambert", spoilt("lambert", 3, 1.5), "lambert[3]: expected a number from 0 to 1, got 1.5"),
]


@pytest.mark.parametrize(("name", "value", "message"), BAD_ARRAYS, ids=range(len(BAD_ARRAYS)))
def test_bad_arrays(name: str, value: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Cylinders(**columns(**{name: value}))
    assert str(caught.value) == f"Cylinders.{message}"


@given(arrays_of.arrays(NUMERIC, st.tuples(st.integers(1, 6), st.just(3))), st.booleans())
def test_the_first_wrong_number_is_named(points: np.ndarray, is_end: bool) -> None:
    others = np.zeros((len(points), 3), np.float32)
    one, two = (others, points) if is_end else (points, others)
    wrong = np.argwhere(~np.isfinite(points))
    if len(wrong) == 0:
        made = Cylinders(one, two, 1)
        assert np.array_equal(made.end if is_end else made.start, points.astype("f8"))
    else:
        with pytest.raises(SceneError) as caught:
            Cylinders(one, two, 1)
        place = f"{'end' if is_end else 'start'}[{wrong[0][0]}, {wrong[0][1]}]"
        assert str(caught.value).startswith(f"Cylinders.{place}: expected a finite number")


# ---- one cylinder


def test_one_cylinder() -> None:
    cylinder = Cylinder((0, 1, 2), np.array([3, 4, 5]), 0.5)  # type: ignore[arg-type]
    assert cylinder == Cylinder((0, 1, 2), (3, 4, 5), 0.5, WHITE, 1)
    assert cylinder.end == vtray.Vector(3, 4, 5)
    assert cylinder.replace(radius=0).radius == 0
    Cylinder((1, 2, 3), (1, 2, 3), 1)  # of no length


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"start": (0, 0)}, "start: expected Vector or three numbers, got (0, 0)"),
        ({"end": (0, NAN, 0)}, "end.y: expected a finite number, got nan"),
        ({"radius": -1}, "radius: expected a number ≥ 0, got -1"),
        ({"color": (0, 0, 256)}, f"color.b: {BYTE} 256"),
        ({"lambert": 2}, "lambert: expected a number from 0 to 1, got 2"),
    ],
)
def test_bad_cylinder(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Cylinder(**{"start": (0, 0, 0), "end": (0, 0, 1), "radius": 1, **changed})
    assert str(caught.value) == f"Cylinder.{message}"


# ---- added to a scene

POSITIONS = (columns()["start"], columns()["end"])
VALUES = np.linspace(0, 1, COUNT)


def test_add_cylinder() -> None:
    scene = Scene()
    added = scene.add_cylinder((0, 0, 0), (0, 0, 1), 0.25, "red", 0.5)
    assert scene.objects == [added] == [Cylinder((0, 0, 0), (0, 0, 1), 0.25, RED, 0.5)]
    with pytest.raises(SceneError, match="add_cylinder: end: expected Vector or three numbers"):
        scene.add_cylinder((0, 0, 0), 1, 0.25)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="add_cylinder: color: "):
        scene.add_cylinder((0, 0, 0), (0, 0, 1), 0.25, "rde")


def test_add_cylinders() -> None:
    scene = Scene()
    added = scene.add_cylinders(*POSITIONS, 0.5, ["red", "#00f"] * 2 + ["w"], color_end="blue")
    assert scene.objects == [added]
    colors = [RED, BLUE, RED, BLUE, WHITE]
    assert added == Cylinders(*POSITIONS, 0.5, colors, 1, BLUE)
    assert added.color_scale is None
    assert np.shares_memory(added.start, POSITIONS[0])
    assert np.shares_memory(added.end, POSITIONS[1])
    assert not added.color.flags.writeable
    assert scene.add_cylinders(*POSITIONS, 1).color_end is None
    assert len(scene.add_cylinders([], [], 1, [], color_end=[], cmap="viridis")) == 0


def test_both_halves_share_the_limits_of_a_map() -> None:
    added = Scene().add_cylinders(
        *POSITIONS, 1, VALUES, color_end=VALUES + 1, cmap="viridis", nan_color="red"
    )
    scale = added.color_scale
    assert scale == vtray.ColorScale("viridis", 0, 2, "red")
    assert added.color.tolist() == scale.colors(VALUES).tolist()
    assert added.color_end is not None
    assert added.color_end.tolist() == scale.colors(VALUES + 1).tolist()
    one = Scene().add_cylinders(*POSITIONS, 1, VALUES, cmap="viridis")
    assert one.color_end is None
    assert one.color_scale == vtray.ColorScale("viridis", 0, 1)
    given = Scene().add_cylinders(*POSITIONS, 1, VALUES, cmap="viridis", clim=(-1, 5))
    assert given.color_scale == vtray.ColorScale("viridis", -1, 5)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"end": spoilt("end", (4, 2), NAN)}, "end[4, 2]: expected a finite number, got nan"),
        ({"end": [(0, 0, 1)]}, f"end: {ENDS} (1, 3)"),
        ({"radius": -1}, "radius: expected a number ≥ 0, got -1"),
        ({"lambert": [1]}, f"lambert: {NUMBERS} (5,), {FIVE} (1,)"),
        (
            {"color": ["red"]},
            "color: expected one colour, or 5, one for each cylinder, got 1",
        ),
        (
            {"color_end": ["red"] * 4},
            "color_end: expected one colour, or 5, one for each cylinder, got 4",
        ),
        (
            {"color_end": np.zeros((4, 3))},
            "color_end: expected one colour, or numbers of shape (5, 3), got shape (4, 3)",
        ),
        (
            {"color": VALUES, "color_end": VALUES[1:], "cmap": "viridis"},
            "color_end: with cmap: expected numbers of shape (5,), one for each cylinder, "
            "got shape (4,)",
        ),
        (
            {"color": VALUES, "color_end": "red", "cmap": "viridis"},
            "color_end: with cmap: expected numbers of shape (5,), one for each cylinder, "
            "got 'red'",
        ),
        (
            {"clim": (0, 1)},
            "clim: expected None without cmap, got (0, 1); "
            'give a colour map too, for instance cmap="viridis"',
        ),
    ],
)
def test_wrong_arguments(changed: dict[str, Any], message: str) -> None:
    arguments = {"start": POSITIONS[0], "end": POSITIONS[1], "radius": 1, **changed}
    with pytest.raises(SceneError) as caught:
        Scene().add_cylinders(**arguments)
    assert str(caught.value) == f"add_cylinders: {message}"


@pytest.mark.parametrize(
    ("name", "keyword", "message"),
    [
        ("add_cylinders", "vmin", "the limits of the colour map are clim=(low, high)"),
        ("add_cylinders", "colour_end", 'did you mean "color_end"?'),
        ("add_cylinder", "color_end", 'did you mean "color"?'),
    ],
)
def test_unknown_arguments(name: str, keyword: str, message: str) -> None:
    with pytest.raises(TypeError) as caught:
        getattr(Scene(), name)(**{keyword: 1})
    assert str(caught.value).endswith(f"{name}() argument {keyword!r} is unknown; {message}")


# ---- other colours


def test_recolored() -> None:
    cylinders, sphere = Cylinders(**columns()), vtray.Sphere((0, 0, 5), 1)
    objects = [cylinders, Cylinder((0, 0, 0), (0, 0, 1), 1), sphere]

    def recolor(index: int, color: Any, **options: Any) -> list[Any]:
        return recolored(vtray.Scene(None, [], objects), index, color, **options).objects

    both, *_ = recolor(0, "red", color_end="blue")
    assert both == Cylinders(**columns(color=RED, color_end=BLUE))
    one, *_ = recolor(0, VALUES, cmap="viridis")
    assert isinstance(one, Cylinders)
    assert one.color_end is None
    assert one.color_scale == vtray.ColorScale("viridis", 0, 1)
    assert np.shares_memory(one.start, cylinders.start)
    assert recolor(1, "red")[1] == objects[1].replace(color=RED)
    for index in (1, 2):
        with pytest.raises(SceneError) as caught:
            recolor(index, "red", color_end="blue")
        words = "expected None, as only Cylinders and Cones have two colours, got 'blue'"
        assert str(caught.value) == f"recolor: color_end: {words}"
    with pytest.raises(SceneError, match="recolor: color_end: expected one colour, or 5, one for"):
        recolor(0, "red", color_end=["blue"])


# ---- the hash of a scene


def test_any_change_is_another_scene() -> None:
    base = columns(color_end=None)
    changed = [
        {},
        {"start": base["end"], "end": base["start"]},
        {"color_end": RED},
        {"color_end": base["color"]},
        {"color": base["color"][::-1]},
        {"radius": 1},
        {"lambert": 1},
        {"end": np.nextafter(base["end"], 99)},
    ]
    scenes = [Scene(CAMERA, [], [Cylinders(**{**base, **arrays})]) for arrays in changed]
    scenes += [Scene(CAMERA, [], [Cylinder((0, 0, 0), (0, 0, z), 1)]) for z in (1, 2)]
    scenes += [Scene(CAMERA, [], [kind([], *more)]) for kind, *more in KINDS_OF_NONE]
    hashes = [scene_hash(scene) for scene in scenes]
    assert len(set(hashes)) == len(hashes)
    assert scene_hash(scenes[0]) == scene_hash(Scene(CAMERA, [], [Cylinders(**base)]))


@each_kind
def test_hashes_stay_what_they_are(kind: type[Arrays]) -> None:
    found = scene_hash(Scene(CAMERA, [], [kind(**COLUMNS_OF[kind]())]))
    assert found == HASHES[kind]


HASHES: dict[type[Arrays], str] = {
    Spheres: "57801293ada7e1faa5cf8f106260f6b5",
    Cylinders: "fe8745703f2488b7260db2e0292e8eff",
    Cones: "7a61d0166b3168ebf9aa13d59b800903",
}
KINDS_OF_NONE: list[tuple[Any, ...]] = [(Spheres, 1), (Cylinders, [], 1), (Cones, [], 1)]


def test_names_are_public() -> None:
    assert (vtray.Cylinder, vtray.Cylinders, vtray.Cones) == (Cylinder, Cylinders, Cones)
