"""Depth of field: rays through a lens, against what optics say and an independent renderer."""

import json
from typing import Any

import numpy as np
import oracle
import pytest
from examples import light, plane, scene, sphere, xyz
from hierarchies import ALWAYS, NEVER
from hierarchies import render as render_scene
from sample_places import lens_places, mean, opening, sample_places
from scene_text import message_of

import vtray
from conftest import JIT, compiled_only, once
from vtray.rendering import hierarchy as acceleration
from vtray.rendering.pack_lens import pack_lens
from vtray.transport.sampling.lens_places import place_in_opening

SIZE = [40, 30] if JIT else [10, 8]
RED = {"r": 200, "g": 20, "b": 20}
BALLS = [
    sphere((-1.5, 0.2, 2), 1, color=RED),
    sphere((0.5, 0, 6), 1.2),
    sphere((3, -1, 14), 1.5, color=RED),
    plane((0, 2, 0), (0, -1, 0.1)),
]
LAMPS = [light(-5, -9, -4), light(6, -7, 3, intensity=0.4)]


def seen_through(lens: Any, objects: Any = BALLS, lamps: Any = LAMPS, **camera: Any) -> Any:
    """Return a document whose camera has a lens."""
    given = {"size": SIZE, "resolution": [6.4 / SIZE[0], 6.4 / SIZE[0]], **camera}
    found = scene(objects, lamps, **given)
    if lens is not None:
        found["camera"]["lens"] = lens
    return found


def render(document: Any, few: int = acceleration.FEW, **options: Any) -> vtray.Image:
    return render_scene(vtray.loads(json.dumps(document)), few, **options)


def light_by_oracle(document: Any, samples: int, filter_name: str) -> np.ndarray:
    """Return the light that an independent renderer finds through a lens."""
    width, height = document["camera"]["size"]
    rows, columns = np.mgrid[0:height, 0:width]
    places = sample_places(columns, rows, samples, filter_name)
    through = lens_places(columns, rows, samples, document["camera"]["lens"].get("blades", 0))
    seen = oracle.look(document, places.columns, places.rows, lens=through)
    return mean(seen.linear, places.weights)


@once
@pytest.mark.parametrize("samples", [2, 65] if JIT else [5])
@pytest.mark.parametrize(
    ("lens", "camera"),
    [
        ({"radius": 0.5, "focus_distance": 16}, {}),
        ({"radius": 2.0, "focus_distance": 12, "blades": 5}, {}),
        ({"radius": 0.3, "focus_distance": 14}, {"projection": "orthographic"}),
        ({"radius": 1.0, "focus_distance": 11}, {"focus": 0.001, "resolution": [1e-5, 1e-5]}),
        ({"radius": 4e9, "focus_distance": 1e13}, {"focus": 1e13, "up": xyz(1, -2, 0.2)}),
    ],
)
def test_picture_is_that_of_an_independent_renderer(lens: Any, camera: Any, samples: int) -> None:
    document = seen_through(lens, **camera)
    expected = light_by_oracle(document, samples, "mitchell")
    found = render(document, samples=samples, filter="mitchell").linear
    assert expected.max() > 50
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-7)


LENS = {"radius": 0.8, "focus_distance": 16}


@once
@pytest.mark.parametrize("integrator", ["direct", "whitted", "path"])
def test_zero_radius_is_a_pinhole(integrator: str) -> None:
    options = {"samples": 4, "integrator": integrator}
    plain = render(seen_through(None), **options)
    closed = render(seen_through({"radius": 0, "focus_distance": 16}), **options)
    assert np.array_equal(plain.linear, closed.linear)
    assert np.array_equal(plain.pixels, closed.pixels)


def test_one_ray_a_pixel_sees_all_sharp_and_says_so() -> None:
    given = vtray.loads(json.dumps(seen_through(LENS)))
    words = "camera.lens: all is sharp with one ray a pixel; give samples, such as 64"
    with pytest.warns(UserWarning, match=words):
        image = vtray.render(given)
    assert np.array_equal(image.linear, render(seen_through(None)).linear)


@once
def test_same_bytes_on_any_threads_and_tiles_and_with_any_hierarchy() -> None:
    document = seen_through(LENS)
    one = render(document, samples=5, threads=1)
    for few in (ALWAYS, NEVER):
        for options in ({"threads": 3}, {"threads": 2, "tile": 7}):
            other = render(document, few, samples=5, **options)
            assert np.array_equal(one.linear, other.linear)
            assert np.array_equal(one.alpha, other.alpha)


def test_depth_normals_and_ids_are_those_of_a_pinhole() -> None:
    blurred = render(seen_through(LENS), samples=4)
    plain = render(seen_through(None), samples=4)
    assert np.array_equal(blurred.depth, plain.depth)
    assert np.array_equal(blurred.ids, plain.ids)
    assert np.array_equal(blurred.normals, plain.normals)


def test_what_is_at_the_distance_of_the_focus_is_sharp() -> None:
    # A wall square to the view with balls before it whose light does not depend on where they are
    # seen from; all that is seen lies at one distance.
    wall = plane((0, 0, 6), (0, 0, -1), color=RED)
    document = seen_through({"radius": 1.5, "focus_distance": 16}, [wall])
    places = sample_places(*np.mgrid[0 : SIZE[1], 0 : SIZE[0]][::-1], 16, "tent")
    sharp = mean(oracle.look(document, places.columns, places.rows).linear, places.weights)
    found = render(document, samples=16, filter="tent").linear
    np.testing.assert_allclose(found, sharp, rtol=1e-9)


def spread(image: vtray.Image) -> tuple[float, float, float]:
    """Return how much a picture shows, and the mean squares of how far it reaches both ways."""
    cover = image.alpha
    rows, columns = np.indices(cover.shape)
    total = cover.sum()
    middle = (cover * columns).sum() / total, (cover * rows).sum() / total
    return (
        float(total),
        float((cover * (columns - middle[0]) ** 2).sum() / total),
        float((cover * (rows - middle[1]) ** 2).sum() / total),
    )


@compiled_only
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("depth", [7.0, 10.0, 14.0, 40.0])
def test_circle_of_confusion(depth: float, projection: str) -> None:
    # A ball at a depth z is blurred to a disc of the radius R |1/f - 1/z| focus / pixel; that of a
    # disc of radius r has the mean square r^2 / 4 in each direction, and squares add up.
    radius, sharp, pixel, focus, ball = 0.6, 10.0, 0.05, 5.0, 0.03 * depth
    document = seen_through(
        {"radius": radius, "focus_distance": sharp},
        [sphere((0, 0, depth - focus), ball)],
        focus=focus,
        size=[100, 100],
        resolution=[pixel, pixel],
        projection=projection,
    )
    share = focus / depth if projection == "perspective" else 1.0
    blur = radius * abs(depth / sharp - 1.0) * share / pixel
    shown = ball * share / pixel
    total, across, down = spread(render(document, samples=256, filter="box"))
    assert total == pytest.approx(np.pi * shown**2, rel=0.02)
    # The box filter spreads by 1/12.
    expected = blur**2 / 4 + shown**2 / 4 + 1 / 12
    assert across == pytest.approx(expected, rel=0.05)
    assert down == pytest.approx(expected, rel=0.05)


@compiled_only
def test_blur_has_the_shape_of_the_opening() -> None:
    # Behind what is sharp the triangle stands upright, one corner up; before it, upside down.
    def picture(depth: float) -> np.ndarray:
        document = seen_through(
            {"radius": 0.8, "focus_distance": 10, "blades": 3},
            [sphere((0, 0, depth - 5), 0.003 * depth)],
            focus=5,
            size=[160, 160],
            resolution=[0.0125, 0.0125],
        )
        return render(document, samples=1024, filter="box").alpha > 0

    behind, before = picture(20.0), picture(10 / 1.5)
    reach = 0.8 * 0.5 * (5 / 10) / 0.0125  # of its corners, in pixels
    for shown, up in ((behind, 1), (before, -1)):
        rows, columns = np.nonzero(shown)
        assert up * (80 - rows).max() == pytest.approx(reach if up > 0 else -reach / 2, abs=3)
        assert up * (80 - rows).min() == pytest.approx(-reach / 2 if up > 0 else reach, abs=3)
        width = np.sqrt(3) * reach
        assert np.ptp(columns) == pytest.approx(width, abs=6)
        # Pixels on the three sides count as a whole.
        inside = width * 1.5 * reach / 2
        assert 0.95 * inside < shown.sum() < inside + 2.5 * 3 * width


@pytest.mark.parametrize("blades", [0, 3, 4, 6, 64])
def test_openings_are_filled_evenly(blades: int) -> None:
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 1, (4, 4), (1, 1))
    lens = pack_lens(camera.replace(lens=vtray.Lens(1, 5, blades=blades or None)), 1.0, 1.0)
    assert lens is not None
    side = 64
    u, v = ((np.indices((side, side)) + 0.5) / side).reshape(2, -1)
    found = np.array([place_in_opening(lens.corners, *pair) for pair in zip(u, v, strict=True)])
    np.testing.assert_allclose(found, opening(u, v, blades), atol=1e-12)
    np.testing.assert_allclose(found.mean(axis=0), 0, atol=2e-3)
    sides = blades or 10**6
    square = (2 + np.cos(2 * np.pi / sides)) / 6  # the mean square of the distance from the middle
    assert (found**2).sum(axis=1).mean() == pytest.approx(square, rel=2e-3)
    inner = np.cos(np.pi / sides)
    turns = 2 * np.pi * (np.arange(blades or 1) + 0.5) / (blades or 1)
    if blades:
        outwards = np.stack([np.sin(turns), -np.cos(turns)])
        assert (found @ outwards).max() <= inner + 1e-12
    else:
        assert np.hypot(*found.T).max() <= 1 + 1e-12


@once
def test_light_can_be_changed_afterwards() -> None:
    given = vtray.loads(json.dumps(seen_through(LENS)))
    image = vtray.render(given, samples=6, keep_lights=True)
    given.lights = [given.lights[0].replace(intensity=0.2), given.lights[1]]
    again = vtray.render(given, samples=6, lock=image)
    assert np.array_equal(image.relight([0.2, 0.4]).linear, again.linear)


@once
def test_mirrors_and_paths_go_through_the_lens() -> None:
    objects = [{**BALLS[0], "material": "mirror"}, *BALLS[1:]]
    matt = render(seen_through(LENS), samples=16, integrator="whitted")
    straight = render(seen_through(LENS), samples=16)
    assert np.array_equal(matt.linear, straight.linear)
    shown = render(seen_through(LENS, objects), samples=16, integrator="whitted")
    paths = render(seen_through(LENS, objects), samples=16, integrator="path")
    assert np.array_equal(shown.alpha, straight.alpha)
    assert np.array_equal(paths.alpha, straight.alpha)
    # Paths add what surfaces light each other by.
    assert (paths.linear.sum() > shown.linear.sum() > 0).all()


@once
def test_faded_bodies_soft_light_fog_and_a_sky_go_with_it() -> None:
    given = vtray.loads(json.dumps(seen_through(LENS)))
    given.add_sphere((1, 0.5, 1), 0.8, "navy", opacity=0.4)
    given.add_light(vtray.SphereLight((0, -8, 0), 1.5, visible=True))
    given.add_light(vtray.Sky(gradient=vtray.Gradient(), radiance=0.3))
    given.style = vtray.Style(fog=(10, 40), outline=1.0, eye_dome=True)
    options = {"samples": 8, "background": "sky"}
    one, other = (vtray.render(given, threads=n, **options) for n in (1, 3))
    assert np.array_equal(one.pixels, other.pixels)
    far = given.camera.replace(lens=vtray.Lens(1e-9, 16))
    given.camera = far
    sharp = vtray.render(given, **options)
    assert np.abs(one.linear - sharp.linear).mean() < 0.4 * sharp.linear.mean()


@once
def test_growing_pictures() -> None:
    given, parts = vtray.loads(json.dumps(seen_through(LENS))), []
    image = vtray.render(given, samples=8, on_update=parts.append, update_seconds=0, tile=16)
    assert parts
    assert np.array_equal(image.linear, render(seen_through(LENS), samples=8).linear)


WRONG: list[tuple[Any, str]] = [
    ({"radius": -1, "focus_distance": 3}, ".radius: expected a number ≥ 0, got -1"),
    ({"radius": "x", "focus_distance": 3}, '.radius: expected a number ≥ 0, got "x"'),
    ({"radius": 4, "focus_distance": 3}, ".radius: expected a number from 0 to focus_distance, "),
    ({"radius": 1, "focus_distance": 0}, ".focus_distance: expected a number > 0, got 0"),
    ({"radius": 1, "focus_distance": "3"}, '.focus_distance: expected a number > 0, got "3"'),
    ({"radius": 1}, ".focus_distance: missing; expected this or focus_on, as one says what is"),
    (
        {"radius": 1, "focus_distance": 3, "focus_on": xyz(0, 0, 9)},
        ".focus_on: expected either this or focus_distance, not both, got {",
    ),
    ({"radius": 1, "focus_on": xyz(0, 0, -10)}, ": expected a focus_on in front of the eye, got"),
    (
        {"radius": 3, "focus_on": xyz(5, 5, -8)},
        ": expected a radius up to the distance from the eye to focus_on, which is 2, got",
    ),
    ({"radius": 1, "focus_distance": 3, "blades": 2}, ".blades: expected an integer from 3 to 64"),
    ({"radius": 1, "focus_distance": 3, "blades": 5.5}, ".blades: expected an integer from 3 to"),
    (3, ": expected an object with the key radius, got 3"),
]


@pytest.mark.parametrize(("lens", "words"), WRONG)
def test_what_is_wrong_is_told(lens: Any, words: str) -> None:
    assert f"camera.lens{words}" in message_of(json.dumps(seen_through(lens)))


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), "3", None, -1.0])
@pytest.mark.parametrize("name", ["radius", "focus_distance"])
def test_code_is_checked_too(name: str, wrong: Any) -> None:
    with pytest.raises(vtray.SceneError, match=f"Lens.{name}: "):
        vtray.Lens(**{"radius": 1, "focus_distance": 2, name: wrong})
    with pytest.raises(vtray.SceneError, match="Camera.lens: expected Lens, got 0.1"):
        vtray.Camera.look_at((0, 0, 5), (0, 0, 0), lens=0.1)


def test_files_keep_lenses(tmp_path: Any) -> None:
    for lens in (
        vtray.Lens(0.25, 5),
        vtray.Lens(0.25, focus_on=(1, 2, 3), blades=6),
        vtray.Lens(0.0, 1e-3),
    ):
        camera = vtray.Camera.look_at((0, 0, 9), (0, 0, 0), lens=lens, size=(8, 6))
        made = vtray.Scene(camera, [], [])
        made.save(tmp_path / "lens.json")
        assert vtray.load(tmp_path / "lens.json").camera == camera
        assert vtray.load_dict(made.to_dict()).camera == camera


def test_a_point_or_its_distance_is_the_same() -> None:
    near = seen_through({"radius": 0.5, "focus_distance": 16, "blades": 7.0})
    on = seen_through({"radius": 0.5, "focus_on": xyz(3, -4, 6), "blades": 7})
    assert np.array_equal(render(near, samples=3).linear, render(on, samples=3).linear)


def test_between_cameras() -> None:
    from vtray.animation.between_cameras import between_cameras
    from vtray.animation.keyframes import ApartError

    camera = vtray.Camera.look_at((0, -8, 0), (0, 0, 0), up=(0, 0, 1))
    one = camera.replace(lens=vtray.Lens(0.5, 4))
    other = camera.replace(lens=vtray.Lens(0.1, 16))
    middle = between_cameras(one, other, 0.5, (0, 0, 0)).lens
    assert middle is not None
    assert (middle.radius, middle.focus_distance) == pytest.approx((0.3, 8))
    opening_up = between_cameras(camera, one, 0.5, (0, 0, 0)).lens
    assert opening_up is not None
    assert (opening_up.radius, opening_up.focus_distance) == pytest.approx((0.25, 4))
    assert between_cameras(camera, camera.orbit(9), 0.5, (0, 0, 0)).lens is None
    with pytest.raises(ApartError, match="expected a lens of a disc.*got one of 5 blades"):
        between_cameras(one, one.replace(lens=vtray.Lens(0.5, 4, blades=5)), 0.5, (0, 0, 0))
