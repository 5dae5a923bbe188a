"""The command line: reads the arguments, calls the rest, prints, and sets the exit status."""

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from vtray.errors import OutputError, UsageError, VtrayError

if TYPE_CHECKING:
    from vtray.image import Image
    from vtray.scene import Scene
    from vtray.stopwatch import Stopwatch

SUCCESS = 0
FAILURE = 1
INTERRUPTED = 130

USAGE = "usage: vtray [-t THREADS] SCENE OUTPUT (more: vtray --help)"


def main() -> NoReturn:
    """Run the command and exit."""
    status = run(sys.argv[1:])
    sys.stderr.flush()
    # Leave at once: taking everything down takes time, and after Ctrl-C a thread may still be
    # busy in the compiler.
    os._exit(status)


def run(arguments: Sequence[str]) -> int:
    """Do what the arguments say; return the exit status."""
    try:
        _run(_parse(arguments))
        sys.stdout.flush()
    except SystemExit:  # --help and --version have printed what they had to
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        return FAILURE
    except VtrayError as error:
        return _fail(str(error))
    except MemoryError:
        return _fail("out of memory; choose a smaller camera.size")
    except Exception as error:  # noqa: BLE001 - a user never sees a traceback
        return _fail(f"this is a bug in vtray, please report it: {error!r}")
    return SUCCESS


class _Parser(argparse.ArgumentParser):
    """An argument parser whose errors are like all others."""

    def error(self, message: str) -> NoReturn:
        """Raise UsageError instead of printing and exiting with status 2."""
        full = f"{message}; {USAGE}"
        raise UsageError(full)


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the arguments, checked as far as can be without reading the scene."""
    parser = _Parser(
        prog="vtray",
        description="Render a scene of spheres and planes to a PNG image.",
        epilog="example: vtray -t 4 scene.json picture.png",
        allow_abbrev=False,
    )
    from vtray import __version__

    parser.add_argument("scene", metavar="SCENE", type=Path, help="the scene, a JSON file")
    parser.add_argument(
        "output", metavar="OUTPUT", type=Path, nargs="?", help="the image to write, a .png file"
    )
    parser.add_argument(
        "-t", "--threads", type=_thread_count, default=1, help="threads that render (default: 1)"
    )
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="no warnings, no progress, only errors"
    )
    parser.add_argument(
        "--stats", action="store_true", help="print seconds, rays and memory on stderr"
    )
    parser.add_argument(
        "--pixel",
        metavar="X,Y",
        type=_pixel,
        help="write no image, print how the pixel in column X, row Y got its value",
    )
    parser.add_argument("-V", "--version", action="version", version=f"vtray {__version__}")
    options = parser.parse_args(arguments)
    if options.output is None and options.pixel is None:
        parser.error("OUTPUT is missing")
    return options


def _thread_count(text: str) -> int:
    """Return the value of ``--threads``."""
    if not re.fullmatch(r"0*[1-9][0-9]{0,8}", text):
        message = f"expected an integer ≥ 1, got {text}"
        raise argparse.ArgumentTypeError(message)
    return int(text)


def _pixel(text: str) -> tuple[int, int]:
    """Return the value of ``--pixel``."""
    match = re.fullmatch(r"([0-9]{1,9}),([0-9]{1,9})", text)
    if not match:
        message = f"expected column,row such as 12,34, got {text}"
        raise argparse.ArgumentTypeError(message)
    return int(match[1]), int(match[2])


def _run(options: argparse.Namespace) -> None:
    """Read the scene, render it, and write the image or explain the pixel."""
    from vtray.stopwatch import Stopwatch

    if options.pixel is None:
        _check_output(options.scene, options.output)
    clock = Stopwatch()
    scene = _load(options)
    clock.lap("read")
    image = _render(scene, options)
    clock.lap("render")
    if options.pixel is not None:
        from vtray.explain import explain_pixel

        print(explain_pixel(scene, image, *options.pixel), end="")
    else:
        image.save(options.output)
    clock.lap("write")
    if options.stats:
        _print_stats(clock, image)


def _check_output(scene: Path, output: Path) -> None:
    """Raise OutputError, before any work is done, if the output cannot be written."""
    from vtray.atomic_file import check_writable
    from vtray.image_format import check_format

    check_format(output)
    check_writable(output)
    if scene.exists() and output.exists() and scene.samefile(output):
        message = f"{output}: is the scene file itself; choose another name for the image"
        raise OutputError(message)


def _load(options: argparse.Namespace) -> "Scene":
    """Read the scene file."""
    from vtray.scene_file import load

    def warn(message: str) -> None:
        if not options.quiet:
            print(f"Warning: {message}", file=sys.stderr)

    return load(options.scene, warn=warn)


def _render(scene: "Scene", options: argparse.Namespace) -> "Image":
    """Render the scene; on a terminal, show what takes long."""
    from vtray.renderer import render

    if options.quiet or not sys.stderr.isatty():
        return render(scene, options.threads)

    from vtray.compiled import is_compiled
    from vtray.progress import ProgressBar

    if not is_compiled():
        print("vtray: compiling for this machine, only this once ...", file=sys.stderr)
    progress = ProgressBar()
    try:
        return render(scene, options.threads, progress)
    finally:
        progress.close()


def _print_stats(clock: "Stopwatch", image: "Image") -> None:
    """Print on stderr what the render took."""
    from vtray.memory import in_gigabytes, peak_memory

    stats = image.stats
    steps = ("pack", "trace", "develop")
    # Loading Numba counts as compiling.
    compiling = clock.seconds["render"] - sum(stats[step] for step in steps)
    seconds = {
        "read": clock.seconds["read"],
        "compile": compiling,
        **{step: stats[step] for step in steps},
        "write": clock.seconds["write"],
    }
    lines = [f"{step:12}{value:10.4f} s" for step, value in seconds.items()]
    lines.append(f"{'rays':12}{stats['rays']:,.0f}")
    lines.append(f"{'rays/second':12}{stats['rays'] / max(stats['trace'], 1e-9):,.0f}")
    lines.append(f"{'peak memory':12}{in_gigabytes(peak_memory())}")
    print("\n".join(lines), file=sys.stderr)


def _fail(message: str) -> int:
    """Print an error on stderr; return the exit status."""
    print(f"Error: {message}", file=sys.stderr)
    return FAILURE
