"""A picture that takes long: a preview while it grows, and what there is of it after Ctrl-C."""

import argparse
import math
import os
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from vtray.base.errors import OutputError, VtrayError, printable
from vtray.base.signals import Postponed, end_by
from vtray.commands.annotation_options import annotations_of
from vtray.commands.command import print_note
from vtray.commands.data_options import inputs_of

if TYPE_CHECKING:
    from vtray.image.image import Image
    from vtray.scene.scene import Scene

PREVIEW_SECONDS = 2.0
"""The least time from one preview to the next."""

Progress = Callable[[str, int, int], None]


def check_preview(options: argparse.Namespace) -> None:
    """Raise OutputError, before any work is done, if the preview cannot be written."""
    from vtray.base.atomic_file import check_replaceable, check_spares, check_writable
    from vtray.image.formats.image_format import check_annotated_format, check_format

    preview = options.preview
    if preview is None:
        return
    remedy = "choose another name for the preview"
    check_format(preview, background=options.background)
    if annotations_of(options):
        check_annotated_format(preview)
    check_replaceable(preview, remedy)
    check_writable(preview)
    inputs = [*inputs_of(options), *([options.replay] if options.replay else ())]
    check_spares(preview, inputs, "is a file that is read", remedy)
    # OUTPUT, which need not be there yet, is written only when it is whole.
    if os.path.realpath(preview) == os.path.realpath(options.output):
        message = f"{preview}: is OUTPUT itself; {remedy}"
        raise OutputError(message)
    check_spares(preview, [options.output], "is OUTPUT itself", remedy)


def check_preview_of(scene: "Scene", options: argparse.Namespace) -> None:
    """Raise an error if the preview is a part of the scene, or cannot hold the picture."""
    from vtray.image.formats.image_format import check_format
    from vtray.scene.arrays import check_spares_data
    from vtray.scene.light_types import images_of

    if options.preview is not None:
        check_spares_data(options.preview, [*scene.objects, *images_of(scene.lights)])
        background = options.background or scene.render.background
        size = options.size or scene.render.size or scene.camera.size
        check_format(options.preview, background=background, size=size)


class Growing:
    """A context in which a picture is rendered: shows and keeps of it what the options ask for.

    With ``--keep-partial``, a signal that comes while rays are traced does not end the process
    before what there is has been saved; a second one does.

    Parameters
    ----------
    options
        The options.
    annotate
        What is painted on the picture once it is finished, as keywords of `vtray.Image.annotated`.
    warn
        Called with a line where a preview cannot be written, once: the picture goes on.
    """

    def __init__(
        self,
        options: argparse.Namespace,
        annotate: Mapping[str, Any],
        warn: Callable[[str], object],
    ) -> None:
        self._options, self._annotate = options, annotate
        self._warn: Callable[[str], object] | None = warn
        self._signal = Postponed()
        self._is_tracing = False
        self._last: Image | None = None

    def arguments(self, progress: Progress | None) -> dict[str, Any]:
        """Return what `vtray.render` is to be called with, and with a progress bar if there is one.

        Nothing is asked of it that the options do not need.
        """
        has_preview, keeps = self._options.preview is not None, self._options.keep_partial
        given: dict[str, Any] = {}
        if has_preview or keeps:
            given["on_update"] = self._update
            given["update_seconds"] = PREVIEW_SECONDS if has_preview else math.inf
        if progress is not None or keeps:
            given["progress"] = self._watch(progress) if keeps else progress
        return given

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """Save what there is if the render was interrupted."""
        if self._is_tracing:
            self._signal.__exit__()
        if isinstance(error, KeyboardInterrupt) and self._options.keep_partial:
            self._keep()
            self._end_if_told()

    def finish(self, image: "Image") -> None:
        """Save the whole picture, and let the preview show it."""
        self._save(image)
        if self._options.preview is not None:
            self._write_preview(image, self._annotate)
        self._end_if_told()

    def _watch(self, progress: Progress | None) -> Progress:
        """Return what `vtray.render` calls from time to time, which ends it if a signal came."""

        def look(step: str, done: int, total: int) -> None:
            if step == "trace" and not self._is_tracing:
                self._signal.__enter__()
                self._is_tracing = True
            if progress is not None:
                progress(step, done, total)
            if self._signal.number:
                raise KeyboardInterrupt

        return look

    def _update(self, image: "Image") -> None:
        """Show and keep a part of the picture."""
        self._last = image
        if self._options.preview is not None:
            self._write_preview(image, {})  # to paint on it may take as long as to trace it

    def _save(self, image: "Image") -> None:
        """Write a picture, whole or not, as the options say."""
        from vtray.image.finished import save_finished

        options = self._options
        save_finished(image, options.output, self._annotate, options.bits, options.aov or ())

    def _write_preview(self, image: "Image", annotate: Mapping[str, Any]) -> None:
        """Write the preview, or say once why that is not possible."""
        from vtray.image.finished import save_finished

        try:
            save_finished(image, self._options.preview, annotate)
        except VtrayError as error:
            if self._warn is not None:
                self._warn(f"the preview is left out: {error}")
            self._warn = None

    def _keep(self) -> None:
        """Save what there is of a picture that was interrupted, and say how much that is."""
        output, image = self._options.output, self._last
        note = "was interrupted before there was anything to keep"
        if image is not None and image.partial is not None:
            try:
                self._save(image)
            except VtrayError as error:
                print_note(f"Error: {error}")
                return
            note = f"holds a part of the picture: {100 * image.partial:.0f} % of its tiles are done"
        if not self._options.quiet:
            print_note(printable(f"vtray: {output} {note}"))

    def _end_if_told(self) -> None:
        """End the process if a signal came that had to wait."""
        if self._signal.number:
            end_by(self._signal.number)
