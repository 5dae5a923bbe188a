"""Points, directions and colours: three numbers each."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import Byte, Real

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Triple = Sequence[float] | NDArray[Any]


class Vector(Frozen, frozen=True, gc=False):
    """A point or a displacement in world space.

    Wherever a `Vector`, `Direction` or `Color` is expected, code may also give a tuple, a
    list or a NumPy array of three numbers.

    Attributes
    ----------
    x, y, z : float
        Coordinates in scene units, finite.
    """

    x: Real
    y: Real
    z: Real


class Direction(Frozen, frozen=True, gc=False):
    """A direction in world space, of any length but zero.

    Attributes
    ----------
    x, y, z : float
        Components, finite and not all zero.
    """

    x: Real
    y: Real
    z: Real

    def __post_init__(self) -> None:
        """Refuse the zero vector, which points nowhere."""
        if self.x == self.y == self.z == 0:
            message = "numbers x, y and z that are not all zero"
            raise ValueError(message)


class Color(Frozen, frozen=True, gc=False):
    """The colour of a surface, in linear light; in sRGB for all tone maps but "linear".

    Attributes
    ----------
    r, g, b : int
        Red, green and blue, from 0 to 255.
    """

    r: Byte
    g: Byte
    b: Byte
