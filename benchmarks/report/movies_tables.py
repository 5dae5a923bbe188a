"""The results for movies as Markdown."""

from collections.abc import Mapping, Sequence

from measures.movies import THREADS, MovieRow
from report.tables import ratio, table

NOTE = f"""\
- Balls at random in a cube, which all move from frame to frame, one light, shadows, one ray a
  pixel, from arrays to an .mp4. What is compiled and loaded is there.
- {THREADS} threads, or processes of one thread each on the same cores. OVITO makes fewer frames, by
  `render_anim` with Tachyon without ambient occlusion; its light comes from a place of its own."""


def movies_table(rows: Mapping[str, Sequence[MovieRow]]) -> str:
    """Write what a frame takes with each program."""
    headings = (
        "movie",
        "program",
        "frames",
        "frames a second",
        "seconds a frame",
        "of all cores",
        "seconds ÷ vtray's",
    )
    lines = [
        (
            movie,
            row.program,
            str(row.frames),
            f"{1 / row.seconds.median:.3g}",
            str(row.seconds),
            str(row.of_cores),
            ratio(row.seconds.median, found[0].seconds.median),
        )
        for movie, found in rows.items()
        for row in found
    ]
    return table(headings, lines)
