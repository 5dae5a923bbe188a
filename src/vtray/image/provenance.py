"""How a picture was made, as its file tells it: enough to make it again from the same scene."""

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from vtray.base.errors import OutputError, ProvenanceError, why_unreadable
from vtray.base.file_name import file_name
from vtray.base.input_file import open_input
from vtray.base.version import __version__
from vtray.image.aovs import AovName
from vtray.image.formats.image_format import FORMATS, find_format, needs_package
from vtray.image.formats.picture import How, Picture
from vtray.scene.checks.limits import END, Fraction, NonNegative
from vtray.scene.settings import RenderSettings, Settings
from vtray.scene.style import Style

Hash = Annotated[str, Meta(pattern=f"^[0-9a-f]{{16,64}}{END}")]


class Provenance(Settings, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """How a picture was made.

    What an older version did not know yet, and so did not tell, has its default.

    Attributes
    ----------
    version : str
        The version of vtray.
    scene : str
        The hash of the scene.
    shown : str or None
        The hash of the scene as it was rendered, with a camera of another size; None if that is the
        same.
    samples, filter, seed, tolerance, exposure, background, denoise, stops,
    tonemap, integrator, depth, firefly, edge_samples
        As in the settings of the render, those that were left out too.
    size : tuple of int or None
        Width and height of the picture in pixels; None for those of the camera.
    style : Style
        How it is drawn, beside its light.
    lock : float or None
        The light that became white, where another picture decided that.
    keep_lights : bool
        Whether its lights were kept, by which rays are chosen in other ways.
    bits : int
        Bits of each channel of the file.
    aov : tuple of str
        What the file holds beside the picture.
    painted : bool
        Whether a title, a legend or the like is painted on it, of which nothing more is told.
    partial : float or None
        The share of its tiles that were done, from 0 to 1, if it was written before it was whole.
    """

    version: str
    scene: Hash
    shown: Hash | None = None
    style: Style = Style()
    lock: NonNegative | None = None
    keep_lights: bool = False
    bits: Literal[8, 16, 32] = 8
    aov: tuple[AovName, ...] = ()
    painted: bool = False
    partial: Fraction | None = None

    @property
    def settings(self) -> RenderSettings:
        """The settings of the render."""
        return RenderSettings(**{name: getattr(self, name) for name in Settings.__struct_fields__})

    def told(self, name: str) -> Any:  # noqa: ANN401
        """Return a setting of the render, or a part of its style."""
        return getattr(self.style if name in Style.__struct_fields__ else self, name)

    def to_text(self) -> str:
        """Return the JSON that stands in files, all of it ASCII."""
        told = {"version": self.version, "scene": self.scene, **msgspec.structs.asdict(self)}
        for name in _SELDOM:
            if told[name] == getattr(_USUAL, name):
                del told[name]
        return msgspec.json.encode(told).decode("ascii")


_SELDOM = (
    "denoise",
    "stops",
    "tonemap",
    "integrator",
    "depth",
    "firefly",
    "edge_samples",
    "shown",
    "style",
    "keep_lights",
    "painted",
    "partial",
)
"""What is told only where it is not as usual: older versions refuse what they do not know."""

_USUAL = Provenance(version="", scene="0" * 16)


def describe(picture: Picture, how: How, *, painted: bool = False) -> Provenance:
    """Return how a picture was made, maybe with something painted on it, and how it is written."""
    height, width = picture.linear.shape[:2]
    values = {
        **msgspec.structs.asdict(picture.settings),
        "version": __version__,
        "scene": picture.scene_hash,
        "shown": picture.shown_hash,
        "size": (width, height),
        "style": picture.style,
        "lock": float(picture.white) if picture.locked else None,
        "keep_lights": picture.keep_lights,
        "bits": how.bits,
        "aov": tuple(how.aov),
        "painted": painted,
        "partial": picture.partial,
    }
    return msgspec.convert(values, Provenance)


def read_provenance(path: str | bytes | Path) -> Provenance:
    """Read from a picture that vtray has written how it was made.

    Parameters
    ----------
    path
        The picture, in any format that vtray writes.

    Returns
    -------
    Provenance
        The version of vtray, the hash of the scene, and all settings.

    Raises
    ------
    ProvenanceError
        If the file cannot be read, says nothing of how it was made, or something that this
        version of vtray does not know.
    """
    path = Path(file_name(path, ProvenanceError))
    text = _read_text(path)
    if not text:
        message = f"{path}: does not say how it was made; expected a picture that vtray has written"
        raise ProvenanceError(message)
    try:
        return msgspec.json.decode(text, type=Provenance)
    except (msgspec.DecodeError, UnicodeEncodeError) as error:
        version = _version(text)
        by = f" by vtray {version}" if version else ""
        message = f"{path}: what it says of how it was made{by} is not understood: {error}"
        raise ProvenanceError(message) from None


def _read_text(path: Path) -> str | None:
    """Return what a file says of how it was made."""
    try:
        form = find_format(path)
    except OutputError:
        message = f"{path}: expected a picture that vtray has written, one of {', '.join(FORMATS)}"
        raise ProvenanceError(message) from None
    try:
        with open_input(path) as file:
            return form.read(file)
    except ModuleNotFoundError as error:
        raise ProvenanceError(needs_package(path, error.name or "more")) from None
    except MemoryError:
        raise
    except OSError as error:
        if error.errno is None:  # not the system's: the library found no picture of its format
            raise ProvenanceError(_damaged(path, error)) from None
        raise ProvenanceError(f"{path}: {why_unreadable(error, 'picture')}") from None
    except Exception as error:  # noqa: BLE001 - a damaged file makes libraries raise almost anything
        raise ProvenanceError(_damaged(path, error)) from None


def _damaged(path: Path, error: Exception) -> str:
    kinds = ", ".join(FORMATS)
    reason = str(error).splitlines()[0] if str(error) else repr(error)
    return f"{path}: is damaged, or none of {kinds} as its name says ({reason[:100]})"


def _version(text: str) -> str:
    """Return the version that wrote a provenance that is not understood, "" if it is not there."""
    try:
        found = msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeEncodeError, RecursionError):
        return ""
    version = found.get("version") if isinstance(found, dict) else ""
    return version[:40] if isinstance(version, str) and version.isprintable() else ""
