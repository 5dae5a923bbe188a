"""Other processes compile parts; whatever happens to them, the caller goes on."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from machine_code import code_in

from conftest import compiled_only, once
from vtray.base.compiler import helpers, parts
from vtray.base.compiler.function_names import full_name
from vtray.base.compiler.object_code import PART_MARK, read_object_code
from vtray.base.signals import INTERRUPTED
from vtray.geometry import edges, stopped

ECHO = "import sys\nfor line in sys.stdin.buffer: print('met', line, '\\ndone', flush=True)"
SLEEP = "import time; time.sleep(60)"

PARTS = {
    "vtray.geometry.packets.nearest.nearest_planes",
    "vtray.geometry.packets.nearest.nearest_slots",
    "vtray.geometry.packets.occlusion.block_by_few",
    "vtray.geometry.packets.occlusion.block_by_slots",
    "vtray.geometry.packets.search.find_blocked",
    "vtray.geometry.packets.search.find_nearest",
    "vtray.transport.camera_rays.cast_rays",
    "vtray.transport.integrators.points.add_points",
    "vtray.transport.interaction.gather_interactions",
    "vtray.transport.sampling.pixel_samples.place_samples",
}

FIRST_PICTURE = """
import hashlib, sys
import vtray as vt
from vtray.base.compiler import helpers, parts

helpers.MOST = int(sys.argv[1])
made, compile_part = [], parts.compile_part
def noting(function, *arguments):
    made.append(function.__name__)
    return compile_part(function, *arguments)
parts.compile_part = noting
scene = vt.Scene()
scene.add_spheres([[0, 0, 0], [1, 0, 0]], 0.5)
scene.lights = [vt.Light((3, -3, 3), 1)]
image = vt.render(scene, size=(32, 32))
print(hashlib.sha256(image.pixels.tobytes()).hexdigest(), *made)
"""


@pytest.fixture
def two_cores(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let one helper be of use, and end it afterwards."""
    monkeypatch.setattr(helpers, "MOST", 1)
    monkeypatch.setattr(helpers, "available_cores", lambda: 2)
    monkeypatch.setattr(helpers, "_asked", {})
    monkeypatch.setattr(helpers, "IDLE_SECONDS", 0.2)
    yield
    wait_until(lambda: not (helpers._at_work or helpers._processes))


def wait_until(is_done: object) -> None:
    """Wait until a function says so."""
    end = time.monotonic() + 20
    while not is_done():  # type: ignore[operator]
        assert time.monotonic() < end
        time.sleep(0.01)


def code_of_parts(home: Path) -> dict[str, bytes]:
    """Return the machine code of each part that is kept."""
    files = [each for each in home.glob("*/*.kernel") if each.name.split("-")[0] in PARTS]
    kept = {each.name: read_object_code(each) for each in files}
    return {name: code_in(each.code) for name, each in kept.items() if each}


def ask(*names: str) -> list[bytes]:
    """Ask for parts; return what helpers tell by the time that all are done."""
    told: list[bytes] = []
    for name in names:
        helpers.ask(name, f"{name}\n".encode(), told.append)
    for name in names:
        wait_until(lambda name=name: helpers._asked[name].done())
        helpers.leave_to_caller(name)
    return told


@pytest.mark.usefixtures("two_cores")
def test_orders_are_handed_over_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "_PROGRAM", ECHO)
    assert ask("one", "two") == [b"met b'one\\n' \n", b"met b'two\\n' \n"]
    assert ask("two") == []  # only once
    wait_until(lambda: not helpers._at_work)
    assert ask("three") == [b"met b'three\\n' \n"]


def ask_for_one_that_waits(monkeypatch: pytest.MonkeyPatch) -> tuple[list[bytes], threading.Event]:
    """Let the helper be at work until an event; return what it tells, and that event."""
    told, go_on = list[bytes](), threading.Event()
    monkeypatch.setattr(helpers, "_PROGRAM", ECHO)

    def wait_and_tell(line: bytes) -> None:
        assert go_on.wait(20)
        told.append(line)

    helpers.ask("one", b"one\n", wait_and_tell)
    wait_until(helpers._asked["one"].running)
    return told, go_on


@pytest.mark.usefixtures("two_cores")
def test_what_takes_long_is_begun_first(monkeypatch: pytest.MonkeyPatch) -> None:
    # The first is at work until all others have been asked for.
    told, go_on = ask_for_one_that_waits(monkeypatch)
    for name in ("two", "long", "three", "longer"):
        helpers.ask(name, f"{name}\n".encode(), told.append, is_long=name.startswith("long"))
    go_on.set()
    wait_until(lambda: all(each.done() for each in helpers._asked.values()))
    names = [line.split(b"'")[1].decode().removesuffix("\\n") for line in told]
    assert names == ["one", "long", "longer", "two", "three"]


@pytest.mark.usefixtures("two_cores")
def test_who_waits_for_one_takes_others(monkeypatch: pytest.MonkeyPatch) -> None:
    told, go_on = ask_for_one_that_waits(monkeypatch)
    assert helpers.wait_for("nothing") is None
    for name in ("two", "three", "four"):
        helpers.ask(name, f"{name}\n".encode(), told.append)
    helpers.leave_to_caller("three")
    assert [helpers.wait_for("one") for _ in range(2)] == ["two", "four"]
    threading.Timer(0.2, go_on.set).start()
    assert helpers.wait_for("one") is None
    assert told == [b"met b'one\\n' \n"]


@compiled_only
def test_parts_that_take_long_are_known_by_name() -> None:
    for function, is_long in ((stopped.stop_rays, True), (edges.has_edge, False)):
        assert parts._is_long(f"{full_name(function)}{PART_MARK}0123456789abcdef") == is_long


@once
@pytest.mark.usefixtures("two_cores")
@pytest.mark.parametrize("program", ["raise SystemExit(1)", "print('nonsense')", "syntax error"])
def test_one_that_fails_leaves_the_part_to_the_caller(
    program: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(helpers, "_PROGRAM", program)
    assert ask("one", "two") in ([], [b"nonsense\n"])


@pytest.mark.usefixtures("two_cores")
def test_nothing_is_lost_by_an_answer_that_cannot_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(line: bytes) -> None:
        raise ValueError(line)

    monkeypatch.setattr(helpers, "_PROGRAM", ECHO)
    helpers.ask("one", b"one\n", fail)
    helpers.leave_to_caller("one")
    assert ask("two") == [b"met b'two\\n' \n"]


@pytest.mark.usefixtures("two_cores")
def test_one_that_is_killed_leaves_the_part_to_the_caller(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "_PROGRAM", SLEEP)
    helpers.ask("one", b"one\n", print)
    helpers.ask("two", b"two\n", print)
    wait_until(lambda: helpers.is_at_work_on("one"))
    helpers.leave_to_caller("two")  # at once: nobody has begun
    assert not helpers.is_at_work_on("two")
    (process,) = helpers._processes
    process.kill()
    helpers.leave_to_caller("one")
    assert not helpers.is_at_work_on("one")


@pytest.mark.usefixtures("two_cores")
@pytest.mark.parametrize(
    ("name", "value"),
    [("lack_of_memory", lambda _: "all of it"), ("available_cores", lambda: 1)],
)
def test_none_is_started_where_it_is_of_no_use(
    name: str, value: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(helpers, name, value)
    helpers.ask("one", b"one\n", print)
    helpers.leave_to_caller("one")
    assert not helpers._processes


@pytest.mark.usefixtures("two_cores")
def test_python_that_cannot_be_started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "executable", str(tmp_path / "gone"))
    assert ask("one") == []


ASKING = f"""
import time
from vtray.base.compiler import helpers
helpers.available_cores = lambda: 2
helpers._PROGRAM = {SLEEP!r}
helpers.ask('one', b'one', print)
while not helpers._processes: time.sleep(0.01)
print(*(each.pid for each in helpers._processes), flush=True)
"""

INTERRUPT = """
import signal
from vtray.base.signals import leave_on_signals
leave_on_signals()
signal.raise_signal(signal.SIGINT)
"""


def test_none_outlives_who_asked() -> None:
    command = [sys.executable, "-c", ASKING]
    ended = subprocess.run(command, capture_output=True, check=True, timeout=20)
    assert not ended.stderr
    with pytest.raises(ProcessLookupError):
        os.kill(int(ended.stdout), signal.SIG_DFL)


def test_none_outlives_who_was_interrupted() -> None:
    command = [sys.executable, "-c", ASKING + INTERRUPT]
    ended = subprocess.run(command, capture_output=True, check=False, timeout=20)
    assert (ended.returncode, ended.stderr) == (INTERRUPTED, b"")
    wait_until(lambda: not is_alive(int(ended.stdout)))


def is_alive(process: int) -> bool:
    """Tell whether a process has not ended; one that nobody has waited for yet has."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@compiled_only
def test_parts_are_the_same_whoever_compiles_them(tmp_path: Path) -> None:
    answers, kernels = [], []
    for most in (0, 1):
        home = tmp_path / str(most)
        environment = {**os.environ, "VTRAY_CACHE_DIR": str(home)}
        ended = subprocess.run(
            [sys.executable, "-c", FIRST_PICTURE, str(most)],
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
            env=environment,
        )
        assert not ended.stderr
        answers.append(ended.stdout.split())
        kernels.append(code_of_parts(home))
    (alone, *all_parts), (helped, *own_parts) = answers
    assert alone == helped
    assert len(own_parts) < len(all_parts) == len(PARTS)
    assert kernels[0] == kernels[1]
