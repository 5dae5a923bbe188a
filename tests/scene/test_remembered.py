"""What arrays remember of where they come from: it goes into all that is made of them."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray
from vtray.scene.arrays import check_spares_data
from vtray.scene.edits import recolored
from vtray.scene.particles.made_of import made_of

WATER = vtray.Particles(
    [(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)],
    {"element": ["O", "H", "H"], "charge": [-0.8, 0.4, 0.4]},
)

Way = Callable[[Any], Any]

WAYS: dict[str, Way] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda item: pickle.loads(pickle.dumps(item)),
    "replace": lambda item: item.replace(opacity=0.5),
}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_particles_and_values(way: Way) -> None:
    drawn = vtray.Scene().add_particles(WATER, "ball-and-stick", bonds=True, color="charge")
    for item, kind in ((drawn.spheres, "particle"), (drawn.bonds, "bond")):
        made = way(item)
        source = made_of(made)
        assert source is not None
        assert source.kind == kind
        np.testing.assert_array_equal(source.particles.positions, WATER.positions)
    scale = way(drawn.spheres).color_scale
    assert (scale.low, scale.high) == (-0.8, 0.4)


def test_what_holds_no_more_is_forgotten() -> None:
    spheres = vtray.Scene().add_particles(WATER, color="charge").spheres
    assert spheres.replace(color=(1, 2, 3)).color_scale is None
    assert made_of(spheres.replace(color=(1, 2, 3))) is not None
    # Rows may be in another order, which nobody says.
    turned = spheres.replace(center=spheres.center[::-1])
    assert made_of(turned) is None
    assert turned.color_scale is not None
    fewer = spheres.replace(center=spheres.center[:2], radius=1.0, color=(1, 2, 3))
    assert made_of(fewer) is None


def test_recolored_particles_are_still_particles() -> None:
    scene = vtray.Scene()
    scene.add_particles(WATER, color="charge")
    (changed,) = recolored(scene, 0, "red").objects
    assert made_of(changed) is not None
    assert changed.color_scale is None
    (changed,) = recolored(scene, 0, [1.0, 2.0, 3.0], cmap="magma").objects
    assert changed.color_scale.high == 3.0


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_files_are_spared(way: Way, tmp_path: Path) -> None:
    scene = vtray.Scene()
    scene.add_spheres(WATER.positions, 0.3)
    scene.add_copies([vtray.Sphere((0, 0, 0), 1)], WATER.positions)
    scene.camera = vtray.Camera.fit(scene)
    scene.save(tmp_path / "water.json")
    for item in vtray.load(tmp_path / "water.json").objects:
        if isinstance(item, vtray.Copies) and way is WAYS["replace"]:
            item = item.replace(objects=[vtray.Sphere((0, 0, 0), 2)])  # noqa: PLW2901
        else:
            item = way(item)  # noqa: PLW2901
        with pytest.raises(vtray.OutputError, match="holds arrays of the scene itself"):
            check_spares_data(item.source, [item])


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, WAYS["pickle"]])
def test_pictures_are_spared(way: Way, tmp_path: Path) -> None:
    path = tmp_path / "sky.npz"
    np.savez(path, image=np.ones((2, 4, 3), np.float32))
    sky = way(vtray.Sky(image=path))
    assert [source.name for source in sky.image.sources()] == ["sky.npz"]
    path = tmp_path / "wood.png"
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(path)
    pattern = way(vtray.ImagePattern(path))
    assert [source.name for source in pattern.image.sources()] == ["wood.png"]
