"""Parts of kernels are compiled once, kept on disk on their own, and shared."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import once
from vtray.base.compiler import compiled, helpers, object_code, parts
from vtray.base.compiler.compiled import Device, Kernel, Part, compile_ahead, was_compiled
from vtray.base.compiler.elf_loader import IS_KNOWN
from vtray.base.compiler.native_call import UnsupportedError

pytestmark = pytest.mark.usefixtures("compiler", "forgotten")


def add_up(numbers: Any, weights: tuple[Any, float], is_on: bool) -> float:
    total = 0.0
    for k in range(numbers.size):
        total += numbers[k] * weights[0][k] * weights[1]
    return total if is_on else -total


def clear(numbers: Any) -> None:
    numbers[0] = 0.0


def check(number: int) -> int:
    if number < 0:
        raise ValueError
    return number


def through_a_device_function(numbers: Any, weights: Any, is_on: Any) -> Any:
    return add_up_apart(numbers, weights, is_on)


def scaled(numbers: Any, weights: Any, is_on: Any, factor: Any) -> Any:
    total = factor * between(numbers, weights, is_on)
    clear_apart(numbers)
    return total


def unscaled(numbers: Any, weights: Any, is_on: Any) -> Any:
    return add_up_apart(numbers, weights, is_on)


def checked(number: Any) -> Any:
    return check_apart(number) + 1


# Only what is vtray's own is kept on disk.
for own in (add_up, clear, scaled, unscaled):
    own.__module__ = "vtray.tests"

add_up_apart, clear_apart, check_apart = Part(add_up), Part(clear), Part(check)
between = Device(through_a_device_function)

NUMBERS, WEIGHTS = np.array([1.0, 2.0, 4.0]), (np.array([1.0, 0.5, 0.25]), 2.0)


def two_kernels() -> tuple[Kernel, Kernel]:
    """Return two kernels that have a part in common, as a new process would."""
    parts._addresses.clear()
    parts._unkept.clear()
    return Kernel(scaled), Kernel(unscaled)


def use(kernels: tuple[Kernel, Kernel]) -> None:
    """See that two kernels do what they should, and without Numba."""
    first, second = kernels
    numbers = NUMBERS.copy()
    assert (first(numbers, WEIGHTS, True, 10.0), numbers[0]) == (60.0, 0.0)
    assert second(NUMBERS, WEIGHTS, False) == -6.0
    assert None not in [*first._native.values(), *second._native.values()]


@pytest.fixture
def forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let parts be kept in a folder of the test, and what is in memory be forgotten."""
    tmp_path.chmod(0o700)
    (tmp_path / "kernels").mkdir(mode=0o700)
    monkeypatch.setattr(object_code, "cache_folder", lambda: tmp_path / "kernels")
    monkeypatch.setattr(parts, "_addresses", {})
    monkeypatch.setattr(compiled, "_trusted", [True])


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the names of what is compiled."""
    names: list[str] = []

    def spy(make: Callable[..., Any]) -> Callable[..., Any]:
        def noting(function: Any, *arguments: Any) -> Any:
            names.append(function.__name__)
            return make(function, *arguments)

        return noting

    monkeypatch.setattr(compiled, "compile_object", spy(compiled.compile_object))
    monkeypatch.setattr(parts, "compile_part", spy(parts.compile_part))
    return names


@pytest.mark.parametrize("linker", ["vtray's", "LLVM's"])
def test_kernels_share_a_part(
    linker: str, made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    other = "_link" if linker == "vtray's" else "load"
    if IS_KNOWN:
        monkeypatch.setattr(object_code, other, lambda *_: None)
    use(two_kernels())
    assert sorted(made) == ["add_up", "clear", "scaled", "unscaled"]
    made.clear()
    use(two_kernels())
    assert made == []


def test_ahead_only_the_kernel_is_compiled(
    made: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path / "kernels")
    first, second = kernels = two_kernels()
    arguments = NUMBERS.copy(), WEIGHTS, True, 10.0
    assert not was_compiled(first)
    for _ in range(2):
        compile_ahead(first, *arguments)
        assert (made, list(tmp_path.glob("kernels/*.kernel"))) == (["scaled"], [])
    use(kernels)
    assert sorted(made) == ["add_up", "clear", "scaled", "unscaled"]
    assert was_compiled(first)
    assert was_compiled(second)
    # What is loaded, or on disk, is not compiled again; what cannot be kept is not begun.
    compile_ahead(first, *arguments)
    compile_ahead(two_kernels()[0], *arguments)
    monkeypatch.setattr(object_code, "cache_folder", lambda: None)
    compile_ahead(two_kernels()[0], *arguments)
    compile_ahead(two_kernels()[0], "no number")
    assert len(made) == 4


def test_while_another_process_is_at_a_part_others_are_made(
    made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process is at what clears, which comes to nothing, while the other part waits twice."""

    def wait_for(name: str) -> str | None:
        return waiting.pop() if name.startswith("vtray.tests.clear") and waiting else None

    first, _ = kernels = two_kernels()
    compile_ahead(first, NUMBERS.copy(), WEIGHTS, True, 10.0)
    waiting = [name for name in parts._origins if name.startswith("vtray.tests.add_up")] * 2
    monkeypatch.setattr(helpers, "is_at_work_on", lambda name: "add_up" in name)
    monkeypatch.setattr(helpers, "wait_for", wait_for)
    use(kernels)
    assert made == ["scaled", "add_up", "clear", "unscaled"]


def test_what_fails_ahead_is_told_by_the_call(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ValueError

    monkeypatch.setattr(compiled, "compile_object", fail)
    first, _ = two_kernels()
    compile_ahead(first, NUMBERS.copy(), WEIGHTS, True, 10.0)
    assert first._ahead == {}


def test_new_kernel_finds_the_part_of_another(made: list[str], tmp_path: Path) -> None:
    use(two_kernels())
    for file in tmp_path.rglob("vtray.tests.*scaled-*.kernel"):
        file.unlink()
    made.clear()
    use(two_kernels())
    assert made == ["scaled", "unscaled"]


@pytest.mark.parametrize("damage", [Path.unlink, lambda file: file.write_bytes(b"damaged")])
def test_part_that_is_lost_is_compiled_again(
    damage: Callable[[Path], object], made: list[str], tmp_path: Path
) -> None:
    use(two_kernels())
    (file,) = tmp_path.rglob("vtray.tests.add_up-*.kernel")
    damage(file)
    made.clear()
    use(two_kernels())
    # The compiler alone knows for which types: it has to see a kernel that calls the part.
    assert made == ["scaled", "add_up"]


def test_other_types_are_another_part(made: list[str]) -> None:
    kernel = Kernel(unscaled)
    singles = NUMBERS.astype(np.float32)
    assert kernel(NUMBERS, WEIGHTS, True) == kernel(singles, WEIGHTS, True) == 6.0
    assert made == ["unscaled", "add_up"] * 2


def test_where_nothing_is_kept(made: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_code, "cache_folder", lambda: None)
    use(two_kernels())
    use(two_kernels())
    assert sorted(made) == sorted(["add_up", "clear", "scaled", "unscaled"] * 2)


@once
def test_numba_compiles_a_part_as_any_function(monkeypatch: pytest.MonkeyPatch) -> None:
    use(two_kernels())  # so that device functions are compiled that call parts by their names

    def refuse(*_: object) -> None:
        raise UnsupportedError

    monkeypatch.setattr(compiled, "link", refuse)
    monkeypatch.setattr("vtray.base.compiler.canary._warned", [])
    kernel = Kernel(scaled)
    with pytest.warns(UserWarning, match="kernels cannot be called without Numba"):
        assert kernel(NUMBERS.copy(), WEIGHTS, True, 10.0) == 60.0
    assert list(kernel._native.values()) == [None]
    assert between(NUMBERS, WEIGHTS, True) == add_up_apart(NUMBERS, WEIGHTS, True) == 6.0


def test_exception_in_a_part_ends_the_kernel() -> None:
    kernel = Kernel(checked)
    assert kernel(1) == 2
    with pytest.raises(RuntimeError, match="a kernel raised an exception: status"):
        kernel(-1)
