"""Kernels are compiled to machine code as a whole, and nothing before them."""

from typing import Any

import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary

from vtray.base.compiler import compiled
from vtray.base.compiler.compiled import Device, Kernel, Seldom
from vtray.base.compiler.numba_pipeline import DeviceLibrary, KernelLibrary

pytestmark = pytest.mark.usefixtures("compiler")


def half(x: Any) -> Any:
    return 0.5 * x


def quarter(x: Any) -> Any:
    return half_compiled(half_compiled(x))


def quarters(numbers: Any) -> Any:
    total = 0.0
    for k in range(numbers.size):
        total += quarter_compiled(numbers[k])
    return total


half_compiled, quarter_compiled = Device(half), Device(quarter)


def test_device_functions_have_no_machine_code(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    make = JITCodeLibrary._finalize_specific

    def spy(library: JITCodeLibrary) -> None:
        made.append(library.name)
        make(library)

    monkeypatch.setattr(JITCodeLibrary, "_finalize_specific", spy)
    kernel = Kernel(quarters)
    assert kernel(np.array([4.0, 8.0])) == 3.0
    assert set(made) <= {"nrt"}  # Numba's own
    assert None not in kernel._native.values()


def test_device_functions_are_optimized_in_kernels_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    optimized: list[str] = []
    optimize = JITCodeLibrary._optimize_final_module

    def spy(library: JITCodeLibrary) -> None:
        optimized.append(type(library).__name__)
        optimize(library)

    monkeypatch.setattr(JITCodeLibrary, "_optimize_final_module", spy)
    doubled = Device(lambda x: 2.0 * x)
    assert Kernel(lambda x: doubled(doubled(x)))(0.5) == 2.0
    assert "DeviceLibrary" not in optimized
    assert optimized.count("KernelLibrary") == 1


def test_what_is_seldom_called_stays_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[int] = []
    optimize = JITCodeLibrary._optimize_final_module

    def spy(library: JITCodeLibrary) -> None:
        optimize(library)
        if isinstance(library, KernelLibrary):
            functions = library._final_module.functions
            left.append(sum(not function.is_declaration for function in functions))

    monkeypatch.setattr(JITCodeLibrary, "_optimize_final_module", spy)
    apart = Seldom(lambda x: 0.5 * half_compiled(x))
    often = Device(lambda x: apart(x) + 1.0)
    kernel = Kernel(lambda x: often(x) + apart(x))
    assert kernel(2.0) == 2.0
    assert left == [2]  # the kernel, and what it calls twice
    assert None not in kernel._native.values()


def test_what_is_seldom_called_works_through_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "_trusted", [False])
    apart = Seldom(lambda x: 0.5 * half_compiled(x))
    often = Device(lambda x: apart(x) + 1.0)
    kernel = Kernel(lambda x: often(x) + apart(x))
    assert kernel(2.0) == 2.0
    assert set(kernel._native.values()) == {None}


def test_kernels_take_each_device_function_once(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[object] = []
    take = JITCodeLibrary._get_module_for_linking

    def spy(library: JITCodeLibrary) -> object:
        if isinstance(library, DeviceLibrary):  # the others are Numba's own
            taken.append(library)
        return take(library)

    monkeypatch.setattr(JITCodeLibrary, "_get_module_for_linking", spy)
    below = Device(lambda x: x - 1.0)
    left, right = Device(lambda x: 2.0 * below(x)), Device(lambda x: 3.0 * below(x))
    assert Kernel(lambda x: left(x) + right(x))(3.0) == 10.0
    assert len(taken) == len(set(taken)) == 3
