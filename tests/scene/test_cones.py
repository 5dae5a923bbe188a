"""Cones, single ones and as arrays: made in code, in files, and as arrows. See test_cylinders."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from scene_text import ABSENT, changed, message_of, read
from test_cylinders import BLUE, RED, columns_of_cones
from test_spheres import CAMERA

import vtray
from vtray import Camera, Cone, Cones, Light, Scene, SceneError
from vtray.scene.files.scene_file import load
from vtray.scene.files.schema import scene_schema
from vtray.scene.fingerprint import scene_hash
from vtray.scene.placing.bounds import Balls

VALIDATOR = jsonschema.Draft202012Validator(scene_schema())
ONE = {
    "type": "cone",
    "start": {"x": 0, "y": 0, "z": 5},
    "end": {"x": 1, "y": 2, "z": 3},
    "radius": 0.5,
    "radius_end": 0.25,
    "color": {"r": 255, "g": 0, "b": 0},
    "lambert": 1,
}


def one(**keys: object) -> str:
    """Return a scene file whose second object is a cone."""
    entry = {name: value for name, value in {**ONE, **keys}.items() if value is not ABSENT}
    return json.dumps(changed({"objects[1]": entry}))


def test_one_cone() -> None:
    expected = Cone((0, 0, 5), (1, 2, 3), 0.5, 0.25, RED, 1)
    assert read(one()).objects[1] == expected
    assert VALIDATOR.is_valid(json.loads(one()))
    scene = Scene()
    assert scene.add_cone((0, 0, 5), (1, 2, 3), 0.5, 0.25, "red") == expected
    pointed = scene.add_cone((0, 0, 5), (1, 2, 3), 0.5)
    assert pointed == Cone((0, 0, 5), (1, 2, 3), 0.5)
    assert pointed.radius_end == 0
    assert scene.objects == [expected, pointed]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"radius_end": ABSENT}, "radius_end: missing; expected a number ≥ 0"),
        ({"radius_end": -1}, "radius_end: expected a number ≥ 0, got -1"),
        ({"end": [0, 0, 1]}, "end: expected an object with the keys x, y and z, got [0, 0, 1]"),
    ],
)
def test_bad_cone(keys: dict[str, Any], message: str) -> None:
    assert message_of(one(**keys)) == f"objects[1].{message}"
    assert not VALIDATOR.is_valid(json.loads(one(**keys)))


def test_files_of_arrays(tmp_path: Path) -> None:
    many = Cones(**columns_of_cones(start=columns_of_cones()["start"].astype("f4")))
    plain = Cones(**columns_of_cones(radius=0.1, radius_end=0, color=RED, color_end=None))
    single = Cone((0, 0, 1), (1, 0, 1), 1, 0.5, BLUE, 0.5)
    copies = vtray.Copies([single, plain], [(0, 0, 0), (1, 2, 3)])
    saved = Scene(CAMERA, [Light((1, 2, 3), 1)], [many, single, plain, copies])
    saved.save(tmp_path / "room.json")
    for found in (load(tmp_path / "room.json"), vtray.load_dict(saved.to_dict())):
        assert found == saved
        assert scene_hash(found) == scene_hash(saved)
    document = json.loads((tmp_path / "room.json").read_text())
    assert VALIDATOR.is_valid(document)
    entry = document["objects"][2]
    assert {"type", "data", "radius", "radius_end", "color"} == set(entry)


def test_add_cones() -> None:
    scene = Scene()
    cones = scene.add_cones([(0, 0, 0)] * 2, [(0, 0, 1)] * 2, 0.3, color=[1, 2], cmap="viridis")
    assert cones.radius_end == 0.0
    assert cones.color.shape == (2, 3)
    assert cones.color_scale is not None
    with pytest.raises(SceneError, match=r"^add_cones: radius_end\[1\]: expected a number ≥ 0"):
        scene.add_cones([(0, 0, 0)] * 2, [(0, 0, 1)] * 2, 0.3, [0, -1])


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_fit_shows_caps_and_tips(projection: str) -> None:
    cones = Cones([(0, 0, 0), (3, 1, 2)], [(0, 2, 0), (3, 1, 5)], [1, 0.2], [0, 1.5])
    camera = Camera.fit(cones, (1, 2, -0.5), projection=projection, size=(80, 60))
    turn = np.linspace(0, 2 * np.pi, 2000)[:, None]
    rims = []
    for discs in (Balls(*hull) for hull in cones.hull()):
        assert discs.toward is not None
        radii = np.broadcast_to(discs.radius, 2)
        for center, toward, radius in zip(discs.center, discs.toward, radii, strict=True):
            side = np.linalg.svd((toward - center)[None])[2]
            rims.append(center + radius * (np.cos(turn) * side[1] + np.sin(turn) * side[2]))
    places = camera.project(np.concatenate(rims))
    low, high = places.min(axis=0), places.max(axis=0)
    first, last = 0.05 * 79, 0.95 * 79
    is_wide = high[0] - low[0] > 0.899 * 79
    if not is_wide:
        first, last = 0.05 * 59, 0.95 * 59
    assert [low[1 - is_wide], high[1 - is_wide]] == pytest.approx([first, last], abs=0.01)


# ---- arrows


def test_arrows_have_shafts_and_heads() -> None:
    scene = Scene()
    vectors = [(0, 0, 10), (0, 3, 4), (0, 0, 0), (1e-3, 0, 0)]
    shafts, heads = scene.add_arrows(np.zeros((4, 3)), vectors, scale=2, radius=0.1, color="red")
    assert scene.objects == [shafts, heads]
    np.testing.assert_allclose(heads.end, np.multiply(vectors, 2), rtol=1e-15)
    np.testing.assert_allclose(heads.start[0], (0, 0, 20 - 0.6))
    np.testing.assert_allclose(shafts.end[0], (0, 0, 20 - 0.3))
    np.testing.assert_allclose(shafts.radius, [0.1, 0.1, 0, 1e-3 / 6])
    np.testing.assert_allclose(heads.radius, 2.5 * shafts.radius)
    np.testing.assert_allclose(heads.start[3], (1e-3, 0, 0))
    assert heads.radius_end == 0.0
    assert (shafts.color == (255, 0, 0)).all()


@pytest.mark.parametrize(("pivot", "tail"), [("tail", 1), ("middle", 0), ("tip", -1)])
def test_pivots(pivot: Any, tail: float) -> None:
    shafts, heads = Scene().add_arrows([(0, 0, 1)], [(0, 2, 0)], pivot=pivot)
    assert shafts.start.tolist() == [[0, tail - 1, 1]]
    assert heads.end.tolist() == [[0, tail + 1, 1]]


def test_colors_of_arrows() -> None:
    vectors = np.array([(0, 0, 1), (0, 0, 2), (0, 0, 3)], "f4")
    for color in (None, [1.0, 2.0, 3.0]):
        shafts, heads = Scene().add_arrows(vectors, vectors, color=color, cmap="viridis")
        for part in (shafts, heads):
            assert np.array_equal(part.color, shafts.color)
            assert part.color_scale is not None
            assert (part.color_scale.low, part.color_scale.high) == (1, 3)
    assert Scene().add_arrows(vectors, vectors).shafts.color.tolist() == [255, 255, 255]


def test_thickness_by_default_is_that_of_most() -> None:
    shafts, _ = Scene().add_arrows(np.zeros((4, 3)), [(0, 0, 9), (8, 0, 0), (0, 0, 0), (0, 7, 0)])
    np.testing.assert_allclose(shafts.radius, [0.4, 0.4, 0, 0.4])
    none = Scene().add_arrows(np.zeros((0, 3)), np.zeros((0, 3)))
    assert (len(none.shafts), len(none.heads)) == (0, 0)
    assert len(Scene().add_arrows([(0, 0, 0)], [(0, 0, 0)]).heads) == 1


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"vectors": [(0, 0, np.inf)]}, r"vectors\[0, 2\]: expected a finite number, got inf"),
        ({"vectors": [(0, 0, 1)] * 2}, "vectors: expected an array of numbers of shape"),
        ({"scale": -1}, "scale: expected a number > 0, got -1"),
        ({"radius": -1}, "radius: expected a number ≥ 0, got -1"),
        ({"pivot": "head"}, 'pivot: expected one of "tail", "middle", "tip", got \'head\''),
        ({"pivot": ["tip"]}, 'pivot: expected one of "tail", "middle", "tip", got '),
        ({"color": [1, 2]}, "color: expected"),
    ],
)
def test_bad_arrows(keys: dict[str, Any], message: str) -> None:
    scene = Scene()
    with pytest.raises(SceneError, match=f"^add_arrows: {message}"):
        scene.add_arrows(**{"positions": [(0, 0, 0)], "vectors": [(0, 0, 1)], **keys})
    assert scene.objects == []
