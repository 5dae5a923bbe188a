"""The benchmarks: scenes for other renderers, and tables; none of these renderers is needed."""

import importlib
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray

BENCHMARKS = Path(__file__).resolve().parent.parent / "benchmarks"
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
    assert Path(str(found.__file__)).parent == BENCHMARKS
    return found


def view() -> Any:
    """Return the scene, twice as bright, as other renderers see it."""
    return module("camera_space").view_from_eye(vtray.loads(json.dumps(SCENE)), 2.0)


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
    seen = module("camera_space").view_from_eye(scene, 1.0)
    # The eye is at (-2, 0, 2); right is -z, up is -y, forward is x.
    assert seen.surfaces[0].center == pytest.approx((-8, -2, 3))


def test_povray_scene() -> None:
    assert module("povray").export(view()).splitlines() == [
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
    lines = module("tachyon").export(view()).splitlines()
    assert lines[:2] == ["BEGIN_SCENE", "RESOLUTION 40 20"]
    assert "  ZOOM 0.5" in lines
    assert "LIGHT CENTER 1.0 5.0 6.0 RAD 1e-9 COLOR 1.0 1.0 1.0" in lines
    assert "SPHERE CENTER 1.0 -2.0 10.0 RAD 3.0 look0" in lines
    assert "PLANE CENTER 0.0 -4.0 0.0 NORMAL 0.0 1.0 0.0 look1" in lines
    assert lines[-1] == "END_SCENE"


@pytest.mark.parametrize(
    ("name", "output"),
    [
        ("povray", "  Trace Time:       0 hours  0 minutes  0 seconds (0.224 seconds)\n"),
        ("tachyon", "  Ray Tracing Time:     0.2240 seconds\n"),
        ("vtray_process", "pack            0.1000 s\ntrace           0.2240 s\n"),
    ],
)
def test_trace_seconds_are_read_from_the_output(name: str, output: str) -> None:
    assert module(name).trace_seconds(output) == 0.224
    assert np.isnan(module(name).trace_seconds("something else"))


def test_scenes_are_valid_and_always_the_same() -> None:
    for _, make, _ in module("scenes").SCENES.values():
        assert make(16) == make(16)
        assert vtray.loads(json.dumps(make(16))).camera.size == (16, 16)


def test_room_is_what_it_is_said_to_be() -> None:
    scene = vtray.loads(json.dumps(module("scenes").room(16)))
    assert len(scene.lights) == 64
    assert sum(isinstance(item, vtray.Sphere) for item in scene.objects) == 4
    assert sum(isinstance(item, vtray.Plane) for item in scene.objects) == 5


def test_brighter_picture_is_the_same_and_mirrored_one_is_not(tmp_path: Path) -> None:
    ramp = np.arange(0, 120, 2).repeat(24).reshape(-1, 8, 3).astype(np.uint8)
    pictures = {"dark": ramp, "bright": ramp * 2, "mirrored": ramp[::-1]}
    for name, pixels in pictures.items():
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    same = module("same_picture")
    dark = tmp_path / "dark.png"
    assert same.is_same(same.difference(dark, tmp_path / "bright.png"))
    assert not same.is_same(same.difference(dark, tmp_path / "mirrored.png"))


def test_jobs_are_interleaved_and_timed(tmp_path: Path) -> None:
    measure = module("measure")
    log = tmp_path / "log"

    def job(name: str) -> Any:
        code = f"open({str(log)!r}, 'a').write({name!r}); print('inner 1.5')"
        command = [sys.executable, "-S", "-c", code]
        return measure.Job(name, command, lambda output: float(output.split()[1]))

    timings = measure.run_interleaved([job("a"), job("b")], 2)
    assert log.read_text() == "abab"
    assert timings["a"].inner.median == 1.5
    assert 0 < timings["b"].whole.median < 60


def test_failing_job_ends_the_run() -> None:
    measure = module("measure")
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
    assert str(module("measure").Spread(seconds)).replace("12.34", "12.35") == text


def results() -> Any:
    """Return made-up results."""
    measure, rendering = module("measure"), module("rendering")

    def timing(whole: float, inner: float) -> Any:
        return measure.Timing(measure.Spread((whole,)), measure.Spread((inner,)))

    rows = [
        rendering.Row("vtray", 1, timing(0.5, 0.2), "0.00, 0.00%"),
        rendering.Row("POV-Ray", 1, timing(2.0, 1.0), "0.30, 0.10%"),
        rendering.Row("Tachyon", 1, None, "not installed"),
    ]
    machine = {"date": "2000-01-01", "processor": "abacus", "vtray": "9.9", "POV-Ray": "3.7"}
    found = module("report").Results(machine, 3)
    found.startup = {"`vtray --help`": timing(0.03, float("nan"))}
    found.scenes = {"a room": rows}
    found.threads = {1: timing(0.5, 0.2), 2: timing(0.4, 0.1)}
    return found


def test_report_has_all_times_and_ratios() -> None:
    report = module("report").full_report(results())
    assert "| a room | vtray | 1 | 0.500 | 0.200 | 1.00 | 1.00 | 0.00, 0.00% |" in report
    assert "| a room | POV-Ray | 1 | 2.00 | 1.00 | 4.00 | 5.00 | 0.30, 0.10% |" in report
    assert "| a room | Tachyon | 1 | - | - | - | - | not installed |" in report
    assert "| `vtray --help` | 0.0300 | - |" in report
    assert "| 2 | 0.100 | 2.00 |" in report
    assert "| processor | abacus |" in report


def test_readme_table_replaces_the_text_between_the_markers() -> None:
    report = module("report")
    table = report.summary(results())
    assert "| scene | threads | vtray 9.9 | POV-Ray 3.7 | Tachyon |" in table
    assert "| a room | 1 | 0.500 (0.200) | 2.00 (1.00) | - |" in table
    readme = f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n"
    changed = report.replace_between_markers(readme, table)
    assert changed == f"before\n{report.BEGIN}\n{table}\n{report.END}\nafter\n"
    assert report.replace_between_markers(changed, table) == changed


def test_readme_without_markers_stays_as_it_is() -> None:
    report = module("report")
    for text in ("no markers\n", report.BEGIN, f"{report.END} {report.BEGIN}"):
        assert report.replace_between_markers(text, "table") == text
