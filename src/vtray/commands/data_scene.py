"""A file of data as a scene: what the options of data say."""

import argparse
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.commands import data_options
from vtray.commands.annotation_options import PointLabel, labels_of
from vtray.commands.data_options import VIEW

if TYPE_CHECKING:
    from pathlib import Path

    from vtray.scene.particles.drawing import Drawn
    from vtray.scene.particles.particles import Particles
    from vtray.scene.scene import Camera, Scene

SIZE = (1024, 1024)
"""Width and height of a picture of data, unless they are given."""

SAMPLES = 4
"""Rays for each pixel that needs them: pictures of data are figures, whose edges are smooth."""

FINEST, COARSEST = 0.012, 0.03
"""How noisy soft light may be: grain is seen on large balls, and lost among small ones."""

NO_GRAIN = 0.15
"""The tolerance for a ball with a radius of a pixel, and for larger ones a part of that."""

MOST_LABELS = 2000
"""How many particles may have a label: more can neither be read nor placed in time."""

UNDRAWN = ("frame", "columns", "legend")
"""Options that `add_particles` need not know."""

USUAL = (-65.0, 20.0)
"""Azimuth and elevation of the view of a cell: three faces are seen, that in front most."""


def load_data(options: argparse.Namespace) -> "tuple[Scene, dict[str, Any]]":
    """Read a file of data, and return a scene of its particles as the options say.

    Beside it, what `vtray.Image.annotated` is to be given of the data: a legend, and labels.

    Raises
    ------
    SceneError
        The file cannot be read, or what is asked for is not in it.
    """
    from vtray.scene.scene import Scene

    given = data_options.given(options)
    particles = read_particles(options)
    view = {name: given.pop(name) for name in VIEW if name in given}
    drawing = {name: value for name, value in given.items() if name not in UNDRAWN}
    if "cutoff" in drawing:
        drawing["bonds"] = drawing.pop("cutoff")
    scene = Scene()
    size = options.size or SIZE
    try:
        if drawing.get("style") == "points":
            scene.camera = _camera(particles.positions, particles, size, dict(view))
        if options.background is not None and not isinstance(options.background, str):
            drawing["background"] = options.background
        drawn = scene.add_particles(particles, **drawing)
        scene.camera = _camera(scene, particles, size, dict(view))
        tolerance = _tolerance(scene.camera, drawn)
        scene.render = scene.render.replace(samples=SAMPLES, tolerance=tolerance)
    except SceneError as error:
        raise SceneError(f"{options.scene}: {error}") from None
    marks: dict[str, Any] = {}
    if data_options.given(options).get("legend"):
        if not drawn.legend:
            message = "--legend: colours have no names; --color-bar says what values they stand for"
            raise SceneError(f"{options.scene}: {message}")
        marks["legend"] = drawn.legend
    _, columns = labels_of(options)
    if columns:
        marks["labels"] = [
            label for name in columns for label in _labels(drawn, particles, name, options.scene)
        ]
        # Of atoms behind others, too, would be too many.
        marks["hide_labels"] = True
    return scene, marks


def _labels(drawn: "Drawn", particles: "Particles", name: str, file: "Path") -> list[PointLabel]:
    """Return what a column says of each particle that is drawn, and where it is."""
    try:
        values = particles[name]
    except SceneError as error:
        raise SceneError(f"{file}: --label: {error}, or give x,y,z:TEXT") from None
    if values.ndim != 1:
        raise SceneError(f"{file}: --label: column {name} has {values.shape[1]} numbers each")
    places = drawn.spheres.center if drawn.stars is None else drawn.stars.center
    if len(places) > MOST_LABELS:
        words = f"expected at most {MOST_LABELS} particles to label, got {len(places)}"
        raise SceneError(f"{file}: --label {name}: {words}; choose some by --select")
    rows = values[drawn.indices]
    texts = [f"{value:.4g}" for value in rows] if rows.dtype.kind == "f" else [*map(str, rows)]
    times = len(places) // max(len(texts), 1)
    pairs = zip(texts * times, places.tolist(), strict=True)
    return [PointLabel(text, (x, y, z)) for text, (x, y, z) in pairs if text.strip()]


def read_particles(options: argparse.Namespace) -> "Particles":
    """Read the frame that is asked for."""
    from vtray.scene.readers.read import read

    return read(options.scene, frame=data_options.given(options).get("frame", 0))


def describe(options: argparse.Namespace) -> str:
    """Return what is known of the particles, a line for each column."""
    import numpy as np

    particles = read_particles(options)
    lines = [f"{len(particles)} particles, frame {particles.frame}"]
    for name in ("x", "y", "z", *particles.columns):
        values = particles[name]
        kind = "" if values.ndim == 1 else f" of {values.shape[1]}"
        if values.dtype.kind in "biuf" and values.size:
            range_ = f"{values.dtype.name}{kind}, from {values.min():g} to {values.max():g}"
        else:
            words = [str(word) for word in np.unique(values)[:9].tolist()]
            range_ = f"names{kind}: {', '.join(words[:8])}{', ...' if len(words) > 8 else ''}"
        lines.append(f"{name:12}{range_}")
    if particles.bonds is not None:
        lines.append(f"{'bonds':12}{len(particles.bonds)}")
    if particles.cell is not None:
        for name, edge in zip("abc", particles.cell.tolist(), strict=True):
            lines.append(f"{'cell ' + name:12}{', '.join(f'{part:g}' for part in edge)}")
    return "\n".join(lines) + "\n"


def _tolerance(camera: "Camera", drawn: "Drawn") -> float:
    """Return how noisy soft light may be on balls of the usual size."""
    import numpy as np

    spheres = drawn.spheres
    if not len(spheres.center):
        return COARSEST
    middle = spheres.center.mean(axis=0)
    steps = camera.project(middle + np.median(spheres.radius) * np.eye(3)) - camera.project(middle)
    # Three steps at right angles are together seen as long as two that are not foreshortened.
    pixels = np.sqrt(np.square(steps[:, :2]).sum() / 2)
    return float(np.clip(NO_GRAIN / pixels, FINEST, COARSEST)) if pixels > 0 else COARSEST


def _camera(
    subject: Any,  # noqa: ANN401
    particles: "Particles",
    size: tuple[int, int],
    view: dict[str, Any],
) -> "Camera":
    """Return the camera that shows everything."""
    from vtray.scene.scene import Camera

    # A box is known by its faces, and what has none by its shape.
    view.setdefault("view", "auto" if particles.cell is None else USUAL)
    projection: Any = "orthographic" if view.pop("orthographic", False) else "perspective"
    return Camera.fit(subject, projection=projection, size=size, **view)
