"""The results for mirrors and glass as Markdown."""

from collections.abc import Mapping

from measures.whitted import DEPTH, Apart, Whitted
from report.tables import ratio, table
from timing import vtray_process
from timing.jobs import Timing

NOTE = f"""\
A ball that mirrors, one of glass (index 1.5) and three matt ones on a checkered floor, in the
light of one point, by vtray's integrator `whitted` and by POV-Ray, with the finish
`reflection {{ 0, 1 fresnel }} conserve_energy`: one ray through the middle of each pixel, over up
to {DEPTH} surfaces, as long as more than 1/1024 would be seen. Light is linear, 1 for white; that
of POV-Ray is rounded to 16 bits, by up to 0.0000076, which is nearly all of the difference in the
first row. In the others POV-Ray keeps a rule of its own: light goes straight on through glass
(`rgbf 1`), where vtray's throws a full shadow; or the floor goes on behind the eye, and the mirror
shows it, where for vtray nothing exists behind the image plane. Mirrors and glass of vtray show no
highlights of points, and POV-Ray is asked for none. Seconds are those of a PNG by vtray's rules."""


def whitted_parts(found: Whitted) -> list[str]:
    """Write all that was measured."""
    parts = [apart_table(found.apart), times_table(found.timings, found.side), NOTE]
    return [*parts, *filter(None, [found.conditions])]


def apart_table(rules: Mapping[str, Apart]) -> str:
    """Write how far POV-Ray's light is from vtray's."""
    headings = ("POV-Ray", "mean difference", "largest", "pixels off by more than 1/255")
    rows = [
        (name, f"{found.mean:.7f}", f"{found.largest:.7f}", f"{found.share:.2%}")
        for name, found in rules.items()
    ]
    return table(headings, rows or [("not installed", "-", "-", "-")])


def times_table(timings: Mapping[str, Mapping[int, Timing]], side: int) -> str:
    """Write what both programs took."""
    ours = timings[vtray_process.NAME]
    headings = (
        f"{side} x {side}",
        "threads",
        "whole process",
        "of that tracing",
        "whole ÷ vtray's",
        "tracing ÷ vtray's",
    )
    rows = [
        (
            name,
            str(threads),
            str(timing.whole),
            str(timing.inner),
            ratio(timing.whole.median, ours[threads].whole.median),
            ratio(timing.inner.median, ours[threads].inner.median),
        )
        for name, by_threads in timings.items()
        for threads, timing in by_threads.items()
    ]
    return table(headings, rows)
