"""Pictures in Matplotlib figures; only imported where there is Matplotlib."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.image import AxesImage
from numpy.typing import NDArray


class ShownPicture(AxesImage):
    """A picture that is shown as exactly as what it is drawn on allows.

    - In files that hold pictures as such (PDF, SVG), it is put as it is.
    - Where a whole number of pixels of the figure shows one of the picture, across and down, each
      has the colour of that one.
    - Otherwise pixels are mixed ("antialiased"): taking the nearest would leave out some rows and
      columns, or show some of them twice, and that is seen as steps and stripes.
    """

    @classmethod
    def on(cls, ax: Axes, pixels: NDArray[Any]) -> "ShownPicture":
        """Add a picture to axes, whose coordinates become its pixels."""
        height, width = pixels.shape[:2]
        ax.set_aspect("auto")
        ax.set_axis_off()
        ax.set_xlim(-0.5, width - 0.5)
        ax.set_ylim(height - 0.5, -0.5)
        shown = cls(ax, origin="upper", extent=(-0.5, width - 0.5, height - 0.5, -0.5))
        shown.set_data(pixels)
        shown.set_clip_path(ax.patch)
        ax.add_image(shown)
        return shown

    def draw(self, renderer: RendererBase) -> None:
        """Draw it, as the renderer can do best."""
        way = "antialiased"
        if renderer.option_scale_image():
            way = "none"
        elif self._is_whole(renderer):
            way = "nearest"
        if self.get_interpolation() != way:
            self.set_interpolation(way)
        super().draw(renderer)

    def _is_whole(self, renderer: RendererBase) -> bool:
        """Tell whether each pixel is shown by a square, or rectangle, of whole ones."""
        height, width = self.get_size()
        box = self.get_window_extent(renderer)
        across, down = abs(box.width) / width, abs(box.height) / height
        return all(
            round(n) >= 1 and abs(n - round(n)) * size < 0.01
            for n, size in ((across, width), (down, height))
        )
