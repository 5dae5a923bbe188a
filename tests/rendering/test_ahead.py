"""What traces a scene is compiled before what builds its hierarchy, for the same types."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.compiler.native_call import Types, unpack
from vtray.rendering import ahead, hierarchy, passes
from vtray.rendering.hierarchy import accelerate

MANY = 300
PLACES = np.random.default_rng(5).normal(size=(MANY, 3))

Ahead = tuple[list[Types], list[Types]]


class EnoughError(Exception):
    """Ends a render before anything is traced."""


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> Ahead:
    """Return the types for which the tracer is compiled ahead, and those that are needed first."""
    early: list[Types] = []
    late: list[Types] = []

    def need(
        _engine: Any, scene: Any, sampling: Any, _tiles: Any, film: Any, *_others: Any
    ) -> None:
        late.append(unpack([film, scene, sampling])[0])
        raise EnoughError

    monkeypatch.setattr(ahead, "was_compiled", lambda _: False)
    monkeypatch.setattr(
        passes, "begin_compiling", lambda *arguments: early.append(unpack(arguments)[0])
    )
    monkeypatch.setattr(passes.Threads, "trace", need)
    return early, late


def render(add: Callable[[vtray.Scene], None], **settings: Any) -> vtray.Scene:
    """Begin to render a scene."""
    scene = vtray.Scene()
    add(scene)
    with pytest.raises(EnoughError):
        vtray.render(scene, size=(8, 6), **settings)
    return scene


def balls(scene: vtray.Scene, **columns: Any) -> None:
    scene.add_spheres(PLACES, 0.1, **columns)


def two_handfuls(scene: vtray.Scene) -> None:
    scene.add_spheres(PLACES[:6], 0.1)
    scene.add_spheres(PLACES[6:12], 0.1)


def bonds(scene: vtray.Scene) -> None:
    balls(scene)
    scene.add_cylinders(PLACES[:-1], PLACES[1:], 0.02)
    scene.add_plane((0, 0, -4), normal=(0, 0, 1))


def arrows(scene: vtray.Scene) -> None:
    scene.add_cones(PLACES, PLACES + 0.1, 0.05, 0.0)
    scene.lights = [vtray.Light((3, -3, 3), 1)]


def many_materials(scene: vtray.Scene) -> None:
    index = np.arange(MANY) % 2
    balls(scene, material=("plastic", "glass"), material_index=index.astype(np.uint8))


@pytest.mark.parametrize(
    ("add", "settings"),
    [
        (balls, {}),
        (two_handfuls, {}),
        (bonds, {}),
        (arrows, {}),
        (arrows, {"samples": 4, "fog": True}),
        (balls, {"outline": True}),
        (many_materials, {"integrator": "path", "samples": 1}),
        (many_materials, {"integrator": "whitted"}),
    ],
)
def test_it_is_what_is_needed(add: Any, settings: dict[str, Any], begun: Ahead) -> None:
    scene = render(add, **settings)
    assert accelerate(scene).nodes > 0
    early, late = begun
    assert len(early) == 1
    assert early == late


def copies(scene: vtray.Scene) -> None:
    scene.add_copies(vtray.Sphere((0, 0, 0), 0.1), PLACES)


def faded(scene: vtray.Scene) -> None:
    balls(scene, opacity=0.5)


@pytest.mark.parametrize(
    ("add", "settings"), [(copies, {}), (faded, {}), (balls, {"clip": (0, -1, 0, 1)})]
)
def test_not_where_a_hierarchy_would_be_built_for_it(
    add: Any, settings: dict[str, Any], begun: Ahead
) -> None:
    render(add, **settings)
    assert begun[0] == []


def test_not_where_none_is_built(begun: Ahead) -> None:
    render(lambda scene: scene.add_spheres(PLACES[:5], 0.1))
    assert begun[0] == []


def test_not_where_that_takes_long(begun: Ahead, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hierarchy, "SOON", MANY - 1)
    render(balls)
    assert begun[0] == []


def test_not_once_a_hierarchy_was_built(begun: Ahead, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ahead, "was_compiled", lambda _: True)
    render(balls)
    assert begun[0] == []
