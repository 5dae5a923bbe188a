"""The benchmarks: scenes for other renderers, and tables; none of these renderers is needed.

Those that are installed render a small scene, and must show what vtray shows.
"""

import importlib
import itertools
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import compiled_only, once
from vtray.scene.default_light import lights_of

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
FEW, SMALL = 60, 64
"""Spheres, and the side of a picture in pixels."""
SCENE = {
    "camera": {
        "center": {"x": 0, "y": 0, "z": 2},
        "normal": {"x": 0, "y": 0, "z": 3},
        "focus": 2,
        "size": [40, 20],
        "resolution": [0.1, 0.2],
    },
    "lights": [{"location": {"x": 1, "y": -5, "z": 6}, "intensity": 0.5}],
    "objects": [
        {
            "type": "sphere",
            "center": {"x": 1, "y": 2, "z": 10},
            "radius": 3,
            "color": {"r": 255, "g": 0, "b": 51},
            "lambert": 0.5,
        },
        {
            "type": "plane",
            "center": {"x": 0, "y": 4, "z": 0},
            "normal": {"x": 0, "y": 2, "z": 0},
            "color": {"r": 0, "g": 255, "b": 0},
            "lambert": 1,
        },
    ],
}


@pytest.fixture(autouse=True)
def _importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the modules of the benchmarks be imported, as they are when they run."""
    monkeypatch.syspath_prepend(BENCHMARKS)


def module(name: str) -> ModuleType:
    """Import a module of the benchmarks."""
    found = importlib.import_module(name)
    assert BENCHMARKS in Path(str(found.__file__)).parents
    return found


def view() -> Any:
    """Return the scene, twice as bright, as other renderers see it."""
    return module("peers.camera_space").view_from_eye(vtray.loads(json.dumps(SCENE)), 2.0)


def test_view_is_seen_from_the_eye_with_y_up() -> None:
    seen = view()
    assert (seen.width, seen.height) == (40, 20)
    assert (seen.pixel_width, seen.pixel_height) == (0.05, 0.1)
    assert seen.lights == [((1, 5, 6), 1.0)]
    sphere, plane = seen.surfaces
    assert (sphere.center, sphere.shape) == ((1, -2, 10), 3)
    assert sphere.color == pytest.approx((0.5, 0, 0.1))
    assert plane.center == (0, -4, 0)
    assert plane.shape == (0, 1, 0), "the normal on the side of the eye"


def test_view_turns_with_the_camera() -> None:
    camera = {**SCENE["camera"], "normal": {"x": 1, "y": 0, "z": 0}}  # type: ignore[dict-item]
    scene = vtray.loads(json.dumps({**SCENE, "camera": camera}))
    seen = module("peers.camera_space").view_from_eye(scene, 1.0)
    # The eye is at (-2, 0, 2); right is -z, up is -y, forward is x.
    assert seen.surfaces[0].center == pytest.approx((-8, -2, 3))


def test_povray_scene() -> None:
    assert module("peers.povray.program").export(view()).splitlines() == [
        "#version 3.7;",
        "global_settings { assumed_gamma 1 }",
        "#default { finish { ambient 0 diffuse 1 } }",
        (
            "camera { location 0 direction <-0.025, 0.05, 1.0> right <2.0, 0.0, 0.0> "
            "up <0.0, 2.0, 0.0> }"
        ),
        "light_source { <1.0, 5.0, 6.0>, rgb 1.0 }",
        "sphere { <1.0, -2.0, 10.0>, 3.0 pigment { rgb <0.5, 0.0, 0.1> } }",
        "plane { <0.0, 1.0, 0.0>, -4.0 pigment { rgb <0.0, 1.0, 0.0> } }",
    ]


def test_tachyon_scene() -> None:
    lines = module("peers.tachyon.program").export(view()).splitlines()
    assert lines[:2] == ["BEGIN_SCENE", "RESOLUTION 40 20"]
    assert "  ZOOM 0.5" in lines
    assert "LIGHT CENTER 1.0 5.0 6.0 RAD 1e-9 COLOR 1.0 1.0 1.0" in lines
    assert "SPHERE CENTER 1.0 -2.0 10.0 RAD 3.0 look0" in lines
    assert "PLANE CENTER 0.0 -4.0 0.0 NORMAL 0.0 1.0 0.0 look1" in lines
    assert lines[-1] == "END_SCENE"


@pytest.mark.parametrize(
    ("name", "output"),
    [
        (
            "peers.povray.program",
            "  Trace Time:       0 hours  0 minutes  0 seconds (0.224 seconds)\n",
        ),
        ("peers.tachyon.program", "  Ray Tracing Time:     0.2240 seconds\n"),
        ("timing.vtray_process", "pack            0.1000 s\ntrace           0.2240 s\n"),
    ],
)
def test_trace_seconds_are_read_from_the_output(name: str, output: str) -> None:
    assert module(name).trace_seconds(output) == 0.224
    assert np.isnan(module(name).trace_seconds("something else"))


@pytest.mark.parametrize(
    ("name", "output"),
    [
        (
            "peers.povray.program",
            "Parse Time:  0 hours (2.5 seconds)\n"
            "Bounding Time:  0 hours (3.5 seconds)\n"
            "Trace Time:  0 hours (1.5 seconds)\n",
        ),
        (
            "peers.tachyon.program",
            "Scene Parsing Time:     2.5000 seconds\n"
            "Preprocessing Time:     3.5000 seconds\n"
            "  Ray Tracing Time:     1.5000 seconds\n",
        ),
        ("peers.host.host", "load    2.5000 s\nbuild   3.5000 s\ntrace   1.5000 s\n"),
        (
            "timing.vtray_process",
            "read 2.0000 s\npack  0.5000 s\nbuild  3.5000 s\ntrace 1.5000 s\nrays   7\n",
        ),
    ],
)
def test_all_phases_are_read_from_the_output(name: str, output: str) -> None:
    assert module(name).phases(output) == (2.5, 3.5, 1.5)
    assert np.isnan(module(name).phases("something else")).all()


def test_scenes_are_valid_and_always_the_same() -> None:
    for _, make, _ in module("scenes.few_objects").SCENES.values():
        assert make(16) == make(16)
        assert vtray.loads(json.dumps(make(16))).camera.size == (16, 16)


def test_room_is_what_it_is_said_to_be() -> None:
    scene = vtray.loads(json.dumps(module("scenes.few_objects").room(16)))
    assert len(scene.lights) == 64
    assert sum(isinstance(item, vtray.Sphere) for item in scene.objects) == 4
    assert sum(isinstance(item, vtray.Plane) for item in scene.objects) == 5


def test_brighter_picture_is_the_same_and_mirrored_one_is_not(tmp_path: Path) -> None:
    ramp = np.arange(0, 120, 2).repeat(24).reshape(-1, 8, 3).astype(np.uint8)
    pictures = {"dark": ramp, "bright": ramp * 2, "mirrored": ramp[::-1]}
    for name, pixels in pictures.items():
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    same = module("timing.same_picture")
    dark = tmp_path / "dark.png"
    assert same.is_same(same.difference(dark, tmp_path / "bright.png"))
    assert not same.is_same(same.difference(dark, tmp_path / "mirrored.png"))


def test_jobs_are_interleaved_and_timed(tmp_path: Path) -> None:
    measure = module("timing.jobs")
    log = tmp_path / "log"

    def job(name: str) -> Any:
        code = f"open({str(log)!r}, 'a').write({name!r}); print('inner 1.5')"
        command = [sys.executable, "-S", "-c", code]
        return measure.Job(name, command, lambda output: float(output.split()[1]))

    timings = measure.run_interleaved([job("a"), job("b")], 2)
    assert log.read_text() == "abab"
    assert timings["a"].inner.median == 1.5
    assert 0 < timings["b"].whole.median < 60


def test_memory_is_that_of_the_process_alone() -> None:
    if sys.platform == "win32":
        pytest.skip("Windows does not tell")
    measure = module("timing.jobs")

    def memory(code: str) -> float:
        command = [sys.executable, "-S", "-c", code]
        return float(measure.run_once(measure.Job("x", command)).memory)

    ours = np.ones(8_000_000)
    assert memory("pass") < ours.nbytes
    assert ours.nbytes < memory(f"b'x' * {ours.nbytes}") < 2 * ours.nbytes


def test_failing_job_ends_the_run() -> None:
    measure = module("timing.jobs")
    with pytest.raises(SystemExit, match="ended with 3"):
        measure.run_once(measure.Job("x", [sys.executable, "-S", "-c", "raise SystemExit(3)"]))


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        ((0.01234,), "0.0123"),
        ((0.3, 0.1, 0.2), "0.200 (0.100-0.300)"),
        ((12.345, 12.345), "12.35 (12.35-12.35)"),
        ((float("nan"),), "-"),
    ],
)
def test_spread_is_written_as_median_and_range(seconds: tuple[float, ...], text: str) -> None:
    assert str(module("timing.jobs").Spread(seconds)).replace("12.34", "12.35") == text


def timing(whole: float, inner: float, **more: float) -> Any:
    """Return what one run took."""
    measure = module("timing.jobs")
    memory = more.pop("memory", float("nan"))
    parts = {name: measure.Spread((seconds,)) for name, seconds in more.items()}
    return measure.Timing(
        measure.Spread((whole,)), measure.Spread((inner,)), memory=memory, **parts
    )


def results() -> Any:
    """Return made-up results."""
    rendering = module("measures.rendering")

    rows = [
        rendering.Row("vtray", 1, timing(0.5, 0.2), "0.00, 0.00%"),
        rendering.Row("POV-Ray", 1, timing(2.0, 1.0), "0.30, 0.10%"),
        rendering.Row("Tachyon", 1, None, "not installed"),
    ]
    machine = {"date": "2000-01-01", "processor": "abacus", "vtray": "9.9", "POV-Ray": "3.7"}
    found = module("report.pages").Results(machine, 3)
    found.startup = {"`vtray --help`": timing(0.03, float("nan"))}
    found.scenes = {"a room": rows}
    found.threads = {1: timing(0.5, 0.2), 2: timing(0.4, 0.1)}
    return found


def test_report_has_all_times_and_ratios() -> None:
    report = module("report.pages").full_report(results())
    assert "| a room | vtray | 1 | 0.500 | 0.200 | 1.00 | 1.00 | 0.00, 0.00% |" in report
    assert "| a room | POV-Ray | 1 | 2.00 | 1.00 | 4.00 | 5.00 | 0.30, 0.10% |" in report
    assert "| a room | Tachyon | 1 | - | - | - | - | not installed |" in report
    assert "| `vtray --help` | 0.0300 | - |" in report
    assert "| 2 | 0.100 | 2.00 |" in report
    assert "| processor | abacus |" in report


def test_table_replaces_the_text_between_the_markers() -> None:
    report = module("report.pages")
    table = report.summary(results())
    assert "| scene | threads | vtray 9.9 | POV-Ray 3.7 | Tachyon |" in table
    assert "| a room | 1 | 0.500 (0.200) | 2.00 (1.00) | - |" in table
    readme = f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n"
    changed = report.replace_between_markers(readme, table)
    assert changed == f"before\n{report.BEGIN}\n{table}\n{report.END}\nafter\n"
    assert report.replace_between_markers(changed, table) == changed


def test_readme_without_markers_stays_as_it_is() -> None:
    report = module("report.pages")
    for text in ("no markers\n", report.BEGIN, f"{report.END} {report.BEGIN}"):
        assert report.replace_between_markers(text, "table") == text


def cube_results() -> Any:
    """Return made-up results for the cube."""
    rendering = module("measures.rendering")
    found = results()
    ours = timing(0.5, 0.2, load=0.05, build=0.1, memory=70e6)
    rows = [
        rendering.Row("vtray", 1, ours, "0.00, 0.00%"),
        rendering.Row("Embree", 1, timing(1.0, 0.3, load=0, build=0.4, memory=60e6), "0.01, 0.00%"),
        rendering.Row("OVITO, Tachyon", 1, timing(2.0, float("nan")), "another picture: dim"),
        rendering.Row("Tachyon", 1, None, "not installed"),
    ]
    found.cube = {"many": rows}
    found.cube_threads = {1: ours, 2: timing(0.4, 0.1, build=0.08)}
    ten_times = timing(5.0, 0.8, load=0.5, build=1.0, memory=700e6)
    found.scaling = {1000: rows, 10_000: [rendering.Row("vtray", 1, ten_times, "")]}
    return found


def test_report_has_the_cube() -> None:
    report = module("report.pages").full_report(cube_results())
    for row in (
        "| many | vtray | 1 | 0.500 | 0.0500 | 0.100 | 0.200 | 70 | 1.00 | 1.00 | 0.00, 0.00% |",
        "| many | Embree | 1 | 1.00 | 0.0000 | 0.400 | 0.300 | 60 | 2.00 | 1.50 | 0.01, 0.00% |",
        "| many | OVITO, Tachyon | 1 | 2.00 | - | - | - | - | 4.00 | - | another picture: dim |",
        "| many | Tachyon | 1 | - | - | - | - | - | - | - | not installed |",
        "| 2 | 0.0800 | 1.25 | 0.100 | 2.00 |",
    ):
        assert row in report


def test_report_has_the_growth_for_each_doubling() -> None:
    report = module("report.pages").full_report(cube_results())
    # Ten times as long for ten times as many is twice for twice; four times is 1.52 for twice.
    assert "| 10,000 | 1.00 | x 2.00 | 0.800 | x 1.52 | 5.00 | 700 |" in report
    assert "| 1,000 | 0.500 (0.200) | 1.00 (0.300) | 2.00 (-) | - |" in report
    assert "| 10,000 | 5.00 (0.800) | - | - | - |" in report


def test_table_of_all_scenes_has_the_cube_but_no_other_pictures() -> None:
    table = module("report.pages").summary(cube_results())
    assert "| many | 1 | 0.500 (0.200) | - | - | 1.00 (0.300) |" in table
    assert "OVITO" not in table


def test_readme_table_has_the_most_threads_and_no_empty_scene() -> None:
    rendering, found = module("measures.rendering"), cube_results()
    found.cube["many"].append(rendering.Row("vtray", 2, timing(0.4, 0.1), ""))
    found.scenes["a room"].append(rendering.Row("vtray", 2, timing(0.3, 0.1), ""))
    found.scenes[f"{module('scenes.few_objects').SCENES['empty'][0]}, 8 x 8"] = found.scenes[
        "a room"
    ]
    table = module("report.pages").readme_table(found)
    assert "| scene | vtray 9.9 | POV-Ray 3.7 | Tachyon |" in table
    assert "| many | 0.400 (0.100) | - | - | - | - |" in table
    assert "| a room | 0.300 (0.100) |" in table
    assert table.count("\n|") == 3
    assert "with 2 threads: the median of 3 runs on abacus (2000-01-01)" in table
    assert "OVITO" not in table


def test_results_are_read_as_they_were_kept(tmp_path: Path) -> None:
    kept, report = module("results"), module("report.pages")
    arrays, spread = module("measures.from_arrays"), module("timing.jobs").Spread((0.1, 0.3, 0.2))
    found = cube_results()
    found.arrays = {"many": [arrays.ArraysRow("vtray", 1, *[spread] * 3, memory=9e7, note="")]}
    found.copies = {"spheres": {1: timing(0.5, 0.25), 2: timing(0.3, 0.1)}}
    found.soft_light, found.whitted = soft_light(), whitted()
    kept.save_results(found, tmp_path / "results.json")
    again = kept.load_results(tmp_path / "results.json")
    assert report.full_report(again) == report.full_report(found)
    assert report.readme_table(again) == report.readme_table(found)
    assert again.scaling.keys() == {1000, 10_000}


def test_pages_show_the_results_that_are_kept() -> None:
    run, report = module("run"), module("report.pages")
    found = module("results").load_results(run.RESULTS)
    assert {page.name for page in run.WRITTEN} == {"README.md", "benchmarks.md"}
    for page, write in run.WRITTEN.items():
        text = page.read_text(encoding="utf-8")
        assert text.index(report.BEGIN) < text.index(report.END)
        written = report.replace_between_markers(text, write(found))
        assert text == written, f"{page.name}: run python benchmarks/run.py --write"


def test_scaling_is_drawn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    module("report.plot").draw_scaling(cube_results().scaling, tmp_path / "plot.png")
    with Image.open(tmp_path / "plot.png") as image:
        assert image.size == (1000, 500)


def test_cube_is_what_it_is_said_to_be() -> None:
    cube = module("scenes.cube")
    one, two = cube.make_cube(1000), cube.make_cube(1000)
    assert all(np.array_equal(a, b) for a, b in zip(one, two, strict=True))
    assert one.center.shape == one.color.shape == (1000, 3)
    assert -1 <= one.center.min() < -0.9
    assert 0.9 < one.center.max() <= 1
    assert one.radius == pytest.approx(0.056)


def test_cube_is_in_view_with_its_light_before_the_image_plane() -> None:
    corners = [
        {
            "type": "sphere",
            "center": dict(zip("xyz", corner, strict=True)),
            "radius": 0.03,
            "color": {"r": 1, "g": 2, "b": 3},
            "lambert": 1,
        }
        for corner in itertools.product((-1, 1), repeat=3)
    ]
    document = module("scenes.cube").scene_around(corners)
    seen = module("peers.camera_space").view_from_eye(vtray.loads(json.dumps(document)), 1.0)
    for surface in seen.surfaces[1:]:
        x, y, z = surface.center
        half = seen.width * seen.pixel_width / 2
        assert max(abs(x), abs(y)) + surface.shape < half * z
        assert z - surface.shape > document["camera"]["focus"]
    ((x, y, z), _), *others = seen.lights
    assert z > document["camera"]["focus"]
    assert x < -1
    assert y > 1
    assert not others


def test_spheres_as_arrays_are_seen_as_spheres_one_by_one(tmp_path: Path) -> None:
    cube, camera_space = module("scenes.cube"), module("peers.camera_space")
    many = camera_space.view_from_eye(vtray.load(cube.write_cube(50, tmp_path, 16)), 1.0)
    single = camera_space.view_from_eye(vtray.loads(cube.list_text(50, 16)), 1.0)
    (cloud,) = many.clouds
    assert len(many.surfaces) == 1
    balls = single.surfaces[1:]
    assert cloud.spheres == pytest.approx(np.array([(*b.center, b.shape) for b in balls]), abs=1e-6)
    colors = cloud.color * cloud.lambert / 255
    assert colors == pytest.approx(np.array([ball.color for ball in balls]), abs=1e-6)


@pytest.mark.parametrize(
    "name", ["peers.povray.program", "peers.tachyon.program", "peers.host.host"]
)
def test_spheres_as_arrays_are_written_as_those_one_by_one(name: str, tmp_path: Path) -> None:
    cloud = module("peers.camera_space").Cloud(
        np.array([[1, -2, 10, 3], [0.5, 2, 8, 0.25]], np.float32),
        np.array([[255, 0, 51], [0, 255, 0]], np.uint8),
        1.0,
    )
    surface = module("peers.camera_space").Surface
    balls = [
        surface(tuple(ball[:3]), ball[3], tuple(color))
        for ball, color in zip(cloud.spheres.tolist(), (cloud.color / 255).tolist(), strict=True)
    ]
    nothing = view()._replace(surfaces=[])
    written = []
    for seen in (nothing._replace(clouds=[cloud]), nothing._replace(surfaces=balls)):
        path = module(name).write_scene(seen, tmp_path)
        # Tachyon names the look of a sphere of its own.
        numbers = path.read_bytes().replace(b"TEXDEF", b"").split()
        written.append(sorted(n for n in numbers if b"look" not in n and n != b"TEXTURE"))
    assert written[0] == written[1]


def test_scene_of_hosts_is_read_as_it_was_written(tmp_path: Path) -> None:
    host, host_scene = module("peers.host.host"), module("peers.host.host_scene")
    written = host.to_host(view())
    found = host_scene.read_scene(host.write_scene(view(), tmp_path))
    assert (found.width, found.height) == (40, 20)
    assert (found.pixel_width, found.pixel_height) == pytest.approx((0.05, 0.1))
    for one, two in zip(found[4:], written[4:], strict=True):
        assert np.array_equal(one, two)
    assert found.planes.tolist() == [[0, 1, 0, -4, 0, 255, 0, 0]]
    assert found.spheres.tolist() == [[1, -2, 10, 3]]


def test_hosts_get_no_lights_that_a_plane_hides() -> None:
    seen = view()
    for lights, count in (([((0, -3, 9), 1.0)], 1), ([((0, -5, 9), 1.0)], 0), (seen.lights * 2, 2)):
        assert len(module("peers.host.host").to_host(seen._replace(lights=lights)).lights) == count


def test_peers_that_are_missing_are_said_to_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    embree, peer, peers = (
        module("peers.embree.program"),
        module("peers.peer"),
        module("peers.programs"),
    )
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("VTRAY_PEERS", str(tmp_path))
    caches = (embree.program, peer.version_of_host)
    for cache in caches:
        cache.cache_clear()
    try:
        assert {peers.describe(each) for each in peers.CUBE_PEERS} == {"not installed"}
    finally:
        for cache in caches:
            cache.cache_clear()


@pytest.fixture(scope="module")
def rendered() -> Any:
    """Return the picture of a few spheres."""
    with pytest.MonkeyPatch.context() as context:
        context.syspath_prepend(BENCHMARKS)
        text = module("scenes.cube").list_text(FEW, SMALL)
    return vtray.render(vtray.loads(text))


@once
@pytest.mark.parametrize("index", range(8))
def test_peer_that_is_installed_shows_what_vtray_shows(
    index: int, rendered: Any, tmp_path: Path
) -> None:
    peers, same = module("peers.programs"), module("timing.same_picture")
    peer = peers.CUBE_PEERS[index]
    if not peers.is_installed(peer):
        pytest.skip(f"{peer.name} is not installed")
    rendered.save(tmp_path / "ours.png")
    scene = vtray.load(module("scenes.cube").write_cube(FEW, tmp_path, SMALL))
    seen = module("peers.camera_space").view_from_eye(scene, 255 / float(rendered.linear.max()))
    job = module("measures.rendering")._peer_job(
        peer, peer.write_scene(seen, tmp_path), (SMALL, SMALL), 2
    )
    run = module("timing.jobs").run_once(job)
    found = same.difference(tmp_path / "ours.png", tmp_path / f"{job.name}.png", peer.column)
    assert found.mean < 255, "the size is another"
    if not peer.apart:
        assert same.is_same(found)
        assert 0 <= run.phases.load < 60
        assert 0 < run.phases.trace < 60


def test_report_has_the_times_of_samples() -> None:
    samples, measure = module("measures.antialiasing"), module("timing.jobs")

    def timing(seconds: float) -> Any:
        return measure.Timing(measure.Spread((0.2 + seconds,)), measure.Spread((seconds,)))

    found = results()
    found.samples = {
        samples.job_name(count, threads): timing(0.1 * count / threads)
        for count in samples.SAMPLES
        for threads in module("measures.rendering").THREADS
    }
    report = module("report.pages").full_report(found)
    assert "| 16 | 2 | 0.800 | 1.00 | 16 | 4.00 |" in report


def test_report_compares_own_scenes_with_the_first() -> None:
    found = results()
    found.bonds = {
        "atoms": {1: timing(0.4, 0.2, memory=80e6), 2: timing(0.3, 0.1, memory=90e6)},
        "bonds": {1: timing(1.0, 0.5, load=0.05, build=0.1, memory=120e6), 2: timing(0.6, 0.3)},
    }
    found.copies = {"spheres": {1: timing(0.5, 0.25, memory=8e7)}}
    report = module("report.pages").full_report(found)
    for row in (
        "| atoms | 1 | - | - | 0.200 | 0.400 | 80 | 1.00 | 1.00 | 1.00 |",
        "| bonds | 1 | 0.0500 | 0.100 | 0.500 | 1.00 | 120 | 2.50 | 2.50 | 1.50 |",
        "| bonds | 2 | - | - | 0.300 | 0.600 | - | 3.00 | 2.00 | - |",
        "| spheres | 1 | - | - | 0.250 | 0.500 | 80 | 1.00 | 1.00 | 1.00 |",
    ):
        assert row in report
    assert report.index("## Bonds") < report.index("## Copies")


@compiled_only
@pytest.mark.parametrize(("name", "scenes"), [("bonds", 2), ("copies", 4)])
def test_own_scenes_are_timed(
    name: str, scenes: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    measure = module(f"measures.{name}")
    write = measure.write_scenes
    monkeypatch.setattr(measure, "write_scenes", lambda *given: write(*given, SMALL))
    if name == "copies":
        monkeypatch.setattr(measure, "MANY", 5)
    found = getattr(measure, f"time_{name}")(FEW, (1, 2), tmp_path, 1)
    assert len(found) == scenes
    for by_threads in found.values():
        assert list(by_threads) == [1, 2]
        assert all(0 < each.inner.median < each.whole.median for each in by_threads.values())


@compiled_only
def test_movies_are_timed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("imageio_ffmpeg")
    pytest.importorskip("distributed")
    measure = module("measures.movies")
    monkeypatch.setattr(measure, "PROCESSES", 1)
    monkeypatch.setattr(measure, "is_installed", lambda _: False)
    found = results()
    found.movies["balls"] = rows = measure.time_movies(FEW, 2, SMALL, tmp_path, 1)
    assert [row.program for row in rows] == ["vtray", "vtray, 1 processes of a Dask cluster"]
    assert all(row.seconds.median > 0 and row.of_cores.median > 0 for row in rows)
    report = module("report.pages").full_report(found)
    assert "\n## Movies\n\n| movie | program | frames |" in report
    assert "\n| balls | vtray | 2 | " in report


@compiled_only
def test_paths_of_all_programs_find_the_same_light(tmp_path: Path) -> None:
    measure = module("measures.paths")
    found = results()
    rows = measure.time_paths(FEW, SMALL, (1,), tmp_path, 1)
    found.paths = measure.Paths({"balls": rows}, "On a busy machine.")
    own, more, *others = rows
    assert [row[:2] for row in (own, more)] == [("vtray", 16), ("vtray", 64)]
    assert [row.program for row in others] == [
        name for name, host in measure.HOSTS.items() if host.is_installed()
    ]
    assert 1.5 < own.error / more.error < 3
    for row in others:
        assert row.light == pytest.approx(more.light, abs=0.004)
        assert row.error == pytest.approx(own.error, rel=0.5)
    report = module("report.pages").full_report(found)
    seconds = more.tracing[1].median * (100 * more.error) ** 2
    assert f"| balls | vtray | 64 | {more.light:.4f} | {100 * more.error:.2f} | " in report
    assert f" | {module('timing.jobs').in_seconds(seconds)} |\n" in report
    assert "\nOn a busy machine.\n" in f"{report}\n"


def test_error_is_that_of_one_of_two_pictures() -> None:
    generator = np.random.default_rng(3)
    pictures = 0.5 + 0.02 * generator.normal(size=(2, 64, 64, 3))
    light, error = module("measures.paths").light_and_error(*pictures)
    assert light == pytest.approx(0.5, abs=0.001)
    assert error == pytest.approx(0.02, rel=0.05)


def test_paths_scene_of_embree_is_seen_along_z(tmp_path: Path) -> None:
    lamps, program = module("scenes.lamps"), module("peers.embree.program")
    scene = lamps.sky_scene(FEW, SMALL)
    given = lamps.for_mitsuba(scene, lamps.lamps()["sky"])
    program.write_paths_scene(given, tmp_path / "scene")
    written = module("peers.host.host_scene").read_scene(tmp_path / "scene")
    # Seen from the eye, a ball is as far to the right and above as vtray has it.
    camera = scene.camera
    for row, at in ((0, 0), (FEW - 1, FEW - 1)):
        column, line = camera.project(scene.objects[0].center[at : at + 1])[0][:2]
        x, y, _, radius = written.spheres[row]
        assert radius == 1
        assert x / written.pixel_width + SMALL / 2 == pytest.approx(column, abs=0.01)
        assert SMALL / 2 - y / written.pixel_height == pytest.approx(line, abs=0.01)
    (floor,) = written.planes
    below = floor[:3] @ written.spheres[:, :3].T - floor[3]
    np.testing.assert_allclose(below, given.spheres[:, 1] - given.floor, atol=0.01)


@once
def test_copied_cubes_are_seen_as_those_written_out() -> None:
    cube = module("scenes.copied_cube")
    copied, written = (cube.make_scene(FEW, 2, SMALL, written_out=out) for out in (False, True))
    assert (len(copied.objects[0]), len(written.objects[0])) == (8, 8 * FEW)
    pictures = [vtray.render(scene).linear for scene in (copied, written)]
    np.testing.assert_array_equal(*pictures)
    assert len(np.unique(pictures[0])) > FEW


def test_ball_and_stick_model_is_what_it_is_said_to_be(tmp_path: Path) -> None:
    ball = module("scenes.ball_and_stick")
    atoms, (start, end) = ball.make_crystal(1000)
    assert (atoms.shape, start.shape) == ((1000, 3), (2000, 3))
    np.testing.assert_allclose(np.linalg.norm(end - start, axis=1), 1)
    apart = np.linalg.norm(atoms[:, None] - atoms, axis=2)
    assert apart[~np.eye(1000, dtype=bool)].min() == pytest.approx(1)
    # Each atom within has four bonds.
    from_middle = np.linalg.norm(atoms, axis=1)
    ends = np.concatenate([start, end])
    for atom in atoms[from_middle < 0.7 * from_middle.max()][::20]:
        assert (np.linalg.norm(ends - atom, axis=1) < 1e-9).sum() == 4
    alone, both = (vtray.load(path) for path in ball.write_scenes(1000, tmp_path, SMALL).values())
    assert both.objects[: len(alone.objects)] == alone.objects
    assert (both.camera, both.lights) == (alone.camera, alone.lights)
    assert len(both.objects[-1]) == 2000  # type: ignore[arg-type]


def soft_light() -> Any:
    """Return made-up results for soft light."""
    soft, spread = module("measures.soft_light"), module("timing.jobs").Spread
    rows = [
        soft.SkyRow("vtray", "tolerance 0.03", 0.0123, {1: spread((0.4,)), 2: spread((0.2,))}),
        soft.SkyRow("Mitsuba", "16 samples", float("nan"), {}),
    ]
    studio = {"a molecule": soft.StudioRow(spread((1.5,)), 25_000_000, 0.625)}
    lamps = {"moon": soft.Difference(-0.0002, 0.0001, 0.003, 0.0005), "sun": None}
    return soft.SoftLight(lamps, {"a cube": rows}, studio)


def test_report_has_soft_light() -> None:
    found = results()
    found.soft_light = soft_light()
    report = module("report.pages").full_report(found)
    for row in (
        "| moon | -0.0200 | -2.0 | 0.30 | 0.05% |",
        "| sun | Mitsuba is not installed | - | - | - |",
        "| scene | program | with | error, % of white | tracing, 1 thread | tracing, 2 threads |",
        "| a cube | vtray | tolerance 0.03 | 1.23 | 0.400 | 0.200 |",
        "| a cube | Mitsuba | 16 samples | not installed | - | - |",
        "| a molecule | 1.50 | 25.0 | 0.62 |",
    ):
        assert row in report


def whitted() -> Any:
    """Return made-up results for mirrors and glass."""
    measure = module("measures.whitted")
    apart = {"with vtray's rules": measure.Apart(1e-6, 2.5e-6, 0.0012)}
    timings = {"vtray": {2: timing(2.0, 0.5)}, "POV-Ray": {2: timing(1.0, 1.0)}}
    return measure.Whitted(1024, apart, timings, "On a busy machine.")


def test_report_has_mirrors_and_glass() -> None:
    found = results()
    found.whitted = whitted()
    report = module("report.pages").full_report(found)
    for row in (
        "| with vtray's rules | 0.0000010 | 0.0000025 | 0.12% |",
        "| POV-Ray | 2 | 1.00 | 1.00 | 0.50 | 2.00 |",
        "On a busy machine.",
    ):
        assert f"\n{row}\n" in f"{report}\n"
    found.whitted.apart = {}
    assert "\n| not installed | - | - | - |\n" in module("report.pages").full_report(found)


@compiled_only
def test_mirrors_and_glass_are_those_of_povray(tmp_path: Path) -> None:
    """To half a step of 16 bits, and where it keeps its rules, in shadows and mirrors alone."""
    measure, side = module("measures.whitted"), 40
    found = measure.measure_whitted(side, (2,), tmp_path, 1)
    assert all(0 < by_threads[2].inner.median < 60 for by_threads in found.timings.values())
    if not module("peers.programs").is_installed(module("peers.povray.program").PEER):
        assert (found.apart, found.timings.keys()) == ({}, {"vtray"})
        pytest.skip("POV-Ray is not installed")
    same, *others = found.apart.values()
    assert same.largest < 0.51 / 65535 + 1e-6
    assert same.share == 0
    assert all(other.largest > 0.1 and 0.001 < other.share < 0.1 for other in others)


def test_scenes_of_mirrors_are_given_to_povray_with_the_rules_asked_for(tmp_path: Path) -> None:
    mirrors, scene = module("peers.povray.mirrors"), module("scenes.mirror_and_glass").make_scene(8)
    texts = []
    for rules in (mirrors.Rules(True, True), mirrors.Rules(False, False)):
        mirrors.write_scene(scene, tmp_path / "a.pov", 8, rules)
        texts.append((tmp_path / "a.pov").read_text())
    assert ["no_image" in text for text in texts] == [True, False]
    assert ["clipped_by" in text for text in texts] == [True, False]
    assert all(text.count("sphere {") == 5 + ("no_image" in text) for text in texts)
    assert all("max_trace_level 9 " in text and "interior { ior 1.5 }" in text for text in texts)


def test_difference_is_told_from_noise() -> None:
    generator = np.random.default_rng(1)
    ours, theirs = (0.5 + 0.02 * generator.normal(size=(n, 8, 8, 3)) for n in (64, 128))
    measure = module("measures.soft_light")
    found = measure.difference(ours, theirs)
    assert abs(found.mean) < 4 * found.mean_error
    assert found.mean_error == pytest.approx(0.02 * (1 / 64 + 1 / 128) ** 0.5 / 192**0.5, rel=0.3)
    assert found.pixel_error == pytest.approx(0.02 * (1 / 64 + 1 / 128) ** 0.5, rel=0.05)
    assert found.far <= 1 / 64
    theirs[:, 3, :4, 1] += 0.05
    found = measure.difference(ours, theirs)
    assert found.far == 4 / 64
    assert found.mean == pytest.approx(-0.05 * 4 / 192, abs=4 * found.mean_error)


@once
def test_lamps_are_given_to_mitsuba_with_the_rays_of_the_picture(tmp_path: Path) -> None:
    made, soft_scene = module("scenes.lamps"), module("peers.host.soft_scene")
    name, lamp = next(iter(made.lamps().items()))
    scene = made.lamp_scene(lamp.light)
    scene.camera = scene.camera.resized((16, 12))
    soft_scene.write_scene(made.for_mitsuba(scene, lamp), tmp_path / "lamp.npz")
    found = soft_scene.read_scene(tmp_path / "lamp.npz")
    assert json.loads(found.lamp) == lamp.plugin, name
    assert (found.floor, found.reflectance, found.emitter_samples) == (0.0, 0.8, 1)
    # Nearest of what the rays meet.
    starts = found.starts[:, :, None]
    arms = found.spheres[:, :3] - starts
    along = arms @ found.way
    inside = found.spheres[:, 3] ** 2 - (arms**2).sum(axis=-1) + along**2
    entered = np.where(inside > 0, along - np.sqrt(np.maximum(inside, 0)), np.inf)
    floor = (found.floor - found.starts[..., 1]) / found.way[1]
    nearest = np.minimum(entered.min(axis=-1), floor)
    scene.lights = [vtray.Ambient()]
    depth = vtray.render(scene, tolerance=1.0).depth
    moved = depth - nearest
    np.testing.assert_allclose(moved, moved[0, 0], rtol=1e-9)
    assert (entered.min(axis=-1) < floor).mean() > 0.2


def test_pictures_of_skies_are_written_with_rows_between() -> None:
    made = module("scenes.lamps")
    lamp = made.lamps()["picture of a sky with a sun"]
    pixels = lamp.light.image.pixels
    np.testing.assert_array_equal(lamp.sky[1::2], pixels)
    np.testing.assert_array_equal(lamp.sky[2:-1:2], (pixels[1:] + pixels[:-1]) / 2)
    np.testing.assert_array_equal(lamp.sky[[0, -1]], pixels[[0, -1]])


def test_clouds_are_what_they_are_said_to_be() -> None:
    clouds = module("scenes.clouds")
    for kind in clouds.CLOUDS:
        (one, radius), (two, _) = (clouds.CLOUDS[kind](1000) for _ in range(2))
        np.testing.assert_array_equal(one, two)
        assert (one.shape, radius.shape) == ((1000, 3), (1000,))
        assert len(lights_of(clouds.make_scene(kind, 20, SMALL))) == 6


@compiled_only
def test_soft_light_is_measured_without_mitsuba(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    measure = module("measures.soft_light")
    monkeypatch.setattr(measure, "is_installed", lambda _: False)
    sizes = measure.Sizes(2, 4, (FEW,), SMALL, 4, (FEW,), SMALL)
    found = measure.measure_soft_light(sizes, (1, 2), tmp_path, 1)
    assert set(found.lamps.values()) == {None}
    (rows,) = found.sky.values()
    ours = [row for row in rows if row.program == "vtray"]
    errors = [row.error for row in ours]
    assert errors == sorted(errors, reverse=True)
    assert 0 < errors[-1] < 0.008
    assert all(0 < row.tracing[n].median < 60 for row in ours for n in (1, 2))
    assert all(np.isnan(row.error) and not row.tracing for row in rows if row not in ours)
    for row in found.studio.values():
        assert 0 < row.error < 12  # of edges, too, of which small pictures are full
        assert row.rays > SMALL**2


def test_report_has_the_times_from_arrays() -> None:
    arrays, measure = module("measures.from_arrays"), module("timing.jobs")

    def row(program: str, factor: float, note: str) -> Any:
        spreads = [measure.Spread((factor * seconds,)) for seconds in (0.5, 0.3, 0.2)]
        return arrays.ArraysRow(program, 2, *spreads, memory=90e6, note=note)

    found = results()
    found.arrays = {"many": [row("vtray", 1, "0.00, 0.00%"), row("Mitsuba", 3, "0.30, 0.20%")]}
    report = module("report.pages").full_report(found)
    assert "| many | vtray | 2 | 0.200 | 0.300 | 0.500 | 90 | 1.00 | 1.00 | 0.00, 0.00% |" in report
    assert (
        "| many | Mitsuba | 2 | 0.600 | 0.900 | 1.50 | 90 | 3.00 | 3.00 | 0.30, 0.20% |" in report
    )
    found.arrays["many"].append(row("OVITO", 4, "another picture: dim"))
    found.scenes = {"a room": [module("measures.rendering").Row("vtray", 2, timing(0.3, 0.1), "")]}
    sentence = "(many): vtray 0.300; Mitsuba 0.900; OVITO 1.20 (another picture)."
    assert sentence in module("report.pages").readme_table(found)


@once
@pytest.mark.parametrize("index", range(4))
def test_script_makes_the_picture_from_arrays(index: int, tmp_path: Path) -> None:
    arrays, cube = module("measures.from_arrays"), module("scenes.cube").make_cube(FEW)
    script = arrays.SCRIPTS[index]
    if script.peer and not module("peers.programs").is_installed(script.peer):
        pytest.skip(f"{script.name} is not installed")
    data = tmp_path / "arrays.npz"
    given = module("peers.arrays_clock").Arrays(cube.center.astype(float), cube.radius, cube.color)
    module("peers.arrays_clock").save_arrays(given, data)
    run = module("timing.jobs").run_once(arrays._job(script, data, SMALL, 2, 3))
    assert len(arrays.picture_seconds(run.output)) == 3
    module("timing.jobs").run_once(arrays._job(arrays.SCRIPTS[0], data, SMALL, 1, 1))
    pictures = [arrays._picture(tmp_path, each) for each in (arrays.SCRIPTS[0], script)]
    found = module("timing.same_picture").difference(*pictures)
    assert found.mean < 255, "the size is another"
    if not (script.peer and script.peer.apart):
        assert module("timing.same_picture").is_same(found)
