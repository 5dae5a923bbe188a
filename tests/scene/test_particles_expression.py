"""Expressions that choose particles, beside plain Python."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vtray.base.errors import SceneError
from vtray.scene.particles.expression import mask
from vtray.scene.particles.particles import Particles

COUNT = 40
GENERATOR = np.random.default_rng(5)
POSITIONS = GENERATOR.integers(-9, 9, (COUNT, 3)) / 2
PARTICLES = Particles(
    POSITIONS,
    {
        "element": GENERATOR.choice(["O", "H", "Si"], COUNT),
        "type": GENERATOR.integers(1, 4, COUNT),
        "velocity": GENERATOR.normal(size=(COUNT, 3)),
        "fixed": GENERATOR.integers(0, 2, COUNT).astype(bool),
        "c_pe[1]": GENERATOR.normal(size=COUNT),
        "my column": GENERATOR.normal(size=COUNT),
    },
    bonds=[(i, i + 1) for i in range(COUNT - 1)],
)


class Row:
    """What plain Python sees of a particle."""

    def __init__(self, index: int) -> None:
        self.x, self.y, self.z = PARTICLES.positions[index].tolist()


def plain(expression: str) -> list[bool]:
    """Work an expression out in Python, particle by particle."""
    found = []
    for index in range(COUNT):
        position = list(PARTICLES.positions[index])  # NumPy's, as ~ of Python's bool goes away
        velocity = PARTICLES["velocity"][index].tolist()
        names = {
            **dict(zip("xyz", position, strict=True)),
            "index": index,
            "element": str(PARTICLES["element"][index]),
            "type": int(PARTICLES["type"][index]),
            "fixed": bool(PARTICLES["fixed"][index]),
            "velocity": velocity,
            "norm": lambda vector: math.sqrt(sum(part * part for part in vector)),
            "sqrt": math.sqrt,
            "column": lambda name, i=index: float(PARTICLES[name][i]),
        }
        found.append(bool(eval(expression, {"abs": abs}, names)))  # noqa: S307  ours
    return found


@pytest.mark.parametrize(
    "expression",
    [
        "element == 'O' and z > 0.5",
        "element in ('O', 'Si') or not type == 2",
        "element not in ['O']",
        "type in {1, 3}",
        "(type == 1) | (x > 0) & ~(y > 0)",
        "(type == 1) ^ (x > 0)",
        "-2 < z <= 2 != y",
        "fixed",
        "not fixed and index % 3 == 1",
        "abs(x) + 2 * y - z / 2 > 1",
        "x ** 2 + y ** 2 < 9",
        "velocity[0] > velocity[2]",
        "norm(velocity) > 1.5",
        "sqrt(abs(z)) < 1",
        "index // 4 >= 3",
        "'O' == element",
        "column('my column') > 0",
        "+x > -y",
        "x > 1e300 * 1e300",
        "True",
        "1 == 2 or 3 > 2 > 1",
        "element in ()",
        "element not in ()",
    ],
)
def test_same_as_python(expression: str) -> None:
    found = mask(PARTICLES, f" {expression} ")
    assert (found.dtype, found.shape) == (bool, (COUNT,))
    assert found.tolist() == plain(expression)


def test_components_and_whole_columns() -> None:
    velocity, z = PARTICLES["velocity"], PARTICLES["z"]
    assert mask(PARTICLES, "velocity.x > 0").tolist() == (velocity[:, 0] > 0).tolist()
    assert mask(PARTICLES, "z == max(z) or z == min(z)").tolist() == (
        ((z == z.max()) | (z == z.min())).tolist()
    )
    assert mask(PARTICLES, "z > mean(z)").tolist() == (z > math.fsum(z) / COUNT).tolist()
    assert mask(PARTICLES, "c_pe[1] > 0").tolist() == (PARTICLES["c_pe[1]"] > 0).tolist()
    assert mask(PARTICLES, "norm(position) < 3").sum() > 0


@pytest.mark.parametrize(
    "expression",
    [
        "{} - 1000 > 0",
        "{} * 2 > 200",
        "{} ** 2 > 1000",
        "-{} < 0",
        "abs({}) - 1 > 0",
        "{} + {} > 250",
        "{} * 10000000000 > 3",
        "{} - 18446744073709551615 <= 0",
        "(((({} + 2) ** 16) ** 16) ** 16) * 0.0 != 0.0",
        "-({} > 1) == -1",
        "({} > 1) + ({} > 2) == 2",
    ],
)
@pytest.mark.parametrize("kind", [np.uint8, np.int8, np.uint16, np.uint32, np.int64, np.uint64])
def test_integers_do_not_wrap_around(expression: str, kind: type) -> None:
    most = np.iinfo(kind).max
    column = np.array([0, 1, 2, 3, 100, most - 1, most], kind)
    particles = Particles(np.zeros((len(column), 3)), {"c": column})
    expected = []
    for entry in column.tolist():
        try:
            expected.append(eval(expression.format(entry, entry)))  # noqa: S307  ours
        except OverflowError:  # Python's integers are not doubles beyond these
            expected.append(True)
    assert mask(particles, expression.format("c", "c")).tolist() == expected


def test_roots_of_short_integers_are_doubles() -> None:
    particles = Particles(np.zeros((2, 3)), {"c": np.array([2, 3], np.uint8)})
    assert mask(particles, f"sqrt(c) == {math.sqrt(2)!r}").tolist() == [True, False]


NUMBERS = st.recursive(
    st.sampled_from(["x", "y", "z", "type", "index", "2", "0.5"]),
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*"), inner),
        st.builds("abs({})".format, inner),
        st.builds("-{}".format, inner),
    ),
    max_leaves=5,
)
TRUTHS = st.recursive(
    st.builds(
        "{} {} {}".format, NUMBERS, st.sampled_from(["<", "<=", ">", ">=", "==", "!="]), NUMBERS
    ),
    lambda inner: st.one_of(
        st.builds("({}) {} ({})".format, inner, st.sampled_from(["and", "or", "&", "|"]), inner),
        st.builds("not ({})".format, inner),
    ),
    max_leaves=4,
)


@given(TRUTHS)
def test_any_expression_is_the_same_as_in_python(expression: str) -> None:
    assert mask(PARTICLES, expression).tolist() == plain(expression)


@given(st.text(max_size=30) | st.text("xyz()[]'\"<>=&|~+-*/.,: \n0123\x00\ud800#@\\", max_size=30))
def test_any_text_is_a_mask_or_one_line(text: str) -> None:
    try:
        assert mask(PARTICLES, text).shape == (COUNT,)
    except SceneError as error:
        assert str(error).startswith("select ")
        assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("elemnt == 'O'", "at 1: no column 'elemnt'; did you mean \"element\"?"),
        ("x > 0 and mass > 1", "at 11: no column 'mass'; there are x, y, z, position, index, elem"),
        ("element == O", "at 12: no column 'O'; there are "),
        ("element == 1", "at 12: 'element' is a name, '1' a number; names stand in quotes"),
        ("type == 'O'", "at 9: \"'O'\" is a name, 'type' a number; names stand in quotes"),
        ("velocity > 3", "at 1: 'velocity' is a vector; expected velocity.x or norm(velocity)"),
        ("velocity.w > 3", "at 1: expected .x, .y or .z, got .w"),
        ("velocity[3] > 3", "at 1: 'velocity' has 3 components, numbered from 0; there is no 3"),
        ("x.y > 3", "at 1: 'x' has no components"),
        ("x", "at 1: expected something true or false, such as z > 0"),
        ("x and y", "at 1: 'x' is neither true nor false; put comparisons in brackets, as in (z >"),
        ("z > 0 & x > 0", "at 5: '0' is neither true nor false; put comparisons in brackets"),
        ("__import__('os')", "at 1: no function '__import__'; there are abs, norm, sqrt, min, max"),
        ("x.__class__", "at 1: expected .x, .y or .z, got .__class__"),
        ("(lambda: 1)()", "at 1: no function 'lambda: 1'; there are "),
        ("lambda: 1", "at 1: 'lambda: 1' is not understood in an expression"),
        ("[x for x in y]", "at 1: '[x for x in y]' is not understood in an expression"),
        ("x if y else z", "at 1: 'x if y else z' is not understood in an expression"),
        ("f'{x}'", "at 1: \"f'{x}'\" is not understood in an expression"),
        ("x >", "not understood: invalid syntax"),
        ("x = 1", "not understood: =; whether both are equal, == tells"),
        ("(x = 1) and y > 2", "not understood: =; whether both"),
        ("x == 1 and", "not understood: invalid syntax"),
        ("", "not understood: "),
        ("x is y", "at 1: expected ==, !=, <, <=, > or >="),
        ("element in 'O'", "at 12: expected several in brackets, as in ('O', 'H')"),
        ("x ** 0.5 > 1", "at 6: expected a whole power from 0 to 16"),
        ("9 ** 9 ** 9 > 1", "at 6: expected a whole power from 0 to 16"),
        ("x @ y > 1", "at 1: 'x @ y' is not understood in an expression"),
        ("1 / 0 > 1", "at 1: '1 / 0': division by zero"),
        ("abs(element) > 1", "at 5: 'element' is a name; expected a number"),
        ("abs(x, y) > 1", "at 1: abs() takes one argument"),
        ("norm(x) > 1", "at 1: norm() takes a vector, such as velocity"),
        ("column(x) > 1", "at 1: column() takes a name in quotes"),
        ("1j == x", "at 1: expected a number or a name in quotes, got 1j"),
        ("z < 1" + "0" * 400, "at 5: expected a number below 1e308"),
        ("x > 0 and\ny > nothing", "at 15: no column 'nothing'; there are "),
    ],
)
def test_errors_name_the_place(expression: str, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        mask(PARTICLES, expression)
    assert f": {message}" in str(caught.value)


@pytest.mark.parametrize("text", ["(" * 5000, "-" * 9000 + "x", "x" * 20_000, "1+" * 4000 + "1"])
def test_too_long_or_too_deep(text: str) -> None:
    with pytest.raises(SceneError, match="^select"):
        mask(PARTICLES, text)


def test_select() -> None:
    chosen = PARTICLES.select("10 <= index < 13")
    assert chosen.positions.tolist() == PARTICLES.positions[10:13].tolist()
    assert chosen.bonds.tolist() == [[0, 1], [1, 2]]
    assert chosen["element"].tolist() == PARTICLES["element"][10:13].tolist()
    turned = PARTICLES.select([12, 11, -1])
    assert turned.positions.tolist() == PARTICLES.positions[[12, 11, -1]].tolist()
    assert turned.bonds.tolist() == [[1, 0]]
    assert len(PARTICLES.select(PARTICLES["fixed"])) == PARTICLES["fixed"].sum()
    assert len(PARTICLES.select([])) == len(PARTICLES.select("False")) == 0


@pytest.mark.parametrize(
    ("which", "message"),
    [
        ([1, 40], "select[1]: expected an index from 0 to 39, got 40"),
        (
            np.array([2**64 - 1], np.uint64),
            f"select[0]: expected an index from 0 to 39, got {2**64 - 1}",
        ),
        ([1, 1], "select: expected each index at most once"),
        ([0.5], "select: expected an expression, 40 of bool, or indices, got "),
        ([True, False], "select: expected an expression, 40 of bool, or indices, got "),
        ([[1]], "select: expected an expression, 40 of bool, or indices, got "),
    ],
)
def test_wrong_choices(which: object, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        PARTICLES.select(which)
    assert str(caught.value).startswith(message)


def test_with_columns() -> None:
    more = PARTICLES.with_columns(charge=np.arange(COUNT), type=["a"] * COUNT)
    assert more["charge"].tolist() == list(range(COUNT))
    assert more["type"][0] == "a"
    with pytest.raises(SceneError, match="must have one row for each of 40 positions"):
        PARTICLES.with_columns(charge=[1])


@pytest.mark.parametrize(
    "rest", ["type % 0", "type // 0", "type % (type - type)", "fixed % 0", "(type - type) // 0"]
)
def test_no_integer_is_divided_by_0(rest: str) -> None:
    for part in (f"{rest} == 0", f"{rest.replace('type', '(type * 1.0)')} == 0"):
        assert not mask(PARTICLES, part).any()
    assert mask(PARTICLES, "6 % type == 0").all()
