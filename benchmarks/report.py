"""The results as Markdown, and the table in the README."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import antialiasing
import arrays_report
import same_picture
import vtray_process
from antialiasing import samples_table
from arrays_report import arrays_table
from cube_report import (
    cube_table,
    cube_threads_table,
    growth_table,
    own_timing,
    programs_table,
)
from from_arrays import ArraysRow
from measure import Timing, in_seconds
from peers import CUBE_PEERS, PEERS
from tables import ratio, table

from rendering import THREADS, Row

BEGIN = "<!-- benchmark:begin -->"
END = "<!-- benchmark:end -->"


@dataclass
class Results:
    """All that a run has measured.

    Attributes
    ----------
    machine
        Name and value of all that bears on the numbers.
    repeats
        How often each process ran.
    startup
        What costs the same for every scene.
    scenes
        For each scene, by what it is, the times of all renderers.
    threads
        For numbers of threads, vtray's times for the first scene.
    cube
        As `scenes`, for a cube of many spheres.
    cube_threads
        As `threads`, for this cube.
    scaling
        For numbers of spheres in the cube, the times of all renderers with one thread.
    samples
        For numbers of samples and of threads, vtray's times for this cube.
    arrays
        As `cube`, from arrays in memory to a PNG.
    """

    machine: dict[str, str]
    repeats: int
    startup: dict[str, Timing] = field(default_factory=dict)
    scenes: dict[str, list[Row]] = field(default_factory=dict)
    threads: dict[int, Timing] = field(default_factory=dict)
    cube: dict[str, list[Row]] = field(default_factory=dict)
    cube_threads: dict[int, Timing] = field(default_factory=dict)
    scaling: dict[int, list[Row]] = field(default_factory=dict)
    samples: dict[str, Timing] = field(default_factory=dict)
    arrays: dict[str, list[ArraysRow]] = field(default_factory=dict)


def full_report(results: Results) -> str:
    """Write everything."""
    parts = [
        "# Benchmarks",
        (
            "Written by `python benchmarks/run.py`; run it again instead of changing this file. "
            f"Seconds are the median of {results.repeats} runs, with the least and the most in "
            "brackets."
        ),
        table(("", ""), results.machine.items()),
    ]
    if results.startup:
        parts += ["## Start-up", _startup_table(results.startup)]
    if results.scenes:
        parts += ["## Scenes", _scene_table(results.scenes), _conditions()]
    if results.threads:
        parts += ["## Threads", "The room, with vtray.", _thread_table(results.threads)]
    if results.cube_threads:
        parts += ["The cube, with vtray.", cube_threads_table(results.cube_threads)]
    if results.cube:
        parts += ["## A cube of many spheres", cube_table(results.cube), _cube_conditions()]
    if results.samples:
        rows = samples_table(results.samples, THREADS)
        parts += ["## Antialiasing", "The cube, with vtray.", rows, antialiasing.NOTE]
    if results.arrays:
        parts += ["## From arrays to a PNG", arrays_table(results.arrays), arrays_report.NOTE]
    if results.scaling:
        parts += ["## More and more spheres", _SCALING_NOTE, growth_table(results.scaling)]
        parts += [_PROGRAMS_NOTE, programs_table(results.scaling)]
    return "\n\n".join(parts) + "\n"


def summary(results: Results) -> str:
    """Write the table for the README: seconds of each whole process, and of tracing alone."""
    programs = [vtray_process.NAME, *(peer.name for peer in PEERS)]
    rows = [
        (scene, str(threads), *(_brief(timings.get((program, threads))) for program in programs))
        for scene, found in (results.scenes | results.cube).items()
        for timings in ({(row.program, row.threads): row.timing for row in found},)
        for threads in sorted({row.threads for row in found})
    ]
    headings = [f"{name} {results.machine.get(name, '')}".strip() for name in programs]
    note = (
        "Seconds of the whole process, and in brackets of tracing rays alone: the median of "
        f"{results.repeats} runs on {results.machine['processor']} ({results.machine['date']}). "
        "A time is given only where the picture is vtray's. "
        "Spreads, options and start-up: [benchmarks/results.md](benchmarks/results.md)."
    )
    shown = [table(("scene", "threads", *headings), rows), note]
    if results.scaling:
        shown.append("![Seconds against the number of spheres](docs/images/scaling.png)")
    return "\n\n".join(shown)


def replace_between_markers(text: str, table: str) -> str:
    """Put a table where the markers are; a text without markers stays as it is."""
    start, end = text.find(BEGIN), text.find(END)
    if start < 0 or end < start:
        return text
    return f"{text[: start + len(BEGIN)]}\n{table}\n{text[end:]}"


def _startup_table(startup: Mapping[str, Timing]) -> str:
    rows = [(name, str(timing.whole), str(timing.inner)) for name, timing in startup.items()]
    return table(("process", "seconds", "of which compiling, or loading what was compiled"), rows)


def _scene_table(scenes: Mapping[str, list[Row]]) -> str:
    headings = (
        "scene",
        "program",
        "threads",
        "whole process",
        "of that tracing",
        "whole ÷ vtray's",
        "tracing ÷ vtray's",
    )
    rows = [
        (scene, row.program, str(row.threads), *_cells(row, found), row.note)
        for scene, found in scenes.items()
        for row in found
    ]
    return table((*headings, "picture off by"), rows)


def _cells(row: Row, rows: list[Row]) -> tuple[str, str, str, str]:
    """Return the times of a row, and these as multiples of vtray's with as many threads."""
    ours = own_timing(rows, row)
    if row.timing is None or ours is None:
        return "-", "-", "-", "-"
    whole, inner = row.timing.whole, row.timing.inner
    ratios = ratio(whole.median, ours.whole.median), ratio(inner.median, ours.inner.median)
    return str(whole), str(inner), *ratios


def _thread_table(threads: Mapping[int, Timing]) -> str:
    one = next(iter(threads.values())).inner.median
    rows = [
        (str(count), str(timing.inner), f"{one / timing.inner.median:.2f}")
        for count, timing in threads.items()
    ]
    return table(("threads", "tracing", "speed-up"), rows)


def _conditions() -> str:
    """Write how the programs were run and what counts as the same picture."""
    options = "; ".join(f"{peer.name} `{peer.options}`" for peer in PEERS)
    mean, share = same_picture.MEAN_TOLERANCE, same_picture.SHARE_TOLERANCE
    far = f"off by more than {same_picture.FAR:g}"
    return f"""\
- Every program casts one ray per pixel at matt surfaces, without antialiasing, and a shadow ray to
  each light, and writes a PNG.
- Options, besides files, size and threads: {options}.
- Tracing is the time that the program itself reports; it leaves out start-up, reading the scene and
  writing the picture.
- ÷ says how many times as long as vtray with as many threads; below 1 is faster.
- How far a picture is off vtray's: the mean over all channels, of 255, and the share of pixels
  {far}, once its brightness is scaled for the best fit. Programs round differently, and an
  edge may run through a neighbouring pixel; a time counts up to {mean:g} and {share:.0%}."""


def _cube_conditions() -> str:
    """Write what the cube's table shows, beyond what is said of all scenes."""
    options = "".join(f"\n  - {peer.name}: `{peer.options}`" for peer in CUBE_PEERS)
    return f"""\
- N spheres with their centres at random in a cube, of a radius that fills a twelfth of it, over a
  floor, with one light that casts shadows; one ray per pixel.
- Loading, building and tracing are what the programs report; building is the making of what finds
  hits fast. What is left of the whole process is start-up and writing the picture.
- Embree is a library: the program around it is ours, as are the scripts for Mitsuba and OVITO. They
  read the scene as vtray does, from arrays; Tachyon and POV-Ray read text. Embree has spheres of
  its own, and is faster with ours.
- OVITO does not tell building from tracing. It is held to as many cores as it should have threads.
- Options, besides files, size and threads:{options}"""


_SCALING_NOTE = """\
The cube with vtray on one thread. For each doubling: the factor since the row above, spread over
the doublings between."""

_PROGRAMS_NOTE = """\
The cube with one thread: seconds of the whole process, and in brackets of tracing alone. A dash
stands for a program that is not installed, that needs too much memory, or whose picture is another
for no known reason."""


def _brief(timing: Timing | None) -> str:
    if timing is None:
        return "-"
    return f"{in_seconds(timing.whole.median)} ({in_seconds(timing.inner.median)})"
