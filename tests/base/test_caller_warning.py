"""Warnings name the line of a user's program that has called vtray, however deep they arise."""

import inspect
import json
from collections.abc import Callable

import pytest

import vtray

ATOM = vtray.Particles([(9.0, 9.0, 9.0)], {"element": ["H"]}, cell=[1, 1, 1])


def ball(**camera: object) -> vtray.Scene:
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 9), 1)
    scene.camera = vtray.Camera.look_at((0, 0, 0), (0, 0, 9), size=(8, 8)).replace(**camera)
    return scene


BEHIND = ball(normal=(0, 0, -1))
UNKNOWN = {**ball().to_dict(), "ligts": []}

CALLS = [
    ("norm: ", lambda: vtray.Scene().add_particles([(0, 0, 9)], color=[-1.0], norm="log")),
    ("cell: ", lambda: vtray.Scene().add_particles(ATOM)),
    ("ligts: ", lambda: vtray.load_dict(UNKNOWN)),
    ("ligts: ", lambda: vtray.loads(json.dumps(UNKNOWN))),
    ("lens: ", lambda: vtray.render(ball(lens=vtray.Lens(0.1, 9)), samples=1)),
    ("scalebar: ", lambda: vtray.render(BEHIND).figure(scalebar="nm")),
]


@pytest.mark.parametrize(("words", "call"), CALLS)
def test_the_line_is_that_of_who_calls(words: str, call: Callable[[], object]) -> None:
    with pytest.warns(UserWarning, match=words) as caught:
        call()
    line = inspect.getsourcelines(call)[1]
    assert {(each.filename, each.lineno) for each in caught} == {(__file__, line)}
