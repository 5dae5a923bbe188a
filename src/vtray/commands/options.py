"""The options of the command line, and what their values may be."""

import argparse
import os
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from vtray.commands import data_options, movie_options
from vtray.commands.annotation_options import WITH_VALUE, add_annotations, with_values
from vtray.commands.command import Parser
from vtray.commands.setting_options import add_settings, flags_of_parts, value_apart, with_parts
from vtray.commands.values import wrong
from vtray.image.aovs import AOVS
from vtray.scene.checks.json_tree import short
from vtray.scene.settings import RenderSettings
from vtray.scene.style import PICTURE, Style

HINT = "usage: vtray [-t THREADS] SCENE OUTPUT (more: vtray --help)"


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the arguments, checked as far as can be without reading a file."""
    from vtray.base.version import __version__

    parser = Parser(
        hint=HINT,
        prog="vtray",
        usage="vtray [OPTION ...] SCENE OUTPUT",
        description="Render a scene of spheres, cylinders, cones and planes, or data of particles, "
        "to an image.",
        epilog="examples: vtray -t 4 --samples 16 scene.json picture.png; "
        "vtray --bonds --view front run.extxyz last.png",
    )
    parser.add_argument(
        "scene",
        metavar="SCENE",
        type=_or_stream("/dev/stdin"),
        help="the scene, a JSON file, or - for standard input; or a file of data: .xyz, .pdb, ...",
    )
    parser.add_argument(
        "output",
        metavar="OUTPUT",
        type=_or_stream("/dev/stdout"),
        nargs="?",
        help="the image to write: .png, .tif, .jpg, .webp, .exr or .npz; - for a PNG on standard "
        "output; or a movie: .mp4, .gif, .webp, or numbered pictures such as frames/%%04d.png",
    )
    parser.add_argument(
        "-t",
        "--threads",
        type=_thread_count,
        help="threads that render (1 unless given; for data, as many as there are cores)",
    )
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="no warnings, no progress, only errors"
    )
    parser.add_argument("-V", "--version", action="version", version=f"vtray {__version__}")
    if data_options.are_used(arguments):
        data_options.add_data_options(parser)
    if movie_options.are_used(arguments):
        movie_options.add_movie_options(parser)
    _add_settings(parser)
    _add_output(parser)
    add_annotations(parser)
    _add_growing(parser)
    _add_reports(parser)
    # SCENE and OUTPUT may stand apart.
    joined = data_options.joined(with_values(with_parts(arguments, Style)))
    options, extra = parser.parse_known_intermixed_args(_files_after_dashes(joined))
    if extra:
        parser.error(_why_extra(extra, joined, options.output))
    options.columns = getattr(options, "columns", None)
    if options.output is None and options.pixel is None and not options.columns:
        parser.error("OUTPUT is missing")
    if options.pixel is not None and (options.preview is not None or options.keep_partial):
        parser.error("--preview and --keep-partial are of no use with --pixel")
    # No options, but a picture that is replayed may have been locked, or have kept its lights.
    options.lock = options.keep_lights = None
    return options


def _why_extra(extra: Sequence[str], arguments: Sequence[str], output: Path) -> str:
    """Return what is wrong with arguments of which some are left over."""
    are_files = not any(text.startswith("-") for text in extra)
    apart = value_apart(arguments, {*WITH_VALUE, *flags_of_parts(Style)}) if are_files else ""
    if apart:
        return apart
    # What a shell makes of a pattern.
    are_frames = are_files and output.is_file() and all(map(os.path.isfile, extra[:-1]))
    hint = "; a pattern for frames in several files needs quotes, as in 'dump.*'"
    return f"unrecognized arguments: {short(' '.join(extra))}{hint if are_frames else ''}"


def _files_after_dashes(arguments: Sequence[str]) -> list[str]:
    """Return arguments in which names of files that follow ``--`` do not look like options."""
    if "--" not in arguments:
        return list(arguments)
    end = arguments.index("--")
    names = arguments[end + 1 :]
    # A single dash is still a stream.
    return [*arguments[:end], *(f"./{name}" if name[:1] == "-" != name else name for name in names)]


def _or_stream(stream: str) -> Callable[[str], Path]:
    """Return what makes a path of an argument, or for ``-`` that of a stream."""
    return lambda text: Path(stream if text == "-" else text)


def settings_of(options: argparse.Namespace) -> dict[str, Any]:
    """Return the settings and parts of a style that the options give, to render with."""
    given = {name: getattr(options, name) for name in (*PICTURE, "lock", "keep_lights")}
    return {name: value for name, value in given.items() if value is not None}


def _add_settings(parser: Parser) -> None:
    """Add how the picture is taken, which is as the scene says unless said otherwise."""
    group = parser.add_argument_group("the picture (otherwise as the scene says)")
    add_settings(group, RenderSettings)
    add_settings(group, Style)
    group.add_argument(
        "--replay",
        metavar="PICTURE",
        type=Path,
        help="take what is not given here from a picture that vtray has written",
    )


def _add_output(parser: Parser) -> None:
    """Add what the file holds."""
    group = parser.add_argument_group("the file")
    group.add_argument(
        "--bits", metavar="8|16", type=_bits, help="bits of each channel; 16 for .png, .tif, .npz"
    )
    group.add_argument(
        "--aov",
        metavar="NAMES",
        type=_aov,
        help=f"for .exr and .npz: any of {','.join(AOVS)}",
    )


def _add_growing(parser: Parser) -> None:
    """Add what is shown and kept before the picture is there."""
    group = parser.add_argument_group("a picture that takes long")
    group.add_argument(
        "--preview",
        metavar="FILE",
        type=_or_stream("/dev/stdout"),
        help="write the picture so far every few seconds, in the end the whole one",
    )
    group.add_argument(
        "--keep-partial",
        action="store_true",
        help="after Ctrl-C, write to OUTPUT what there is of the picture",
    )


def _add_reports(parser: Parser) -> None:
    """Add what is printed."""
    group = parser.add_argument_group("reports")
    group.add_argument(
        "--stats", action="store_true", help="print seconds, rays and memory on stderr"
    )
    group.add_argument(
        "--pixel",
        metavar="X,Y[:SAMPLE]",
        type=_pixel,
        help="write no image, print how the pixel in column X, row Y got its value, by the ray "
        "through its middle or by one of its samples",
    )


def _thread_count(text: str) -> int:
    """Return the value of ``--threads``."""
    if not re.fullmatch(r"0*[1-9][0-9]{0,8}", text):
        raise wrong("an integer ≥ 1", text)
    return int(text)


def _pixel(text: str) -> tuple[int, ...]:
    """Return the value of ``--pixel``: a column, a row, and maybe the number of a sample."""
    if not re.fullmatch(r"[0-9]{1,9},[0-9]{1,9}(:[0-9]{1,9})?", text):
        raise wrong("column,row such as 12,34", text)
    return tuple(map(int, re.split("[,:]", text)))


def _bits(text: str) -> int:
    """Return the value of ``--bits``; which formats have it is checked later."""
    if text not in ("8", "16", "32"):
        raise wrong("8 or 16", text)
    return int(text)


def _aov(text: str) -> tuple[str, ...]:
    """Return the value of ``--aov``."""
    names = tuple(text.split(","))
    if not set(names) <= set(AOVS):
        raise wrong(f"names of {', '.join(AOVS)} with commas between", text)
    return names
