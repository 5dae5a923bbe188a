"""How long vtray takes before it does any work."""

import json
import os
import sys
from pathlib import Path

from scenes.few_objects import small
from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved

SMALL = 256


def time_startup(folder: Path, repeats: int) -> dict[str, Timing]:
    """Time what costs the same for every scene; the inner seconds are those of compiling."""
    scene, bad, picture = folder / "small.json", folder / "bad.json", folder / "small.png"
    scene.write_text(json.dumps(small(SMALL)))
    bad.write_text(json.dumps({**small(SMALL), "lights": [{"intensity": -1}]}))
    environment = {**os.environ, "VTRAY_CACHE_DIR": str(folder / "fresh-cache")}

    def render(name: str) -> Job:
        command = vtray_process.command(scene, picture, 1)
        return Job(name, command, vtray_process.compile_seconds, environment=environment)

    first = run_interleaved([render("the first render ever")], 1)
    jobs = [
        Job("Python alone, `python -c pass`", [sys.executable, "-c", "pass"]),
        Job("`vtray --help`", [*vtray_process.executable(), "--help"]),
        Job(
            "a scene with a mistake",
            [*vtray_process.executable(), str(bad), str(picture)],
            status=1,
        ),
        render(f"a render of one sphere, {SMALL} x {SMALL}"),
    ]
    return run_interleaved(jobs, repeats) | first
