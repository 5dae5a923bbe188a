"""What a picture may carry: what is asked for, and what of it there is."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.figures.brightness_scale import BrightnessScale
from vtray.figures.caption import frame_caption
from vtray.figures.color_bar import bar_labels, color_scales, is_asked_for
from vtray.figures.legend import Entry, legend_entries
from vtray.figures.point_labels import Label, shown_labels
from vtray.figures.scale_bar import ScaleBar, scale_bar
from vtray.figures.sheet import FigureError
from vtray.figures.subject import Subject
from vtray.figures.triad import Arm, triad

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from vtray.figures.legend import LegendGiven
    from vtray.figures.point_labels import LabelsGiven
    from vtray.scene.objects import Object


@dataclass(frozen=True, kw_only=True)
class Annotations:
    """What is asked for; `vtray.Image.annotated` says what each may be."""

    title: str | None = None
    time: str | float | None = None
    frame: int | None = None
    legend: "LegendGiven | None" = None
    colorbar: bool | str | Sequence[str] = False
    scalebar: bool | str = False
    axes: "bool | Mapping[str, ArrayLike]" = False
    labels: "LabelsGiven" = ()
    hide_labels: bool = False
    at: "ArrayLike | None" = None


class Marks(NamedTuple):
    """What there is of that, checked.

    Attributes
    ----------
    title, caption
        What stands above the picture, "" for nothing: its name, and which frame it shows.
    legend
        The lines of the legend.
    scales, bar_labels
        The scales that are shown, of colours and then of brightness, and what stands beside each.
    scale_bar
        The scale bar, None for none.
    triad
        The axes, those that point away first.
    labels
        The labels, those of far points first.
    """

    title: str
    caption: str
    legend: list[Entry]
    scales: list[Any]
    bar_labels: list[str]
    scale_bar: ScaleBar | None
    triad: list[Arm]
    labels: list[Label]


def find_marks(image: Subject, wanted: Annotations, *, flat: bool = False) -> Marks:
    """Return what a picture shall carry, or a flat one, in which nothing shines.

    Raises
    ------
    FigureError
        Something that is asked for is not right.
    """
    title: object = wanted.title
    if not isinstance(title, (str, type(None))):
        message = f"title: expected a text or None, got {title!r}"
        raise FigureError(message)
    caption = frame_caption(wanted.time, wanted.frame)
    brightness = image.brightness_scales if is_asked_for(wanted.colorbar) and not flat else []
    return marks_beside(image.scene.objects, wanted, brightness)._replace(
        title=title or "",
        caption=caption,
        scale_bar=scale_bar(image, wanted.scalebar, wanted.at),
        triad=triad(image.scene.camera, wanted.axes),
        labels=shown_labels(image, wanted.labels, hide=wanted.hide_labels),
    )


def marks_beside(
    objects: "Sequence[Object]", wanted: Annotations, brightness: Sequence[BrightnessScale] = ()
) -> Marks:
    """Return the legend and the colour bars of a picture of objects, and nothing else of `Marks`.

    Parameters
    ----------
    objects
        What is shown.
    wanted
        What is asked for.
    brightness
        How bright points are that shine.

    Raises
    ------
    FigureError
        One of them is not right.
    """
    scales = (
        [*color_scales(objects), *dict.fromkeys(brightness)]
        if is_asked_for(wanted.colorbar)
        else []
    )
    entries = [] if wanted.legend is None else legend_entries(wanted.legend)
    return Marks("", "", entries, scales, bar_labels(wanted.colorbar, scales), None, [], [])
