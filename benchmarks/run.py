"""Measure vtray, beside other renderers where they are installed.

    python benchmarks/run.py [--quick] [--only NAME]    measures
    python benchmarks/run.py --write                    writes the tables again

Keeps what it measured in benchmarks/results.json, writes the tables of docs/benchmarks.md and of
README.md from it, and draws docs/images/scaling.png; a partial run only prints, and draws the
picture if it measured what is in it.
"""

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

from measures import startup
from measures.antialiasing import time_samples
from measures.bonds import time_bonds
from measures.copies import time_copies
from measures.from_arrays import time_arrays
from measures.machine import cores, machine
from measures.movies import time_movies
from measures.paths import Paths, time_paths
from measures.rendering import THREADS, time_cube, time_scene, time_threads
from measures.soft_light import FULL, QUICK, measure_soft_light
from measures.whitted import measure_whitted
from peers.programs import CUBE_PEERS
from report.pages import full_report, readme_table, replace_between_markers
from report.plot import draw_scaling
from results import Results, load_results, save_results
from scenes.cube import SIDE, write_cube
from scenes.few_objects import SCENES
from timing.jobs import Timing

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
RESULTS = HERE / "results.json"
PLOT = ROOT / "docs" / "images" / "scaling.png"
WRITTEN = {ROOT / "docs" / "benchmarks.md": full_report, ROOT / "README.md": readme_table}
"""The pages with tables, and what writes them."""
PARTS = (
    *("startup", *SCENES, "threads", "cube", "samples"),
    *("soft-light", "whitted", "paths", "bonds", "copies", "movies", "arrays", "scaling"),
)
REPEATS, QUICK_REPEATS = 5, 2
QUICK_SIDE = 256
CUBE, QUICK_CUBE = 1_000_000, 10_000
ATOMS, QUICK_ATOMS = 100_000, 1_000
COPIED, QUICK_COPIED = 100_000, 1_000
MOVING, QUICK_MOVING = 100_000, 1_000
FRAMES, QUICK_FRAMES = 200, 8
PATHS, QUICK_PATHS = (100_000, 1_000_000), (1_000,)
PATHS_SIDE, QUICK_PATHS_SIDE = 512, 64
COUNTS, QUICK_COUNTS = (10_000, 100_000, 1_000_000, 10_000_000), (1_000, 10_000)
SCALING_REPEATS = SOFT_REPEATS = 3


def main() -> None:
    """Measure what was asked for; print it, and keep it if it is all."""
    options = _parse()
    if options.write:
        write_tables(load_results(RESULTS))
        return
    with tempfile.TemporaryDirectory(prefix="vtray-benchmark-") as folder:
        # Kernels compiled here neither help nor disturb the user's own.
        cache = Path(folder) / "cache"
        os.environ["VTRAY_CACHE_DIR"] = str(cache)
        results = measure(Path(folder), options.only or list(PARTS), quick=options.quick)
        versions = len(list(cache.glob("*")))
    print(full_report(results))
    if versions > 1:
        sys.exit("Error: vtray's sources changed during the run; nothing is written, run it again")
    if results.scaling and not options.quick:
        _draw(results)
    if options.quick or options.only:
        return
    save_results(results, RESULTS)
    write_tables(results)


def write_tables(results: Results) -> None:
    """Write the tables of all pages."""
    for page, report in WRITTEN.items():
        if page.exists():
            text = page.read_text(encoding="utf-8")
            page.write_text(replace_between_markers(text, report(results)), encoding="utf-8")


def measure(folder: Path, parts: list[str], *, quick: bool) -> Results:
    """Measure the parts that are named."""
    repeats = QUICK_REPEATS if quick else REPEATS
    results = Results(machine(), repeats)
    if "startup" in parts:
        _say("start-up")
        results.startup = startup.time_startup(folder, repeats)
    for name in filter(parts.__contains__, SCENES):
        description, make, full_side = SCENES[name]
        _say(description)
        side = min(full_side, QUICK_SIDE) if quick else full_side
        title = f"{description}, {side} x {side}"
        results.scenes[title] = time_scene(make(side), folder, repeats)
    side = QUICK_SIDE if quick else SIDE
    spheres = QUICK_CUBE if quick else CUBE
    if "threads" in parts:
        _say("threads")
        room = folder / "room.json"
        room.write_text(json.dumps(SCENES["room"][1](side)))
        results.threads = _time_threads(room, repeats)
        results.cube_threads = _time_threads(write_cube(spheres, folder, side), repeats)
    if "cube" in parts:
        title = f"{spheres:,} spheres in a cube over a floor, 1 light, {side} x {side}"
        _say(title)
        results.cube[title] = time_cube(spheres, side, CUBE_PEERS, THREADS, folder, repeats)
    if "samples" in parts:
        _say("samples")
        scene = write_cube(spheres, folder, side)
        results.samples = time_samples(scene, THREADS, repeats)
    _measure_light(results, folder, parts, quick=quick)
    _measure_own_scenes(results, folder, parts, quick=quick)
    _measure_movies(results, folder, parts, quick=quick)
    if "arrays" in parts:
        title = f"{spheres:,} spheres in a cube, 1 light, {side} x {side}"
        _say(f"from arrays: {title}")
        results.arrays[title] = time_arrays(spheres, side, THREADS, folder, repeats)
    if "scaling" in parts:
        for count in QUICK_COUNTS if quick else COUNTS:
            _say(f"{count:,} spheres")
            peers = [peer for peer in CUBE_PEERS if count <= peer.most_spheres]
            times = min(repeats, SCALING_REPEATS)
            results.scaling[count] = time_cube(count, side, peers, (1,), folder, times)
    return results


def _measure_light(results: Results, folder: Path, parts: list[str], *, quick: bool) -> None:
    """Measure soft light, mirrors and glass, and paths, if they are among the parts."""
    if "soft-light" in parts:
        _say("soft light")
        times = min(results.repeats, SOFT_REPEATS)
        sizes = QUICK if quick else FULL
        results.soft_light = measure_soft_light(sizes, THREADS, folder, times)
    if "whitted" in parts:
        _say("mirrors and glass")
        side = QUICK_SIDE if quick else SIDE
        results.whitted = measure_whitted(side, THREADS, folder, results.repeats)
    if "paths" in parts:
        side = QUICK_PATHS_SIDE if quick else PATHS_SIDE
        times = min(results.repeats, SOFT_REPEATS)
        results.paths = Paths()
        for count in QUICK_PATHS if quick else PATHS:
            title = f"{count:,} spheres, {side} x {side}"
            _say(f"paths: {title}")
            results.paths.cubes[title] = time_paths(count, side, THREADS, folder, times)


def _measure_own_scenes(results: Results, folder: Path, parts: list[str], *, quick: bool) -> None:
    """Measure those of the parts that only vtray renders."""
    if "bonds" in parts:
        _say("atoms and bonds")
        atoms = QUICK_ATOMS if quick else ATOMS
        results.bonds = time_bonds(atoms, THREADS, folder, results.repeats)
    if "copies" in parts:
        _say("copies")
        copied = QUICK_COPIED if quick else COPIED
        results.copies = time_copies(copied, THREADS, folder, results.repeats)


def _measure_movies(results: Results, folder: Path, parts: list[str], *, quick: bool) -> None:
    """Measure movies, if they are among the parts."""
    if "movies" not in parts:
        return
    balls, frames, side = (
        (QUICK_MOVING, QUICK_FRAMES, QUICK_SIDE) if quick else (MOVING, FRAMES, SIDE)
    )
    title = f"{balls:,} balls that move, {side} x {side}"
    _say(f"a movie: {title}")
    times = min(results.repeats, SCALING_REPEATS)
    results.movies[title] = time_movies(balls, frames, side, folder, times)


def _time_threads(scene: Path, repeats: int) -> dict[int, Timing]:
    """Time vtray on a scene with more and more threads."""
    counts = [count for count in (1, 2, 4, 8, 16) if count <= max(cores(), 2)]
    return dict(zip(counts, time_threads(scene, counts, repeats), strict=True))


def _draw(results: Results) -> None:
    """Draw how the time grows, if that can be."""
    try:
        draw_scaling(results.scaling, PLOT)
    except ImportError:
        print(f"Matplotlib is not installed: {PLOT} stays as it was", file=sys.stderr)


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="small pictures and few runs: a look, not a result"
    )
    parser.add_argument(
        "--only", metavar="NAME", choices=PARTS, action="append", help=f"one of {', '.join(PARTS)}"
    )
    parser.add_argument(
        "--write", action="store_true", help="measure nothing: write the tables of the last run"
    )
    return parser.parse_args()


def _say(what: str) -> None:
    print(f"measuring: {what} ...", file=sys.stderr)


if __name__ == "__main__":
    main()
