"""Finds in the machine code of a kernel what is not the same on every machine.

That is: calls of functions elsewhere, such as a sine of the library of C; products and sums that
are rounded once instead of twice; approximate inverses and roots; and the 80 bits of the x87.

References
----------
Tool Interface Standard, Executable and Linking Format, version 1.2, in its form for 64 bits.
"""

import re
import struct
from collections.abc import Iterator
from typing import NamedTuple

import capstone

X86, ARM = 62, 183
"""Numbers of processors in an ELF file."""

MOVE_BYTES = {"memset", "memcpy", "memmove"}
"""What a kernel may call: it makes no numbers."""

ARCHITECTURES = {
    X86: (capstone.CS_ARCH_X86, capstone.CS_MODE_64),
    ARM: (capstone.CS_ARCH_ARM64, capstone.CS_MODE_ARM),
}
INEXACT = {
    X86: re.compile(r"v?fn?m(add|sub)|v?rcp|v?rsqrt|vexp|f|ldmxcsr"),
    ARM: re.compile(r"fn?m(add|sub)|fn?ml[as]|fcmla|frec|frsqrt|b?fmmla"),
}


class Section(NamedTuple):
    """A part of an object file."""

    kind: int
    is_code: bool
    data: bytes
    link: int


SYMBOLS = 2
"""The kind of the section with the names of functions."""


def inexact_in(code: bytes) -> set[str]:
    """Return the functions that an object file calls, and its instructions, that may differ."""
    inexact = INEXACT[_machine_of(code)]
    sections = list(_sections(code))
    found = {name for name in instructions_in(code) if inexact.match(name)}
    for section in sections:
        if section.kind == SYMBOLS:
            found |= set(_undefined(section.data, sections[section.link].data)) - MOVE_BYTES
    return found


def instructions_in(code: bytes) -> set[str]:
    """Return the names of all instructions of an object file."""
    decoder = capstone.Cs(*ARCHITECTURES[_machine_of(code)])
    found = set()
    for section in _sections(code):
        if section.is_code:
            lines = list(decoder.disasm_lite(section.data, 0))
            length = sum(size for _, size, _, _ in lines)
            assert length == len(section.data), "not all of the code could be read"
            found |= {name for _, _, name, _ in lines}
    return found


def code_in(code: bytes) -> bytes:
    """Return the bytes of all instructions of an object file."""
    return b"".join(section.data for section in _sections(code) if section.is_code)


def _machine_of(code: bytes) -> int:
    """Return the number of the processor that an object file is for."""
    machine: int = struct.unpack_from("<H", code, 18)[0]
    return machine


def _sections(code: bytes) -> Iterator[Section]:
    """Give the parts of an object file."""
    start = struct.unpack_from("<Q", code, 40)[0]
    size, count = struct.unpack_from("<HH", code, 58)
    for k in range(count):
        header = struct.unpack_from("<IIQQQQIIQQ", code, start + k * size)
        _, kind, flags, _, offset, length, link, *_ = header
        yield Section(kind, bool(flags & 4), code[offset : offset + length], link)


def _undefined(symbols: bytes, names: bytes) -> Iterator[str]:
    """Give the names that an object file leaves to the linker."""
    for name, _, _, section, _, _ in struct.iter_unpack("<IBBHQQ", symbols):
        if name and not section:
            yield names[name : names.index(b"\0", name)].decode()
