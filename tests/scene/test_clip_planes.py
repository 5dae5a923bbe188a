"""Clip planes, slices and caps, as files, code and the command line write them."""

import json
from pathlib import Path
from typing import Any

import pytest

import vtray
from vtray.commands.setting_options import with_parts
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.rooms import rooms_of
from vtray.scene.style import Style

SCENE = json.loads((Path(__file__).parents[2] / "scenes" / "first.json").read_text())
UP, NOWHERE = {"x": 0, "y": 0, "z": 1}, {"x": 0, "y": 0, "z": 0}
PLANE = vtray.ClipPlane((0, 0, 1), 2)


@pytest.mark.parametrize(
    ("written", "style"),
    [
        ({"clip": [{"normal": UP, "distance": 2}]}, Style(clip=(0, 0, 1, 2))),
        ({"clip": [{"normal": UP}], "cap": True}, Style(clip=(0, 0, 1), cap=True)),
        (
            {"clip": [{"normal": UP, "center": NOWHERE, "objects": [0, 2]}]},
            Style(clip=vtray.ClipPlane((0, 0, 1), center=(0, 0, 0), objects=(0, 2))),
        ),
        (
            {
                "slice": {"normal": UP, "thickness": 1, "distance": 2},
                "cap": {"r": 1, "g": 2, "b": 3},
            },
            Style(slice=(0, 0, 1, 2, 1), cap=(1, 2, 3)),
        ),
    ],
)
def test_files_say_it(written: dict[str, Any], style: Style) -> None:
    scene = vtray.loads(json.dumps({**SCENE, "style": written}))
    assert scene.style == style
    assert vtray.load_dict(scene.to_dict()).style == style


@pytest.mark.parametrize(
    ("written", "problem"),
    [
        ({"clip": True}, "clip: expected an array, got true"),
        (
            {"clip": [{"normal": NOWHERE}]},
            "clip[0].normal: expected numbers x, y and z that are not all zero, got "
            '{"x": 0, "y": 0, "z": 0}',
        ),
        (
            {"clip": [{"normal": UP, "distance": 1, "center": NOWHERE}]},
            "clip[0].center: expected either a center or a distance, not both, got "
            '{"x": 0, "y": 0, "z": 0}',
        ),
        (
            {"clip": [{"normal": UP, "objects": [0, -1]}]},
            "clip[0].objects[1]: expected an integer ≥ 0, got -1",
        ),
        ({"slice": True}, "slice: expected false, or a plane with a thickness, got true"),
        ({"slice": {"normal": UP}}, "slice.thickness: missing; expected a number > 0"),
        (
            {"cap": "white"},
            'cap: expected an object with the keys r, g and b, true or false, got "white"',
        ),
    ],
)
def test_files_say_it_wrong(written: dict[str, Any], problem: str) -> None:
    with pytest.raises(vtray.SceneError) as caught:
        vtray.loads(json.dumps({**SCENE, "style": written}))
    assert str(caught.value) == f"<string>: style.{problem}"


@pytest.mark.parametrize(
    ("given", "style"),
    [
        ({"clip": "0,0,1,2"}, Style(clip=PLANE)),
        ({"clip": "0,0,1,2;1,0,0"}, Style(clip=[PLANE, vtray.ClipPlane((1, 0, 0))])),
        ({"clip": [(0, 0, 1, 2), {"normal": (1, 0, 0)}]}, Style(clip="0,0,1,2;1,0,0")),
        ({"clip": "off", "slice": "off", "cap": "off"}, Style()),
        ({"clip": False}, Style()),
        ({"slice": "0,0,1,5"}, Style(slice=vtray.Slice((0, 0, 1), 5))),
        ({"cap": "white"}, Style(cap=vtray.Color(255, 255, 255))),
    ],
)
def test_code_says_it(given: dict[str, Any], style: Style) -> None:
    assert Style(**given) == style


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({"clip": "0,0,0,1"}, "Style.clip: expected planes as NX,NY,NZ or NX,NY,NZ,D, with"),
        ({"clip": "1,2"}, "Style.clip: expected planes as NX,NY,NZ or NX,NY,NZ,D, with"),
        ({"clip": "1,0,0,x"}, "Style.clip: expected planes as NX,NY,NZ or NX,NY,NZ,D, with"),
        ({"clip": True}, "Style.clip: expected planes as NX,NY,NZ or NX,NY,NZ,D, with"),
        ({"clip": 3}, "Style.clip: expected planes as NX,NY,NZ or NX,NY,NZ,D, with"),
        ({"clip": (1, 0, 0, float("nan"))}, "ClipPlane.distance: expected a finite number, got"),
        ({"slice": True}, "Style.slice: expected false, or a plane with a thickness, got True"),
        ({"slice": "1,0,0,1,0"}, "Slice.thickness: expected a number > 0, got 0"),
        (
            {"cap": "whit"},
            "Style.cap: expected a colour such as red or #ff8000, or on or off, got whit",
        ),
    ],
)
def test_code_says_it_wrong(given: dict[str, Any], problem: str) -> None:
    with pytest.raises(vtray.SceneError) as caught:
        Style(**given)
    assert str(caught.value).startswith(problem)


def test_options_take_what_follows() -> None:
    arguments = ["--clip", "-1,0,0,2", "--cap", "--slice", "0,0,1,3", "a.json"]
    given = with_parts(arguments, Style)
    assert given == ["--clip=-1,0,0,2", "--cap=", "--slice=0,0,1,3", "a.json"]


def test_rooms() -> None:
    scene = vtray.loads(json.dumps(SCENE))
    assert rooms_of(Style(), scene) is None
    slab = rooms_of(Style(slice=(0, 0, 2, 5, 1)), scene)
    assert slab is not None
    assert slab.walls == (((0, 0, 5.5, 0, 0, 1), (0, 0, 4.5, 0, 0, -1)),)
    some = vtray.ClipPlane((1, 0, 0), 0, objects=[0])
    rooms = rooms_of(Style(clip=some), scene)
    assert rooms is not None
    assert [len(rooms.walls_of(k)) for k in range(3)] == [1, 0, 0]
    with pytest.raises(vtray.RenderError, match=r"style.clip\[0\].objects: expected places in"):
        accelerate(scene, style=Style(clip=vtray.ClipPlane((1, 0, 0), 0, objects=[99])))
    scene.objects = []
    with pytest.raises(vtray.RenderError, match=r"style.slice: the scene has no middle; give a"):
        rooms_of(Style(slice=(0, 0, 1, 3)), scene)
