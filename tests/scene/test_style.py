"""How a picture is drawn beside its light has one definition, with which all agree that know it."""

import argparse
import copy
import inspect
import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from pictures import hand_made

import vtray
from vtray.commands.setting_options import add_settings, with_parts
from vtray.scene.settings import kinds_of, overridden
from vtray.scene.style import PICTURE, EyeDome, Fog, Outline, Style, check_picture

SCENE = {
    "camera": json.loads((Path(__file__).parents[2] / "scenes" / "room.json").read_text())[
        "camera"
    ],
    "lights": [],
    "objects": [],
}

WRITTEN: list[tuple[dict[str, Any], Style]] = [
    ({}, Style()),
    ({"fog": False, "outline": False, "eye_dome": False}, Style()),
    ({"fog": True}, Style(fog=Fog())),
    ({"fog": {"start": 1, "end": 2.5}}, Style(fog=(1, 2.5))),
    (
        {"outline": {"width": 2, "color": {"r": 1, "g": 2, "b": 3}, "depth": False}},
        Style(outline=Outline(2, (1, 2, 3), depth=False)),
    ),
    ({"eye_dome": {"strength": 2}}, Style(eye_dome=2)),
]


@pytest.mark.parametrize(("written", "style"), WRITTEN)
def test_files_say_it(written: dict[str, Any], style: Style, tmp_path: Path) -> None:
    warnings: list[str] = []
    text = json.dumps({**SCENE, "style": written})
    scene = vtray.loads(text, warn=warnings.append)
    assert scene.style == style
    assert not warnings
    assert vtray.load_dict(scene.to_dict()).style == style
    scene.save(tmp_path / "a.json")
    assert vtray.load(tmp_path / "a.json").style == style
    plain = style == Style()
    assert ("style" in json.loads((tmp_path / "a.json").read_text())) is not plain
    assert scene == vtray.Scene(scene.camera, [], [], style=style)


@pytest.mark.parametrize(
    ("written", "problem"),
    [
        (
            3,
            ": expected an object with the keys outline, fog, eye_dome, clip, "
            "slice, cap and solid_from, got 3",
        ),
        (
            {"fog": 3},
            ".fog: expected an object with the keys start, end and color, true or false, got 3",
        ),
        ({"fog": {"start": -1}}, ".fog.start: expected a number ≥ 0, got -1"),
        ({"fog": {"start": 5, "end": 5}}, ".fog.end: expected a number > start, got 5"),
        (
            {"fog": {"color": "red"}},
            '.fog.color: expected an object with the keys r, g and b, got "red"',
        ),
        (
            {"outline": {"width": 65}},
            ".outline.width: expected a number of pixels > 0 and at most 64, got 65",
        ),
        ({"outline": {"depth": 1}}, ".outline.depth: expected true or false, got 1"),
        ({"eye_dome": {"strength": 0}}, ".eye_dome.strength: expected a number > 0, got 0"),
    ],
)
def test_files_say_it_wrong(written: object, problem: str) -> None:
    data = {**copy.deepcopy(SCENE), "style": written}
    with pytest.raises(vtray.SceneError) as caught:
        vtray.loads(json.dumps(data))
    assert str(caught.value) == f"<string>: style{problem}"


def test_unknown_keys() -> None:
    warnings: list[str] = []
    text = json.dumps({**SCENE, "style": {"fog": {"begin": 1}, "outlines": True}})
    vtray.loads(text, "a.json", warn=warnings.append)
    unknown = "unknown key, ignored; the nearest known key is"
    assert warnings == [
        f'a.json: style.fog.begin: {unknown} "end"',
        f'a.json: style.outlines: {unknown} "outline"',
    ]


@pytest.mark.parametrize(
    ("given", "style"),
    [
        ({"fog": "auto"}, Style(fog=Fog())),
        ({"fog": "off", "outline": "none"}, Style()),
        ({"fog": "1,2,white"}, Style(fog=Fog(1, 2, vtray.Color(255, 255, 255)))),
        ({"fog": [1, 2, "#fff"]}, Style(fog=Fog(1, 2, "white"))),
        ({"fog": {"end": 3}}, Style(fog=Fog(end=3))),
        ({"outline": 2}, Style(outline=Outline(2.0))),
        ({"outline": (2, "red")}, Style(outline=Outline(2.0, "red"))),
        ({"eye_dome": "1,3"}, Style(eye_dome=EyeDome(1, 3))),
        ({"outline": np.array(2.0), "eye_dome": np.array(3)}, Style(outline=2, eye_dome=3)),
        ({"clip": [*map(np.array, (1.0, 0.0, 0.0, 0.5))]}, Style(clip=[(1, 0, 0, 0.5)])),
    ],
)
def test_code_says_it(given: dict[str, Any], style: Style) -> None:
    assert Style(**given) == style
    assert overridden(Style(fog=True), {"fog": None, **given}) == Style(**{"fog": True, **given})
    check_picture({**given, "samples": 4})


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({"fog": (2, 1)}, "Fog.end: expected a number > start, got 1"),
        (
            {"fog": 3},
            "Style.fog: expected two distances, maybe a colour, such as 5,20 or 5,20,white",
        ),
        ({"fog": "3,x"}, "Style.fog: expected two distances, maybe a colour, such as"),
        ({"fog": (1, 2, "blu")}, "Fog.color: expected a name"),
        ({"outline": np.array(-1)}, "Outline.width: expected a number of pixels > 0 and at most"),
        ({"fog": np.array(1.0)}, "Style.fog: expected two distances, maybe a colour, such as 5,20"),
        ({"slice": np.array(1.0)}, "Style.slice: expected "),
        ({"outline": -1}, "Outline.width: expected a number of pixels > 0 and at most 64, got -1"),
        ({"outline": None}, "Style.outline: expected a width in pixels, or that and a colour"),
        ({"eye_dome": (1, "x")}, "Style.eye_dome: expected a strength, or that and a radius"),
        ({"eye_dome": b"a"}, "Style.eye_dome: expected a strength, or that and a radius"),
        ({"fog": b"ab"}, "Style.fog: expected two distances, maybe a colour, such as"),
        ({"slice": {}}, "Style.slice: lacks normal, thickness; expected normal, thickness, dis"),
        ({"cap": {"r": 1, "b": 2}}, "Style.cap: lacks g; expected r, g, b"),
        ({"clip": {"distance": 2}}, "Style.clip: lacks normal; expected normal, distance"),
    ],
)
def test_code_says_it_wrong(given: dict[str, Any], problem: str) -> None:
    with pytest.raises(vtray.SceneError) as caught:
        Style(**given)
    assert str(caught.value).startswith(problem)


def test_misspelt() -> None:
    with pytest.raises(TypeError, match=r"Fog\(\) argument 'begin' is unknown"):
        Style(fog={"begin": 1})
    with pytest.raises(TypeError, match=r"Slice\(\) argument 'norml' is unknown; did you mean"):
        Style(slice={"norml": (0, 0, 1)})
    with pytest.raises(
        TypeError, match=r"Fog\(\) argument '1' is unknown; the arguments are start,"
    ):
        Style(fog={1: 2})
    scene = vtray.Scene()
    with pytest.raises(AttributeError, match=r"'fog', which is a part of its style: .*scene.style"):
        scene.fog = True


@pytest.fixture
def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(exit_on_error=False)
    add_settings(made.add_argument_group("style"), Style)
    made.add_argument("files", nargs="*")
    return made


@pytest.mark.parametrize(
    ("arguments", "files", "given"),
    [
        (["--fog", "a.json", "b.png"], ["a.json", "b.png"], {"fog": True}),
        (["--fog", "1,2", "a.json"], ["a.json"], {"fog": Fog(1, 2)}),
        (["--fog=1,2,red", "a.json"], ["a.json"], {"fog": Fog(1, 2, "red")}),
        (["--fog", "off", "a.json"], ["a.json"], {"fog": False}),
        (["--outline", "1.5", "c60.xyz"], ["c60.xyz"], {"outline": Outline(1.5)}),
        (["--outline", "1abc.pdb"], ["1abc.pdb"], {"outline": True}),
        (["a.json", "--eye-dome"], ["a.json"], {"eye_dome": True}),
        (["--eye-dome", "--outline", "a"], ["a"], {"eye_dome": True, "outline": True}),
        (["--fog", "--", "1,2"], ["1,2"], {"fog": True}),
    ],
)
def test_options(
    arguments: list[str], files: list[str], given: dict[str, Any], parser: argparse.ArgumentParser
) -> None:
    found = vars(parser.parse_intermixed_args(with_parts(arguments, Style)))
    assert found.pop("files") == files
    assert found == {**dict.fromkeys(Style.__struct_fields__), **given}


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--fog", "2,1"], "expected a number > start, got 1.0"),
        (["--fog", "1,x"], "expected two distances, maybe a colour, such as 5,20 or 5,20,white"),
        (["--outline", "0"], "expected a number of pixels > 0 and at most 64, got 0.0"),
        (["--outline", "-1"], "expected a number of pixels > 0 and at most 64, got -1.0"),
        (["--outline=2,blu"], 'got .blu.; did you mean "blue"'),
    ],
)
def test_wrong_options(arguments: list[str], problem: str, parser: argparse.ArgumentParser) -> None:
    with pytest.raises(argparse.ArgumentError, match=problem):
        parser.parse_args(with_parts(arguments, Style))


def test_each_part_is_described_and_has_a_default() -> None:
    assert Style() == Style(**msgspec.structs.asdict(Style()))
    assert tuple(kinds_of(Style)) == Style.__struct_fields__
    assert PICTURE[-len(Style.__struct_fields__) :] == Style.__struct_fields__
    for name in Style.__struct_fields__:
        assert f"\n{name} : " in inspect.getdoc(Style)


def test_pictures_tell_it(tmp_path: Path) -> None:
    image = hand_made()
    path = tmp_path / "a.png"
    image.save(path)
    assert b'"style"' not in path.read_bytes()
    assert vtray.read_provenance(path).style == Style()
    image.style = Style(fog=(1, 2, "white"), outline=True)
    image.save(path)
    told = vtray.read_provenance(path)
    assert told.style == image.style
    assert (told.told("fog"), told.told("samples")) == (image.style.fog, 1)
