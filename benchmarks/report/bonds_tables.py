"""The results for bonds as Markdown."""

from collections.abc import Iterable, Mapping

from measures.bonds import job_name
from report.tables import ratio, table
from timing.jobs import Timing

NOTE = """\
Each atom has two bonds, in the colours of both their ends, under one light and over a floor, at
1024 x 1024. ÷ says how many times as long as the atoms alone."""


def bonds_table(timings: Mapping[str, Timing], threads: Iterable[int]) -> str:
    """Write what atoms and bonds took."""
    rows = []
    for number in threads:
        alone = timings[job_name("atoms", number)]
        for name, shown in (("atoms", "atoms alone"), ("bonds", "atoms and bonds")):
            found = timings[job_name(name, number)]
            cells = str(found.inner), str(found.whole)
            rows.append(
                (
                    shown,
                    str(number),
                    *cells,
                    ratio(found.inner.median, alone.inner.median),
                    ratio(found.whole.median, alone.whole.median),
                )
            )
    return table(("scene", "threads", "tracing", "whole process", "tracing ÷", "whole ÷"), rows)
