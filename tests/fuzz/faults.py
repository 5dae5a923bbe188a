"""Signals and limits at random moments: the whole picture, or what was there before."""

import json
import os
import resource
import signal
import subprocess
import sys
import time
from functools import cache
from pathlib import Path
from random import Random

from examples import light, scene, sphere

from fuzz.promises import check_printed

# Tells when the first line has run: before that, Python itself is in charge.
COMMAND = """
import sys
from vtray.base.signals import leave_on_signals
leave_on_signals()
sys.__stdout__.write("begun\\n")
sys.__stdout__.flush()
from vtray.__main__ import main
main()
"""

SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: -15, signal.SIGHUP: -1, signal.SIGKILL: -9}

LIMITS = {
    resource.RLIMIT_FSIZE: (0, 300_000),
    resource.RLIMIT_NOFILE: (3, 40),
    resource.RLIMIT_AS: (30_000_000, 2_000_000_000),
}


def attempt(random: Random, folder: Path) -> None:
    """Render a picture over an old one, and have something happen on the way."""
    file, picture = folder / "scene.json", folder / "picture.png"
    file.write_text(json.dumps(_document()))
    picture.write_bytes(b"precious")
    number = random.choice([None, *SIGNALS])
    limit = random.choice(list(LIMITS)) if number is None else None
    most = random.randint(*LIMITS[limit]) if limit is not None else 0
    (folder / "fault.txt").write_text(f"signal {number}, limit {limit} to {most}")

    def restrict() -> None:
        if limit is not None:
            resource.setrlimit(limit, (most, most))

    process = subprocess.Popen(
        [sys.executable, "-c", COMMAND, "-t", "2", file, picture],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=restrict,  # noqa: PLW1509 - there are no threads here
        env={k: v for k, v in os.environ.items() if k != "NUMBA_DISABLE_JIT"},
    )
    assert process.stdout is not None
    begun = process.stdout.readline()
    if number is not None:
        time.sleep(random.uniform(0, 0.5))
        process.send_signal(number)
    _, err = process.communicate(timeout=120)
    if not begun and limit is not None:
        return  # not even Python itself could start
    left = {item.name for item in folder.iterdir()} - {"scene.json", "picture.png", "fault.txt"}
    if process.returncode in (0, 1):
        check_printed(process.returncode, err.decode())
    else:
        assert (process.returncode, err) == (SIGNALS.get(number), b"")
    assert not left or number == signal.SIGKILL, left
    expected = {0: _whole_picture()}.get(process.returncode, b"precious")
    # A signal may also come when all is done.
    assert picture.read_bytes() in (expected, *[_whole_picture()] * (number is not None))


def _document() -> dict:
    """Return a scene that takes some time."""
    balls = [sphere((k % 20 - 10, k // 20 - 5, 9), 0.45) for k in range(200)]
    lights = [light(k, -9, 0, intensity=0.1) for k in range(8)]
    return scene(balls, lights, size=[400, 300], resolution=[0.02, 0.02])


@cache
def _whole_picture() -> bytes:
    """Return the picture as it is without any fault."""
    import tempfile

    import vtray

    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        vtray.render(vtray.loads(json.dumps(_document()))).save(picture)
        return picture.read_bytes()
