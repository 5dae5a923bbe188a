"""Fog hides more and more of what is farther away, and is antialiased as all else."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from examples import light, plane, scene, sphere

import vtray
from conftest import compiled_only, once
from vtray.rendering.fog import ball_around, fitted, shapes_of
from vtray.scene.placing.bounds import balls_of
from vtray.scene.placing.depths import depths_of
from vtray.scene.style import Style

SIZE = [16, 12]
WIDE = {"size": SIZE, "resolution": [0.4, 0.4]}
BALLS = [sphere((0, 0, 3), 2), sphere((1.5, 1, 8), 2.5, color={"r": 200, "g": 90, "b": 0})]
LAMP = [light(3, -9, -10)]


def world(*objects: dict, **camera: object) -> vtray.Scene:
    """Return a scene of balls or of others, seen along z from (0, 0, -10)."""
    return vtray.loads(json.dumps(scene([*objects] or BALLS, LAMP, **{**WIDE, **camera})))


def share_at(depth: np.ndarray, start: float, end: float) -> np.ndarray:
    """Return how much of what is seen is fog, by the rule as it is told; 0 where nothing is."""
    with np.errstate(over="ignore"):
        share = (np.where(np.isfinite(depth), depth, 0.0) - start) / (end - start)
    share = np.clip(share, 0.0, 1.0)
    return np.where(np.isfinite(depth), share, 0.0)


@once
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("background", ["black", "#204060", "transparent"])
@pytest.mark.parametrize("color", [None, (9, 99, 199)])
def test_one_ray_a_pixel(projection: str, background: str, color: object) -> None:
    found = world(projection=projection)
    plain = vtray.render(found, exposure=0.9)
    image = vtray.render(
        found, exposure=0.9, background=background, fog={"start": 12, "end": 19, "color": color}
    )
    share = share_at(image.depth, 12, 19)[..., None]
    assert 0 < share.mean() < 1
    np.testing.assert_allclose(image.linear, plain.linear * (1 - share), rtol=1e-14)
    covered = np.isfinite(image.depth)[..., None]
    lit = 0.9 * plain.linear * (1 - share)
    behind = np.zeros(3) if background == "black" else np.array([32, 64, 96])
    if background == "transparent":
        alpha = covered * (1.0 if color else 1 - share)
        assert (image.pixels[..., 3:] == np.rint(255 * alpha)).all()
        lit = np.divide(lit, alpha, out=np.zeros_like(lit), where=alpha > 0)
        veil = share * np.array(color or (0, 0, 0))
    else:
        veil = share * np.array(color or behind) + (1 - covered) * behind
    expected = np.floor((lit + veil).clip(0, 255))
    assert np.abs(image.pixels[..., :3] - expected).max() <= 1
    assert np.mean(image.pixels[..., :3] != expected) < 0.01


def test_depth_is_that_of_files() -> None:
    found = world()
    image, plain = vtray.render(found, fog=(11, 19)), vtray.render(found)
    np.testing.assert_array_equal(image.depth, plain.depth)
    np.testing.assert_array_equal(image.ids, plain.ids)
    np.testing.assert_array_equal(image.normals, plain.normals)


@once
@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("lights", ["points", "soft"])
def test_samples_see_it_each(samples: int, lights: str) -> None:
    # A wall that all rays meet after the same length: three quarters are left of everything.
    found = world(plane((0, 0, 5), (0, 0, -1)), sphere((0, 0, 5), 1), projection="orthographic")
    if lights == "soft":
        found.lights = [vtray.SphereLight((3, -9, -1), 1.0)]
    wall = vtray.Scene(found.camera, found.lights, found.objects[:1])
    plain = vtray.render(wall, samples=samples, exposure=1.0)
    image = vtray.render(wall, samples=samples, exposure=1.0, fog=(13, 21))
    np.testing.assert_allclose(image.linear, 0.75 * plain.linear, rtol=1e-12)
    # Before it, a ball, whose pixels lie between what is nearest and what is farthest in them.
    plain = vtray.render(found, samples=samples, exposure=1.0)
    image = vtray.render(found, samples=samples, exposure=1.0, fog=(13, 21))
    assert (image.linear >= 0.75 * plain.linear * (1 - 1e-12)).all()
    assert (image.linear <= 0.875 * plain.linear * (1 + 1e-12)).all()


@once
@pytest.mark.parametrize("fog", [(11, 19), (11, 19, "red")])
@pytest.mark.parametrize("samples", [1, 4])
def test_light_and_colours_change_as_in_a_new_render(fog: object, samples: int) -> None:
    found = world()
    found.style = Style(fog=fog)
    found.lights = [*found.lights, vtray.Light((-5, 0, -9), 0.5)]
    kept = vtray.render(found, samples=samples, background="#204060", keep_lights=True)
    plain = vtray.render(found, samples=samples, background="#204060")
    np.testing.assert_array_equal(kept.linear, plain.linear)
    changed = kept.relight([0.25, 2.0])
    first, second = found.lights
    found.lights = [first.replace(intensity=0.25), second.replace(intensity=2.0)]
    expected = vtray.render(found, samples=samples, background="#204060")
    np.testing.assert_array_equal(changed.linear, expected.linear)
    np.testing.assert_array_equal(changed.pixels, expected.pixels)
    assert changed.style == expected.style
    changed = kept.recolor(0, "lime")
    expected = vtray.render(changed.scene, samples=samples, background="#204060")
    np.testing.assert_array_equal(changed.pixels, expected.pixels)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_fitted_to_the_nearest_and_the_farthest_point(projection: str) -> None:
    found = world(sphere((0, 0, 4), 1), sphere((0, 0, 10), 2), projection=projection)
    fog = vtray.render(found, fog=True).style.fog
    assert (fog.start, fog.end) == pytest.approx((13, 22))
    half = vtray.render(found, fog={"start": 3}).style.fog
    assert (half.start, half.end) == (3, pytest.approx(22))
    # What is flat has all of the fog, and not the middle of that of a ball around it.
    flat = world(sphere((-6, 0, 4), 1), sphere((6, 0, 4), 1), projection=projection)
    fog = vtray.render(flat, fog=True).style.fog
    away = 14 if projection == "orthographic" else math.hypot(14, 6)
    assert (fog.start, fog.end) == pytest.approx((away - 1, away + 1))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_the_ball_around_a_scene_stays_as_a_camera_turns(projection: str) -> None:
    found = world(sphere((0, 0, 4), 1), sphere((0, 0, 10), 2), projection=projection)
    # The middle of the centres is (0, 0, 7); the farthest point from there is at 12.
    for camera in (found.camera, found.camera.orbit(70, about=found)):
        fog = fitted(Style(fog=True), camera, lambda: ball_around(found)).fog
        assert (fog.start, fog.end) == pytest.approx((17 - 5, 17 + 5))


def points_of(found: vtray.Scene) -> np.ndarray:
    """Return many points of the balls and discs that a scene is the hull of."""
    generator = np.random.default_rng(3)
    points = []
    for balls in balls_of(found, "test"):
        radii = np.broadcast_to(balls.radius, len(balls.center))
        for k, (center, radius) in enumerate(zip(balls.center, radii, strict=True)):
            way = generator.normal(size=(4000, 3))
            if balls.toward is not None:
                normal = balls.toward[k] - center
                normal = normal / np.linalg.norm(normal)
                way -= (way @ normal)[:, None] * normal
            way *= radius / np.linalg.norm(way, axis=1)[:, None]
            part = 1.0 if balls.toward is None else generator.random((4000, 1)) ** 0.5
            places = np.zeros((1, 3)) if balls.at is None else balls.at
            points += [center + part * way + at for at in places]
    return np.concatenate(points)


@pytest.mark.parametrize("kind", ["balls", "rods", "copies"])
@pytest.mark.parametrize("projection", ["perspective", "orthographic", "panorama"])
def test_depths_are_those_of_all_points(projection: str, kind: str) -> None:
    generator = np.random.default_rng(1)
    places = generator.normal(size=(9, 3))
    found = vtray.Scene()
    if kind == "balls":
        found.add_spheres(places, generator.uniform(0.1, 0.5, 9))
        found.add_sphere((0, 1, 0), 0.7)
    elif kind == "rods":
        found.add_cylinders(places, places + generator.normal(size=(9, 3)), 0.4)
        found.add_cone((0, 2, 0), (0, 2, 0.1), 3.0, 0.0)
    else:
        found.objects.append(vtray.Copies(vtray.Sphere((1, 2, 3), 0.3), at=places))
    eye = np.array([3.0, -5.0, 4.0])
    if projection == "panorama":
        camera = vtray.Camera.panorama(eye=tuple(eye), target=(0, 0, 0), up=(0, 0, 1))
    elif projection == "orthographic":
        camera = vtray.Camera.orthographic(tuple(eye), (0, 0, 0), 8.0, (0, 0, 1))
    else:
        camera = vtray.Camera.look_at(tuple(eye), (0, 0, 0), (0, 0, 1), 40.0)
    way = points_of(found) - eye
    forward = -eye / np.linalg.norm(eye)
    distance = way @ forward if projection == "orthographic" else np.linalg.norm(way, axis=1)
    near, far = depths_of(camera, balls_of(found, "test"))
    assert near <= distance.min() + 1e-9
    assert far >= distance.max() - 1e-9
    assert (near, far) == pytest.approx((distance.min(), distance.max()), abs=0.03)


def test_copies_are_as_far_as_what_they_hold() -> None:
    found = vtray.Scene()
    parts = [vtray.Sphere((0, 0, 0), 1), vtray.Sphere((4, 0, 0), 1)]
    found.objects.append(vtray.Copies(parts, at=[(0, 0, 20), (0, 0, 30)]))
    camera = vtray.Camera.orthographic((0, 0, 0), (0, 0, 1), 8.0)
    assert depths_of(camera, balls_of(found, "test")) == (19, 31)


def test_nothing_to_fit_it_to() -> None:
    found = world(plane((0, 0, 5), (0, 0, -1)))
    with pytest.raises(vtray.SceneError, match="fog: there is nothing that it could be fitted to"):
        vtray.render(found, fog=True)
    vtray.render(found, fog=(1, 2))
    with pytest.raises(vtray.SceneError, match="fog: expected a start before its end, got 99 and"):
        vtray.render(world(), fog={"start": 99})


@pytest.mark.parametrize("numbers", [(0, 1e308), (1e300, 1e308), (0, 5e-324), (14.5, 14.5 + 1e-14)])
def test_extreme_distances(numbers: tuple[float, float]) -> None:
    image = vtray.render(world(), fog=(*numbers, "red"))
    share = share_at(image.depth, *numbers)
    sure = np.abs(image.depth - 14.5) > 1e-9
    np.testing.assert_allclose(image.overlays[0].share[sure], share[sure], rtol=1e-9, atol=1e-99)


def test_lamps_are_seen_through_it() -> None:
    found = world(plane((0, 0, 50), (0, 0, -1)))
    found.lights = [vtray.SphereLight((0, 0, 10), 1.0, visible=True)]
    plain, image = vtray.render(found), vtray.render(found, fog=(11, 27))
    middle = 6, 8
    # From -10 to the lamp's nearest point, at 9.
    np.testing.assert_allclose(image.linear[middle], plain.linear[middle] / 2, rtol=1e-3)


@once
@pytest.mark.parametrize("integrator", ["whitted", "path"])
@pytest.mark.parametrize("samples", [1, 9])
def test_light_over_many_surfaces_is_in_it(integrator: str, samples: int) -> None:
    found = world()
    found.add_sphere((-2, 1, 6), 2.0, material="mirror")
    found.add_sphere((3, -1, 4), 1.0, color="gold", material="plastic")
    found.add_light(vtray.SphereLight((-3, -3, 6), 0.7, radiance=2, visible=True))
    found.add_light(vtray.Sky(0.5))
    options = {"integrator": integrator, "samples": samples, "filter": "box", "exposure": 1}
    plain, image = vtray.render(found, **options), vtray.render(found, fog=(11, 19), **options)
    if samples == 1:
        for y in range(0, SIZE[1], 2):
            for x in range(0, SIZE[0], 2):
                tree = vtray.trace_pixel(image, x, y)
                assert tree.light == tuple(plain.linear[y, x])
                seen = tree.light if tree.veil is None else tree.veil.light
                assert seen == tuple(image.linear[y, x])
    # What fog adds and what it takes is one share of each pixel, where all is as far away.
    shares = 1 - np.divide(image.linear, plain.linear, where=plain.linear > 0, out=plain.linear * 0)
    assert 0.1 < shares[plain.linear > 0].mean() < 0.9
    parts = image.emission + image.direct + image.indirect
    np.testing.assert_allclose(parts, image.linear, rtol=1e-12, atol=1e-12)


def test_a_pixel_is_explained() -> None:
    found = world()
    image = vtray.render(found, fog=(5, 19, "red"))
    tree = vtray.trace_pixel(image, 8, 6)
    share = float(share_at(np.array(tree.hit.distance), 5, 19))
    assert tree.veil.share == pytest.approx(share)
    assert tree.veil.light == pytest.approx(tuple((1 - share) * channel for channel in tree.light))
    assert tree.veil.light == tuple(image.linear[6, 8])
    text = str(tree)
    assert f"fog          {100 * share:.4g} % of what is seen {tree.hit.distance:.10g} away" in text
    assert " + (" in text
    assert "samples" not in text
    found.style = Style(fog=(5, 19))
    assert vtray.trace_pixel(found, 8, 6).veil == tree.veil
    assert vtray.trace_pixel(vtray.render(found), 8, 6).exposed.overlays == ()
    assert vtray.trace_pixel(found, 0, 0).veil is None


@pytest.mark.parametrize("place", [(3, 3, 0), (0, 0, 2)])
def test_fog_is_told_where_bodies_are_faded(place: tuple[float, float, float]) -> None:
    """Whether they are before what is seen, or nowhere in the picture."""
    found = vtray.Scene()
    found.add_plane((0, 0, 0), normal=(0, 0, 1), color="white")
    found.add_sphere(place, 0.5, opacity=0.5, color="white")
    found.add_light(vtray.Sun((0, 0, -1)))
    found.camera = vtray.Camera.look_at((0, 0, 5), (0, 0, 0), size=(2, 2), fov_degrees=10)
    image = vtray.render(found, fog=(2, 6), exposure=1)
    tree, passed = vtray.trace_pixel(image, 1, 1), 0.5 if place[0] == 0 else 1
    assert tree.veil is not None
    assert (tree.veil.distance, tree.veil.share, tree.veil.is_counted) == (5, 0.75, True)
    assert tree.light == tree.veil.light == tuple(image.linear[1, 1])
    assert tree.share == pytest.approx(0.25 * passed)
    (way,) = tree.lights
    assert way.adds == pytest.approx([255 * way.share * tree.share] * 3)
    text = str(tree)
    assert "fog          75 % of what is seen 5 away, which is left out above\n" in text
    assert f" x color x {tree.share:g} that is seen\n" in text
    assert "samples" not in text
    if tree.layers:
        (layer,) = tree.layers
        # The ball begins 2.5 away, in the fog of an eighth.
        assert (layer.fog, layer.share) == (0.125, pytest.approx(0.5 * 0.875))
        assert "  seen       43.75 % of its light, through 12.5 % fog\n" in text
        assert "behind       12.5 % of the light passes all layers and fog\n" in text


def test_what_is_behind_layers_and_nowhere_is_in_no_fog() -> None:
    found = world()
    found.objects = [vtray.Sphere((0, 0, 5), 3, (255, 255, 255), opacity=0.5)]
    tree = vtray.trace_pixel(vtray.render(found, fog=(5, 190)), 8, 6)
    assert (tree.hit, tree.veil) == (None, None)
    assert tree.share == pytest.approx(0.5)
    assert "behind       50 % of the light passes all layers\n" in str(tree)


def test_pictures_made_again(tmp_path: Path) -> None:
    found = world()
    image = vtray.render(found, fog=True)
    image.save(tmp_path / "a.png")
    told = vtray.read_provenance(tmp_path / "a.png")
    assert told.style == image.style
    again = vtray.render(found, **{name: told.told(name) for name in Style.__struct_fields__})
    np.testing.assert_array_equal(again.pixels, image.pixels)


def test_files_of_light_hold_it() -> None:
    image = vtray.render(world(), fog=(11, 19, "red"), exposure=0.5)
    share = share_at(image.depth, 11, 19)
    np.testing.assert_allclose(
        image.with_overlays[..., 0], image.linear[..., 0] + share * 255 / 0.5
    )
    np.testing.assert_array_equal(image.with_overlays[..., 1:], image.linear[..., 1:])


@compiled_only
def test_frames_have_the_same_fog(tmp_path: Path) -> None:
    found = world()
    found.camera = vtray.Camera.fit(found, size=(12, 9))
    vtray.turntable(found, tmp_path / "%d.png", seconds=0.3, fps=10, fog=True)
    fogs = [vtray.read_provenance(tmp_path / f"{k}.png").style.fog for k in range(3)]
    for fog in fogs[1:]:
        assert math.isclose(fog.start, fogs[0].start)
        assert math.isclose(fog.end, fogs[0].end)
    vtray.turntable(found, tmp_path / "%d.png", seconds=0.3, fps=10, fog=True, resume=True)


@compiled_only
def test_parts_of_a_picture_have_it() -> None:
    shown: list[vtray.Image] = []
    found = world(size=[160, 120], resolution=[0.04, 0.04])
    image = vtray.render(
        found,
        samples=4,
        fog=(11, 19),
        tile=8,
        on_update=shown.append,
        update_seconds=0.0,
        background="white",
    )
    assert shown
    assert shown[-1].style == image.style
    plain = vtray.render(found, samples=4)
    assert shown[-1].alpha.sum() < 0.9 * plain.alpha.sum()


@pytest.mark.parametrize("samples", [1, 4])
def test_a_lamp_is_as_dim_beside_what_fades(samples: int) -> None:
    found = world()
    lamp = vtray.SphereLight((-3.4, -2, 5), 1.2, radiance=4, visible=True)
    found.lights.append(lamp)
    alone = vtray.render(found, samples=samples, fog=(11, 19), exposure=1.0)
    # It hides nothing, and only now is light looked for layer by layer.
    found.add_sphere((0, 0, 60), 0.5, opacity=0.5)
    image = vtray.render(found, samples=samples, fog=(11, 19), exposure=1.0)
    seen = alone.linear.max(axis=2) > 300
    assert seen.any()
    np.testing.assert_allclose(image.linear[seen], alone.linear[seen], rtol=1e-12)


def test_sheets_seen_from_above_have_the_fog_of_the_ball_around() -> None:
    scene = vtray.Scene()
    scene.add_spheres([(0, 0, 0), (3, 0, 0), (0, 4, 0)], 0.0)
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 8, up=(0, 1, 0), size=(4, 3))
    fog = fitted(Style(fog=True), scene.camera, lambda: shapes_of(scene)).fog
    assert fog.start < 9 < fog.end


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("seed", range(6))
def test_copies_are_as_far_away_as_if_written_out(seed: int, projection: str) -> None:
    random = np.random.default_rng(seed)
    ends, places = random.normal(size=(2, 5, 3)), 3 * random.normal(size=(9, 3))
    radii = random.uniform(0, 1, 5)
    balls, sticks = vtray.Spheres(ends[0], radii), vtray.Cylinders(*ends, radii)
    copies, written = vtray.Scene(), vtray.Scene()
    copies.objects = [vtray.Copies([balls, sticks], places)]
    for at in places:
        written.add_spheres(ends[0] + at, radii)
        written.add_cylinders(*(ends + at), radii)
    camera = vtray.Camera.fit(written, view="iso", projection=projection)
    found, expected = (depths_of(camera, balls_of(one, "test")) for one in (copies, written))
    assert found == expected
