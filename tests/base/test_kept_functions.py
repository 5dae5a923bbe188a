"""What Numba has made of device functions serves later processes, and only where it fits."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import compiled_only

FUNCTIONS = """
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device, kernel, part, seldom


class Verbs(NamedTuple):
    change: Any
    join: Any


def _halved(x):
    return 0.5 * x


halved, halved_apart = device(_halved), seldom(_halved)


@device
def square(x):
    return x * x


@device
def larger(x, y):
    return max(x, y)


@device
def verbs():
    return Verbs(square, larger)


@device
def changed(verbs, x):
    return verbs.change(x)


@part
def largest(values: Any) -> float:
    found = 0.0
    for k in range(values.size):
        found = larger(found, changed(verbs(), values[k]))
    return found


@device
def with_part(values):
    return largest(values) + halved(values[0]) + halved_apart(values[1])


@kernel
def measure(values):
    return larger(with_part(values), 1.0)
"""

RUN = """
import json, sys
import numpy as np
import {package}
{package}.__path__.append({folder!r})
from vtray.base.compiler import kept_functions, parts
from {package}.measures import measure

found, missing, made = [], [], []

class Watched(kept_functions.KeptFunctions):
    def load_overload(self, sig, target_context):
        kept = super().load_overload(sig, target_context)
        (found if kept else missing).append(self._function.__name__)
        return kept

kept_functions.KeptFunctions = Watched
compile_part = parts.compile_part
def watched(function, *arguments):
    made.append(function.__name__)
    return compile_part(function, *arguments)
parts.compile_part = watched
result = measure(np.array([1.0, 5.0, 2.0]))
print(json.dumps([result, found, missing, made]))
"""

RESULT = 25.0 + 0.5 + 2.5
DEVICES = ["_halved", "changed", "larger", "square", "verbs", "with_part"]

pytestmark = compiled_only


class Runs:
    """Processes that call a kernel, and their folder."""

    def __init__(self, folder: Path, package: str = "vtray") -> None:
        self.kept = folder / "kept"
        self._script = RUN.format(package=package, folder=str(folder))
        (folder / "measures.py").write_text(FUNCTIONS)

    def run(self) -> tuple[list[str], list[str], list[str]]:
        """Return what was found on disk, what was missing there, and the parts compiled."""
        environment = {**os.environ, "VTRAY_CACHE_DIR": str(self.kept)}
        command = [sys.executable, "-W", "error", "-c", self._script]
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, timeout=120
        )
        assert done.returncode == 0, done.stderr
        result, found, missing, made = json.loads(done.stdout)
        assert result == RESULT
        return sorted(set(found)), sorted(set(missing)), made

    def files(self, name: str) -> list[Path]:
        """Return the files of a function, at least one."""
        files = [*self.kept.glob(f"kernels-*/vtray.measures.{name}-*.kernel")]
        assert files
        return files

    def remove(self, name: str) -> None:
        """Remove what is kept of a function."""
        for file in self.files(name):
            file.unlink()


@pytest.fixture(scope="module")
def first_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a first run, which has compiled everything."""
    folder = tmp_path_factory.mktemp("first")
    assert Runs(folder).run() == ([], DEVICES, ["largest"])
    return folder


@pytest.fixture
def runs(tmp_path: Path, first_run: Path) -> Runs:
    """Return runs after a first one."""
    shutil.copytree(first_run, tmp_path, dirs_exist_ok=True)
    return Runs(tmp_path)


def test_nothing_but_the_kernel_is_compiled_again(runs: Runs) -> None:
    runs.remove("measure")
    assert runs.run() == (["larger", "with_part"], [], [])
    runs.files("measure")


def test_a_part_is_made_by_what_is_kept_of_its_callers(runs: Runs) -> None:
    runs.remove("measure")
    runs.remove("largest")
    assert runs.run() == (["changed", "larger", "verbs", "with_part"], [], ["largest"])
    runs.files("largest")


def test_a_kernel_on_disk_needs_no_functions(runs: Runs) -> None:
    for name in DEVICES:
        runs.remove(name)
    assert runs.run() == ([], [], [])


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: content[:-1],
        lambda content: content[:300] + bytes([content[300] ^ 1]) + content[301:],
    ],
)
def test_damaged_ones_are_compiled_anew(runs: Runs, damage: Callable[[bytes], bytes]) -> None:
    runs.remove("measure")
    for file in runs.files("larger"):
        file.write_bytes(damage(file.read_bytes()))
    found, missing, _ = runs.run()
    assert (found, missing) == (["with_part"], ["larger"])
    runs.remove("measure")
    assert runs.run() == (["larger", "with_part"], [], [])


def test_what_calls_a_missing_one_is_compiled_anew(runs: Runs) -> None:
    runs.remove("measure")
    runs.remove("_halved")
    found, missing, _ = runs.run()
    assert (found, missing) == (["larger"], ["_halved", "with_part"])


def test_functions_of_others_are_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    package = tmp_path / "others"
    package.mkdir()
    (package / "__init__.py").touch()
    runs = Runs(tmp_path, "others")
    found, missing, _ = runs.run()
    assert (found, missing) == ([], DEVICES)
    assert not [*runs.kept.glob("kernels-*/*measures*")]
