"""Movies by the command."""

import json
from pathlib import Path

import numpy as np
import pytest
from examples import one_sphere
from PIL import Image

from conftest import compiled_only
from vtray.commands import cli
from vtray.commands.movie_options import are_used, makes_movie
from vtray.commands.options import parse

FRAME = """2
Lattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3:charge:R:1 Time={0}
C {0} 0 0 {0}
O 1 2 2 0
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """Return a trajectory of five frames."""
    path = tmp_path / "run.xyz"
    path.write_text("".join(FRAME.format(k / 2) for k in range(5)))
    return path


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """Return a scene file of 12 x 9 pixels."""
    document = one_sphere()
    document["camera"].update(size=[12, 9], resolution=[0.4, 0.4])
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    return path


def pictures(folder: Path) -> list[np.ndarray]:
    return [np.asarray(Image.open(path)) for path in sorted(folder.glob("*.png"))]


@compiled_only
def test_frames_of_a_file(run: Path, capfd: pytest.CaptureFixture[str]) -> None:
    there = run.with_name("made") / "%02d.png"
    size = ["--size", "16x12", "--color", "charge", "-t1"]
    assert cli.run([*size, "--frames", "1:5:2", str(run), str(there)]) == 0
    assert capfd.readouterr() == ("", "")
    first, second = pictures(there.parent)
    assert first.shape == (12, 16, 3)
    # The scale of colours is that of the frames of the movie: from 0 to 1.5.
    for limits in ("0,1.5", "0,9"):
        again = run.with_name(limits) / "%d.png"
        assert cli.run([*size, "--frames", "1:5:2", f"--clim={limits}", str(run), str(again)]) == 0
        same = [
            (a == b).all() for a, b in zip(pictures(again.parent), (first, second), strict=True)
        ]
        assert all(same) == (limits == "0,1.5")
    movie = run.with_name("a.webp")
    assert cli.run([*size, "--frames", "1:5:2", "--fps", "4", str(run), str(movie)]) == 0
    with Image.open(movie) as found:
        assert found.n_frames == 2
        assert (np.asarray(found.convert("RGB")) == first).all()
        assert found.info["duration"] == 250
    assert cli.run([*size, str(run), str(run.with_name("all.gif"))]) == 0
    with Image.open(run.with_name("all.gif")) as found:
        assert found.n_frames == 5
    assert cli.run([*size, str(run), str(run.with_name("one.webp"))]) == 0  # a picture, as ever
    with Image.open(run.with_name("one.webp")) as found:
        assert getattr(found, "n_frames", 1) == 1


@compiled_only
def test_frames_without_particles(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path, there = tmp_path / "few.xyz", tmp_path / "made" / "%d.png"
    path.write_text("0\n\n2\n\nC 5 0 0\nO 6 0 0\n0\n\n")
    size = ["--size", "48x36", "-t1"]
    assert cli.run([*size, "--frames", ":", "--legend", str(path), str(there)]) == 0
    assert capfd.readouterr() == ("", "")
    before, some, after = pictures(there.parent)
    assert (before == after).all()  # the legend alone, which is that of all
    assert (before < 255).any()
    assert (some != before).any()
    # The scale of colours is that of the frames with particles.
    colors = []
    for limits in ([], ["--clim=5,6"]):
        there = tmp_path / f"scale{len(limits)}" / "%d.png"
        options = [*size, "--frames", ":", "--color", "x", *limits]
        assert cli.run([*options, str(path), str(there)]) == 0
        before, some, after = pictures(there.parent)
        assert (before == 255).all()
        assert (after == 255).all()
        colors.append(some)
    assert (colors[0] == colors[1]).all()
    only = ["--frames", ":", "--select", "x > 9", str(path), str(tmp_path / "none.gif")]
    assert cli.run(only) == 1
    assert capfd.readouterr().err == "Error: frames: expected particles, got none\n"


@compiled_only
def test_select_of_none(run: Path, capfd: pytest.CaptureFixture[str]) -> None:
    there = str(run.with_name("made") / "%d.png")
    size = ["--size", "16x12", "--samples", "1", "-t1"]
    assert cli.run([*size, "--select", "x > 9", str(run), there]) == 0
    words = "none of the particles in the frames that were looked at; the cell alone is shown"
    assert capfd.readouterr().err == f"Warning: {run}: --select: {words}\n"
    assert cli.run([*size, "--select", "x > 1.5", str(run), there]) == 0
    assert capfd.readouterr().err == ""


@compiled_only
def test_turntables(run: Path, scene: Path) -> None:
    turn = ["--turntable", "0.3", "--fps", "10", "-t1"]
    there = run.with_name("data") / "%d.png"
    assert cli.run([*turn, "--size", "16x12", "--frame", "-1", str(run), str(there)]) == 0
    first, second, third = pictures(there.parent)
    assert (first != second).any()
    assert (second != third).any()
    there = run.with_name("scene") / "%d.png"
    assert cli.run([*turn, str(scene), str(there)]) == 0
    assert [picture.shape for picture in pictures(there.parent)] == [(9, 12, 3)] * 3


@compiled_only
def test_what_is_painted(run: Path) -> None:
    there = run.with_name("made") / "%d.png"
    texts = ["--time", "{time:.1f} ps", "--title", "{frame}", "--legend", "--label", "element"]
    size = ["--size", "90x70", "-t1", "--no-cell", "--frames", ":2"]
    assert cli.run([*size, *texts, str(run), str(there)]) == 0
    one, other = pictures(there.parent)
    assert (one[:30, :60] != other[:30, :60]).any()


@compiled_only
def test_legend_and_scale_bar_are_those_of_all_frames(tmp_path: Path) -> None:
    path, there = tmp_path / "run.xyz", tmp_path / "made" / "%d.png"
    atoms = ["O 0 0 0", "H 0 4 9", "C 9 0 0", "C 9 4 0"]
    frames = [f"{count}\n\n" + "\n".join(atoms[-count:]) + "\n" for count in (1, 4, 2)]
    path.write_text("".join(frames))
    options = ["--size", "160x120", "-t1", "--legend", "--scale-bar=nm", "--samples", "1"]
    assert cli.run([*options, "--view", "front", str(path), str(there)]) == 0
    one, all_, few = pictures(there.parent)
    assert (all_[:, :115] != few[:, :115]).any()
    for picture in (all_, few):
        assert (picture[:, 130:] == one[:, 130:]).all()  # the legend, and the end of the bar
        assert (picture[108:] == one[108:]).all()  # the remark below the bar
    assert len(np.unique(one[:60, 130:].reshape(-1, 3), axis=0)) > 10


MIXED = [
    "1\nProperties=species:S:1:pos:R:3:q:R:1 Time=1\nC 0 0 0 1\n",
    "1\nProperties=species:S:1:pos:R:3:q:R:1\nC 0 0 0 1\n",
    "1\n\nC 0 0 0\n",
]
"""Frames of which not all have a time and a column."""

ERRORS = [
    (["DATA", "a.png", "--frames", "::2"], "a.png: is no movie by its name; expected .mp4, .gif"),
    (["DATA", "a.png", "--fps", "5"], "a.png: is no movie by its name; expected .mp4, .gif, "),
    (["DATA", "--columns", "--frames", "::2"], ""),
    (["DATA", "a.gif", "--frames", "x"], "argument --frames: expected START:STOP:STEP such as 0:5"),
    (["DATA", "a.gif", "--frames", "7:"], "DATA: frames 7:: there are 5 frames, none of which is"),
    (["DATA", "a.gif", "--frames", "-9"], "DATA: frames -9: there are 5 frames, none of which is"),
    (["DATA", "a.gif", "--fps", "0"], "argument --fps: expected a number > 0, got 0"),
    (["DATA", "a.gif", "--fps", "99"], "a.gif: fps: expected at most 50 for this format, got 99"),
    (["DATA", "a.gif", "--turntable", "no"], "argument --turntable: expected a number > 0, got no"),
    (["DATA", "a.gif", "--turntable", "1e9"], "seconds: expected at most 1000000 pictures, got 3"),
    (["DATA", "a.gif", "--turntable", "1", "--frames", "1:"], "--frames and --turntable: expected"),
    (["DATA", "a.gif", "--frame", "1"], "--frame is for pictures, and a.gif is a movie; use --fr"),
    (["DATA", "a.gif", "--preview", "b.png"], "--preview is for pictures, and a.gif is a movie"),
    (["DATA", "a.gif", "--stats"], "--stats is for pictures, and a.gif is a movie"),
    (["DATA", "a.gif", "--bits", "16"], "a.gif: bits 16: movies have 8 bits and colours alone"),
    (["DATA", "a.gif", "--bits", "16", "--axes"], "a.gif: bits 16: movies have 8 bits and colours"),
    (["DATA", "m/%d.png", "--bits", "16", "--axes"], "m/0.png: annotations: expected 8 bits with"),
    (["DATA", "a.gif", "--alpha"], "a.gif: background: this format cannot be transparent; .webp "),
    (["DATA", "no/a.gif"], "no/a.gif: there is no folder "),
    (["DATA", "a.gif", "--color", "no"], "DATA: frame 0: color: expected a colour or the name of"),
    (["MIXED", "a.gif", "--color", "q"], "MIXED: frame 2: color: expected a colour or the name of"),
    (["MIXED", "a.gif", "--select", "q > 0"], "MIXED: frame 2: select 'q > 0': at 1: no column"),
    (["MIXED", "a.gif", "--time", "{time}"], "MIXED: frame 1: time: the data do not say the time"),
    (
        ["DATA", "a.gif", "--time", "{t}"],
        "time: expected {frame} and {time} alone in braces, such as {time:.1f} ps, got {t}",
    ),
    (["SCENE", "a.gif"], "a.gif: a scene has one picture; --turntable SECONDS goes around it"),
    (["SCENE", "a.gif", "--frames", "1:"], "--frames is for files of data, and SCENE is a scene"),
    (["SCENE", "--fps", "5", "--pixel", "1,1"], "--fps is for movies; expected one as OUTPUT"),
]


@pytest.mark.parametrize(("arguments", "message"), ERRORS)
def test_errors(
    arguments: list[str],
    message: str,
    run: Path,
    scene: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(run.parent)
    Path("mixed.xyz").write_text("".join(MIXED))
    named = {"DATA": run.name, "SCENE": scene.name, "MIXED": "mixed.xyz"}
    status = cli.run([*(named.get(word, word) for word in arguments), "-t1"])
    error = capfd.readouterr().err
    if not message:  # what is printed needs no OUTPUT
        assert (status, error) == (0, "")
        return
    for word, name in named.items():
        message = message.replace(word, name)
    assert status == 1
    assert error.startswith(f"Error: {message}")
    assert error.count("\n") == 1


def test_options_are_made_when_they_are_used() -> None:
    assert are_used(["a.xyz", "--frames=1:"])
    assert are_used(["--help"])
    assert not are_used(["a.json", "b.png"])
    assert parse(["--frames", "-5:", "a.xyz", "b.mp4"]).frames == "-5:"
    options = parse(["a.json", "a%d.png"])
    assert not makes_movie(options, is_data=False)
    assert makes_movie(options, is_data=True)
