"""Previews, and what is kept of a picture after Ctrl-C."""

import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from examples import light, one_sphere, plane, scene, sphere
from PIL import Image as PillowImage

import vtray
from conftest import compiled_only
from vtray.base.errors import OutputError
from vtray.commands import cli, growing
from vtray.commands.options import parse
from vtray.image.formats import image_file
from vtray.rendering import growth

VTRAY = [str(Path(sys.executable).with_name("vtray"))]
SOON = """
from vtray.commands import growing
from vtray.__main__ import main
growing.PREVIEW_SECONDS = 0.2
main()
"""
HASTY = [sys.executable, "-c", SOON]
"""The same, but that previews come ten times as soon."""


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """Return a scene file of 12 x 9 pixels."""
    document = one_sphere()
    document["camera"].update(size=[12, 9], resolution=[0.4, 0.4])
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    return path


@pytest.fixture
def heavy(tmp_path: Path) -> Path:
    """Return a scene file that takes many seconds, in a folder of its own."""
    spheres = [sphere((k % 50 - 25, k // 50 - 25, 40), 0.6) for k in range(2500)]
    lights = [light(k / 6 - 50, -50, 0, intensity=0.003) for k in range(600)]
    world = scene([*spheres, plane((0, 0, 60), (0, 0, -1))], lights, size=[1600, 1600])
    path = tmp_path / "heavy" / "scene.json"
    path.parent.mkdir()
    path.write_text(json.dumps(world))
    return path


def start(*arguments: object, by: Sequence[str] = HASTY) -> "subprocess.Popen[str]":
    command = [*by, "-t2", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for(path: Path, process: "subprocess.Popen[str]") -> None:
    end = time.monotonic() + 60
    while not path.exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)


def names(folder: Path) -> list[str]:
    return sorted(item.name for item in folder.iterdir())


@pytest.mark.parametrize("more", [["--preview", "p.png"], ["--keep-partial"]])
def test_picture_is_the_same(
    more: list[str], small: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(small.parent)
    assert cli.run([small.name, "a.png"]) == 0
    assert cli.run([small.name, "b.png", *more]) == 0
    assert capfd.readouterr() == ("", "")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()
    if "--preview" in more:  # which shows the whole in the end
        assert Path("p.png").read_bytes() == Path("a.png").read_bytes()
    assert set(names(small.parent)) == {"a.png", "b.png", "scene.json"} | set(more[1:])


REMEDY = "choose another name for the preview"
WRONG = [
    ("scene.json", 'cannot write ".json" files; the formats are'),
    ("a.png", f"is OUTPUT itself; {REMEDY}"),
    ("b/../a.png", f"is OUTPUT itself; {REMEDY}"),
    ("linked.png", f"is OUTPUT itself; {REMEDY}"),
    ("made.png", f"is a file that is read; {REMEDY}"),
    ("missing/p.png", "there is no folder"),
    ("folder.png", "is a folder; give the name of a file"),
    ("read-only.png", "is read-only"),
    ("/dev/stdout", f"is no file whose content can be replaced; {REMEDY}"),
    ("p.jpg", "background: this format cannot be transparent"),
]


def test_preview_on_standard_output(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["--preview", "-", str(small), str(small.with_name("a.png"))]) != 0
    words = f"/dev/stdout: is no file whose content can be replaced; {REMEDY}"
    assert capfd.readouterr().err == f"Error: {words}\n"


@pytest.mark.parametrize(("preview", "message"), WRONG)
def test_preview_that_cannot_be_written(
    preview: str,
    message: str,
    small: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(small.parent)
    assert cli.run(["scene.json", "made.png"]) == 0
    Path("a.png").write_bytes(b"precious")
    Path("linked.png").symlink_to("a.png")
    Path("folder.png").mkdir()
    Path("b").mkdir()
    Path("read-only.png").touch(0o400)
    before = names(small.parent), Path("made.png").read_bytes()
    arguments = ["no such scene", "a.png", "--alpha", "--replay", "made.png"]
    assert cli.run([*arguments, "--preview", preview]) == 1
    error = capfd.readouterr().err
    assert re.fullmatch(rf"Error: {re.escape(preview)}: .*{re.escape(message)}.*\n", error)
    assert (names(small.parent), Path("made.png").read_bytes()) == before
    assert Path("a.png").read_bytes() == b"precious"


def test_preview_that_is_a_part_of_the_scene(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    world = vtray.Scene(vtray.Camera((0, 0, 0), (0, 0, 1), focus=1, size=(9, 7), resolution=(1, 1)))
    world.add_spheres(np.zeros((3, 3)), 1.0)
    world.save("scene.json")
    before = Path("scene.npz").read_bytes()
    assert cli.run(["scene.json", "a.png", "--preview", "scene.npz"]) == 1
    assert "scene.npz: holds arrays of the scene itself" in capfd.readouterr().err
    assert Path("scene.npz").read_bytes() == before
    np.savez("sky.npz", image=np.ones((2, 4, 3), np.float32))
    before = Path("sky.npz").read_bytes()
    document = json.loads(Path("scene.json").read_text())
    document["lights"] = [{"type": "sky", "image": "sky.npz"}]
    Path("scene.json").write_text(json.dumps(document))
    assert cli.run(["scene.json", "a.png", "--preview", "sky.npz"]) == 1
    assert "sky.npz: holds arrays of the scene itself" in capfd.readouterr().err
    assert Path("sky.npz").read_bytes() == before


def test_preview_is_in_the_end_what_is_saved(small: Path) -> None:
    output, preview = small.with_name("a.png"), small.with_name("p.png")
    arguments = ["--title", "A", "--size", "48x36", "--preview", str(preview)]
    assert cli.run([*arguments, str(small), str(output)]) == 0
    assert preview.read_bytes() == output.read_bytes()
    plain = vtray.render(vtray.load(small), size=(48, 36)).pixels
    with PillowImage.open(preview) as shown:
        assert (np.asarray(shown) != plain).any()


def test_preview_that_cannot_be_painted_on(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    arguments = ["--title", "A", str(small), str(small.with_name("a.png"))]
    assert cli.run([*arguments, "--preview", str(small.with_name("p.npz"))]) == 1
    assert "p.npz: this format is not for pixels alone; .png, " in capfd.readouterr().err
    assert names(small.parent) == ["scene.json"]


def test_what_is_kept_has_annotations(small: Path) -> None:
    output = small.with_name("a.png")
    options = parse(["--keep-partial", "-q", str(small), str(output)])
    image = vtray.render(vtray.load(small), size=(48, 36))
    image.partial = 0.5
    ended = pytest.raises(KeyboardInterrupt)
    with ended, growing.Growing(options, {"title": "A"}, print) as context:
        context.arguments(None)["on_update"](image)
        raise KeyboardInterrupt
    with PillowImage.open(output) as shown:
        np.testing.assert_array_equal(np.asarray(shown), image.annotated(title="A").pixels)


def test_no_picture_of_which_to_show_a_part(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for more in (["--preview", "p.png"], ["--keep-partial"]):
        assert cli.run([str(small), "--pixel", "1,2", *more]) == 1
        error = capfd.readouterr().err
        assert error.startswith("Error: --preview and --keep-partial are of no use with --pixel; ")


def test_preview_that_fails_is_left_out(
    small: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, tries = image_file.write_whole, []

    def write(path: Path, content: Callable[[object], object]) -> None:
        if path.name == "p.png":
            tries.append(path)
            message = f"{path}: cannot be written: no space left on device"
            raise OutputError(message)
        whole(path, content)

    monkeypatch.setattr(image_file, "write_whole", write)
    monkeypatch.setattr(growing, "PREVIEW_SECONDS", 0)
    monkeypatch.setattr(growth, "REST", 0)
    output, preview = small.with_name("a.png"), small.with_name("p.png")
    assert cli.run([str(small), str(output), "--samples", "2", "--preview", str(preview)]) == 0
    message = f"{preview}: cannot be written: no space left on device"
    assert capfd.readouterr().err == f"Warning: the preview is left out: {message}\n"
    assert len(tries) > 1  # there may be space again
    assert output.exists()
    tries.clear()
    assert cli.run([str(small), str(output), "--preview", str(preview), "-q"]) == 0
    assert capfd.readouterr() == ("", "")
    assert tries


@compiled_only
@pytest.mark.parametrize(("name", "status"), [("SIGINT", 130), ("SIGTERM", -15)])
def test_what_there_is_is_kept(
    name: str, status: int, heavy: Path, vtray_command: Callable[..., object]
) -> None:
    output, preview = heavy.with_name("picture.png"), heavy.with_name("preview.png")
    process = start("--keep-partial", "--preview", preview, heavy, output)
    wait_for(preview, process)
    process.send_signal(getattr(signal, name))
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (status, "")
    said = re.fullmatch(
        rf"vtray: {re.escape(str(output))} holds a part of the picture: "
        r"([0-9]+) % of its tiles are done\n",
        err,
    )
    assert said, err
    told = vtray.read_provenance(output)
    assert round(100 * told.partial) == int(said[1]) < 100
    with PillowImage.open(output) as shown:
        pixels = np.asarray(shown)
    assert pixels.shape == (1600, 1600, 3)
    assert (pixels.max(axis=2) > 0).mean() > 0.5
    assert vtray.read_provenance(preview).partial == told.partial
    assert names(heavy.parent) == ["picture.png", "preview.png", "scene.json"]
    # A part does not count as the picture.
    done = vtray_command("--replay", output, "--size", "8x6", heavy, heavy.with_name("b.png"))
    assert f"{output}: is a part of a picture, of whose tiles {said[1]} % were done" in done.stderr


@compiled_only
def test_interrupt_twice(heavy: Path) -> None:
    output, preview = heavy.with_name("picture.png"), heavy.with_name("preview.png")
    output.write_bytes(b"precious")
    process = start("--keep-partial", "--preview", preview, heavy, output)
    wait_for(preview, process)
    for _ in range(3):
        process.send_signal(signal.SIGINT)
        time.sleep(0.001)
    out, _ = process.communicate(timeout=30)
    assert (process.returncode, out) == (130, "")
    assert output.read_bytes() == b"precious" or vtray.read_provenance(output).partial < 1
    assert names(heavy.parent) == ["picture.png", "preview.png", "scene.json"]


@compiled_only
def test_interrupt_without_keeping(heavy: Path) -> None:
    output, preview = heavy.with_name("picture.png"), heavy.with_name("preview.png")
    process = start("--preview", preview, heavy, output)
    wait_for(preview, process)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=30) == ("", "")
    assert process.returncode == 130
    assert vtray.read_provenance(preview).partial < 1
    assert names(heavy.parent) == ["preview.png", "scene.json"]


@compiled_only
def test_interrupt_before_there_is_anything(heavy: Path) -> None:
    output = heavy.with_name("picture.png")
    process = start("--keep-partial", heavy, output, by=VTRAY)
    time.sleep(0.05)  # while Python starts
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    # Where not even vtray had begun: -2, or 1 if Python itself was looking for its modules.
    had_begun = "Failed to import the site module" not in errors
    assert process.returncode in ((130, -2) if had_begun else (1,))
    assert names(heavy.parent) == ["scene.json"]


@compiled_only
def test_two_previews_at_once(heavy: Path) -> None:
    preview = heavy.with_name("preview.png")
    outputs = [heavy.with_name(f"{k}.png") for k in range(2)]
    processes = [
        start("--keep-partial", "--preview", preview, "--seed", str(k), heavy, output)
        for k, output in enumerate(outputs)
    ]
    wait_for(preview, processes[0])
    seen = set()
    for _ in range(40):
        seen.add(vtray.read_provenance(preview).seed)  # whole whenever one looks
        time.sleep(0.01)
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        process.communicate(timeout=30)
        assert process.returncode == 130
    assert seen <= {0, 1}
    assert names(heavy.parent) == ["0.png", "1.png", "preview.png", "scene.json"]
