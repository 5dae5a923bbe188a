"""What all tests share."""

import gc
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

# Numba makes its messages in colours where Colorama is installed, as for the docs: those of types
# that do not fit, too, which it drops. That takes a twentieth of the time of compiling.
os.environ.setdefault("NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING", "1")

import numba
import pytest
from hypothesis import HealthCheck, settings

from vtray.base.compiler import helpers
from vtray.transport.materials import albedo

JIT = not numba.config.DISABLE_JIT
CONFORMANCE = Path(__file__).parents[2] / "shared" / "conformance"

# The workers that run the tests keep all cores busy.
helpers.MOST = 0

# Without the compiler, each table of what a rough surface mirrors takes half a second, and is as
# good to half a percent with fewer points.
if not JIT:
    albedo.POINTS, albedo.STEP = 233, 144

# What pytest and Numba keep is much, and never dead: looking through it often takes a tenth of all.
gc.set_threshold(50_000, 20, 100)

# The same examples on every run, so that a failure is one that the change caused. Without the
# compiler everything is a hundred times slower: fewer examples then.
settings.register_profile(
    "vtray",
    derandomize=True,
    deadline=None,
    max_examples=150 if JIT else 30,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("vtray")

compiled_only = pytest.mark.skipif(not JIT, reason="needs the compiler")
once = pytest.mark.skipif(not JIT, reason="finds and reaches nothing more without the compiler")
x86_only = pytest.mark.skipif(
    platform.machine() not in {"x86_64", "AMD64"}, reason="looks for instructions of x86-64"
)


def pytest_configure(config: pytest.Config) -> None:
    """Let infinity and NaN pass silently in kernels that run uncompiled, as in compiled ones."""
    if not JIT:
        config.addinivalue_line("filterwarnings", "ignore::RuntimeWarning")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let those tests be among the last that look at what others have left.

    Of two workers, each begins with a half of all; the second, which is done sooner, then takes
    from the end of the first one's.
    """
    last = [item for item in items if item.get_closest_marker("last")]
    others = [item for item in items if not item.get_closest_marker("last")]
    workers = getattr(config, "workerinput", {}).get("workercount")
    place = len(others) // 2 - len(last) if workers == 2 else len(others)
    items[:] = [*others[:place], *last, *others[place:]]


@pytest.fixture
def compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let kernels that the test makes itself be compiled, also where vtray's own are not."""
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)


@pytest.fixture
def vtray_command() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Return a function that runs the installed command as a process."""

    def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
        command = [Path(sys.executable).with_name("vtray"), *map(str, arguments)]
        environment = {k: v for k, v in os.environ.items() if k != "NUMBA_DISABLE_JIT"}
        settings = {"capture_output": True, "text": True, "timeout": 120, "env": environment}
        return subprocess.run(command, check=False, **{**settings, **options})

    return run
