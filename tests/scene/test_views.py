"""Named views, the view that shows a shape, and cameras made of others."""

import math

import numpy as np
import pytest

import vtray
from conftest import once
from vtray import Camera, SceneError, Vector
from vtray.scene.placing.bounds import Balls
from vtray.scene.placing.moved import axes_of
from vtray.scene.placing.views import moments, principal_axes, tilt_of

POINTS = np.random.default_rng(3).normal(size=(60, 3))


def right_up(camera: Camera) -> tuple[list[float], list[float]]:
    """Return what points to the right and up in the picture, rounded."""
    right, down, _ = axes_of(camera)
    return [round(c, 9) + 0.0 for c in right], [round(-c, 9) + 0.0 for c in down]


@pytest.mark.parametrize(
    ("view", "direction", "right", "up"),
    [
        ("front", (0, 1, 0), (1, 0, 0), (0, 0, 1)),
        ("-y", (0, 1, 0), (1, 0, 0), (0, 0, 1)),
        ("back", (0, -1, 0), (-1, 0, 0), (0, 0, 1)),
        ("y", (0, -1, 0), (-1, 0, 0), (0, 0, 1)),
        ("right", (-1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ("x", (-1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ("left", (1, 0, 0), (0, -1, 0), (0, 0, 1)),
        ("-x", (1, 0, 0), (0, -1, 0), (0, 0, 1)),
        ("top", (0, 0, -1), (1, 0, 0), (0, 1, 0)),
        ("z", (0, 0, -1), (1, 0, 0), (0, 1, 0)),
        ("bottom", (0, 0, 1), (1, 0, 0), (0, -1, 0)),
        ("-z", (0, 0, 1), (1, 0, 0), (0, -1, 0)),
        ((-90, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1)),
        ((0, 90), (0, 0, -1), (0, 1, 0), (-1, 0, 0)),
    ],
)
def test_views(view: object, direction: object, right: object, up: object) -> None:
    camera = Camera.fit(POINTS, view=view)  # type: ignore[arg-type]
    n = camera.normal
    assert (n.x, n.y, n.z) == direction
    assert right_up(camera) == (list(right), list(up))  # type: ignore[call-overload]


def test_iso_sees_all_axes_alike() -> None:
    normal = Camera.fit(POINTS, view="iso").normal
    assert (normal.x, normal.y, normal.z) == pytest.approx((-1, 1, -1) / np.sqrt(3))


def test_views_are_those_of_directions() -> None:
    made = Camera.fit(POINTS, view="front", size=(30, 20))
    assert made == Camera.fit(POINTS, direction=(0, 1, 0), up=(0, 0, 1), size=(30, 20))
    assert Camera.fit(POINTS, view="front", up=(1, 0, 0)).up == vtray.Direction(1, 0, 0)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            {"view": "frnt"},
            'view: expected "x", .* or azimuth and elevation .* got "frnt"; did you',
        ),
        ({"view": (0, 91)}, r"view\[1\]: expected an elevation from -90 to 90 degrees, got 91"),
        ({"view": 3}, "view: expected"),
        ({"view": 30}, "view: expected azimuth and elevation in degrees, or the name .* got 30$"),
        ({"view": np.array(30.0)}, "view: expected azimuth and elevation .* got array"),
        ({"view": (1, 2, 3)}, r"view: expected azimuth and elevation .* got \(1, 2, 3\)$"),
        ({"view": "top", "direction": (0, 1, 0)}, "view: expected None where direction is given"),
        ({"zoom": np.arange(2)}, r"zoom: expected a number from 1e-9 to 1e9, got \[0, 1\]"),
        ({"zoom": 1e300}, "zoom: expected a number from 1e-9 to 1e9, got 1e.300"),
    ],
)
def test_wrong_views(keys: dict[str, object], message: str) -> None:
    with pytest.raises(SceneError, match=f"^Camera.fit: {message}"):
        Camera.fit(POINTS, **keys)  # type: ignore[arg-type]


def shape(lengths: tuple[float, float, float], seed: int = 1) -> np.ndarray:
    """Return a cloud with such extents along axes that are turned at random, with these."""
    random = np.random.default_rng(seed)
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    cloud = random.uniform(-1, 1, (500, 3))
    return np.concatenate([cloud, -cloud]) * lengths @ axes.T, axes


@pytest.mark.parametrize("seed", range(4))
def test_auto_looks_along_the_shortest_axis(seed: int) -> None:
    cloud, axes = shape((5, 3, 0.5), seed)
    camera = Camera.fit(cloud, view="auto")
    right, down, forward = map(np.array, axes_of(camera))
    assert abs(forward @ axes[:, 2]) == pytest.approx(math.cos(math.radians(20)), abs=0.01)
    assert abs(right @ axes[:, 0]) == pytest.approx(1, abs=0.01)
    assert down[2] < 0.35  # up is rather up
    # The copies of a cloud have the shape of both together.
    copies = vtray.Copies(vtray.Spheres(cloud / 9, 0.1), at=cloud)
    same = Camera.fit(copies, view="auto")
    assert axes_of(same)[2] == pytest.approx(tuple(forward), abs=1e-9)


def test_auto_of_rods_plates_and_balls() -> None:
    rod = [(k, k, 0) for k in range(5)]
    right, _, forward = axes_of(Camera.fit(rod, view="auto"))
    assert abs(right[0]) == pytest.approx(math.sqrt(0.5))
    assert forward[2] < 0
    plate = np.argwhere(np.ones((4, 4, 1))).astype(float)
    right, _, forward = axes_of(Camera.fit(plate, view="auto"))
    assert forward[2] == pytest.approx(-math.cos(math.radians(20)))
    assert right == pytest.approx((1, 0, 0))
    for ball in (np.concatenate([np.eye(3), -np.eye(3)]), [(1, 2, 3)]):
        iso = Camera.fit(ball, view="iso")
        assert Camera.fit(ball, view="auto").normal == iso.normal


def test_principal_axes() -> None:
    cloud, _ = shape((3, 2, 1))
    for points in (cloud, cloud * 1e200, cloud + 1e6):
        values, axes = principal_axes(moments([Balls(points, 0.0)]))
        expected = np.linalg.svd(points - points.mean(axis=0))[2][::-1]
        assert abs(np.sum(np.array(axes) * expected, axis=1)) == pytest.approx(1, abs=1e-6)
        assert values == sorted(values)


def test_zoom() -> None:
    camera = Camera.fit(POINTS, view="front")
    double = Camera.fit(POINTS, view="front", zoom=2)
    assert double == camera.zoomed(2)
    near, far = double.project(POINTS), camera.project(POINTS)
    middle = np.array(camera.size) / 2
    np.testing.assert_allclose(near[:, :2] - middle, 2 * (far[:, :2] - middle))
    np.testing.assert_array_equal(near[:, 2], far[:, 2])
    with pytest.raises(
        SceneError, match=r"^Camera.zoomed: factor: expected a number from 1e-9 to 1e9, got -1"
    ):
        camera.zoomed(-1)


# ---- cameras made of others


def eye(camera: Camera) -> np.ndarray:
    n = camera.normal
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    return center - camera.focus * np.array([n.x, n.y, n.z]) / np.linalg.norm([n.x, n.y, n.z])


def test_orbit() -> None:
    camera = Camera.look_at((1, -7, 3), (1, 1, 3), up=(0, 0, 1))
    turned = camera.orbit(90)
    np.testing.assert_allclose(eye(turned), (9, 1, 3), atol=1e-6)
    assert turned.normal == pytest.approx(vtray.Direction(-1, 0, 0)) or turned.normal.x == -1
    np.testing.assert_allclose(eye(camera.orbit(0, 30)), (1, 1 - 8 * 0.75**0.5, 7), atol=1e-6)
    np.testing.assert_allclose(eye(camera.orbit(90, about=(1, -7, 3))), (1, -7, 3), atol=1e-9)
    ball = vtray.Sphere((1, 0, 3), 2)
    scene = vtray.Scene(objects=[ball])
    assert camera.orbit(20, about=scene) == camera.orbit(20, about=(1, 0, 3))
    plain = vtray.Camera((0, 0, 0), (0, 0, 1), 5, (4, 4), (1, 1))
    assert plain.orbit(180, about=(0, 0, 5)).center.z == pytest.approx(10)
    with pytest.raises(SceneError, match="^Camera.orbit: elevation: expected an elevation that"):
        camera.orbit(0, 95)


def test_orbit_keeps_views_upright() -> None:
    ball = vtray.Sphere((1, 2, 3), 2)
    scene = vtray.Scene(objects=[ball])
    for projection in ("perspective", "orthographic"):
        first, other = (
            Camera.fit(scene, view=view, projection=projection) for view in ((-60, 25), (30, 25))
        )
        turned = first.orbit(90, about=scene)
        for one, wanted in zip(axes_of(turned), axes_of(other), strict=True):
            assert one == pytest.approx(wanted, abs=1e-9)
        np.testing.assert_allclose(eye(turned), eye(other), atol=1e-6)
        assert turned.up == vtray.Direction(0, 0, 1)
    risen = Camera.fit(scene, view=(-60, 25)).orbit(0, 20, about=scene)
    wanted = axes_of(Camera.fit(scene, view=(-60, 45)))[2]
    assert axes_of(risen.orbit(40).orbit(-40))[2] == pytest.approx(wanted)
    # An up that leans on purpose is gone around.
    leaning = Camera.look_at((0, -9, 2), (0, 0, 0), up=(1, 0, 3))
    assert leaning.orbit(30).up == leaning.up


def test_project_of_what_is_not_finite() -> None:
    points = [(np.inf, 0, 0), (0, -np.inf, 0), (0, 0, np.nan), (0, 0, 0)]
    for make in (Camera.look_at, Camera.panorama):
        found = make((0, -9, 0), (0, 0, 0), up=(0, 0, 1)).project(points)
        assert np.isfinite(found).all(axis=1).tolist() == [False, False, False, True]


def test_stereo() -> None:
    camera = Camera.look_at((0, -10, 0), (0, 0, 0), up=(0, 0, 1), size=(40, 30))
    left, right = camera.stereo(0.5)
    np.testing.assert_allclose(
        [eye(left), eye(right)], [(-0.25, -10, 0), (0.25, -10, 0)], atol=1e-5
    )
    for one in (left, right):
        np.testing.assert_allclose(one.project((0, 0, 0))[:2], (20, 15), atol=1e-6)
    near = (0, -5, 0)
    assert left.project(near)[0] > right.project(near)[0]
    with pytest.raises(SceneError, match="^Camera.stereo: about: expected a point in front"):
        camera.stereo(0.5, about=(0, -20, 0))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_project_leads_back_to_the_pixel(projection: str) -> None:
    scene = vtray.Scene()
    scene.add_spheres(POINTS, 0.4)
    scene.add_light((0, 0, 9))
    scene.camera = Camera.fit(scene, view=(20, 30), projection=projection, size=(9, 7))
    for column, row in ((4, 3), (3, 4), (5, 3)):
        hit = vtray.trace_pixel(scene, column, row).hit
        assert hit is not None
        found = scene.camera.project([hit.point])
        np.testing.assert_allclose(found, [(column, row, hit.distance)], rtol=1e-9)


def test_project_behind_the_image_plane_is_nothing() -> None:
    camera = Camera((0, 0, 0), (0, 0, 1), 5, (4, 4), (1, 1))
    found = camera.project([[(0, 0, -1), (0, 0, 0)], [(0, 0, 5), (2, 0, 5)]])
    assert np.isnan(found[0]).all()
    np.testing.assert_allclose(found[1], [(2, 2, 10), (3, 2, math.sqrt(104))])
    with pytest.raises(SceneError, match=r"^Camera.project: points: .* got shape \(2,\)"):
        camera.project((1, 2))
    for wrong in (np.ma.masked_equal([[1, 2, 3]], 2), np.ones((1, 3)) * 1j, [["a", "b", "c"]]):
        with pytest.raises(SceneError, match=r"^Camera.project: points: .*, got an array"):
            camera.project(wrong)
    with pytest.raises(SceneError, match="^Camera.project: points: expected numbers of shape"):
        camera.project((1, 2, 10**400))


def test_targets_of_other_kinds_are_told() -> None:
    with pytest.raises(SceneError, match="^Camera.orbit: about: expected"):
        Camera.look_at((0, 0, 9), (0, 0, 0)).orbit(3, about="here")  # type: ignore[arg-type]
    assert Camera.look_at((0, 0, 9), (0, 0, 0)).orbit(0, about=Vector(0, 0, 0)).center.z > 8.9


def test_particles_are_fitted_as_their_positions() -> None:
    particles = vtray.Particles(np.random.default_rng(1).normal(size=(9, 3)))
    assert Camera.fit(particles, view="iso") == Camera.fit(particles.positions, view="iso")


@pytest.mark.parametrize("seed", range(8))
def test_even_clouds_are_seen_from_a_corner(seed: int) -> None:
    cloud = np.random.default_rng(seed).uniform(0, 100, (200, 3))
    assert Camera.fit(cloud, view="auto") == Camera.fit(cloud, view="iso")


@pytest.mark.parametrize(
    ("edges", "near"),
    [
        ([(5, 0, 0), (0, 3, 0)], (0, -3, 0)),  # lies flat
        ([(5, 0, 0), (0, 0, 3)], (0, 0, 3)),  # stands
        ([(5, 0, 0), (0, 2, 1)], (0, -2, -1)),  # leans back
        ([(5, 0, 0), (0, 1, 2)], (0, 1, 2)),
    ],
)
def test_sheets_are_seen_from_their_near_edges(
    edges: list[tuple[float, ...]], near: tuple[float, ...]
) -> None:
    steps = np.linspace(-1, 1, 5)
    sheet = np.array(
        [a * np.array(edges[0]) + b * np.array(edges[1]) for a in steps for b in steps]
    )
    camera = Camera.fit(sheet, view="auto")
    right, down, forward = axes_of(camera)
    assert abs(right[0]) == pytest.approx(1)
    assert down[2] < 0
    toward = -np.array(forward) @ np.array(near) / np.linalg.norm(near)
    assert toward == pytest.approx(math.sin(math.radians(20)))
    # Turned by so much, what is up in the picture lies in the sheet, which turntables go around.
    angle = math.radians(tilt_of(sheet, "test"))
    around = -math.cos(angle) * np.array(down) - math.sin(angle) * np.array(forward)
    assert around @ np.cross(*edges) == pytest.approx(0, abs=1e-9)


@once
def test_floors_have_no_horizon() -> None:
    scene = vtray.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1))
    scene.add_sphere((0, 0, 1), 1)
    image = vtray.render(scene, size=(8, 6))
    assert (image.ids[..., 0] >= 0).all()
