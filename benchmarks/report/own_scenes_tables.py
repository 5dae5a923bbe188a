"""The results for scenes that vtray renders alone as Markdown: bonds, and copies."""

from collections.abc import Mapping

from measures.own_scenes import ByThreads
from report.tables import megabytes, ratio, table

BONDS_NOTE = """\
A ball-and-stick model: each atom has two bonds, in the colours of both their ends, under one light
and over a floor, at 1024 x 1024. ÷ says how many times as much as the atoms alone."""

COPIES_NOTE = """\
Spheres at random in a cube, and this cube at the places of a grid, under one light and over a
floor, all of it in view, at 1024 x 1024. Written out, each sphere has a row of its own in an array;
copied, each place has. ÷ says how many times as much as the spheres at one place."""


def own_scenes_table(timings: Mapping[str, ByThreads]) -> str:
    """Write what each scene took, and how much that is of what the first one did."""
    headings = (
        "scene",
        "threads",
        "loading",
        "building",
        "tracing",
        "whole process",
        "peak memory, MB",
        "tracing ÷",
        "whole ÷",
        "memory ÷",
    )
    first = next(iter(timings.values()))
    rows = [
        (
            scene,
            str(threads),
            str(found.load),
            str(found.build),
            str(found.inner),
            str(found.whole),
            megabytes(found.memory),
            ratio(found.inner.median, first[threads].inner.median),
            ratio(found.whole.median, first[threads].whole.median),
            ratio(found.memory, first[threads].memory),
        )
        for scene, by_threads in timings.items()
        for threads, found in by_threads.items()
    ]
    return table(headings, rows)
