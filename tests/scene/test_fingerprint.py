"""The hash of a scene: the same for the same content, another for any other."""

import json
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import scenes

import vtray
from conftest import compiled_only, once
from vtray.scene.fingerprint import PIECE, hash_arrays, scene_hash

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


@once
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
    assert {len(text) for text in hashes} == {32}


def test_the_same_numbers_of_something_else_are_another_scene() -> None:
    share = np.linspace(0.1, 0.9, 50)
    names: list[tuple[str, ...]] = [("opacity",), ("roughness",), ("metalness",), ()]
    names += [("opacity", "roughness"), ("roughness", "metalness"), ("opacity", "metalness")]
    found = {scene_hash(many(material="plastic", **dict.fromkeys(some, share))) for some in names}
    assert len(found) == len(names)


@given(count=st.integers(0, 300), place=st.integers(0, 299), bit=st.integers(0, 7))
def test_any_bit_of_an_array_counts(count: int, place: int, bit: int) -> None:
    array = np.random.default_rng(count).integers(0, 256, count).astype(np.uint8)
    before = hash_arrays([array], 1)
    if place < count:
        array[place] ^= 1 << bit
    assert (hash_arrays([array], 1) != before) == (place < count)


def test_threads_and_pieces_make_no_difference() -> None:
    array = np.random.default_rng(1).integers(0, 256, 5 * PIECE + 3).astype(np.uint8)
    assert hash_arrays([array], 1) == hash_arrays([array], 3)
    scene = many()
    assert scene_hash(scene, 1) == scene_hash(scene, 3)


def test_order_in_memory_makes_no_difference() -> None:
    array = np.random.default_rng(1).normal(size=(PIECE // 8, 3))
    for same in (np.asfortranarray(array), np.repeat(array, 2, axis=0)[::2]):
        assert hash_arrays([same], 2) == hash_arrays([array], 2)
    # The same bytes of another shape or kind are something else, and so is another division.
    others = [array.reshape(3, -1), array.view("<i8"), array.ravel()]
    assert len({hash_arrays([other], 2) for other in [array, *others]}) == 4
    assert hash_arrays([array[:9], array[9:]], 2) != hash_arrays([array[:8], array[8:]], 2)


def test_numbers_that_keep_sum_and_checksum_are_told() -> None:
    # CRC-32 is linear: of 33 changes that each keep the sum, some together keep the checksum too.
    words = np.zeros(2 * 33, np.uint64)
    before, plain = hash_arrays([words], 1), zlib.crc32(words.data)
    changes: dict[int, tuple[int, int]] = {}  # by the highest bit: the checksum's change, by which
    for k in range(33):
        words[:] = 0
        words[2 * k : 2 * k + 2] = 1, 2**64 - 1
        change, chosen = zlib.crc32(words.data) ^ plain, 1 << k
        while change and change.bit_length() in changes:
            other, others = changes[change.bit_length()]
            change, chosen = change ^ other, chosen ^ others
        if not change:
            break
        changes[change.bit_length()] = change, chosen
    for k in range(33):
        words[2 * k : 2 * k + 2] = (1, 2**64 - 1) if chosen >> k & 1 else (0, 0)
    assert words.any()
    assert (int(words.sum()), zlib.crc32(words.data)) == (0, plain)
    assert hash_arrays([words], 1) != before


@once
def test_another_process_finds_the_same() -> None:
    code = (
        "import sys; sys.path[:] = sys.argv[1:]\n"
        "from test_fingerprint import many\n"
        "from vtray.scene.fingerprint import scene_hash\n"
        "print(scene_hash(many()))"
    )
    command = [sys.executable, "-c", code, *sys.path]
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
