"""The command line: reads the arguments, calls the rest, prints, and sets the exit status."""

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from vtray.command import SUCCESS, Parser, leave, print_result, run_command
from vtray.errors import OutputError

if TYPE_CHECKING:
    from vtray.image import Image
    from vtray.scene import Scene
    from vtray.stopwatch import Stopwatch

HINT = "usage: vtray [-t THREADS] SCENE OUTPUT (more: vtray --help)"


def main() -> NoReturn:
    """Run the command ``vtray`` and exit."""
    leave(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Do what the arguments say; return the exit status."""
    return run_command(lambda: _run(_parse(arguments)), too_large="choose a smaller camera.size")


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the arguments, checked as far as can be without reading the scene."""
    from vtray import __version__

    parser = Parser(
        hint=HINT,
        prog="vtray",
        description="Render a scene of spheres and planes to a PNG image.",
        epilog="example: vtray -t 4 scene.json picture.png",
    )
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


def _run(options: argparse.Namespace) -> int:
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

        print_result(explain_pixel(scene, image, *options.pixel))
    else:
        image.save(options.output)
    clock.lap("write")
    if options.stats:
        _print_stats(clock, image)
    return SUCCESS


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

    if options.quiet or not sys.stderr.isatty():
        return load(options.scene, warn=warn)

    from vtray.progress import announced

    with announced(f"vtray: reading {options.scene} ..."):
        return load(options.scene, warn=warn)


def _render(scene: "Scene", options: argparse.Namespace) -> "Image":
    """Render the scene; on a terminal, show what takes long."""
    # NumPy's linear algebra, unused here, starts a thread for each core that spins for 40 ms.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from vtray.renderer import render

    if options.quiet or not sys.stderr.isatty():
        return render(scene, options.threads)

    from vtray.kernel_folder import is_compiled
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
    from vtray.memory import peak_memory

    stats = image.stats
    steps = ("build", "pack", "trace", "develop")
    # Loading NumPy and LLVM counts as compiling.
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
    if stats["nodes"]:
        lines.append(f"{'nodes':12}{stats['nodes']:,.0f}")
        lines.append(f"{'depth':12}{stats['depth']:,.0f}")
        lines.append(f"{'hierarchy':12}{stats['memory'] / 1e6:,.0f} MB")
    lines.append(f"{'peak memory':12}{peak_memory() / 1e6:,.0f} MB")
    print("\n".join(lines), file=sys.stderr)
