"""Object code on disk is used where it fits, and only there."""

import contextlib
import gc
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
import pytest
from examples import one_sphere
from llvmlite import binding

from conftest import compiled_only
from vtray.base.compiler import object_code
from vtray.base.compiler.compiled import Kernel
from vtray.base.compiler.native_call import caller, unpack
from vtray.base.compiler.object_code import (
    ObjectCode,
    compile_object,
    link,
    object_name,
    read_object_code,
    write_object_code,
)

pytestmark = pytest.mark.usefixtures("compiler")


def total(numbers: Any) -> Any:
    result = 0.0
    for k in range(numbers.size):
        result += numbers[k]
    return result


def total_of_rows(numbers: Any) -> Any:
    return total_compiled(numbers.reshape(numbers.size))


total_compiled = Kernel(total)


def assemble(text: str) -> ObjectCode:
    """Return the object code of a function in LLVM's language."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    machine = binding.Target.from_default_triple().create_target_machine(codemodel="large")
    return ObjectCode("f", "f8", machine.emit_object(binding.parse_assembly(text)))


def test_written_read_linked_and_called(tmp_path: Path) -> None:
    numbers = np.array([1.0, 2.0, 4.0])
    file = tmp_path / "total.kernel"
    write_object_code(file, compile_object(total, (numbers,), {}))
    compiled = read_object_code(file)
    assert compiled is not None
    call = caller(link(compiled), compiled.layout)
    _, words = unpack([numbers])
    assert call(words) == 7.0


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: b"damaged",
        lambda content: content[:-1],
        lambda content: content + b"\0",
        lambda content: content[:200] + bytes([content[200] ^ 1]) + content[201:],
    ],
)
def test_damaged_file_is_not_used(damage: Callable[[bytes], bytes], tmp_path: Path) -> None:
    file = tmp_path / "total.kernel"
    write_object_code(file, ObjectCode("f", "f8", bytes(1000)))
    assert read_object_code(file) == ObjectCode("f", "f8", bytes(1000))
    file.write_bytes(damage(file.read_bytes()))
    assert read_object_code(file) is None


def test_file_that_cannot_be_written_or_read(tmp_path: Path) -> None:
    file = tmp_path / "no folder" / "total.kernel"
    write_object_code(file, ObjectCode("f", "f8", b""))
    assert read_object_code(file) is None


@pytest.mark.parametrize(
    "change",
    [
        lambda patch: patch.setenv("NUMBA_CPU_NAME", "generic"),
        lambda patch: patch.setenv("NUMBA_OPT", "1"),
        lambda patch: patch.setattr(llvmlite, "__version__", "0.1"),
        lambda patch: patch.setattr(object_code, "_numba_version", lambda: "0.1"),
        lambda patch: patch.setattr(sys, "version", "3.99"),
        lambda patch: patch.setattr(object_code, "processor", lambda: "another"),
    ],
)
def test_other_circumstances_have_another_file(
    change: Callable[[pytest.MonkeyPatch], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    object_code._circumstances.cache_clear()
    usual = object_name("total", "f8,")
    assert usual == object_name("total", "f8,") != object_name("total", "i8,")
    assert usual != object_name("other", "f8,")
    change(monkeypatch)
    object_code._circumstances.cache_clear()
    changed = object_name("total", "f8,")
    monkeypatch.undo()
    object_code._circumstances.cache_clear()
    assert changed != usual == object_name("total", "f8,")


@pytest.mark.parametrize("reader", ["yaml", None])  # without it, Numba passes the file over
def test_file_of_settings_is_a_circumstance(
    reader: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    find = object_code.find_spec
    monkeypatch.setattr(
        object_code, "find_spec", lambda name: reader if name == "yaml" else find(name)
    )
    monkeypatch.chdir(tmp_path)
    keys = [object_name("total", "f8,")]
    for text in ("boundscheck: 1", "boundscheck: 0"):
        (tmp_path / ".numba_config.yaml").write_text(text)
        keys.append(object_name("total", "f8,"))
    assert len(set(keys)) == (3 if reader else 1)


def test_what_cannot_be_linked_says_so_in_silence(capfd: pytest.CaptureFixture[str]) -> None:
    missing = "declare double @no_such_function()\n" + (
        "define double @f() { %x = call double @no_such_function() ret double %x }"
    )
    for compiled in [assemble(missing), ObjectCode("f", "f8", b"no object code")]:
        with pytest.raises(RuntimeError):
            link(compiled)
    assert capfd.readouterr() == ("", "")


def test_functions_of_the_c_library_and_of_numba_are_found() -> None:
    cosine = "declare double @cos(double)\n" + (
        "define double @f() { %x = call double @cos(double 0.0) ret double %x }"
    )
    assert link(assemble(cosine))
    kernel = Kernel(total_of_rows)
    assert kernel(np.ones((2, 3))) == 6.0
    assert None not in kernel._native.values()


def test_numba_helps_where_linking_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> int:
        raise RuntimeError

    monkeypatch.setattr("vtray.base.compiler.compiled._trusted", [True])
    monkeypatch.setattr("vtray.base.compiler.canary._warned", [])
    monkeypatch.setattr("vtray.base.compiler.compiled.link", refuse)
    kernel = Kernel(total)
    with pytest.warns(UserWarning, match="kernels cannot be called without Numba"):
        assert kernel(np.array([1.0, 2.0])) == 3.0
    assert kernel(np.array([1.0, 2.0])) == 3.0
    assert list(kernel._native.values()) == [None]


def test_functions_outside_the_package_are_not_kept() -> None:
    # The folder's name would not tell that their source has changed.
    assert total_compiled._file(("f8,",)) is None


RENDER = """
import sys
from vtray.commands.cli import run
status = run(sys.argv[1:])
print(status, "numba" in sys.modules)
"""


@compiled_only
@pytest.mark.parametrize("options", [["--quiet"], ["--threads", "2"]])
def test_second_run_does_without_numba(options: list[str], tmp_path: Path) -> None:
    import json

    (tmp_path / "scene.json").write_text(json.dumps(one_sphere()))

    def run(*arguments: str) -> str:
        command = [sys.executable, "-c", RENDER, *arguments, "scene.json"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        assert done.stderr == ""
        return done.stdout.splitlines()[-1]

    run(*options, "--pixel", "5,5")
    assert run(*options, "--pixel", "5,5") == "0 False"


def spied(context: Callable[[], Any], during: list[tuple[int, int, int]]) -> Callable[[], Any]:
    """Return a context that notes how often Python collects in it."""

    @contextlib.contextmanager
    def noting() -> Iterator[None]:
        with context():
            during.append(gc.get_threshold())
            yield

    return noting


@pytest.fixture
def usual_collections() -> Iterator[tuple[int, int, int]]:
    """Let Python look for dead objects as often as it does by itself; tell how often that is."""
    of_tests, usual = gc.get_threshold(), (700, 10, 10)
    gc.set_threshold(*usual)
    yield usual
    gc.set_threshold(*of_tests)


def test_python_collects_as_before_after_compiling(
    monkeypatch: pytest.MonkeyPatch, usual_collections: tuple[int, int, int]
) -> None:
    usual = usual_collections
    during: list[tuple[int, int, int]] = []
    monkeypatch.setattr(
        object_code, "_fewer_collections", spied(object_code._fewer_collections, during)
    )
    compile_object(total, (np.ones(1),), {})
    with pytest.raises(numba.TypingError):
        compile_object(total, ("text",), {})
    assert during == [(object_code._OBJECTS_TO_COLLECT, *usual[1:])] * 2
    assert gc.get_threshold() == usual
    gc.set_threshold(0)  # by somebody who wants no collections
    try:
        compile_object(total, (np.ones(1),), {})
        assert gc.get_threshold()[0] == during[-1][0] == 0
    finally:
        gc.set_threshold(*usual)
