"""The options of movies; made, as those of data, only where one of them is used."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from vtray.animation.movie_names import ALONE, is_numbered
from vtray.base.errors import SceneError, UsageError
from vtray.commands.command import Parser
from vtray.commands.values import positive

FLAGS = ("--frames", "--fps", "--turntable", "--resume", "--dask")

FPS = 30.0
"""Pictures in a second, unless they are given."""

_PICTURES_ALONE = ("pixel", "preview", "keep_partial", "replay", "stats")
"""Options that are of no use for movies."""


def are_used(arguments: Sequence[str]) -> bool:
    """Tell whether an argument is one of the options, or asks for help."""
    words = {argument.partition("=")[0] for argument in arguments}
    return not words.isdisjoint({*FLAGS, "-h", "--help"})


def add_movie_options(parser: Parser) -> None:
    """Add the options to a parser."""
    group = parser.add_argument_group("movies: .mp4, .gif, .webp, or frames/%04d.png")
    group.add_argument(
        "--frames",
        metavar="A:B:STEP",
        type=_frames,
        help="a movie of these frames of a file of data, such as 0:500:5; all unless given",
    )
    group.add_argument(
        "--turntable",
        metavar="SECONDS",
        type=positive,
        help="a movie for which the camera goes around once, in so many seconds",
    )
    group.add_argument(
        "--fps", metavar="N", type=positive, help=f"pictures in a second ({FPS:g} unless given)"
    )
    group.add_argument("--resume", action="store_true", help="go on where an earlier run has ended")
    group.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="let the workers of a Dask cluster take the pictures: tcp://HOST:PORT of its "
        "scheduler, or its scheduler file (.json)",
    )


def makes_movie(options: argparse.Namespace, is_data: bool) -> bool:
    """Tell whether a movie is asked for; raise UsageError if options do not go together.

    Parameters
    ----------
    options
        The options.
    is_data
        Whether there is a file of data in place of a scene.
    """
    used = [flag for flag in FLAGS if getattr(options, flag[2:], None)]
    output: Path | None = options.output
    if output is None:
        if used:
            raise UsageError(f"{used[0]} is for movies; expected one as OUTPUT")
        return False
    is_alone = output.suffix.lower() in ALONE
    if not (used or is_alone or (is_data and is_numbered(output))):
        return False
    for name in _PICTURES_ALONE:
        if getattr(options, name, None):
            flag = name.replace("_", "-")
            raise UsageError(f"--{flag} is for pictures, and {output} is a movie")
    _check_what(options, is_data)
    return True


def _check_what(options: argparse.Namespace, is_data: bool) -> None:
    """Raise UsageError if it is not plain what changes from picture to picture."""
    frames, turns = (getattr(options, name, None) for name in ("frames", "turntable"))
    if frames is not None and turns is not None:
        raise UsageError("--frames and --turntable: expected one of them")
    if turns is None and not is_data:
        if frames is not None:
            raise UsageError(f"--frames is for files of data, and {options.scene} is a scene")
        words = "a scene has one picture; --turntable SECONDS goes around it"
        raise UsageError(f"{options.output}: {words}")
    if turns is None and getattr(options, "frame", None) is not None:
        raise UsageError(f"--frame is for pictures, and {options.output} is a movie; use --frames")


def _frames(text: str) -> str:
    """Return the value of ``--frames``."""
    from vtray.scene.readers.which_frames import as_slice

    try:
        as_slice(text)
    except SceneError as error:
        raise argparse.ArgumentTypeError(str(error).removeprefix("frames: ")) from None
    return text
