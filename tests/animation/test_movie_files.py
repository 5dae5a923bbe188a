"""Movies, decoded again: as many pictures as there were, at their times, and near them."""

from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import once
from vtray.animation import gif_file
from vtray.animation.feed import spread
from vtray.animation.times import ends_of

imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")

COUNT = 5


def make(k: int) -> vtray.Scene:
    """Return a scene of which every picture is another."""
    scene = vtray.Scene()
    scene.add_spheres([(0.4 * k - 1, 0, 0), (0, 0, 1)], 0.5, color=["red", "#d0d0d0"])
    scene.lights = [vtray.Light((2, -5, 3))]
    scene.render = vtray.RenderSettings(exposure=0.9)
    scene.camera = vtray.Camera.look_at((0, -5, 1), (0, 0, 0), up=(0, 0, 1), size=(21, 15))
    return scene


@pytest.fixture(scope="module")
def stills(tmp_path_factory: pytest.TempPathFactory) -> list[np.ndarray]:
    folder = tmp_path_factory.mktemp("stills") / "made"
    assert vtray.animate(make, folder / "%03d.png", frames=COUNT) == folder / "%03d.png"
    assert sorted(path.name for path in folder.iterdir()) == [f"{k:03d}.png" for k in range(COUNT)]
    return [np.asarray(Image.open(folder / f"{k:03d}.png")).astype(int) for k in range(COUNT)]


@once
def test_numbered_pictures_are_renders(stills: list[np.ndarray]) -> None:
    for k, still in enumerate(stills):
        assert (vtray.render(make(k)).pixels == still).all()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # of the reader
def test_mp4(stills: list[np.ndarray], tmp_path: Path) -> None:
    path = vtray.animate(make, tmp_path / "a.mp4", frames=COUNT, fps=12.5)
    reader = imageio_ffmpeg.read_frames(path)
    meta = next(reader)
    assert (meta["size"], meta["fps"], meta["codec"]) == ((22, 16), 12.5, "h264")
    assert meta["duration"] == pytest.approx(COUNT / 12.5, abs=0.01)
    assert "yuv420p(tv, bt709/bt709/iec61966-2-1" in meta["pix_fmt"]
    frames = [np.frombuffer(frame, np.uint8).reshape(16, 22, 3) for frame in reader]
    assert len(frames) == COUNT
    for frame, still in zip(frames, stills, strict=True):
        assert np.abs(frame[:15, :21].astype(int) - still).mean() < 6
    assert [item.name for item in tmp_path.iterdir()] == ["a.mp4"]


@once
@pytest.mark.parametrize(("ending", "near"), [("gif", 8), ("webp", 0)])
def test_gif_and_webp(ending: str, near: int, stills: list[np.ndarray], tmp_path: Path) -> None:
    path = vtray.animate(make, tmp_path / f"a.{ending}", frames=COUNT, fps=30)
    with Image.open(path) as movie:
        assert (movie.size, movie.n_frames, movie.info["loop"]) == ((21, 15), COUNT, 0)
        times = []
        for k, still in enumerate(stills):
            movie.seek(k)
            movie.load()
            times.append(movie.info["duration"])
            off = np.abs(np.asarray(movie.convert("RGB")).astype(int) - still)
            assert off.max() <= near
            assert (off[still.min(axis=2) == 255] == 0).all()  # where it is white
        assert times == ([30, 40, 30, 30, 40] if ending == "gif" else [33, 34, 33, 33, 34])
    assert [item.name for item in tmp_path.iterdir()] == [path.name]


def test_transparent_webp(tmp_path: Path) -> None:
    path = vtray.animate(make, tmp_path / "a.webp", frames=2, background="transparent")
    with Image.open(path) as movie:
        movie.seek(1)
        still = vtray.render(make(1), background="transparent").pixels
        assert (np.asarray(movie) == still).all()


def test_times_add_up() -> None:
    assert sum(islice(ends_of(29.97, 100), 2997)) == 10_000
    assert [*islice(ends_of(50, 100), 3)] == [2, 2, 2]


def test_spread() -> None:
    assert spread(3, 8) == [0, 1, 2]
    assert spread(100, 4) == [0, 33, 66, 99]


def test_few_pixels_of_a_colour_keep_it_in_a_gif() -> None:
    # Balls of eight colours, whose dark rims are far fewer pixels than their bright middles.
    hues = np.array([*np.ndindex(2, 2, 2)]) * 170 + 85
    shade = np.sqrt(1 - np.linspace(-0.995, 0.995, 60) ** 2)
    picture = (hues[:, None, None] * (shade[:, None] * shade)[None, :, :, None]).astype(np.uint8)
    picture = picture.reshape(-1, 60, 3)
    table = gif_file._table_of([picture, np.full((600, 60, 3), 255, np.uint8)])
    off = np.linalg.norm(table[gif_file._nearest(picture, table)] - picture.astype(int), axis=2)
    assert len(table) == 256
    assert np.percentile(off, 99) < 13
    assert off.mean() < 3
