"""What is kept with a scene: it is made anew exactly when its spheres change."""

import copy
import pickle
import signal
import threading
from collections.abc import Callable

import numpy as np
import pytest
from clouds import cloud
from hierarchies import ALWAYS, render

import vtray
from conftest import JIT, compiled_only, once
from vtray.geometry.bvh import build as bvh_build
from vtray.rendering import hierarchy as acceleration
from vtray.rendering import renderer
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.numbering import locate, number_objects

CAMERA = vtray.Camera((0, 0, -3), (0, 0, 1), 2, (8, 6), (0.2, 0.2))
LIGHTS = [vtray.Light((1, -3, -5), 1)]
WALL = vtray.Plane((0, 0, 5), (0, 0, -1), (9, 9, 9), 1)
BALL = vtray.Sphere((0, 0, 2), 0.5, (1, 2, 3), 1)


def arrays(count: int = 100) -> dict[str, np.ndarray]:
    """Return arrays that can be written to."""
    random = np.random.default_rng(7)
    return {
        "center": random.normal(size=(count, 3)),
        "radius": random.uniform(0.1, 0.4, count),
        "color": random.integers(0, 256, (count, 3), dtype=np.uint8),
        "lambert": random.uniform(0.2, 0.5, count),
    }


def scene_of(*objects: object) -> vtray.Scene:
    return vtray.Scene(CAMERA, LIGHTS, list(objects))


def replace_camera(scene: vtray.Scene) -> None:
    scene.camera = vtray.Camera((1, 2, 3), (1, 0, 0), 5, (3, 3), (1, 1))


def move_the_planes(scene: vtray.Scene) -> None:
    scene.objects = [WALL, *(item for item in scene.objects if item is not WALL), WALL]


NO_BUILD: dict[str, Callable[[vtray.Scene], object]] = {
    "nothing": lambda scene: None,
    "camera": replace_camera,
    "light": lambda scene: scene.lights.append(vtray.Light((0, 0, 0), 3)),
    "no light": lambda scene: scene.lights.clear(),
    "plane": lambda scene: scene.objects.append(WALL),
    "planes": move_the_planes,
    "check": lambda scene: scene.check(),
    "render": lambda scene: vtray.render(scene, threads=1),
}


@pytest.mark.parametrize("change", NO_BUILD)
def test_a_change_of_other_things_needs_no_new_build(change: str) -> None:
    scene = scene_of(WALL, vtray.Spheres(**arrays()), BALL)
    kept = accelerate(scene)
    NO_BUILD[change](scene)
    assert accelerate(scene) is kept


def swap_objects(scene: vtray.Scene) -> None:
    scene.objects.reverse()


BUILD: dict[str, Callable[[vtray.Scene], object]] = {
    "another sphere": lambda scene: scene.objects.append(BALL),
    "one sphere less": lambda scene: scene.objects.remove(BALL),
    "an equal sphere": lambda scene: scene.objects.__setitem__(
        2, vtray.Sphere((0, 0, 2), 0.5, (1, 2, 3), 1)
    ),
    "more arrays": lambda scene: scene.objects.append(vtray.Spheres(**arrays(3))),
    "equal arrays": lambda scene: scene.objects.__setitem__(1, vtray.Spheres(**arrays())),
    "another order": swap_objects,
}


@once
@pytest.mark.parametrize("change", BUILD)
def test_other_objects_need_a_new_build(change: str) -> None:
    scene = scene_of(WALL, vtray.Spheres(**arrays()), BALL)
    kept = accelerate(scene)
    BUILD[change](scene)
    assert accelerate(scene) is not kept
    np.testing.assert_array_equal(
        vtray.render(scene, threads=1).linear, render(scene, ALWAYS).linear
    )


CHANGES: dict[str, Callable[[dict[str, np.ndarray]], object]] = {
    "one digit": lambda columns: columns["center"].__setitem__(
        (-1, -1), np.nextafter(columns["center"][-1, -1], 9)
    ),
    "one color": lambda columns: columns["color"].__setitem__((50, 1), 256 - 200),
    "last color": lambda columns: columns["color"].__setitem__((-1, 2), 0),
    "lambert": lambda columns: columns["lambert"].__setitem__(3, 0.75),
    "twice as large": lambda columns: columns["radius"].__imul__(2),
    "twice as far": lambda columns: columns["center"].__imul__(2),
    "mirrored": lambda columns: columns["center"].__imul__(-1),
    "one axis mirrored": lambda columns: columns["center"][:, 1].__imul__(-1),
    "two centers swapped": lambda columns: columns["center"].__setitem__(
        [3, 4], columns["center"][[4, 3]]
    ),
    "reversed": lambda columns: columns["center"].__setitem__(..., columns["center"][::-1].copy()),
    "radius and lambert swapped": lambda columns: (
        columns["radius"].__setitem__(..., columns["lambert"].copy()),
        columns["lambert"].__setitem__(..., arrays(len(columns["radius"]))["radius"]),
    ),
}


@once
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", [100, 4096, 8192])
@pytest.mark.parametrize("change", CHANGES)
def test_arrays_changed_in_place_need_a_new_build(change: str, count: int, dtype: type) -> None:
    columns = arrays(count if JIT else 60)
    columns = {
        name: column if name == "color" else column.astype(dtype)
        for name, column in columns.items()
    }
    if not JIT and change == "one color":
        columns["color"][50, 1] = 0
    spheres = vtray.Spheres(**columns)
    before = acceleration._fingerprint([spheres], 1)
    assert acceleration._fingerprint([BALL, spheres], 1) == before
    CHANGES[change](columns)
    assert acceleration._fingerprint([spheres], 1) != before


def test_the_picture_follows_arrays_changed_in_place() -> None:
    columns = arrays()
    scene = scene_of(vtray.Spheres(**columns))
    vtray.render(scene, threads=1)
    kept = accelerate(scene)
    columns["radius"] *= 2
    image = vtray.render(scene, threads=1)
    assert accelerate(scene) is not kept
    np.testing.assert_array_equal(image.linear, render(scene, ALWAYS).linear)


def test_arrays_that_change_places_need_a_new_build() -> None:
    one, two = arrays(), {name: column[::-1].copy() for name, column in arrays().items()}
    scene = scene_of(vtray.Spheres(**one), vtray.Spheres(**two))
    kept = accelerate(scene)
    for name in one:
        one[name][...], two[name][...] = two[name].copy(), one[name].copy()
    assert accelerate(scene) is not kept


def test_one_number_for_all_is_part_of_the_object() -> None:
    columns = arrays()
    scene = scene_of(vtray.Spheres(columns["center"], 0.5, (1, 2, 3), 1))
    kept = accelerate(scene)
    assert accelerate(scene) is kept
    scene.objects[0] = vtray.Spheres(columns["center"], 0.25, (1, 2, 3), 1)
    assert accelerate(scene) is not kept


def test_equal_scenes_do_not_share() -> None:
    one, two = (scene_of(vtray.Spheres(**arrays())) for _ in range(2))
    assert one == two
    assert accelerate(one) is not accelerate(two)


@once
@pytest.mark.parametrize(
    "duplicate", [copy.copy, copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene))]
)
def test_scenes_are_copied_with_and_without_what_is_kept(duplicate: Callable) -> None:
    columns = arrays()
    scene = scene_of(WALL, vtray.Spheres(**columns), BALL)
    fresh = duplicate(scene)
    image = vtray.render(scene, threads=1)
    used = duplicate(scene)
    assert fresh == used == scene
    for other in (fresh, used):
        np.testing.assert_array_equal(vtray.render(other, threads=1).linear, image.linear)
        other.objects = other.objects[1:]
    assert len(scene.objects) == 3
    columns["radius"] *= 0.5
    changed = vtray.render(scene, threads=1)
    assert not np.array_equal(changed.linear, image.linear)
    np.testing.assert_array_equal(changed.linear, render(scene, ALWAYS).linear)
    np.testing.assert_array_equal(vtray.render(used, threads=1).linear, render(used, ALWAYS).linear)


def test_numbers_lead_back_to_the_objects() -> None:
    several = [vtray.Spheres(**arrays(n)) for n in (0, 3, 0, 2)]
    scene = scene_of(several[0], BALL, WALL, several[1], several[2], WALL, BALL, several[3])
    found = [locate(number_objects(scene.objects), number) for number in range(7)]
    assert found == [(1, 0), (3, 0), (3, 1), (3, 2), (6, 0), (7, 0), (7, 1)]


@compiled_only
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(
    ("kind", "count"), [("uniform", 10**5), ("uniform", 10**6), ("one_point", 10**5)]
)
def test_memory_for_each_sphere(kind: str, count: int, dtype: type) -> None:
    given = cloud(kind, count, 1)
    columns = [given.center, given.radius, given.color, given.lambert]
    spheres = vtray.Spheres(*(c if c.dtype == np.uint8 else c.astype(dtype) for c in columns))
    assert accelerate(scene_of(spheres), threads=2).memory <= 100 * count


def test_more_spheres_than_can_be_numbered(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(vtray.Spheres(**arrays()), BALL)
    monkeypatch.setattr(acceleration, "MAX_SPHERES", 101)
    vtray.render(scene, threads=1)
    monkeypatch.setattr(acceleration, "MAX_SPHERES", 100)
    with pytest.raises(vtray.RenderError, match="^objects: expected at most 100 spheres, got 101$"):
        vtray.render(scene_of(*scene.objects))


def test_progress_of_building(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bvh_build, "SMALL", 16)
    told: list[tuple[int, int]] = []
    accelerate(
        scene_of(cloud("uniform", 500, 1)), 2, lambda done, total: told.append((done, total))
    )
    done, total = told[-1]
    assert done == total > 1
    assert told == sorted(told)


@once
def test_an_error_while_building_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(cloud("uniform", 500, 1))
    threads = threading.active_count()

    def fail(done: int, total: int) -> None:
        raise ValueError("no more")

    with pytest.raises(ValueError, match="no more"):
        accelerate(scene, 2, fail)
    assert threading.active_count() == threads
    assert "_acceleration" not in scene.__dict__
    np.testing.assert_array_equal(
        vtray.render(scene, threads=1).linear, render(scene, 10**9).linear
    )


@pytest.mark.skipif(not JIT, reason="coverage, measured then, may wait forever for its own lock")
@pytest.mark.parametrize("step", ["find_extent", "set_keys", "split_ranges"])
def test_interrupt_while_building(step: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bvh_build, "SMALL", 16)
    monkeypatch.setattr(bvh_build, "CHUNK", 20)
    whole = getattr(bvh_build, step)
    calls: list[int] = []
    main = threading.get_ident()

    def interrupted(*arguments: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            signal.pthread_kill(main, signal.SIGINT)
        return whole(*arguments)

    monkeypatch.setattr(bvh_build, step, interrupted)
    scene = scene_of(cloud("uniform", 500, 1))
    threads = threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        accelerate(scene, 1)
    assert threading.active_count() == threads
    monkeypatch.setattr(bvh_build, step, whole)
    image = renderer.render(scene, threads=1)
    np.testing.assert_array_equal(image.linear, render(scene, 10**9).linear)
