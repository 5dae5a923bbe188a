"""Expressions that choose particles, such as ``element == 'O' and z > 3``.

They are read with Python's own parser, and worked out here step by step: what is not among the
steps below is an error, and no text is ever run as Python.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from functools import partial, reduce
from typing import TYPE_CHECKING, Any, Protocol

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import column_called

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Mask = NDArray[np.bool_]

_LONGEST = 10_000
"""Characters of an expression, at the most."""

_MOST_BITS = 1023
"""Of an integer that a double surely reaches."""

_MOST = 2**63 - 1
"""The largest integer of 64 bits."""

BESIDE_COLUMNS = ("position", "index")
"""Names that expressions have beside those of columns, and x, y and z."""

_COMPONENTS = {"x": 0, "y": 1, "z": 2, "r": 0, "g": 1, "b": 2}

_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}

_ARITHMETIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}

_LOGIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
}

_FUNCTIONS = ("abs", "norm", "sqrt", "min", "max", "mean", "column")


class Table(Protocol):
    """What has columns: `Particles`."""

    @property
    def columns(self) -> "Mapping[str, NDArray[Any]]":
        """The columns but those of the positions."""

    @property
    def positions(self) -> "NDArray[Any]":
        """Places, (n, 3)."""


def mask(particles: Table, expression: str, name: str = "select") -> "Mask":
    """Tell for which particles an expression is true.

    Its names are ``x``, ``y``, ``z``, ``position``, ``index`` (from 0) and the columns; ``force.x``
    and ``force[0]`` are the first component of a vector. It may have numbers, names in quotes,
    ``in ('O', 'H')``, comparisons (also ``0 < z < 3``), ``and``, ``or``, ``not`` (or ``&``, ``|``
    and ``~``), ``+ - * / // % **``, and the functions ``abs``, ``sqrt``, ``norm`` (length of a
    vector), ``min``, ``max`` and ``mean`` (of all particles, but for NaN). ``column('c_pe')`` is a
    column of any name.

    Parameters
    ----------
    particles
        What has the columns.
    expression
        The text.
    name
        What messages begin with.

    Returns
    -------
    array (n,)
        Of bool.

    Raises
    ------
    SceneError
        The expression is not understood, or there is no such column. The message has the place in
        the text, from 1, and what is known.
    """
    import numpy as np

    text, found = _worked_out(particles, expression, name)
    count = len(particles.positions)
    if isinstance(found, (bool, np.bool_)):
        return np.full(count, bool(found))
    if not _is_truth(found):
        raise _problem(name, text, 1, "expected something true or false, such as z > 0")
    return np.asarray(found, np.bool_)


def values_of(particles: Table, expression: str, name: str) -> "Array":
    """Return what an expression is for each particle: numbers, names or truths, (n,).

    The parameters, and what it may have, are those of `mask`.

    Raises
    ------
    SceneError
        The expression is not understood, there is no such column, or it is a vector.
    """
    import numpy as np

    text, found = _worked_out(particles, expression, name)
    if getattr(found, "ndim", 0) == 2:
        raise _problem(name, text, 1, f"a vector; expected a component, or norm({text})")
    return np.broadcast_to(np.asarray(found), len(particles.positions))


def _worked_out(particles: Table, expression: str, name: str) -> tuple[str, Any]:
    """Return an expression without blanks around it, and what it is."""
    import numpy as np

    text = re.sub(r"\s", " ", expression).strip()
    if len(text) > _LONGEST:
        raise SceneError(f"{name}: longer than {_LONGEST} characters: {short(text)!r}")
    try:
        tree = ast.parse(text, mode="eval")
    except SyntaxError as error:
        place = error.offset or 1
        words = f"not understood: {error.msg}"
        if _has_lone_equals(text, place):
            words = "not understood: =; whether both are equal, == tells"
        raise _problem(name, text, place, words) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise _problem(name, text, 1, f"not understood: {error}") from None
    try:
        with np.errstate(all="ignore"):
            return text, _Steps(particles, text, name).value(tree.body)
    except RecursionError:
        raise _problem(name, text, 1, "too many brackets within brackets") from None


class _Steps:
    """Works out an expression."""

    def __init__(self, particles: Table, text: str, name: str) -> None:
        self._particles = particles
        self._text = text
        self._begin = name

    def value(self, node: ast.expr) -> Any:  # noqa: ANN401
        """Return the value of a part: an array, a number, a name or a truth."""
        step = getattr(self, f"_{type(node).__name__.lower()}", None)
        if step is None:
            raise self._wrong(node, f"{self._source(node)!r} is not understood in an expression")
        return step(node)

    def _constant(self, node: ast.Constant) -> object:
        if isinstance(node.value, int) and node.value.bit_length() > _MOST_BITS:
            raise self._wrong(node, "expected a number below 1e308")
        if isinstance(node.value, (bool, int, float, str)):
            return node.value
        raise self._wrong(node, f"expected a number or a name in quotes, got {node.value!r}")

    def _name(self, node: ast.Name) -> "Array":
        return self._column(node.id, node)

    def _attribute(self, node: ast.Attribute) -> "Array":
        index = _COMPONENTS.get(node.attr)
        if index is None:
            raise self._wrong(node, f"expected .x, .y or .z, got .{short(node.attr)}")
        return self._component(node.value, index, node)

    def _subscript(self, node: ast.Subscript) -> "Array":
        # Columns of LAMMPS may be called c_pe[1].
        name = self._source(node)
        if name in self._particles.columns:
            return self._column(name, node)
        if not (isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, int)):
            raise self._wrong(node, f"expected a number in brackets, got {name!r}")
        return self._component(node.value, node.slice.value, node)

    def _component(self, part: ast.expr, index: int, node: ast.expr) -> "Array":
        found = self.value(part)
        if getattr(found, "ndim", 0) != 2:
            raise self._wrong(node, f"{self._source(part)!r} has no components")
        if not 0 <= index < found.shape[1]:
            words = f"{self._source(part)!r} has {found.shape[1]} components"
            raise self._wrong(node, f"{words}, numbered from 0; there is no {index}")
        column: Array = found[:, index]
        return column

    def _call(self, node: ast.Call) -> Any:  # noqa: ANN401
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in _FUNCTIONS:
            known = ", ".join(_FUNCTIONS)
            raise self._wrong(node, f"no function {self._source(node.func)!r}; there are {known}")
        if len(node.args) != 1 or node.keywords:
            raise self._wrong(node, f"{name}() takes one argument")
        found = self.value(node.args[0])
        if name == "column":
            if not isinstance(found, str):
                raise self._wrong(node, "column() takes a name in quotes")
            return self._column(found, node)
        return self._function(name, found, node)

    def _function(self, name: str, found: Any, node: ast.Call) -> Any:  # noqa: ANN401
        import numpy as np

        self._check_numbers(found, node.args[0])
        if name == "norm":
            if getattr(found, "ndim", 0) != 2:
                raise self._wrong(node, "norm() takes a vector, such as velocity")
            parts = [found[:, i].astype(np.float64) for i in range(found.shape[1])]
            return np.sqrt(reduce(operator.add, [part * part for part in parts]))
        self._check_one(found, node.args[0])
        if name == "abs":
            return np.abs(_wide(found))
        if name == "sqrt":
            return np.sqrt(_wide(found))
        values = np.atleast_1d(found)
        if not len(values):
            raise self._wrong(node, f"{name}() of no particles")
        if not np.isnan(values).all():
            values = values[~np.isnan(values)]
        # Exact, whatever the order in which a machine would add.
        return math.fsum(values) / len(values) if name == "mean" else getattr(values, name)()

    def _compare(self, node: ast.Compare) -> Any:  # noqa: ANN401
        parts = [node.left, *node.comparators]
        truths = [
            self._one_comparison(one, kind, other)
            for one, kind, other in zip(parts, node.ops, parts[1:], strict=False)
        ]
        return reduce(operator.and_, truths)

    def _one_comparison(self, left: ast.expr, kind: ast.cmpop, right: ast.expr) -> Any:  # noqa: ANN401
        one = self._side(left)
        if isinstance(kind, (ast.In, ast.NotIn)):
            if not isinstance(right, (ast.Tuple, ast.List, ast.Set)):
                raise self._wrong(right, "expected several in brackets, as in ('O', 'H')")
            equal = [self._equal(one, item, left) for item in right.elts]
            found = reduce(operator.or_, equal) if equal else False
            return (
                ~found
                if isinstance(kind, ast.NotIn) and not isinstance(found, bool)
                else (found if isinstance(kind, ast.In) else not found)
            )
        compare = _COMPARE.get(type(kind))
        if compare is None:
            raise self._wrong(left, "expected ==, !=, <, <=, > or >=")
        other = self._side(right)
        self._check_alike(one, other, left, right)
        return compare(one, other)

    def _equal(self, one: object, item: ast.expr, left: ast.expr) -> Any:  # noqa: ANN401
        other = self._side(item)
        self._check_alike(one, other, left, item)
        return one == other

    def _boolop(self, node: ast.BoolOp) -> Any:  # noqa: ANN401
        logic = operator.and_ if isinstance(node.op, ast.And) else operator.or_
        return reduce(logic, [self._truth(part) for part in node.values])

    def _unaryop(self, node: ast.UnaryOp) -> Any:  # noqa: ANN401
        import numpy as np

        if isinstance(node.op, (ast.Not, ast.Invert)):
            return np.logical_not(self._truth(node.operand))
        found = self.value(node.operand)
        self._check_numbers(found, node.operand)
        return _calculated(operator.mul, found, -1 if isinstance(node.op, ast.USub) else 1)

    def _binop(self, node: ast.BinOp) -> Any:  # noqa: ANN401
        logic = _LOGIC.get(type(node.op))
        if logic is not None:
            return logic(self._truth(node.left), self._truth(node.right))
        one, other = self.value(node.left), self.value(node.right)
        self._check_numbers(one, node.left)
        self._check_numbers(other, node.right)
        if isinstance(node.op, ast.Pow):
            if not (isinstance(other, int) and 0 <= other <= 16):
                raise self._wrong(node.right, "expected a whole power from 0 to 16")
            # Products round the same on every machine.
            return reduce(partial(_calculated, operator.mul), [one] * other, 1)
        arithmetic = _ARITHMETIC.get(type(node.op))
        if arithmetic is None:
            raise self._wrong(node, f"{self._source(node)!r} is not understood in an expression")
        try:
            return _calculated(arithmetic, one, other)
        except (ArithmeticError, TypeError, ValueError) as error:
            raise self._wrong(node, f"{self._source(node)!r}: {error}") from None

    def _column(self, name: str, node: ast.expr) -> "Array":
        import numpy as np

        particles = self._particles
        called = column_called(name, particles.columns)
        if called in particles.columns:
            found = particles.columns[called]
            return found if found.dtype.kind in "biufU" else found.astype(np.str_)
        if name in ("x", "y", "z"):
            return particles.positions[:, "xyz".index(name)]
        if name == "position":
            return particles.positions
        if name == "index":
            return np.arange(len(particles.positions))
        from vtray.scene.checks.scene_words import nearest

        known = ["x", "y", "z", *BESIDE_COLUMNS, *particles.columns]
        close = nearest(name, known, cutoff=0.6)
        remedy = f"did you mean {close}?" if close else f"there are {', '.join(known)}"
        raise self._wrong(node, f"no column {short(name)!r}; {remedy}")

    def _side(self, node: ast.expr) -> Any:  # noqa: ANN401
        """Return one side of a comparison: one value for each particle, or for all."""
        found = self.value(node)
        self._check_one(found, node)
        return found

    def _truth(self, node: ast.expr) -> Any:  # noqa: ANN401
        found = self.value(node)
        if not _is_truth(found):
            words = f"{self._source(node)!r} is neither true nor false"
            raise self._wrong(
                node, f"{words}; put comparisons in brackets, as in (z > 0) & (x > 0)"
            )
        return found

    def _check_one(self, found: object, node: ast.expr) -> None:
        """Raise SceneError for a vector."""
        if getattr(found, "ndim", 0) == 2:
            name = self._source(node)
            raise self._wrong(node, f"{name!r} is a vector; expected {name}.x or norm({name})")

    def _check_numbers(self, found: object, node: ast.expr) -> None:
        """Raise SceneError for names."""
        if _is_text(found):
            raise self._wrong(node, f"{self._source(node)!r} is a name; expected a number")

    def _check_alike(self, one: object, other: object, left: ast.expr, right: ast.expr) -> None:
        """Raise SceneError where a name is compared with a number."""
        if _is_text(one) == _is_text(other):
            return
        names, numbers = (left, right) if _is_text(one) else (right, left)
        words = f"{self._source(names)!r} is a name, {self._source(numbers)!r} a number"
        raise self._wrong(right, f"{words}; names stand in quotes, numbers do not")

    def _source(self, node: ast.expr) -> str:
        """Return a part as it stands in the text."""
        return short(ast.get_source_segment(self._text, node) or ast.unparse(node))

    def _wrong(self, node: ast.expr, problem: str) -> SceneError:
        # The parser counts bytes.
        before = self._text.encode()[: node.col_offset].decode()
        return _problem(self._begin, self._text, len(before) + 1, problem)


def _is_truth(found: Any) -> bool:  # noqa: ANN401
    """Tell whether a value is true or false, for all or for each particle."""
    import numpy as np

    return isinstance(found, (bool, np.bool_)) or (
        getattr(found, "ndim", 0) == 1 and found.dtype == np.bool_
    )


def _calculated(operation: Callable[[Any, Any], Any], one: Any, other: Any) -> Any:  # noqa: ANN401
    """Return what an operation makes of two numbers, or of those of each particle.

    Integers that 64 bits do not hold become doubles, rather than wrap around, and what is divided
    by 0 NaN or infinite, rather than 0.
    """
    import numpy as np

    one, other = _wide(one), _wide(other)
    found = operation(one, other)
    if _is_whole(one) and _is_whole(other):
        rough = operation(one * 1.0, other * 1.0)
        if not np.all(np.abs(rough) < 2.0**63):
            return rough
    return found


def _wide(found: Any) -> Any:  # noqa: ANN401
    """Return truths and integers as integers of 64 bits, or doubles where these do not hold them.

    All other numbers stay as they are.
    """
    import numpy as np

    if not _is_whole(found):
        return found
    # The least of 64 bits is left out, as there is no number of the opposite sign.
    fits = np.all(np.asarray(found) <= _MOST) and np.all(np.asarray(found) >= -_MOST)
    if isinstance(found, int):
        return int(found) if fits else float(found)
    return found.astype(np.int64 if fits else np.float64)


def _is_whole(found: Any) -> bool:  # noqa: ANN401
    """Tell whether a value is an integer or a truth, or has one for each particle."""
    kind = found.dtype.kind if hasattr(found, "dtype") else ""
    return isinstance(found, int) or kind in ("b", "i", "u")


def _is_text(found: Any) -> bool:  # noqa: ANN401
    """Tell whether a value is a name, or has one for each particle."""
    return isinstance(found, str) or (
        getattr(found, "dtype", None) is not None and (found.dtype.kind == "U")
    )


def _has_lone_equals(text: str, place: int) -> bool:
    """Tell whether an = stands alone near a place in an expression, counted from 1."""
    return re.search(r"(?<![<>=!])=(?!=)", text[max(place - 2, 0) :]) is not None


def _problem(name: str, text: str, place: int, problem: str) -> SceneError:
    """Give the error for an expression."""
    return SceneError(f"{name} {short(text, 80)!r}: at {place}: {problem}")
