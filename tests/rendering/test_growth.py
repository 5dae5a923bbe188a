"""A picture that is shown while it grows: better and better, and in the end the same."""

import json
import os
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import light, plane, scene, sphere
from soft_scenes import soft_scene

import vtray
from conftest import JIT, compiled_only, once
from vtray.base import pool
from vtray.base.pool import Progress
from vtray.base.tiles import Tile
from vtray.rendering import growth, passes
from vtray.rendering.engines.engine import Cast, Done, trace_to
from vtray.rendering.growth import STEP, Growth, Part
from vtray.transport.film import Film, new_film
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import SceneArrays

SIZE = (96, 70) if JIT else (10, 9)
TILE = 20 if JIT else 4


class StepByStep:
    """An engine that traces a tile after the other, and tells of each."""

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
        casts = []
        for k, tile in enumerate(tiles):
            casts.append(trace_to(film, scene, sampling, tile))
            if done is not None:
                done(tile)
            if progress is not None:
                progress(k + 1, len(tiles))
        return Cast(max(cast.peak for cast in casts), sum(cast.rays for cast in casts))


@pytest.fixture
def often(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let pictures be shown after each tile."""
    monkeypatch.setattr(passes, "Threads", StepByStep)
    monkeypatch.setattr(growth, "REST", 0)
    return


def balls() -> vtray.Scene:
    """Return a scene with a light of each kind that has other kernels."""
    objects = [sphere((0, 0, 5), 1.2), sphere((1.5, 0.5, 4), 0.6), plane((0, 1, 0), (0, -1, 0.1))]
    made = vtray.loads(json.dumps(scene(objects, [light(5, -5, 0)])))
    made.add_sun((1, 2, 1), angle=5)
    return made


def heavy() -> vtray.Scene:
    """Return a scene that takes many seconds."""
    spheres = [sphere((k % 50 - 25, k // 50 - 25, 40), 0.6) for k in range(2500)]
    lights = [light(k / 6 - 50, -50, 0, intensity=0.003) for k in range(600)]
    world = scene([*spheres, plane((0, 0, 60), (0, 0, -1))], lights, size=[2000, 2000])
    return vtray.loads(json.dumps(world))


def assert_same(one: vtray.Image, other: vtray.Image) -> None:
    assert one.white == other.white
    assert one.stats["rays"] == other.stats["rays"]
    np.testing.assert_array_equal(one.linear, other.linear)
    np.testing.assert_array_equal(one.pixels, other.pixels)
    np.testing.assert_array_equal(one.alpha, other.alpha)


@once
@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("background", ["black", "transparent"])
def test_parts_get_better_and_the_whole_is_the_same(
    samples: int, background: str, often: None, tmp_path: Path
) -> None:
    world = balls()
    options: dict[str, Any] = {"samples": samples, "background": background, "tile": TILE}
    options["size"] = SIZE
    whole = vtray.render(world, **options)
    parts: list[vtray.Image] = []
    callers = set()

    def show(image: vtray.Image) -> None:
        callers.add(threading.current_thread())
        parts.append(image)

    assert_same(vtray.render(world, on_update=show, update_seconds=0, **options), whole)
    assert callers == {threading.current_thread()}
    count = -(-SIZE[0] // TILE) * -(-SIZE[1] // TILE) * min(samples, 2)
    shares = [part.partial for part in parts]
    assert set(shares) == {k / count for k in range(count)}
    assert shares == sorted(shares)
    assert shares[0] == 0
    assert shares[-1] < 1
    errors = [np.abs(part.linear - whole.linear).mean() for part in parts]
    assert errors == sorted(errors, reverse=True)
    drawn = errors[shares.count(0) - 1]  # of the whole draft
    assert errors[-1] < drawn
    assert drawn < 0.6 * np.abs(whole.linear).mean() or not JIT
    covers = [np.abs(part.alpha - whole.alpha).mean() for part in parts]
    assert covers == sorted(covers, reverse=True)
    assert all(part.pixels.shape == whole.pixels.shape for part in parts)
    parts[-1].save(tmp_path / "a.png")
    assert vtray.read_provenance(tmp_path / "a.png").partial == shares[-1]
    assert "partial" not in whole_told(whole, tmp_path / "b.png")
    assert vtray.read_provenance(tmp_path / "b.png").partial is None


def whole_told(image: vtray.Image, path: Path) -> str:
    image.save(path)
    return vtray.read_provenance(path).to_text()


def test_lights_that_are_kept(often: None) -> None:
    world, parts = balls(), []
    options: dict[str, Any] = {"samples": 2, "keep_lights": True, "tile": TILE, "size": SIZE}
    image = vtray.render(world, on_update=parts.append, update_seconds=0, **options)
    assert_same(image, vtray.render(world, **options))
    whole = vtray.render(world, **options).relight([0.5, 2])
    np.testing.assert_array_equal(image.relight([0.5, 2]).linear, whole.linear)
    with pytest.raises(vtray.RenderError, match="a part of a picture"):
        parts[-1].relight([0.5, 2])


@compiled_only
@pytest.mark.parametrize("samples", [1, 3])
def test_threads_show_pixels_that_are_done(samples: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pool, "POLL_SECONDS", 0.001)
    monkeypatch.setattr(growth, "REST", 0)
    world = vtray.loads(json.dumps(soft_scene(3, "few", size=[160, 120], resolution=[0.03, 0.03])))
    options: dict[str, Any] = {"samples": samples, "threads": 2, "tile": 32}
    whole, parts = vtray.render(world, **options), []
    assert_same(vtray.render(world, on_update=parts.append, update_seconds=0, **options), whole)
    assert len(parts) > 3
    errors = [np.abs(part.linear - whole.linear).mean() for part in parts]
    drawn = next(k for k, part in enumerate(parts) if part.partial)
    assert errors[drawn:] == sorted(errors[drawn:], reverse=True)


def test_draft_has_the_view_of_the_picture(often: None) -> None:
    # Where light changes slowly, a draft is nearly the picture, in its place and not beside it.
    wall = scene([plane((0, 0, 5), (0.3, 0.2, -1))], [light(2, -1, 1)], size=list(SIZE))
    parts: list[vtray.Image] = []
    world = vtray.loads(json.dumps(wall))
    whole = vtray.render(world, on_update=parts.append, update_seconds=0, tile=TILE)
    draft = [part for part in parts if part.partial == 0][-1].linear[..., 0]
    height, width = draft.shape
    np.testing.assert_allclose(
        draft[:, [0, -1]].mean(0) / whole.linear[:, [0, -1], 0].mean(0), 1, atol=0.1
    )
    assert len(np.unique(draft)) <= (width // STEP + 1) * (height // STEP + 1)
    # The nearest ray is never farther away than half a step.
    across = np.abs(np.diff(draft, axis=1)) > 0
    assert all(np.diff(np.flatnonzero(row)).max(initial=0) <= STEP for row in across)


@once
def test_pictures_come_seldom_where_they_take_long() -> None:
    times: list[tuple[float, float]] = []

    def tell(part: Part) -> None:
        begin = time.perf_counter()
        time.sleep(0.02)
        times.append((begin, time.perf_counter()))

    grown = Growth(tell, 0.05)
    film = new_film(8, 8, "linear")
    grown.begin_draft(film, 8, 8)
    while len(times) < 4:
        grown.add(Tile(0, 0, 8, 8))
        grown.update(0, 9)
        time.sleep(0.001)
    for (_, before), (after, _) in pairwise(times):
        assert after - before > 0.17


def interrupt(grown: Growth) -> None:
    with pytest.raises(KeyboardInterrupt), grown:
        raise KeyboardInterrupt


def test_nothing_new_is_not_shown() -> None:
    parts: list[Part] = []
    grown = Growth(parts.append, 0)
    interrupt(grown)
    grown.begin_draft(new_film(2, 2, "linear"), 9, 7)
    grown.update(0, 9)
    interrupt(grown)
    assert parts == []
    grown.add(Tile(0, 0, 2, 2))
    grown.update(9, 9)  # nor what follows at once as the whole
    assert parts == []
    grown.update(1, 9)
    grown.update(2, 9)
    assert [(part.linear.shape, part.coverage, part.done) for part in parts] == [
        ((7, 9, 3), None, 1 / 9)
    ]


def test_what_it_raises_ends_the_render(often: None) -> None:
    before = threading.active_count()
    parts: list[vtray.Image] = []

    def show(image: vtray.Image) -> None:
        parts.append(image)
        raise LookupError

    with pytest.raises(LookupError):
        vtray.render(balls(), size=SIZE, on_update=show, update_seconds=0)
    assert len(parts) == 1
    assert threading.active_count() == before


@compiled_only
def test_what_it_raises_ends_the_threads() -> None:
    before = threading.active_count()

    def show(image: vtray.Image) -> None:
        raise LookupError

    begin = time.perf_counter()
    with pytest.raises(LookupError):
        vtray.render(heavy(), threads=2, on_update=show, update_seconds=0.1)
    assert time.perf_counter() - begin < 20
    time.sleep(0.05)
    assert threading.active_count() == before


@compiled_only
@pytest.mark.parametrize("seconds", [float("inf"), 0.2])
def test_interrupt_shows_what_there_is(seconds: float) -> None:
    world, before = heavy(), threading.active_count()
    vtray.render(world, size=(8, 6), on_update=lambda _: None)  # kernels are there then
    parts: list[vtray.Image] = []
    begin = time.perf_counter()

    def interrupt_soon(step: str, done: int, _total: int) -> None:
        if step == "trace" and done > 40 and time.perf_counter() - begin > 0.5:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        vtray.render(
            world,
            threads=2,
            progress=interrupt_soon,
            on_update=parts.append,
            update_seconds=seconds,
        )
    time.sleep(0.05)
    assert threading.active_count() == before
    assert len(parts) == 1 or seconds < 1
    assert parts[-1].partial < 1
    assert parts[-1].linear.any()


@pytest.mark.parametrize("seconds", [-1, float("nan"), "1", None, True])
def test_seconds_that_are_none(seconds: object) -> None:
    with pytest.raises(ValueError, match="^update_seconds: expected a number ≥ 0, got "):
        vtray.render(balls(), on_update=print, update_seconds=seconds)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"on_update": 5}, "on_update: expected a function that takes an image, got 5"),
        ({"progress": True}, "progress: expected a function that takes a step, and how much of "),
        ({"warn": 3}, "warn: expected a function that takes a line of text, got 3"),
    ],
)
def test_what_cannot_be_called(given: Any, message: str) -> None:
    with pytest.raises(ValueError, match=f"^{message}"):
        vtray.render(balls(), **given)
