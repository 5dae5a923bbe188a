"""Light without grain: nearer to that of many rays, and told as what it is."""

import io
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import plane, scene, sphere
from pictures import read_exr

import vtray
from conftest import compiled_only
from vtray.base.extras import ExtraError
from vtray.commands import cli
from vtray.image import denoise as library
from vtray.image.denoise import denoise
from vtray.image.formats.exr_file import write_exr
from vtray.image.formats.picture import How
from vtray.rendering.guides import find_guides
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.scene.settings import RenderSettings
from vtray.transport.sampling import fans

pytestmark = compiled_only

RED, BLUE = {"r": 255, "g": 0, "b": 0}, {"r": 40, "g": 80, "b": 200}
SIZE = (96, 72)


def world(**camera: Any) -> vtray.Scene:
    """Return balls and a rod on a floor, in ambient light."""
    objects = [
        sphere((-0.7, 0, 5), 1, color=RED, lambert=0.8),
        sphere((1, 0.4, 4), 0.6, color=BLUE),
        plane((0, 1, 0), (0, -1, -0.05)),
    ]
    options = {"size": list(SIZE), "resolution": [0.05, 0.05], **camera}
    made = vtray.loads(json.dumps(scene(objects, [], **options)))
    ends = {"color": (255, 0, 0), "color_end": (40, 80, 200)}
    made.add_cylinders([(-1, -1, 4)], [(1.5, -0.5, 5)], 0.2, **ends)
    made.lights = [vtray.Ambient()]
    return made


def error(one: np.ndarray, truth: np.ndarray) -> float:
    return float(np.sqrt(np.square(one - truth).mean()) / truth.mean())


@pytest.mark.parametrize("samples", [1, 4])
def test_light_is_nearer_to_the_truth(samples: int, monkeypatch: pytest.MonkeyPatch) -> None:
    many = [vtray.render(world(), samples=samples, seed=k).linear for k in range(1, 13)]
    truth = np.mean(many, axis=0)
    monkeypatch.setattr(fans, "WHOLE_FAN", 8)
    image = vtray.render(world(), samples=samples, tolerance=10, denoise=True)
    plain = vtray.render(world(), samples=samples, tolerance=10)
    np.testing.assert_array_equal(image.raw, plain.linear)
    assert plain.raw is plain.linear
    assert error(image.linear, truth) < 0.75 * error(plain.linear, truth)
    # What is there beside light is as it was.
    np.testing.assert_array_equal(image.ids, plain.ids)
    np.testing.assert_array_equal(image.depth, plain.depth)
    np.testing.assert_array_equal(image.alpha, plain.alpha)
    assert not image.linear[image.alpha == 0].any()
    assert image.white == image.linear.max() != plain.white
    assert image.pixels.max() == 255
    # A red ball scatters red light alone.
    assert not image.linear[..., 1:][image.ids[..., 0] == 0].any() or samples > 1


def test_lights_and_colors_that_change() -> None:
    options: dict[str, Any] = {"denoise": True, "keep_lights": True}
    made = world()
    made.add_light((5, -5, 0), 0.5)
    image = vtray.render(made, **options)
    relit = image.relight([0.2, 2])
    made.lights = relit.scene.lights
    again = vtray.render(made, **options)
    np.testing.assert_array_equal(relit.raw, again.raw)
    np.testing.assert_allclose(relit.linear, again.linear, rtol=1e-4, atol=1e-2)
    assert relit.white == relit.linear.max()
    green = image.recolor(0, "green")
    assert green.linear[green.ids[..., 0] == 0][:, 1].min() > 0
    assert not green.linear[green.ids[..., 0] == 0][:, [0, 2]].any()
    assert error(green.linear, green.raw) < 0.1


def test_parts_have_their_grain(monkeypatch: pytest.MonkeyPatch) -> None:
    parts: list[vtray.Image] = []
    image = vtray.render(world(), denoise=True, on_update=parts.append, update_seconds=0)
    assert all(part.linear is part.raw for part in parts)
    assert image.linear is not image.raw


def test_raw_light_in_files(tmp_path: Path) -> None:
    image = vtray.render(world(), denoise=True, size=(24, 18))
    image.save(tmp_path / "a.npz", aov=["raw", "ids"])
    with np.load(tmp_path / "a.npz") as found:
        np.testing.assert_array_equal(found["raw"], image.raw)
        np.testing.assert_array_equal(found["linear"], image.linear)
    file = io.BytesIO()
    write_exr(image, How(aov=("raw",)), file)
    _, channels = read_exr(file.getvalue())
    np.testing.assert_array_equal(channels["raw.B"], (image.raw[..., 2] / 255).astype("f4"))
    np.testing.assert_array_equal(channels["B"], (image.linear[..., 2] / 255).astype("f4"))


def test_command_and_replay(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "scene.json"
    world(size=[24, 18], resolution=[0.2, 0.2]).save(file)
    plain, clean, again, other = (tmp_path / f"{name}.npz" for name in ("a", "b", "c", "d"))
    assert cli.run([str(file), str(plain)]) == 0
    assert cli.run([str(file), str(clean), "--denoise", "--aov", "raw", "--stats"]) == 0
    assert "\ndenoise " in capfd.readouterr().err
    assert cli.run(["--replay", str(clean), str(file), str(again)]) == 0
    assert cli.run(["--replay", str(clean), str(file), str(other), "--no-denoise"]) == 0
    assert capfd.readouterr() == ("", "")
    found = [dict(np.load(path)) for path in (plain, clean, again, other)]
    assert [vtray.read_provenance(p).denoise for p in (plain, clean, again, other)] == [
        False,
        True,
        True,
        False,
    ]
    assert "denoise" not in str(found[0]["provenance"])
    np.testing.assert_array_equal(found[1]["raw"], found[0]["linear"])
    np.testing.assert_array_equal(found[2]["raw"], found[0]["linear"])
    np.testing.assert_array_equal(found[3]["linear"], found[0]["linear"])
    assert not np.array_equal(found[1]["linear"], found[0]["linear"])


def test_scene_that_says_so(tmp_path: Path) -> None:
    made = world()
    made.render = vtray.RenderSettings(denoise=True)
    made.save(tmp_path / "a.json")
    assert '"denoise": true' in (tmp_path / "a.json").read_text()
    assert vtray.load(tmp_path / "a.json").render.denoise is True
    with pytest.raises(vtray.SceneError, match=r"denoise: expected true or false, got 1"):
        vtray.loads((tmp_path / "a.json").read_text().replace('"denoise": true', '"denoise": 1'))
    with pytest.raises(vtray.SceneError, match="denoise: expected "):
        vtray.RenderSettings(denoise="yes")


def test_library_that_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    with pytest.raises(ExtraError, match="^denoise needs pyoidn, which is not installed: .*pip"):
        vtray.render(world(), denoise=True, progress=pytest.fail)  # before any work
    world().save(tmp_path / "a.json")
    output = tmp_path / "a.png"
    assert cli.run([str(tmp_path / "a.json"), str(output), "--denoise"]) == 1
    assert capfd.readouterr().err.startswith("Error: denoise needs pyoidn, which is not installed")
    assert not output.exists()


def test_library_that_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    device = pytest.importorskip("pyoidn").Device
    monkeypatch.setattr(device, "get_error", lambda self: "out of memory")
    message = "^denoise: Open Image Denoise failed: out of memory$"
    with pytest.raises(vtray.RenderError, match=message):
        vtray.render(world(), size=(8, 6), denoise=True)


@pytest.mark.parametrize("scale", [1e-290, 1e280])
def test_light_of_any_strength(scale: float) -> None:
    made = world()
    usual = vtray.render(made, size=(32, 24), denoise=True)
    made.lights = [vtray.Ambient(scale)]
    image = vtray.render(made, size=(32, 24), denoise=True)
    assert np.isfinite(image.linear).all()
    np.testing.assert_allclose(image.linear / scale, usual.linear, rtol=0.02, atol=0.5)


def test_nothing_to_denoise() -> None:
    nothing = np.zeros((6, 8, 3))
    assert not denoise(nothing, nothing, nothing).any()
    light = np.ones((6, 8, 3))  # of which nothing is known stays as it is
    np.testing.assert_array_equal(denoise(light, nothing, nothing), light)


def test_guides_of_one_ray_are_those_of_the_middle() -> None:
    made = world()
    made.add_copies([vtray.Sphere((0, 0, 3), 0.2, (10, 20, 30), 0.5)], [(0, 0, 0), (0.5, -0.5, 0)])
    image = vtray.render(made)
    arrays = pack(made, accelerate(made)).arrays
    found = find_guides(arrays, RenderSettings(), 2)
    np.testing.assert_array_equal(found.cover, image.alpha)
    np.testing.assert_array_equal(found.normals, image.normals)
    colors = {0: (0.8, 0, 0), 2: (1, 1, 1), 4: (5 / 255, 10 / 255, 15 / 255)}
    for number, color in colors.items():
        seen = found.albedo[image.ids[..., 0] == number]
        assert len(seen) > 9
        np.testing.assert_allclose(seen, np.broadcast_to(color, seen.shape), rtol=1e-12)
    rod = image.ids[..., 0] == 3
    for half, color in enumerate(((1, 0, 0), (40 / 255, 80 / 255, 200 / 255))):
        seen = found.albedo[rod & (image.halves == half)]
        assert len(seen) > 9
        np.testing.assert_allclose(seen, np.broadcast_to(color, seen.shape), rtol=1e-12)


@pytest.mark.parametrize("name", ["box", "blackman-harris", "mitchell"])
def test_guides_are_filtered_as_light(name: str) -> None:
    made = world()
    image = vtray.render(made, samples=64, filter=name)
    found = find_guides(
        pack(made, accelerate(made)).arrays, RenderSettings(samples=64, filter=name), 2
    )
    off = np.abs(found.cover - image.alpha)
    assert off.mean() < 0.006
    assert off.max() < 0.25


def test_library_is_asked_for_when_it_is_used() -> None:
    assert library.load_library().__name__ == "pyoidn"


def test_light_through_a_lens_is_nearer_to_the_truth() -> None:
    given = world()
    given.camera = given.camera.replace(lens=vtray.Lens(0.6, 15))
    many = [vtray.render(given, samples=8, seed=k).linear for k in range(1, 13)]
    truth = np.mean(many, axis=0)
    image = vtray.render(given, samples=4, tolerance=10, denoise=True)
    assert error(image.linear, truth) < 0.8 * error(image.raw, truth)


def test_background_behind_what_a_lens_blurs_has_no_grain() -> None:
    given = vtray.Scene()
    given.add_sphere((0, 0, 0), 1.2, color="black")
    given.camera = vtray.Camera.look_at(
        (0, 0, 20), target=(0, 0, 0), fov_degrees=14, size=(48, 48), lens=vtray.Lens(1.5, 60)
    )
    given.lights = [vtray.Sky(1)]
    options = {"background": "sky", "exposure": 1, "seed": 2}
    truth = vtray.render(given, samples=1024, **options)
    rough = vtray.render(given, samples=16, **options)
    image = vtray.render(given, samples=16, denoise=True, **options)
    assert error(image.alpha, truth.alpha) < 0.5 * error(rough.alpha, truth.alpha)
    assert error(1.0 * image.pixels, truth.pixels) < 0.5 * error(1.0 * rough.pixels, truth.pixels)
    assert image.alpha.min() >= 0
    assert image.alpha.max() <= 1


def test_horizon_is_even() -> None:
    given = vtray.Scene()
    given.add_plane((0, 0, 0), normal=(0, 0, 1), color="#0b2230", material="plastic")
    given.camera = vtray.Camera.look_at(
        (0, -60, 7), target=(0, 0, 6), up=(0, 0, 1), fov_degrees=24, size=(64, 48)
    )
    given.lights = [vtray.Sky(0.5, color=(250, 200, 160))]
    image = vtray.render(
        given, integrator="path", samples=8, exposure=1, background="sky", denoise=True
    )
    horizon = ((image.alpha > 0.1) & (image.alpha < 0.9)).any(axis=1)
    assert horizon.any()
    assert image.pixels[horizon].std(axis=1).max() < 1.5


@pytest.mark.parametrize("material", ["plastic", "glass", vtray.Metal(roughness=0.3)])
def test_red_things_have_no_grain_in_what_they_mirror(material: Any) -> None:
    given = vtray.Scene()
    given.add_plane((0, 0, 0), normal=(0, 0, 1), color="#c8ccd4")
    given.add_sphere((0, 0, 1), 1, color=(255, 0, 0), material=material)
    given.camera = vtray.Camera.look_at(
        (0, -9, 3), target=(0, 0, 0.9), up=(0, 0, 1), fov_degrees=18, size=(48, 48)
    )
    given.lights = [vtray.Sky(0.6), vtray.SphereLight((-6, -7, 9), 4, radiance=4)]
    truth = vtray.render(given, integrator="path", samples=512)
    image = vtray.render(given, integrator="path", samples=8, denoise=True)
    seen = truth.alpha * (truth.ids[..., 0] == 1) > 0
    for channel in (1, 2):
        true, rough, clean = (
            light[..., channel][seen] for light in (truth.linear, image.raw, image.linear)
        )
        assert error(clean, true) < 0.8 * error(rough, true)


def test_fog_behind_a_lens_has_no_grain() -> None:
    given = vtray.Scene()
    given.add_plane((0, 0, 0), normal=(0, 0, 1), color="#c8ccd4")
    for k in range(5):
        given.add_sphere((1.5 * ((k * 3) % 5) - 3, 4 + 5 * k, 0.8), 0.8, color=(40, 80, 200))
    given.camera = vtray.Camera.look_at(
        (0, -8, 3),
        target=(0, 6, 0.5),
        up=(0, 0, 1),
        fov_degrees=35,
        size=(96, 72),
        lens=vtray.Lens(0.6, 9),
    )
    given.lights = [vtray.Sky(0.5)]
    options = {"background": "#203040", "exposure": 1, "fog": (6, 30, "white"), "seed": 2}
    truth = vtray.render(given, samples=256, **options)
    image = vtray.render(given, samples=8, denoise=True, **options)
    rough = vtray.render(given, samples=8, **options)
    assert error(1.0 * image.pixels, truth.pixels) < 0.6 * error(1.0 * rough.pixels, truth.pixels)
