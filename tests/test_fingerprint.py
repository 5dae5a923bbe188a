"""The hash of a scene: the same for the same content, another for any other."""

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vtray
from conftest import compiled_only
from strategies import scenes
from vtray.fingerprint import PIECE, add_up, scene_hash

CAMERA = vtray.Camera((0, 0, 0), (0, 0, 1), 1, (4, 3), (0.1, 0.1))


def many(count: int = 50, **arrays: object) -> vtray.Scene:
    """Return a scene with spheres as arrays, and single objects."""
    random = np.random.default_rng(3)
    values = {
        "center": random.normal(size=(count, 3)),
        "radius": random.uniform(0.1, 1, count),
        "color": random.integers(0, 256, (count, 3)).astype(np.uint8),
        "lambert": random.uniform(0, 1, count),
        **arrays,
    }
    objects = [
        vtray.Plane((0, 0, 9), (0, 0, 1), (1, 2, 3), 1),
        vtray.Spheres(**values),
        vtray.Sphere((0, 0, 5), 1, (9, 9, 9), 0.5),
    ]
    return vtray.Scene(CAMERA, [vtray.Light((1, 2, 3), 0.7)], objects)


@given(document=scenes())
def test_saved_and_loaded_again_it_is_the_same(
    document: dict, tmp_path_factory: pytest.TempPathFactory
) -> None:
    scene = vtray.loads(json.dumps(document))
    path = tmp_path_factory.mktemp("scene") / "scene.json"
    scene.save(path)
    assert scene_hash(vtray.load(path)) == scene_hash(scene)


@pytest.mark.parametrize(
    "arrays",
    [
        {},
        {"radius": 0.5, "lambert": 1},
        {"color": (1, 2, 3)},
        {"center": np.ones((50, 3), np.float32), "radius": np.ones(50, ">f8")},
        {"center": np.asfortranarray(np.random.default_rng(1).normal(size=(50, 3)))},
        {"center": np.zeros((0, 3)), "radius": [], "color": (0, 0, 0), "lambert": 1},
    ],
)
def test_arrays_saved_and_loaded_again_too(arrays: dict, tmp_path: Path) -> None:
    scene = many(**arrays)
    scene.save(tmp_path / "scene.json")
    assert scene_hash(vtray.load(tmp_path / "scene.json")) == scene_hash(scene)


def changed() -> list[vtray.Scene]:
    """Return scenes that all differ in something."""
    center = np.random.default_rng(3).normal(size=(50, 3))
    one_up, swapped = center.copy(), center.copy()
    one_up[49, 2] = np.nextafter(one_up[49, 2], 9)
    swapped[[0, 1]] = swapped[[1, 0]]
    base = many(center=center)
    plane, spheres, sphere = base.objects
    light = vtray.Light((1, 2, 3), np.nextafter(0.7, 1))
    wider = vtray.Camera((0, 0, 0), (0, 0, 1), 1, (5, 3), (0.1, 0.1))
    return [
        base,
        many(center=one_up),
        many(center=swapped),
        many(center=center, radius=1.0),
        many(center=center, radius=np.ones(50)),
        many(center=center * 2),
        many(center=np.zeros((50, 3)), radius=1, color=(0, 0, 0), lambert=1),
        many(center=np.zeros((100, 3), np.float32), radius=1, color=(0, 0, 0), lambert=1),
        vtray.Scene(wider, base.lights, base.objects),
        vtray.Scene(CAMERA, [light], base.objects),
        vtray.Scene(CAMERA, base.lights * 2, base.objects),
        vtray.Scene(CAMERA, base.lights, [sphere, spheres, plane]),
        vtray.Scene(CAMERA, base.lights, [plane, spheres]),
        vtray.Scene(CAMERA, base.lights, [plane, spheres, spheres]),
        vtray.Scene(CAMERA, base.lights, [plane]),
        vtray.Scene(CAMERA, [], []),
    ]


def test_any_change_is_another_scene() -> None:
    hashes = [scene_hash(scene) for scene in changed()]
    assert len(set(hashes)) == len(hashes)
    assert {len(text) for text in hashes} == {24}


@given(count=st.integers(0, 300), place=st.integers(0, 299), bit=st.integers(0, 7))
def test_any_bit_of_an_array_counts(count: int, place: int, bit: int) -> None:
    array = np.random.default_rng(count).integers(0, 256, count).astype(np.uint8)
    before = add_up([array], 1)
    if place < count:
        array[place] ^= 1 << bit
    assert (add_up([array], 1) != before) == (place < count)


def test_threads_and_pieces_make_no_difference() -> None:
    array = np.random.default_rng(1).integers(0, 256, 5 * PIECE + 3).astype(np.uint8)
    assert add_up([array], 1) == add_up([array], 3)
    assert len(add_up([array], 1)) == 6
    scene = many()
    assert scene_hash(scene, 1) == scene_hash(scene, 3)


def test_another_process_finds_the_same() -> None:
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from test_fingerprint import many\n"
        "from vtray.fingerprint import scene_hash\n"
        "print(scene_hash(many()))"
    )
    command = [sys.executable, "-c", code, str(Path(__file__).parent)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == scene_hash(many())


@compiled_only
def test_a_million_spheres_take_no_time() -> None:
    scene = many(1_000_000)
    seconds = []
    for _ in range(5):
        start = time.perf_counter()
        scene_hash(scene)
        seconds.append(time.perf_counter() - start)
    assert min(seconds) < 0.1  # 0.01 s on an idle machine
