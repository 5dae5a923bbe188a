"""How a picture is taken of a scene, beside its camera: the settings of a render.

`Settings` defines each of them once: its name, kind, limits and default, and how a command line
writes it. From that come the checks and the words of their errors, the JSON Schema, the options of
the command, what pictures say of how they were made, and what `vtray.render` takes, whose signature
a test compares with it.
"""

import functools
import typing
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Literal,
    NamedTuple,
    Self,
    TypeVar,
    get_args,
)

import msgspec
from msgspec import Meta

from vtray.scene.checks.checked import Checked, Frozen
from vtray.scene.checks.limits import Positive, SizePair, alternatives
from vtray.scene.colors.names import to_rgb
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.vectors import Color

MAX_SAMPLES = 2**16
TOLERANCE = 0.008
"""Two of the 255 steps of a picture; what is estimated is about twice the error that there is."""
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
Exposure = Literal["max", "auto"] | Positive
Stops = Annotated[float, Meta(ge=-100, le=100, description="a number from -100 to 100")]
IntegratorName = Literal["direct", "whitted", "path"]
Firefly = Literal["off"] | Positive
MAX_DEPTH = 64
DEPTH = 8
"""Over how many surfaces light is followed by default."""

Depth = Annotated[
    Annotated[int, Meta(ge=0, le=MAX_DEPTH)]
    | Annotated[float, Meta(ge=0, le=MAX_DEPTH, multiple_of=1)],
    Meta(description=f"an integer from 0 to {MAX_DEPTH}"),
]
Background = Literal["black", "transparent", "sky"] | Color

FILTERS: tuple[str, ...] = get_args(FilterName)
"""The names of the reconstruction filters."""


class Option(NamedTuple):
    """How a command line writes a setting.

    Attributes
    ----------
    form
        What stands for its value, such as "N".
    help
        What it is, in a line.
    words
        What is expected, where a command line writes it in other words than a scene file.
    flags
        Options without a value that stand for one.
    of
        Makes the value of what a command line or code gives, with its place for messages; None
        where the kind says it all. Such an option may be given without a value.
    """

    form: str
    help: str
    words: str = ""
    flags: Mapping[str, str] = MappingProxyType({})
    of: Callable[[Any, str], Any] | None = None


class Settings(msgspec.Struct, frozen=True, gc=False):
    """The settings of a render.

    Each has a default, which is what versions did that did not know it: so their pictures can be
    made again.
    """

    samples: Annotated[Samples, Option("N", "rays for each pixel that needs them")] = 1
    filter: Annotated[FilterName, Option("NAME", ", ".join(FILTERS))] = "blackman-harris"
    seed: Annotated[Seed, Option("N", "other places of the samples")] = 0
    size: Annotated[
        SizePair | None,
        Option("WxH", "width and height in pixels", "width and height such as 1200x800"),
    ] = None
    exposure: Annotated[
        Exposure,
        Option(
            "max|auto|NUMBER",
            "max: the brightest channel becomes 255; auto: all but the brightest; a number: light "
            "times that",
        ),
    ] = "max"
    background: Annotated[
        Background,
        Option(
            "COLOR",
            'what is seen where nothing is: black, transparent, sky, "orange", "#e0e8ff", ...',
            'black, transparent, sky, a name such as "orange", or digits such as "#e0e8ff"',
            MappingProxyType({"--alpha": "transparent"}),
        ),
    ] = "black"
    tolerance: Annotated[
        Positive, Option("NUMBER", "how noisy soft light may be: the error of a pixel, 1 for white")
    ] = TOLERANCE
    denoise: Annotated[
        Annotated[bool, Meta(description="true or false")],
        Option("", "take the grain of soft light out by Open Image Denoise"),
    ] = False
    stops: Annotated[Stops, Option("NUMBER", "twice as bright for each, after any exposure")] = 0.0
    tonemap: Annotated[ToneMapName, Option("NAME", ", ".join(get_args(ToneMapName)))] = "linear"
    integrator: Annotated[
        IntegratorName,
        Option("NAME", "direct; whitted: mirrors and glass are followed; path: all light is"),
    ] = "direct"
    depth: Annotated[Depth, Option("N", "over how many surfaces light is followed")] = DEPTH
    firefly: Annotated[
        Firefly,
        Option("off|NUMBER", "the brightest light of a sample, 1 for white: less grain, too dark"),
    ] = "off"
    edge_samples: Annotated[
        Samples, Option("N", "rays for the pixels whose samples differ most, if that is more")
    ] = 1

    def __post_init__(self) -> None:
        """Hold equal settings equally: integers as such, and the colour black as "black"."""
        for name, (kind, _) in kinds_of(type(self)).items():
            msgspec.structs.force_setattr(self, name, _whole(getattr(self, name), kind))
        if self.background == Color(0, 0, 0):
            msgspec.structs.force_setattr(self, "background", "black")


@functools.cache
def kinds_of(cls: type[msgspec.Struct]) -> dict[str, tuple[Any, Option]]:
    """Return the kind of each setting that a type has, and how a command line writes it."""
    kinds = typing.get_type_hints(cls, include_extras=True)
    return {
        name: (kinds[name], extra)
        for name in cls.__struct_fields__
        for extra in getattr(kinds[name], "__metadata__", ())
        if isinstance(extra, Option)
    }


def _whole(value: object, kind: Any) -> Any:  # noqa: ANN401
    """Return a value of a kind, with integers as such."""
    if isinstance(value, tuple):
        (pair,) = (part for part in alternatives(kind) if typing.get_origin(part) is tuple)
        return tuple(map(_whole, value, get_args(pair)))
    return int(value) if isinstance(value, float) and int in alternatives(kind) else value


class _CheckedSettings(Checked):
    """Makes construction in code take a background in all ways to write a colour.

    It takes an integrator as scene files do, too.
    """

    def _convert(cls, values: dict[str, Any]) -> None:  # noqa: N805
        """Convert what is given."""
        background: Any = values.get("background")
        is_kept = isinstance(background, str) and background in get_args(get_args(Background)[0])
        if background is not None and not is_kept:
            values["background"] = Color(*to_rgb(background, f"{cls.__name__}.background"))
        integrator: Any = values.get("integrator")
        if isinstance(integrator, Mapping) and {"type"} <= {*integrator} <= {"type", "depth"}:
            values.update({**integrator, "integrator": integrator["type"]})
            del values["type"]


class RenderSettings(
    Settings, Frozen, metaclass=_CheckedSettings, frozen=True, omit_defaults=True, gc=False
):
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
    exposure : "max", "auto" or float
        "max": the brightest channel of the picture becomes 255. "auto": that of 99 of 100 pixels
        with light does at the most, and what is brighter is cut off. A number: light is multiplied
        by it, so that for 1 a surface that a light of intensity 1 shines on squarely gets its
        color.
    background : "black", "transparent", "sky" or Color
        What is seen where there is nothing; "sky" shows the skies among the lights. Code may write
        a colour in all ways of `vtray.colors.to_rgb`.
    tolerance : float
        How noisy soft light may be: the estimated standard error of a pixel, > 0, 1 for white.
    denoise : bool
        Whether the grain of soft light is taken out by Open Image Denoise.
    stops : float
        How often the light is doubled after that exposure, from -100 to 100; below 0 it is halved.
    tonemap : str
        How light becomes the numbers of a file: "linear" as it is; "srgb", "filmic" and "agx"
        encoded for monitors, for which all colours that are given are taken for sRGB.
    integrator : str
        What light is followed: "direct", that which comes from lights straight to what is seen;
        "whitted", also over mirrors, metal and glass; "path", all light, by paths that go on at
        random from whatever they meet, which takes many samples. Code may write it with a depth, as
        scene files do: ``{"type": "path", "depth": 12}``.
    depth : int
        Over how many surfaces light is followed at the most, from 0 to 64; 8 by default.
    firefly : "off" or float
        The brightest channel that one sample may bring to a pixel by "whitted" and "path", > 0, 1
        for white: specks of light become darker, and so does the picture; edges of bright things
        become smooth. "off" by default.
    edge_samples : int
        Rays for each pixel whose samples differ much, if that is more than `samples`, from 1 to
        65536: for one pixel of sixteen at the most, those that differ most. In direct light, where
        that of the lamps is not kept apart, and without a lens.
    """

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            samples: int = 1,
            filter: FilterName = "blackman-harris",  # noqa: A002
            seed: int = 0,
            size: Sequence[int] | None = None,
            exposure: Literal["max", "auto"] | float = "max",
            background: "str | Color | Sequence[float]" = "black",
            tolerance: float = 0.008,
            denoise: bool = False,
            stops: float = 0.0,
            tonemap: ToneMapName = "linear",
            integrator: IntegratorName | Mapping[str, object] = "direct",
            depth: int = 8,
            firefly: Literal["off"] | float = "off",
            edge_samples: int = 1,
        ) -> None: ...

    def replace(self, **changes: Any) -> Self:  # noqa: ANN401
        """Return these settings with others in place of some; None means as here.

        Raises
        ------
        SceneError
            If a value is not right.
        TypeError
            If there is no setting of a name.
        """
        given = {name: value for name, value in changes.items() if value is not None}
        return type(self)(**{**msgspec.structs.asdict(self), **given}) if given else self


Given = TypeVar("Given", bound=Frozen)


def overridden(settings: Given, given: Mapping[str, Any]) -> Given:
    """Return settings with those that are given in place of some.

    Parameters
    ----------
    settings
        The settings, or the style.
    given
        Values by their names, for instance the arguments of a function. None means as it is, and
        what is no setting is passed over.

    Raises
    ------
    SceneError
        If a value is not right.
    """
    names = settings.__struct_fields__
    return settings.replace(**{name: given[name] for name in names if given.get(name) is not None})
