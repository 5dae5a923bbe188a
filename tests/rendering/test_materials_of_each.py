"""Many objects of which each is made of one of several materials."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT, once
from vtray.scene.fingerprint import scene_hash

PLACES = np.array([(-1.5, 0, 0), (0, 0, 0), (1.5, 0, 0), (0, 1.1, 0.5), (-0.8, -1, 0)], float)
KINDS = ("glass", vtray.Metal("gold"), "lambert", "glass")
INDEX = (0, 1, 2, 3, 1)
SIZE = (14, 10) if JIT else (7, 5)


def lit(*objects: Any) -> vtray.Scene:
    """Return a scene of some objects under a sky."""
    scene = vtray.Scene()
    scene.objects = list(objects)
    scene.lights = [
        vtray.Sky(gradient=vtray.Gradient((255, 240, 220), (160, 180, 200), (40, 50, 60))),
        vtray.Light((2, 5, -6), 0.5),
    ]
    scene.camera = vtray.Camera.look_at((0, 0.5, -7), target=(0, 0, 0), size=SIZE)
    return scene


def spheres(**changed: Any) -> vtray.Spheres:
    return vtray.Spheres(PLACES, 0.6, **{"material": KINDS, "material_index": INDEX, **changed})


def one_by_one(item: Any) -> list[Any]:
    """Return what arrays hold as single objects."""
    single = {"spheres": vtray.Sphere, "cylinders": vtray.Cylinder, "cones": vtray.Cone}
    make = single[type(item).__name__.lower()]
    names = [name for name in ("center", "start", "end") if hasattr(item, name)]
    radii = [name for name in ("radius", "radius_end") if hasattr(item, name)]
    return [
        make(
            **{name: getattr(item, name)[k] for name in names},
            **{name: getattr(item, name) for name in radii},
            color=item.color,
            material=KINDS[INDEX[k]],
        )
        for k in range(len(item))
    ]


def light(scene: vtray.Scene) -> bytes:
    return vtray.render(scene, integrator="whitted", depth=3, threads=1).linear.tobytes()


MANY = [
    spheres(),
    vtray.Cylinders(
        PLACES, np.add(PLACES, (0.2, 0.7, 0.1)), 0.4, material=KINDS, material_index=np.array(INDEX)
    ),
    vtray.Cones(
        PLACES, np.add(PLACES, (0.2, 0.9, 0.1)), 0.5, 0.1, material=KINDS, material_index=INDEX
    ),
]


@once
@pytest.mark.parametrize("item", MANY)
def test_are_as_single_objects(item: Any) -> None:
    mirror = vtray.Sphere((0, -1.6, 1), 0.7, material="mirror")
    assert light(lit(item, mirror)) == light(lit(*one_by_one(item), mirror))


def test_copies_are_made_of_the_same() -> None:
    at = [(0, 0, 0), (0.3, 1.5, 2)]
    moved = [spheres().replace(center=PLACES + move) for move in at]
    assert light(lit(vtray.Copies([spheres()], at=at))) == light(lit(*moved))


def test_one_of_several_may_be_all_there_is() -> None:
    alone = spheres(material_index=(1,) * 5)
    assert light(lit(alone)) == light(lit(spheres(material=KINDS[1], material_index=None)))


ROUGH = (0.0, 0.5, 1.0, 0.2, 0.9)
METAL = (0.0, 0.5, 1.0, 1.0, 0.2)
PLAIN = (
    vtray.Plastic(1.7),
    vtray.Blend(vtray.Plastic(1.7, 0.5), vtray.Metal(roughness=0.5), 0.5),
    vtray.Metal(roughness=1),
    vtray.Metal(roughness=0.2),
    vtray.Blend(vtray.Plastic(1.7, 0.9), vtray.Metal(roughness=0.9), 0.2),
)


@once
def test_each_may_be_rough_and_metal_in_its_own_way() -> None:
    item = vtray.Spheres(
        PLACES, 0.6, material=vtray.Plastic(1.7), roughness=ROUGH, metalness=np.array(METAL)
    )
    single = [
        vtray.Sphere(place, 0.6, material=material)
        for place, material in zip(PLACES, PLAIN, strict=True)
    ]
    together, apart = (
        vtray.render(lit(*objects), integrator="path", samples=2).linear.tobytes()
        for objects in ([item], single)
    )
    assert together == apart


@once
@pytest.mark.parametrize("kind", [vtray.Cylinders, vtray.Cones])
def test_roughness_is_that_of_the_materials_that_have_one(kind: Any) -> None:
    ends = PLACES, np.add(PLACES, (0.2, 0.7, 0.1)), 0.4
    kinds = vtray.Glass(roughness=0.3), vtray.Metal("gold"), "lambert", vtray.Plastic(1.4, 0.1)
    rough = [vtray.Glass(roughness=0.6), vtray.Metal("gold", 0.6), "lambert"]
    index = (0, 1, 2, 3, 1)
    item = kind(*ends, material=kinds, material_index=index, roughness=0.6)
    other = kind(*ends, material=(*rough, vtray.Plastic(1.4, 0.6)), material_index=index)
    one, two = (vtray.render(lit(x), integrator="path", samples=2).linear for x in (item, other))
    assert one.tobytes() == two.tobytes()
    assert item != other
    problems: list[str] = []
    vtray.render(lit(item), integrator="whitted", warn=problems.append)
    words = "material: glass and metal and plastic are shown as smooth by the integrator whitted"
    assert any(problem.startswith(words) for problem in problems)


@once
def test_thin_glass_stays_smooth() -> None:
    thin, kinds = vtray.Glass(thin=True), (0, 1, 0, 1, 0)
    item = spheres(material=(thin, "mirror"), material_index=kinds)
    with pytest.raises(vtray.SceneError, match=r"Spheres.roughness: given for no material"):
        item.replace(roughness=0.5)
    scenes = [
        lit(spheres(material=(thin, plastic), material_index=kinds, roughness=roughness))
        for plastic, roughness in ((vtray.Plastic(), 0.5), (vtray.Plastic(roughness=0.5), None))
    ]
    problems: list[str] = []
    one, other = (
        vtray.render(scene, integrator="whitted", warn=problems.append).linear for scene in scenes
    )
    assert one.tobytes() == other.tobytes()
    assert [problem.partition(" is shown")[0] for problem in problems] == 2 * ["material: plastic"]


def test_roughness_is_said_in_files(tmp_path: Path) -> None:
    item = spheres(material="plastic", material_index=None, roughness=ROUGH, metalness=0.25)
    scene = lit(item)
    scene.save(tmp_path / "scene.json")
    for same in (vtray.load(tmp_path / "scene.json"), vtray.load_dict(scene.to_dict())):
        assert same == scene
    assert lit(item.replace(roughness=None)) != scene
    assert scene_hash(lit(item.replace(metalness=None))) != scene_hash(scene)


@once
def test_files_and_copies_keep_them(tmp_path: Path) -> None:
    scene = lit(spheres(), MANY[2])
    scene.save(tmp_path / "scene.json")
    for same in (
        vtray.load(tmp_path / "scene.json"),
        vtray.load_dict(scene.to_dict()),
        pickle.loads(pickle.dumps(scene)),
    ):
        assert same == scene
        assert light(same) == light(scene)


def test_other_materials_make_another_scene() -> None:
    scenes = [
        lit(item)
        for item in (
            spheres(),
            spheres(material_index=INDEX[::-1]),
            spheres(material=KINDS[::-1]),
            spheres(material=KINDS[:1], material_index=None),
        )
    ]
    assert all(one != other for one in scenes for other in scenes if one is not other)
    assert len({scene_hash(scene) for scene in scenes}) == len(scenes)


def test_what_shines_is_light() -> None:
    item = spheres(material=("lambert", vtray.Emissive(2)), material_index=(0, 1, 0, 0, 0))
    scene = lit(item)
    scene.lights = []
    scene.camera = scene.camera.replace(size=(14, 10))
    problems: list[str] = []
    image = vtray.render(scene, integrator="whitted", warn=problems.append)
    assert problems == []
    assert image.linear.max() > 0
    vtray.render(scene, warn=problems.append)
    assert "material: emissive is shown as matt" in problems[-1]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"material_index": None}, "material_index: missing; expected .* as there are 4"),
        ({"material_index": (0, 4, 0, 0, 9)}, r"material_index\[1\]: .* from 0 to 3, .*, got 4"),
        ({"material": "glass"}, r"material_index\[1\]: .* one material, got 1"),
        ({"material": ()}, "material: expected Lambert, .*, got "),
        ({"material": ("glass", "wood")}, r"material\[1\]: expected Lambert, .*, got 'wood'"),
        ({"material_index": (0, 0.5, 1, 1, 1)}, r"material_index\[1\]: .*, got 0.5"),
        ({"material_index": (0, 1, 2, 3, np.nan)}, r"material_index\[4\]: .*, got nan"),
        ({"material_index": (0, 1, 2, 3, -1)}, r"material_index\[4\]: .* 0 to 255, got -1"),
        ({"material_index": (0, 1)}, r"material_index: .* of shape \(5,\).*, got shape \(2,\)"),
        ({"roughness": (0, 1, 2, 0, 0)}, r"roughness\[2\]: expected a number from 0 to 1, got 2"),
        ({"roughness": (0, 1)}, r"roughness: expected .*, got shape \(2,\)"),
        ({"metalness": 0.5}, 'metalness: given for no material .*; expected "plastic"'),
        ({"material_index": 1}, r"material_index: expected an array .*, got shape \(\)"),
    ],
)
def test_wrong_numbers(given: dict[str, Any], message: str) -> None:
    with pytest.raises(vtray.SceneError, match=rf"Spheres\.{message}"):
        spheres(**given)
    scene = vtray.Scene()
    arguments = {"material": KINDS, "material_index": INDEX, **given}
    with pytest.raises(vtray.SceneError, match=f"add_spheres: {message}"):
        scene.add_spheres(PLACES, 0.6, **arguments)


def test_numbers_that_have_changed_are_checked_again() -> None:
    index = np.array(INDEX, np.uint8)
    scene = lit(spheres(material_index=index))
    index[2] = 4
    with pytest.raises(vtray.SceneError, match=r"objects\[0\].material_index\[2\]: .*, got 4"):
        light(scene)


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ([], r"material: expected an array of such materials, got \[\]"),
        (["glass"], r"data: .*: material_index\[1\]: .* as there is one material, got 1"),
        (["glass", "wood"], r'material\[1\]: expected "lambert", .*, got "wood"'),
        (["glass", {"type": "glass", "ior": 0}], r"material\[1\].ior: expected a number from 0.1"),
        (["glass", 3], r'material\[1\]: expected "lambert", .*, got 3'),
        (3, 'material: expected "lambert", .* or an array of such materials, got 3'),
    ],
)
def test_wrong_files(tmp_path: Path, material: Any, message: str) -> None:
    file = tmp_path / "scene.json"
    lit(spheres()).save(file)
    written = json.loads(file.read_text())
    written["objects"][0]["material"] = material
    file.write_text(json.dumps(written))
    with pytest.raises(vtray.SceneError, match=rf"objects\[0\]\.{message}"):
        vtray.load(file)
