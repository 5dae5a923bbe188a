"""Engines: whoever traces the tiles, in whatever order, the picture is the same."""

import json
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from strategies import crowd

import vtray
from conftest import JIT
from vtray.base.pool import Progress
from vtray.base.tiles import NO_TILE, Tile
from vtray.rendering import passes
from vtray.rendering.engines import threads
from vtray.rendering.engines.engine import Cast, Done, Plan, paste, trace
from vtray.transport.film import Film
from vtray.transport.integrators.direct import trace_tile
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import SceneArrays, new_memory


class Elsewhere:
    """An engine that sends tiles away, from the last to the first, and pastes what comes back."""

    def __init__(self, threads: int) -> None:
        self.threads = threads

    def trace(
        self,
        scene: SceneArrays,
        sampling: Sampling,
        tiles: Sequence[Tile],
        film: Film,
        progress: Progress | None = None,
        done: Done | None = None,
    ) -> Cast:
        wanted = tuple(
            name
            for name in set(Film._fields) - {"left", "top", "kept"}
            if getattr(film, name) is not None
        )
        casts = []
        for tile in reversed(tiles):
            part, cast = trace(scene, Plan(sampling, wanted), tile)
            paste(tile, part, sampling.marks, film)
            if done is not None:
                done(tile)
            casts.append(cast)
        return Cast(max(cast.peak for cast in casts), sum(cast.rays for cast in casts))


@pytest.mark.parametrize("samples", [1, 4])
def test_picture_is_the_same_from_elsewhere(samples: int, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = vtray.loads(json.dumps(crowd(3, spheres=30 if JIT else 4)))
    options = {"samples": samples, "tile": 20, "size": None if JIT else (9, 7)}
    expected = vtray.render(scene, **options)
    surfaces = expected.depth, expected.normals, expected.ids
    monkeypatch.setattr(passes, "Threads", Elsewhere)
    image = vtray.render(scene, **options)
    assert image.stats["rays"] == expected.stats["rays"]
    assert image.white == expected.white
    np.testing.assert_array_equal(image.linear, expected.linear)
    np.testing.assert_array_equal(image.alpha, expected.alpha)
    for found, wanted in zip((image.depth, image.normals, image.ids), surfaces, strict=True):
        np.testing.assert_array_equal(found, wanted)


def test_passes_share_what_threads_need(monkeypatch: pytest.MonkeyPatch) -> None:
    made, tiles, callers = [], [], []

    def new_one(scene: SceneArrays) -> Any:
        made.append(scene)
        return new_memory(scene)

    def trace_one(*arguments: Any) -> Any:
        tiles.append(Tile(*arguments[2:6]))
        callers.append(threading.current_thread())
        return trace_tile(*arguments)

    monkeypatch.setattr(threads, "new_memory", new_one)
    monkeypatch.setattr(threads, "trace_tile", trace_one)
    scene = vtray.loads(json.dumps(crowd(3, spheres=4)))
    vtray.render(scene, samples=2, size=(9, 7), threads=1)
    assert len(made) == 1  # for two passes
    # Before the tiles of each, an empty one loads in this thread what the others need.
    whole = Tile(0, 0, 9, 7)
    assert tiles == [NO_TILE, whole, NO_TILE, whole]
    here = threading.current_thread()
    assert [caller is here for caller in callers] == [True, False, True, False]
