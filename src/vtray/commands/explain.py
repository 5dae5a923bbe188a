"""How a pixel got its value, in words: what ``vtray --pixel`` prints."""

from vtray.image.image import Image
from vtray.rendering.pixel_rays import trace_rays
from vtray.scene.scene import Scene


def explain_pixel(
    scene: Scene, image: Image, column: int, row: int, sample: int | None = None
) -> str:
    """Return how a pixel got its value, as text of some lines.

    Parameters
    ----------
    scene
        The scene.
    image
        Its picture: exposure needs the brightest channel of all pixels.
    column, row
        The pixel, from the left and from the top.
    sample
        Which of its samples, None for the ray through its middle; see `vtray.trace_pixel`.

    Raises
    ------
    RenderError
        There is no such pixel or sample.
    """
    return f"{trace_rays(scene, image, column, row, sample, caller='--pixel')}\n"
