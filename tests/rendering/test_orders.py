"""The light of pictures by how often surfaces scattered it: emission, direct and indirect."""

import io
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pictures import read_exr

import vtray
from conftest import JIT, compiled_only, once
from vtray.commands import cli
from vtray.image.formats.exr_file import write_exr
from vtray.image.formats.picture import How
from vtray.scene.materials import Emissive, Glass, Plastic
from vtray.scene.stars import Stars

WHITE = (255, 255, 255)
NAMES = ("emission", "direct", "indirect")
SIZE = 20 if JIT else 8
PANEL = vtray.RectangleLight((0.5, -0.6, 2), ((0.6, 0, 0), (0, 0.4, 0)), radiance=2, visible=True)


def looking_down(objects: list[Any], lights: list[Any], size: int = SIZE) -> vtray.Scene:
    """Return a scene that is seen from above, as far as 1 around (0, 0)."""
    scene = vtray.Scene()
    scene.objects, scene.lights = objects, lights
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=12, size=(size, size)
    )
    return scene


def all_kinds() -> vtray.Scene:
    """Return a scene with most kinds of materials and lights."""
    objects = [
        vtray.Sphere((-0.5, 0.1, 0.6), 0.5, WHITE, material="glass"),
        vtray.Sphere((0.5, 0.1, 0.4), 0.4, (200, 99, 71), material=Plastic(roughness=0.3)),
        vtray.Sphere((0, 0.7, 0.2), 0.2, (240, 240, 255), material="mirror"),
        vtray.Sphere((-0.1, -0.6, 0.2), 0.2, (255, 200, 9), material=Emissive(3)),
        vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208)),
    ]
    lights = [vtray.Sky(0.5), vtray.Light((5, 5, 5), 0.3), PANEL]
    return looking_down(objects, lights)


def rendered(scene: vtray.Scene, integrator: str = "path", **settings: Any) -> vtray.Image:
    """Return a picture."""
    return vtray.render(scene, integrator=integrator, warn=[].append, **settings)


def assert_add_up(image: vtray.Image) -> None:
    """See that the orders of a picture are all of its light, to the rounding of sums."""
    found = [getattr(image, name) for name in NAMES]
    total = found[0] + found[1] + found[2]
    np.testing.assert_allclose(total, image.raw, rtol=1e-12, atol=1e-12 * image.raw.max())
    alone = np.count_nonzero(found, axis=0) < 2
    np.testing.assert_array_equal(total[alone], image.raw[alone])
    assert all(array.shape == image.raw.shape for array in found)


@once
@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_orders_add_up_to_the_picture(integrator: str, samples: int) -> None:
    image = rendered(all_kinds(), integrator, samples=samples, tolerance=0.1)
    assert_add_up(image)
    assert image.emission.max() >= 510
    assert image.direct.max() > 100
    assert (image.indirect.max() > 20) == (integrator != "direct")
    assert min(getattr(image, name).min() for name in NAMES) == 0


def through_a_lens() -> vtray.Scene:
    scene = all_kinds()
    scene.camera = scene.camera.replace(lens=vtray.Lens(0.2, 8))
    return scene


def of_all_directions() -> vtray.Scene:
    scene = all_kinds()
    scene.camera = vtray.Camera.panorama((0.1, -0.1, 1.5), (0, 1, 1), size=(2 * SIZE, SIZE))
    return scene


def with_fading_balls() -> vtray.Scene:
    """Return layers over a floor, a lamp that is seen through some of them, and fog."""
    balls = [vtray.Sphere((0.1 * k, -0.3, 1.5 - k / 2), 0.5, WHITE, opacity=0.4) for k in range(4)]
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), (192, 200, 208))
    lights = [vtray.Light((5, 5, 9), 0.6), PANEL.replace(location=(0, -0.5, 0.3))]
    scene = looking_down([*balls, floor], lights)
    scene.style = vtray.Style(fog=vtray.Fog(start=7, end=14))
    return scene


def with_stars() -> vtray.Scene:
    scene = all_kinds()
    scene.objects.append(Stars([(-0.3, -0.3, 1.5), (0.4, -0.2, 2)], 2.0, peak=1.0))
    return scene


def with_many_lamps() -> vtray.Scene:
    """Return so many lamps that they share their rays."""
    scene = all_kinds()
    places = [(np.cos(k) * (2 + k / 40), np.sin(k) * (2 + k / 40), 3) for k in range(140)]
    scene.lights = [vtray.SphereLight(place, 0.2, radiance=0.3) for place in places]
    return scene


@pytest.mark.parametrize(
    ("make", "settings"),
    [
        (through_a_lens, {"samples": 3}),
        (of_all_directions, {"samples": 3}),
        (with_fading_balls, {"integrator": "direct"}),
        (with_fading_balls, {"integrator": "direct", "samples": 3}),
        (with_stars, {}),
        (with_many_lamps, {"integrator": "direct", "samples": 3}),
        (all_kinds, {"samples": 3, "filter": "mitchell", "tonemap": "agx", "depth": 3}),
        (all_kinds, {"integrator": "direct", "samples": 3, "fog": (7, 14), "background": "sky"}),
        (all_kinds, {"integrator": "direct", "samples": 3, "outline": True, "eye_dome": True}),
    ],
)
@compiled_only
def test_orders_of_other_pictures_add_up(
    make: Callable[[], vtray.Scene], settings: dict[str, Any]
) -> None:
    image = rendered(make(), **settings)
    assert_add_up(image)
    assert image.direct.any()


@once
def test_lamps_behind_layers_are_dimmed_by_them() -> None:
    image = rendered(with_fading_balls(), "direct")
    lit = image.emission[..., 0][image.emission[..., 0] > 0]
    assert len(lit)
    assert lit.min() < 0.7 * lit.max()


@once
def test_what_is_seen_to_shine_is_emission() -> None:
    ball = vtray.Sphere((0, 0, 0), 0.6, (255, 51, 0), material=Emissive(2.5))
    for integrator in ("whitted", "path"):
        image = rendered(looking_down([ball], [vtray.Sky(7)]), integrator, samples=4)
        np.testing.assert_array_equal(image.emission, image.linear)
        assert image.emission.max() == pytest.approx(2.5 * 255)
        assert not image.direct.any()
        assert not image.indirect.any()


@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_the_sky_behind_is_no_part(integrator: str) -> None:
    """It is laid behind `linear`, which does not hold it either."""
    scene = looking_down([vtray.Sphere((0, 0, 0), 0.3, (255, 51, 0))], [vtray.Sky(1)])
    image = rendered(scene, integrator, background="sky")
    assert image.with_sky[0, 0] == pytest.approx(255)
    assert not image.emission.any()


@once
@pytest.mark.parametrize("samples", [1, 4])
def test_what_shines_on_a_plane_is_direct(samples: int) -> None:
    floor = vtray.Plane((0, 0, 0), (0, 0, 1), (255, 128, 0), 0.5)
    lights = [vtray.Light((0, 0, 1e6), 1), vtray.SphereLight((3, 0, 4), 1, radiance=2)]
    for integrator in ("direct", "whitted", "path"):
        image = rendered(looking_down([floor], lights), integrator, samples=samples)
        np.testing.assert_array_equal(image.direct, image.linear)
        assert not image.emission.any()
        assert not image.indirect.any()
    alone = rendered(looking_down([floor], lights[:1]), "direct", exposure=1.0)
    assert alone.direct[0, 0] == pytest.approx([127.5, 64, 0])


def hollow_ball(share: float, size: int = 4) -> vtray.Scene:
    """Return a ball that is seen from within, with a light in its middle."""
    ball = vtray.Sphere((0, 0, 0), 9, WHITE, lambert=share)
    scene = looking_down([ball], [vtray.Light((0, 0, 0), 1)])
    scene.camera = vtray.Camera.look_at(
        (0, 0, 8.95), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=12, size=(size, size)
    )
    return scene


@once
@pytest.mark.parametrize("share", [0.25, 0.75])
@pytest.mark.parametrize("depth", [0, 1, 7] if JIT else [0, 1])
def test_a_hollow_ball_is_lit_by_a_series(share: float, depth: int) -> None:
    """Once by the light in the middle, and by each bounce with a share of that again.

    Only a little of the ball, 1 of 360, is behind the image plane, and so not there.
    """
    image = rendered(hollow_ball(share), samples=64 if JIT else 16, depth=depth)
    assert image.direct / 255 == pytest.approx(share, rel=1e-9)
    expected = sum(share ** (k + 1) * (1 - 1 / 360) ** k for k in range(1, depth + 1))
    assert image.indirect.mean() / 255 == pytest.approx(expected, rel=0.05)
    assert not image.emission.any()


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_a_lamp_in_a_mirror_is_direct(integrator: str) -> None:
    mirror = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE, material="mirror")
    lamp = vtray.RectangleLight((0, 0, 3), ((8, 0, 0), (0, 8, 0)), radiance=2)
    image = rendered(looking_down([mirror], [lamp]), integrator)
    assert image.direct == pytest.approx(510)
    assert not image.emission.any()
    assert not image.indirect.any()


@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_what_mirrors_show_of_lit_surfaces_is_indirect(integrator: str) -> None:
    """A ball above a mirror has direct light, and the mirror shows it."""
    mirror = vtray.Plane((0, 0, 0), (0, 0.5, 1), WHITE, material="mirror")
    ball = vtray.Sphere((0, 0.5, 1), 0.4, (255, 0, 0))
    image = rendered(looking_down([mirror, ball], [vtray.Light((0, -9, 30), 1)]), integrator)
    is_ball = image.ids[..., 0] == 1
    assert image.direct[is_ball].any()
    assert not image.direct[~is_ball].any()
    assert image.indirect[~is_ball].any()
    np.testing.assert_array_equal(image.indirect[~is_ball], image.linear[~is_ball])


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_each_side_of_glass_scatters_once(integrator: str) -> None:
    """The sky through a ball is indirect light, and through a sheet it is direct."""
    for is_thin, seen in ((False, "indirect"), (True, "direct")):
        ball = vtray.Sphere((0, 0, 0), 3, WHITE, material=Glass(1.0, thin=is_thin))
        sheet = vtray.Plane((0, 0, 0), (0, 0, 1), WHITE, material=Glass(1.0, thin=True))
        image = rendered(looking_down([sheet if is_thin else ball], [vtray.Sky(1)]), integrator)
        for name in NAMES:
            expected = 255.0 if name == seen else 0.0
            assert getattr(image, name) == pytest.approx(expected), name


@once
def test_fireflies_are_cut_in_all_orders_alike() -> None:
    bright, cut = (rendered(all_kinds(), firefly=firefly) for firefly in ("off", 0.4))
    assert_add_up(cut)
    peak = bright.linear.max(axis=2, keepdims=True)
    is_lamp = (bright.emission == 510).all(axis=2, keepdims=True)
    factor = np.where(is_lamp, 1.0, 0.4 * 255 / np.maximum(peak, 0.4 * 255))
    assert np.count_nonzero(factor < 1) > 3
    for name in NAMES:
        np.testing.assert_allclose(getattr(cut, name), getattr(bright, name) * factor, rtol=1e-12)


@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
@pytest.mark.parametrize("samples", [1, 4])
@once
def test_threads_and_tiles_change_nothing(integrator: str, samples: int) -> None:
    one, other = (
        rendered(all_kinds(), integrator, samples=samples, threads=n, tile=tile)
        for n, tile in ((1, 64), (3, 8))
    )
    for name in NAMES:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()


@once
def test_exposures_share_the_light() -> None:
    image = rendered(all_kinds(), exposure="auto")
    other = image.expose(2.0, stops=1)
    assert other.direct.tobytes() == image.direct.tobytes()
    found = image.direct
    assert image.expose("max").direct is found


@compiled_only
def test_denoised_pictures_tell_of_their_raw_light() -> None:
    pytest.importorskip("pyoidn")
    image = rendered(all_kinds(), samples=4, denoise=True)
    assert image.raw is not image.linear
    assert_add_up(image)


@pytest.mark.parametrize("make", [all_kinds, with_fading_balls, with_many_lamps])
@compiled_only
def test_other_lights_and_colors_have_their_own(make: Callable[[], vtray.Scene]) -> None:
    image = rendered(make(), "direct", samples=3, keep_lights=True)
    assert_add_up(image)
    relit = image.relight([2.0 * k for k in range(len(image.scene.lights))])
    recolored = relit.recolor(len(image.scene.objects) - 1, "lime")
    for other in (relit, recolored):
        assert_add_up(other)
    assert recolored.direct.tobytes() != relit.direct.tobytes()
    assert image.direct.tobytes() != relit.direct.tobytes()


@once
def test_parts_of_pictures_do_not_know_them(tmp_path: Path) -> None:
    parts: list[vtray.Image] = []
    rendered(all_kinds(), on_update=parts.append, update_seconds=0.0, tile=SIZE // 2)
    assert np.isnan(parts[0].direct).all()
    parts[0].save(tmp_path / "a.npz", aov=NAMES)


@once
@pytest.mark.parametrize("is_asked_before", [False, True])
def test_pickled_pictures_know_them(is_asked_before: bool) -> None:
    image = rendered(all_kinds())
    if is_asked_before:
        assert image.indirect.any()
    other = pickle.loads(pickle.dumps(image))
    for name in NAMES:
        assert getattr(other, name).tobytes() == getattr(image, name).tobytes()


@compiled_only
def test_files_hold_them(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    scene, made = tmp_path / "a.json", tmp_path / "a.npz"
    document = json.loads((Path(__file__).parents[2] / "scenes" / "first.json").read_text())
    scene.write_text(json.dumps(document))
    given = ["--size", "12x9", "--integrator", "path", "--samples", "2"]
    assert cli.run([str(scene), str(made), *given, "--aov", "direct,indirect,emission"]) == 0
    assert capfd.readouterr().err == ""
    image = rendered(vtray.load(scene), size=(12, 9), samples=2)
    with np.load(made) as found:
        for name in NAMES:
            np.testing.assert_array_equal(found[name], getattr(image, name))
    file = io.BytesIO()
    write_exr(image, How(aov=NAMES), file)
    _, channels = read_exr(file.getvalue())
    for name in NAMES:
        for k, channel in enumerate("RGB"):
            expected = (getattr(image, name)[..., k] / 255).astype("f4")
            np.testing.assert_array_equal(channels[f"{name}.{channel}"], expected)


@compiled_only
def test_what_is_not_asked_for_is_not_traced(monkeypatch: pytest.MonkeyPatch) -> None:
    from vtray.rendering.relighting import Rerendering

    monkeypatch.setattr(Rerendering, "_trace", None)
    image = rendered(all_kinds(), samples=2)
    assert image.pixels.any()
    with pytest.raises(TypeError):
        _ = image.direct
