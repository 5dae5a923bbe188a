"""Object code into memory without LLVM, where that is plain.

To load LLVM takes 30 ms, and kernels need little of its linker. They are compiled in the large code
model: whatever they refer to, be it their constants or a function of the C library, they do so by
an address of 64 bits. So all there is to do is to place the sections one after the other, and to
write these addresses. Object code with anything else in it is left to LLVM.

References
----------
System V Application Binary Interface, chapter 4; AMD64 Architecture Processor Supplement, 4.4.
"""

import ctypes
import os
import struct
import sys
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

IS_KNOWN = sys.platform == "linux" and os.uname().machine == "x86_64" and sys.maxsize > 2**32
"""Whether this is the one kind of machine that is known here."""

FUNCTIONS = ("memcpy", "memmove", "memset")
"""The functions that kernels may call: LLVM puts them in by itself, for loops over bytes."""

NOTHING: Mapping[str, int] = MappingProxyType({})
"""No addresses."""

_BEGINNING = b"\x7fELF\2\1\1"  # 64 bits, little-endian, version 1
_RELOCATABLE, _X86_64 = 1, 62
_CONTENT, _SYMBOLS, _RELOCATIONS = 1, 2, 4
_WRITABLE, _ALLOCATED = 1, 2
_ADDRESS_64 = 1  # symbol + addend
_ELSEWHERE = 0
_PAGE = 4096

# Of the system: to read and write, to read and run, memory of this process alone and of no file.
_READ_WRITE, _READ_RUN = 3, 5
_PRIVATE_ANONYMOUS = 0x22


class _Section(NamedTuple):
    """A part of an object file, as its header has it."""

    name: int
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int
    info: int
    align: int
    item_size: int


class _Symbol(NamedTuple):
    """A place in a section, or something from elsewhere."""

    name: int
    info: int
    other: int
    section: int
    value: int
    size: int


class _UnknownError(Exception):
    """Something that is not known here."""


def load(code: bytes, function: str, known: Mapping[str, int] = NOTHING) -> int | None:
    """Load object code into memory, for the rest of the process.

    Parameters
    ----------
    code
        An object file.
    function
        The name of a function in it.
    known
        The addresses of others that it calls, by their names, beside those of ``FUNCTIONS``.

    Returns
    -------
    int or None
        The address of the function; None if all this is better left to LLVM.
    """
    try:
        return _load(code, function.encode(), known) if IS_KNOWN else None
    except (_UnknownError, LookupError, ValueError, struct.error):
        return None


def _load(code: bytes, function: bytes, known: Mapping[str, int]) -> int:
    """Load object code as `load` does."""
    sections = _sections(code)

    def content(section: _Section) -> bytes:
        return code[section.offset : section.offset + section.size]

    (table,) = (section for section in sections if section.kind == _SYMBOLS)
    symbols = [_Symbol(*fields) for fields in struct.iter_unpack("<I2BH2Q", content(table))]
    names = content(sections[table.link])

    def name_of(symbol: _Symbol) -> bytes:
        return names[symbol.name : names.index(b"\0", symbol.name)]

    image, places = bytearray(), {}
    for number, section in enumerate(sections):
        if section.flags & _ALLOCATED and section.size:
            _check(section.kind == _CONTENT and not section.flags & _WRITABLE)
            _check(section.align <= _PAGE)
            image += bytes(-len(image) % max(section.align, 1))
            places[number] = len(image)
            image += content(section)
    (entry,) = (symbol for symbol in symbols if name_of(symbol) == function)
    system = ctypes.CDLL(None)
    base = _new_memory(system, len(image))
    for section in sections:
        if section.kind == _RELOCATIONS and section.info in places:
            for offset, info, addend in struct.iter_unpack("<2Qq", content(section)):
                _check(info & 0xFFFFFFFF == _ADDRESS_64)
                symbol = symbols[info >> 32]
                if symbol.section == _ELSEWHERE:
                    name = name_of(symbol).decode()
                    target = known[name] if name in known else _address(system, name)
                else:
                    target = base + places[symbol.section] + symbol.value
                struct.pack_into("<Q", image, places[section.info] + offset, target + addend)
    ctypes.memmove(base, bytes(image), len(image))
    _check(system.mprotect(ctypes.c_void_p(base), ctypes.c_size_t(len(image)), _READ_RUN) == 0)
    return base + places[entry.section] + entry.value


def _sections(code: bytes) -> list[_Section]:
    """Return the headers of all sections of an object file."""
    _check(code.startswith(_BEGINNING))
    _check(struct.unpack_from("<2H", code, 16) == (_RELOCATABLE, _X86_64))
    (first,) = struct.unpack_from("<Q", code, 40)
    (count,) = struct.unpack_from("<H", code, 60)
    headers = code[first : first + 64 * count]
    return [_Section(*fields) for fields in struct.iter_unpack("<2I4Q2I2Q", headers)]


def _new_memory(system: ctypes.CDLL, size: int) -> int:
    """Return where new memory begins."""
    new: Callable[..., int | None] = system.mmap
    system.mmap.restype = ctypes.c_void_p
    where = new(None, ctypes.c_size_t(size), _READ_WRITE, _PRIVATE_ANONYMOUS, -1, 0)
    _check(where is not None and where % _PAGE == 0)
    return where or 0


def _address(system: ctypes.CDLL, name: str) -> int:
    """Return the address of a function of the C library."""
    _check(name in FUNCTIONS)
    return ctypes.cast(system[name], ctypes.c_void_p).value or 0


def _check(is_known: bool) -> None:
    """Give up if something is not known."""
    if not is_known:
        raise _UnknownError
