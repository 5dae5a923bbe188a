"""Movies leave room for legends and colour bars, as single pictures do."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import compiled_only
from vtray.commands import cli
from vtray.rendering.beside import MARGIN, fit_beside

SIZE = (320, 200)


def pictures(there: Path) -> list[np.ndarray]:
    found = [np.asarray(Image.open(path)) for path in sorted(there.parent.glob("*.png"))]
    assert found
    return found


def stands_beside(picture: np.ndarray) -> bool:
    """Tell whether what is shown ends before what stands on the right begins."""
    is_white = (picture == 255).all(axis=(0, 2))
    used = np.flatnonzero(~is_white)
    gaps = np.diff(used)
    # A column that is free of both, in the right half.
    return bool((gaps[used[:-1] > 130] > 3).any())


def cloud(shift: float = 0.0) -> vtray.Particles:
    """Return balls that fill a picture from all sides."""
    x, y, z = np.mgrid[-4:5, -4:5, -1:2].reshape(3, -1)
    places = np.stack([x + shift, y, z], axis=1).astype(float)
    columns = {"element": np.where(x > 0, "C", "O"), "heat": x + shift}
    return vtray.Particles(places, columns)


@pytest.fixture
def run(tmp_path: Path) -> Path:
    path = tmp_path / "run.xyz"
    with path.open("w") as file:
        for shift in (0.0, 0.5):
            particles = cloud(shift)
            print(len(particles), "Properties=species:S:1:pos:R:3:heat:R:1", sep="\n", file=file)
            rows = zip(particles["element"], particles.positions, particles["heat"], strict=True)
            for name, (a, b, c), heat in rows:
                print(name, a, b, c, heat, file=file)
    return path


@compiled_only
@pytest.mark.parametrize(
    "marks", [["--legend"], ["--color", "heat", "--cmap", "viridis", "--color-bar=heat"]]
)
@pytest.mark.parametrize("turns", [[], ["--turntable", "0.3", "--fps", "10"]])
def test_movies_of_data(run: Path, marks: list[str], turns: list[str]) -> None:
    there = run.with_name("made") / "%02d.png"
    size = ["--size", "{}x{}".format(*SIZE), "--samples", "1", "--view", "top", "-t1"]
    assert cli.run([*size, *marks, *turns, str(run), str(there)]) == 0
    assert all(map(stands_beside, pictures(there)))
    if not turns:
        # The camera is that of a picture that shows both.
        alone = run.with_name("alone.png")
        assert cli.run([*size, *marks, "--frame", "1", str(run), str(alone)]) == 0
        assert stands_beside(np.asarray(Image.open(alone)))


@compiled_only
@pytest.mark.parametrize("kind", ["particles", "scene", "turntable"])
def test_movies_in_python(kind: str, tmp_path: Path) -> None:
    there = tmp_path / kind / "%d.png"
    options: dict[str, Any] = {"size": SIZE, "threads": 1, "background": "white"}
    annotate = {"legend": {"oxygen": "red", "carbon": "gray"}, "colorbar": "heat"}
    scene = vtray.Scene()
    scene.add_particles(cloud(), color="heat", cmap="viridis")
    if kind == "particles":
        drawn = {"color": "heat", "cmap": "viridis", "view": "top"}
        vtray.animate([cloud(), cloud(0.5)], there, annotate=annotate, **drawn, **options)
    elif kind == "scene":
        vtray.animate(scene, there, frames=1, annotate=annotate, **options)
    else:
        vtray.turntable(scene, there, seconds=0.2, fps=10, annotate=annotate, **options)
    assert all(map(stands_beside, pictures(there)))


@pytest.mark.parametrize(
    "marks",
    [{"frame": 3}, {"frame": True}, {"time": 0}, {"time": True}, {"time": "2 ps"}, {"title": "x"}],
)
def test_texts_have_room_above(marks: dict[str, Any]) -> None:
    seen = []
    camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=(600, 400))

    def fit(margin: Any) -> vtray.Camera:
        seen.append(margin)
        return camera

    fit_beside(fit, [], marks)
    left, top, right, bottom = seen[-1]
    assert left == right == bottom == MARGIN < top < 0.3


@compiled_only
def test_a_camera_that_is_given_stays(tmp_path: Path) -> None:
    scene = vtray.Scene()
    scene.add_particles(cloud())
    scene.camera = vtray.Camera.fit(scene, size=SIZE)
    for name, marks in (("a", {}), ("b", {"legend": {"oxygen": "red"}})):
        there = tmp_path / name / "%d.png"
        vtray.animate(
            scene, there, frames=1, annotate=marks, background="white", threads=1, samples=1
        )
    (bare,), (marked,) = (pictures(tmp_path / name / "%d.png") for name in "ab")
    assert (bare[:, :120] == marked[:, :120]).all()
