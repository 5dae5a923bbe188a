"""Measure vtray, beside other renderers where they are installed.

    python benchmarks/run.py [--quick] [--only NAME]

Writes benchmarks/results.md and the table in README.md; a partial run only prints.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import startup
from machine import cores, machine
from rendering import time_scene, time_threads
from report import Results, full_report, replace_between_markers, summary
from scenes import SCENES

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results.md"
README = HERE.parent / "README.md"
PARTS = ("startup", *SCENES, "threads")
REPEATS, QUICK_REPEATS = 5, 2
QUICK_SIDE = 256


def main() -> None:
    """Measure what was asked for; print it, and keep it if it is all."""
    options = _parse()
    with tempfile.TemporaryDirectory(prefix="vtray-benchmark-") as folder:
        # Kernels compiled here neither help nor disturb the user's own.
        cache = Path(folder) / "cache"
        os.environ["VTRAY_CACHE_DIR"] = str(cache)
        results = measure(Path(folder), options.only or list(PARTS), quick=options.quick)
        versions = len(list(cache.glob("*")))
    report = full_report(results)
    print(report)
    if versions > 1:
        sys.exit("Error: vtray's sources changed during the run; nothing is written, run it again")
    if options.quick or options.only:
        return
    RESULTS.write_text(report, encoding="utf-8")
    if README.exists():
        text = README.read_text(encoding="utf-8")
        README.write_text(replace_between_markers(text, summary(results)), encoding="utf-8")


def measure(folder: Path, parts: list[str], *, quick: bool) -> Results:
    """Measure the parts that are named."""
    repeats = QUICK_REPEATS if quick else REPEATS
    results = Results(machine(), repeats)
    if "startup" in parts:
        _say("start-up")
        results.startup = startup.time_startup(folder, repeats)
    for name, (description, make, full_side) in SCENES.items():
        if name in parts:
            _say(description)
            side = min(full_side, QUICK_SIDE) if quick else full_side
            title = f"{description}, {side} x {side}"
            results.scenes[title] = time_scene(make(side), folder, repeats)
    if "threads" in parts:
        _say("threads")
        _, make, full_side = SCENES["room"]
        counts = [count for count in (1, 2, 4, 8, 16) if count <= max(cores(), 2)]
        scene = make(QUICK_SIDE if quick else full_side)
        timings = time_threads(scene, folder, counts, repeats)
        results.threads = dict(zip(counts, timings, strict=True))
    return results


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="small pictures and few runs: a look, not a result"
    )
    parser.add_argument(
        "--only", metavar="NAME", choices=PARTS, action="append", help=f"one of {', '.join(PARTS)}"
    )
    return parser.parse_args()


def _say(what: str) -> None:
    print(f"measuring: {what} ...", file=sys.stderr)


if __name__ == "__main__":
    main()
