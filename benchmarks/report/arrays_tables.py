"""The results from arrays to a PNG as Markdown."""

from collections.abc import Mapping, Sequence

from measures.from_arrays import LATER, ArraysRow
from report.tables import megabytes, ratio, table
from timing import vtray_process

NOTE = f"""\
- The arrays are NumPy's: centres as float64, colours as uint8. The clock runs from them to the PNG
  on disk; imports and loading the arrays are only in the whole process, which makes one picture.
- Later pictures of a process, {LATER} of them, are made as the first: all that is kept is compiled
  code. What is compiled on the very first run is on disk, for all programs.
- One ray a pixel, one light whose rays are parallel, shadows; no floor. OVITO has its own light.
- Each is driven by a script of ours, `arrays_*.py` in `benchmarks/`, as its users would: Mitsuba by
  `load_dict` with `ellipsoids` and the `direct` integrator."""


def arrays_table(rows: Mapping[str, Sequence[ArraysRow]]) -> str:
    """Write what each program took."""
    headings = (
        "scene",
        "program",
        "threads",
        "arrays to PNG, later",
        "arrays to PNG, first",
        "whole process",
        "peak memory, MB",
        "later ÷ vtray's",
        "whole ÷ vtray's",
        "picture off by",
    )
    lines = []
    for scene, found in rows.items():
        ours = {row.threads: row for row in found if row.program == vtray_process.NAME}
        for row in found:
            own = ours[row.threads]
            lines.append(
                (
                    scene,
                    row.program,
                    str(row.threads),
                    str(row.later),
                    str(row.first),
                    str(row.whole),
                    megabytes(row.memory),
                    ratio(row.later.median, own.later.median),
                    ratio(row.whole.median, own.whole.median),
                    row.note,
                )
            )
    return table(headings, lines)
