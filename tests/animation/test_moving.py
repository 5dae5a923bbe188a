"""Clip planes, slices and opacities that move, between keyframes or by functions."""

import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import vtray
from conftest import once
from vtray.animation.between_planes import between_clips, between_slices
from vtray.animation.fading import between_opacities, faded, opacity_of
from vtray.animation.keyframes import Keyframes, straight
from vtray.animation.moving import way_of_opacity, way_of_part
from vtray.base.errors import SceneError

SIZE = (16, 12)


def balls(**more: Any) -> vtray.Scene:
    """Return a scene of two objects and a light."""
    scene = vtray.Scene()
    scene.add_spheres([(-1, 0, 0), (1, 0, 0)], 1.0, color="white", **more)
    scene.add_sphere((0, 0, 0.5), 0.8, color="tomato")
    scene.camera = vtray.Camera.look_at((0, -7, 0), (0, 0, 0), up=(0, 0, 1), size=SIZE)
    scene.lights = [vtray.Light((-5, -9, 3))]
    return scene


def pixels(folder: Path) -> list[np.ndarray]:
    return [np.asarray(Image.open(path)) for path in sorted(folder.glob("*.png"))]


def plane_at(k: int) -> vtray.ClipPlane:
    """Return what lies between distances of -1 and 1 from picture 0 to 4, worked out by hand."""
    share = (0, 5 / 32, 1 / 2, 27 / 32, 1)[k]
    return vtray.ClipPlane((1, 0, 0), distance=-1 + 2 * share)


@once
def test_pictures_are_stills_with_the_same_planes(tmp_path: Path) -> None:
    keys = {0: (1, 0, 0, -1), 4: (1, 0, 0, 1)}
    ways: list[Any] = [keys, plane_at]
    for k, clip in enumerate(ways):
        vtray.animate(
            balls(), tmp_path / f"{k}" / "%d.png", frames=5, clip=clip, cap=True, exposure=1.0
        )
        for n, found in enumerate(pixels(tmp_path / f"{k}")):
            still = vtray.render(balls(), clip=plane_at(n), cap=True, exposure=1.0)
            assert (found == still.pixels).all()


@once
def test_keyframes_say_how_many_pictures_there_are(tmp_path: Path) -> None:
    scene = balls()
    vtray.animate(scene, tmp_path / "%d.png", clip={2: (1, 0, 0, 1)}, opacity={0: 1, 3: 0.5})
    assert len(pixels(tmp_path)) == 4


def test_planes_turn_the_shortest_way_and_evenly() -> None:
    one, other = vtray.ClipPlane((2, 0, 0), 1.0), vtray.ClipPlane((-1, 1, 0), 3.0)  # 135 degrees
    for share, degrees in ((0.0, 0), (0.25, 33.75), (0.5, 67.5), (1.0, 135)):
        (found,) = between_clips([one], [other], share)
        normal = np.array([found.normal.x, found.normal.y, found.normal.z])
        angle = math.radians(degrees)
        wanted = (math.cos(angle), math.sin(angle), 0)
        assert normal / np.linalg.norm(normal) == pytest.approx(wanted, abs=1e-9)
        assert found.distance == 1 + 2 * share
    assert between_clips([one], [other], 1.0) == (other,)


def test_planes_move_through_their_centers() -> None:
    one, other = (vtray.ClipPlane((0, 0, 1), center=(0, 0, z), objects=[1]) for z in (1, 5))
    (found,) = between_clips([one], [other], 0.25)
    assert found == one.replace(center=vtray.Vector(0, 0, 2))
    free = vtray.ClipPlane((0, 0, 1))
    assert between_clips([free], [free], 0.5) == (free,)


def test_slabs_grow() -> None:
    one, other = vtray.Slice((0, 0, 1), 1, 0), vtray.Slice((0, 0, 1), 3, 2)
    assert between_slices(one, other, 0.75) == vtray.Slice((0, 0, 1), 2.5, 1.5)
    keys = {0: (0, 0, 1, 0, 1), 2: other}
    assert way_of_part("slice", keys)(1) == vtray.Slice((0, 0, 1), 2, 1)


@once
def test_pictures_are_stills_with_the_same_opacities(tmp_path: Path) -> None:
    keys = {0: 1.0, 2: (0.5, 1.0), 4: (0.0, 1.0)}
    vtray.animate(balls(), tmp_path / "%d.png", opacity=keys, exposure=1.0)
    for k, (found, opacity) in enumerate(
        zip(pixels(tmp_path), (1.0, 0.75, 0.5, 0.25, 0.0), strict=True)
    ):
        still = vtray.render(balls(opacity=opacity), exposure=1.0)
        assert (found == still.pixels).all(), k


def test_opacities_between_others() -> None:
    assert between_opacities(0.2, 0.6, 0.5) == pytest.approx(0.4)
    assert between_opacities(1.0, (0.0, 0.5), 0.5) == (0.5, 0.75)
    assert between_opacities((None, 0.5), (None, 1.0), 0.5) == (None, 0.75)
    assert way_of_opacity({1: 0.25, 3: 0.5})(0) == 0.25
    assert way_of_opacity(lambda k: k / 4)(3) == 0.75


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            [[0.5, 1], 1],
            r"opacity\[0\]: expected a number from 0 to 1, or one for each, got \[0.5,",
        ),
        ([0.5, "1"], r"opacity\[1\]: expected a number from 0 to 1, or one for each, got '1'"),
        (np.zeros((2, 2)), r"opacity\[0\]: expected a number from 0 to 1, or one for each, got "),
        ("half", "opacity: expected a number from 0 to 1, or one for each, got 'half'"),
        ({0.5}, "opacity: expected a number from 0 to 1, or one for each, got {0.5}"),
    ],
)
def test_wrong_opacities(given: Any, message: str) -> None:
    with pytest.raises(SceneError, match=f"^{message}"):
        opacity_of(given, "opacity")


@pytest.mark.parametrize("given", [0.5, np.float32(0.5), np.array(0.5)])
def test_one_opacity(given: Any) -> None:
    assert opacity_of(given, "opacity") == 0.5
    assert opacity_of(np.array([0, 0.5]), "opacity") == (0, 0.5)


def test_what_fades_and_what_does_not() -> None:
    scene = balls()
    parts = [vtray.Sphere((0, 0, 0), 1)]
    scene.objects += [vtray.Copies(parts, [(0, 0, 0)]), vtray.Stars([(0, 0, 9)])]
    *bodies, copies, stars = faded(scene.objects, 0.5)
    assert [body.opacity for body in bodies] == [0.5, 0.5]
    assert copies.objects[0].opacity == 0.5
    assert stars is scene.objects[-1]
    assert faded(scene.objects, (None, 0.1, None, None))[0] is scene.objects[0]
    assert scene.objects[0].opacity is None


@once
def test_particles_fade_around_those_that_stand_out(tmp_path: Path) -> None:
    particles = vtray.Particles([(0, 0, 0), (0, 0, 3)], columns={"charge": [1.0, -1.0]})
    given: dict[str, Any] = {"highlight": "charge > 0", "size": SIZE}
    vtray.animate([particles] * 3, tmp_path / "k/%d.png", opacity={0: 1.0, 2: 0.0}, **given)
    for k, opacity in enumerate((1.0, 0.5, 0.0)):
        name = tmp_path / f"{k}" / "%d.png"
        vtray.animate([particles], name, opacity=opacity, **given)
    stills = [pixels(tmp_path / f"{k}")[0] for k in range(3)]
    assert (stills[0] != stills[2]).any()
    # The exposure of scenes whose lights were never set is not that of the first.
    for found, still in zip(pixels(tmp_path / "k"), stills, strict=True):
        assert (found == still).all()


def test_turntable_whose_plane_moves(tmp_path: Path) -> None:
    scene = balls()
    keys = {0: (0, 0, 1, 1), 2: (0, 0, 1, 0)}
    more: dict[str, Any] = {"lights": "still", "exposure": 1.0, "seconds": 1, "fps": 4}
    vtray.turntable(scene, tmp_path / "%d.png", clip=keys, opacity=0.5, **more)
    *_, last = pixels(tmp_path)
    scene.camera = scene.camera.orbit(270, about=scene)
    scene.objects = faded(scene.objects, 0.5)
    still = vtray.render(scene, clip=(0, 0, 1, 0), exposure=1.0)
    assert np.abs(last.astype(int) - still.pixels).max() <= 1


ERRORS: list[tuple[dict[str, Any], str]] = [
    ({"clip": {}}, "clip: expected values by the numbers of pictures, got none"),
    ({"clip": {-1: (1, 0, 0, 0)}}, "clip: expected numbers of pictures from 0, got -1"),
    ({"clip": {0: "x"}}, r"clip\[0\]: expected planes as NX,NY,NZ or NX,NY,NZ,D"),
    (
        {"clip": {0: (1, 0, 0, 0), 5: [(1, 0, 0, 0), (0, 1, 0, 0)]}},
        r"clip\[5\]: expected as many planes as clip\[0\] has, 1, got 2",
    ),
    (
        {"clip": {0: (1, 0, 0, 0), 5: (1, 0, 0)}},
        r"clip\[5\]: expected a plane with a distance, as clip\[0\] has, got no distance",
    ),
    (
        {"clip": {0: (1, 0, 0, 0), 5: (-2, 0, 0, 0)}},
        r"clip\[5\]: expected a normal that is not opposite to that of clip\[0\]; put a keyframe",
    ),
    (
        {"clip": {0: vtray.ClipPlane((1, 0, 0), 0, objects=[0]), 5: (1, 0, 0, 0)}},
        r"clip\[5\]: expected a plane that cuts the objects that clip\[0\] cuts, \[0\], got all",
    ),
    ({"clip": lambda k: k}, "clip of picture 0: expected planes as NX,NY,NZ or"),
    ({"slice": {0: False}}, r"slice\[0\]: expected a slab, got False"),
    ({"opacity": {}}, "opacity: expected values by the numbers of pictures, got none"),
    ({"opacity": {0: 2}}, r"opacity\[0\]: expected a number from 0 to 1, or one for each, got 2"),
    ({"opacity": {0: (0.5, -1)}}, r"opacity\[0\]\[1\]: expected a number from 0 to 1"),
    ({"opacity": "charge"}, "opacity: expected a number from 0 to 1, or one for each, got 'c"),
    ({"opacity": {0: (1, 1), 5: [1]}}, r"opacity\[5\]: expected opacities of as many objects"),
    (
        {"opacity": {0: (None, 1), 5: 1}},
        r"opacity\[5\]: expected None for object 0, as opacity\[0\] has, got 1",
    ),
    ({"opacity": (1, 1, 1)}, "opacity: expected a number, or one for each of 2 objects, got 3"),
    ({"opacity": lambda k: 3 - k}, "opacity of picture 0: expected a number from 0 to 1"),
]


@pytest.mark.parametrize(("wrong", "message"), ERRORS)
def test_errors(wrong: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=message):
        vtray.animate(balls(), tmp_path / "a.gif", **{"frames": 3, **wrong})
    assert not [*tmp_path.iterdir()]


def test_keyframes_may_be_between_pictures() -> None:
    moving = Keyframes("opacity", {Fraction(3, 2): 1.0, 0: 0.0}, straight)
    assert [moving(k) for k in (0, 2)] == [0.0, 1.0]
    assert 0.5 < moving(1) < 1.0
