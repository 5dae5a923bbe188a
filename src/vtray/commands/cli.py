"""The command line: reads the arguments, calls the rest, prints, and sets the exit status."""

import argparse
import contextlib
import sys
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError, printable
from vtray.base.input_file import open_input
from vtray.base.memory import BYTES_PER_PIXEL_AND_MORE, check_memory, check_memory_of_start
from vtray.base.signals import LastStep
from vtray.commands import data_options
from vtray.commands.annotation_options import annotations_of, value_of
from vtray.commands.command import SUCCESS, print_note, print_result, run_command
from vtray.commands.growing import Growing, check_preview, check_preview_of
from vtray.commands.movie_options import makes_movie
from vtray.commands.options import parse, settings_of

if TYPE_CHECKING:
    from vtray.base.stopwatch import Stopwatch
    from vtray.image.image import Image
    from vtray.image.provenance import Provenance
    from vtray.scene.scene import Scene


def run(arguments: Sequence[str]) -> int:
    """Do what the arguments say; return the exit status."""

    def action() -> int:
        options = parse(arguments)
        with _warnings_printed(options):
            return _run(options)

    return run_command(action)


def _run(options: argparse.Namespace) -> int:
    """Read the scene, render it, and write the image or explain the pixel."""
    from vtray.base.stopwatch import Stopwatch

    is_data = _is_data(options)
    if options.columns:
        from vtray.commands.data_scene import describe

        print_result(describe(options))
        return SUCCESS
    if makes_movie(options, is_data):
        _make_movie(options, is_data)
        return SUCCESS
    told = _take_over(options)
    if options.pixel is None:
        _check_output(options, is_data)
    check_memory_of_start()
    clock = Stopwatch()
    scene, of_data = _load_data(options) if is_data else (_load(options), {})
    if options.pixel is None:
        _check_picture(scene, options)
    if told is not None:
        _compare(told, scene, options)
    clock.lap("read")
    annotate = annotations_of(options, of_data)
    with Growing(options, annotate, lambda problem: _warn(problem, options)) as growing:
        image = _render(scene, options, growing)
    clock.lap("render")
    if options.pixel is not None:
        from vtray.commands.explain import explain_pixel

        print_result(explain_pixel(scene, image, *options.pixel))
    else:
        growing.finish(image)
    clock.lap("write")
    if options.stats:
        _print_stats(clock, image)
    return SUCCESS


def _make_movie(options: argparse.Namespace, is_data: bool) -> None:
    """Make a movie in place of a picture."""
    from vtray.base.compiler.compiled import before_compiling
    from vtray.commands.movie import make_movie

    check_memory_of_start()
    is_told = not options.quiet and sys.stderr.isatty()
    before_compiling(_announce_compiling if is_told else None)
    load = None if is_data else lambda: _load(options)
    make_movie(options, load, lambda text: _warn(f"{options.scene}: {text}", options))


def _take_over(options: argparse.Namespace) -> "Provenance | None":
    """Take over the settings of the picture that is to be made again, if there is one."""
    if options.replay is None:
        return None
    from vtray.commands.replay import take_over

    return take_over(options)


def _compare(told: "Provenance", scene: "Scene", options: argparse.Namespace) -> None:
    """Warn of what is not as it was when a picture was made."""
    from vtray.commands.replay import differences

    is_painted = options.pixel is not None or bool(annotations_of(options))
    for difference in differences(told, scene, is_painted=is_painted):
        _warn(f"{options.replay}: {difference}", options)


def _check_output(options: argparse.Namespace, is_data: bool) -> None:
    """Raise OutputError, before any work is done, if the output cannot be written."""
    from vtray.base.atomic_file import check_spares, check_writable
    from vtray.image.formats.image_format import check_annotated_format, check_format

    output = options.output
    check_format(output, options.bits, options.aov or (), options.background)
    if annotations_of(options):
        check_annotated_format(output, options.bits)
    check_writable(output)
    what = f"is the {'data' if is_data else 'scene'} file itself"
    check_spares(output, data_options.inputs_of(options), what, "choose another name for the image")
    check_preview(options)


def _check_picture(scene: "Scene", options: argparse.Namespace) -> None:
    """Raise an error if the output is a part of the scene, or cannot hold the picture."""
    from vtray.image.formats.image_format import check_format, find_format
    from vtray.scene.arrays import check_spares_data
    from vtray.scene.light_types import images_of

    check_spares_data(options.output, [*scene.objects, *images_of(scene.lights)])
    background = options.background or scene.render.background
    size = options.size or scene.render.size or scene.camera.size
    how = check_format(options.output, options.bits, options.aov or (), background, size)
    least = find_format(options.output).memory[how.bits]
    width, height = map(int, size)
    check_memory(width, height, least=BYTES_PER_PIXEL_AND_MORE if how.aov else least)
    check_preview_of(scene, options)
    if value_of(options, "colorbar") is True:
        _check_color_bar(scene)


def _check_color_bar(scene: "Scene") -> None:
    """Raise SceneError if a colour bar would have nothing to show."""
    from vtray.figures.color_bar import color_scales
    from vtray.scene.stars import Stars

    if not color_scales(scene.objects) and not any(isinstance(k, Stars) for k in scene.objects):
        message = "--color-bar: colours stand for no values, as scene files hold colours alone"
        raise SceneError(message)


@contextlib.contextmanager
def _warnings_printed(options: argparse.Namespace) -> Iterator[None]:
    """Print what Python warns of as this command prints its own warnings."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        _warn(str(message), options)

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield


def _warn(message: str, options: argparse.Namespace) -> None:
    """Print a warning on stderr."""
    if not options.quiet:
        print_note(f"Warning: {printable(message)}")


def _is_data(options: argparse.Namespace) -> bool:
    """Tell whether there is a file of data in place of a scene; see that the options are for it."""
    given = data_options.given(options)
    is_data = not given.keys().isdisjoint({"format", "trajectory"})
    if options.scene.suffix != ".json" and not is_data:
        from vtray.scene.readers.reader_table import is_data as is_called_data

        is_data = is_called_data(str(options.scene))
    if is_data or given or options.label:
        data_options.check_kind(options, is_data=is_data)
    # Workers of a cluster have as many threads as they were started with.
    if options.threads is None and not is_data and not getattr(options, "dask", None):
        options.threads = 1
    return is_data


def _load_data(options: argparse.Namespace) -> "tuple[Scene, dict[str, Any]]":
    """Read a file of data, and make a scene of it, and what is painted on its picture."""
    from vtray.commands.data_scene import load_data

    return load_data(options)


def _load(options: argparse.Namespace) -> "Scene":
    """Read the scene file."""
    from vtray.scene.files.scene_file import load

    def warn(message: str) -> None:
        _warn(message, options)

    announced: Any = contextlib.nullcontext
    if not options.quiet and sys.stderr.isatty():
        from vtray.base.progress import announced
    try:
        with announced(printable(f"vtray: reading {options.scene} ...")):
            return load(options.scene, warn=warn)
    except SceneError as error:
        # Names of scene files may end in anything.
        if options.scene.suffix in (".json", "") or _begins_as_scene(options.scene):
            raise
        raise SceneError(f"{error}; if it is data, say by --format what it is") from None


def _begins_as_scene(path: Path) -> bool:
    """Tell whether a file begins as a scene file does, or cannot be read."""
    from vtray.scene.files.scene_file import begins_as_scene

    try:
        with open_input(path) as file:
            begin: bytes = file.read(64)
    except (OSError, ValueError):
        return True
    return begins_as_scene(begin)


def _render(scene: "Scene", options: argparse.Namespace, growing: Growing) -> "Image":
    """Render the scene; on a terminal, show what takes long."""
    from vtray.base.compiler.compiled import before_compiling
    from vtray.rendering.renderer import render

    def warn(message: str) -> None:
        _warn(f"{options.scene}: {message}", options)

    settings = settings_of(options)
    if options.quiet or not sys.stderr.isatty():
        before_compiling(None)
        return render(scene, options.threads, warn=warn, **growing.arguments(None), **settings)

    from vtray.base.progress import ProgressBar

    before_compiling(_announce_compiling)
    progress = ProgressBar()
    try:
        with LastStep(progress.close):
            given = growing.arguments(progress) | settings
            return render(scene, options.threads, warn=warn, **given)
    finally:
        progress.close()


def _announce_compiling(is_kept: bool) -> None:
    """Print on stderr why the render takes longer than the next one will."""
    once = ", once for this machine" if is_kept else ""
    print_note(f"vtray: compiling what this scene needs{once} ...")


def _print_stats(clock: "Stopwatch", image: "Image") -> None:
    """Print on stderr what the render took."""
    from vtray.base.memory import peak_memory

    stats = image.stats
    steps = [step for step in ("build", "pack", "trace", "denoise", "develop") if step in stats]
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
    print_note("\n".join(lines))
