"""Kernels are loaded without LLVM to the same effect, and what is not plain is left to LLVM."""

import ctypes
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import one_sphere
from llvmlite import binding

from conftest import compiled_only
from vtray.base.compiler import object_code
from vtray.base.compiler.compiled import Kernel
from vtray.base.compiler.elf_loader import IS_KNOWN, load
from vtray.base.compiler.kernel_folder import cache_folder
from vtray.base.compiler.native_call import caller, unpack
from vtray.base.compiler.object_code import compile_object

pytestmark = [
    pytest.mark.usefixtures("compiler"),
    pytest.mark.skipif(not IS_KNOWN, reason="for Linux on x86-64"),
]


def assemble(text: str, codemodel: str = "large", reloc: str = "static") -> bytes:
    """Return the object code of what is written in LLVM's language."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    target = binding.Target.from_default_triple()
    machine = target.create_target_machine(codemodel=codemodel, reloc=reloc)
    code: bytes = machine.emit_object(binding.parse_assembly(text))
    return code


def weigh(numbers: Any) -> Any:
    """Need constants in memory."""
    total = 0.0
    for k in range(numbers.size):
        total += (numbers[k] * 0.1 + 2.5e-7) / 3.7
    return total


def test_same_results_as_linked_by_llvm() -> None:
    numbers = np.linspace(0.0, 1.0, 1001)
    compiled = compile_object(weigh, (numbers,), {"error_model": "numpy", "_nrt": False})
    _, words = unpack([numbers])
    entry = load(compiled.code, compiled.symbol)
    assert entry is not None
    found = caller(entry, compiled.layout)(words)
    assert found == caller(object_code._link(compiled, {}), compiled.layout)(words)


def test_functions_of_the_c_library_are_called() -> None:
    text = "declare ptr @memset(ptr, i32, i64)\n"
    text += "define ptr @f(ptr %p) nounwind {"
    text += " %q = call ptr @memset(ptr %p, i32 7, i64 3) ret ptr %q }"
    entry = load(assemble(text), "f")
    assert entry is not None
    cells = (ctypes.c_uint8 * 4)()
    ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)(entry)(ctypes.addressof(cells))
    assert list(cells) == [7, 7, 7, 0]


def test_constants_are_found_by_how_far_they_are() -> None:
    text = "@c = internal constant double 2.5\n"
    text += "define double @f() nounwind { %x = load volatile double, ptr @c ret double %x }"
    entry = load(assemble(text, "small", "pic"), "f")
    assert entry is not None
    assert ctypes.CFUNCTYPE(ctypes.c_double)(entry)() == 2.5


def test_constants_may_be_addresses() -> None:
    text = "@c = internal constant double 2.5\n@p = internal constant ptr @c\n"
    text += "define double @f() nounwind { %p = load volatile ptr, ptr @p"
    text += " %x = load volatile double, ptr %p ret double %x }"
    entry = load(assemble(text, "small", "pic"), "f")
    assert entry is not None
    assert ctypes.CFUNCTYPE(ctypes.c_double)(entry)() == 2.5


@pytest.mark.parametrize(("codemodel", "reloc"), [("large", "static"), ("small", "pic")])
def test_what_is_called_may_be_far_away(codemodel: str, reloc: str) -> None:
    text = "declare double @g(double)\ndeclare double @h(double)\n"
    text += "define double @f(double %x) nounwind { %y = call double @g(double %x)"
    text += " %z = call double @h(double %y) %u = call double @g(double %z) ret double %u }"
    kind = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
    others = {"g": kind(lambda x: x + 1.0), "h": kind(lambda x: 2.0 * x)}
    known = {name: ctypes.cast(each, ctypes.c_void_p).value or 0 for name, each in others.items()}
    entry = load(assemble(text, codemodel, reloc), "f", known)
    assert entry is not None
    assert kind(entry)(3.0) == 9.0
    assert load(assemble(text, codemodel, reloc), "f", {"g": known["g"]}) is None


def test_what_is_loaded_can_be_run_but_not_written() -> None:
    text = "define double @f() nounwind { ret double 2.5 }"
    entry = load(assemble(text), "f")
    assert entry is not None
    assert ctypes.CFUNCTYPE(ctypes.c_double)(entry)() == 2.5
    for line in Path("/proc/self/maps").read_text().splitlines():
        first, last = (int(end, 16) for end in line.split()[0].split("-"))
        if first <= entry < last:
            assert line.split()[1] == "r-xp"


def test_constants_stand_where_vectors_are_read() -> None:
    text = "@c = constant <4 x double> zeroinitializer, align 32\n"
    text += "define i64 @f() nounwind { ret i64 ptrtoint (ptr @c to i64) }"
    entry = load(assemble(text), "f")
    assert entry is not None
    assert ctypes.CFUNCTYPE(ctypes.c_int64)(entry)() % 32 == 0


CALL = "declare double @{0}(double)\ndefine double @f() nounwind {{ {1} }}"


@pytest.mark.parametrize(
    "code",
    [
        pytest.param(lambda: b"no object code", id="no object code"),
        pytest.param(lambda: b"", id="empty"),
        pytest.param(
            lambda: assemble(CALL.format("cos", "%x = call double @cos(double 0.0) ret double %x")),
            id="another function",
        ),
        pytest.param(
            lambda: assemble(
                "@c = constant double 0.1\n"
                "define double @f() nounwind { %x = load volatile double, ptr @c ret double %x }",
                "small",
            ),
            id="addresses of 32 bits",
        ),
        pytest.param(
            lambda: assemble(
                "@c = global double 0.1\n"
                "define double @f() nounwind { %x = load volatile double, ptr @c ret double %x }"
            ),
            id="variables",
        ),
        pytest.param(lambda: assemble("define double @g() { ret double 1.0 }"), id="another name"),
        pytest.param(
            lambda: assemble("define double @f() nounwind { ret double 1.0 }").replace(
                b"\x7fELF\2", b"\x7fELF\1", 1
            ),
            id="32 bits",
        ),
    ],
)
def test_what_is_not_plain_is_left_alone(code: Any) -> None:
    assert load(code(), "f") is None


def test_code_cut_short_is_left_alone() -> None:
    code = assemble("define double @f() nounwind { ret double 1.0 }")
    assert load(code, "f") is not None
    for length in range(0, len(code), 7):
        assert load(code[:length], "f") is None


def test_llvm_links_what_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_code, "load", lambda *_: None)
    kernel = Kernel(weigh)
    assert kernel(np.zeros(0)) == 0.0
    assert None not in kernel._native.values()


RENDER = """
import sys
from vtray.commands.cli import run
status = run(sys.argv[1:])
heavy = ["numba", "llvmlite.binding", "hashlib", "tempfile", "zipfile"]
print(status, [name for name in heavy if name in sys.modules])
"""


@compiled_only
def test_second_run_loads_little(tmp_path: Path) -> None:
    import json

    (tmp_path / "scene.json").write_text(json.dumps(one_sphere()))

    kept = cache_folder()
    assert kept is not None
    # Where kernels are kept is given: what finds that out loads what it likes.
    given = {**os.environ, "VTRAY_CACHE_DIR": str(kept.parent)}

    def run() -> str:
        command = [sys.executable, "-c", RENDER, "scene.json", "picture.png"]
        done = subprocess.run(
            command, cwd=tmp_path, env=given, capture_output=True, text=True, check=True
        )
        assert done.stderr == ""
        return done.stdout.splitlines()[-1]

    run()
    assert run() == "0 []"
