"""Code that is kept is told apart by the processor that it is for."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from llvmlite import binding

from vtray.base.compiler import processor as module
from vtray.base.compiler.processor import processor

TOLD = """\
processor\t: 0
vendor_id\t: GenuineIntel
cpu family\t: 6
model\t\t: 85
model name\t: Xeon: Gold
stepping\t: 7
cpu MHz\t\t: 2100.000
flags\t\t: fpu sse2 avx2

processor\t: 1
vendor_id\t: Another
"""

on_linux = pytest.mark.skipif(
    sys.platform != "linux" or module.os.uname().machine != "x86_64", reason="for Linux on x86-64"
)


@pytest.fixture(autouse=True)
def forgotten() -> Iterator[None]:
    processor.cache_clear()
    yield
    processor.cache_clear()


def told(text: str, folder: Path, patch: pytest.MonkeyPatch) -> str:
    file = folder / "cpuinfo"
    file.write_text(text)
    patch.setattr(module, "CPUINFO", file)
    processor.cache_clear()
    return processor()


@on_linux
def test_what_linux_tells_of_the_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = told(TOLD, tmp_path, monkeypatch)
    assert "fpu sse2 avx2" in usual
    for old, new in [("avx2", "avx512f"), (": 85", ": 86"), ("Gold", "Silver"), (": 7", ": 8")]:
        assert told(TOLD.replace(old, new), tmp_path, monkeypatch) != usual
    for old, new in [("2100", "800"), ("Another", "Other")]:
        assert told(TOLD.replace(old, new), tmp_path, monkeypatch) == usual


@pytest.mark.parametrize(
    "change",
    [
        lambda patch: patch.setattr(binding, "get_host_cpu_name", lambda: "another"),
        lambda patch: patch.setattr(binding, "get_process_triple", lambda: "another"),
        lambda patch: patch.setattr(binding, "get_host_cpu_features", binding.FeatureMap),
    ],
)
@pytest.mark.parametrize("text", ["", TOLD.replace("flags", "Features")])
def test_elsewhere_llvm_tells(
    text: str,
    change: Callable[[pytest.MonkeyPatch], None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    usual = told(text, tmp_path, monkeypatch)
    assert binding.get_host_cpu_name() in usual
    change(monkeypatch)
    processor.cache_clear()
    assert processor() != usual
