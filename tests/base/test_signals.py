"""A command that is told to end does so at once, silently, and leaves nothing behind."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from examples import one_sphere, xyz

from vtray.base.atomic_file import write_whole

HALF = """
import os, signal, sys, time
from pathlib import Path
from vtray.base.atomic_file import write_whole
from vtray.base.signals import leave_on_signals

leave_on_signals()

def write(file):
    file.write(b"half")
    file.flush()
    os.kill(os.getpid(), {number})
    time.sleep(9)

write_whole(Path(sys.argv[1]), write)
"""

KERNEL = """
import os, signal, sys, time
from pathlib import Path
from vtray.base.own_files import write_own
from vtray.base.signals import leave_on_signals

leave_on_signals()

def replace(*_):
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(9)

os.replace = replace
write_own(Path(sys.argv[1]), b"code")
"""

NEW = """
import os, signal, sys, threading, time
from pathlib import Path
from vtray.base.{module} import {write}
from vtray.base.signals import leave_on_signals

leave_on_signals()
made, usual, waiting = threading.Event(), os.open, threading.Event()

def tell():
    made.wait()
    signal.raise_signal(signal.SIGTERM)  # this thread gets it, to whom it is not blocked
    waiting.set()

def opened(path, flags, *rest, **named):
    found = usual(path, flags, *rest, **named)
    if flags & os.O_CREAT:
        if {is_elsewhere}:
            made.set()
            waiting.wait()
        else:
            os.kill(os.getpid(), signal.SIGTERM)
        for _ in range(1000):
            pass
    return found

if {is_elsewhere}:
    threading.Thread(target=tell, daemon=True).start()
import fcntl, tempfile
os.open = opened
{write}(Path(sys.argv[1]), {content})
"""

AT_AN_IMPORT = """
import builtins, os, signal, sys

usual, count = builtins.__import__, 0

def interrupted(*arguments, **options):
    global count
    count += 1
    if count == {count}:
        os.kill(os.getpid(), signal.SIGINT)
    return usual(*arguments, **options)

import vtray.__main__
sys.argv = ["vtray", *sys.argv[1:]]
builtins.__import__ = interrupted
{call}
"""


def run(code: str, *arguments: object) -> "subprocess.CompletedProcess[bytes]":
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, check=False, timeout=60)


@pytest.mark.parametrize("count", [2, 3, 40, 200, 400])
@pytest.mark.parametrize("call", ["vtray.__main__.main()", "vtray.__main__.diff()"])
def test_interrupt_while_python_imports(call: str, count: int, tmp_path: Path) -> None:
    done = run(AT_AN_IMPORT.format(count=count, call=call), tmp_path / "a.json", tmp_path / "a.png")
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


def test_interrupt_in_the_middle_of_a_decoder(tmp_path: Path) -> None:
    # The decoder calls Python where a camera looks at `up`; there signals come through.
    code = AT_AN_IMPORT.format(count=0, call="") + (
        "import vtray.scene.camera\n"
        "vtray.scene.camera.unit = lambda _: os.kill(os.getpid(), signal.SIGINT)\n"
        "vtray.__main__.main()\n"
    )
    scene = tmp_path / "scene.json"
    document = one_sphere()
    document["camera"]["up"] = xyz(0, 1, 0)
    scene.write_text(json.dumps(document))
    done = run(code, scene, tmp_path / "a.png")
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


@pytest.mark.parametrize(("name", "status"), [("SIGINT", 130), ("SIGTERM", -15), ("SIGHUP", -1)])
def test_nothing_is_left_of_a_file_half_written(name: str, status: int, tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"precious")
    number = int(getattr(signal, name))
    done = run(HALF.format(number=number), path)
    assert (done.returncode, done.stdout, done.stderr) == (status, b"", b"")
    assert [item.name for item in tmp_path.iterdir()] == ["a.png"]
    assert path.read_bytes() == b"precious"


@pytest.mark.parametrize("is_elsewhere", [False, True])
@pytest.mark.parametrize(
    ("module", "write", "content"),
    [("atomic_file", "write_whole", "time.sleep"), ("own_files", "write_own", "b'code'")],
)
def test_nothing_is_left_of_a_file_just_made(
    module: str, write: str, content: str, is_elsewhere: bool, tmp_path: Path
) -> None:
    code = NEW.format(module=module, write=write, content=content, is_elsewhere=is_elsewhere)
    done = run(code, tmp_path / "a")
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGTERM, b"", b"")
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_left_of_a_kernel_half_written(tmp_path: Path) -> None:
    done = run(KERNEL, tmp_path / "a.kernel")
    assert (done.returncode, done.stderr) == (-signal.SIGTERM, b"")
    assert list(tmp_path.iterdir()) == []


def test_what_is_to_be_ignored_is_ignored(tmp_path: Path) -> None:
    code = "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n" + HALF
    done = run(
        code.format(number=int(signal.SIGHUP)).replace("sleep(9)", "sleep(0)"), tmp_path / "a"
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert (tmp_path / "a").read_bytes() == b"half"


def test_what_a_killed_process_has_left_is_taken_over(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    done = run(HALF.format(number=int(signal.SIGKILL)), path)
    assert done.returncode == -signal.SIGKILL
    (left,) = tmp_path.iterdir()
    assert left.name.startswith(".vtray-")
    os.link(left, tmp_path / "other")  # no longer a file of vtray's alone: not to be touched
    write_whole(path, lambda file: file.write(b"first"))
    assert (tmp_path / "other").read_bytes() == b"half"
    (tmp_path / "other").unlink()
    write_whole(path, lambda file: file.write(b"whole"))
    assert [item.name for item in tmp_path.iterdir()] == ["a.png"]
    assert path.read_bytes() == b"whole"


POSTPONED = """
import os, signal, sys
from vtray.base.signals import Postponed, end_by, leave_on_signals

leave_on_signals()
with Postponed() as told:
    for _ in range({times}):
        os.kill(os.getpid(), signal.SIGTERM)
    print(told.number == signal.SIGTERM, flush=True)
{after}
"""


@pytest.mark.parametrize(
    ("times", "after", "status", "printed"),
    [
        (1, "sys.exit(3)", 3, b"True\n"),
        (1, "end_by(told.number)", -15, b"True\n"),
        (1, "end_by(signal.SIGINT)", 130, b"True\n"),
        (2, "", -15, b""),
        (1, "os.kill(os.getpid(), signal.SIGTERM)", -15, b"True\n"),
    ],
)
def test_first_signal_that_is_postponed(
    times: int, after: str, status: int, printed: bytes
) -> None:
    done = run(POSTPONED.format(times=times, after=after))
    assert (done.returncode, done.stdout, done.stderr) == (status, printed, b"")
