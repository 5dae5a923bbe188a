"""What the command paints onto pictures."""

import json
from pathlib import Path

import numpy as np
import pytest
from examples import one_sphere
from PIL import Image as PillowImage

import vtray
from conftest import once
from vtray.base.errors import UsageError
from vtray.commands import cli
from vtray.commands.annotation_options import with_values
from vtray.commands.options import parse


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """Return a scene file of 96 x 72 pixels, seen in perspective."""
    document = one_sphere()
    document["camera"].update(size=[96, 72], resolution=[0.05, 0.05])
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    return path


@once
def test_command_paints_what_annotated_does(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = scene.with_name("a.png")
    assert cli.run([str(scene), "--scale-bar=nm", "--title", "A", str(output)]) == 0
    assert capfd.readouterr() == ("", "")
    image = vtray.render(vtray.load(scene))
    with PillowImage.open(output) as read:
        expected = image.annotated(scalebar="nm", title="A").pixels
        np.testing.assert_array_equal(np.asarray(read), expected)
    assert vtray.read_provenance(output).scene == image.scene_hash


def test_value_of_a_bar_stands_after_an_equals_sign() -> None:
    assert with_values(["--scale-bar", "a.json", "--color-bar=x", "--", "--scale-bar"]) == [
        "--scale-bar=",
        "a.json",
        "--color-bar=x",
        "--",
        "--scale-bar",
    ]


def test_a_word_beside_two_files_is_the_value_of_a_bar() -> None:
    files = ["a.json", "b.png"]
    assert with_values(["--scale-bar", "nm", *files]) == ["--scale-bar=nm", *files]
    assert with_values(["--scale-bar", *files]) == ["--scale-bar=", *files]
    assert with_values([*files, "--color-bar", "eV"]) == [*files, "--color-bar=eV"]
    assert with_values(["--scale-bar", "--color-bar", "eV", *files])[:2] == [
        "--scale-bar=",
        "--color-bar=eV",
    ]
    assert with_values(["--scale-bar", "scene", "b.png"]) == ["--scale-bar=", "scene", "b.png"]
    assert with_values(["--scale-bar", "Å", *files]) == ["--scale-bar=Å", *files]


def test_an_equals_sign_after_a_space_belongs_to_the_option() -> None:
    assert with_values(["--scale-bar", "=Å", "ar.png"]) == ["--scale-bar=Å", "ar.png"]
    assert with_values(["--color-bar", "=T (K)", "a", "b"]) == ["--color-bar=T (K)", "a", "b"]
    assert with_values(["a", "b", "--scale-bar", "="]) == ["a", "b", "--scale-bar="]
    assert with_values(["--", "--scale-bar", "=nm"]) == ["--", "--scale-bar", "=nm"]


@pytest.mark.parametrize(
    ("given", "remedy"),
    [
        (("--color-bar", "energy (eV)"), '--color-bar "energy (eV)": '),
        (("--scale-bar", "1nm"), "--scale-bar 1nm: "),
        (("--cap", "#ff0000;"), '--cap "#ff0000;": '),
    ],
)
def test_a_value_after_a_space_that_is_none_is_told(
    given: tuple[str, str], remedy: str, scene: Path
) -> None:
    files = [str(scene), "x.png"]
    option, _, value = remedy.removesuffix(": ").partition(" ")
    for arguments in ([*given, *files], [*files, *given], [files[0], *given, files[1]]):
        with pytest.raises(UsageError) as caught:
            parse(arguments)
        assert str(caught.value).startswith(remedy)
        assert f"; write {option}={value}; usage: " in str(caught.value)
    with pytest.raises(UsageError, match=r"^unrecognized arguments: y.png; "):
        parse(["--color-bar", *files, "y.png"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["a.npz", "--axes"], "a.npz: this format is not for pixels alone; .png, "),
        (["a.exr", "--title", "A"], " are, and a title, axes and all other annotations are such "),
        (["a.png", "--bits", "16", "--axes"], "a.png: annotations: expected 8 bits with them, got"),
        (["a.png", "--color-bar"], "--color-bar: colours stand for no values, as scene files hold"),
        (["a.png", "--color-bar=E"], "colorbar: expected True or False, as no object has a cmap"),
        (["a.png", "--title", "A" * 40, "--size", "12x9"], "annotations: there is no room in a"),
    ],
)
def test_errors_are_one_line(
    scene: Path, arguments: list[str], message: str, capfd: pytest.CaptureFixture[str]
) -> None:
    output = scene.with_name(arguments[0])
    assert cli.run([str(scene), str(output), *arguments[1:]]) == 1
    out, err = capfd.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert message in err
    assert not output.exists()
