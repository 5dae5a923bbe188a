"""The rays of one pixel as users get them: data that is told and drawn."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vtray.figures.traced_rays import Exposed, Hit, ShadowRay, Surface, TracedRays, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Exposed", "Hit", "RayTree", "ShadowRay", "Surface", "View"]


@dataclass(frozen=True)
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
        What it hits, or None.
    lights
        The shadow rays to all point lights in the order of ``scene.lights``; none if nothing is
        hit. Other lights are not a ray each, and are left out.
    light
        The sum of what the point lights add: linear red, green and blue.
    view
        The camera in world space.
    exposed
        What became of the light in a picture; None if only a scene was given.
    scene
        The scene as it was traced.
    """

    def __str__(self) -> str:
        """Explain the pixel in some lines, as ``vtray --pixel`` does."""
        from vtray.figures.ray_text import describe

        return describe(self)

    def _repr_markdown_(self) -> str:
        """Return the explanation as Markdown, by which notebooks show it."""
        return f"```text\n{self}\n```"

    def draw(self, ax: "Axes | None" = None, *, light: int | None = None) -> "Axes":
        """Draw the rays in the plane in which the camera ray and one shadow ray lie.

        What this plane cuts of the scene is drawn as it is there; what lies outside of it (normal,
        other lights, whole outlines) is projected squarely onto it. Needs matplotlib:
        ``pip install matplotlib``.

        Parameters
        ----------
        ax
            Where to draw; None for a new figure, which is ``ax.figure`` of the result.
        light
            The place in ``scene.lights`` of the one whose shadow ray lies in the plane; None for
            that which adds most. If nothing is hit or there are no point lights, the plane is
            upright in the image.

        Returns
        -------
        Axes
            Where it was drawn.

        Raises
        ------
        ExtraError
            Matplotlib is not installed.
        RenderError
            There is no such light, or it is no point.
        """
        from vtray.figures.ray_drawing import draw

        return draw(self, ax, light)
