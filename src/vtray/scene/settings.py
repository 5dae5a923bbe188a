"""How a picture is taken of a scene, beside its camera: the settings of a render."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta

from vtray.scene.checks.checked import Checked, Frozen, bind
from vtray.scene.checks.limits import Positive, SizePair
from vtray.scene.colors.names import to_rgb
from vtray.scene.vectors import Color

MAX_SAMPLES = 2**16
MAX_SEED = 2**32 - 1

# An integer may be written 16 or 16.0: JSON knows only numbers.
Samples = Annotated[
    Annotated[int, Meta(ge=1, le=MAX_SAMPLES)]
    | Annotated[float, Meta(ge=1, le=MAX_SAMPLES, multiple_of=1)],
    Meta(description=f"an integer from 1 to {MAX_SAMPLES}"),
]
Seed = Annotated[
    Annotated[int, Meta(ge=0, le=MAX_SEED)]
    | Annotated[float, Meta(ge=0, le=MAX_SEED, multiple_of=1)],
    Meta(description=f"an integer from 0 to {MAX_SEED}"),
]
FilterName = Literal["box", "tent", "gaussian", "mitchell", "blackman-harris"]
Exposure = Literal["max"] | Positive
Background = Literal["black", "transparent"] | Color

FILTERS: tuple[str, ...] = get_args(FilterName)
"""The names of the reconstruction filters."""


class _CheckedSettings(Checked):
    """Makes construction in code take a background in all ways to write a colour."""

    def __call__(cls, *args: object, **kwargs: object) -> Any:  # noqa: ANN401, N805
        """Bind the arguments, check and convert them, and make the object."""
        values = bind(cls, args, kwargs)
        background: Any = values.get("background")
        is_kept = isinstance(background, str) and background in ("black", "transparent")
        if background is not None and not is_kept:
            values["background"] = Color(*to_rgb(background, f"{cls.__name__}.background"))
        return super().__call__(**values)


class RenderSettings(Frozen, metaclass=_CheckedSettings, frozen=True, omit_defaults=True, gc=False):
    """How a picture is taken of a scene.

    Attributes
    ----------
    samples : int
        Rays for each pixel that needs them, from 1 to 65536; 1 gives exactly the format's picture.
    filter : str
        How the samples of a pixel are weighted, if there is more than one: "box", "tent",
        "gaussian", "mitchell" or "blackman-harris".
    seed : int
        Chooses among equally good places of the samples, from 0 to 2**32 - 1.
    size : tuple of int, optional
        Width and height of the picture in pixels, instead of those of the camera; the view stays.
    exposure : "max" or float
        "max": the brightest channel of the picture becomes 255. A number: light is multiplied by
        it, so that for 1 a surface that a light of intensity 1 shines on squarely gets its color.
    background : "black", "transparent" or Color
        What is seen where there is nothing. Code may write a colour in all ways of
        `vtray.colors.to_rgb`.
    """

    samples: Samples = 1
    filter: FilterName = "blackman-harris"
    seed: Seed = 0
    size: SizePair | None = None
    exposure: Exposure = "max"
    background: Background = "black"

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            samples: int = 1,
            filter: str = "blackman-harris",  # noqa: A002
            seed: int = 0,
            size: tuple[int, int] | None = None,
            exposure: Literal["max"] | float = "max",
            background: "str | Color | Sequence[float]" = "black",
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold equal settings equally: integers as such, and the colour black as "black"."""
        for name in ("samples", "seed"):
            msgspec.structs.force_setattr(self, name, int(getattr(self, name)))
        if self.size is not None:
            width, height = self.size
            msgspec.structs.force_setattr(self, "size", (int(width), int(height)))
        if self.background == Color(0, 0, 0):
            msgspec.structs.force_setattr(self, "background", "black")

    def replace(self, **changes: Any) -> "RenderSettings":  # noqa: ANN401
        """Return these settings with others in place of some; None means as here.

        Raises
        ------
        SceneError
            If a value is not right.
        TypeError
            If there is no setting of a name.
        """
        given = {name: value for name, value in changes.items() if value is not None}
        return RenderSettings(**{**msgspec.structs.asdict(self), **given})
