"""Calls of machine code without the compiler: from Python's values to machine words and back.

A function that Numba has compiled is an ``int f(result *, exception **, arguments...)``. Tuples are
taken apart into their members, and so are arrays: two pointers of Numba's own (null here), number
of items, bytes of an item, address, then the shape and the strides. Each of these is a word of
eight bytes in memory, from where the entry point takes them (`numba_pipeline`). Items of a class
that lies `apart` are in words of their own, and their address is a word.

References
----------
https://numba.readthedocs.io/en/stable/developer/architecture.html
"""

import ctypes
import struct
from collections.abc import Callable, Iterable
from importlib import import_module
from operator import attrgetter
from typing import Any, cast

import msgspec
import numpy as np

from vtray.base.compiler.unseen import is_apart

C_TYPES: dict[str, Any] = {
    "b1": ctypes.c_bool,
    "i1": ctypes.c_int8,
    "i2": ctypes.c_int16,
    "i4": ctypes.c_int32,
    "i8": ctypes.c_int64,
    "u1": ctypes.c_uint8,
    "u2": ctypes.c_uint16,
    "u4": ctypes.c_uint32,
    "u8": ctypes.c_uint64,
    "f4": ctypes.c_float,
    "f8": ctypes.c_double,
    "": ctypes.c_void_p,
}
"""Scalars by the names of NumPy; without a name what returns nothing, which reads as None."""

_SUCCESS = {0, -2}
"""What a function may return; -2 stands for None."""

_WORD_BYTES = 8
_int = struct.Struct("q").pack
_address = struct.Struct("Q").pack
_float = struct.Struct("d").pack
_NULL = _FALSE = bytes(_WORD_BYTES)
_TRUE = b"\1".ljust(_WORD_BYTES, b"\0")

_array_types: dict[tuple[np.dtype[Any], int, int], str] = {}
"""By what NumPy says of an array: its items, its dimensions, and its flags."""


class UnsupportedError(Exception):
    """Arguments or a result that only Numba itself can handle."""


class TupleLayout(msgspec.Struct, frozen=True):
    """A tuple in memory.

    Attributes
    ----------
    made_by
        What makes one of the items, as ``module:name``; for a NamedTuple its class.
    items
        The layouts of the items: of a scalar its key in ``C_TYPES``.
    """

    made_by: str
    items: "list[str | TupleLayout]"


Layout = str | TupleLayout
"""What a function returns, ``""`` if nothing."""

Types = tuple[str, ...]
"""The types of a function's arguments, as texts that differ where the types do."""

Words = list[bytes]
"""The words of arguments, one after the other; those of a pinned argument are together."""

NativeCall = Callable[[Words], object]
"""Calls machine code with the words of its arguments."""


class _Block(bytes):
    """Words one after the other, which hold the addresses of others that live as long."""

    held: Words


class _Place(bytes):
    """The address of words."""

    block: _Block


class Pinned:
    """An argument taken apart once, for many calls; see `pinned`."""

    __slots__ = ("type", "value", "words")

    def __init__(self, value: object) -> None:
        (self.type,), words = unpack([value])
        self.words = _block_of(words)
        self.value = value


def unpack(arguments: Iterable[object]) -> tuple[Types, Words]:
    """Return the types of arguments, and the words that are passed for them.

    The words hold addresses: they are good as long as the arguments live.

    Raises
    ------
    UnsupportedError
        Only Numba can handle these arguments.
    """
    types: list[str] = []
    words: Words = []
    for argument in arguments:
        if type(argument) is Pinned:
            types.append(argument.type)
            words.append(argument.words)
        elif isinstance(argument, tuple):
            parts: list[str] = []
            _unpack(argument, parts, words)
            types.append("".join(parts))
        else:
            _unpack(argument, types, words)
    return tuple(types), words


def unpinned(arguments: Iterable[object]) -> tuple[object, ...]:
    """Return arguments as they were before `pinned`."""
    return tuple(item.value if type(item) is Pinned else item for item in arguments)


def caller(address: int, layout: Layout) -> NativeCall:
    """Return a function that calls machine code; it may be used by several threads at once.

    Parameters
    ----------
    address
        Where the code begins.
    layout
        What it returns.
    """
    # Unlike PYFUNCTYPE, this releases the interpreter's lock during the call.
    native = ctypes.CFUNCTYPE(ctypes.c_int)(address)
    result_type = _c_struct([layout])
    read = _reader(layout)
    byref = ctypes.byref
    # All calls share this: nobody looks at it.
    exception = byref(ctypes.c_void_p())

    def call(words: Words) -> object:
        result: Any = result_type()
        status = native(byref(result), exception, b"".join(words))
        if status not in _SUCCESS:
            message = f"a kernel raised an exception: status {status}"
            raise RuntimeError(message)
        return read(result.item0)

    return call


def _unpack(value: object, types: list[str], words: Words) -> None:
    """Append the type of a value, and its words."""
    kind = type(value)
    if kind is int and -(2**63) <= cast("int", value) < 2**63:
        types.append("i8,")
        words.append(_int(value))
    elif kind is np.ndarray:
        _unpack_array(cast("np.ndarray[Any, Any]", value), types, words)
    elif isinstance(value, tuple):
        types.append(f"{kind.__module__}.{kind.__qualname__}(")
        for item in value:
            if isinstance(item, tuple) and is_apart(type(item)):
                parts: Words = []
                _unpack(item, types, parts)
                words.append(_place_of(_block_of(parts)))
            else:
                _unpack(item, types, words)
        types.append(")")
    elif kind is float:
        types.append("f8,")
        words.append(_float(value))
    elif value is None:
        types.append("none,")
        words.append(_NULL)
    elif kind is bool:
        types.append("b1,")
        words.append(_TRUE if value else _FALSE)
    elif isinstance(value, np.generic) and value.dtype.str[1:] in C_TYPES:
        types.append(f"{value.dtype.str[1:]},")
        words.append(value.tobytes().ljust(_WORD_BYTES, b"\0"))
    else:
        raise UnsupportedError


def _block_of(words: Words) -> _Block:
    """Return words one after the other."""
    block = _Block(b"".join(words))
    block.held = [word for word in words if type(word) is not bytes]
    return block


def _place_of(block: _Block) -> _Place:
    """Return the address of words."""
    place = _Place(_address(np.frombuffer(block, np.uint8).__array_interface__["data"][0]))
    place.block = block
    return place


def _unpack_array(array: "np.ndarray[Any, Any]", types: list[str], words: Words) -> None:
    """Append the type of an array, and its words."""
    dtype, shape = array.dtype, array.shape
    kind = dtype, len(shape), array.flags.num
    if kind not in _array_types:
        _array_types[kind] = _array_type(array)
    types.append(_array_types[kind])
    address = _address(array.ctypes.data)
    words += (_NULL, _NULL, _int(array.size), _int(dtype.itemsize), address)
    words += map(_int, shape)
    words += map(_int, array.strides)


def _array_type(array: "np.ndarray[Any, Any]") -> str:
    """Return the type of an array."""
    dtype, flags = array.dtype, array.flags
    if dtype.str[1:] not in C_TYPES:
        raise UnsupportedError
    order = "C" if flags.c_contiguous else "F" if flags.f_contiguous else "A"
    limits = f"{'' if flags.writeable else 'r'}{'' if flags.aligned else 'u'}"
    return f"{dtype.str}[{array.ndim}{order}{limits}],"


def _c_struct(items: list[Layout]) -> type[ctypes.Structure]:
    """Return the ctypes structure of some items, named ``item0`` and so on."""
    fields = [
        (f"item{k}", C_TYPES[item] if isinstance(item, str) else _c_struct(item.items))
        for k, item in enumerate(items)
    ]
    return type("Result", (ctypes.Structure,), {"_fields_": fields})


def _reader(layout: Layout) -> Callable[[object], object]:
    """Return a function that makes Python's value of what a ctypes structure holds."""
    if isinstance(layout, str):
        return lambda value: value
    module, _, name = layout.made_by.partition(":")
    make = getattr(import_module(module), name)
    if make is tuple and len(layout.items) > 1 and all(isinstance(i, str) for i in layout.items):
        return attrgetter(*(f"item{k}" for k in range(len(layout.items))))  # three times as fast
    readers = [(f"item{k}", _reader(item)) for k, item in enumerate(layout.items)]
    if make is tuple:
        return lambda value: tuple([read(getattr(value, name)) for name, read in readers])
    return lambda value: make(*[read(getattr(value, name)) for name, read in readers])
