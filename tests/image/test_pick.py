"""What is seen in a pixel, down to the particle."""

from typing import Any

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.base.errors import RenderError
from vtray.scene.particles import drawing
from vtray.scene.particles.particles import Particles

PAIR = Particles(
    [(0.5, 2, 2), (1.5, 2, 2)],
    {"name": np.array(["left", "right"]), "force": np.eye(3)[:2]},
    cell=np.eye(3) * 4,
)


@pytest.mark.parametrize("written_out", [0, 100])
def test_picked_particles(written_out: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing, "WRITTEN_OUT", written_out)
    scene = vtray.Scene()
    scene.add_sphere((5, 2, 2), 0.4)
    scene.add_particles(PAIR, bonds=1.2, radii=0.3, cell=False, replicate=(1, 1, 2))
    scene.camera = vtray.Camera.orthographic((2, -3, 4), (2, 2, 4), 8, up=(0, 0, 1), size=(80, 80))
    scene.add_light((2, -9, 4))
    image = vtray.render(scene)

    def at(x: float, z: float) -> Any:
        return image.pick(round(40 + 10 * (x - 2)), round(40 - 10 * (z - 4)))

    ball = at(1.5, 2)
    assert ball is not None
    assert (ball.object, ball.index, ball.copy, ball.particle) == (1, 1, 0, 1)
    assert (len(scene.objects) == 3) == (written_out > 0)
    assert ball.values == {"x": 1.5, "y": 2, "z": 2, "name": "right", "force": [0, 1, 0]}
    assert ball.distance == pytest.approx(4.7, abs=0.01)
    assert at(0.5, 6).copy == 1
    assert [ball.kind, at(0.9, 2).kind] == ["particle", "bond"]
    assert [at(0.9, 2).particle, at(1.1, 6).particle] == [0, 1]  # the halves of the bond
    single = at(5, 2)
    assert single.kind is None
    assert (single.object, single.copy, single.particle, single.values) == (0, None, None, {})
    assert at(1, 4) is None
    with pytest.raises(RenderError, match="pick: there is no pixel 80, 0 in a picture of 80 x 80"):
        image.pick(80, 0)
    words = r"pick: a pixel has a whole column and row, got 1\.5; round it, as by int\(\)"
    with pytest.raises(RenderError, match=words):
        image.pick(1.5, 0)
    with pytest.raises(RenderError, match="got None"):
        image.pick(0, None)


@once
@pytest.mark.parametrize("written_out", [0, 100])
def test_picked_particles_on_far_faces(written_out: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing, "WRITTEN_OUT", written_out)
    scene = vtray.Scene()
    columns = {"name": np.array(["left", "right", "high"])}
    three = Particles([(0, 2, 2), (3, 2, 2), (3, 2, 3.6)], columns, cell=PAIR.cell)
    scene.add_particles(three, bonds=2.5, radii=0.3, cell=False, replicate=(1, 1, 2), boundary=True)
    scene.camera = vtray.Camera.orthographic((2, -3, 4), (2, 2, 4), 8, up=(0, 0, 1), size=(80, 80))
    scene.add_light((2, -9, 4))
    image = vtray.render(scene)

    def at(x: float, z: float) -> Any:
        return image.pick(round(40 + 10 * (x - 2)), round(40 - 10 * (z - 4)))

    near, far = at(0, 6), at(4, 6)
    assert (near.kind, far.kind, near.object) == ("particle", "particle", 0)
    assert near.object != far.object
    assert (near.particle, near.copy) == (far.particle, far.copy) == (0, 1)
    assert far.values["name"] == "left"
    found = [at(x, z) for x, z in ((3.4, 6), (3.6, 6), (3, 4.6), (3, 5))]
    assert [(p.kind, p.particle, p.copy) for p in found] == [
        ("bond", 1, 1),
        ("bond", 0, 1),
        ("bond", 2, 0),
        ("bond", 1, 1),
    ]
    assert at(-0.4, 6) is None


@once
@pytest.mark.parametrize("written_out", [0, 100])
@pytest.mark.parametrize("faded", [{"opacity": 0.6}, {"opacity": 0.5, "highlight": "index == 0"}])
def test_picked_particles_that_are_faded(
    faded: dict[str, Any], written_out: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drawing, "WRITTEN_OUT", written_out)
    scene = vtray.Scene()
    options: dict[str, Any] = {"bonds": 1.2, "radii": 0.3, "cell": False, "replicate": (1, 1, 2)}
    drawn = scene.add_particles(PAIR, **faded, **options)
    assert drawn.copies is not None
    scene.camera = vtray.Camera.orthographic((2, -3, 4), (2, 2, 4), 8, up=(0, 0, 1), size=(80, 80))
    scene.lights = [vtray.Light((2, -3, 4))]
    image = vtray.render(scene)
    found = [image.pick(25, y) for y in (60, 20)]
    assert [(p.particle, p.copy) for p in found if p is not None] == [(0, 0), (0, 1)]
