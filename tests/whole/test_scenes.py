"""The example scenes: up to date, free of warnings, and shown in the documentation."""

import importlib.util
from pathlib import Path
from types import ModuleType

import msgspec
import pytest
from PIL import Image

import vtray
from conftest import compiled_only, once

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
NAMES = sorted(path.stem for path in SCENES.glob("*.json"))
SMALL_WIDTH = 64


@pytest.fixture(scope="module")
def make_scenes() -> ModuleType:
    """Import the script that makes the scenes."""
    spec = importlib.util.spec_from_file_location("make_scenes", SCENES / "make_scenes.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def shrink(scene: vtray.Scene) -> vtray.Scene:
    """Return the same view with fewer and larger pixels."""
    width, height = scene.camera.size
    factor = width / SMALL_WIDTH
    pixel_width, pixel_height = scene.camera.resolution
    camera = msgspec.structs.replace(
        scene.camera,
        size=(SMALL_WIDTH, round(height / factor)),
        resolution=(pixel_width * factor, pixel_height * factor),
    )
    return vtray.Scene(camera, scene.lights, scene.objects)


def test_each_scene_has_a_maker_and_each_maker_a_scene(make_scenes: ModuleType) -> None:
    assert sorted(maker.__name__ for maker in make_scenes.MAKERS) == NAMES


@once
@pytest.mark.parametrize("name", NAMES)
def test_scene_file_is_current(make_scenes: ModuleType, name: str) -> None:
    written = (SCENES / f"{name}.json").read_text(encoding="utf-8")
    # Compared as a whole: a difference of 150 kB would take pytest minutes to explain.
    current = written == make_scenes.to_text(getattr(make_scenes, name)())
    assert current, "run python scenes/make_scenes.py --render"


@compiled_only
@pytest.mark.parametrize("name", NAMES)
def test_scene_renders_without_warnings(name: str) -> None:
    warnings: list[str] = []
    scene = vtray.load(SCENES / f"{name}.json", warn=warnings.append)
    image = vtray.render(shrink(scene), threads=1)
    assert not warnings
    assert image.pixels.max() == 255
    # Most of the picture shows something.
    assert (image.pixels.max(axis=2) > 0).mean() > 0.9


@pytest.mark.parametrize("name", NAMES)
def test_picture_is_in_the_documentation(name: str) -> None:
    scene = vtray.load(SCENES / f"{name}.json")
    with Image.open(ROOT / "docs" / "images" / f"{name}.png") as picture:
        assert picture.size == scene.camera.size
