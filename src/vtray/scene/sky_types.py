"""What makes the colour of a sky change with the direction: a gradient, for one."""

from typing import TYPE_CHECKING

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import FieldError
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    from vtray.scene.vectors import Triple


class Gradient(Frozen, frozen=True, gc=False, omit_defaults=True):
    """Colours of a sky by the height above the horizon; those of a clear day by default.

    At the sine h of the height, the colour is ``horizon + (zenith - horizon) * h * (2 - h)``; below
    the horizon, with h the sine of the depth, it is ``ground + (horizon - ground) * (1 - h)**8``,
    which is nearly the ground from 15 degrees on.

    Attributes
    ----------
    zenith : Color, optional
        The colour straight above, in linear light.
    horizon : Color, optional
        The colour at the horizon.
    ground : Color, optional
        The colour below the horizon.
    """

    zenith: Color = Color(85, 140, 230)
    horizon: Color = Color(235, 240, 245)
    ground: Color = Color(120, 110, 100)

    if TYPE_CHECKING:

        def __init__(
            self,
            zenith: "Color | Triple" = ...,
            horizon: "Color | Triple" = ...,
            ground: "Color | Triple" = ...,
        ) -> None: ...


def check_one_of(gradient: object, image: object) -> None:
    """Raise FieldError if a sky has both a gradient and a picture."""
    if gradient is not None and image is not None:
        field, message = "image", "no picture beside a gradient; leave out one of them"
        raise FieldError(field, message)
