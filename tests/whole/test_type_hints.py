"""What a type checker says of code that uses vtray: nothing where it is right."""

from pathlib import Path

import pytest

from conftest import once

CACHE = Path(__file__).parents[2] / ".mypy_cache"

RIGHT = """
from collections.abc import Iterator

import numpy as np
import vtray

places = np.random.default_rng(1).random((10, 3))
scene = vtray.Scene()
spheres = scene.add_spheres(places, 0.1, color=places[:, 0], cmap="viridis", clim=(0, 1))
scene.add_spheres([(0, 0, 0), (1, 1, 1)], [0.1, 0.2], ["red", "#00f"], material=["glass", "metal"])
scene.add_sphere(places[0], np.float64(1), "blue", material=vtray.Glass(1.3, (0.1, 0, 0)))
scene.add_cylinders(places, places + 1, 0.1, color=["red"] * 10, color_end=(0.1, 0.2, 0.3))
scene.add_plane((0, 0, -1), (0, 0, 1), material=vtray.Lambert(pattern=vtray.Checker()))
scene.add_sky(0.5, gradient={"zenith": "white"})
scene.lights = [vtray.Sun((0, 0, -1), 1), *vtray.lights.rembrandt(scene, side="right")]
scene.camera = vtray.Camera.fit(scene, view=(30, 20), margin=0.1, size=[64, 48]).orbit(10)
scene.style = vtray.Style(outline=vtray.Outline(2, "red", "particles"), clip=[(0, 0, 1)])
scene.render = vtray.RenderSettings(background=(1, 2, 3), integrator="path")
particles = vtray.Particles([(0, 0, 0), (1, 0, 0)], {"element": ["O", "H"]}, [(0, 1)], (1, 2, 3))
particles = particles.select("element == 'O'").with_columns(charge=[1.0])
drawn = scene.add_particles(particles, "licorice", color="charge", clim=(0, 1), norm="log")
image: vtray.Image = vtray.render(scene, samples=4, exposure=2, fog=(1, 2), cap="red", warn=print)
image.expose("auto", stops=1, tonemap="agx").save("a.png", bits=16)
image.annotated(title="x", labels=[("O", (0, 0, 1))], axes=True).save("b.png")
picked = image.pick(3, 4)
print(spheres.radius, drawn.legend, picked and picked.object, vtray.compare(image, "b.png").mean)


def frames() -> Iterator[vtray.Scene]:
    yield scene


vtray.animate(frames(), "a.gif", camera={0: scene.camera, 9: scene.camera.zoomed(2)})
"""

WRONG = [
    'vtray.Scene().add_sphere((0, 0, 0), "x")',
    "vtray.Scene().add_sphere((0, 0, 0), 1, colour=1)",
    'vtray.Scene().add_particles([], style="balls")',
    "vtray.Scene().camera = 3",
    'vtray.Camera.fit([], projection="panorama")',
    'vtray.Outline(borders="partcles")',
    "vtray.Particles(3, columns=3)",
    'vtray.render(vtray.Scene(), filter="bx")',
    'vtray.render(vtray.Scene()).expose(tonemap="agxx")',
    'vtray.RenderSettings(integrator="pth")',
    "vtray.Scnee",
    "vtray.lights.rembrant",
]


@once
def test_type_checkers_know_right_from_wrong(tmp_path: Path) -> None:
    api = pytest.importorskip("mypy.api")
    path = tmp_path / "user.py"
    path.write_text("\n".join([RIGHT, *WRONG]))
    # What `make lint` has found out of vtray need not be found out again.
    said, problems, _ = api.run(["--strict", "--no-pretty", "--cache-dir", str(CACHE), str(path)])
    first = len(RIGHT.splitlines()) + 1
    lines = path.read_text().splitlines()
    found = {int(line.split(":")[1]) for line in said.splitlines() if ": error: " in line}
    assert not problems
    assert [lines[number - 1] for number in sorted(found) if number < first] == [], said
    assert {lines[number - 1] for number in found if number >= first} == set(WRONG), said
