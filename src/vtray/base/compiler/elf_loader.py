"""Object code into memory without LLVM, where that is plain.

To load LLVM takes 30 ms, and kernels need little of its linker: the sections are placed one after
the other, and what refers to others is written there. Code finds its constants by how far these are
from it, in 32 bits. What it calls, in the C library or in other object code, may be farther away
than that; so behind the sections there is a jump to each, by an address of 64 bits, and code calls
that. Object code with anything else in it is left to LLVM.

References
----------
System V Application Binary Interface, chapter 4; AMD64 Architecture Processor Supplement, 4.4.
"""

import ctypes
import os
import struct
import sys
from collections.abc import Callable, Mapping
from itertools import starmap
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
_ADDRESS_64, _DISTANCE_32, _CALL_32 = 1, 2, 4  # symbol + addend; that less the place, twice
_ELSEWHERE = 0
_RELOCATED = b".data.rel.ro\0"
_JUMP = b"\xff\x25\0\0\0\0"  # to the address that comes next
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
    file = _ObjectFile(code)
    entry, addresses = file.place_of(file.symbol(function)), file.relocate(known)
    system, image = ctypes.CDLL(None), file.image
    base = _new_memory(system, len(image))
    for at, place in addresses:
        struct.pack_into("<Q", image, at, base + place)
    ctypes.memmove(base, bytes(image), len(image))
    _check(system.mprotect(ctypes.c_void_p(base), ctypes.c_size_t(len(image)), _READ_RUN) == 0)
    return base + entry


class _ObjectFile:
    """What an object file has for memory.

    Attributes
    ----------
    image
        Its sections, one after the other.
    """

    def __init__(self, code: bytes) -> None:
        self.image = bytearray()
        self._code, self._sections = code, _sections(code)
        (table,) = (section for section in self._sections if section.kind == _SYMBOLS)
        fields = struct.iter_unpack("<I2BH2Q", self._content(table))
        self._symbols, self._names = list(starmap(_Symbol, fields)), self._text(table.link)
        (of_sections,) = struct.unpack_from("<H", code, 62)
        names_of_sections = self._text(of_sections)
        self._places: dict[int, int] = {}
        for number, section in enumerate(self._sections):
            if section.flags & _ALLOCATED and section.size:
                # What only addresses are written to, and these before anything runs, is constant.
                is_relocated = names_of_sections.startswith(_RELOCATED, section.name)
                _check(is_relocated or not section.flags & _WRITABLE)
                self._place(number, section)

    def _place(self, number: int, section: _Section) -> None:
        _check(section.kind == _CONTENT and section.align <= _PAGE)
        self.image += bytes(-len(self.image) % max(section.align, 1))
        self._places[number] = len(self.image)
        self.image += self._content(section)

    def _content(self, section: _Section) -> bytes:
        return self._code[section.offset : section.offset + section.size]

    def _text(self, number: int) -> bytes:
        return self._content(self._sections[number])

    def _name_of(self, symbol: _Symbol) -> bytes:
        return self._names[symbol.name : self._names.index(b"\0", symbol.name)]

    def symbol(self, name: bytes) -> _Symbol:
        """Return what has a name."""
        (found,) = (symbol for symbol in self._symbols if self._name_of(symbol) == name)
        return found

    def place_of(self, symbol: _Symbol) -> int:
        """Return where something of the file is in the image."""
        return self._places[symbol.section] + symbol.value

    def relocate(self, known: Mapping[str, int]) -> list[tuple[int, int]]:
        """Write how far what is referred to is from there.

        Parameters
        ----------
        known
            As for `load`.

        Returns
        -------
        list
            Where in the image addresses are to be written, and of which places in it.
        """
        addresses: list[tuple[int, int]] = []
        jumps: dict[str, int] = {}
        for section in self._sections:
            if section.kind == _RELOCATIONS and section.info in self._places:
                begin = self._places[section.info]
                for offset, info, addend in struct.iter_unpack("<2Qq", self._content(section)):
                    symbol, kind, at = self._symbols[info >> 32], info & 0xFFFFFFFF, begin + offset
                    is_here = symbol.section != _ELSEWHERE
                    place = self.place_of(symbol) if is_here else self._jump(symbol, known, jumps)
                    if kind == _ADDRESS_64:
                        addresses.append((at, place + addend))
                    else:
                        _check(kind in (_DISTANCE_32, _CALL_32))
                        struct.pack_into("<i", self.image, at, place + addend - at)
        return addresses

    def _jump(self, symbol: _Symbol, known: Mapping[str, int], jumps: dict[str, int]) -> int:
        """Return where the jump to something elsewhere is; put it behind all else if need be."""
        name = self._name_of(symbol).decode()
        if name not in jumps:
            address = known[name] if name in known else _address(name)
            jumps[name] = len(self.image)
            self.image += _JUMP + struct.pack("<Q", address)
        return jumps[name]


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


def _address(name: str) -> int:
    """Return the address of a function of the C library."""
    _check(name in FUNCTIONS)
    return ctypes.cast(ctypes.CDLL(None)[name], ctypes.c_void_p).value or 0


def _check(is_known: bool) -> None:
    """Give up if something is not known."""
    if not is_known:
        raise _UnknownError
