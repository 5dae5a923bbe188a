"""The results for soft light as Markdown."""

import math
from collections.abc import Mapping, Sequence

from measures.soft_light import EVERY, FAR_ERRORS, Difference, SkyRow, SoftLight, StudioRow
from report.tables import table

LAMPS_NOTE = f"""\
Balls over a floor, all of them matt, in the light of one lamp: vtray's light less that of Mitsuba's
integrator `direct`, both along the same rays, one through the middle of each pixel. Both are means
of pictures with other random numbers, and standard errors come from how much these differ. Far off
are pixels by more than {FAR_ERRORS:g} of their own standard errors. White is what squarely faces
one light of strength 1. Under a sky of one colour vtray casts no more rays from where the first 64
all arrive, which makes what is nearly open brighter by less than 0.006."""

SKY_NOTE = f"""\
The cube of spheres over a floor, white, under a sky of one colour, in parallel rays. For the
tolerance 1, vtray casts 64 rays from each point; for a smaller one, more where these disagree.
Mitsuba casts as many as it has samples: with its integrator `direct` each with a ray from the eye,
or from one point for each pixel, where only its intersection is asked, by code of ours in Dr.Jit.
The error is the root of the mean square of one pixel in {EVERY} by {EVERY}, beside a picture by
vtray with thousands of rays from each point. Mitsuba's seconds are those of the second picture of a
process, when all is compiled."""

STUDIO_NOTE = """\
Spheres like the atoms of molecules at 1024 x 1024, with vtray on two threads, as scenes look whose
lights were never set: in the light of four suns of 10 to 40 degrees, and ambient light, with 4
samples, and a tolerance by the size of balls. The error is the mean of the estimated standard
errors of the pixels that show something, edges too, in steps of 255."""


def soft_light_parts(found: SoftLight) -> list[str]:
    """Write all that was measured."""
    return [
        lamps_table(found.lamps),
        LAMPS_NOTE,
        sky_table(found.sky),
        SKY_NOTE,
        studio_table(found.studio),
        STUDIO_NOTE,
    ]


def lamps_table(lamps: Mapping[str, Difference | None]) -> str:
    """Write how far Mitsuba's light is from vtray's."""
    headings = (
        "lamp",
        "mean difference, % of white",
        "in standard errors",
        "standard error of a pixel, %",
        "pixels far off",
    )
    return table(headings, [(name, *_cells(found)) for name, found in lamps.items()])


def _cells(found: Difference | None) -> tuple[str, ...]:
    """Write a difference."""
    if found is None:
        return "Mitsuba is not installed", "-", "-", "-"
    return (
        f"{100 * found.mean:.4f}",
        f"{found.mean / found.mean_error:.1f}",
        f"{100 * found.pixel_error:.2f}",
        f"{found.far:.2%}",
    )


def sky_table(scenes: Mapping[str, Sequence[SkyRow]]) -> str:
    """Write what pictures under the sky took, and how noisy they are."""
    threads = [number for rows in scenes.values() for number in rows[0].tracing]
    numbers = list(dict.fromkeys(threads))
    headings = (
        "scene",
        "program",
        "with",
        "error, % of white",
        *(f"tracing, {number} thread{'s' if number > 1 else ''}" for number in numbers),
    )
    rows = [
        (scene, row.program, row.quality, _error(row), *_seconds(row, numbers))
        for scene, found in scenes.items()
        for row in found
    ]
    return table(headings, rows)


def _error(row: SkyRow) -> str:
    return "not installed" if math.isnan(row.error) else f"{100 * row.error:.2f}"


def _seconds(row: SkyRow, threads: Sequence[int]) -> list[str]:
    return [str(row.tracing.get(number, "-")) for number in threads]


def studio_table(clouds: Mapping[str, StudioRow]) -> str:
    """Write what pictures in the studio took."""
    rows = [
        (name, str(row.tracing), f"{row.rays / 1e6:,.1f}", f"{row.error:.2f}")
        for name, row in clouds.items()
    ]
    return table(("scene", "tracing", "rays, millions", "error, of 255"), rows)
