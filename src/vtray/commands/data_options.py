"""The options of data: how particles of a file become a picture.

They are only made where one of them is used, or help is asked for: a scene file need not wait.
"""

import argparse
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from vtray.base.errors import UsageError
from vtray.base.file_series import files_of
from vtray.base.number import number_in
from vtray.commands.annotation_options import labels_of
from vtray.commands.command import Parser
from vtray.commands.values import between, pair_in, positive, wrong

STRETCHES = ("linear", "asinh", "log")
STYLES = ("spacefill", "ball-and-stick", "licorice", "points")
VIEWS = ("x", "-x", "y", "-y", "z", "-z", "top", "bottom", "front", "back", "left", "right", "iso")


def _integer(text: str) -> int:
    if not re.fullmatch(r"[-+]?[0-9]{1,18}", text):
        raise wrong("an integer such as 0, or -1 for the last", text)
    return int(text)


def _limits(text: str) -> tuple[float, float]:
    pair = pair_in(text)
    if pair is None:
        raise wrong("two numbers such as -1,1", text)
    return pair


def _times(text: str) -> tuple[int, ...]:
    if not re.fullmatch(r"[0-9]{1,6}(,[0-9]{1,6}){2}", text):
        raise wrong("three integers such as 3,3,1", text)
    return tuple(map(int, text.split(",")))


def _boundary(text: str) -> bool | float:
    """Return the value of ``--boundary``, of which "" stands for none."""
    return between(0.0, 0.5, "a part of the cell's edge, up to 0.5")(text) if text else True


def _radii(text: str) -> str | float:
    value = number_in(text)
    return text if math.isnan(value) else value


def _view(text: str) -> str | tuple[float, float]:
    if text in (*VIEWS, "auto"):
        return text
    pair = pair_in(text)
    if pair is None:
        raise wrong(f"{', '.join(VIEWS)}, auto, or degrees such as 30,20", text)
    return pair


def _position(text: str) -> dict[str, str]:
    """Return what a table calls the places, as `vtray.read` is told."""
    names = [name.strip() for name in text.split(",")]
    if not all(names) or len(names) not in (1, 3):
        raise wrong("three names of columns such as px,py,pz, or one", text)
    return {"position": text} if len(names) == 1 else dict(zip("xyz", names, strict=True))


YES_OR_NO: dict[str, Any] = {"action": argparse.BooleanOptionalAction, "default": None}
FLAG: dict[str, Any] = {"action": "store_true", "default": None}

WHAT: dict[str, dict[str, Any]] = {
    "frame": {"metavar": "N", "type": _integer, "help": "which frame, from 0; -1 is the last"},
    "format": {
        "metavar": "NAME",
        "help": "what the file is where its name does not say it: xyz, lammps-dump, csv, ...",
    },
    "trajectory": {
        "metavar": "FILE",
        "type": Path,
        "help": "a second file with the places of all frames, such as .xtc or .dcd",
    },
    "position": {
        "metavar": "NAMES",
        "type": _position,
        "help": "the columns of a table that are the places: px,py,pz, or one of three numbers",
    },
    "columns": {**FLAG, "help": "write no image, print what is known of the particles"},
    "select": {"metavar": "EXPR", "help": "draw those alone, such as \"element == 'O' and z > 3\""},
    "replicate": {"metavar": "A,B,C", "type": _times, "help": "show the cell so many times"},
    "boundary": {
        "metavar": "PART",
        "type": _boundary,
        "help": "show what is on faces of the cell on the opposite ones, too; =0.1 for a tenth of "
        "a cell more on each side",
    },
    "wrap": {**FLAG, "help": "bring particles into the cell"},
    "unwrap": {**FLAG, "help": "make molecules whole that the cell's border cuts"},
}
"""Which particles are drawn, and where."""

HOW: dict[str, dict[str, Any]] = {
    "style": {"metavar": "NAME", "choices": STYLES, "help": ", ".join(STYLES)},
    "radii": {
        "metavar": "NAME",
        "type": _radii,
        "help": "covalent, vdw, a number, or the name of a column",
    },
    "scale": {
        "metavar": "NUMBER",
        "type": between(1e-20, 1e20, "a number from 1e-20 to 1e20"),
        "help": "multiply all radii by it",
    },
    "bonds": {
        **YES_OR_NO,
        "help": "bonds by covalent radii, of types those that the file names, or none",
    },
    "cutoff": {"metavar": "LENGTH", "type": positive, "help": "bonds of that length or shorter"},
    "hydrogen-bonds": {**FLAG, "help": "hydrogen bonds as dashes"},
    "cell": {**YES_OR_NO, "help": "the edges of the cell, or not"},
    "color": {"metavar": "COLUMN", "help": "colours by a column, or one colour for all"},
    "colors": {"metavar": "jmol|cpk", "choices": ("jmol", "cpk"), "help": "those of elements"},
    "cmap": {"metavar": "NAME", "help": "the colour map of values: viridis, coolwarm, ..."},
    "clim": {
        "metavar": "LOW,HIGH",
        "type": _limits,
        "help": "the values of its first and last colour",
    },
    "norm": {
        "metavar": "log|centered",
        "choices": ("linear", "log", "centered"),
        "help": "how values are spread over it",
    },
    "emission": {
        "metavar": "COLUMN",
        "type": _radii,
        "help": "let points shine, so that their light adds up: by a column, or a number",
    },
    "stretch": {
        "metavar": "NAME",
        "choices": STRETCHES,
        "help": f"how light becomes brightness: {', '.join(STRETCHES)} (asinh unless given)",
    },
    "softening": {
        "metavar": "NUMBER",
        "type": between(1e-9, 1e9, "a number from 1e-9 to 1e9"),
        "help": "from which part of the brightest on it counts by its logarithm",
    },
    "peak": {
        "metavar": "NUMBER",
        "type": positive,
        "help": "the light of a pixel that is as bright as can be",
    },
    "highlight": {"metavar": "EXPR", "help": "let the colours of all others fade"},
    "opacity": {
        "metavar": "NUMBER|COLUMN",
        "type": _radii,
        "help": "share of light that all take on its way through; with --highlight, all others",
    },
    "legend": {**FLAG, "help": "show what the colours are called: elements, or names in a column"},
}
"""What they look like."""

VIEW: dict[str, dict[str, Any]] = {
    "view": {
        "metavar": "VIEW",
        "type": _view,
        "help": "from where: x, -x, ..., top, front, ..., iso, auto, or AZIMUTH,ELEVATION",
    },
    "zoom": {
        "metavar": "NUMBER",
        "type": between(1e-9, 1e9, "a number from 1e-9 to 1e9"),
        "help": "show everything larger by that",
    },
    "orthographic": {**FLAG, "help": "without perspective"},
}
"""From where they are seen."""

GROUPS = {
    "data: which particles": WHAT,
    "data: what they look like": HOW,
    "data: from where they are seen": VIEW,
}
NAMES = tuple(name for group in GROUPS.values() for name in group)

SAME = {"radii": ("--radius",)}
"""Other names of options."""

_FLAGS = {f"--{name}" for name in NAMES} | {"--no-bonds", "--no-cell"}
_FLAGS |= {flag for flags in SAME.values() for flag in flags}
_MAY_BE_NEGATIVE = ("--view", "--clim", "--label", "--frames")


def are_used(arguments: Sequence[str]) -> bool:
    """Tell whether an argument is one of the options, or asks for help."""
    words = {argument.partition("=")[0] for argument in arguments}
    return not words.isdisjoint(_FLAGS | {"-h", "--help"})


def joined(arguments: Sequence[str]) -> list[str]:
    """Return the arguments with values such as -x, which look like options, after a ``=``."""
    found: list[str] = []
    for argument in arguments:
        last = found[-1] if found else ""
        if last in _MAY_BE_NEGATIVE and argument.startswith("-") and argument[1:2] != "-":
            found[-1] = f"{last}={argument}"
        else:
            found.append(argument)
    return found


def add_data_options(parser: Parser) -> None:
    """Add the options to a parser."""
    for title, options in GROUPS.items():
        group = parser.add_argument_group(title)
        for name, known in options.items():
            group.add_argument(f"--{name}", *SAME.get(name, ()), **known)


def given(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options that were given, by their names."""
    names = [name.replace("-", "_") for name in NAMES]
    found = {name: getattr(options, name, None) for name in names}
    return {name: value for name, value in found.items() if value is not None}


def inputs_of(options: argparse.Namespace) -> list[Path]:
    """Return the files that a picture, or a movie, is made of."""
    trajectory = getattr(options, "trajectory", None)
    files = [Path(path) for path in files_of(str(options.scene))]
    return files if trajectory is None else [*files, trajectory]


def check_kind(options: argparse.Namespace, *, is_data: bool) -> None:
    """Raise UsageError if an option is for data and there is a scene file, or the other way round.

    Parameters
    ----------
    options
        The options.
    is_data
        Whether the file is one of data.
    """
    used = given(options)
    if used.get("bonds") is False and "cutoff" in used:
        raise UsageError("--no-bonds and --cutoff: expected one of them")
    if not is_data and used:
        name = next(iter(used)).replace("_", "-")
        raise UsageError(f"--{name} is for files of data, and {options.scene} is a scene")
    columns = [] if is_data else labels_of(options)[1]
    if columns:
        words = f"expected x,y,z:TEXT, got {columns[0]}; columns are those of files of data"
        raise UsageError(f"--label: {words}")
    if is_data and options.replay is not None:
        words = "a picture does not tell how it was made of data"
        raise UsageError(f"--replay is for scene files, and {options.scene} is none; {words}")
