"""The results for the cube of many spheres as Markdown."""

import itertools
import math
from collections.abc import Mapping, Sequence

from measures.rendering import Row
from report.tables import megabytes, ratio, table
from timing import vtray_process
from timing.jobs import Timing, in_seconds

Scaling = Mapping[int, Sequence[Row]]


def cube_table(cube: Mapping[str, Sequence[Row]]) -> str:
    """Write what each program took, and of that what it reports, and its memory."""
    headings = (
        "scene",
        "program",
        "threads",
        "whole process",
        "loading",
        "building",
        "tracing",
        "peak memory, MB",
        "whole ÷ vtray's",
        "tracing ÷ vtray's",
        "picture off by",
    )
    rows = [
        (scene, row.program, str(row.threads), *_cells(row, found), row.note)
        for scene, found in cube.items()
        for row in found
    ]
    return table(headings, rows)


def own_timing(rows: Sequence[Row], row: Row) -> Timing | None:
    """Return vtray's time with as many threads as another has."""
    same = [r for r in rows if r.program == vtray_process.NAME and r.threads == row.threads]
    return same[0].timing if same else None


def _cells(row: Row, rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the times of a row, its memory, and its times as multiples of vtray's."""
    timing, ours = row.timing, own_timing(rows, row)
    if timing is None or ours is None:
        return ("-",) * 7
    return (
        str(timing.whole),
        str(timing.load),
        str(timing.build),
        str(timing.inner),
        megabytes(timing.memory),
        ratio(timing.whole.median, ours.whole.median),
        ratio(timing.inner.median, ours.inner.median),
    )


def growth_table(scaling: Scaling) -> str:
    """Write how vtray's own steps grow with the number of spheres."""
    headings = (
        "spheres",
        "building",
        "for each doubling",
        "tracing",
        "for each doubling",
        "whole process",
        "peak memory, MB",
    )
    timings = {count: rows[0].timing for count, rows in scaling.items()}
    builds = _growth({n: t.build.median for n, t in timings.items() if t})
    traces = _growth({n: t.inner.median for n, t in timings.items() if t})
    rows = [
        (
            f"{count:,}",
            str(timing.build),
            builds[count],
            str(timing.inner),
            traces[count],
            str(timing.whole),
            megabytes(timing.memory),
        )
        for count, timing in timings.items()
        if timing
    ]
    return table(headings, rows)


def _growth(seconds: Mapping[int, float]) -> dict[int, str]:
    """Write the factor for each doubling of the spheres since the number before, as ``x 1.95``."""
    found = dict.fromkeys(seconds, "-")
    for (few, short), (many, long) in itertools.pairwise(seconds.items()):
        if not math.isnan(long / short):
            found[many] = f"x {(long / short) ** (1 / math.log2(many / few)):.2f}"
    return found


def programs_table(scaling: Scaling) -> str:
    """Write the seconds of all programs for each number of spheres: whole process, and tracing."""
    programs = list(dict.fromkeys(row.program for rows in scaling.values() for row in rows))
    rows = [
        (f"{count:,}", *(_brief(found.get(program)) for program in programs))
        for count, rows in scaling.items()
        for found in ({row.program: row.timing for row in rows},)
    ]
    return table(("spheres", *programs), rows)


def _brief(timing: Timing | None) -> str:
    if timing is None:
        return "-"
    return f"{in_seconds(timing.whole.median)} ({in_seconds(timing.inner.median)})"


def cube_threads_table(threads: Mapping[int, Timing]) -> str:
    """Write how vtray's steps get faster with more threads."""
    one = next(iter(threads.values()))
    rows = [
        (
            str(count),
            str(timing.build),
            ratio(one.build.median, timing.build.median),
            str(timing.inner),
            ratio(one.inner.median, timing.inner.median),
        )
        for count, timing in threads.items()
    ]
    return table(("threads", "building", "speed-up", "tracing", "speed-up"), rows)
