"""Cameras made by `look_at`, `orthographic`, `fit` and `resized`.

The oracle works with points on the silhouettes of the spheres and the rules of the picture alone.
"""

import itertools
import math
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import vtray
from conftest import compiled_only, once
from vtray import Camera, Scene, SceneError, Spheres
from vtray.scene.placing import camera_fit, pieces, seen
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls

TURN = np.linspace(0, 2 * np.pi, 720, endpoint=False)


def axes_of(camera: Camera) -> tuple[Any, Any, Any]:
    """Return x', y', z' as the rules say: y' is what of -up is square to z'."""
    assert camera.up is not None
    forward = np.array([camera.normal.x, camera.normal.y, camera.normal.z])
    forward = forward / np.linalg.norm(forward)
    up = np.array([camera.up.x, camera.up.y, camera.up.z])
    down = -(up - np.dot(up, forward) * forward)
    down = down / np.linalg.norm(down)
    return np.cross(down, forward), down, forward


def project(camera: Camera, points: Any) -> Any:
    """Return the columns and rows, not rounded, where points are seen, and their depths, (n, 3)."""
    right, down, forward = axes_of(camera)
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    offset = np.asarray(points, float) - (center - camera.focus * forward)
    depth = offset @ forward
    scale = camera.focus / depth if camera.projection == "perspective" else np.ones_like(depth)
    column = offset @ right * scale / camera.resolution[0] + camera.size[0] / 2
    row = offset @ down * scale / camera.resolution[1] + camera.size[1] / 2
    return np.stack([column, row, depth - camera.focus], axis=-1)


def silhouette(camera: Camera, center: Any, radius: float) -> Any:
    """Return points of the circle where rays touch a sphere, (720, 3)."""
    _, _, forward = axes_of(camera)
    eye = np.array([camera.center.x, camera.center.y, camera.center.z]) - camera.focus * forward
    if camera.projection == "perspective":
        axis = eye - center
        distance = np.linalg.norm(axis)
        assert distance > radius
        axis, sine = axis / distance, radius / distance
    else:
        axis, sine = -forward, 0.0
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    side /= np.linalg.norm(side)
    other = np.cross(axis, side)
    circle = np.cos(TURN)[:, None] * side + np.sin(TURN)[:, None] * other
    return center + radius * (sine * axis + math.sqrt(1 - sine**2) * circle)


def seen_range(camera: Camera, spheres: Spheres) -> tuple[Any, Any]:
    """Return the least and the largest column, row and depth of all silhouettes."""
    radii = np.broadcast_to(spheres.radius, len(spheres))
    points = [
        project(camera, silhouette(camera, center, radius))
        for center, radius in zip(spheres.center.astype(float), radii.tolist(), strict=True)
    ]
    return np.min(points, axis=(0, 1)), np.max(points, axis=(0, 1))


def directions() -> st.SearchStrategy[tuple[float, float, float]]:
    part = st.floats(-1, 1).map(lambda x: round(x, 3))
    return st.tuples(part, part, part).filter(lambda v: math.hypot(*v) > 0.1)


@once
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(1, 12),
    scale=st.sampled_from([1.0, 1e-9, 1e6]),
    far=st.sampled_from([0.0, 1.0, 1e4]),
    largest=st.sampled_from([0.05, 1.0, 5.0]),
    direction=directions(),
    up=directions(),
    margin=st.sampled_from([0.0, 0.05, 0.2, 0.45]),
    projection=st.sampled_from(["perspective", "orthographic"]),
    fov=st.sampled_from([1.0, 20.0, 40.0, 90.0, 130.0]),
    size=st.sampled_from([(800, 600), (100, 300), (31, 31), (2, 3), (640, 20)]),
    dtype=st.sampled_from([np.float32, np.float64]),
)
def test_fit_is_inside_tight_and_in_the_middle(
    seed: int,
    count: int,
    scale: float,
    far: float,
    largest: float,
    direction: Any,
    up: Any,
    margin: float,
    projection: Any,
    fov: float,
    size: tuple[int, int],
    dtype: Any,
) -> None:
    assume(np.linalg.norm(np.cross(direction, up)) > 0.01)
    random = np.random.default_rng(seed)
    center = (random.normal(size=(count, 3)) * random.uniform(0, 1, 3) + far) * scale
    radius = random.uniform(0.01, 1, count) * largest * scale
    spheres = Spheres(center.astype(dtype), radius.astype(dtype), (1, 2, 3), 1)
    camera = Camera.fit(spheres, direction, up, margin, projection, fov, size)
    assert camera.size == size
    assert camera.resolution[0] == camera.resolution[1]
    low, high = seen_range(camera, spheres)
    lattice = np.array(size) - 1.0
    first, last = margin * lattice, (1 - margin) * lattice
    # Samples of a circle miss its ends by a few millionths; far from the origin digits are lost.
    extent = np.array([*(high - low)[:2], 1])
    loose = 2e-5 * extent[:2] + 1e-9 * (1 + far / largest) * max(size)
    assert np.all(low[:2] >= first - loose)
    assert np.all(high[:2] <= last + loose)
    assert low[2] > 0, "behind the image plane"
    free = np.array([low[:2] - first, last - high[:2]])
    assert np.any(np.all(np.abs(free) < loose, axis=0)), "not tight"
    assert np.all(np.abs(free[0] - free[1]) < 2 * loose), "not in the middle"
    if projection == "perspective":
        slope = size[1] * camera.resolution[1] / 2 / camera.focus
        assert math.degrees(2 * math.atan(slope)) == pytest.approx(fov)


@pytest.mark.parametrize(
    ("size", "across", "down"),
    [
        ((300, 400), None, 40),
        ((400, 300), None, 40),
        ((640, 360), 52, None),
        ((1000, 150), 52, None),
        ((2, 400), None, 40),
    ],
)
def test_wide_pictures_are_not_seen_at_wider_angles(
    size: tuple[int, int], across: float | None, down: float | None
) -> None:
    camera = Camera.fit(np.random.default_rng(5).normal(size=(9, 3)), size=size)
    for angle, pixels, side in zip((across, down), size, camera.resolution, strict=True):
        if angle is not None:
            found = 2 * math.degrees(math.atan(pixels * side / 2 / camera.focus))
            assert found == pytest.approx(angle)
    given = Camera.fit([(0, 0, 0), (1, 0, 0)], fov_degrees=40, size=size)
    assert size[1] * given.resolution[1] / given.focus == pytest.approx(2 * math.tan(math.pi / 9))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("margins", [(0.1, 0, 0.4, 0.2), (0, 0.45, 0.05, 0.05)])
@pytest.mark.parametrize("size", [(101, 101), (201, 101)])
def test_fit_leaves_free_what_each_margin_says(
    projection: Any, margins: tuple[float, float, float, float], size: tuple[int, int]
) -> None:
    random = np.random.default_rng(5)
    spheres = Spheres(random.normal(size=(9, 3)), 0.3, (1, 2, 3), 1)
    camera = Camera.fit(spheres, margin=margins, projection=projection, size=size)
    low, high = seen_range(camera, spheres)
    lattice = np.array(size) - 1.0
    free = np.array([low[:2] / lattice, 1 - high[:2] / lattice]).ravel() - margins
    assert np.all(free > -1e-4)
    across, down = free[::2], free[1::2]
    assert min(across.max(), down.max()) < 1e-4, "not tight"
    assert np.abs(np.diff(across)) < 1e-4
    assert np.abs(np.diff(down)) < 1e-4


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_fit_of_points(projection: Any) -> None:
    points = [(x, y, z) for x in (0, 2) for y in (0, 1) for z in (0, 3)]
    camera = Camera.fit(points, (0, 0, -1), margin=0, projection=projection, size=(101, 101))
    seen = project(camera, points)
    assert seen[:, 0].min() == pytest.approx(0, abs=1e-6)
    assert seen[:, 0].max() == pytest.approx(100, abs=1e-6)
    assert seen[:, 1].min() + seen[:, 1].max() == pytest.approx(100, abs=1e-6)
    assert camera.up == vtray.Direction(0, 1, 0)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize(
    "points", [[(5, 6, 7)], [(0, 0, 0), (0, 0, 1)], [(0, 0, 0), (1, 0, 5), (-1, 0, 5)]]
)
@pytest.mark.parametrize("size", [(1, 1), (1, 5), (20, 10)])
def test_fit_of_points_without_extent(projection: Any, points: Any, size: Any) -> None:
    camera = Camera.fit(points, projection=projection, size=size)
    seen = project(camera, points)
    assert np.all(seen[:, 2] > 0)
    assert np.all(seen[:, :2] > -1.01)
    assert np.all(seen[:, :2] < size)


def test_fit_takes_all_kinds_of_spheres() -> None:
    scene = Scene()
    scene.add_sphere((0, 0, 0), 1)
    scene.add_spheres([(5, 0, 0), (0, 3, 0)], radius=[1, 2])
    scene.add_plane((0, 0, -2), (0, 0, 1))
    scene.add_spheres(np.array([(-4, 0, 0)], np.float32), radius=0.5)
    together = Spheres([(5, 0, 0), (0, 3, 0), (-4, 0, 0), (0, 0, 0)], [1, 2, 0.5, 1], (1, 1, 1), 1)
    camera = Camera.fit(scene, (1, 2, -1))
    assert camera.up == vtray.Direction(0, 0, 1)
    assert camera == Camera.fit(together, (1, 2, -1), up=(0, 0, 1))


@pytest.mark.parametrize(
    ("normal", "point", "direction", "up"),
    [
        ((0, 0, 5), (0, 0, -3), (1, 1, -1), (0, 0, 1)),
        ((0, 0, -1), (0, 0, -3), (1, 1, -1), (0, 0, 1)),
        ((0, 0, 1), (0, 0, 3), (1, 1, -1), (0, 0, -1)),
        ((0, 0, 1), (0, 0, -3), (0, 0, -1), (0, 1, 0)),
        ((0, 1, 0), (0, -3, 0), (0, 1, 0), (0, 0, 1)),
        (None, None, (0, 1, 0), (0, 0, 1)),
        (None, None, (1, 0, 0), (0, 1, 0)),
    ],
)
def test_up_by_default(normal: Any, point: Any, direction: Any, up: Any) -> None:
    scene = Scene()
    scene.add_sphere((0, 0, 0), 1)
    if normal:
        scene.add_plane(point, normal)
    camera = Camera.fit(scene, direction)
    assert camera.up == vtray.Direction(*up)


def test_fit_of_a_million_spheres_is_fast() -> None:
    random = np.random.default_rng(1)
    center, radius = random.normal(size=(10**6, 3)), random.uniform(0.01, 0.1, 10**6)
    spheres = Spheres(center, radius, (1, 2, 3), 1)
    seconds = []
    for _ in range(5):
        begin = time.perf_counter()
        Camera.fit(spheres, (1, 2, -1))
        seconds.append(time.perf_counter() - begin)
    assert min(seconds) < 0.5  # 0.06 s on an idle core


def clouds() -> dict[str, Any]:
    """Return many centres in shapes that leave much, little and nothing to choose from, (n, 3)."""
    random = np.random.default_rng(5)
    cube, normal = random.random((3000, 3)), random.normal(size=(3000, 3))
    return {
        "cube": cube,
        "normal": normal,
        "shell": normal / np.linalg.norm(normal, axis=1)[:, None],
        "sheet": cube * (1, 1, 0),
        "edge-on": cube[:, :1] * (1, 2, -1) + cube[:, 1:2] * (0, 1, 0),
        "line": cube[:, :1] * (1.0, 2.0, -3.0),
        "lattice": np.floor(cube * 12),
        "far": cube + 1e6,
        "two": np.repeat(cube[:2], 1500, axis=0),
    }


@once
@pytest.mark.parametrize("name", clouds())
@pytest.mark.parametrize("direction", [(0, 0, -1), (1, 2, -1), (1, 0, 0)])
def test_fit_of_many_spheres(name: str, direction: Any, monkeypatch: Any) -> None:
    """What is worked out piece by piece, of few chosen among many, is the same to the last bit."""
    center = clouds()[name]
    random = np.random.default_rng(7)
    kinds: list[Any] = [("perspective", 1), ("perspective", 40), ("perspective", 120)]
    kinds.append(("orthographic", 40))
    for dtype in (np.float32, np.float64):
        for radius in (0.0, 0.2, 1e3, random.uniform(0, 0.02, 3000), random.uniform(0, 2, 3000)):
            spheres = Spheres(center.astype(dtype), radius, (1, 2, 3), 1)
            cameras, around = [], []
            for many, piece in ((10**6, 10**6), (1, 256)):
                monkeypatch.setattr(seen, "MANY", many)
                monkeypatch.setattr(seen, "SAMPLE", 128)
                monkeypatch.setattr(pieces, "PIECE", piece)
                cameras.append(
                    [
                        Camera.fit(spheres, direction, projection=projection, fov_degrees=fov)
                        for projection, fov in kinds
                    ]
                )
                around.append(repr(bounding_sphere(Balls(spheres.center, spheres.radius))))
            assert cameras[0] == cameras[1]
            assert around[0] == around[1]


def test_few_of_many_spheres_decide(monkeypatch: Any) -> None:
    counts = []
    look = seen.look

    def count(*arguments: Any) -> Any:
        found = look(*arguments)
        counts.append(len(found.x))
        return found

    monkeypatch.setattr(camera_fit, "look", count)
    center = np.random.default_rng(3).normal(size=(200_000, 3))
    for fov in (1, 40, 90):
        Camera.fit(Spheres(center, 0.01, (1, 2, 3), 1), (1, 2, -1), fov_degrees=fov)
    assert max(counts) < 2000


@pytest.mark.parametrize("fov", [1, 40, 120])
@pytest.mark.parametrize("size", [(800, 600), (3, 7)])
@pytest.mark.parametrize("offset", [(3.0, -4.0, 1.0), (1e-9, 0.0, 1e-9), (1e12, 5e11, 0.0)])
def test_look_at(fov: float, size: Any, offset: Any) -> None:
    eye = np.array([1.0, -2.0, 0.5]) * math.hypot(*offset)
    target = eye + offset
    camera = Camera.look_at(eye, target, fov_degrees=fov, size=size)
    column, row, depth = project(camera, target)
    assert (column, row) == pytest.approx((size[0] / 2, size[1] / 2), abs=1e-4)
    assert depth == pytest.approx(math.hypot(*offset), rel=1e-5)
    # The angle between the lines from the eye through the ends of the middle column.
    right, down, forward = axes_of(camera)
    half = size[1] / 2 * camera.resolution[1] * down
    ends = [camera.focus * forward + side * half for side in (-1, 1)]
    cosine = np.dot(*ends) / math.prod(map(np.linalg.norm, ends))
    assert math.degrees(math.acos(cosine)) == pytest.approx(fov, abs=1e-5)
    # Up is up: what is above the target is seen above it.
    above = target + np.array([0, 0.1, 0]) * math.hypot(*offset)
    assert project(camera, above)[1] < row
    assert np.dot(right, np.cross(forward, [0, 1, 0])) > 0


def test_orthographic() -> None:
    camera = Camera.orthographic((10, 0, 0), (0, 0, 0), 6, up=(0, 0, 1), size=(300, 200))
    points = [(0, 0, 0), (-50, 0, 3), (9, 5, 0)]
    seen = project(camera, points)
    # Looking along -x with z up, y points right.
    assert seen[:, :2].tolist() == pytest.approx(
        np.array([(150, 100), (150, 0), (150 + 500 / 3, 100)])
    )
    assert seen[:, 2] == pytest.approx([10, 60, 1], rel=1e-5)
    assert camera.projection == "orthographic"


@given(
    st.tuples(st.integers(1, 500), st.integers(1, 500)),
    st.tuples(st.integers(1, 500), st.integers(1, 500)),
)
def test_resized_shows_the_whole_view(size: Any, other: Any) -> None:
    camera = Camera((1, 2, 3), (0, 0, 1), 2, size, (0.25, 0.5), (0, 1, 0), "orthographic")
    resized = camera.resized(other)
    assert resized.size == other
    changed = {"size": size, "resolution": camera.resolution}
    fields = {name: getattr(resized, name) for name in Camera.__struct_fields__}
    assert Camera(**{**fields, **changed}) == camera
    views = [
        [pixels * side for pixels, side in zip(c.size, c.resolution, strict=True)]
        for c in (resized, camera)
    ]
    ratios = [new / old for new, old in zip(*views, strict=True)]
    assert min(ratios) == pytest.approx(1)
    assert resized.resolution[1] == pytest.approx(2 * resized.resolution[0])


@compiled_only
def test_no_picture_feels_how_near_the_image_plane_is() -> None:
    scene = Scene()
    random = np.random.default_rng(3)
    scene.add_spheres(random.uniform(-3, 3, (200, 3)), 0.4, random.random((200, 3)))
    scene.add_plane((0, 4, 0), (0, -1, 0))
    scene.add_light((5, -9, -9))
    # The axes of the format's first rule for this direction are those of this up.
    near = Camera.look_at((1, 1, -12), (1, 1, 0), up=(0, -1, 0), size=(80, 60))
    fields = {name: getattr(near, name) for name in ("normal", "size")}
    pictures = []
    for factor in (1, 2.0**10, 2.0**18):
        focus, pixel = near.focus * factor, near.resolution[0] * factor
        scene.camera = Camera((1, 1, focus - 12), focus=focus, resolution=(pixel, pixel), **fields)
        pictures.append(vtray.render(scene, 1).linear)
    assert pictures[0].max() > 200
    for picture in pictures[1:]:
        close = np.isclose(picture, pictures[0], rtol=1e-6, atol=1e-6)
        # But for edges of shadows and spheres, where the last digit decides.
        assert close.mean() > 0.999


def test_resized_by_two_keeps_every_digit() -> None:
    camera = Camera.look_at((1, 2, 3), (0, 0, 0), size=(800, 600))
    twice = camera.resized((1600, 1200))
    assert twice.resolution == tuple(side / 2 for side in camera.resolution)
    assert twice.resized((800, 600)) == camera


ZERO = "expected numbers x, y and z that are not all zero, got (0.0, 0.0, 0.0)"
PARALLEL = "expected a direction that is not parallel to"
NOTHING = (
    "nothing has an end; expected at least one sphere, cylinder, cone or point, "
    "as planes have no edge"
)
ARRAY = "expected an array of numbers of shape (n, 3), got shape"
ORIGIN = (0, 0, 0)
FAR = (0, 0, 9)
ONE = [(1, 2, 3)]
CALLS: list[tuple[str, tuple[Any, ...], dict[str, Any], str]] = [
    ("look_at", ((0, 0), FAR), {}, "eye: expected Vector or three numbers, got (0, 0)"),
    (
        "look_at",
        (ORIGIN, ORIGIN),
        {},
        "target: expected a point other than eye, got (0.0, 0.0, 0.0)",
    ),
    (
        "look_at",
        (ORIGIN, (0, 9, 0)),
        {},
        f"up: {PARALLEL} the line from eye to target, got (0.0, 1.0, 0.0); "
        "take for instance (0, 0, 1)",
    ),
    ("look_at", (ORIGIN, FAR), {"up": ORIGIN}, f"up: {ZERO}"),
    (
        "look_at",
        (ORIGIN, FAR),
        {"fov_degrees": 180},
        "fov_degrees: expected a number of degrees > 0 and < 180, got 180",
    ),
    (
        "look_at",
        (ORIGIN, FAR),
        {"size": (0, 5)},
        "size[0]: expected an integer from 1 to 2147483647, got 0",
    ),
    (
        "look_at",
        ((-1e308, 0, 0), (1e308, 0, 0)),
        {},
        "target: expected a point at a distance from eye that is a double, got (1e+308, 0.0, 0.0)",
    ),
    ("orthographic", (ORIGIN, FAR, 0), {}, "height: expected a number > 0, got 0"),
    ("fit", (Scene(),), {}, f"{NOTHING} (Camera.look_at needs none)"),
    ("fit", ([],), {}, f"{NOTHING} (Camera.look_at needs none)"),
    ("fit", ([(1, 2)],), {}, f"positions: {ARRAY} (1, 2)"),
    ("fit", ([(1, 2, math.nan)],), {}, "positions[0, 2]: expected a finite number, got nan"),
    (
        "fit",
        (ONE,),
        {"margin": 0.5},
        "margin: expected a number from 0 to less than 0.5, got 0.5",
    ),
    (
        "fit",
        (ONE,),
        {"margin": (0, 0, 0.5, 0)},
        "margin[2]: expected a number from 0 to less than 0.5, got 0.5",
    ),
    (
        "fit",
        (ONE,),
        {"margin": (0.1, 0.2)},
        "margin: expected a number, or four: left, top, right, bottom, got (0.1, 0.2)",
    ),
    ("fit", (ONE,), {"direction": ORIGIN}, f"direction: {ZERO}"),
    ("fit", (ONE,), {"up": (0, 0, 2)}, f"up: {PARALLEL} direction, or None, got (0.0, 0.0, 2.0)"),
    (
        "fit",
        (ONE,),
        {"projection": "iso"},
        'projection: expected "perspective" or "orthographic", got \'iso\'',
    ),
    (
        "fit",
        ([(1e308, 0, 0), (-1e308, 0, 0)],),
        {},
        "the spheres reach too far; expected coordinates and radii whose sums and products are "
        "doubles, up to about 1e307",
    ),
    ("fit", (ONE,), {"fov_degrees": math.nan}, "fov_degrees: expected a finite number, got nan"),
]


@pytest.mark.parametrize(("maker", "arguments", "options", "message"), CALLS)
def test_wrong_arguments(maker: str, arguments: Any, options: Any, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        getattr(Camera, maker)(*arguments, **options)
    assert str(caught.value) == f"Camera.{maker}: {message}"


def test_wrong_size_of_resized() -> None:
    words = "expected an array of two integers > 0, got (1, 2, 3)"
    with pytest.raises(SceneError) as caught:
        Camera.fit(ONE).resized((1, 2, 3))  # type: ignore[arg-type]
    assert str(caught.value) == f"Camera.resized: size: {words}"


def test_up_parallel_to_normal() -> None:
    for up, tilt in itertools.product([(0, 0, -1), (0, 0, 1e300)], [0, 1e-12]):
        with pytest.raises(SceneError, match=r"^Camera.up: expected a direction that is not par"):
            Camera((0, 0, 0), (tilt, 0, 1), 1, (1, 1), (1, 1), up)
    assert Camera((0, 0, 0), (0, 0, 1), 1, (1, 1), (1, 1), (1e-6, 0, 1)).up is not None
