"""The rays of one pixel as users get them: data that is told and drawn."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vtray.figures.traced_rays import (
    Choice,
    Exposed,
    FanRay,
    Hit,
    Layer,
    PathRay,
    ShadowFan,
    ShadowRay,
    Surface,
    TracedRays,
    Veil,
    View,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = [
    "Choice",
    "Exposed",
    "FanRay",
    "Hit",
    "Layer",
    "PathRay",
    "RayTree",
    "ShadowFan",
    "ShadowRay",
    "Surface",
    "Veil",
    "View",
]


@dataclass(frozen=True, repr=False)
class RayTree(TracedRays):
    """All rays of one pixel; see `vtray.trace_pixel`.

    ``print(tree)`` explains them in words, `draw` shows them, and so does a notebook.

    Attributes
    ----------
    pixel
        Column from the left and row from the top.
    origin
        Where the camera ray starts, in world space: the eye.
    direction
        Its unit direction in world space.
    hit
        What it hits, or None; what is behind a lamp that is seen does not count.
    lights
        The ways to all lights in the order of ``scene.lights``: a `ShadowRay` for each point, a
        `ShadowFan` for each other light. None if nothing is hit.
    light
        The sum of what all lights add, or the light of the lamp: linear red, green and blue. Where
        rays go on, that of all of them.
    view
        The camera in world space.
    exposed
        What became of the light in a picture; None if only a scene was given.
    lamp
        The place in ``scene.lights`` of the lamp that is seen, or None.
    scene
        The scene as it was traced.
    layers
        The layers of faded bodies before the hit, the nearest first.
    share
        How much of the light of the hit is seen: what passes all of them, and of that what fog
        leaves where its `veil` is counted.
    veil
        What fog does to that light; None if there is none, or nothing is met.
    path
        All rays over surfaces, in the order in which they were followed: the camera's first, then
        those that go on from what it hits, and so on. Empty where none goes on, as in direct light.
    sample
        The number of the ray among the samples of the pixel; None for the one through its middle.
    """

    def __repr__(self) -> str:
        seen = "nothing" if self.hit is None else f"a hit at {self.hit.distance:.6g}"
        seen = seen if self.lamp is None else f"lamp {self.lamp}"
        return f"<RayTree of pixel {self.pixel}, {seen}, {len(self.lights)} ways to lights>"

    def __str__(self) -> str:
        """Explain the pixel in some lines, as ``vtray --pixel`` does."""
        from vtray.figures.ray_text import describe

        return describe(self)

    def _repr_markdown_(self) -> str:
        """Return the explanation as Markdown, by which notebooks show it."""
        return f"```text\n{self}\n```"

    def draw(self, ax: "Axes | None" = None, *, light: int | None = None) -> "Axes":
        """Draw the rays in the plane of the camera ray and of the way to a light, or onwards.

        What this plane cuts of the scene is drawn as it is there; what lies outside of it (normal,
        other lights, whole outlines) is projected squarely onto it. Needs matplotlib:
        ``pip install matplotlib``.

        Parameters
        ----------
        ax
            Where to draw; None for a new figure, which is ``ax.figure`` of the result.
        light
            The place in ``scene.lights`` of the one in whose plane the drawing lies: that of its
            middle, or of the normal where light comes from all sides. None for the ray that goes on
            first from what is hit; without such rays, for the light that adds most. If nothing is
            hit or there are no lights, the plane is upright in the image.

        Returns
        -------
        Axes
            Where it was drawn.

        Raises
        ------
        ExtraError
            Matplotlib is not installed.
        RenderError
            There is no such light.
        """
        from vtray.figures.ray_drawing import draw

        return draw(self, ax, light)
