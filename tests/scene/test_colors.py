"""Colours as people write them, one and many, and through colour maps."""

import copy
import math
import pickle
import re
import subprocess
import sys
from fractions import Fraction
from typing import Any

import cmap
import matplotlib as mpl
import matplotlib.colors
import numpy as np
import pandas as pd
import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageColor

import vtray
from conftest import once
from vtray import Color, ColorScale, Scene, SceneError
from vtray.base.extras import pip_install
from vtray.colors import to_rgb
from vtray.scene.colors.color_scale import color_table

POINTS = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]


def colors_of(color: Any, points: Any = POINTS, **options: Any) -> list[Any]:
    spheres = Scene().add_spheres(points, 0.5, color, **options)
    assert spheres.color.dtype == np.uint8
    assert not spheres.color.flags.writeable
    return spheres.color.tolist()


def refusal(color: Any, **options: Any) -> str:
    scene = Scene()
    with pytest.raises(SceneError) as caught:
        scene.add_spheres(POINTS, 0.5, color, **options)
    assert scene.objects == []
    call, message = str(caught.value).split(": ", 1)
    assert call == "add_spheres"
    return message


@pytest.mark.parametrize(
    ("color", "rgb"),
    [
        ("red", (255, 0, 0)),
        (" Light Sky Blue ", (135, 206, 250)),
        ("grey", (128, 128, 128)),
        ("rebeccapurple", (102, 51, 153)),
        ("g", (0, 128, 0)),
        ("k", (0, 0, 0)),
        ("tab:orange", (255, 127, 14)),
        ("C3", (214, 39, 40)),
        ("#f80", (255, 136, 0)),
        ("#Ff8000", (255, 128, 0)),
        ((255, 128, 0), (255, 128, 0)),
        ([0, 0, 0], (0, 0, 0)),
        ((2, 1, 0), (2, 1, 0)),
        ((1.0, 0.5, 0.0), (255, 128, 0)),
        ((1, 0.5, 0), (255, 128, 0)),
        ((0.49 / 255, 0.5 / 255, 254.5 / 255), (0, 1, 255)),
        (np.array([1, 0, 0], np.uint8), (1, 0, 0)),
        (np.array([1, 0, 0], np.float32), (255, 0, 0)),
        (np.array([9, 0, 255]), (9, 0, 255)),
        ((np.float32(1), np.float64(0), 0), (255, 0, 0)),
        ((np.uint8(1), np.uint8(0), np.uint8(0)), (1, 0, 0)),
        (Color(1, 0, 0), (1, 0, 0)),
    ],
)
def test_one_color(color: Any, rgb: Any) -> None:
    assert to_rgb(color) == rgb
    assert all(type(number) is int for number in to_rgb(color))
    assert colors_of(color) == list(rgb)
    scene = Scene()
    assert scene.add_sphere((0, 0, 0), 1, color).color == Color(*rgb)
    assert scene.add_plane((0, 0, 0), (0, 0, 1), color).color == Color(*rgb)
    settings = vtray.RenderSettings(background=color)
    assert settings.background == ("black" if rgb == (0, 0, 0) else Color(*rgb))


@once
@pytest.mark.parametrize("name", [*mpl.colors.CSS4_COLORS, *mpl.colors.TABLEAU_COLORS, *"bgrcmykw"])
def test_names_are_those_of_matplotlib(name: str) -> None:
    expected = np.floor(np.array(mpl.colors.to_rgb(name)) * 255 + 0.5)
    assert to_rgb(name) == tuple(expected)


KINDS = 'expected a name such as "red", a text such as "#ff8000", or three numbers, got'
ALPHA = "expected three numbers, as colours have no alpha (opacity=... lets light through), got"
FLOATS = "expected floats from 0 to 1, or integers from 0 to 255, got"


@pytest.mark.parametrize(
    ("color", "message"),
    [
        ("gren", f"{KINDS} 'gren'; did you mean \"green\"?"),
        ("", f"{KINDS} ''"),
        ("#12", f"{KINDS} '#12'"),
        ("#ff800080", f"{ALPHA} '#ff800080'; write \"#ff8000\""),
        ("#F808", f"{ALPHA} '#F808'; write \"#f80\""),
        ((1, 2), f"{KINDS} (1, 2)"),
        ((255, 0, 0, 255), f"{ALPHA} (255, 0, 0, 255); leave out the fourth"),
        ((1.0, 0.5, 0.0, 1.0), f"{ALPHA} (1.0, 0.5, 0.0, 1.0); leave out the fourth"),
        (
            (1, 0, 0),
            "(1, 0, 0) may mean floats from 0 to 1 or integers from 0 to 255; "
            "write (1.0, 0.0, 0.0) or (255, 0, 0)",
        ),
        (
            np.array([0, 1, 1]),
            "(0, 1, 1) may mean floats from 0 to 1 or integers from 0 to 255; "
            "write (0.0, 1.0, 1.0) or (0, 255, 255)",
        ),
        ((256, 0, 0), "expected integers from 0 to 255, got 256 in (256, 0, 0)"),
        ((0, -1, 0), "expected integers from 0 to 255, got -1 in (0, -1, 0)"),
        ((255, 0.5, 0), f"{FLOATS} 255 in (255, 0.5, 0)"),
        ((1.5, 0.0, 0.0), f"{FLOATS} 1.5 in (1.5, 0.0, 0.0)"),
        ((0.0, float("nan"), 0.0), f"{FLOATS} nan in (0.0, nan, 0.0)"),
        ((True, False, False), f"{KINDS} (True, False, False)"),
        (None, f"{KINDS} None"),
        (7, f"{KINDS} 7"),
        ({"r": 1}, f"{KINDS} {{'r': 1}}"),
    ],
)
def test_no_color(color: Any, message: str) -> None:
    for call, make in (
        ("color", lambda: to_rgb(color)),
        ("add_sphere: color", lambda: Scene().add_sphere((0, 0, 0), 1, color)),
        ("add_plane: color", lambda: Scene().add_plane((0, 0, 0), (0, 0, 1), color)),
    ):
        with pytest.raises(SceneError) as caught:
            make()
        assert str(caught.value) == f"{call}: {message}"
    if color is not None:
        with pytest.raises(SceneError) as caught:
            vtray.RenderSettings(background=color)
        assert str(caught.value) == f"RenderSettings.background: {message}"


RAINBOW = [[255, 0, 0], [0, 128, 0], [0, 0, 255], [255, 255, 0]]


@pytest.mark.parametrize(
    "color",
    [
        ["red", "green", "blue", "yellow"],
        ("r", "#008000", (0, 0, 1.0), np.array([255, 255, 0])),
        [Color(255, 0, 0), "g", "b", Color(255, 255, 0)],
        np.array(["red", "green", "blue", "yellow"]),
        np.array(["red", "green", "blue", "yellow"], object),
        pd.Series(["red", "green", "blue", "yellow"]),
        pd.Series(["red", "green", "blue", "yellow"], dtype="category"),
        pl.Series(["red", "green", "blue", "yellow"]),
        RAINBOW,
        np.array(RAINBOW),
        np.array(RAINBOW, np.uint8),
        np.array(RAINBOW) / 255,
        (np.array(RAINBOW) / 255).astype(np.float32),
        pd.DataFrame(np.array(RAINBOW), columns=list("rgb")),
        pl.DataFrame(np.array(RAINBOW) / 255, schema=list("rgb")),
    ],
)
def test_one_color_for_each(color: Any) -> None:
    assert colors_of(color) == RAINBOW


def test_bytes_are_shared() -> None:
    color = np.array(RAINBOW, np.uint8)
    assert np.shares_memory(Scene().add_spheres(POINTS, 1, color).color, color)


def test_three_names_and_no_spheres() -> None:
    assert colors_of(["r", "k", "w"], POINTS[:3]) == [[255, 0, 0], [0, 0, 0], [255, 255, 255]]
    assert colors_of([], []) == []
    assert colors_of("red", []) == [255, 0, 0]
    assert colors_of([], [], cmap="viridis") == []


@pytest.mark.parametrize(
    ("color", "options", "message"),
    [
        (
            ["red", "green"],
            {},
            "color: expected one colour, or 4, one for each position, got 2",
        ),
        (["red", "gren", "b", "k"], {}, f"color[1]: {KINDS} 'gren'; did you mean \"green\"?"),
        (
            ["red", (1, 0, 0), "b", "k"],
            {},
            "color[1]: (1, 0, 0) may mean floats from 0 to 1 or "
            "integers from 0 to 255; write (1.0, 0.0, 0.0) or (255, 0, 0)",
        ),
        (
            np.zeros((4, 4)),
            {},
            f"color: {ALPHA} shape (4, 4); give color[:, :3]",
        ),
        (
            np.zeros((3, 3)),
            {},
            "color: expected one colour, or numbers of shape (4, 3), got shape (3, 3)",
        ),
        (
            np.zeros(4),
            {},
            f"color: {ALPHA} [0.0, 0.0, 0.0, 0.0]; leave out the fourth",
        ),
        (np.eye(4, 3) * 2, {}, f"color[0]: {FLOATS} 2.0 in (2.0, 0.0, 0.0)"),
        (np.full((4, 3), np.nan), {}, f"color[0]: {FLOATS} nan in (nan, nan, nan)"),
        (
            np.array(RAINBOW) * 2,
            {},
            "color[0]: expected integers from 0 to 255, got 510 in (510, 0, 0)",
        ),
        (
            np.eye(4, 3, dtype=int),
            {},
            "color[0]: (1, 0, 0) may mean floats from 0 to 1 or integers from 0 to 255; "
            "write (1.0, 0.0, 0.0) or (255, 0, 0)",
        ),
        (np.zeros((4, 3), bool), {}, f"color: {KINDS} an array of dtype bool and shape (4, 3)"),
        (
            np.zeros(4),
            {"clim": (0, 1)},
            "clim: expected None without cmap, got (0, 1); "
            'give a colour map too, for instance cmap="viridis"',
        ),
        (
            np.zeros(3),
            {"cmap": "viridis"},
            "color: with cmap: expected numbers of shape (4,), one for each position, "
            "got shape (3,)",
        ),
        (
            "red",
            {"cmap": "viridis"},
            "color: with cmap: expected numbers of shape (4,), one for each position, got 'red'",
        ),
        (
            np.zeros(4),
            {"cmap": "virdis"},
            "cmap: expected the name of a colour map such as \"viridis\", got 'virdis'; "
            'did you mean "viridis"?',
        ),
        (
            np.zeros(4),
            {"cmap": 7},
            'cmap: expected the name of a colour map such as "viridis", or a colour map, got 7',
        ),
        (
            np.zeros(4),
            {"cmap": "viridis", "clim": (1, 0)},
            "clim: expected the lower number first, got (1, 0); for the colours in reverse, "
            'add "_r" to the name of the colour map',
        ),
        (
            np.zeros(4),
            {"cmap": "viridis", "clim": (0, np.inf)},
            "clim: expected two finite numbers, got (0, inf)",
        ),
        (
            np.zeros(4),
            {"cmap": "viridis", "clim": 3},
            "clim: expected two finite numbers, got 3",
        ),
        (
            np.zeros(4),
            {"cmap": "viridis", "nan_color": "nothing"},
            f"nan_color: {KINDS} 'nothing'",
        ),
    ],
)
def test_wrong_colors(color: Any, options: Any, message: str) -> None:
    assert refusal(color, **options) == message


def test_arrays_that_are_none() -> None:
    class OnGraphicsCard:
        def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
            raise RuntimeError("it lies on a graphics card")

        def __repr__(self) -> str:
            return "<device array>"

    words = "with cmap: expected numbers of shape (4,), one for each position, got"
    assert refusal(OnGraphicsCard(), cmap="viridis") == f"color: {words} <device array>"
    assert refusal(OnGraphicsCard()) == f"color: {KINDS} <device array>"
    for texts in (np.array([*"1234"]), np.array([*"1234"], object)):
        got = f"color: {words} an array of dtype {texts.dtype} and shape (4,)"
        assert refusal(texts, cmap="viridis") == got
    assert refusal([1, "x", 3, 4], cmap="viridis") == f"color: {words} [1, 'x', 3, 4]"
    ragged = [(1, 2, 3), (1, 2), (1, 2, 3), (1, 2, 3)]
    assert refusal(ragged) == f"color[1]: {KINDS} (1, 2)"


MASKED = "an array with masked numbers; leave out what is masked, or give array.filled(...)"


def test_masked_colors() -> None:
    rows = np.ma.masked_less(np.arange(12.0).reshape(4, 3) / 12, 0.2)
    names = np.ma.array(["red", "lime", "blue", "tan"], mask=[0, 0, 1, 0])
    for color in (rows, (255 * rows).astype(np.uint8), rows[0], names):
        assert refusal(color) == f"color: {KINDS} {MASKED}"
    assert colors_of(np.ma.array(names.data)) == colors_of(["red", "lime", "blue", "tan"])
    # Values have a color for what there is not.
    values = np.ma.array([0.0, 1, 2, 3], mask=[0, 0, 1, 0])
    assert colors_of(values, cmap="gray", nan_color=(1, 2, 3))[2] == [1, 2, 3]


@pytest.mark.parametrize("frame", [pd.DataFrame, pl.DataFrame])
def test_tables_with_other_columns(frame: Any) -> None:
    table = frame({"x": [1.0] * 4, "y": [2.0] * 4, "id": ["a"] * 4, "mass": [3.0] * 4})
    got = 'got a table of shape (4, 4) with the columns "x", "y", "id", "mass"; choose'
    numbers = "expected an array of numbers of shape (n, 3)"
    with pytest.raises(SceneError) as caught:
        Scene().add_spheres(table, 1)
    remedy = 'three columns, as in table[["x", "y", "z"]]'
    assert str(caught.value) == f"add_spheres: positions: {numbers}, {got} {remedy}"
    with pytest.raises(SceneError, match=re.escape(f'{got} one column, as in table["radius"]')):
        Scene().add_spheres(POINTS, table)
    assert f'{got} three columns, as in table[["r", "g", "b"]]' in refusal(table)
    assert f'{got} one column, as in table["value"]' in refusal(table, cmap="gray")
    alpha = frame(dict.fromkeys("rgba", [0.5] * 4))
    got = 'a table of shape (4, 4) with the columns "r", "g", "b", "a"'
    remedy = 'choose three columns, as in table[["r", "g", "b"]]'
    assert refusal(alpha) == f"color: {ALPHA} {got}; {remedy}"
    short = table[["x", "y"]]
    with pytest.raises(SceneError, match=r'got a table of .*the columns "x", "y"; choose three'):
        Scene().add_spheres(short, 1)


def test_atoms_have_positions() -> None:
    class Atoms:
        """As those of ASE: a sequence of objects."""

        positions = np.zeros((2, 3))

        def __len__(self) -> int:
            return 2

        def __getitem__(self, index: int) -> object:
            raise AssertionError("nobody looks at them one by one")

    assert len(Scene().add_spheres(Atoms(), 1)) == 2
    for things, remedy in (
        (Atoms(), "give its attribute positions"),
        (type("Molecule", (), {"get_positions": 1})(), "give what its get_positions() returns"),
    ):
        with pytest.raises(SceneError, match=f"center: .*; {re.escape(remedy)}$"):
            vtray.Spheres(things, 1, (0, 0, 0), 1)
    assert vtray.Camera.fit(Atoms()) == vtray.Camera.fit(Atoms.positions)


def test_names_that_pillow_has_looked_up() -> None:
    assert ImageColor.getrgb("plum") == to_rgb("plum") == (221, 160, 221)


def test_values_without_a_map() -> None:
    with pytest.raises(SceneError, match=r'colour by values, give a colour map too, .*"viridis"$'):
        Scene().add_spheres([(0, 0, 0)] * 5, 1, np.arange(5.0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 0), 1), "positions: expected an array of numbers of shape (n, 3), got shape (2,)"),
        ((POINTS, -1), "radius: expected a number ≥ 0, got -1"),
        ((POINTS, [1, 2, np.nan, 4]), "radius[2]: expected a finite number, got nan"),
        (
            (POINTS, [1, 2]),
            "radius: expected a number or an array of numbers of shape (4,), "
            "as positions has shape (4, 3), got shape (2,)",
        ),
        ((POINTS, 1, "red", 1.5), "lambert: expected a number from 0 to 1, got 1.5"),
    ],
)
def test_other_wrong_arguments(arguments: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Scene().add_spheres(*arguments)
    assert str(caught.value) == f"add_spheres: {message}"


@pytest.mark.parametrize(
    "positions",
    [
        pd.DataFrame({"x": [0.0, 1], "y": [2.0, 3], "z": [4.0, 5]}),
        pd.DataFrame({"x": [0, 1], "y": [2.0, 3], "z": [4, 5]}),
        pl.DataFrame({"x": [0.0, 1], "y": [2.0, 3], "z": [4.0, 5]}),
        np.array([(0, 2, 4), (1, 3, 5)], np.int16),
        [[0, 2, 4], [1, 3, 5]],
    ],
)
@pytest.mark.parametrize("series", [pd.Series, pl.Series, np.array, list])
def test_tables_are_arrays(positions: Any, series: Any) -> None:
    values = series([0.5, 1.5])
    spheres = Scene().add_spheres(positions, values, values, cmap="viridis")
    assert spheres.center.tolist() == [[0, 2, 4], [1, 3, 5]]
    assert spheres.radius.tolist() == [0.5, 1.5]  # type: ignore[union-attr]
    assert spheres.color.tolist() == color_table("viridis")[[0, -1]].tolist()


def test_positions_are_not_copied() -> None:
    for dtype in (np.float32, np.float64):
        positions = np.zeros((5, 3), dtype)
        assert np.shares_memory(Scene().add_spheres(positions, 1).center, positions)


NAN = float("nan")
INF = float("inf")


def test_values_through_a_map() -> None:
    table = color_table("viridis").tolist()
    values = [0.0, 1.0, NAN, 0.5]
    expected = [table[0], table[255], [1, 2, 3], table[128]]
    assert colors_of(values, cmap="viridis", nan_color=(1, 2, 3)) == expected
    assert colors_of(np.ma.array([0, 1, 7, 0.5], mask=[0, 0, 1, 0]), cmap="viridis") == [
        *expected[:2],
        [128, 128, 128],
        expected[3],
    ]
    limits = colors_of([-INF, INF, -1, 5], cmap="viridis", clim=(0, 1))
    assert limits == [table[0], table[255], table[0], table[255]]
    assert colors_of([False, True, False, True], cmap="viridis")[:2] == [table[0], table[255]]
    assert colors_of([0, 1, None, 0.5], cmap="viridis", nan_color=(1, 2, 3)) == expected
    assert colors_of([3, 3, 3, 3], cmap="viridis") == [table[128]] * 4
    logarithms = ColorScale("viridis", 3, 3, norm="log")
    assert logarithms.colors([1, 3, 9]).tolist() == [table[0], table[128], table[255]]
    same = colors_of([2, 3, 4, NAN], cmap="viridis", clim=(3, 3))
    assert same == [table[0], table[128], table[255], [128] * 3]
    assert colors_of([NAN] * 4, cmap="viridis") == [[128] * 3] * 4
    assert colors_of([0, 1, 2, 3], cmap="viridis_r")[0] == table[255]
    # Three values are values, and not a colour, if there is a map.
    assert len(colors_of([0.0, 1, 0], POINTS[:3], cmap="viridis")) == 3


@given(st.lists(st.floats(width=64), min_size=1, max_size=20), st.data())
def test_scale_is_that_of_matplotlib(values: list[float], data: st.DataObject) -> None:
    finite = st.floats(-1e300, 1e300)
    low, high = sorted((data.draw(finite), data.draw(finite)))
    scale = ColorScale("plasma", low, high, "red")
    colors = scale.colors(values)
    for value, color in zip(values, colors.tolist(), strict=True):
        if math.isnan(value):
            assert color == [255, 0, 0]
            continue
        if value == low == high:
            index = 128
        elif value <= low:
            index = 0
        elif value >= high:
            index = 255
        else:
            share = (Fraction(value) - Fraction(low)) / (Fraction(high) - Fraction(low))
            index = min(int(256 * share), 255)
        near = {max(index - 1, 0), index, min(index + 1, 255)}
        assert color in scale.table[sorted(near)].tolist()


@pytest.mark.parametrize("values", [0.5, [0.5], [[0.25, 0.5], [NAN, 1.0]], np.zeros((2, 0, 3))])
@pytest.mark.parametrize("norm", ["linear", "log"])
def test_scale_takes_numbers_of_any_shape(values: Any, norm: Any) -> None:
    scale = ColorScale("viridis", 0.1, 1, norm=norm)
    colors = scale.colors(values)
    assert colors.shape == (*np.shape(values), 3)
    assert np.array_equal(colors.reshape(-1, 3), scale.colors(np.ravel(values)))


@pytest.mark.parametrize("norm", ["foo", "centered", None, ["log"]])
def test_scale_of_no_known_norm(norm: Any) -> None:
    with pytest.raises(SceneError, match='^ColorScale: norm: expected "linear" or "log", got '):
        ColorScale("viridis", 0, 1, norm=norm)


@pytest.mark.parametrize(
    ("call", "arguments"),
    [
        ("add_spheres", ([(0, 0, 0)], 1)),
        ("add_cylinders", ([(0, 0, 0)], [(1, 0, 0)], 1)),
        ("add_cones", ([(0, 0, 0)], [(1, 0, 0)], 1)),
    ],
)
def test_maps_need_values(call: str, arguments: Any) -> None:
    add = getattr(Scene(), call)
    words = "with cmap: expected values that it turns into colours, one for each, got none"
    for color in ({}, {"color": None}):
        with pytest.raises(SceneError, match=f"^{call}: color: {words}$"):
            add(*arguments, cmap="virids", **color)
    assert add(*arguments, color=None) == add(*arguments) == add(*arguments, color="white")


def test_scale_is_remembered() -> None:
    scene = Scene()
    spheres = scene.add_spheres(POINTS, 1, [1, NAN, 3, 7], cmap="magma", nan_color="w")
    scale = spheres.color_scale
    assert scale == ColorScale("magma", 1, 7, "white")
    assert repr(scale) == "ColorScale('magma', 1.0, 7.0, nan_color=(255, 255, 255))"
    assert np.array_equal(scale.colors([1, NAN, 3, 7]), spheres.color)
    assert scene.add_spheres(POINTS, 1).color_scale is None
    snapshot = Scene(scene.camera, list(scene.lights), list(scene.objects))
    assert snapshot.objects[0].color_scale is scale  # type: ignore[union-attr]
    for again in (copy.copy(spheres), copy.deepcopy(spheres), pickle.loads(pickle.dumps(spheres))):
        assert again.color_scale == scale
        assert again == spheres
    plain = vtray.Spheres(spheres.center, spheres.radius, spheres.color, spheres.lambert)
    assert plain == spheres
    assert plain.color_scale is None
    with pytest.raises(AttributeError, match="make another one instead of setting low"):
        scale.low = 3
    with pytest.raises(ValueError, match="read-only"):
        scale.table[:] = 0
    assert len({scale, ColorScale("magma", 1, 7, "white"), ColorScale("magma", 1, 8)}) == 2


def test_maps_as_objects() -> None:
    few = mpl.colors.ListedColormap(["red", "blue"], name="few")
    assert colors_of([0, 1, 2, 3], cmap=few) == [[255, 0, 0]] * 2 + [[0, 0, 255]] * 2
    for table in (
        color_table(mpl.colormaps["viridis"]),
        color_table(cmap.Colormap("viridis")),
        color_table("viridis"),
    ):
        assert np.array_equal(table, color_table("viridis"))
    assert len(color_table(cmap.Colormap("tab10"))) == len(color_table("tab10")) == 10


def run_without(packages: list[str], code: str) -> str:
    hidden = f"import sys; sys.modules.update(dict.fromkeys({packages}))\n"
    run = [sys.executable, "-W", "error", "-c", hidden + code]
    done = subprocess.run(run, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


TABLES = """
from vtray.scene.colors.color_scale import color_table
for name in ("viridis", "coolwarm_r", "tab10", "PRGn", "rainbow", "gray"):
    print(name, len(color_table(name)), color_table(name).tolist()[::5])
"""


def test_maps_of_both_packages_are_the_same() -> None:
    tables = run_without([], TABLES)
    assert tables.startswith("viridis 256 [[68, 1, 84]")
    assert run_without(["matplotlib"], TABLES) == tables


def test_names_that_the_package_cmap_does_not_know() -> None:
    code = "from vtray.scene.colors.color_scale import color_table\ncolor_table('viridsi')"
    last = run_without(["matplotlib"], code).splitlines()[-1]
    words = "expected the name of a colour map such as \"viridis\", got 'viridsi'"
    assert last == f'vtray.base.errors.SceneError: cmap: {words}; did you mean "viridis"?'


def test_no_package_for_maps() -> None:
    last = run_without(["matplotlib", "cmap"], TABLES).splitlines()[-1]
    assert last == (
        "vtray.base.errors.SceneError: cmap: colour maps need the package cmap, or Matplotlib: "
        f"{pip_install('cmap')}"
    )


def test_plain_colors_need_no_package_for_maps() -> None:
    code = "import vtray; print(vtray.Scene().add_spheres([(0, 0, 0)], 1, 'red').color.tolist())"
    assert run_without(["matplotlib", "cmap"], code) == "[255, 0, 0]\n"
