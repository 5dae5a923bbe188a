"""The command with files of data in place of scenes."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from conftest import compiled_only
from vtray.base.errors import SceneError
from vtray.commands import cli, data_scene
from vtray.commands.annotation_options import annotations_of
from vtray.commands.data_options import joined
from vtray.commands.data_scene import load_data
from vtray.commands.options import parse
from vtray.figures.annotations import Annotations
from vtray.figures.painted.picture import share_beside
from vtray.scene.camera import Camera
from vtray.scene.default_light import settings_of
from vtray.scene.grain import LITTLE_GRAIN, NO_GRAIN
from vtray.scene.scene import Scene

WATER = """3
Lattice="6 0 0 0 6 0 0 0 6" Properties=species:S:1:pos:R:3:charge:R:1
O 0 0 0 -0.8
H 0.76 0.59 0 0.4
H -0.76 0.59 0 0.4
3
Lattice="6 0 0 0 6 0 0 0 6" Properties=species:S:1:pos:R:3:charge:R:1
O 1 0 0 -0.8
H 1.76 0.59 0 0.4
H 0.24 0.59 0 0.5
"""


@pytest.fixture
def water(tmp_path: Path) -> Path:
    """Return a file of two frames of a molecule in a cell."""
    path = tmp_path / "water.xyz"
    path.write_text(WATER)
    return path


def scene_of(*arguments: object) -> Scene:
    """Return the scene that the command makes of data."""
    return load_data(parse([*map(str, arguments), "picture.png"]))[0]


def rightmost(scene: Scene) -> float:
    """Return the column of the rightmost of many points on the spheres of a scene."""
    (spheres,) = scene.objects
    around = np.random.default_rng(3).normal(size=(2000, 3))
    around /= np.linalg.norm(around, axis=1, keepdims=True)
    radii = np.broadcast_to(spheres.radius, len(spheres))
    pairs = zip(spheres.center, radii, strict=True)
    return max(
        scene.camera.project(center + radius * around)[:, 0].max() for center, radius in pairs
    )


def test_data_becomes_a_scene(water: Path) -> None:
    spheres, edges, corners = scene_of(water).objects
    assert spheres.color[0].tolist() == [255, 13, 13]
    assert (len(edges), len(corners)) == (12, 8)
    last = scene_of(water, "--frame", "-1", "--no-cell", "--color", "charge", "--clim", "-1,1")
    assert [len(item) for item in last.objects] == [3]
    assert last.objects[0].center[0].tolist() == [1, 0, 0]
    assert (last.objects[0].color_scale.low, last.objects[0].color_scale.high) == (-1, 1)
    assert last.camera.size == (1024, 1024)
    bound = scene_of(water, "--cutoff", "1.2", "--wrap", "--replicate", "2,1,1", "--no-cell")
    assert [len(item) for item in bound.objects] == [6, 6]
    again = scene_of(water, "--boundary", "--no-cell")
    assert [len(item) for item in again.objects] == [3, 8]
    dashed = scene_of(water, "--hydrogen-bonds", "--no-cell")
    assert [len(item) for item in dashed.objects] == [3, 2, 0]
    shining = scene_of(water, "--emission", "z", "--stretch", "log", "--peak", "2")
    (stars,) = shining.objects
    assert (stars.stretch, stars.softening, stars.peak) == ("log", None, 2)
    points = scene_of(water, "--style", "points", "--no-cell", "--size", "80x60")
    assert points.camera.size == (80, 60)


@pytest.mark.parametrize(
    "given",
    [
        ("--no-cell", "--legend"),
        ("--color", "z", "--color-bar=charge"),
        ("--replicate", "3,1,2", "--boundary", "--orthographic"),
    ],
)
def test_points_are_as_large_as_pixels_of_the_picture(water: Path, given: tuple[str, ...]) -> None:
    scene = scene_of(water, "--style", "points", "--size", "200x100", *given)
    camera, points = scene.camera, scene.objects[0]
    away = camera.normal.x, camera.normal.y, camera.normal.z
    side = np.cross(away, (0, 0, 1))
    side /= np.linalg.norm(side)
    radii = np.broadcast_to(points.radius, len(points))
    ends = camera.project(points.center + radii[:, None] * side)
    assert ends[:, 0] - camera.project(points.center)[:, 0] == pytest.approx(0.75, abs=1e-6)


def test_large_balls_have_less_grain(water: Path) -> None:
    def tolerance(*options: str) -> float:
        return settings_of(scene_of(water, "--no-cell", "--orthographic", *options)).tolerance

    assert tolerance() == 0.012
    assert tolerance("--size", "4x3") == 0.06
    # Of three balls of 0.35 and 0.66, most of what is seen is the large one.
    middle = [tolerance("--size", f"{4 * k}x{3 * k}") for k in (3, 4, 5, 20)]
    pixels = [NO_GRAIN / middle[0] * k / 3 for k in (3, 4, 5, 20)]
    expected = [max(NO_GRAIN / radius, LITTLE_GRAIN / radius**0.5) for radius in pixels]
    assert middle == pytest.approx(expected, rel=0.05)
    assert 0.012 < middle[3] < middle[0] < 0.06
    assert tolerance("--emission", "z") == 0.06


def test_views(water: Path) -> None:
    def looks(*view: str) -> tuple[float, ...]:
        normal = scene_of(water, "--no-cell", *view).camera.normal
        return normal.x, normal.y, normal.z

    assert looks("--view", "-x") == (1, 0, 0)
    assert looks("--view=top") == (0, 0, -1)
    assert looks("--view", "-90,0") == (0, 1, 0)
    assert looks() == looks("--view", "-65,20")
    shape = Camera.fit(scene_of(water, "--no-cell"), view="auto").normal
    assert looks("--view", "auto") == pytest.approx((shape.x, shape.y, shape.z))
    near, far = (scene_of(water, *zoom).camera for zoom in (["--zoom", "2"], []))
    assert near.resolution[0] * 2 == far.resolution[0]
    assert scene_of(water, "--orthographic").camera.projection == "orthographic"


@pytest.mark.parametrize("style", ["spacefill", "points"])
def test_a_cell_that_is_left_out_is_told_of_once(style: str, tmp_path: Path) -> None:
    path = tmp_path / "beside.xyz"
    path.write_text('1\nLattice="4 0 0 0 4 0 0 0 4"\nO -3 1 1\n')
    scene_of(path, "--style", style, "--no-cell")
    with pytest.warns(UserWarning, match=r"cell: not drawn, .*--wrap.*--cell") as found:
        assert len(scene_of(path, "--style", style).objects) == 1
    assert len(found) == 1


def test_particles_that_are_lost_in_their_cell(tmp_path: Path) -> None:
    def shown(edge: float, *options: str) -> Scene:
        path = tmp_path / "lost.xyz"
        lattice = f"{edge} 0 0 0 {edge} 0 0 0 {edge}"
        path.write_text(f'2\nLattice="{lattice}"\nO 1 1 1\nO 1 2.2 1\n')
        return scene_of(path, *options)

    words = r"lost\.xyz: the particles are 0\.07\d* times as wide as their cell; --no-cell shows"
    with pytest.warns(UserWarning, match=words):
        assert len(shown(60).objects) == 3
    # What is asked for, or large enough, needs no words.
    shown(60, "--cell")
    shown(60, "--no-cell")
    shown(20)
    shown(60, "--replicate", "20,1,1")
    shown(0)


def test_nothing_but_a_cell(water: Path) -> None:
    none = ["--select", "charge > 9", "--legend", "--boundary", "--bonds"]
    words = "water.xyz: --select: none of the 3 particles; the cell alone is shown"
    with pytest.warns(UserWarning, match=words):
        scene = scene_of(water, *none)
    assert [len(item) for item in scene.objects] == [0, 0, 12, 8]
    options = parse([*none, str(water), "picture.png"])
    with pytest.warns(UserWarning, match=words):
        marks = load_data(options)[1]
    assert annotations_of(options, marks)["legend"] is None
    empty = water.with_name("empty.xyz")
    empty.write_text('0\nLattice="6 0 0 0 6 0 0 0 6"\n')
    scene = scene_of(empty, "--style", "points", "--legend")
    assert [len(item) for item in scene.objects] == [0, 12, 8]


@pytest.mark.parametrize("style", ["spacefill", "points"])
def test_nothing_at_all(style: str, tmp_path: Path) -> None:
    path = tmp_path / "few.xyz"
    path.write_text("0\n\n2\n\nC 0 0 0\nC 1 0 0\n")
    with pytest.raises(SceneError, match=r"few.xyz: frame 0: expected particles, got none, nor a"):
        scene_of(path, "--style", style, "--legend")
    some = "--style", style, "--frame=1", "--select"
    with pytest.raises(SceneError, match=r"few.xyz: --select: expected some of the 2 particles"):
        scene_of(path, *some, "x > 1")
    assert len(scene_of(path, *some, "x > 0").objects[0]) == 1


def test_values_that_look_like_options() -> None:
    given = ["--view", "-x", "--clim", "-1,1", "-t", "2", "--view", "--zoom", "2"]
    assert joined(given) == ["--view=-x", "--clim=-1,1", "-t", "2", "--view", "--zoom", "2"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--frame", "2"], "DATA: frame 2: there are 2 frames; expected -2 to 1"),
        (["--color", "chrage"], "DATA: color: expected a colour or the name of a column, got "),
        (["--style", "ball"], "argument --style: invalid choice: 'ball' (choose from "),
        (
            ["--replicate", "2"],
            "argument --replicate: expected three integers such as 3,3,1, got 2",
        ),
        (["--view", "up"], "argument --view: expected x, -x, y, -y, z, -z, top, bottom, "),
        (["--clim", "1"], "argument --clim: expected two numbers such as -1,1, got 1"),
        (["--zoom", "0"], "argument --zoom: expected a number from 1e-9 to 1e9, got 0"),
        (["--zoom", "1e300"], "argument --zoom: expected a number from 1e-9 to 1e9, got 1e300"),
        (["--scale", "1e200"], "argument --scale: expected a number from 1e-20 to 1e20, got"),
        (["--label", "nam"], "DATA: --label: no column 'nam'; there are x, y, z, element, charge"),
        (["--label", "1,2,:a"], "argument --label: expected x,y,z:TEXT such as 0,0,1.5:top, or"),
        (["--emission", "mass"], "DATA: emission: expected a number or the name of a column, got"),
        (["--emission", "charge"], "DATA: add_particles: emission[0]: expected a number ≥ 0, got"),
        (["--emission", "z", "--bonds"], "DATA: bonds: points that shine have none; leave out"),
        (
            ["--softening", "0"],
            "argument --softening: expected a number from 1e-9 to 1e9, got 0",
        ),
        (["--frame", "1.5"], "argument --frame: expected an integer such as 0, or -1 for the last"),
        (["--boundary=1"], "argument --boundary: expected a part of the cell's edge, up to 0.5"),
        (["--no-bonds", "--cutoff", "2"], "--no-bonds and --cutoff: expected one of them"),
        (["--replay", "a.png"], "--replay is for scene files, and DATA is none; "),
    ],
)
def test_errors(
    arguments: list[str], message: str, water: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli.run([str(water), str(water.with_name("out.png")), *arguments]) == 1
    out, error = capfd.readouterr()
    assert out == ""
    assert error.startswith("Error: " + message.replace("DATA", str(water)))
    assert error.count("\n") == 1


def test_options_of_data_are_not_for_scenes(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "scene.json"
    assert cli.run([str(scene), "out.png", "--hydrogen-bonds"]) == 1
    words = f"--hydrogen-bonds is for files of data, and {scene} is a scene"
    assert capfd.readouterr().err == f"Error: {words}\n"
    assert cli.run([str(scene), "out.png", "--label", "name"]) == 1
    words = "--label: expected x,y,z:TEXT, got name; columns are those of files of data"
    assert capfd.readouterr().err == f"Error: {words}\n"


def test_radius_is_another_word(water: Path) -> None:
    one, other = (scene_of(water, flag, "0.5", "--no-cell") for flag in ("--radii", "--radius"))
    assert one.objects == other.objects
    assert one.objects[0].radius == 0.5


def test_labels_of_data(water: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given = ["--label", "element", "--label", "-1,0,2:A: b", "--label=charge", "--select", "x != 0"]
    options = parse([*given, str(water), "picture.png"])
    scene, of_data = load_data(options)
    labels = annotations_of(options, of_data)["labels"]
    assert labels[0] == ("A: b", (-1, 0, 2))
    assert [text for text, _ in labels[1:]] == ["H", "H", "0.4", "0.4"]
    assert [point for _, point in labels[1:3]] == [
        tuple(place) for place in scene.objects[0].center.tolist()
    ]
    assert of_data["hide_labels"]
    twice = load_data(parse(["--label=z", "--replicate=1,2,1", str(water), "picture.png"]))[1]
    assert len(twice["labels"]) == 6
    again = load_data(parse(["--label=element", "--boundary", str(water), "picture.png"]))[1]
    assert [text for text, _ in again["labels"]].count("O") == 8
    monkeypatch.setattr(data_scene, "MOST_LABELS", 2)
    with pytest.raises(SceneError, match="--label z: expected at most 2 particles to label, got 3"):
        scene_of(water, "--label", "z")


def test_columns_are_listed(water: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.run([str(water), "--columns", "--frame", "1"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0] == "3 particles, frame 1"
    assert "element     names: H, O" in lines
    assert "charge      float64, from -0.8 to 0.5" in lines
    assert lines[-1] == "cell c      0, 0, 6"


def test_columns_of_some(water: Path, capfd: pytest.CaptureFixture[str]) -> None:
    arguments = [str(water), "--columns", "--select"]
    assert cli.run([*arguments, "element == 'H'"]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0] == "2 of 3 particles, frame 0"
    assert "element     names: H" in lines
    assert cli.run([*arguments, "element = 'H'"]) == 1
    assert capfd.readouterr().err.startswith(f"Error: {water}: select \"element = 'H'\": at 9: ")


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        ("0,0,0,1\n1,0,0,\n2,0,0,3\n", "mass        float64, from 1 to 3, 1 NaN"),
        ("0,0,0,\n1,0,0,nan\n", "mass        float64, 2 NaN"),
    ],
)
def test_columns_that_lack_numbers(
    rows: str, line: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "some.csv"
    path.write_text("x,y,z,mass\n" + rows)
    assert cli.run([str(path), "--columns"]) == 0
    assert capfd.readouterr().out.splitlines()[-1] == line


def test_highlighting_nothing_is_warned_of(water: Path) -> None:
    words = "water.xyz: --highlight: none of the 3 particles that are drawn; all of them fade"
    with pytest.warns(UserWarning, match=words):
        scene_of(water, "--highlight", "element == 'Xe'")


def test_columns_of_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "none.xyz"
    path.write_text("0\n\n")
    assert cli.run([str(path), "--columns"]) == 0
    assert capfd.readouterr().out.splitlines()[:2] == [
        "0 particles, frame 0",
        "x           float64",
    ]


@compiled_only
def test_picture_of_data(water: Path, capfd: pytest.CaptureFixture[str]) -> None:
    picture = water.with_name("water.png")
    options = ["--bonds", "--size", "40x30", "--samples", "1"]
    assert cli.run([*options, str(water), str(picture)]) == 0
    assert capfd.readouterr() == ("", "")
    with Image.open(picture) as made:
        assert made.size == (40, 30)
        assert made.getpixel((0, 0)) == (255, 255, 255)


@pytest.mark.parametrize("mark", ["--legend", "--color-bar"])
def test_particles_leave_room_for_what_stands_beside(water: Path, mark: str) -> None:
    coloured = ["--color", "x"] if mark == "--color-bar" else []
    given = [*coloured, "--no-cell", "--size", "300x300", str(water)]
    alone, beside = (rightmost(scene_of(*given, *marks)) for marks in ([], [mark]))
    assert alone > 270
    scene = scene_of(*given, mark)
    legend = [("H", "white"), ("O", "red")] if mark == "--legend" else None
    taken = share_beside(
        scene.objects, Annotations(legend=legend, colorbar=mark == "--color-bar"), (300, 300)
    )
    assert 0.1 < taken < 0.4
    assert beside <= 300 * (1 - taken) + 1


def test_particles_leave_room_for_what_stands_above_and_below(water: Path) -> None:
    given = ["--no-cell", "--view", "top", "--size", "400x200", str(water)]

    def ends(*marks: str) -> tuple[float, float]:
        scene = scene_of(*given, *marks)
        (spheres,) = scene.objects
        lift = spheres.radius[:, None] * np.array([(0, 1, 0)])
        rows = scene.camera.project(np.concatenate([spheres.center + lift, spheres.center - lift]))
        return float(rows[:, 1].min()), float(rows[:, 1].max())

    alone, titled, barred = ends(), ends("--title", "Water"), ends("--scale-bar=Å")
    assert titled[0] > alone[0] + 8
    assert titled[1] == pytest.approx(alone[1], abs=3)
    assert barred[1] < alone[1] - 8
    assert barred[0] == pytest.approx(alone[0], abs=3)
    assert ends("--title", "Water\n" * 8) == alone  # for which there is no room


def test_points_that_shine_leave_room_for_their_bars(water: Path) -> None:
    shining = ["--emission", "y", "--color", "charge", "--cmap", "viridis", "--view", "front"]
    given = [*shining, "--size", "600x400", str(water)]
    widest = []
    for marks in ([], ["--color-bar"], ["--color-bar=q;mass"]):
        scene = scene_of(*given, *marks)
        widest.append(scene.camera.project(scene.objects[0].center)[:, 0].max())
    # Without a text, "emission per pixel" stands there.
    assert widest[0] > widest[2] > widest[1] > 400
    options = parse([*given, *marks, "picture.png"])
    assert annotations_of(options)["colorbar"] == ["q", "mass"]


def test_legend_of_data(water: Path) -> None:
    options = parse(["--legend", str(water), "picture.png"])
    _, of_data = load_data(options)
    assert [name for name, _ in annotations_of(options, of_data)["legend"]] == ["H", "O"]
    assert options.legend is True
    with pytest.raises(SceneError, match="--legend: colours have no names"):
        scene_of(water, "--legend", "--color", "charge")


def test_a_topology_alone_has_no_places(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("MDAnalysis")
    path = tmp_path / "top.psf"
    atom = "       1 W    1    SOL  OW   O     -0.800000       15.9990           0\n"
    path.write_text(f"PSF\n\n       1 !NTITLE\n REMARKS one\n\n       1 !NATOM\n{atom}")
    assert cli.run([str(path), str(tmp_path / "a.png")]) == 1
    assert ", or by --trajectory run.xtc\n" in capfd.readouterr().err


def test_a_file_may_have_any_name(water: Path, capfd: pytest.CaptureFixture[str]) -> None:
    other = water.rename(water.with_name("run.100"))
    assert cli.run(["--columns", "--format", "xyz", str(other)]) == 0
    assert capfd.readouterr().out.startswith("3 particles")
    assert cli.run(["--columns", str(other)]) == 0  # as it begins like no other
    assert capfd.readouterr().out.startswith("3 particles")
    other.write_text("H\n1.0\n9 0 0\n0 9 0\n0 0 9\nH\n1\nCartesian\n4 5 6\n")
    assert cli.run([str(other), str(water.with_name("a.png"))]) == 1
    assert "if it is data, say by --format what it is" in capfd.readouterr().err


def test_texts_of_one_picture_name_its_frame(water: Path) -> None:
    options = parse([str(water), "picture.png", "--frame", "1", "--title", "frame {frame}"])
    assert load_data(options)[1]["title"] == "frame 1"


def test_colors_without_values_have_no_bar(water: Path) -> None:
    with pytest.raises(SceneError, match="--color-bar: colours stand for no values"):
        load_data(parse([str(water), "picture.png", "--color-bar="]))
