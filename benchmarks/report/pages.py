"""The results as Markdown: what the page of the benchmarks shows of them, and what the README."""

from collections.abc import Mapping, Sequence

from measures.from_arrays import ArraysRow
from measures.rendering import THREADS, Row
from peers.programs import CUBE_PEERS, PEERS
from report import arrays_tables, movies_tables, samples_tables
from report.arrays_tables import arrays_table
from report.cube_tables import (
    cube_table,
    cube_threads_table,
    growth_table,
    own_timing,
    programs_table,
)
from report.movies_tables import movies_table
from report.own_scenes_tables import BONDS_NOTE, COPIES_NOTE, own_scenes_table
from report.paths_tables import paths_parts
from report.samples_tables import samples_table
from report.soft_light_tables import soft_light_parts
from report.tables import ratio, table
from report.whitted_tables import whitted_parts
from results import Results
from scenes.few_objects import SCENES
from timing import same_picture, vtray_process
from timing.jobs import Timing, in_seconds

BEGIN = "<!-- benchmark:begin -->"
END = "<!-- benchmark:end -->"


def full_report(results: Results) -> str:
    """Write everything, as the page of the benchmarks shows it."""
    parts = []
    if results.scenes or results.cube:
        parts += ["## All programs", summary(results)]
    spread = (
        f"From here on, seconds are the median of {results.repeats} runs, with the least and the "
        "most in brackets."
    )
    parts += ["## The machine", table(("", ""), results.machine.items()), spread]
    if results.startup:
        parts += ["## Start-up", _startup_table(results.startup)]
    if results.scenes:
        parts += ["## Scenes", _scene_table(results.scenes), _conditions()]
    parts += _threads(results)
    if results.cube:
        parts += ["## A cube of many spheres", cube_table(results.cube), _cube_conditions()]
    parts += _own_scenes(results)
    if results.movies:
        parts += ["## Movies", movies_table(results.movies), movies_tables.NOTE]
    if results.arrays:
        parts += ["## From arrays to a PNG", arrays_table(results.arrays), arrays_tables.NOTE]
    if results.scaling:
        parts += ["## More and more spheres", _SCALING_NOTE, growth_table(results.scaling)]
        parts += [_PROGRAMS_NOTE, programs_table(results.scaling)]
    return "\n\n".join(parts)


def _own_scenes(results: Results) -> list[str]:
    """Write what samples, soft light, mirrors, paths, bonds and copies cost."""
    parts = []
    if results.samples:
        rows = samples_table(results.samples, THREADS)
        parts += ["## Antialiasing", "The cube, with vtray.", rows, samples_tables.NOTE]
    if results.soft_light:
        parts += ["## Soft light", *soft_light_parts(results.soft_light)]
    if results.whitted:
        parts += ["## Mirrors and glass", *whitted_parts(results.whitted)]
    if results.paths:
        parts += ["## Paths", *paths_parts(results.paths)]
    if results.bonds:
        parts += ["## Bonds", own_scenes_table(results.bonds), BONDS_NOTE]
    if results.copies:
        parts += ["## Copies", own_scenes_table(results.copies), COPIES_NOTE]
    return parts


def _threads(results: Results) -> list[str]:
    """Write what more threads bring."""
    parts = []
    if results.threads:
        parts += ["## Threads", "The room, with vtray.", _thread_table(results.threads)]
    if results.cube_threads:
        parts += ["The cube, with vtray.", cube_threads_table(results.cube_threads)]
    return parts


def summary(results: Results) -> str:
    """Write one table of all scenes: seconds of each whole process, and of tracing alone."""
    rows = [
        (scene, str(threads), *_row_of_programs(found, threads))
        for scene, found in (results.scenes | results.cube).items()
        for threads in sorted({row.threads for row in found})
    ]
    note = (
        "Seconds of the whole process, and in brackets of tracing rays alone: medians of "
        f"{results.repeats} runs. A time is given only where the picture is vtray's."
    )
    return f"{table(('scene', 'threads', *_programs(results)), rows)}\n\n{note}"


def readme_table(results: Results) -> str:
    """Write what the README shows: scenes with something to see, on as many threads as ran."""
    empty = SCENES["empty"][0]
    shown = {
        scene: found
        for scene, found in (results.scenes | results.cube).items()
        if not scene.startswith(empty)
    }
    threads = max(row.threads for found in shown.values() for row in found)
    rows = [(scene, *_row_of_programs(found, threads)) for scene, found in shown.items()]
    note = (
        "Seconds from the scene file to the PNG, and in brackets of tracing rays alone, with "
        f"{threads} threads: the median of {results.repeats} runs on "
        f"{results.machine['processor']} ({results.machine['date']}). "
        "A time is given only where the picture is vtray's."
    )
    parts = [table(("scene", *_programs(results)), rows), note]
    parts += [_from_arrays(scene, found, threads) for scene, found in results.arrays.items()]
    return "\n\n".join(parts)


def _programs(results: Results) -> list[str]:
    """Return the programs that render all scenes, with their versions."""
    names = [vtray_process.NAME, *(peer.name for peer in PEERS)]
    return [f"{name} {results.machine.get(name, '')}".strip() for name in names]


def _row_of_programs(found: Sequence[Row], threads: int) -> list[str]:
    """Write the times of all programs with so many threads."""
    timings = {row.program: row.timing for row in found if row.threads == threads}
    names = [vtray_process.NAME, *(peer.name for peer in PEERS)]
    return [_brief(timings.get(name)) for name in names]


def _from_arrays(scene: str, rows: Sequence[ArraysRow], threads: int) -> str:
    """Write what the first picture from arrays took, in a sentence."""
    seconds = "; ".join(
        f"{row.program} {in_seconds(row.first.median)}{_apart(row)}"
        for row in rows
        if row.threads == threads
    )
    return f"Seconds from NumPy arrays to a PNG, driven from Python ({scene}): {seconds}."


def _apart(row: ArraysRow) -> str:
    return " (another picture)" if row.note.startswith("another") else ""


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
