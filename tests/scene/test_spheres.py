"""Spheres as arrays, made in code."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

import vtray
from vtray.base.errors import SceneError
from vtray.scene.scene import Color, Scene
from vtray.scene.spheres import Spheres

COUNT = 5
CAMERA = vtray.Camera((0, 0, 0), (0, 0, 1), 10, (4, 3), (0.5, 0.25))


def columns(**changed: object) -> dict[str, Any]:
    """Return arrays of five spheres, with others in place of some."""
    return {
        "center": np.arange(3.0 * COUNT).reshape(COUNT, 3),
        "radius": np.linspace(0, 1, COUNT),
        "color": np.arange(3 * COUNT, dtype=np.uint8).reshape(COUNT, 3),
        "lambert": np.linspace(1, 0, COUNT),
        **changed,
    }


class OnlyDLPack:
    """An array of another package that can only be exchanged by DLPack."""

    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __dlpack__(self, **options: Any) -> Any:
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self) -> Any:
        return self.array.__dlpack_device__()


class OnlyArray:
    """An array of another package that turns itself into one of NumPy."""

    def __init__(self, array: np.ndarray | None) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        if self.array is None:
            raise RuntimeError("it lies on a graphics card")
        return self.array


@pytest.mark.parametrize("wrap", [np.asarray, OnlyDLPack, OnlyArray, np.asfortranarray])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_are_shared_and_read_only(wrap: Any, dtype: Any) -> None:
    given = columns()
    for name in ("center", "radius", "lambert"):
        given[name] = given[name].astype(dtype, order="F" if wrap is np.asfortranarray else "C")
    spheres = Spheres(**{name: wrap(array) for name, array in given.items()})
    for name, array in given.items():
        attribute = getattr(spheres, name)
        assert np.array_equal(attribute, array)
        assert attribute.dtype == array.dtype
        assert np.shares_memory(attribute, array) or (name == "color" and wrap is np.asfortranarray)
        assert array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            attribute[:] = 0
    assert len(spheres) == COUNT


def test_strided_and_mapped_arrays_are_shared(tmp_path: Any) -> None:
    table = np.zeros((COUNT, 9), np.float32)
    np.save(tmp_path / "x.npy", table)
    mapped = np.load(tmp_path / "x.npy", mmap_mode="r")
    for array in (table, mapped, table[::-1]):
        spheres = Spheres(array[:, 1:7:2], array[:, 8], (1, 2, 3), 1)
        assert np.shares_memory(spheres.center, array)
        assert np.shares_memory(spheres.radius, array)
        assert type(spheres.center) is np.ndarray


@pytest.mark.parametrize(
    "dtype", ["f2", ">f2", ">f4", ">f8", "i1", "u2", ">i4", "i8", "u8", "longdouble"]
)
def test_other_dtypes_become_doubles(dtype: str) -> None:
    given = {name: np.ones_like(array, dtype) for name, array in columns().items()}
    spheres = Spheres(**given)
    assert spheres.color.dtype == np.uint8
    for name in ("center", "radius", "lambert"):
        assert getattr(spheres, name).dtype == np.dtype("f8")
    assert spheres == Spheres(np.ones((COUNT, 3)), 1, (1, 1, 1), 1)


def test_one_value_for_all() -> None:
    for color in ((1, 2, 3), [1.0, 2, 3], Color(1, 2, 3), np.array([1, 2, 3], np.int64)):
        spheres = Spheres([(0, 0, 5), (1, 0, 5)], np.float32(0.5), color, np.array(1))
        assert type(spheres.radius) is type(spheres.lambert) is float
        assert (spheres.radius, spheres.lambert) == (0.5, 1.0)
        assert (spheres.color.dtype, spheres.color.tolist()) == (np.uint8, [1, 2, 3])


def test_no_spheres() -> None:
    lists = Spheres([], [], [], [])
    assert lists.center.shape == lists.color.shape == (0, 3)
    assert lists.radius.shape == (0,)
    assert len(lists) == 0
    assert lists == Spheres(np.zeros((0, 3), np.float32), 1, (1, 2, 3), 0)


def test_repr_is_short() -> None:
    assert repr(Spheres(**columns(radius=2))) == (
        "Spheres(center=<float64 (5, 3)>, radius=2.0, color=<uint8 (5, 3)>, lambert=<float64 (5,)>)"
    )


def test_equality_is_that_of_the_spheres() -> None:
    spheres = Spheres(**columns())
    assert spheres == Spheres(**columns())
    assert (spheres != Spheres(**columns())) is False
    assert spheres == Spheres(**columns(center=columns()["center"].astype(np.float32)))
    assert Spheres(**columns(radius=1)) == Spheres(**columns(radius=np.ones(COUNT)))
    assert spheres != "spheres"
    for name, array in columns().items():
        other = array.copy()
        other[-1] = 0.5 if other.ndim == 1 else 77
        assert spheres != Spheres(**columns(**{name: other}))
    assert spheres != Spheres(**{name: array[1:] for name, array in columns().items()})
    assert Scene(CAMERA, [], [spheres]) == Scene(CAMERA, [], [Spheres(**columns())])
    with pytest.raises(TypeError, match="unhashable"):
        hash(spheres)


def test_pickle_and_copies() -> None:
    spheres = Spheres(**columns(radius=2))
    for copied in (pickle.loads(pickle.dumps(spheres)), copy.copy(spheres), copy.deepcopy(spheres)):
        assert copied == spheres
        assert not copied.center.flags.writeable


def test_attributes_are_frozen() -> None:
    with pytest.raises(AttributeError):
        Spheres(**columns()).radius = 2.0  # type: ignore[misc]


def test_color_and_lambert_may_be_left_out() -> None:
    spheres = Spheres([(0, 0, 5)], 1)
    assert spheres == Spheres([(0, 0, 5)], 1, (255, 255, 255), 1)
    assert spheres.replace(radius=2) == Spheres([(0, 0, 5)], 2)
    with pytest.raises(SceneError, match=r"Spheres.radius: expected a number ≥ 0, got -1"):
        spheres.replace(radius=-1)


def test_wrong_calls_are_type_errors() -> None:
    with pytest.raises(TypeError, match="lacks the arguments radius"):
        Spheres([])  # type: ignore[call-arg]


CENTERS = "expected an array of numbers of shape (n, 3), got"
NUMBERS = "expected a number or an array of numbers of shape (n,), got"
FIVE_NUMBERS = (
    "expected a number or an array of numbers of shape (5,), as center has shape (5, 3), got"
)
FIVE_COLORS = (
    "expected three integers or an array of numbers of shape (5, 3), as center has shape (5, 3), "
    "got"
)
BYTE = "expected an integer from 0 to 255, got"
NAN, INF = float("nan"), float("inf")


def spoilt(name: str, index: Any, value: object, dtype: Any = None) -> Any:
    """Return an array with a wrong number in it."""
    array = columns()[name].astype(dtype or "f8")
    array[index] = value
    return array


BAD_ARRAYS: list[tuple[str, Any, str]] = [
    ("radius", spoilt("radius", 2, -2.0), "radius[2]: expected a number ≥ 0, got -2.0"),
    ("radius", spoilt("radius", [1, 4], -0.1, "f4"), "radius[1]: expected a number ≥ 0, got -0.1"),
    ("radius", spoilt("radius", 4, NAN), "radius[4]: expected a finite number, got nan"),
    ("radius", spoilt("radius", 0, INF, "f2"), "radius[0]: expected a finite number, got inf"),
    ("radius", -1, "radius: expected a number ≥ 0, got -1"),
    ("radius", NAN, "radius: expected a finite number, got nan"),
    ("radius", [1, 2], f"radius: {FIVE_NUMBERS} shape (2,)"),
    ("radius", np.ones((5, 1)), f"radius: {FIVE_NUMBERS} shape (5, 1)"),
    ("radius", [], f"radius: {FIVE_NUMBERS} shape (0,)"),
    ("radius", "1", f"radius: {NUMBERS} '1'"),
    ("radius", None, f"radius: {NUMBERS} None"),
    ("radius", True, f"radius: {NUMBERS} True"),
    ("radius", np.ones(5, bool), f"radius: {NUMBERS} an array of dtype bool"),
    ("radius", np.ones(5, object), f"radius: {NUMBERS} an array of dtype object"),
    ("radius", np.ones(5, "m8[s]"), f"radius: {NUMBERS} an array of dtype timedelta64[s]"),
    ("radius", 10**400, f"radius: {NUMBERS} 1{'0' * 36}..."),
    (
        "radius",
        np.ma.masked_less(np.arange(5.0), 2),
        f"radius: {NUMBERS} an array with masked numbers",
    ),
    (
        "radius",
        OnlyArray(None),
        f"radius: {NUMBERS} <test_spheres.OnlyArray object at 0x",
    ),
    ("center", spoilt("center", (3, 1), INF), "center[3, 1]: expected a finite number, got inf"),
    ("center", np.zeros((3, 5)), f"center: {CENTERS} shape (3, 5) (transpose it)"),
    ("center", np.zeros((5, 2)), f"center: {CENTERS} shape (5, 2)"),
    ("center", np.zeros(3), f"center: {CENTERS} shape (3,)"),
    ("center", np.zeros((5, 3), "c8"), f"center: {CENTERS} an array of dtype complex64"),
    ("center", [[1, 2, 3], [1, 2]], f"center: {CENTERS} [[1, 2, 3], [1, 2]] (setting an array"),
    ("center", {"x": 1}, f"center: {CENTERS} {{'x': 1}}"),
    ("color", spoilt("color", (1, 2), 256, "i4"), f"color[1, 2]: {BYTE} 256"),
    ("color", spoilt("color", (1, 2), -1, "i1"), f"color[1, 2]: {BYTE} -1"),
    ("color", spoilt("color", (4, 0), 0.5), f"color[4, 0]: {BYTE} 0.5"),
    ("color", spoilt("color", (0, 0), NAN), "color[0, 0]: expected a finite number, got nan"),
    ("color", (0, 300, 0), f"color[1]: {BYTE} 300"),
    ("color", 7, f"color: {FIVE_COLORS} shape ()"),
    ("color", [(1, 2, 3)], f"color: {FIVE_COLORS} shape (1, 3)"),
    ("lambert", spoilt("lambert", 3, 1.5), "lambert[3]: expected a number from 0 to 1, got 1.5"),
    ("lambert", 1.5, "lambert: expected a number from 0 to 1, got 1.5"),
    ("lambert", np.ones(4), f"lambert: {FIVE_NUMBERS} shape (4,)"),
]
if np.finfo(np.longdouble).max > 1e300 and np.finfo(np.longdouble).maxexp > 1024:
    HUGE = spoilt("center", (2, 2), np.longdouble("1e400"), "longdouble")
    BAD_ARRAYS.append(("center", HUGE, "center[2, 2]: expected a finite number, got 1e+400"))


@pytest.mark.parametrize(("name", "value", "message"), BAD_ARRAYS, ids=range(len(BAD_ARRAYS)))
def test_bad_arrays(name: str, value: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Spheres(**columns(**{name: value}))
    assert str(caught.value).startswith(f"Spheres.{message}")


def test_scene_looks_again_at_shared_arrays() -> None:
    radius = np.ones(COUNT)
    scene = Scene(CAMERA, [], [Spheres(**columns()), Spheres(**columns(radius=radius))])
    scene.check()
    radius[3] = -1
    with pytest.raises(SceneError, match=r"Scene.objects\[1\].radius\[3\]: expected a number ≥ 0"):
        scene.check()


NUMERIC = (
    arrays_of.floating_dtypes(endianness="?")
    | arrays_of.integer_dtypes(endianness="?")
    | arrays_of.unsigned_integer_dtypes(endianness="?")
)


@st.composite
def radii(draw: st.DrawFn) -> np.ndarray:
    """Arrays of any numeric dtype and memory layout."""
    array = draw(arrays_of.arrays(draw(NUMERIC), st.integers(1, 20)))
    return array[:: draw(st.sampled_from([1, 2, -1, -3]))]


@given(radii())
def test_the_first_wrong_number_is_named(radius: np.ndarray) -> None:
    right = (radius >= 0) & np.isfinite(radius)
    center = np.zeros((len(radius), 3), np.float32)
    if right.all():
        assert np.array_equal(Spheres(center, radius, (0, 0, 0), 1).radius, radius.astype("f8"))
    else:
        with pytest.raises(SceneError) as caught:
            Spheres(center, radius, (0, 0, 0), 1)
        assert f"Spheres.radius[{np.argmin(right)}]: " in str(caught.value)


@given(arrays_of.arrays(NUMERIC, st.tuples(st.integers(1, 6), st.just(3))))
def test_colors_are_whole_numbers_from_0_to_255(color: np.ndarray) -> None:
    right = [0 <= value <= 255 and value == int(value) for value in color.ravel().tolist()]
    center = np.zeros((len(color), 3))
    if all(right):
        assert Spheres(center, 1, color, 1).color.tolist() == color.astype(int).tolist()
    else:
        row, column = divmod(right.index(False), 3)
        with pytest.raises(SceneError) as caught:
            Spheres(center, 1, color, 1)
        assert f"Spheres.color[{row}, {column}]: " in str(caught.value)
