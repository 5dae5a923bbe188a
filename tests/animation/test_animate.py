"""What `vtray.animate` takes, what stays the same in all pictures, and what ends in an error."""

import gc
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import compiled_only, once
from vtray.animation import output as outputs
from vtray.animation.movie_names import ALONE
from vtray.animation.particle_scenes import Drawing, ParticleScenes, looked_at
from vtray.animation.snapshots import snapshots_of
from vtray.animation.sources import source_of
from vtray.base.errors import OutputError, RenderError, SceneError
from vtray.base.extras import ExtraError
from vtray.image.formats.image_format import FORMATS

SIZE = (12, 9)


def ball(x: float = 0.0, **more: Any) -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_spheres([(x, 0, 0)], 1.0, **{"color": "white", **more})
    scene.camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=SIZE)
    scene.lights = [vtray.Light((0, -9, 0))]
    return scene


def pixels(folder: Path) -> list[np.ndarray]:
    return [np.asarray(Image.open(path)) for path in sorted(folder.glob("*.png"))]


def test_what_pictures_are_made_of(tmp_path: Path) -> None:
    called = []

    def make(name: str) -> vtray.Scene:
        called.append(name)
        return ball(0.5 * len(name))

    ways = {
        "list": ([ball(0), ball(0.5), ball(1)], {}),
        "one-by-one": ((ball(0.5 * k) for k in range(3)), {}),
        "function": (make, {"frames": ["", "a", "bb"]}),
        "some": ([ball(0), ball(7), ball(0.5), ball(7), ball(1)], {"frames": "::2"}),
        "picked": ([ball(1), ball(0), ball(0.5)], {"frames": [1, 2, 0]}),
    }
    for name, (scenes, more) in ways.items():
        vtray.animate(scenes, tmp_path / name / "%d.png", **more)
    first, *others = [pixels(tmp_path / name) for name in ways]
    assert len(first) == 3
    for found in others:
        assert all((a == b).all() for a, b in zip(first, found, strict=True))
    assert called == ["", "a", "bb"]  # once each


def in_place(as_given: Callable[[np.ndarray], Any]) -> Iterator[Any]:
    """Give what is made of an array again and again, as a simulation writes to it."""
    places = np.array([[0.0, 0.0, 0.0]])
    for _ in range(3):
        places[0, 0] += 0.5
        yield as_given(places)


class Given(NamedTuple):
    positions: np.ndarray


def scene_of(places: np.ndarray) -> vtray.Scene:
    scene = ball()
    scene.objects = [vtray.Spheres(places, 1.0)]
    return scene


@once
@pytest.mark.parametrize("as_given", [scene_of, vtray.Particles, np.asarray, Given])
def test_arrays_may_be_written_to_again(
    as_given: Callable[[np.ndarray], Any], tmp_path: Path
) -> None:
    more = {} if as_given is scene_of else {"camera": ball().camera, "radii": 1.0}
    for name, kept in (("a", np.asarray), ("b", np.copy)):
        path = tmp_path / name / "%d.png"
        vtray.animate(in_place(lambda places, kept=kept: as_given(kept(places))), path, **more)
    found, expected = pixels(tmp_path / "a"), pixels(tmp_path / "b")
    assert len(found) == 3
    assert all((a == b).all() for a, b in zip(found, expected, strict=True))
    assert (found[0] != found[2]).any()


@once
def test_what_moves_through_a_trajectory_is_looked_at_once_it_is_given(tmp_path: Path) -> None:
    places = np.zeros((1, 3))

    def at(k: int) -> Given:  # as MDAnalysis does: the same object, whose frame is another
        places[0, 0] = k
        return Given(places)

    for name, make in (("a", at), ("b", lambda k: np.array([[float(k), 0.0, 0.0]]))):
        path = tmp_path / name / "%d.png"
        vtray.animate(make, path, frames=3, radii=1.0, samples=1, size=SIZE)
    found, expected = pixels(tmp_path / "a"), pixels(tmp_path / "b")
    assert all((a == b).all() for a, b in zip(found, expected, strict=True))


def test_a_scene_may_change_from_picture_to_picture(tmp_path: Path) -> None:
    def scenes() -> Iterator[vtray.Scene]:
        scene = ball()
        yield scene
        scene.lights = [vtray.Light((0, -9, 0), 0.5)]
        yield scene
        scene.objects.clear()
        yield scene

    vtray.animate(scenes(), tmp_path / "%d.png")
    assert [int(picture.max()) for picture in pixels(tmp_path)] == [255, 127, 0]


@pytest.mark.parametrize("before", [0, 1])
@pytest.mark.parametrize("camera", [ball().camera, None])
@pytest.mark.parametrize(
    ("objects", "message"),
    [
        (3, r"objects: expected a list, got 3"),
        (["x"], r"objects\[0\]: expected Sphere, .* got 'x'"),
    ],
)
def test_objects_that_are_none(
    before: int, camera: vtray.Camera | None, objects: Any, message: str, tmp_path: Path
) -> None:
    def scenes() -> Iterator[vtray.Scene]:
        scene = ball()
        scene.camera = camera
        for _ in range(before):
            yield scene
        scene.objects = objects
        yield scene

    for k, given in enumerate((scenes(), list(scenes())[before:])):
        with pytest.raises(SceneError, match=message):
            vtray.animate(given, tmp_path / f"{k}-%d.png", size=SIZE)


def test_what_does_not_change_is_copied_once() -> None:
    scene, other = ball(), ball()
    source = snapshots_of(source_of(iter([scene, scene, other])), iter([]))
    one, again, last = source.start(0)
    assert one is not again
    assert one.objects[0] is again.objects[0] is not scene.objects[0]
    assert last.objects[0] is not one.objects[0]
    assert one.objects[0] == scene.objects[0]


def test_a_background_may_be_an_array(tmp_path: Path) -> None:
    particles = vtray.Particles([(0, 0, 0)])
    for name, background in (("a", np.array([1.0, 0.5, 0.0])), ("b", (1.0, 0.5, 0.0))):
        path = tmp_path / name / "%d.png"
        vtray.animate([particles], path, background=background, size=SIZE)
    assert (pixels(tmp_path / "a")[0] == pixels(tmp_path / "b")[0]).all()


def test_exposure_is_that_of_the_first(tmp_path: Path) -> None:
    def make(k: int) -> vtray.Scene:
        scene = ball()
        scene.lights = [vtray.Light((0, -9, 0), 1 / (1 + k))]
        return scene

    vtray.animate(make, tmp_path / "a" / "%d.png", frames=2)
    bright, dark = (int(picture.max()) for picture in pixels(tmp_path / "a"))
    assert (bright, dark) == (255, 127)
    vtray.animate(make, tmp_path / "b" / "%d.png", frames=2, exposure="max")
    assert [int(picture.max()) for picture in pixels(tmp_path / "b")] == [255, 255]


@compiled_only  # several thousand samples
@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_what_does_not_move_stays_the_same(tmp_path: Path, integrator: str) -> None:
    # Which pixels get more samples, and how many rays go to soft lights, depends on what is white.
    scene = ball()
    scene.add_spheres([(1.3, -1, 0.5), (-1, -1.2, -0.7)], 0.5, color="white")
    scene.add_plane((0, 0, -1.3), (0, 0, 1), "white")
    scene.lights = [vtray.SphereLight((2, -9, 3), 2, 4), vtray.SphereLight((-3, -4, 1), 1, 1)]
    how = {"size": (48, 36), "samples": 2, "integrator": integrator, "edge_samples": 8}
    vtray.animate(scene, tmp_path / "a" / "%d.png", frames=3, **how)
    vtray.turntable(scene, tmp_path / "b" / "%d.png", seconds=2, fps=1, degrees=0, **how)
    first, *others = pixels(tmp_path / "a")
    assert all((first == other).all() for other in others)
    one, two = pixels(tmp_path / "b")
    assert (one == two).all()
    locked = [vtray.read_provenance(tmp_path / "a" / f"{k}.png").lock is not None for k in range(2)]
    assert locked == [integrator == "direct", True]


def test_stops_count_once_in_all_pictures(tmp_path: Path) -> None:
    scene, dark = ball(), ball()
    scene.lights = [vtray.Light((0, -9, 0))]
    dark.lights = [vtray.Light((0, -9, 0), 0.5)]
    scene.render = dark.render = vtray.RenderSettings(exposure="auto", stops=-1)
    vtray.animate([scene, dark], tmp_path / "a" / "%d.png")
    half, quarter = (int(picture.max()) for picture in pixels(tmp_path / "a"))
    assert abs(half - 2 * quarter) <= 1
    first, second = (vtray.read_provenance(tmp_path / "a" / f"{k}.png") for k in range(2))
    assert (first.stops, second.stops) == (-1, -1)
    assert first.lock is None
    assert second.lock > 0
    scene.render = dark.render = vtray.RenderSettings()
    vtray.animate([scene, dark], tmp_path / "b" / "%d.png", stops=-1)
    assert [int(picture.max()) for picture in pixels(tmp_path / "b")] == [127, 63]


def test_black_pictures_decide_no_exposure(tmp_path: Path) -> None:
    def make(k: int) -> vtray.Scene:
        scene = ball(50 if k == 0 else 0)
        scene.lights = [vtray.Light((0, -9, 0))]
        return scene

    vtray.animate(make, tmp_path / "%d.png", frames=3)
    assert [int(picture.max()) for picture in pixels(tmp_path)] == [0, 255, 255]


def test_points_that_shine_keep_their_brightness(tmp_path: Path) -> None:
    points = np.random.default_rng(1).normal(size=(40, 3))

    def make(k: int) -> vtray.Scene:
        scene = vtray.Scene()
        scene.add_particles(points, emission=1.0 / (1 + k), stretch="linear")
        scene.camera = vtray.Camera.look_at((0, -6, 0), (0, 0, 0), up=(0, 0, 1), size=SIZE)
        return scene

    vtray.animate(make, tmp_path / "%d.png", frames=2)
    one, other = pixels(tmp_path)
    assert one.max() == 255
    assert 120 <= other.max() < 255


def test_camera(tmp_path: Path) -> None:
    scene, camera = ball(1), ball().camera
    scene.render = vtray.RenderSettings(exposure=0.9)
    middle, away = camera.orbit(20, about=scene), camera.orbit(40, about=scene)
    keys = {0: camera, 2: away}
    vtray.animate(scene, tmp_path / "keys" / "%d.png", camera=keys)
    found = pixels(tmp_path / "keys")
    assert len(found) == 3
    for picture, there in zip(found, (camera, middle, away), strict=True):
        scene.camera = there
        assert np.abs(vtray.render(scene).pixels.astype(int) - picture).max() <= 1
    vtray.animate([scene], tmp_path / "one" / "%d.png", camera=camera)
    vtray.animate(scene, tmp_path / "by" / "%d.png", camera=lambda k: camera, frames=1)
    assert (pixels(tmp_path / "one")[0] == found[0]).all()
    assert (pixels(tmp_path / "by")[0] == found[0]).all()
    assert scene.camera == away  # it is not changed


def test_what_is_wrong_with_a_frame_says_which(tmp_path: Path) -> None:
    given = [vtray.Particles([(0, 0, 0)], {"q": [1]}, time=1), vtray.Particles([(0, 0, 0)])]
    path = tmp_path / "a.gif"
    with pytest.raises(SceneError, match=r"^scenes: frame 1: color: expected a colour or the name"):
        vtray.animate(given, path, color="q", size=SIZE)
    with pytest.raises(SceneError, match=r"^scenes: frame 4: color: expected a colour or the name"):
        vtray.animate(lambda k: given[k // 4], path, frames=range(3, 5), color="q", size=SIZE)
    with pytest.raises(SceneError, match=r"^scenes: frame 0: expected vtray.Particles, .*, got 1$"):
        vtray.animate([1, 2], path, size=SIZE)
    late = {"annotate": {"time": True}, "resume": True, "size": SIZE}
    with pytest.raises(OutputError, match=r"^scenes: frame 1: time: the data do not say the time"):
        vtray.animate(given, path, **late)
    with pytest.raises(SceneError, match=r"^scenes: frame 1: color: "):
        vtray.animate(iter(given), tmp_path / "b.gif", color="q", size=SIZE)


@compiled_only
def test_particles_have_one_camera_and_one_scale(tmp_path: Path) -> None:
    def frame(k: int) -> vtray.Particles:
        return vtray.Particles([(3.0 * k, 0, 0), (0, 0, 1)], {"energy": [k, 0.5]}, time=k / 2)

    how = {"color": "energy", "view": "front", "size": SIZE, "radii": 0.4}
    frames = [frame(k) for k in range(3)]
    vtray.animate(frames, tmp_path / "%d.png", **how)
    scene = vtray.Scene()
    scene.add_particles(frames[1], color="energy", clim=(0, 2), radii=0.4)
    both = vtray.Scene()
    for one in frames:
        both.add_particles(one, radii=0.4)
    scene.camera = vtray.Camera.fit(both, view="front", size=SIZE)
    made = vtray.render(scene, samples=4, tolerance=0.02)
    assert (pixels(tmp_path)[1] == made.pixels).all()


def test_a_cell_is_in_all_pictures_or_in_none() -> None:
    cell = np.eye(3) * 4
    inside, outside = (vtray.Particles([(x, 1, 1)], cell=cell) for x in (1, -3))
    drawing = Drawing({}, SIZE, None)
    make = ParticleScenes(drawing.draw, drawing.fit, looked_at(source_of([inside] * 2), inside))
    counts = [
        len(make(one, 0).scene.objects) for one in (inside, outside, vtray.Particles([(0, 0, 0)]))
    ]
    assert counts == [3, 3, 1]
    with pytest.warns(UserWarning, match="cell: not drawn"):
        make = ParticleScenes(drawing.draw, drawing.fit, looked_at(source_of([outside]), outside))
    assert [len(make(one, 0).scene.objects) for one in (inside, outside)] == [1, 1]


@compiled_only
def test_annotations(tmp_path: Path) -> None:
    frames = [vtray.Particles([(0, 0, 0)], time=0.25 * k) for k in range(2)]
    texts = {"title": "{frame}: {time:.2f}", "fontsize": 8}
    how = {"size": (90, 40), "view": "front"}
    vtray.animate(frames, tmp_path / "%d.png", annotate=texts, **how)
    one, other = pixels(tmp_path)
    assert (one != other).any()
    with pytest.raises(OutputError, match=r"title: expected \{frame\} and \{time\} alone"):
        vtray.animate(frames, tmp_path / "b%d.png", annotate={"title": "{x}"}, **how)
    with pytest.raises(OutputError, match="time: the data do not say the time of a picture"):
        vtray.animate([ball()], tmp_path / "c%d.png", annotate={"time": True})


@compiled_only  # 300 pictures
def test_memory_does_not_grow(tmp_path: Path) -> None:
    alive: weakref.WeakSet[Any] = weakref.WeakSet()
    most = []

    class Marker:
        """What can be watched."""

    def scenes() -> Iterator[vtray.Scene]:
        for k in range(300):
            scene = ball(k / 300)
            scene.__dict__["marker"] = marker = Marker()
            alive.add(marker)
            del marker
            gc.collect()  # fast, as what was there before is left out
            most.append(len(alive))
            yield scene

    gc.freeze()
    try:
        vtray.animate(scenes(), tmp_path / "a.gif", size=(4, 3), threads=1)
    finally:
        gc.unfreeze()
    assert len(most) == 300
    assert max(most) <= 5
    assert most[-1] <= most[20]


ERRORS = [
    ({"path": "a.avi"}, OutputError, r"a.avi: is no movie by its name; expected .mp4, .gif, .webp"),
    ({"path": "no/a.gif"}, OutputError, r"no/a.gif: there is no folder"),
    ({"path": "%d-%d.png"}, OutputError, "expected one number such as %04d in the name"),
    ({"path": "%d.bmp"}, OutputError, 'cannot write ".bmp" files; the formats are'),
    ({"path": "no/no/%d.png"}, OutputError, "the folder no/no cannot be made: no such file"),
    ({"fps": 0}, SceneError, "fps: expected a number > 0, got 0"),
    ({"fps": "fast"}, SceneError, "fps: expected a number > 0, got 'fast'"),
    ({"fps": 60}, OutputError, "a.gif: fps: expected at most 50 for this format, got 60"),
    ({"fps": 0.001}, OutputError, "a.gif: fps: expected at least 0.002 for this format"),
    ({"path": "a.webp", "fps": 1e-9}, OutputError, "fps: expected at least 0.0001 for this format"),
    ({"path": "a.mp4", "fps": 1e-7}, OutputError, "fps: expected at least 0.001 for this format"),
    ({"annotate": "x"}, OutputError, "annotate: expected keywords of Image.annotated, got 'x'"),
    (
        {"annotate": {"tilte": "x"}},
        OutputError,
        "argument 'tilte' is unknown; did you mean \"title\"",
    ),
    ({"annotate": {1: "x"}}, OutputError, "argument '1' is unknown; the arguments are title, time"),
    (
        {"progress": "bar"},
        ValueError,
        "progress: expected True or a function that takes .* got 'bar'",
    ),
    ({"progress": 5}, ValueError, "progress: expected True or a function that takes .* got 5"),
    ({"warn": 5}, ValueError, "warn: expected a function that takes a line of text, got 5"),
    (
        {"annotate": {"title": "{frame:999999999}"}},
        OutputError,
        "title: expected {frame} and {time} alone",
    ),
    (
        {"annotate": {"title": "{time.real}"}},
        OutputError,
        "title: expected {frame} and {time} alone",
    ),
    (
        {"annotate": {"title": "{time}"}},
        OutputError,
        "title: the data do not say the time of a pict",
    ),
    (
        {"path": "made/%d.png", "bits": 16, "annotate": {"title": "x"}},
        OutputError,
        "made/0.png: annotations: expected 8 bits with them, got 16",
    ),
    (
        {"path": "made/%d.npz", "aov": ["depth"], "annotate": {"title": "x"}},
        OutputError,
        "made/0.npz: this format is not for pixels alone; .png",
    ),
    ({"bits": 16}, OutputError, "a.gif: bits 16: movies have 8 bits and colours alone"),
    ({"aov": ["depth"]}, OutputError, "a.gif: aov: movies have 8 bits and colours alone"),
    ({"background": "transparent"}, OutputError, "a.gif: background: this format cannot be trans"),
    ({"samples": 0}, SceneError, "samples: "),
    ({"color": "x"}, TypeError, r"animate\(\) argument 'color' is for particles, or unknown"),
    ({"sampels": 3}, TypeError, "argument 'sampels' is unknown; did you mean \"samples\""),
    ({"trajectory": "x"}, SceneError, "trajectory: expected the name of a trajectory beside it"),
    ({"scenes": []}, SceneError, "frames: expected at least one picture, got none"),
    ({"scenes": iter([])}, SceneError, "scenes: expected at least one picture, got none"),
    ({"scenes": 7}, SceneError, "scenes: expected scenes, a function that makes them, or the name"),
    ({"scenes": ball}, SceneError, "frames: expected how many pictures a function makes"),
    ({"scenes": ball()}, SceneError, "frames: expected how many pictures of the scene there are"),
    ({"scenes": iter([ball()]), "frames": "::2"}, SceneError, "expected None where scenes come on"),
    ({"frames": "a:b"}, SceneError, "frames: expected START:STOP:STEP such as 0:500:5"),
    ({"frames": "5:"}, SceneError, "frames 5:: there are 2 frames, none of which is among these"),
    ({"camera": 7}, SceneError, "camera: expected a Camera, cameras by the numbers of pictures"),
    ({"camera": {}}, SceneError, "camera: expected cameras by the numbers of pictures, got none"),
    ({"camera": {-1: ball().camera}}, SceneError, "expected numbers of pictures from 0, got -1"),
    ({"camera": {0: 1}}, SceneError, r"camera\[0\]: expected a Camera, got 1"),
    ({"camera": lambda k: k}, SceneError, "camera: expected a Camera for picture 0, got 0"),
    ({"scenes": "no.xyz"}, SceneError, "no.xyz: no such file; expected a file of data"),
    ({"scenes": [ball(), 3]}, SceneError, "scenes: frame 1: expected a Scene, got 3"),
]


@pytest.mark.parametrize(("wrong", "kind", "message"), ERRORS)
def test_errors(
    wrong: dict[str, Any],
    kind: type[Exception],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    given: dict[str, Any] = {"scenes": [ball(), ball(1)], "path": "a.gif", **wrong}
    with pytest.raises(kind, match=message) as error:
        vtray.animate(given.pop("scenes"), given.pop("path"), **given)
    assert "\n" not in str(error.value)
    assert not Path("made").exists()


def test_settings_that_are_none_are_not_given(tmp_path: Path) -> None:
    how = {"size": (4, 3), "threads": 1}
    none = {"samples": None, "clip": None, "fog": None}
    vtray.animate([ball()], tmp_path / "a" / "%d.png", **how)
    vtray.animate([ball()], tmp_path / "b" / "%d.png", **how, **none)
    vtray.turntable(ball(), tmp_path / "c" / "%d.png", seconds=0.01, **how, **none)
    (first,), (second,), (third,) = (pixels(tmp_path / name) for name in "abc")
    assert (first == second).all()
    assert (first == third).all()


@once
def test_numbers_of_numpy(tmp_path: Path) -> None:
    how: dict[str, Any] = {"size": (4, 3), "threads": 1}
    keys = {np.int64(0): ball().camera, np.int64(2): ball().camera.orbit(10, about=(0, 0, 0))}
    three = np.int64(3)
    vtray.animate(ball(), tmp_path / "a" / "%d.png", frames=three, fps=np.int64(30), **how)
    vtray.animate(ball(), tmp_path / "b" / "%d.png", camera=keys, **how)
    vtray.animate(lambda k: ball(float(k)), tmp_path / "c" / "%d.png", frames=three, **how)
    vtray.turntable(ball(), tmp_path / "d" / "%d.png", seconds=three, fps=np.float32(1), **how)
    assert [len(pixels(tmp_path / name)) for name in "abcd"] == [3, 3, 3, 3]


def test_numbers_of_an_array_are_those_of_frames() -> None:
    for frames in ([0, 10, 20], np.arange(0, 30, 10), range(0, 30, 10)):
        source = source_of(ball, frames)
        found = [source.number(k) for k in range(3)]
        assert (found, {*map(type, found)}) == ([0, 10, 20], {int})
    assert source_of(ball, [0.5, 1.5]).number(1) == 1


def test_pictures_of_one_size(tmp_path: Path) -> None:
    other = ball()
    other.camera = other.camera.resized((6, 9))
    words = "a.gif: expected pictures of 12 x 9 pixels as the first, got 6 x 9; give a size for all"
    with pytest.raises(OutputError, match=f"^scenes: frame 1: .*{words}") as error:
        vtray.animate([ball(), other], tmp_path / "a.gif")
    assert "a.gif: 1 picture done" in error.value.__notes__[0]
    vtray.animate([ball(), other], tmp_path / "b.gif", size=(8, 6))
    vtray.animate([ball(), other], tmp_path / "%d.png")  # where sizes may differ


def test_without_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(ExtraError, match=r"a.mp4: writing .mp4 needs imageio_ffmpeg, which is "):
        vtray.animate([ball()], tmp_path / "a.mp4")
    assert not [*tmp_path.iterdir()]


def test_ffmpeg_that_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("imageio_ffmpeg")
    monkeypatch.setattr("vtray.animation.mp4_file.QUALITY", "bad")
    with pytest.raises(OutputError, match="ffmpeg cannot write it: "):
        vtray.animate([ball(), ball()], tmp_path / "a.mp4")
    assert not (tmp_path / "a.mp4").exists()


def test_render_errors_are_passed_on(tmp_path: Path) -> None:
    dark = ball()
    dark.lights = [vtray.Light((0, 0, 9), 1e306)]
    with pytest.raises(RenderError, match="^scenes: frame 1: .*the intensities add up to"):
        vtray.animate([ball(), dark], tmp_path / "a.gif")


def test_progress_and_warnings(tmp_path: Path) -> None:
    seen, warned = [], []
    dark = ball()
    dark.lights = []
    vtray.animate(
        [dark] * 3,
        tmp_path / "a.gif",
        progress=lambda *step: seen.append(step),
        warn=warned.append,
    )
    assert seen == [("frames", k, 3) for k in range(4)]
    assert len(warned) == 1


def test_progress_bar(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    vtray.animate([ball()], tmp_path / "a.gif", progress=True)
    assert "frames: 100%" in capfd.readouterr().err


def test_kinds_of_names() -> None:
    assert outputs.is_movie(Path("a.MP4"))
    assert outputs.is_movie(Path("%04d.tif"))
    assert not outputs.is_movie(Path("%04d/a.png"))
    assert set(ALONE) == {*outputs.MOVIES} - {*FORMATS}
    assert outputs.Output(Path("f/a%03d.png")).name(7) == Path("f/a007.png")


def test_categories_keep_their_colors() -> None:
    kinds = [[1, 2], *[[4, 2]] * 6, [5, 4], *[[4, 4]] * 12]
    frames = [vtray.Particles([(0, 0, 0), (1, 0, 0)], {"type": types}) for types in kinds]
    drawing = Drawing({}, (8, 6), None)
    scenes = ParticleScenes(drawing.draw, drawing.fit, looked_at(source_of(frames), frames[0]))
    assert scenes.fixed == {"categories": [1, 2, 4]}  # 5 is in none of those that are looked at
    colors = [scenes(frame, 0).scene.objects[0].color.tolist() for frame in frames]
    assert colors[0] == [[0, 114, 178], [230, 159, 0]]
    assert colors[1] == [[0, 158, 115], [230, 159, 0]]
    assert colors[7][1] == colors[-1][0] == [0, 158, 115]
    assert colors[7][0] not in (*colors[0], *colors[1])


def test_slow_files_are_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ase = pytest.importorskip("ase")
    path = tmp_path / "run.traj"
    pytest.importorskip("ase.io").write(path, [ase.Atoms("C", [(k, 0, 0)]) for k in range(5)])
    made = []
    monkeypatch.setattr(
        "vtray.scene.readers.ase_file.from_ase",
        lambda atoms: made.append(atoms) or vtray.from_ase(atoms),
    )
    vtray.animate(path, tmp_path / "%d.png", size=(8, 6), samples=1, exposure=1)
    assert len(made) == 5
    assert len([*tmp_path.glob("*.png")]) == 5
    with pytest.raises(SceneError, match=r"run.traj: frame 9: there are 5 frames"):
        vtray.animate(path, tmp_path / "a%d.png", frames=[0, 9])
    with pytest.raises(SceneError, match=r"^.*run.traj: frames 7:: there are 5 frames, none of"):
        vtray.animate(path, tmp_path / "b%d.png", frames="7:")
