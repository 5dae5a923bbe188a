"""A file of data as a scene: what the options of data say."""

import argparse
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from vtray.animation.annotating import VARYING, annotated
from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.commands import data_options
from vtray.commands.annotation_options import PointLabel, labels_of, value_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from vtray.scene.particles.drawing import Drawn
    from vtray.scene.particles.particles import Particles
    from vtray.scene.scene import Camera, Scene

MOST_LABELS = 2000
"""How many particles may have a label: more can neither be read nor placed in time."""

LOST = 0.1
"""Particles that are narrower beside their cell are hardly seen."""

AROUND = ("colorbar", "title", "time", "scalebar")
"""What options paint around what is shown, which is left room."""

UNDRAWN = ("frame", "format", "trajectory", "position", "columns", "legend")
"""Options that `add_particles` need not know."""


def load_data(options: argparse.Namespace) -> "tuple[Scene, dict[str, Any]]":
    """Read a file of data, and return a scene of its particles as the options say.

    Beside it, what `vtray.Image.annotated` is to be given of the data: a legend, and labels.

    Raises
    ------
    SceneError
        The file cannot be read, or what is asked for is not in it.
    """
    return shown_data(options, read_particles(options))


def shown_data(
    options: argparse.Namespace, particles: "Particles"
) -> "tuple[Scene, dict[str, Any]]":
    """Return a scene of particles as `draw_data` does, and what is painted on it.

    Raises
    ------
    SceneError
        There is nothing to be seen, or what is asked for is not right.
    """
    scene, drawn, marks = draw_data(options, particles)
    if not _is_empty(drawn):
        if len(particles) and not len(drawn.indices):
            words = f"--select: none of the {len(particles)} particles; the cell alone is shown"
            warn_caller(f"{options.scene}: {words}")
        _warn_if_all_fades(options, drawn, particles)
        _warn_if_lost(options, drawn)
        return scene, marks
    if len(particles):
        words = f"--select: expected some of the {len(particles)} particles, got none"
    else:
        words = f"frame {particles.frame}: expected particles, got none, nor a cell"
    raise SceneError(f"{options.scene}: {words}")


def draw_data(
    options: argparse.Namespace,
    particles: "Particles",
    camera: "Camera | None" = None,
    fixed: "Mapping[str, Any]" = MappingProxyType({}),
) -> "tuple[Scene, Drawn, dict[str, Any]]":
    """Return a scene of particles as the options say, what is in it, and what is painted on it.

    Parameters
    ----------
    options
        The options.
    particles
        The particles.
    camera
        The camera; None for one that shows all of them, if there is anything to be seen.
    fixed
        What else `Scene.add_particles` is given, where the options do not say it.
    """
    from vtray.rendering.beside import MARGIN, fit_beside
    from vtray.scene.particles.view import MOVING, SIZE, VIEW, camera_of, places_of
    from vtray.scene.scene import Scene

    given = data_options.given(options)
    view = {name: given.pop(name) for name in VIEW if name in given}
    drawing = {**fixed, **{name: given[name] for name in given if name not in UNDRAWN}}
    if "cutoff" in drawing:
        drawing["bonds"] = drawing.pop("cutoff")
    scene = Scene()
    size, has_cell = options.size or SIZE, particles.cell is not None
    try:
        if camera is not None:
            scene.camera = camera
        elif drawing.get("style") == "points":
            scene.camera = camera_of(places_of(particles), has_cell, size, MARGIN, **view)
        if options.background is not None and not isinstance(options.background, str):
            drawing["background"] = options.background
        drawn = scene.add_particles(particles, **drawing)
        marks = _marks(options, drawn, particles)
        if camera is None and not _is_empty(drawn):
            annotate = {**{name: value_of(options, name) for name in AROUND}, **marks}
            fit = partial(camera_of, scene, has_cell, size, **view)
            scene.camera = fit_beside(fit, scene.objects, annotate)
            if drawn.style == "points" and drawn.stars is None:
                # They are as large as its pixels, not as those of the camera before it.
                scene.objects.clear()
                drawing["cell"] = drawn.cell is not None
                drawn = scene.add_particles(particles, **drawing)
        if camera is not None:
            scene.render = scene.render.replace(tolerance=MOVING)
    except SceneError as error:
        raise SceneError(f"{options.scene}: {error}") from None
    return scene, drawn, marks


def _warn_if_all_fades(options: argparse.Namespace, drawn: "Drawn", particles: "Particles") -> None:
    """Warn of a highlight that nothing has."""
    from vtray.scene.particles.drawing import chosen

    highlight = data_options.given(options).get("highlight")
    if highlight is None or not len(drawn.indices):
        return
    if not chosen(particles, highlight, "highlight")[drawn.indices].any():
        words = f"none of the {len(drawn.indices)} particles that are drawn; all of them fade"
        warn_caller(f"{options.scene}: --highlight: {words}")


def _warn_if_lost(options: argparse.Namespace, drawn: "Drawn") -> None:
    """Warn of particles that are hardly seen in a cell that was not asked for."""
    import numpy as np

    is_asked_for = data_options.given(options).get("cell") is not None
    if is_asked_for or drawn.cell is None or drawn.copies is not None or drawn.stars is not None:
        return
    corners, balls = drawn.cell[1].center, drawn.spheres
    if len(balls):
        # Axis by axis is five times as fast with 10^7 of them, and takes a sixth of the memory.
        ends = [((x - balls.radius).min(), (x + balls.radius).max()) for x in balls.center.T]
        width, edge = max(high - low for low, high in ends), np.ptp(corners, axis=0).max()
        if width < LOST * edge:
            words = f"the particles are {width / edge:.2g} times as wide as their cell"
            message = f"{options.scene}: {words}; --no-cell shows them larger"
            warn_caller(message)


def _is_empty(drawn: "Drawn") -> bool:
    """Tell whether there is nothing that a camera could be fitted to."""
    return not len(drawn.indices) and drawn.cell is None


def _marks(options: argparse.Namespace, drawn: "Drawn", particles: "Particles") -> dict[str, Any]:
    """Return what is painted on a picture of particles: a legend, and labels."""
    marks: dict[str, Any] = {}
    texts = {name: value_of(options, name) for name in VARYING}
    known = {name: text for name, text in texts.items() if text is not None and "{" in text}
    if known:
        marks |= annotated(known, particles.frame, particles.time, {})
    if value_of(options, "colorbar") and drawn.color_scale is None and drawn.stars is None:
        message = "--color-bar: colours stand for no values; --legend says what names they have"
        raise SceneError(message)
    if data_options.given(options).get("legend"):
        if not drawn.legend and len(drawn.indices):
            message = "--legend: colours have no names; --color-bar says what values they stand for"
            raise SceneError(message)
        marks["legend"] = drawn.legend or None
    _, columns = labels_of(options)
    if columns:
        marks["labels"] = [label for name in columns for label in _labels(drawn, particles, name)]
        # Of atoms behind others, too, would be too many.
        marks["hide_labels"] = True
    return marks


def _labels(drawn: "Drawn", particles: "Particles", name: str) -> list[PointLabel]:
    """Return what a column says of each particle that is drawn, and where it is."""
    from vtray.scene.particles.made_of import made_of

    try:
        values = particles[name]
    except SceneError as error:
        raise SceneError(f"--label: {error}, or give x,y,z:TEXT") from None
    if values.ndim != 1:
        raise SceneError(f"--label: column {name} has {values.shape[1]} numbers each")
    places = drawn.spheres.center if drawn.stars is None else drawn.stars.center
    if len(places) > MOST_LABELS:
        words = f"expected at most {MOST_LABELS} particles to label, got {len(places)}"
        raise SceneError(f"--label {name}: {words}; choose some by --select")
    rows = values[drawn.indices]
    texts = [f"{value:.4g}" for value in rows] if rows.dtype.kind == "f" else [*map(str, rows)]
    times = len(places) // max(len(texts), 1)
    pairs = [*zip(texts * times, places.tolist(), strict=True)]
    if drawn.boundary is not None:
        again = drawn.boundary[0]
        text_of = dict(zip(drawn.indices.tolist(), texts, strict=True))
        source = made_of(again)
        which = [] if source is None else source.indices.tolist()
        pairs += [(text_of[k], at) for k, at in zip(which, again.center.tolist(), strict=True)]
    return [PointLabel(text, (x, y, z)) for text, (x, y, z) in pairs if text.strip()]


def read_particles(options: argparse.Namespace) -> "Particles":
    """Read the frame that is asked for."""
    from vtray.scene.readers.read import read

    given = data_options.given(options)
    return read(options.scene, frame=given.get("frame", 0), **reading_of(options))


def reading_of(options: argparse.Namespace) -> dict[str, Any]:
    """Return what `vtray.read` is told of the file."""
    given = data_options.given(options)
    asked = {"format": "format", "trajectory": "trajectory", "position": "columns"}
    return {theirs: given[name] for name, theirs in asked.items() if name in given}


def describe(options: argparse.Namespace) -> str:
    """Return what is known of the particles, a line for each column."""
    import numpy as np

    particles = read_particles(options)
    count = f"{len(particles)}"
    selected = data_options.given(options).get("select")
    if selected is not None:
        try:
            particles = particles.select(selected)
        except SceneError as error:
            raise SceneError(f"{options.scene}: {error}") from None
        count = f"{len(particles)} of {count}"
    lines = [f"{count} particles, frame {particles.frame}"]
    wide = max(11, *map(len, particles.columns)) + 1 if particles.columns else 12
    for name in ("x", "y", "z", *particles.columns):
        values = particles[name]
        kind = "" if values.ndim == 1 else f" of {values.shape[1]}"
        if values.dtype.kind in "biuf":
            range_ = f"{values.dtype.name}{kind}{_range_of(values)}"
        else:
            words = [str(word) for word in np.unique(values)[:9].tolist()]
            range_ = f"names{kind}: {', '.join(words[:8])}{', ...' if len(words) > 8 else ''}"
        lines.append(f"{name:{wide}}{range_}")
    if particles.bonds is not None:
        lines.append(f"{'bonds':12}{len(particles.bonds)}")
    if particles.cell is not None:
        for name, edge in zip("abc", particles.cell.tolist(), strict=True):
            lines.append(f"{'cell ' + name:12}{', '.join(f'{part:g}' for part in edge)}")
    return "\n".join(lines) + "\n"


def _range_of(values: "NDArray[Any]") -> str:
    """Say from where to where numbers go, and how many are none, to follow their type."""
    import numpy as np

    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    words = f", from {known.min():g} to {known.max():g}" if known.size else ""
    missing = values.size - known.size
    return f"{words}, {missing} NaN" if missing else words
