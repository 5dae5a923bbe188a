"""Points that shine, as arrays: smaller than pixels, and their light adds up."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from msgspec import Meta

from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays, Bytes, Floats
from vtray.scene.checks.checked import make_unchecked
from vtray.scene.checks.columns import COLOR, NO_NAMES, POINT, Column, check_arrays
from vtray.scene.checks.limits import NonNegative, Positive

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

EMISSION = Column(NonNegative, (), "a number", ("emission",))

Stretch = Literal["linear", "asinh", "log"]

STRETCHES: tuple[Stretch, ...] = ("linear", "asinh", "log")

Softening = Annotated[float, Meta(ge=1e-9, le=1e9, description="a number from 1e-9 to 1e9")]

SOFTENINGS = {"linear": 1.0, "asinh": 0.1, "log": 0.001}
"""What is used for each stretch unless it is given; for linear, it is of no use."""


class Stars(Arrays, frozen=True, eq=False, dict=True, tag_field="type", tag="stars"):
    """Points that shine: smaller than pixels, seen as light that adds up, never as surfaces.

    Each spreads its light over the three by three pixels around it, so that none falls between
    pixels, and moves smoothly. What adds up in a pixel becomes its brightness by a stretch, and its
    colour is the mean of the colours of the light there. This is added to what else the picture
    shows. A point is seen where nothing is nearer in its pixel; it lights nothing, and no ray meets
    it: it has no ids, normals, depth or shadow, `Image.flat` does not show it, and it is in no
    scene file.

    Attributes
    ----------
    center : array (n, 3)
        Places in world space; float64 or float32 as given, all else becomes float64.
    emission : array (n,) or float
        How much light each gives to the picture, in any unit, ≥ 0, or one for all; distance does
        not change it.
    color : array (n, 3) or (3,)
        Colours of the light, or one for all, as uint8.
    stretch : str
        How the light that adds up becomes brightness, with x for light in parts of `peak`:
        ``"linear"``, x itself; ``"asinh"``, ``asinh(x/s) / asinh(1/s)`` with the softening s, which
        is linear far below s and logarithmic far above it; ``"log"``,
        ``log(1 + x/s) / log(1 + 1/s)``.
    softening : float or None
        The light, in parts of `peak`, from which on it counts by its logarithm; None for 0.1 with
        asinh, and 0.001 with log.
    peak : float or None
        The light of a pixel that is as bright as can be, in the unit of `emission`, > 0; None for
        what 99.5 % of the pixels with light do not exceed. Give it for sequences of pictures, which
        else flicker.

    Raises
    ------
    SceneError
        If an array has the wrong shape or holds a wrong number, or a value is not right.

    References
    ----------
    R. Lupton et al., "Preparing red-green-blue images from CCD data", Publications of the
    Astronomical Society of the Pacific 116, 2004: the stretch by asinh that keeps colours. The
    stretches and their softenings are those of ``astropy.visualization``.
    """

    center: Floats
    emission: Floats | float
    color: Bytes
    stretch: Stretch
    softening: Softening | None
    peak: Positive | None

    COLUMNS = MappingProxyType({"center": POINT, "emission": EMISSION, "color": COLOR})
    EACH = "position"
    _in_code = MappingProxyType(
        {
            "emission": 1.0,
            "color": (255, 255, 255),
            "stretch": "asinh",
            "softening": None,
            "peak": None,
        }
    )

    @classmethod
    def from_arrays(
        cls, values: Mapping[str, object], place: str, called: Mapping[str, str] = NO_NAMES
    ) -> Self:
        """Make points as calling the class does, as `Arrays.from_arrays` says."""
        made: Self = make_unchecked(
            cls, **check_arrays(cls.COLUMNS, values, place, called), **_checked(values, place)
        )
        return made

    @property
    def soft(self) -> float:
        """The softening that is used."""
        return SOFTENINGS[self.stretch] if self.softening is None else self.softening

    def hull(self) -> list[tuple[Floats, Floats | float, Floats | None]]:
        """Return the balls whose hulls these are: points."""
        return [(self.center, 0.0, None)]

    def arrays(self) -> "list[NDArray[Any]]":
        """Return what the attributes hold, as arrays, those of the stretch too."""
        import numpy as np

        how = [STRETCHES.index(self.stretch), self.soft, self.peak or 0.0]
        return [*super().arrays(), np.array(how, np.float64)]

    def __eq__(self, other: object) -> bool:
        """Tell whether the same points stand in the same order, and look the same."""
        if not isinstance(other, Stars):
            return NotImplemented
        mine, its = ((one.stretch, one.soft, one.peak) for one in (self, other))
        return mine == its and bool(super().__eq__(other))

    __hash__ = None  # arrays are compared, and may change

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: ArrayLike,
            emission: ArrayLike = 1.0,
            color: ArrayLike = ...,
            stretch: Stretch = "asinh",
            softening: float | None = None,
            peak: float | None = None,
        ) -> None: ...


def _checked(values: Mapping[str, object], place: str) -> dict[str, Any]:
    """Return what is no array of points that shine."""
    from vtray.scene.checks.scene_check import from_code

    kinds: dict[str, Any] = {"stretch": Stretch, "softening": Softening, "peak": Positive}
    given = {
        name: value for name, value in values.items() if value is not None or name == "stretch"
    }
    found = {
        name: from_code(given[name], kinds[name], place + name) for name in kinds if name in given
    }
    return {"softening": None, "peak": None, **found}


def check_in_file(objects: Iterable[object]) -> None:
    """Raise SceneError if there are points that shine, which are in no scene file."""
    for index, item in enumerate(objects):
        if isinstance(item, Stars):
            remedy = "keep the particles, and save the picture"
            raise SceneError(f"Scene.objects[{index}]: scene files hold no stars; {remedy}")
