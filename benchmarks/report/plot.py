"""A picture of how the time grows with the number of spheres."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from report.cube_tables import Scaling
from timing import vtray_process
from timing.jobs import Timing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = {
    "vtray": "#d7301f",
    "Embree": "#08519c",
    "Embree, single rays": "#4292c6",
    "Embree, its own spheres": "#9ecae1",
    "Mitsuba": "#7b3294",
    "Tachyon": "#1b7837",
    "POV-Ray": "#b8860b",
}
OTHER_COLORS = ("#969696", "#525252", "#252525")


def draw_scaling(scaling: Scaling, path: Path) -> None:
    """Draw seconds against the number of spheres, for all programs.

    On the left those of the whole process, on the right those of building and tracing.

    Raises
    ------
    ImportError
        If Matplotlib is not installed.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, (left, right) = plt.subplots(
        1, 2, figsize=(10, 5), sharex=True, sharey=True, layout="constrained"
    )
    _draw(left, scaling, lambda timing: timing.whole.median)
    _draw(right, scaling, lambda timing: timing.build.median + timing.inner.median)
    left.set_title("the whole process", fontsize="medium")
    right.set_title("building and tracing", fontsize="medium")
    left.set_ylabel("seconds, one thread")
    # Log axes label their minor ticks, which overlap here.
    left.yaxis.set_major_formatter("{x:g}")
    left.yaxis.set_minor_formatter("")
    left.xaxis.set_major_formatter("{x:,.0f}")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def _draw(axes: "Axes", scaling: Scaling, seconds: Callable[[Timing], float]) -> None:
    """Draw a line for each program."""
    others = iter(OTHER_COLORS)
    for program in dict.fromkeys(row.program for rows in scaling.values() for row in rows):
        rows = {n: row for n, rows in scaling.items() for row in rows if row.program == program}
        points = {n: seconds(row.timing) for n, row in rows.items() if row.timing}
        color = COLORS.get(program) or next(others, "#bdbdbd")
        is_apart = any(row.note.startswith("another") for row in rows.values())
        axes.loglog(
            list(points),
            list(points.values()),
            label=f"{program}{' (another picture)' if is_apart else ''}",
            color=color,
            linestyle="--" if is_apart else "-",
            **_emphasis(is_ours=program == vtray_process.NAME),
        )
    axes.set_xlabel("spheres")
    axes.grid(which="major", color="#e5e5e5")
    axes.spines[["top", "right"]].set_visible(False)


def _emphasis(*, is_ours: bool) -> dict[str, Any]:
    """Return what sets vtray's line off from the others."""
    if is_ours:
        return {"linewidth": 2.5, "marker": "o", "markersize": 6, "zorder": 3}
    return {"linewidth": 1.5, "marker": "o", "markersize": 4, "zorder": 2}
