"""The installed command as a process: real files, real faults."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from examples import light, one_sphere, plane, scene, sphere
from PIL import Image as PillowImage

import vtray
from conftest import compiled_only

pytestmark = compiled_only

Command = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(one_sphere()))
    return path


def read(path: Path) -> np.ndarray:
    with PillowImage.open(path) as image:
        assert (image.format, image.mode) == ("PNG", "RGB")
        return np.asarray(image)


@pytest.mark.parametrize("threads", [1, 2, 50])
def test_renders(vtray_command: Command, scene_file: Path, threads: int) -> None:
    output = scene_file.with_name("picture.png")
    done = vtray_command("-t", threads, scene_file, output)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    expected = vtray.render(vtray.load(scene_file)).pixels
    np.testing.assert_array_equal(read(output), expected)


def test_files_are_equal_on_every_run(vtray_command: Command, scene_file: Path) -> None:
    outputs = [scene_file.with_name(f"{k}.png") for k in range(3)]
    for k, output in enumerate(outputs):
        vtray_command("--threads", 1 + k, scene_file, output)
    assert len({output.read_bytes() for output in outputs}) == 1


def test_module_is_the_same_command(scene_file: Path) -> None:
    output = scene_file.with_name("a.png")
    done = subprocess.run(
        [sys.executable, "-m", "vtray", scene_file, output], capture_output=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    assert read(output).max() == 255


def test_pixel_needs_no_output(vtray_command: Command, scene_file: Path) -> None:
    done = vtray_command("--pixel", "35,22", scene_file)
    assert done.returncode == 0
    assert done.stdout.startswith("pixel        column 35, row 22 of 64 x 48\n")
    assert done.stderr == ""


def test_errors(vtray_command: Command, tmp_path: Path) -> None:
    (tmp_path / "bad.json").write_text('{"camera": 1}')
    for arguments in (["missing.json", "a.png"], ["bad.json", "a.png"], ["-t", "0", "b", "c"], []):
        done = vtray_command(*arguments, cwd=tmp_path)
        assert done.returncode == 1
        assert done.stdout == ""
        assert done.stderr.startswith("Error: ")
        assert done.stderr.count("\n") == 1
    assert [item.name for item in tmp_path.iterdir()] == ["bad.json"]


def run_in_shell(command: str, scene_file: Path) -> "subprocess.CompletedProcess[str]":
    """Run the command in a shell, with SCENE and PICTURE replaced by files."""
    program = f"{Path(sys.executable).with_name('vtray')} {command}"
    words = {"SCENE": scene_file, "PICTURE": scene_file.with_name("picture.png")}
    for word, path in words.items():
        program = program.replace(word, str(path))
    done = subprocess.run(program, shell=True, capture_output=True, text=True, check=False)
    for printed in (done.stdout, done.stderr):
        assert "Traceback" not in printed
        assert "bug" not in printed
    return done


@pytest.mark.parametrize("redirection", [">&-", "2>&-", ">&- 2>&-"])
@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        ("SCENE PICTURE", 0),
        ("--stats SCENE PICTURE", 0),
        ("--pixel 1,1 SCENE", 0),
        ("--help", 0),
        ("missing.json PICTURE", 1),
        ("", 1),
    ],
)
def test_closed_streams(scene_file: Path, redirection: str, arguments: str, status: int) -> None:
    done = run_in_shell(f"{arguments} {redirection}", scene_file)
    assert done.returncode == status
    if ">&-" in redirection.split():
        assert done.stdout == ""
    if "2>&-" in redirection.split():
        assert done.stderr == ""
        assert "Error" not in done.stdout
    assert scene_file.with_name("picture.png").exists() == (arguments.endswith("SCENE PICTURE"))


@pytest.mark.parametrize("redirection", [">/dev/full", "2>/dev/full", "| true"])
@pytest.mark.parametrize("arguments", ["--pixel 1,1 SCENE", "--help", "missing.json PICTURE"])
def test_streams_that_cannot_be_written(scene_file: Path, redirection: str, arguments: str) -> None:
    run_in_shell(f"{arguments} {redirection}", scene_file)


def test_full_standard_output(scene_file: Path) -> None:
    done = run_in_shell("--pixel 1,1 SCENE > /dev/full", scene_file)
    assert done.returncode == 1
    assert done.stderr == "Error: standard output cannot be written: No space left on device\n"


def test_full_device(vtray_command: Command, scene_file: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("there is no /dev/full")
    done = vtray_command(scene_file, "/dev/full")
    assert done.returncode == 1
    assert done.stderr == "Error: /dev/full: cannot be written: no space left on device\n"


def test_full_disk(vtray_command: Command, scene_file: Path, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("may not mount a small disk")
    try:
        (disk / "old.png").write_bytes(b"precious")
        (disk / "ballast").write_bytes(bytes(40_000))
        document = scene([sphere((0, 0, 5), 3)], [light(5, -5, 0)], size=[900, 900])
        document["camera"]["resolution"] = [0.006, 0.006]
        scene_file.write_text(json.dumps(document))
        done = vtray_command(scene_file, disk / "old.png")
        assert done.returncode == 1
        message = f"Error: {disk}/old.png: cannot be written: no space left on device\n"
        assert done.stderr == message
        assert (disk / "old.png").read_bytes() == b"precious"
        assert sorted(item.name for item in disk.iterdir()) == ["ballast", "old.png"]
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_unwritable_folder(vtray_command: Command, scene_file: Path) -> None:
    folder = "/proc/self" if os.geteuid() == 0 else str(scene_file.parent / "locked")
    if os.geteuid() != 0:
        Path(folder).mkdir(mode=0o500)
    done = vtray_command(scene_file, f"{folder}/picture.png")
    assert done.returncode == 1
    assert done.stderr.startswith(f"Error: {folder}/picture.png: cannot be written: ")


def heavy_scene() -> dict:
    """Return a scene that takes many seconds."""
    spheres = [sphere((k % 50 - 25, k // 50 - 25, 40), 0.6) for k in range(2500)]
    lights = [light(k / 20 - 50, -50, 0, intensity=0.001) for k in range(2000)]
    return scene([*spheres, plane((0, 0, 60), (0, 0, -1))], lights, size=[2000, 2000])


@pytest.mark.parametrize("threads", [1, 2])
def test_interrupt(scene_file: Path, threads: int) -> None:
    scene_file.write_text(json.dumps(heavy_scene()))
    output = scene_file.with_name("picture.png")
    process = subprocess.Popen(
        [Path(sys.executable).with_name("vtray"), f"-t{threads}", scene_file, output],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    time.sleep(1.5)
    assert process.poll() is None
    start = time.perf_counter()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert time.perf_counter() - start < 0.5
    assert (process.returncode, out, err) == (130, b"", b"")
    assert list(scene_file.parent.iterdir()) == [scene_file]


def test_killed_process_leaves_the_old_picture(scene_file: Path) -> None:
    scene_file.write_text(json.dumps(heavy_scene()))
    output = scene_file.with_name("picture.png")
    output.write_bytes(b"precious")
    command = [Path(sys.executable).with_name("vtray"), scene_file, output]
    process = subprocess.Popen(command)
    time.sleep(1.0)
    process.kill()
    process.wait()
    assert output.read_bytes() == b"precious"


def test_two_at_once_into_one_file(scene_file: Path) -> None:
    output = scene_file.with_name("picture.png")
    command = [Path(sys.executable).with_name("vtray"), scene_file, output]
    processes = [subprocess.Popen(command) for _ in range(4)]
    assert [process.wait() for process in processes] == [0, 0, 0, 0]
    assert read(output).max() == 255
    assert sorted(scene_file.parent.iterdir()) == [output, scene_file]


def test_standard_streams(vtray_command: Command, scene_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "picture.png"
    vtray_command(scene_file, output)
    expected = output.read_bytes()
    document = scene_file.read_bytes()
    for arguments in (("-", "-"), ("/dev/stdin", "/dev/stdout")):
        done = vtray_command(*arguments, input=document, text=False)
        assert (done.returncode, done.stdout, done.stderr) == (0, expected, b"")
    # What is there in the file already stays, as with any command.
    log = tmp_path / "log"
    log.write_bytes(b"before")
    done = run_in_shell(f"SCENE - >> {log}", scene_file)
    assert (done.returncode, done.stderr) == (0, "")
    assert log.read_bytes() == b"before" + expected
    # A file of this name can still be meant.
    done = vtray_command(scene_file, "./-", cwd=tmp_path)
    assert (tmp_path / "-").read_bytes() == expected


def test_sockets_as_standard_streams(scene_file: Path, tmp_path: Path) -> None:
    # Some programs that call others connect them so; a socket cannot be opened by its name.
    ours, theirs = socket.socketpair()
    program = [Path(sys.executable).with_name("vtray"), "-", "-"]
    process = subprocess.Popen(program, stdin=theirs, stdout=theirs, stderr=subprocess.PIPE)
    theirs.close()
    picture = tmp_path / "picture.png"
    with ours, ours.makefile("rb") as stream:
        ours.sendall(scene_file.read_bytes())
        ours.shutdown(socket.SHUT_WR)
        picture.write_bytes(stream.read())
    assert (process.communicate(), process.returncode) == ((None, b""), 0)
    assert read(picture).max() == 255


def test_picture_for_a_closed_stream_is_an_error(scene_file: Path) -> None:
    done = run_in_shell("SCENE - >&-", scene_file)
    message = "Error: /dev/stdout: cannot be written: bad file descriptor\n"
    assert (done.returncode, done.stderr) == (1, message)


def test_process_substitution(scene_file: Path, tmp_path: Path) -> None:
    program = Path(sys.executable).with_name("vtray")
    copy = tmp_path / "copy.png"
    command = f"{program} <(cat {scene_file}) >(cat > {copy}); wait $!"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert read(copy).max() == 255


def test_terminal_gets_no_picture(scene_file: Path) -> None:
    pty = pytest.importorskip("pty")
    terminal, inside = pty.openpty()
    program = [Path(sys.executable).with_name("vtray"), scene_file, "-"]
    done = subprocess.run(program, stdout=inside, stderr=subprocess.PIPE, text=True, check=False)
    os.close(inside)
    os.close(terminal)
    assert done.returncode == 1
    assert done.stderr == "Error: /dev/stdout: is a terminal; send it to a file or a pipe\n"


@pytest.mark.parametrize("option", ["--stats", "--samples=1"])
def test_notes_that_cannot_be_printed_are_no_failure(scene_file: Path, option: str) -> None:
    text = scene_file.read_text()
    scene_file.write_text(text.replace("{", '{"unknown": 1, ', 1))  # which is warned of
    done = run_in_shell(f"{option} SCENE PICTURE 2> /dev/full", scene_file)
    assert done.returncode == 0
    assert read(scene_file.with_name("picture.png")).max() == 255


@pytest.mark.parametrize("link", [None, "soft", "hard"])
def test_data_of_the_scene_is_spared(
    vtray_command: Command, tmp_path: Path, link: str | None
) -> None:
    ball = vtray.Spheres([(0, 0, 5)], 1, (255, 255, 255), 1)
    camera = vtray.Camera((0, 0, 0), (0, 0, 1), 10, (8, 6), (0.1, 0.1))
    vtray.Scene(camera, [vtray.Light((0, -5, 0), 1)], [ball]).save(tmp_path / "ball.json")
    data, output = tmp_path / "ball.npz", tmp_path / "ball.npz"
    if link is not None:
        output = tmp_path / "out.npz"
        output.symlink_to("ball.npz") if link == "soft" else output.hardlink_to(data)
    before = data.read_bytes()
    done = vtray_command(tmp_path / "ball.json", output)
    remedy = "choose another name for the image"
    assert done.stderr == f"Error: {output}: holds arrays of the scene itself; {remedy}\n"
    assert (done.returncode, data.read_bytes()) == (1, before)


def test_texts_of_others_do_not_reach_the_terminal_raw(
    vtray_command: Command, scene_file: Path, tmp_path: Path
) -> None:
    # Each could clear the screen, turn the direction of writing, or forge a line of its own.
    evil = "a\x1b[2J\u202eb\nError: c"
    shown = r"a\x1b[2J\u202eb\nError: c"
    text = scene_file.read_text()
    scene_file.write_text(text.replace("{", "{" + json.dumps(evil) + ": 1, ", 1))
    strange = tmp_path / f"{evil}.json"
    strange.write_text(text.replace("1", "-1"))
    for arguments in (
        [scene_file, tmp_path / "a.png"],
        [scene_file, tmp_path / f"{evil}.gif"],
        [strange, tmp_path / "a.png"],
        [f"{evil}", "a.png"],
        ["--threads", evil, scene_file, "a.png"],
        ["--background", evil, scene_file, "a.png"],
    ):
        done = vtray_command(*arguments, cwd=tmp_path)
        assert shown in done.stderr
        assert done.stderr.removesuffix("\n").isprintable()
