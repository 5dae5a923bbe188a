"""Rough metal, plastic and glass as users get them, beside integrals that an oracle works out."""

import math
from typing import Any

import numpy as np
import pytest
from oracle_gloss import Surface, scattered

import vtray
from conftest import once
from vtray.scene.materials import Blend, Glass, Material, Metal, Plastic

WHITE = (255, 255, 255)
ORANGE = (255, 153, 51)
OUT = np.array([0.0, -math.sin(0.7), math.cos(0.7)])
"""Where the camera is, as seen from what it looks at."""

MIRRORED = np.array([0.0, math.sin(0.7), math.cos(0.7)])


def seen_at(material: Any, lights: list[Any], color: Any = ORANGE, samples: int = 1024) -> Any:
    """Return the light of one point of a floor, 1 for white."""
    scene = vtray.Scene()
    scene.objects = [vtray.Plane((0, 0, 0), (0, 0, 1), color, material=material)]
    scene.lights = lights
    scene.camera = vtray.Camera.look_at(
        tuple(9 * OUT), target=(0, 0, 0), up=(0, 0, 1), fov_degrees=0.01, size=(2, 2)
    )
    image = vtray.render(scene, integrator="path", samples=samples, depth=2)
    return image.linear.mean(axis=(0, 1)) / 255


SURFACES = [
    (Metal(roughness=0.2), Surface(0.2, np.array(ORANGE) / 255)),
    (Metal(roughness=0.6), Surface(0.6, np.array(ORANGE) / 255)),
    (Plastic(1.5, 0.15), Surface(0.15, np.array(ORANGE) / 255, 1.5, is_metal=False)),
    (Plastic(1.8, 0.7), Surface(0.7, np.array(ORANGE) / 255, 1.8, is_metal=False)),
]


@once
@pytest.mark.parametrize(("material", "surface"), SURFACES)
def test_points_and_suns_show_what_the_formula_says(material: Material, surface: Surface) -> None:
    way = np.array([0.1, 0.55, 0.8])
    way /= np.linalg.norm(way)
    expected = math.pi * scattered(surface, way[None], OUT)[0]
    for light in (vtray.Light(tuple(7 * way), 1), vtray.Sun(tuple(-way), angle=0)):
        found = seen_at(material, [light], samples=1)
        assert found == pytest.approx(expected, rel=4e-3)


AXIS = MIRRORED + np.array([0.1, 0.0, 0.1])
AXIS /= np.linalg.norm(AXIS)


def shown_of_disc(surface: Surface, spread: float) -> Any:
    """Return what a surface shows of a disc in the sky of radiance 1, around `AXIS`."""
    height, angle = np.meshgrid(
        1 - spread * (np.arange(400) + 0.5) / 400, 2 * math.pi * (np.arange(400) + 0.5) / 400
    )
    aside = np.sqrt(1 - height**2)
    one = np.cross(AXIS, [1.0, 0.0, 0.0])
    one /= np.linalg.norm(one)
    other = np.cross(AXIS, one)
    ways = (
        height[..., None] * AXIS
        + (aside * np.cos(angle))[..., None] * one
        + (aside * np.sin(angle))[..., None] * other
    ).reshape(-1, 3)
    ways = ways[ways[:, 2] > 1e-6]
    area = 2 * math.pi * spread / 160000
    return area * scattered(surface, ways, OUT).sum(axis=0)


@once
@pytest.mark.parametrize(("material", "surface"), SURFACES)
@pytest.mark.parametrize("radius", [0.05, 0.7, 3])
def test_ball_lamps_show_what_their_integral_is(
    material: Material, surface: Surface, radius: float
) -> None:
    """Small lamps are found by shadow rays, large ones by those that go on; together, once."""
    expected = 2.5 * shown_of_disc(surface, 1 - math.sqrt(1 - (radius / 5) ** 2))
    lamp = vtray.SphereLight(tuple(5 * AXIS), radius, radiance=2.5)
    assert seen_at(material, [lamp]) == pytest.approx(expected, rel=0.02)
    # As many lamps as share shadow rays, of which one has light.
    dark = [vtray.SphereLight((k, 0, 9), 0.1, radiance=0) for k in range(30)]
    crowded = seen_at(material, [*dark[:11], lamp, *dark[11:]])
    assert crowded == pytest.approx(expected, rel=0.15)


@once
@pytest.mark.parametrize(("material", "surface"), SURFACES)
@pytest.mark.parametrize("angle", [2, 8, 70])
def test_suns_show_what_their_integral_is(
    material: Material, surface: Surface, angle: float
) -> None:
    """Wide ones are met by rays that go on, too, and counted once."""
    half = math.radians(angle) / 2
    radiance = 0.3 / math.sin(half) ** 2
    expected = radiance * shown_of_disc(surface, 1 - math.cos(half))
    found = seen_at(material, [vtray.Sun(tuple(-AXIS), 0.3, angle)])
    assert found == pytest.approx(expected, rel=0.02)


@once
@pytest.mark.parametrize(("material", "surface"), SURFACES)
def test_panels_and_lamps_of_given_intensity_show_what_their_integral_is(
    material: Material, surface: Surface
) -> None:
    across, up = np.meshgrid((np.arange(300) - 149.5) / 150, (np.arange(300) - 149.5) / 150)
    places = np.stack([across * 1.5, up * 1.0 + 3, np.full_like(up, 4.0)], axis=-1).reshape(-1, 3)
    distance = np.linalg.norm(places, axis=1)
    ways = places / distance[:, None]
    angles = (3.0 * 2.0 / 90000) * ways[:, 2] / distance**2
    shown = (scattered(surface, ways, OUT) * angles[:, None]).sum(axis=0)
    edges = (3, 0, 0), (0, 2, 0)
    bright = vtray.RectangleLight((0, 3, 4), edges, radiance=3)
    assert seen_at(material, [bright]) == pytest.approx(3 * shown, rel=0.02)


@once
@pytest.mark.parametrize(("material", "surface"), SURFACES)
def test_pictures_of_skies_show_what_their_integral_is(
    material: Material, surface: Surface
) -> None:
    """A sky that is dark but for one patch, which its rays are drawn to."""
    pixels = np.full((32, 64, 3), 0.05)
    pixels[4:9, 28:36] = (40.0, 30.0, 20.0)
    sky = vtray.Sky(1, image=pixels)
    # The light of the same sky on white, matt floors that face each way tells where it is.
    found = seen_at(material, [sky], samples=2048)
    separate = [seen_at(material, [vtray.Sky(1, image=np.where(mask, pixels, 0))], samples=2048)
                for mask in (pixels > 1, pixels <= 1)]  # fmt: skip
    assert found == pytest.approx(sum(separate), rel=0.03)
    even = seen_at(material, [vtray.Sky(0.05)], samples=2048)
    dim = seen_at(material, [vtray.Sky(1, image=np.full((32, 64, 3), 0.05))], samples=2048)
    assert dim == pytest.approx(even, rel=0.02)


MATERIALS = [
    Plastic(),
    Plastic(1.5, 0.3),
    Plastic(2.4, 1),
    Metal(roughness=0.05),
    Metal(roughness=1),
    Glass(roughness=0.3),
    Glass(0.7, roughness=0.6),
    Glass(roughness=1),
    Blend(Plastic(), Metal(roughness=0.4), 0.2),
    Metal(roughness=0.5),
    Glass(thin=True),
    Blend("lambert", "mirror"),
]


@once
@pytest.mark.parametrize("material", MATERIALS)
def test_white_furnaces_are_white(material: Material) -> None:
    """Where everything is white and the light the same from everywhere, nothing is seen."""
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, WHITE, material=material),
        vtray.Sphere((0.6, 0.1, 0.4), 0.4, WHITE),
        vtray.Plane((0, 0, 0), (0, 0, 1), WHITE),
    ]
    scene.lights = [vtray.Sky(1)]
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=12, size=(5, 5)
    )
    light = vtray.render(scene, integrator="path", samples=256, depth=64).linear / 255
    assert light.mean() == pytest.approx(1, abs=0.01)


@once
def test_threads_change_nothing_with_all_kinds_of_lights() -> None:
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, ORANGE, material=Metal(roughness=0.3)),
        vtray.Plane((0, 0, 0), (0, 0, 1), WHITE, material=Plastic(1.5, 0.4)),
    ]
    pixels = np.full((8, 16, 3), 0.05)
    pixels[1, 7] = 40.0
    scene.lights = [
        vtray.Sky(1, image=pixels),
        vtray.Light((0, 3, 3)),
        vtray.Sun((0, -1, -1)),
        vtray.RectangleLight((0, 3, 4), ((3, 0, 0), (0, 2, 0)), radiance=3),
        *(vtray.SphereLight((k - 15, 0, 9), 0.1, radiance=9) for k in range(30)),
    ]
    scene.camera = vtray.Camera.look_at(
        (0, -5, 4), target=(0, 0, 0.3), up=(0, 0, 1), fov_degrees=30, size=(4, 3)
    )
    one, two = (
        vtray.render(scene, integrator="path", samples=2, depth=2, threads=threads, tile=tile)
        for threads, tile in ((1, 64), (2, 2))
    )
    assert (one.linear == two.linear).all()
    assert one.linear.max() > 0
