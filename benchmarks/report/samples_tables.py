"""The results for antialiasing as Markdown."""

from collections.abc import Iterable, Mapping

from measures.antialiasing import SAMPLES, job_name
from report.tables import ratio, table
from timing.jobs import Timing

NOTE = """\
With the default filter, Blackman-Harris. ÷ says how many times as long as with one ray a pixel:
tracing alone, and the whole process from scene file to PNG."""


def samples_table(timings: Mapping[str, Timing], threads: Iterable[int]) -> str:
    """Write what samples took."""
    rows = []
    for count in threads:
        one = timings[job_name(1, count)]
        for samples in SAMPLES:
            found = timings[job_name(samples, count)]
            rows.append(
                (
                    str(samples),
                    str(count),
                    str(found.inner),
                    str(found.whole),
                    ratio(found.inner.median, one.inner.median),
                    ratio(found.whole.median, one.whole.median),
                )
            )
    headings = ("samples", "threads", "tracing", "whole process", "tracing ÷", "whole ÷")
    return table(headings, rows)
