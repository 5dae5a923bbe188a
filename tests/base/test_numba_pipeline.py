"""Kernels are compiled to machine code as a whole, and nothing before them."""

from typing import Any

import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary

from vtray.base.compiler.compiled import Device, Kernel

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
