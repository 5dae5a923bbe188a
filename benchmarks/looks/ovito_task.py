"""Does a task of the page of eight figures with OVITO, as its users do.

    python ovito_task.py TASK DATA VIEW OUTPUT

DATA is a file that OVITO reads, or an .npz with positions and values; VIEW is what
`figures.py` writes.
Settings are OVITO's own, but for a radius of points. Runs in the peers' own Python environment,
without vtray.
"""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np


def crystal(pipeline: Any, _: dict[str, Any]) -> None:  # noqa: ANN401
    """Bind by van der Waals radii, and show three cells along each edge."""
    from ovito.modifiers import CreateBondsModifier, ReplicateModifier

    pipeline.modifiers.append(CreateBondsModifier(mode=CreateBondsModifier.Mode.VdWRadius))
    pipeline.modifiers.append(ReplicateModifier(num_x=3, num_y=3, num_z=3))


def liquid(pipeline: Any, _: dict[str, Any]) -> None:  # noqa: ANN401
    """Bind by van der Waals radii: OVITO finds no hydrogen bonds."""
    from ovito.modifiers import CreateBondsModifier

    pipeline.modifiers.append(CreateBondsModifier(mode=CreateBondsModifier.Mode.VdWRadius))


def by_value(pipeline: Any, given: dict[str, Any]) -> None:  # noqa: ANN401
    """Colour by a value, with a legend."""
    from ovito.modifiers import ColorCodingModifier

    gradient = (
        ColorCodingModifier.BlueWhiteRed if given["diverges"] else ColorCodingModifier.Viridis
    )
    pipeline.modifiers.append(ColorCodingModifier(property="Value", gradient=gradient()))


TASKS: dict[str, Callable[[Any, dict[str, Any]], None]] = {
    "rutile": crystal,
    "liquid": liquid,
    "colloids": by_value,
    "landscape": by_value,
    "stars": by_value,
}


def main() -> None:
    """Do what the arguments say."""
    from ovito.io import import_file
    from ovito.pipeline import Pipeline
    from ovito.vis import ColorLegendOverlay, TachyonRenderer, Viewport

    task, data, view_file, output = sys.argv[1:]
    with np.load(view_file) as given:
        view = {name: given[name] for name in given.files}
    if data.endswith(".npz"):
        with np.load(data) as arrays:
            given = {name: arrays[name] for name in arrays.files}
        pipeline: Pipeline = _pipeline_of(given)
    else:
        given, pipeline = {}, import_file(data)
    TASKS[task](pipeline, given)
    pipeline.add_to_scene()
    is_flat = bool(view["is_orthographic"])
    kind = Viewport.Type.Ortho if is_flat else Viewport.Type.Perspective
    eye = view["eye"]
    if task == "rutile":
        # OVITO's copies stand at all sides of the cell.
        eye = eye - pipeline.source.compute().cell[:, :3].sum(axis=1)
    viewport = Viewport(
        type=kind,
        fov=float(view["height"]) / 2 if is_flat else float(view["fov"]),
        camera_pos=tuple(eye),
        camera_dir=tuple(view["forward"]),
        camera_up=tuple(view["up"]),
    )
    if task == "colloids":
        viewport.overlays.append(ColorLegendOverlay(modifier=pipeline.modifiers[-1]))
    size = tuple(int(side) for side in view["size"])
    background = (0, 0, 0) if task == "stars" else (1, 1, 1)
    viewport.render_image(
        size=size, filename=output, renderer=TachyonRenderer(), background=background
    )


def _pipeline_of(given: dict[str, Any]) -> Any:  # noqa: ANN401
    """Return a pipeline of arrays."""
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline, StaticSource

    data = DataCollection()
    particles = data.create_particles(count=len(given["positions"]))
    particles.create_property("Position", data=given["positions"])
    particles.create_property("Value", data=given["values"])
    particles.vis.radius = float(given["radius"])
    if "cell" in given:
        data.create_cell(given["cell"], pbc=(True, True, True))
    return Pipeline(source=StaticSource(data=data))


if __name__ == "__main__":
    main()
