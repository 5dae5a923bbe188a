"""Pictures of what clip planes cut: those of an oracle, and all ways to the same picture."""

import warnings
from dataclasses import replace
from random import Random
from typing import Any

import msgspec
import numpy as np
import oracle_clip
import pytest
from examples import cone, cylinder, light, plane, scene, sphere
from hierarchies import ALWAYS, NEVER, render
from plain import trace_pixel as trace_plainly
from single_rays import lit_pixel
from written_out import write_out

import vtray
from conftest import JIT, compiled_only, once
from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.packet import CAP
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.rendering.passes import Tracer
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.transport.integrators import reference
from vtray.transport.sampling.fans import fans_of_middles

Scene = dict[str, Any]

VIEW: Scene = {"size": [40, 30], "resolution": [0.15, 0.15]}
SMALL: Scene = {"size": [9, 7], "resolution": [0.6, 0.6]}
PLANES = [((0.3, 0.1, -1), -3.6)]
"""What is nearer to the eye is left out."""
WEDGE = [((0.3, 0.1, -1), -3.6), ((1, 0.2, 0), 0.7), ((-0.2, 1, 0.1), 1.3)]


def crowd(seed: int, count: int, *kinds: str, **camera: Any) -> Scene:
    """Return a scene of shapes that overlap, before a wall."""
    random = Random(seed)
    objects = [plane((0, 0, 9), (0.2, 0.1, -1))]
    for _ in range(count):
        center = [random.uniform(-2, 2), random.uniform(-1.6, 1.6), random.uniform(2, 6)]
        color = {c: random.randrange(60, 256) for c in "rgb"}
        end = [p + random.choice([0.3, 1.5]) * random.uniform(-1, 1) for p in center]
        radius, kind = random.uniform(0.2, 0.7), random.choice(kinds)
        if kind == "sphere":
            objects.append(sphere(tuple(center), radius, color=color))
        elif kind == "cylinder":
            objects.append(cylinder(tuple(center), tuple(end), 0.5 * radius, color=color))
        else:
            objects.append(cone(tuple(center), tuple(end), radius, 0.1, color=color))
    lights = [light(5, -5, -9), light(-3, 1, 3, intensity=0.4)]
    return scene(objects, lights, **{**(VIEW if JIT else SMALL), **camera})


def load(document: Scene) -> vtray.Scene:
    """Return a scene, in which many single objects are arrays, so that they have a hierarchy."""
    return vtray.load_dict(document)


def style_of(planes: Any, cap: Any) -> dict[str, Any]:
    """Return the options of a render."""
    return {"clip": [(*normal, distance) for normal, distance in planes], "cap": cap}


def test_planes_of_no_objects_cut_nothing() -> None:
    scene = vtray.Scene(lights=[vtray.Light((0, -9, 3), 1)])
    scene.add_sphere((0, 0, 0), 1)
    scene.camera = vtray.Camera.fit(scene, size=(8, 6))
    plain = vtray.render(scene)
    for clip in (vtray.ClipPlane((1, 0, 0), objects=[]), []):
        np.testing.assert_array_equal(vtray.render(scene, clip=clip).linear, plain.linear)


def test_planes_may_be_rows_of_an_array() -> None:
    rows = np.array([(1.0, 0.0, 0.0, 0.5), (0.0, 1.0, 0.0, 0.25)])
    wanted = (vtray.ClipPlane((1, 0, 0), 0.5), vtray.ClipPlane((0, 1, 0), 0.25))
    assert vtray.Style(clip=rows).clip == vtray.Style(clip=rows.tolist()).clip == wanted
    assert vtray.Style(clip=rows[0]).clip == wanted[:1]
    with pytest.raises(vtray.SceneError, match="such as 1,0,0,2.5, got 1,0,0;$"):
        vtray.Style(clip="1,0,0;")


@pytest.mark.parametrize("given", [None, [vtray.Scene()], "room.json"])
def test_what_is_rendered_is_a_scene(given: Any) -> None:
    with pytest.raises(vtray.SceneError, match=r"scene: expected a vtray\.Scene, got"):
        vtray.render(given)


@once
@pytest.mark.parametrize("cap", [False, True, (255, 255, 0)])
@pytest.mark.parametrize(
    ("planes", "kinds", "camera"),
    [
        (PLANES, ("sphere",), {}),
        (PLANES, ("sphere", "cylinder"), {"projection": "orthographic"}),
        (WEDGE, ("sphere", "cylinder"), {}),
        (PLANES, ("sphere",), {"center": {"x": 0, "y": 0, "z": 4.2}}),
    ],
)
def test_is_near_the_oracle(cap: Any, planes: Any, kinds: Any, camera: Scene) -> None:
    document = crowd(4, 25 if JIT else 4, *kinds, **camera)
    image = render(load(document), NEVER, **style_of(planes, cap))
    seen = oracle_clip.look(
        document,
        planes,
        is_capped=cap is not False,
        cap=cap if isinstance(cap, tuple) else None,
    )
    ids = image.ids[..., 0]
    same = ids == seen.ids
    assert (~same).mean() < (2e-3 if JIT else 0.04)
    assert (seen.caps >= 0).any() <= (cap is not False)
    # From within what is cut away, the camera may see no cap.
    assert (seen.caps >= 0).any() or cap is False or camera.get("center") or not JIT
    hit = same & (ids >= 0)
    np.testing.assert_allclose(image.depth[hit], seen.depth[hit].astype(float), rtol=1e-9)
    far = np.abs(image.normals[hit] - seen.normals[hit]).max(axis=-1) > 1e-6
    assert far.mean() < 4e-3
    far = np.abs(image.linear[hit] - seen.linear[hit]).max(axis=-1) > 1e-3
    assert far.mean() < (4e-3 if JIT else 0.1)


KINDS = ("sphere", "cylinder", "cone")


@compiled_only
@pytest.mark.parametrize("cap", [False, True])
def test_hierarchies_and_single_rays_tell_the_same(cap: bool) -> None:
    scene = load(crowd(5, 160, *KINDS))
    options = style_of(WEDGE, cap)
    image = render(scene, NEVER, **options)
    other = render(scene, ALWAYS, threads=3, tile=7, **options)
    for name in ("linear", "depth", "normals", "ids"):
        np.testing.assert_array_equal(getattr(image, name), getattr(other, name))
    arrays = pack(scene, accelerate(scene, style=Style(**options))).arrays
    cosines, blockers = np.zeros(2), np.full(2, NOTHING)
    width, height = VIEW["size"]
    for y in range(height):
        for x in range(y % 2, width, 2):
            found = trace_plainly(arrays, x, y, cosines, blockers)
            plain = cosines.copy(), blockers.copy()
            traced = reference.trace_pixel(
                arrays, x, y, new_stack(), cosines, blockers, new_walk(0)
            )
            assert traced == found
            np.testing.assert_array_equal(plain, (cosines, blockers))
            assert traced.value == tuple(image.linear[y, x])


@compiled_only
@pytest.mark.parametrize("cap", [False, True])
def test_copies_are_cut_as_if_written_out(cap: bool) -> None:
    random = np.random.default_rng(3)
    scene = load(crowd(5, 6, *KINDS))
    balls = vtray.Spheres(random.uniform(-0.5, 0.5, (20, 3)), random.uniform(0.1, 0.3, 20))
    parts = [balls, vtray.Cylinder((0, 0, 0), (0.5, 0.2, 0.1), 0.1), vtray.Sphere((1, 0, 0), 0.2)]
    scene.add_copies(parts, random.uniform((-2, -1.5, 2), (2, 1.5, 6), (15, 3)))
    options = {**style_of(WEDGE, cap), "threads": 2}
    image, whole = vtray.render(scene, **options), vtray.render(write_out(scene)[0], **options)
    np.testing.assert_array_equal(image.linear, whole.linear)
    np.testing.assert_array_equal(image.depth, whole.depth)
    np.testing.assert_array_equal(image.normals, whole.normals)
    assert set(np.unique(image.copies)) > {-1}


@once
@pytest.mark.skipif(JIT, reason="needs kernels of its own, which take long to compile")
def test_copies_of_what_fades_beside_what_does_not_are_cut_as_if_written_out() -> None:
    scene = load(crowd(5, 1, "sphere", **VIEW))
    parts = [vtray.Sphere((0, 0, 0), 0.1), vtray.Sphere((0.2, 0, 0), 0.1, opacity=0.5)]
    corners = np.indices((3, 7, 4)).reshape(3, -1).T
    scene.add_copies(parts, corners * (0.5, 0.25, 0.5) + (-0.6, -0.8, 3))
    options = style_of([((1, 0.2, 0.3), 1.0), ((-0.1, 1, 0.1), 0.7)], True)
    image, whole = vtray.render(scene, **options), vtray.render(write_out(scene)[0], **options)
    np.testing.assert_array_equal(image.linear, whole.linear)
    np.testing.assert_array_equal(image.depth, whole.depth)
    assert len(np.unique(image.copies)) > 5


def with_all_cut(kept: Acceleration) -> Acceleration:
    """Return shapes of which all that are copied count as such that clip planes may cut."""
    assert kept.placed is not None
    assert not kept.is_cut
    items = len(kept.items_of(kept.copied))
    placed = replace(kept.placed, item=kept.placed.item + np.int32(items))
    return replace(kept, placed=placed)


@compiled_only
def test_what_is_not_cut_is_as_without_clip_planes() -> None:
    kinds = "sphere", "cylinder"
    objects, scene = load(crowd(6, 150, *kinds)).objects, load(crowd(6, 1, *kinds))
    scene.objects = [objects[0], vtray.Copies(objects[1:], [(0, 0, 0), (0.1, 0.2, 0.3)])]
    plain = vtray.render(scene)
    options = style_of([((0.1, 0.2, 1), 99)], True)
    image = vtray.render(scene, **options)
    # But for the far part of the wall behind all.
    same = image.ids[..., 0] == plain.ids[..., 0]
    assert same.mean() > 0.9
    kept = accelerate(scene, style=Style(**options))
    few, many = (
        Tracer(pack(scene, one).arrays, 1).light(RenderSettings(), None).film.linear
        for one in (kept, with_all_cut(kept))
    )
    np.testing.assert_array_equal(few, many)
    np.testing.assert_array_equal(image.linear[same], plain.linear[same])


def test_parts_of_the_picture() -> None:
    ball = vtray.Sphere((0, 0, 4), 1, (255, 0, 0))
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 5, (8, 8) if JIT else (2, 2), (0.01, 0.01))
    scene = vtray.Scene(camera, [vtray.Light((0, 0, -9))], [ball], style=Style(clip=(0, 0, -1, -4)))
    middle = camera.size[1] // 2, camera.size[0] // 2
    hollow, closed = vtray.render(scene), vtray.render(scene, cap="lime")
    assert hollow.depth[middle] == 10.0
    assert closed.depth[middle] == 9.0
    assert closed.normals[middle].tolist() == [0, 0, -1]
    assert closed.ids[middle].tolist() == [0, 0]
    assert closed.pixels[middle].tolist() == [0, 255, 0]
    assert vtray.render(scene, cap=True).pixels[middle].tolist() == [255, 0, 0]
    assert vtray.render(scene, clip=()).depth[middle] == 8.0
    assert vtray.render(scene, clip="off", slice=(0, 0, 1, 4.9, 0.6)).depth[middle] == 10.0
    half = vtray.render(scene, clip=(), slice=(0, 0, 1, 4, 0.5), cap=True)
    assert half.depth[middle] == 8.75


@compiled_only
def test_other_lights_and_colors() -> None:
    scene = load(crowd(5, 30, "sphere"))
    options = {**style_of(WEDGE, "white"), "samples": 4, "keep_lights": True}
    image = vtray.render(scene, **options)
    dimmed = image.relight([0.5, 2.0])
    np.testing.assert_array_equal(dimmed.linear, vtray.render(dimmed.scene, **options).linear)
    # One of which more is seen than its cap, which is white.
    round_ = (image.ids[..., 0] > 0) & (np.abs(image.normals[..., 2]) < 0.5)
    colored = image.recolor(int(np.bincount(image.ids[round_][:, 0]).argmax()), "purple")
    assert not np.array_equal(colored.linear, image.linear)
    np.testing.assert_array_equal(colored.linear, vtray.render(colored.scene, **options).linear)


@compiled_only
@pytest.mark.parametrize("far", [0.0, 1e6])
@pytest.mark.parametrize("cap", [False, True])
def test_nothing_speckles(far: float, cap: bool) -> None:
    # Square to all light, nothing is in the way of a cut: each has one brightness.
    random = np.random.default_rng(8)
    scene = vtray.Scene()
    shift = np.array([far, -far, far])
    scene.add_spheres(random.uniform(-1, 1, (200, 3)) + shift, 0.35, "white")
    normal = np.array([1, 2, -2]) / 3
    light = shift + normal * 1e3
    scene.lights = [vtray.Light(tuple(light))]
    eye = vtray.Camera.fit(scene, direction=(-1, -2, 2.2), size=(120, 90))
    scene.camera = eye
    plane = vtray.ClipPlane(tuple(normal), center=tuple(shift + 0.1 * normal))
    image = vtray.render(scene, clip=plane, cap=cap)
    is_cap = (image.ids[..., 0] >= 0) & (np.abs(image.normals @ normal) > 1 - 1e-9)
    if cap:
        assert is_cap.mean() > 0.2
        light_of_caps = image.linear[is_cap]
        assert light_of_caps.min() > 0.99 * light_of_caps.max()
    else:
        assert is_cap.mean() < 0.01


@compiled_only
@pytest.mark.parametrize("cap", [False, True])
def test_pixels_on_edges_have_samples(cap: bool) -> None:
    document = crowd(9, 40, "sphere")
    options = style_of(WEDGE, cap)
    image = render(load(document), ALWAYS, samples=4, keep_lights=True, **options)
    marks = image._relighting._passes[1].first >= 0
    times = 5
    width, height = document["camera"]["size"]
    fine = msgspec.json.decode(msgspec.json.encode(document))
    fine["camera"]["size"] = [times * width, times * height]
    fine["camera"]["resolution"] = [length / times for length in fine["camera"]["resolution"]]
    found = render(load(fine), ALWAYS, **options)
    # The middle of a pixel is at an integer, and so a fine one beside it belongs to two.
    ids = found.ids[..., 0]
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            if not marks[y, x]:
                mine = np.s_[times * y - 2 : times * y + 3, times * x - 2 : times * x + 3]
                assert len(np.unique(ids[mine])) == 1
                normals = found.normals[mine].reshape(-1, 3)
                assert np.abs(normals - normals[0]).max() < 0.75
    hit = image.ids[..., 0] >= 0
    assert marks[hit].mean() < 0.8


def test_a_moved_plane_hashes_and_builds_nothing_anew() -> None:
    random = np.random.default_rng(1)
    scene = vtray.Scene()
    scene.add_spheres(random.uniform(-1, 1, (400 if JIT else 150, 3)), 0.05)
    scene.camera = vtray.Camera((0, 0, -2), (0, 0, 1), 3, (4, 4), (0.5, 0.5))
    whole = accelerate(scene)
    one = accelerate(scene, style=Style(clip=(0, 0, -1, 0.25)))
    assert accelerate(scene, style=Style(clip=(0, 0, -1, 0.25))) is one
    other = accelerate(scene, style=Style(clip=(0, 0, -1, 0.5)))
    assert accelerate(scene) is whole
    assert other.items is one.items is whole.items
    z = scene.objects[0].center[:, 2]
    for kept, z_least in ((one, -0.25), (other, -0.5)):
        assert kept.shapes[0].count == int((z - 0.05 > z_least + 1e-9).sum())
        assert kept.cut[0][1].count == int((np.abs(z - z_least) < 0.05).sum())
        slots = kept.shapes[0].count + kept.cut[0][1].count
        assert len(set(kept.columns[0].number[:slots].tolist())) == slots


@compiled_only
def test_planes_cut_the_objects_that_they_name() -> None:
    document = crowd(5, 24, *KINDS)
    objects = load(document).objects
    plane = {"normal": (0.3, 0.1, -1), "distance": -3.6}
    some = tuple(range(0, len(objects), 2))
    other = {"normal": (1, 0.2, 0), "distance": 0.7, "objects": [3, 4, 5]}
    scene = load(document)
    image = vtray.render(scene, clip=[{**plane, "objects": some}, other], cap=True)
    ids, depth = image.ids[..., 0], image.depth
    free = [k for k in range(len(objects)) if k % 2 and k not in (3, 5)]
    # Each alone, in front of nothing: the nearest of these is what is seen.
    nearest = np.full(depth.shape, np.inf)
    for clips, mine in (
        ([], free),
        ([plane], [k for k in some if k != 4]),
        ([other], [3, 5]),
        ([plane, other], [4]),
    ):
        part = vtray.Scene(scene.camera, scene.lights, [objects[k] for k in mine])
        given = [{k: v for k, v in one.items() if k != "objects"} for one in clips]
        nearest = np.minimum(nearest, vtray.render(part, clip=given, cap=True, warn=print).depth)
    np.testing.assert_array_equal(depth, nearest)
    assert set(free) & set(np.unique(ids))


@compiled_only
@pytest.mark.parametrize("cap", [False, True])
def test_soft_light_arrives_as_each_ray_alone_would(cap: bool) -> None:
    random = np.random.default_rng(4)
    scene = vtray.Scene()
    scene.add_spheres(random.uniform(-1, 1, (150, 3)), random.uniform(0.1, 0.4, 150), "white")
    scene.lights = [
        vtray.Ambient(0.4),
        vtray.Light((3, -4, 9), 0.3),
        vtray.Sun((0.5, 0.6, -1), 0.5, angle=8),
        vtray.SphereLight((-4, -2, 5), 1.5, 0.4),
    ]
    scene.camera = vtray.Camera.fit(scene, direction=(0.3, 1, -0.6), size=(24, 18))
    options: dict[str, Any] = {"clip": (0.1, -1, 0.3, 0.2), "cap": cap}
    image = vtray.render(scene, seed=5, tolerance=0.05, **options)
    arrays = pack(scene, accelerate(scene, style=Style(**options))).arrays
    assert image.noise is not None
    fans = fans_of_middles(image.noise)
    caps = 0
    for y in range(0, 18, 2):
        for x in range(0, 24, 2):
            traced, _ = lit_pixel(arrays, x, y, fans, seed=5)
            if traced.primitive != NOTHING:
                caps += bool(traced.interaction.half & CAP)
            assert tuple(image.linear[y, x]) == traced.value
    assert (caps > 5) == cap


@pytest.mark.parametrize("distance", [99, 1e308])
def test_a_plane_that_cuts_nothing_may_be_anywhere(distance: float) -> None:
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 5, (4, 4), (0.1, 0.1))
    scene = vtray.Scene(camera, [vtray.Light((0, 0, -9))], [vtray.Sphere((0, 0, 4), 1)])
    plain = vtray.render(scene)
    assert plain.linear.min() > 0
    np.testing.assert_array_equal(
        vtray.render(scene, clip=(0, 0, 1, distance)).linear, plain.linear
    )


def test_planes_that_leave_nothing_are_warned_of_where_render_is_called() -> None:
    world = load(scene([sphere((0, 0, 5), 1)], [light(0, 0, 0)], size=[3, 2]))
    with pytest.warns(UserWarning, match=r"^style.clip: leaves nothing of the scene") as caught:
        assert not vtray.render(world, clip=(0, 0, 1, -9)).linear.any()
    assert [warning.filename for warning in caught] == [__file__]


@pytest.mark.parametrize(
    ("clip", "is_left"),
    [
        ((0, 1, 0, -0.5), True),
        ((0, 1, 0, -1.5), False),
        ((0, -1, 0, -2.5), False),
        ((0, 1, 0, -1), True),
        (((0, 1, 0, -0.5), (1, 0, 0, -9)), True),
        (((1, 0, 0, -9), (-1, 0, 0, 3)), False),
        (((1, 0, 0, -9), (0, 0, 1, -9), (-1, 1, -1, 16)), True),
        (((1, 0, 0, -9), (0, 0, 1, -9), (-1, 0, -1, 12)), False),
        ((0, 1, 0, -1e300), False),
        ((1, 0, 0, -1e300), True),
    ],
)
def test_a_plane_of_which_anything_is_left_is_not_warned_of(
    clip: tuple[object, ...], is_left: bool
) -> None:
    world = vtray.Scene()
    world.add_plane((0, -1, 0), normal=(0, 1, 0))
    world.add_sphere((0, 1, 0), 1)
    world.camera = vtray.Camera.look_at((0, 8, 9), target=(0, 0, 0), size=(6, 4))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        vtray.render(world, clip=clip)
    said = [str(warning.message) for warning in caught]
    assert any(text.startswith("style.clip: leaves nothing") for text in said) != is_left
