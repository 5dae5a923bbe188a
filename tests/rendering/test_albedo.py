"""What share of light surfaces scatter, in pictures."""

import numpy as np
import pytest

import vtray
from conftest import once

SIZE = 24


def two_balls(**settings: object) -> vtray.Scene:
    """Return two balls on black, one of which is a mirror."""
    scene = vtray.Scene()
    scene.add_sphere((-1, 0, 0), 0.8, color=(255, 128, 0), lambert=0.5)
    scene.add_sphere((1, 0, 0), 0.8, color=(51, 102, 204), material="mirror")
    scene.add_light((0, 0, 9))
    scene.camera = vtray.Camera.look_at(
        (0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), fov_degrees=25, size=(SIZE, SIZE)
    )
    scene.render = vtray.RenderSettings(**settings)
    return scene


OWN = np.array([255, 128, 0]) / 510, np.array([51, 102, 204]) / 255


@once
@pytest.mark.parametrize("integrator", ["direct", "path"])
@pytest.mark.parametrize("samples", [1, 4])
def test_albedo_is_color_times_lambert(integrator: str, samples: int) -> None:
    image = vtray.render(two_balls(), integrator=integrator, samples=samples, warn=[].append)
    middle, side = SIZE // 2, round(SIZE * 0.25)
    assert image.albedo[middle, side] == pytest.approx(OWN[0])
    assert image.albedo[middle, SIZE - side] == pytest.approx(OWN[1])
    assert (image.albedo[0] == 0).all()
    shares = image.albedo[..., 0] / OWN[0][0]
    is_edge = (shares[:, :middle] > 0.01) & (shares[:, :middle] < 0.99)
    assert is_edge.any() == (samples > 1)


RED = np.array([0.8, 0.0, 0.0])
SHARES = {
    "mirror": (vtray.Mirror(), RED),
    "emissive": (vtray.Emissive(3), RED),
    "plastic": (vtray.Plastic(1.5), 0.04 + 0.96 * 0.5 * RED),
    "glass": (vtray.Glass(1.5), 0.04 + 0.96 * RED),
    "thin glass": (vtray.Glass(1.5, thin=True), 0.08 / 1.04 + 0.96 / 1.04 * RED),
    "metal": (vtray.Metal(), RED),
    "blend": (vtray.Blend(vtray.Glass(1.5), vtray.Mirror(), 0.25), 0.03 + 0.97 * RED),
}


@pytest.mark.parametrize("integrator", ["whitted", "path"])
@pytest.mark.parametrize("name", SHARES)
def test_albedo_counts_what_is_mirrored_and_let_through(integrator: str, name: str) -> None:
    material, share = SHARES[name]
    scene = two_balls()
    scene.objects[0] = vtray.Plane((0, 0, 0), (0, 0, 1), (204, 0, 0), 0.5, material=material)
    image = vtray.render(scene, integrator=integrator, size=(9, 9))
    assert image.albedo[4, 4] == pytest.approx(share, abs=1e-3)
    if material == vtray.Plastic(1.5):
        assert image.albedo[0, 0, 1] > image.albedo[4, 4, 1]


@once
def test_albedo_of_rough_metal_has_the_light_of_many_facets() -> None:
    scene = two_balls()
    scene.objects = [vtray.Plane((0, 0, 0), (0, 0, 1), material=vtray.Metal(roughness=1))]
    image = vtray.render(scene, integrator="path", size=(9, 9))
    assert image.albedo == pytest.approx(1)


def test_albedo_within_glass_is_1_where_all_is_mirrored() -> None:
    scene = two_balls()
    scene.objects = [vtray.Sphere((0, 0, 8), 2, (204, 0, 0), material="glass")]
    scene.camera = vtray.Camera.look_at(
        (1.8, 0, 8), target=(1.8, 9, 8), up=(0, 0, 1), fov_degrees=25, size=(9, 9)
    )
    image = vtray.render(scene, integrator="path")
    assert (image.albedo[4, 4] == 1).all()


def test_colors_of_tone_maps_are_decoded() -> None:
    image = vtray.render(two_balls(), tonemap="agx", warn=[].append)
    decoded = ((128 / 255 + 0.055) / 1.055) ** 2.4 / 2
    assert image.albedo[SIZE // 2, SIZE // 4] == pytest.approx([0.5, decoded, 0])


def test_recolored_pictures_have_their_own() -> None:
    image = vtray.render(two_balls(), keep_lights=True, warn=[].append)
    before = image.albedo.copy()
    other = image.recolor(0, color=(0, 255, 0))
    assert other.albedo[SIZE // 2, SIZE // 4] == pytest.approx([0, 0.5, 0])
    assert (image.albedo == before).all()
    assert (other.albedo[:, SIZE // 2 + 1 :] == before[:, SIZE // 2 + 1 :]).all()


def test_light_over_albedo_is_the_same_for_all_colors() -> None:
    image = vtray.render(two_balls(), warn=[].append)
    scene = two_balls()
    scene.objects[0] = scene.objects[0].replace(color=(255, 255, 255), lambert=1.0)
    white = vtray.render(scene, warn=[].append)
    seen = image.ids[..., 0] == 0
    np.testing.assert_allclose(
        image.linear[seen][:, :2] / image.albedo[seen][:, :2], white.linear[seen][:, :2], rtol=1e-9
    )


@once
@pytest.mark.parametrize("integrator", ["direct", "path"])
def test_how_many_rays_each_pixel_has(integrator: str) -> None:
    scene = two_balls()
    one = vtray.render(scene, integrator=integrator, warn=[].append)
    assert (one.samples == 1).all()
    image = vtray.render(scene, integrator=integrator, samples=5, warn=[].append)
    assert set(np.unique(image.samples)) == {1, 5}
    assert image.samples[0, 0] == 1
    assert image.samples[SIZE // 2, SIZE // 4] == 5
    lens = scene.camera.replace(lens=vtray.Lens(0.1, 9))
    through = vtray.render(
        vtray.Scene(lens, scene.lights, scene.objects), samples=5, warn=[].append
    )
    assert (through.samples == 5).all()
    assert image.stats["rays"] >= image.samples.sum()
