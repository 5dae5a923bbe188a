"""Pictures by tone maps: colours come back, whatever is mixed with them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pictures import read_exr
from PIL import Image as PillowImage

import vtray
from conftest import JIT, once
from vtray.image.tone_maps.table import TONE_MAPS
from vtray.scene.colors.color_light import light_of_numbers
from vtray.scene.colors.srgb import decode_srgb, encode_srgb

ENCODED = tuple(TONE_MAPS)
COLORS = ["white", "black", "orange", (200, 100, 7), "#010203", (128, 128, 128)]


def wall(color: Any, *lights: Any) -> vtray.Scene:
    """Return a wall that is looked at squarely, by default in a light of 1."""
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color=color)
    scene.lights = list(lights) or [vtray.Light((0, 0, 1e9))]
    scene.camera = vtray.Camera.look_at((0, 0, 5), target=(0, 0, 0), size=(6, 4))
    return scene


def balls(**more: Any) -> vtray.Scene:
    """Return balls of several colours with much background."""
    scene = vtray.Scene()
    scene.add_spheres(
        [(0, 0, 0), (1.5, 0.4, 0), (-1.2, 0.8, 0.5)],
        radius=[1, 0.6, 0.5],
        color=[(255, 160, 0), (30, 90, 200), (240, 240, 240)],
        **more,
    )
    scene.lights = [vtray.Light((9, 9, 9)), vtray.Sun((1, -1, -3), 0.3, color=(255, 200, 180))]
    scene.camera = vtray.Camera.look_at(
        (0, 0, 8), target=(0, 0, 0), size=(24, 18) if JIT else (12, 9)
    )
    return scene


@pytest.mark.parametrize("color", COLORS)
def test_surface_lit_squarely_has_its_own_color(color: Any) -> None:
    expected = vtray.colors.to_rgb(color)
    image = vtray.render(wall(color), exposure=1, tonemap="srgb")
    assert (image.pixels == expected).all()
    assert (image.develop(16) == np.array(expected) * 257).all()
    # Half of the light is a stop less.
    half = vtray.render(wall(color, vtray.Light((0, 0, 1e9), 0.5)), exposure=1, tonemap="srgb")
    light = decode_srgb(np.array(expected) / 255.0) / 2.0
    assert (half.pixels == np.floor(255.0 * encode_srgb(light) + 0.5)).all()
    assert np.array_equal(half.expose(1, stops=1).pixels, image.pixels)


def test_every_number_comes_back() -> None:
    scene = wall("black")
    image = vtray.render(scene, exposure=1, tonemap="srgb", keep_lights=True)
    for number in range(0, 256, 5):
        color = number, 255 - number, number // 2
        assert (image.recolor(0, color).pixels == color).all()


@pytest.mark.parametrize("tonemap", ENCODED)
def test_known_light(tonemap: Any) -> None:
    # A quarter of the light of white, on grey.
    image = vtray.render(
        wall((188, 188, 188), vtray.Light((0, 0, 1e9), 0.25)), exposure=1, tonemap=tonemap
    )
    grey = 0.25 * ((188 / 255 + 0.055) / 1.055) ** 2.4
    shown = TONE_MAPS[tonemap](np.full((1, 3), grey))[0]
    expected = 255 * (1.055 * shown ** (1 / 2.4) - 0.055)
    assert np.abs(image.pixels - expected).max() < 0.51
    assert image.linear == pytest.approx(255 * grey)


@once
@pytest.mark.parametrize("tonemap", ENCODED)
def test_white_furnace_stays_white(tonemap: Any) -> None:
    scene = wall("white", vtray.Sky())
    scene.add_sphere((0, 0, 1), 0.5, color="white")
    scene.lights = [vtray.Ambient(distance=1e-9)]
    image = vtray.render(scene, exposure=1, tonemap=tonemap)
    assert np.ptp(image.pixels.reshape(-1, 3).astype(int), axis=0).max() <= 1
    assert np.ptp(image.pixels[0, 0].astype(int)) <= 1
    if tonemap == "srgb":
        assert (image.pixels == 255).all()
    assert (image.expose(1, stops=12).pixels == 255).all()


@once
def test_color_of_light_is_decoded() -> None:
    tint = vtray.Color(188, 100, 255)
    lights = [
        vtray.Light((0, 0, 1e9), color=tint),
        vtray.Sun((0, 0, -1), angle=0, color=tint),
        vtray.Ambient(distance=1e-9, color=tint),
        vtray.Sky(color=tint),
        vtray.Sky(gradient=vtray.Gradient(tint, tint, tint)),
    ]
    for light in lights:
        image = vtray.render(wall("white", light), exposure=1, tonemap="srgb")
        assert np.abs(image.pixels.astype(int) - (188, 100, 255)).max() <= 1, light


@pytest.mark.parametrize(
    "light",
    [vtray.Sky(color=(9, 90, 200)), vtray.Sky(gradient=vtray.Gradient(*3 * [(9, 90, 200)]))],
)
def test_sky_behind_is_decoded(light: vtray.Sky) -> None:
    scene = balls()
    scene.add_light(light)
    image = vtray.render(scene, exposure=1, tonemap="srgb", background="sky")
    assert (image.pixels[0, 0] == (9, 90, 200)).all()


def test_stars_are_decoded() -> None:
    for colors in ("orange", [(255, 165, 0), (255, 165, 0), (255, 165, 1)]):
        scene = vtray.Scene()
        scene.add_particles(
            [(0, 0, 0), (0.1, 0, 0), (0.3, 0.2, 0)], emission=1.0, peak=1e-3, color=colors
        )
        scene.camera = vtray.Camera.look_at(
            (0, 0, 8), target=(0, 0, 0), size=(24, 18) if JIT else (12, 9)
        )
        image = vtray.render(scene, exposure=1, tonemap="srgb", background="black")
        brightest = image.pixels.reshape(-1, 3).max(axis=0).astype(int)
        assert np.abs(brightest - (255, 165, 0)).max() <= 1


@pytest.mark.parametrize("tonemap", ENCODED)
def test_stars_are_added_to_a_background(tonemap: Any) -> None:
    scene = vtray.Scene()
    scene.add_particles([(0, 0, 0)], emission=1.0, peak=0.5, color="red")
    scene.camera = vtray.Camera.look_at((0, 0, 8), target=(0, 0, 0), size=(12, 9))
    blue, black = (
        vtray.render(scene, exposure=1, tonemap=tonemap, background=color).pixels.astype(int)
        for color in ((0, 0, 90), "black")
    )
    assert (blue[0, 0] == (0, 0, 90)).all()
    assert np.abs(blue[4, 6, 0] - black[4, 6, 0]) <= 1
    assert blue[4, 6, 0] > 100
    assert blue[4, 6, 2] >= 90


@once
@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("tonemap", ENCODED)
def test_background_has_exactly_its_color(samples: int, tonemap: Any) -> None:
    for background in ((3, 140, 250), (255, 255, 255)):
        image = vtray.render(balls(), samples=samples, tonemap=tonemap, background=background)
        assert (image.pixels[image.alpha == 0.0] == background).all()
        assert (image.develop(16)[image.alpha == 0.0] == np.array(background) * 257).all()
        clear = vtray.render(balls(), samples=samples, tonemap=tonemap, background="transparent")
        assert clear.pixels.shape[2] == 4
        # Laid over the background in linear light, it is the same.
        share = clear.pixels[..., 3:] / 255.0
        light = decode_srgb(clear.pixels[..., :3] / 255.0) * share
        light = light + (1.0 - share) * decode_srgb(np.array(background) / 255.0)
        assert np.abs(255 * encode_srgb(light.clip(0, 1)) - image.pixels).max() < 2.0


@pytest.mark.parametrize("tonemap", ENCODED)
def test_black_is_as_any_background(tonemap: Any) -> None:
    black = vtray.render(balls(), tonemap=tonemap)
    assert not black.pixels[0, 0].any()
    nearly = vtray.render(balls(), tonemap=tonemap, background="#000001")
    whole = black.alpha == 1.0
    assert np.array_equal(black.pixels[whole], nearly.pixels[whole])


def test_fog_and_lines_have_their_own_colors() -> None:
    options: dict[str, Any] = {"fog": (0, 1e-3, (10, 200, 90)), "tonemap": "agx"}
    foggy = vtray.render(balls(), **options)
    assert (foggy.pixels[foggy.ids[..., 0] >= 0] == (10, 200, 90)).all()
    lined = vtray.render(balls(), outline=(9, (10, 200, 90)), tonemap="filmic", samples=4)
    assert ((lined.pixels == (10, 200, 90)).all(axis=2)).sum() > (30 if JIT else 10)
    for image in (foggy, lined):
        clear = vtray.render(
            balls(),
            **{**options, "background": "transparent"}
            if image is foggy
            else {"outline": (9, (10, 200, 90)), "tonemap": "filmic", "background": "transparent"},
        )
        assert ((clear.pixels[..., :3] == (10, 200, 90)).all(axis=2)).sum() > (30 if JIT else 10)


def test_caps_are_decoded() -> None:
    scene = wall("white")
    scene.objects = []
    scene.add_sphere((0, 0, 0), 1, color="white")
    image = vtray.render(scene, exposure=1, tonemap="srgb", clip=(0, 0, 1, 0), cap=(200, 100, 7))
    assert (image.pixels[2, 3] == (200, 100, 7)).all()


@once
@pytest.mark.parametrize("tonemap", ENCODED)
def test_relit_and_recolored_as_a_new_render(tonemap: Any) -> None:
    for more in ({}, {"opacity": 0.5}):
        scene = balls(**more)
        image = vtray.render(scene, tonemap=tonemap, keep_lights=True, exposure="auto", stops=1)
        lit = image.relight([0.25, 2.0])
        scene.lights = lit.scene.lights
        expected = vtray.render(scene, tonemap=tonemap, exposure="auto", stops=1, keep_lights=True)
        assert np.array_equal(lit.pixels, expected.pixels)
        red = image.recolor(0, "red")
        assert np.array_equal(
            red.linear, vtray.render(red.scene, tonemap=tonemap, keep_lights=True).linear
        )


def test_exposed_again() -> None:
    images = {name: vtray.render(balls(), tonemap=name, exposure="auto") for name in ENCODED}
    for one in ENCODED:
        for other in ENCODED:
            assert np.array_equal(images[one].expose(tonemap=other).pixels, images[other].pixels)
            assert np.array_equal(images[one].linear, images[other].linear)
    bright = images["agx"].expose(stops=1)
    assert bright.settings == vtray.RenderSettings(exposure="auto", stops=1, tonemap="agx")
    assert bright.expose(tonemap="srgb").white == bright.white
    locked = images["srgb"].expose(lock=bright)
    assert locked.expose(tonemap="agx").white == bright.white
    assert np.array_equal(images["srgb"].expose(tonemap="agx", lock=bright).pixels, bright.pixels)


def test_linear_pictures_cannot_be_encoded_later_nor_the_reverse() -> None:
    linear = vtray.render(balls())
    encoded = vtray.render(balls(), tonemap="agx")
    message = 'tonemap: the picture was rendered with "{}", by which its colours .*="{}"$'
    for name in ENCODED:
        with pytest.raises(vtray.RenderError, match=message.format("linear", name)):
            linear.expose(tonemap=name)
    with pytest.raises(vtray.RenderError, match=message.format("agx", "linear")):
        encoded.expose(1, tonemap="linear")
    assert np.array_equal(linear.expose(tonemap="linear").pixels, linear.pixels)
    with pytest.raises(vtray.SceneError, match=r'tonemap: expected "linear", "srgb", .* got'):
        linear.expose(tonemap="sRGB")


def test_linear_is_as_ever() -> None:
    plain = vtray.render(balls(), samples=4)
    named = vtray.render(balls(), samples=4, tonemap="linear", stops=0.0)
    assert np.array_equal(plain.pixels, named.pixels)
    white = plain.white
    expected = np.floor(255 * plain.linear / white).clip(0, 255)
    expected[plain.linear == white] = 255
    assert np.array_equal(plain.pixels, expected)


def test_light_is_stored_as_it_is(tmp_path: Path) -> None:
    scene = wall((188, 0, 255), vtray.Light((0, 0, 1e9), 4.0))
    for tonemap in ENCODED:
        vtray.render(scene, tonemap=tonemap, stops=3).save(tmp_path / "a.exr")
        _, channels = read_exr((tmp_path / "a.exr").read_bytes())
        expected = 4 * light_of_numbers("srgb")[[188, 0, 255]] / 255
        found = [float(channels[name][0, 0]) for name in "RGB"]
        assert found == pytest.approx(expected, rel=1e-6)


@once
def test_same_on_any_threads_and_tiles() -> None:
    given = {"tonemap": "agx", "samples": 4, "background": "navy"}
    given["size"] = (70, 90) if JIT else (18, 22)
    image = vtray.render(balls(), **given)
    for options in ({"threads": 1}, {"threads": 3, "tile": 7}):
        other = vtray.render(balls(), **given, **options)
        assert np.array_equal(image.pixels, other.pixels)


def test_extremes() -> None:
    for exposure in (5e-324, 1e-300, 1e300, 1.7e308):
        for tonemap in ENCODED:
            pixels = vtray.render(balls(), tonemap=tonemap, exposure=exposure).pixels
            assert set(np.unique(pixels)) <= ({0} if exposure < 1 else {0, 255})
    dark = balls()
    dark.lights = [vtray.Light((0, 0, 9), 0.0)]
    dark.add_light(vtray.Light((0, 0, 9), 0.0))
    found = vtray.render(dark, tonemap="agx", warn=lambda text: None)
    assert found.white == 0.0
    assert not found.pixels.any()


@once
def test_flat_pictures_and_figures() -> None:
    pytest.importorskip("matplotlib")
    scene = wall("orange")
    linear = vtray.render(scene, exposure=1)
    image = vtray.render(scene, exposure=1, tonemap="srgb")
    assert np.array_equal(linear.flat(), image.flat())
    large = vtray.render(scene, exposure=1, tonemap="srgb", size=(120, 80))
    assert large.annotated(title="x").pixels.shape == large.pixels.shape
    large.figure()


def test_pixel_is_explained() -> None:
    scene = wall((200, 100, 7), vtray.Light((0, 0, 1e9), color=(188, 255, 255)))
    image = vtray.render(scene, exposure=1, tonemap="agx")
    tree = vtray.trace_pixel(image, 3, 2)
    assert tree.light == tuple(image.linear[2, 3])
    text = str(tree)
    light = light_of_numbers("agx")[[200, 100, 7]]
    shown = ", ".join(f"{channel:.6g}" for channel in light)
    assert f"color (200, 100, 7), as light ({shown}), lambert 1" in text
    assert 'exposure     tone map "agx" of light / 255, 255 is what becomes 255' in text
    scene.render = vtray.RenderSettings(tonemap="srgb")
    assert "as light" in str(vtray.trace_pixel(scene, 3, 2))


def test_told_and_made_again(tmp_path: Path) -> None:
    from vtray.commands import cli

    scene = balls()
    scene.save(tmp_path / "scene.json")
    names = [str(tmp_path / name) for name in ("scene.json", "a.png", "b.png")]
    assert cli.run([*names[:2], "--tonemap", "filmic", "--exposure", "auto", "--stops", "1"]) == 0
    told = vtray.read_provenance(names[1])
    assert (told.tonemap, told.exposure, told.stops) == ("filmic", "auto", 1.0)
    assert cli.run(["--replay", names[1], names[0], names[2]]) == 0
    assert Path(names[1]).read_bytes() == Path(names[2]).read_bytes()
    scene.render = vtray.RenderSettings(tonemap="filmic", exposure="auto", stops=1)
    scene.save(tmp_path / "scene.json")
    assert np.array_equal(
        vtray.render(vtray.load(tmp_path / "scene.json")).pixels,
        vtray.render(balls(), tonemap="filmic", exposure="auto", stops=1).pixels,
    )


def test_movies(tmp_path: Path) -> None:
    vtray.animate([balls(), balls()], tmp_path / "%d.png", tonemap="agx", stops=1, size=(12, 9))
    one, other = (vtray.read_provenance(tmp_path / f"{k}.png") for k in range(2))
    assert one.tonemap == other.tonemap == "agx"
    pictures = [np.asarray(PillowImage.open(tmp_path / f"{k}.png")) for k in range(2)]
    assert np.array_equal(*pictures)
    shown = vtray.render(balls(), tonemap="agx", stops=1, size=(12, 9)).pixels
    assert np.array_equal(pictures[0], shown)
