"""Tuples that stay in memory are to kernels what they are to Python."""

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from vtray.base.compiler.compiled import Device, Kernel, pinned
from vtray.base.compiler.in_memory import InMemory, in_memory, word_count
from vtray.base.compiler.native_call import unpack

pytestmark = pytest.mark.usefixtures("compiler")


class Shelf(NamedTuple):
    """Arrays, and all that lies beside them."""

    books: Any
    lamp: Any
    label: Any
    deep: Any
    last: Any


class Label(NamedTuple):
    """Numbers with names, but no array."""

    size: int
    is_full: bool


def new_shelf(lamp: Any = None, first: float = 0.0) -> Shelf:
    books = first + np.arange(24.0).reshape(2, 3, 4)
    deep = (np.float32(0.5), (np.arange(3, dtype=np.int16), True, ()))
    return Shelf(books, lamp, Label(7, False), deep, np.array([True, False]))


def count_books(shelf: Any, other: Any, factor: float) -> Any:
    half, (steps, is_on, _) = shelf.deep
    total = light_of(shelf.lamp)
    for shelf_row in range(shelf.books.shape[0]):
        for k in range(steps.size):
            total = total * factor + shelf.books[shelf_row, k, -1] + steps[k]
    total += total_of(other, shelf.books.strides[1] // shelf.books.itemsize)
    steps[0] = other.label.size
    return total, half, is_on, shelf.last[0], shelf.label.is_full


def light_of(lamp: Any) -> Any:
    # Arguments that are None are known to the compiler, which drops what depends on them alone.
    return 0.0 if lamp is None else lamp.books[1, 2, 3] + lamp.label.size


def total_of(shelf: Any, column: int) -> float:
    total = 0.0
    for row in shelf.books[:, :, column - 1]:
        for book in row:
            total += book
    return total


@pytest.mark.parametrize("lamp", [None, new_shelf(first=100.0), new_shelf(new_shelf())])
@pytest.mark.parametrize("take", [lambda value: value, pinned])
def test_is_as_in_python(monkeypatch: pytest.MonkeyPatch, lamp: Any, take: Any) -> None:
    plain, compiled = new_shelf(lamp), new_shelf(lamp)
    wanted = count_books(plain, new_shelf(first=7.0), 1.5)
    for helper in (light_of, total_of):
        monkeypatch.setitem(globals(), helper.__name__, Device(helper))
    kernel = Kernel(count_books)
    assert kernel(take(compiled), new_shelf(first=7.0), 1.5) == wanted
    assert all(native is not None for native in kernel._native.values())
    assert [list(one.deep[1][0]) for one in (plain, compiled)] == [[7, 1, 2]] * 2


@pytest.mark.parametrize("value", [new_shelf(), new_shelf(new_shelf()), new_shelf((1.0, 2, None))])
def test_words_are_where_they_are_looked_for(value: Shelf) -> None:
    kind = in_memory(numba.typeof(value))
    assert isinstance(kind, InMemory)
    _, words = unpack([value])
    assert len(b"".join(words)) == 8 * kind.size == 8 * word_count(kind)
    for name, item, place in zip(kind.fields, kind.items, kind.places, strict=True):
        _, before = unpack(value[: value._fields.index(name)])
        assert len(b"".join(before)) == 8 * place
        assert isinstance(item, InMemory) == (isinstance(getattr(value, name), Shelf))


@pytest.mark.parametrize("value", [Label(1, True), (np.zeros(2), 1), 3.0, None, np.zeros((2, 2))])
def test_what_holds_no_array_or_has_no_names_is_handed_over(value: Any) -> None:
    kind = numba.typeof(value)
    assert in_memory(kind) is kind


def test_types_differ_where_anything_within_does() -> None:
    values = new_shelf(), new_shelf(new_shelf()), new_shelf((1.0,)), new_shelf(1)
    kinds = {in_memory(numba.typeof(value)) for value in values}
    assert len({kind.name for kind in kinds}) == len(kinds) == len(values)
    assert in_memory(numba.typeof(new_shelf())) in kinds
