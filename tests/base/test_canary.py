"""Calls without Numba are tried before they are trusted; where they fail, Numba takes over."""

import os
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
import numpy as np
import pytest

import vtray
from conftest import compiled_only
from vtray.base.compiler import canary, compiled, kernel_folder, native_call, object_code
from vtray.base.compiler.canary import Cage, Song, new_arguments, sing
from vtray.base.compiler.compiled import Device, Kernel
from vtray.base.compiler.native_call import Layout, NativeCall, TupleLayout, unpack
from vtray.base.compiler.object_code import (
    compile_object,
    object_file,
    object_name,
    write_object_code,
)
from vtray.image import exposure

pytestmark = compiled_only

MESSAGE = "kernels cannot be called without Numba ("


@pytest.fixture(scope="module")
def image() -> vtray.Image:
    """Return a small picture of lit balls."""
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 0), 1, color="tomato")
    scene.add_sphere((1, 1, 1), 0.5, color="teal")
    scene.camera = vtray.Camera.fit(scene, size=(12, 8))
    scene.lights = vtray.lights.rembrandt(scene, points=True)
    return vtray.render(scene)


@pytest.fixture(autouse=True)
def untried(image: vtray.Image, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the process be as if no kernel had been called."""
    monkeypatch.setattr(compiled, "_trusted", [])
    monkeypatch.setattr(canary, "_warned", [])
    monkeypatch.setattr(exposure._expose, "_native", {})


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Keep kernels in a new folder."""
    monkeypatch.setenv("VTRAY_CACHE_DIR", str(tmp_path))
    kernel_folder.cache_folder.cache_clear()
    yield
    kernel_folder.cache_folder.cache_clear()


def total(numbers: Any) -> Any:
    result = 0.0
    for k in range(numbers.size):
        result += numbers[k]
    return result


def expose_anew(image: vtray.Image) -> list[str]:
    """Call the kernel of exposures twice, see that it is right, and return what was warned of."""
    with warnings.catch_warnings(record=True, action="always") as warned:
        for factor in (0.5, 2.0):
            bytes_ = np.floor(np.minimum(255.0 * image.linear / (255.0 / factor), 255.0))
            assert bytes_.max() > 100 * factor
            assert (image.expose(factor).pixels == bytes_).all()
    return [str(one.message) for one in warned]


def calls() -> list[bool]:
    """Tell whether the kernel of exposures is called without Numba, for each type of arguments."""
    return [native is not None for native in exposure._expose._native.values()]


def test_healthy_canary_is_silent(image: vtray.Image) -> None:
    assert expose_anew(image) == []
    assert compiled._trusted == [True]
    assert calls() == [True]


def at(name: str, word: int) -> int:
    """Return where a word of a field of the first cage stands among all words."""
    cage, *_ = new_arguments()
    return len(unpack([tuple(cage)[: Cage._fields.index(name)]])[1]) + word


def exchange(one: int, other: int) -> Callable[[pytest.MonkeyPatch], None]:
    """Let two words of the canary be passed each in the place of the other, as a fault."""

    def caller(address: int, layout: Layout) -> NativeCall:
        call = native_call.caller(address, layout)

        def call_wrongly(words: list[Any]) -> object:
            words = words.copy()
            if len(words) == IS_ON + 1:  # others might end the process
                words[one], words[other] = words[other], words[one]
            return call(words)

        return call_wrongly

    return lambda patch: patch.setattr(compiled, "caller", caller)


def misread(change: Callable[[Layout], Layout]) -> Callable[[pytest.MonkeyPatch], None]:
    """Let results be read in another form, as a fault."""
    caller = native_call.caller
    return lambda patch: patch.setattr(
        compiled, "caller", lambda address, layout: caller(address, change(layout))
    )


def backwards(layout: Layout) -> Layout:
    return layout if isinstance(layout, str) else TupleLayout(layout.made_by, layout.items[::-1])


def as_integers(layout: Layout) -> Layout:
    if isinstance(layout, str):
        return layout.replace("f", "i")
    return TupleLayout(layout.made_by, list(map(as_integers, layout.items)))


def fail(error: Exception) -> Callable[..., Any]:
    def failing(*_: object) -> None:
        raise error

    return failing


def without_linker(patch: pytest.MonkeyPatch) -> None:
    """Leave nothing that could load machine code."""
    patch.setattr(object_code, "load", lambda *_: None)
    patch.delattr(llvmlite.binding, "JITLibraryBuilder")


ADDRESS = 4
ECHO = at("bytes_", 7)
WEIGHT, STEP, IS_ON = range(2 * ECHO, 2 * ECHO + 3)

RETURNED = "CanaryError: the canary returned other numbers than in plain Python)"
WROTE = "CanaryError: the canary wrote other numbers than in plain Python)"
FAULTS: dict[str, tuple[Callable[[pytest.MonkeyPatch], object], str]] = {
    "integers": (exchange(at("number", 0), STEP), RETURNED),
    "floats": (exchange(at("deep", 0), WEIGHT), RETURNED),
    "flags": (exchange(at("deep", 8), IS_ON), RETURNED),
    "arrays": (exchange(at("keys", ADDRESS), at("numbers", ADDRESS)), RETURNED),
    "arrays of bytes": (exchange(at("signs", ADDRESS), at("bytes_", ADDRESS)), RETURNED),
    "written arrays": (
        exchange(ECHO + at("keys", ADDRESS), ECHO + at("numbers", ADDRESS)),
        WROTE,
    ),
    "read and written": (exchange(at("keys", ADDRESS), ECHO + at("keys", ADDRESS)), RETURNED),
    "shape": (exchange(at("points", 5), at("points", 6)), RETURNED),
    "size": (exchange(at("cube", 2), at("cube", 3)), RETURNED),
    "results": (misread(backwards), RETURNED),
    "kind of results": (misread(as_integers), RETURNED),
    "status": (
        lambda patch: patch.setattr(native_call, "_SUCCESS", {1}),
        "RuntimeError: a kernel raised an exception: status 0",
    ),
    "linker": (
        lambda patch: patch.setattr(compiled, "link", fail(RuntimeError("no symbol\n_f"))),
        "RuntimeError: no symbol)",
    ),
    "llvmlite": (without_linker, "ImportError: cannot import name 'JITLibraryBuilder'"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_told_once_and_numba_takes_over(
    fault: str, image: vtray.Image, monkeypatch: pytest.MonkeyPatch
) -> None:
    break_calls, reason = FAULTS[fault]
    break_calls(monkeypatch)
    (message,) = expose_anew(image)
    assert message.startswith(MESSAGE + reason)
    for version in (numba.__version__, llvmlite.__version__):
        assert version in message
    assert "\n" not in message
    assert calls() == [False]
    assert compiled._trusted == [False]


def sing_wrongly(cage: Any, echo: Any, weight: Any, step: Any, is_on: Any) -> Any:
    return Song(weight, (step, step, step), ((weight, is_on), step), is_on)


def write_too_much(cage: Any, echo: Any, weight: Any, step: Any, is_on: Any) -> Any:
    song = compiled_sing(cage, echo, weight, step, is_on)
    echo.cube[0, 0, 1] = weight
    return song


compiled_sing = Device(sing)


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("wrong", "reason"),
    [(sing_wrongly, RETURNED), (write_too_much, WROTE)],
    ids=["returns", "writes"],
)
def test_other_machine_code_on_disk_is_noticed(
    wrong: Callable[..., object], reason: str, image: vtray.Image
) -> None:
    arguments = new_arguments()
    types = "".join(unpack(arguments)[0])
    file = object_file(object_name("vtray.base.compiler.canary.sing", types))
    assert file is not None
    write_object_code(file, compile_object(wrong, arguments, {}))
    (message,) = expose_anew(image)
    assert f"({reason}" in message
    assert calls() == [False]


@pytest.mark.usefixtures("folder")
def test_damaged_machine_code_is_compiled_again(image: vtray.Image, tmp_path: Path) -> None:
    for _ in range(2):
        compiled._trusted.clear()
        exposure._expose._native.clear()
        assert expose_anew(image) == []
        assert calls() == [True]
        (file,) = tmp_path.rglob("vtray.base.compiler.canary.*.kernel")
        file.write_bytes(file.read_bytes()[:-100])


def test_single_kernels_that_fail_are_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled._trusted.append(True)
    monkeypatch.setattr(compiled, "link", fail(RuntimeError("no symbol")))
    with pytest.warns(UserWarning, match="without Numba .RuntimeError: no symbol.") as warned:
        assert [Kernel(total)(np.ones(count)) for count in (3, 4)] == [3.0, 4.0]
    assert len(warned) == 1


def test_who_makes_errors_of_warnings_gets_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "link", fail(RuntimeError("no symbol")))
    kernel = Kernel(total)
    with pytest.raises(UserWarning, match="no symbol"):
        kernel(np.ones(3))
    assert kernel(np.ones(3)) == 3.0


@pytest.mark.parametrize("error", [MemoryError(), vtray.RenderError("too little memory")])
def test_lack_of_memory_is_no_fault(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = Kernel(total)
    with monkeypatch.context() as patch:
        patch.setattr(compiled, "link", fail(error))
        with pytest.raises(type(error)):
            kernel(np.ones(3))
    assert kernel(np.ones(3)) == 3.0
    assert compiled._trusted == [True]


def test_threads_wait_for_one_trial(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = []
    compare = canary.compare_with_python

    def slowly(*arguments: Any) -> None:
        compare(*arguments)
        time.sleep(0.05)
        tried.append("tried")

    monkeypatch.setattr(compiled, "compare_with_python", slowly)
    kernel, results, gate = Kernel(total), [], threading.Barrier(4)

    def call() -> None:
        gate.wait()
        results.append((kernel(np.ones(3)), list(tried)))

    threads = [threading.Thread(target=call) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [(3.0, ["tried"])] * 4


def test_canary_reads_and_writes_all_arrays() -> None:
    expected = canary._text(sing(*new_arguments()))
    cage, *rest = new_arguments()
    for array in arrays_in(cage):
        array.flags.writeable = True
        for k in (0, -1):
            before = array.flat[k]
            array.flat[k] = ~before if array.dtype == bool else before + 1
            assert canary._text(sing(cage, *rest)) != expected
            array.flat[k] = before
    echo, same = new_arguments()[1], rest[0]
    assert sum((a != b).any() for a, b in zip(arrays_in(echo), arrays_in(same), strict=True)) == 9


def arrays_in(value: object) -> list[Any]:
    """Return the arrays in tuples."""
    if isinstance(value, tuple):
        return [array for item in value for array in arrays_in(item)]
    return [value] if isinstance(value, np.ndarray) else []


UNCOMPILED = """
import vtray
from vtray.base.compiler import compiled
scene = vtray.Scene()
scene.add_sphere((0, 0, 0), 1)
scene.camera = vtray.Camera.fit(scene, size=(3, 2))
scene.lights = vtray.lights.rembrandt(scene, points=True)
vtray.render(scene)
print(compiled._trusted, compiled.loading_seconds())
"""


def test_nothing_is_tried_without_the_compiler(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    done = subprocess.run(
        [sys.executable, "-W", "ignore::RuntimeWarning", "-c", UNCOMPILED],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1", "VTRAY_CACHE_DIR": str(cache)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "[] 0.0\n", "")
    assert not cache.exists()


def test_settings_of_numba_may_turn_it_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    assert Kernel(total)(np.ones(3)) == 3.0
