"""Lights of all kinds made in code, added to scenes, and with other intensities."""

import copy
import inspect
import math
import pickle
from collections.abc import Callable
from typing import Any

import pytest

from vtray import (
    Ambient,
    Camera,
    Color,
    Direction,
    Light,
    RectangleLight,
    Scene,
    SceneError,
    Sky,
    SphereLight,
    Sun,
    Vector,
)
from vtray.image.exposure import check_brightness
from vtray.scene.edits import relit
from vtray.scene.light_types import AnyLight, strength_of

INF, NAN = math.inf, math.nan
SIDES = ((2, 0, 0), (0, 0, -3))
CAMERA = Camera((0, 0, 0), (0, 0, 1), 1, (4, 3), (0.1, 0.1))
LIGHTS: list[AnyLight] = [
    Light((1, 2, 3), 0.5, (9, 8, 7)),
    Sun((0, 0, -1), 0.25, 3.0, (9, 8, 7)),
    SphereLight((1, 2, 3), 4.0, 2.0, (9, 8, 7)),
    Sky(0.75, (9, 8, 7)),
    RectangleLight((1, 2, 3), SIDES, 0.125, (9, 8, 7)),
    RectangleLight((1, 2, 3), SIDES, radiance=6.0),
    SphereLight((1, 2, 3), 4.0, radiance=7.0),
    Ambient(3.0, 5.0, (9, 8, 7)),
    Ambient(),
]


def test_what_may_be_left_out() -> None:
    white = Color(255, 255, 255)
    assert Light((1, 2, 3)) == Light(Vector(1, 2, 3), 1.0, white)
    assert Sun((0, 0, -1)) == Sun(Direction(0, 0, -1), 1.0, 0.53, white)
    assert SphereLight((1, 2, 3), 4) == SphereLight(Vector(1, 2, 3), 4.0, 1.0, white)
    sides = (Vector(2, 0, 0), Vector(0, 0, -3))
    assert RectangleLight((1, 2, 3), SIDES) == RectangleLight(Vector(1, 2, 3), sides, 1.0, white)
    assert SphereLight((1, 2, 3), 4, radiance=2).intensity is None
    assert Sky() == Sky(1.0, white)
    assert Ambient() == Ambient(1.0, INF, white)
    for kind, count in (
        (Light, 2),
        (Sun, 3),
        (SphereLight, 4),
        (RectangleLight, 4),
        (Sky, 6),
        (Ambient, 3),
    ):
        parameters = inspect.signature(kind).parameters.values()
        assert sum(one.default is not one.empty for one in parameters) == count


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Light((1, 2)), "Light.location: expected Vector or three numbers, got (1, 2)"),
        (lambda: Light((1, 2, NAN)), "Light.location.z: expected a finite number, got nan"),
        (
            lambda: Light((1, 2, 3), 1, (0, 0, 256)),
            "Light.color.b: expected an integer from 0 to 255, got 256",
        ),
        (
            lambda: Sun((0, 0, 0)),
            "Sun.direction: expected numbers x, y and z that are not all zero, got (0.0, 0.0, 0.0)",
        ),
        (lambda: Sun((0, 0, 1), NAN), "Sun.intensity: expected a finite number, got nan"),
        (lambda: Sun((0, 0, 1), INF), "Sun.intensity: expected a finite number, got inf"),
        (
            lambda: Sun((0, 0, 1), angle=-1),
            "Sun.angle: expected a number of degrees from 0 to 180, got -1",
        ),
        (
            lambda: Sun((0, 0, 1), angle=181),
            "Sun.angle: expected a number of degrees from 0 to 180, got 181",
        ),
        (lambda: SphereLight((0, 0, 0), -1), "SphereLight.radius: expected a number ≥ 0, got -1"),
        (lambda: SphereLight((0, 0, 0), INF), "SphereLight.radius: expected a finite number"),
        (
            lambda: SphereLight((0, 0, 0), 1, 1.0, radiance=2),
            "SphereLight.radiance: expected either this or the intensity, not both, got 2",
        ),
        (
            lambda: SphereLight((0, 0, 0), 1).replace(radiance=2),
            "SphereLight.radiance: expected either this or the intensity, not both, got 2",
        ),
        (
            lambda: SphereLight((0, 0, 0), 1, visible=2),  # type: ignore[arg-type]
            "SphereLight.visible: expected true or false, got 2",
        ),
        (lambda: SphereLight((0, 0, 0), 1, radiance=-1), "SphereLight.radiance: expected a number"),
        (
            lambda: RectangleLight((0, 0, 0), ((1, 0, 0), (0, 0, 0))),
            "RectangleLight.edges: expected two vectors that are not zero (a tiny one will do)",
        ),
        (
            lambda: RectangleLight((0, 0, 0), ((1, 0, 0), (1, 1, 0))),
            "RectangleLight.edges: expected two vectors at right angles to each other, got",
        ),
        (
            lambda: RectangleLight((0, 0, 0), ((1, 0, 0),)),
            "RectangleLight.edges: expected two vectors, got ((1, 0, 0))",
        ),
        (
            lambda: RectangleLight((0, 0, 0), ((1, 0, 0), (0, NAN, 0))),
            "RectangleLight.edges[1].y: expected a finite number, got nan",
        ),
        (
            lambda: RectangleLight((0, 0), SIDES),
            "RectangleLight.location: expected Vector or three",
        ),
        (lambda: Scene().add_rectangle_light((0, 0), SIDES), "add_rectangle_light: location: exp"),
        (
            lambda: Scene().add_rectangle_light((0, 0, 0), SIDES, 1, radiance=0),
            "RectangleLight.radiance: expected either this or the intensity, not both, got 0",
        ),
        (lambda: Sky(-1), "Sky.radiance: expected a number ≥ 0, got -1"),
        (lambda: Sky(gradient=(1, 2, 3)), "Sky.gradient: expected Gradient, got (1, 2, 3)"),  # type: ignore[arg-type]
        (
            lambda: Scene().add_sky(gradient={"zenit": "red"}),
            "add_sky: gradient: expected a Gradient, or a dictionary of some of zenith, horizon, "
            "ground, got {'zenit': 'red'}",
        ),
        (
            lambda: Scene().add_sky(gradient={"zenith": "redd"}),
            "add_sky: gradient: zenith: ",
        ),
        (
            lambda: Light((0, 0, 1), color="red"),  # type: ignore[arg-type]
            "Light.color: expected Color or three numbers, got 'red'; a name becomes numbers by "
            "vtray.colors.to_rgb('red')",
        ),
        (lambda: Sky(color="red"), "Sky.color: expected Color or three numbers, got 'red'"),  # type: ignore[arg-type]
        (lambda: Ambient(-1), "Ambient.intensity: expected a number ≥ 0, got -1"),
        (lambda: Ambient(distance=-1e-9), "Ambient.distance: expected a number ≥ 0, got -1e-09"),
        (lambda: Ambient(distance=NAN), "Ambient.distance: expected a number ≥ 0, got nan"),
        (lambda: Ambient(distance=-INF), "Ambient.distance: expected a number ≥ 0, got -inf"),
        (lambda: Scene().add_light((1, 2, 3), -1), "Light.intensity: expected a number ≥ 0"),
        (lambda: Scene().add_light("x"), "add_light: location: expected Vector or three"),  # type: ignore[call-overload]
        (lambda: Scene().add_light((1, 2, 3), color="rde"), "add_light: color: "),
        (lambda: Scene().add_sun((0, 0)), "add_sun: direction: expected Direction or three"),
        (lambda: Scene().add_sun((0, 0, 1), 1, 200), "Sun.angle: expected a number of degrees"),
        (lambda: Scene().add_sphere_light((0, 0), 1), "add_sphere_light: location: expected"),
        (lambda: Scene().add_sphere_light((0, 0, 0), -1), "SphereLight.radius: expected a number"),
        (lambda: Scene().add_sky(-1), "Sky.radiance: expected a number ≥ 0, got -1"),
        (lambda: Scene().add_sky(color=7), "add_sky: color: "),  # type: ignore[arg-type]
        (lambda: Scene().add_ambient(distance=-1), "Ambient.distance: expected a number ≥ 0"),
        (
            lambda: Scene().add_light(Sky(), 2),  # type: ignore[call-overload]
            "add_light: expected a light alone, or the location, intensity and color of a point, "
            "got a Sky and more",
        ),
    ],
)
def test_wrong_arguments(make: Callable[[], object], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        make()
    assert str(caught.value).startswith(message)


def test_lights_are_added() -> None:
    scene = Scene()
    added: list[AnyLight] = [
        scene.add_light((1, 2, 3)),
        scene.add_light([1, 2, 3], 0.5, "red"),
        scene.add_sun((0, 0, -1), 2, color="#ff8000"),
        scene.add_sphere_light((1, 2, 3), 4, 5, (0, 0, 255)),
        scene.add_sphere_light((1, 2, 3), 4, radiance=5),
        scene.add_rectangle_light((1, 2, 3), SIDES),
        scene.add_rectangle_light((1, 2, 3), SIDES, 5, "red"),
        scene.add_rectangle_light((1, 2, 3), [Vector(2, 0, 0), (0, 0, -3)], radiance=0),
        scene.add_rectangle_light((1, 2, 3), SIDES, visible=True),
        scene.add_sphere_light((1, 2, 3), 4, visible=True),
        scene.add_sky(0.5, "skyblue"),
        scene.add_ambient(0.3, 7),
        scene.add_ambient(),
        *(scene.add_light(light) for light in LIGHTS),
    ]
    assert added == [
        Light((1, 2, 3)),
        Light((1, 2, 3), 0.5, (255, 0, 0)),
        Sun((0, 0, -1), 2, 0.53, (255, 128, 0)),
        SphereLight((1, 2, 3), 4, 5, (0, 0, 255)),
        SphereLight((1, 2, 3), 4, radiance=5),
        RectangleLight((1, 2, 3), SIDES),
        RectangleLight((1, 2, 3), SIDES, 5, (255, 0, 0)),
        RectangleLight((1, 2, 3), SIDES, radiance=0),
        RectangleLight((1, 2, 3), SIDES, 1.0, (255, 255, 255), None, True),
        SphereLight((1, 2, 3), 4, 1.0, (255, 255, 255), None, True),
        Sky(0.5, (135, 206, 235)),
        Ambient(0.3, 7),
        Ambient(),
        *LIGHTS,
    ]
    assert all(one is other for one, other in zip(scene.lights, added, strict=True))
    with pytest.raises(TypeError, match="'angel' is unknown; did you mean \"angle\""):
        scene.add_sun((0, 0, -1), angel=3)  # type: ignore[call-arg]


def test_other_intensities_keep_all_else() -> None:
    scene = Scene(CAMERA, LIGHTS)
    changed = relit(scene, range(9)).lights
    assert list(map(strength_of, changed)) == [0, 1, 2, 3, 4, 5, 6, 7, 8]
    before = list(map(strength_of, scene.lights))
    assert before == [0.5, 0.25, 2, 0.75, 0.125, 6, 7, 3, 1]
    assert relit(Scene(CAMERA, changed), before).lights == LIGHTS
    for place in range(9):
        for wrong in (-1, "x", NAN):
            values: list[Any] = [1.0] * 9
            values[place] = wrong
            with pytest.raises(SceneError, match=rf"^relight: intensities\[{place}\]: expected"):
                relit(scene, values)


def test_brightness_is_that_of_all_lights() -> None:
    check_brightness(LIGHTS)
    for light in (
        Sun((0, 0, 1), 1e304),
        Sky(1e304),
        Ambient(1e304),
        SphereLight((0, 0, 0), 1, 1e304),
        SphereLight((0, 0, 0), 1, radiance=1e304),
        RectangleLight((0, 0, 0), SIDES, radiance=1e304),
    ):
        with pytest.raises(Exception, match="lights: the intensities add up to 1e"):
            check_brightness([*LIGHTS, light])


def test_lights_are_frozen_and_copied() -> None:
    for light in LIGHTS:
        assert pickle.loads(pickle.dumps(light)) == copy.deepcopy(light) == light
        assert light.replace(color=(1, 2, 3)).color == Color(1, 2, 3)
        with pytest.raises(AttributeError, match="cannot be changed"):
            light.color = Color(0, 0, 0)  # type: ignore[misc]
    with pytest.raises(AttributeError):
        LIGHTS[3].intensity = 3.0  # type: ignore[misc]
    scene = Scene(CAMERA, LIGHTS)
    scene.check()
    assert pickle.loads(pickle.dumps(scene)) == scene
