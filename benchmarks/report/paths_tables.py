"""The results for paths as Markdown."""

from collections.abc import Mapping, Sequence

from measures.paths import SURFACES, Paths, PathsRow
from report.tables import table
from timing.jobs import in_seconds

ERROR = 0.01
"""For this share of the sky's light, seconds are compared."""
NOTE = f"""\
The cube of spheres over a floor, which scatter 80 % of the light, under a sky of radiance 1, by
paths over up to {SURFACES} surfaces, in parallel rays, with a box for a filter: vtray's integrator
`path`; a program of ours that casts Embree's rays, in floats, and scatters them by independent
random numbers, the samples of a pixel in packets of 16 or one by one; Mitsuba's `path` in LLVM,
with ellipsoids; Blender's Cycles on the processor, with a point cloud, and without what is not
exact (adaptive sampling, denoising, clamping). The error is that of a channel of a pixel, in
radiance: the root of the mean square of what two pictures with other random numbers differ by, over
the root of 2. Seconds for an error of {ERROR:.0%} are those of one thread, if errors fall as the
root of the samples. The others' seconds are those of the second picture of a process, when all is
compiled, and their hierarchies are there."""


def paths_parts(found: Paths) -> list[str]:
    """Write all that was measured."""
    return [paths_table(found.cubes), NOTE, *filter(None, [found.conditions])]


def paths_table(scenes: Mapping[str, Sequence[PathsRow]]) -> str:
    """Write what pictures by paths took, and how noisy they are."""
    numbers = list(dict.fromkeys(n for rows in scenes.values() for n in rows[0].tracing))
    headings = (
        *("scene", "program", "samples", "mean light", "error, %"),
        *(f"tracing, {number} thread{'s' if number > 1 else ''}" for number in numbers),
        f"seconds for an error of {ERROR:.0%}",
    )
    rows = [
        (
            *(scene, row.program, str(row.samples), f"{row.light:.4f}", f"{100 * row.error:.2f}"),
            *(str(row.tracing[number]) for number in numbers),
            in_seconds(row.tracing[numbers[0]].median * (row.error / ERROR) ** 2),
        )
        for scene, found in scenes.items()
        for row in found
    ]
    return table(headings, rows)
