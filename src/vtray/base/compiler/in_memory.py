"""Arguments of kernels that stay in memory.

A scene is a tuple of tuples of some seventy arrays. Numba hands over such a tuple word by word, and
writes code that takes it apart and puts it together in each function that it goes through, which is
more than half of all that LLVM is given. So a tuple with named items that holds arrays is an
address to machine code: that of its words, which lie one after the other as `native_call` has put
them there, and from where an item is loaded when it is asked for. An item of a class that lies
`apart` is the address of its own words, so that all others lie where they do whatever is in it.

Nobody writes to these words while a kernel runs, and LLVM is told so. What a kernel itself makes of
a class is a value, as ever.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls, allow-untyped-decorators

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numba
from blake3 import blake3
from llvmlite import ir
from numba.core.datamodel.models import PrimitiveModel
from numba.core.extending import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, register_model

from vtray.base.compiler.function_names import full_name
from vtray.base.compiler.unseen import is_apart

types: Any = numba.types

WORD = ir.IntType(64)
"""What there is in memory for a number, an address, or nothing."""

ITEMS, ITEM_BYTES, DATA, SHAPE, STRIDES = range(2, 7)
"""The members of an array to Numba; in memory, the last two have a word for each dimension."""

_NAME_BYTES = 12


class InMemory(numba.types.Type):
    """A tuple with named items that lies in memory, as the type of an argument.

    Attributes
    ----------
    made_by
        Its class.
    items
        The types of its items.
    fields
        Their names.
    places
        The words at which they begin.
    size
        How many words there are.
    """

    def __init__(self, made_by: Any, items: tuple[Any, ...]) -> None:
        self.made_by, self.items = made_by, items
        self.fields: tuple[str, ...] = made_by._fields
        sizes = [_item_words(item) for item in items]
        self.places = [sum(sizes[:k]) for k in range(len(sizes))]
        self.size = sum(sizes)
        # Names of functions hold those of their arguments, and some would be thousands long.
        whole = ", ".join([full_name(made_by), *map(str, items)])
        super().__init__(f"{made_by.__name__}-{blake3(whole.encode()).hexdigest(_NAME_BYTES)}")


class Unseen(numba.types.Type):
    """A tuple with named items that lies in memory, to code that does not look into it.

    Attributes
    ----------
    made_by
        Its class.
    """

    def __init__(self, made_by: Any) -> None:
        self.made_by = made_by
        super().__init__(f"{full_name(made_by)}-unseen")


@register_model(InMemory)
@register_model(Unseen)
class _Address(PrimitiveModel):
    """What such a tuple is to machine code."""

    def __init__(self, manager: Any, kind: InMemory | Unseen) -> None:
        super().__init__(manager, kind, WORD.as_pointer())


@infer_getattr
class _Items(AttributeTemplate):
    """Says what type an item has."""

    key = InMemory

    def generic_resolve(self, kind: InMemory, name: str) -> Any:  # type: ignore[override]
        """Return the type of an item, None if there is none of the name."""
        return kind.items[kind.fields.index(name)] if name in kind.fields else None


def in_memory(kind: Any) -> Any:
    """Return the type of an argument of a kernel, given what Numba says of its value."""
    if isinstance(kind, types.BaseNamedTuple) and _has_array(kind):
        return InMemory(kind.instance_class, tuple(map(in_memory, kind.types)))
    return kind


def hidden(kind: Any, classes: frozenset[str]) -> Any:
    """Return a type as it is to code that does not look into tuples of some classes."""
    if isinstance(kind, InMemory) and full_name(kind.made_by) in classes:
        return Unseen(kind.made_by)
    return _with_items(kind, lambda item: hidden(item, classes))


def shown(kind: Any, seen: Mapping[str, Any], classes: frozenset[str]) -> Any:
    """Return a type as it is to code that looks into all tuples but those of some classes.

    Parameters
    ----------
    kind
        What it is to code that calls this one.
    seen
        The types of the tuples that are unseen there, by the names of their classes.
    classes
        Those into which this code does not look.

    Raises
    ------
    KeyError
        One of them is not in `seen`.
    """
    if isinstance(kind, Unseen):
        name = full_name(kind.made_by)
        return kind if name in classes else hidden(seen[name], classes)
    return _with_items(kind, lambda item: shown(item, seen, classes))


def has_unseen(kind: Any, classes: frozenset[str]) -> bool:
    """Tell whether a type holds unseen tuples, beside those of some classes."""
    if isinstance(kind, Unseen):
        return full_name(kind.made_by) not in classes
    return any(has_unseen(item, classes) for item in _items_of(kind))


def tuples_in(kind: Any) -> Iterator[InMemory]:
    """Yield the types of all tuples in memory that a type holds, and itself if it is one."""
    if isinstance(kind, InMemory):
        yield kind
    for item in _items_of(kind):
        yield from tuples_in(item)


def word_count(kind: Any) -> int:
    """Return how many words a value of a type takes in memory."""
    if isinstance(kind, InMemory):
        return kind.size
    if isinstance(kind, types.BaseTuple):
        return sum(word_count(item) for item in kind.types)
    return SHAPE + 2 * int(kind.ndim) if isinstance(kind, types.Array) else 1


def _item_words(kind: Any) -> int:
    """Return how many words an item of a tuple in memory takes."""
    return 1 if _is_apart(kind) else word_count(kind)


def _is_apart(kind: Any) -> bool:
    """Tell whether an item of a tuple in memory is the address of its words."""
    return isinstance(kind, Unseen) or (isinstance(kind, InMemory) and is_apart(kind.made_by))


def load(context: Any, builder: Any, kind: Any, place: Any) -> Any:
    """Write what loads a value from the words at a place; return the value."""
    if isinstance(kind, InMemory):
        return place
    if isinstance(kind, types.NoneType):
        return context.get_dummy_value()
    if isinstance(kind, types.BaseTuple):
        values = []
        for item in kind.types:
            values.append(load(context, builder, item, place))
            place = _moved(builder, place, word_count(item))
        return context.make_tuple(builder, kind, values)
    if isinstance(kind, types.Array):
        return _load_array(context, builder, kind, place)
    word = _load_word(builder, context.get_data_type(kind), place)
    return context.data_model_manager[kind].from_data(builder, word)


@lower_getattr_generic(InMemory)
def _load_item(context: Any, builder: Any, kind: InMemory, place: Any, name: str) -> Any:
    number = kind.fields.index(name)
    item, at = kind.items[number], _moved(builder, place, kind.places[number])
    if _is_apart(item):
        return _load_word(builder, WORD.as_pointer(), at)
    return load(context, builder, item, at)


def _load_array(context: Any, builder: Any, kind: Any, place: Any) -> Any:
    """Write what loads an array; what only Numba's counting of references needs is null."""
    made = ir.Constant(context.get_value_type(kind), None)
    item = context.get_data_type(kind.dtype)

    def word(number: int, value_type: Any = WORD) -> Any:
        return _load_word(builder, value_type, _moved(builder, place, number))

    made = builder.insert_value(made, word(ITEMS), ITEMS)
    made = builder.insert_value(made, WORD(context.get_abi_sizeof(item)), ITEM_BYTES)
    made = builder.insert_value(made, word(DATA, item.as_pointer()), DATA)
    for axis in range(kind.ndim):
        made = builder.insert_value(made, word(SHAPE + axis), (SHAPE, axis))
        made = builder.insert_value(made, word(SHAPE + kind.ndim + axis), (STRIDES, axis))
    return made


def _moved(builder: Any, place: Any, words: int) -> Any:
    """Write what moves a place by some words."""
    return builder.gep(place, [WORD(words)]) if words else place


def _load_word(builder: Any, kind: Any, place: Any) -> Any:
    """Write what loads a value from the word at a place."""
    loaded = builder.load(builder.bitcast(place, kind.as_pointer()), align=1)
    loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
    return loaded


def _items_of(kind: Any) -> tuple[Any, ...]:
    """Return the types of the items of a tuple, none for all else."""
    if isinstance(kind, InMemory):
        return kind.items
    return tuple(kind.types) if isinstance(kind, types.BaseTuple) else ()


def _with_items(kind: Any, change: Callable[[Any], Any]) -> Any:
    """Return the type of a tuple with other items, as it is for all else."""
    items = tuple(map(change, _items_of(kind)))
    if isinstance(kind, InMemory):
        return InMemory(kind.made_by, items)
    made_by = getattr(kind, "instance_class", None)
    return types.BaseTuple.from_types(items, made_by) if items else kind


def _has_array(kind: Any) -> bool:
    """Tell whether a type holds an array, maybe deep within."""
    if isinstance(kind, types.BaseTuple):
        return any(map(_has_array, kind.types))
    return isinstance(kind, types.Array)
