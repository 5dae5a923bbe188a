"""What pictures carry: where labels and axes are, what legends and captions say."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import vtray
from conftest import JIT
from vtray.figures.annotations import Annotations, find_marks
from vtray.figures.caption import frame_caption
from vtray.figures.legend import ball, legend_entries
from vtray.figures.point_labels import shown_labels
from vtray.figures.projection import project
from vtray.figures.round_marks import round_marks
from vtray.figures.sheet import FigureError
from vtray.figures.triad import ARM, DOT, arrow, extent, name_places, triad

Array = np.ndarray

EYE, TARGET = np.array([7.0, -9.0, 4.0]), np.array([0.5, 0.2, -0.3])
SIZE = (40, 30) if JIT else (16, 12)


def camera(projection: str = "perspective", up: Any = (0, 0, 1)) -> vtray.Camera:
    if projection == "perspective":
        return vtray.Camera.look_at(tuple(EYE), tuple(TARGET), up, 40.0, SIZE)
    return vtray.Camera.orthographic(tuple(EYE), tuple(TARGET), 8.0, up, SIZE)


def axes_seen(up: Any = (0, 0, 1)) -> tuple[Array, Array, Array]:
    """Return right, down and forward by vector products."""
    forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    return right, np.cross(forward, right), forward


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_points_are_where_the_camera_sees_them(projection: str) -> None:
    points = np.random.default_rng(1).uniform(-3, 3, (20, 3))
    right, down, forward = axes_seen()
    arm = points - EYE
    depth = arm @ forward
    x, y = arm @ right, arm @ down
    if projection == "perspective":
        pixel = 2 * np.tan(np.radians(20)) / SIZE[1]
        x, y = x / depth / pixel, y / depth / pixel
    else:
        x, y = x / (8 / SIZE[1]), y / (8 / SIZE[1])
    places = project(camera(projection), points)
    np.testing.assert_allclose(places.column, x + SIZE[0] / 2, atol=1e-9)
    np.testing.assert_allclose(places.row, y + SIZE[1] / 2, atol=1e-9)
    np.testing.assert_allclose(places.depth, depth, atol=1e-9)


def test_point_behind_the_eye_is_nowhere() -> None:
    places = project(camera(), np.array([2 * EYE - TARGET, TARGET]))
    assert np.isnan(places.column[0])
    assert (places.column[1], places.row[1]) == pytest.approx((SIZE[0] / 2, SIZE[1] / 2))


@pytest.fixture(scope="module")
def image() -> vtray.Image:
    """Return a ball above a floor, a bond behind it, and a copy of a small ball beside it."""
    scene = vtray.Scene()
    scene.add_spheres([TARGET], radius=1.0, color="red")
    way = axes_seen()[2]
    start, end = TARGET + 3 * way - 2 * axes_seen()[0], TARGET + 3 * way
    scene.add_cylinders([start], [end], radius=0.4)
    small = vtray.Sphere((0, 0, 0), 0.5)
    scene.objects.append(vtray.Copies([small], [TARGET + 2 * axes_seen()[0]]))
    scene.add_plane((0, 0, -3), (0, 0, 1))
    scene.add_light((5, -9, 9))
    scene.camera = camera()
    return vtray.render(scene)


def texts(image: vtray.Image, labels: Any, *, hide: bool) -> list[str]:
    return [label.text for label in shown_labels(image, labels, hide=hide)]


def test_labels_stand_at_their_points_far_ones_first(image: vtray.Image) -> None:
    way = axes_seen()[2]
    given = [("near", TARGET - 2 * way), ("far", TARGET + 4 * way), ("gone", 3 * EYE)]
    labels = shown_labels(image, given, hide=False)
    assert [label.text for label in labels] == ["far", "near"]
    for label in labels:
        assert (label.column, label.row) == pytest.approx((SIZE[0] / 2, SIZE[1] / 2))
    assert labels == shown_labels(image, dict(given), hide=False)
    assert labels == shown_labels(image, ((name, list(at)) for name, at in given), hide=False)


def test_labels_behind_something_are_left_out(image: vtray.Image) -> None:
    right, _, way = axes_seen()
    labels = {
        "before the ball": TARGET - 2 * way,
        "in the ball": TARGET,
        "behind the ball": TARGET + 1.5 * way,
        "in the bond, behind the ball": TARGET + 3 * way,
        "in the bond": TARGET + 3 * way - 1.8 * right,
        "behind the bond": TARGET + 4 * way - 1.8 * right,
        "in a copy": TARGET + 2 * right,
        "behind a copy": TARGET + 2 * right + way,
        "above the floor": TARGET - 2.5 * right,
        "behind the floor": TARGET + 9 * way - 2.5 * right,
    }
    assert set(texts(image, labels, hide=False)) == set(labels)
    shown = texts(image, labels, hide=True)
    assert [name for name in labels if name not in shown] == [
        name for name in labels if "behind" in name
    ]


@pytest.mark.parametrize("up", [(0, 0, 1), (0.3, 1, 0.2)])
def test_triad_points_where_the_camera_sees_the_axes(up: Any) -> None:
    arms = triad(camera(up=up), axes=True)
    right, down, forward = axes_seen(up)
    assert sorted(arm.name for arm in arms) == ["x", "y", "z"]
    assert [arm.ahead for arm in arms] == sorted((arm.ahead for arm in arms), reverse=True)
    for arm in arms:
        axis = np.eye(3)["xyz".index(arm.name)]
        seen = (arm.across, arm.down, arm.ahead)
        assert seen == pytest.approx((axis @ right, axis @ down, axis @ forward))
        assert np.argmax(arm.color) == "xyz".index(arm.name), "red, green, blue"


def test_triad_of_other_directions() -> None:
    (arm,) = triad(camera(), {"c": TARGET - EYE})
    assert (arm.name, arm.ahead) == ("c", pytest.approx(1.0))
    assert triad(camera(), axes=False) == []


def test_arrows_end_where_their_axes_do() -> None:
    arms = triad(camera(), axes=True)
    for arm in arms:
        shaft, head = arrow(arm)
        np.testing.assert_allclose(head[1], [ARM * arm.across, ARM * arm.down])
        np.testing.assert_allclose((shaft[0] + shaft[3]) / 2, 0.0, atol=1e-12)
        within = (shaft[1] + shaft[2]) / 2 - (head[0] + head[2]) / 2
        np.testing.assert_allclose(3 * within, head[1] - (head[0] + head[2]) / 2)
    low, high = extent(arms, [0.5] * 3, 0.7)
    for arm, place in zip(arms, name_places(arms), strict=True):
        half = np.array([0.25, 0.35])
        assert (low <= place - half).all()
        assert (place + half <= high).all()
        assert np.dot(place, (arm.across, arm.down)) > 0


def test_arrow_at_the_viewer_is_a_dot_with_its_name_beside() -> None:
    above = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 4.0, size=SIZE)
    arms = triad(above, axes=True)
    (dot,) = arrow(arms[-1])
    assert arms[-1].name == "z"
    assert np.abs(dot).max() == DOT
    x, y = name_places(arms)[-1]
    assert x < 0 < y, "lower left, as x points right and y up"


@pytest.mark.parametrize("name", ["y", "[010]"])
@pytest.mark.parametrize("tilt", [1e-3, 0.05, 0.2, 0.5, 1.0])
@pytest.mark.parametrize("view", [(0, 1, 0), (0.3, 1, 0.02), (0.02, 1, -0.3), (0, -1, 0)])
def test_names_of_axes_keep_apart(view: Any, tilt: float, name: str) -> None:
    # Seen along an axis but for a tilt: it points where another does, or nearly.
    eye = 9 * np.array(view) + 9 * tilt * np.array([-1, 0, 0])
    seen = vtray.Camera.orthographic(tuple(eye), (0, 0, 0), 4.0, up=(1, 0, 0), size=SIZE)
    arms = triad(seen, {"x": (1, 0, 0), name: (0, 1, 0), "z": (0, 0, 1)})
    places = np.array(name_places(arms))
    for k, arm in enumerate(arms):
        half = np.array([0.3 * len(arm.name), 0.37])
        for j, other in enumerate(arms):
            if j != k:
                wide = half + np.array([0.3 * len(other.name), 0.37])
                assert (abs(places[k] - places[j]) > wide).any()
                on_arrow = np.linspace(0, 1, 50)[:, None] * [other.across, other.down] * ARM
                assert (abs(places[k] - on_arrow) > half).any(axis=1).all()


def test_legend_of_names_and_pairs() -> None:
    given = {"O": "red", "H": (255, 255, 255), "C": (0.5, 0.5, 0.5)}
    entries = legend_entries(given)
    assert entries == [("O", (255, 0, 0)), ("H", (255, 255, 255)), ("C", (128, 128, 128))]
    assert legend_entries(list(given.items())) == legend_entries(iter(given.items())) == entries
    assert legend_entries([(" two\nwords ", "red")])[0].name == "two words"
    assert legend_entries([]) == legend_entries({}) == []


def test_ball_has_its_colour_and_smooth_edges() -> None:
    picture = ball((200, 100, 50), 31)
    assert (picture[0, 0] == (*picture[0, 0, :3], 0)).all()
    assert picture[15, 15, 3] == 255
    brightest = picture[..., :3].reshape(-1, 3).max(axis=0)
    np.testing.assert_allclose(brightest, (200, 100, 50), atol=1)
    assert 0 < picture[0, 11, 3] < 255
    area = picture[..., 3].astype(float).sum() / 255
    assert area == pytest.approx(np.pi * 15.5**2, rel=0.01)
    flat = ball((200, 100, 50), 31, flat=True)
    assert (flat[..., 3] == picture[..., 3]).all()
    assert (flat[..., :3] != picture[..., :3]).any()


@pytest.mark.parametrize(
    ("time", "frame", "text"),
    [
        (None, None, ""),
        (12.5, None, "t = 12.5"),
        ("12.5 ps", None, "t = 12.5 ps"),
        (None, 12, "frame 12"),
        (0, np.int64(0), "t = 0, frame 0"),
    ],
)
def test_captions(time: Any, frame: Any, text: str) -> None:
    assert frame_caption(time, frame) == text


@pytest.mark.parametrize(
    ("low", "high", "most", "texts"),
    [
        (0, 1, 6, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
        (-2, 3.5, 6, ["−2", "−1", "0", "1", "2", "3"]),
        (-2, 3.5, 2, ["0"]),
        (-1e-9, 3e-9, 4, ["0", "2e−9"]),
        (0, 1e7, 3, ["0", "5e6", "1e7"]),
        (99.99, 100.01, 3, ["99.99", "100.00", "100.01"]),
        (2, 2, 5, ["2"]),
        (101325000, 101325059, 3, ["101325000", "101325020", "101325040"]),
        (1, 1 + 5e-9, 3, ["1.000000000", "1.000000002", "1.000000004"]),
        (1e300, 1.0000001e300, 3, ["1e300", "1.00000005e300", "1.0000001e300"]),
        (0.1, 0.7, 4, ["0.2", "0.4", "0.6"]),
        (0, 2e-5, 6, ["0", "5e−6", "1e−5", "1.5e−5", "2e−5"]),
        (0, 1e-3, 3, ["0.0000", "0.0005", "0.0010"]),
        (-4e5, 4e5, 5, ["−400000", "−200000", "0", "200000", "400000"]),
        (5e-6, 5e-6, 3, ["5e−6"]),
    ],
)
def test_round_marks(low: float, high: float, most: int, texts: list[str]) -> None:
    marks = round_marks(low, high, most)
    assert len(marks) <= most
    for value, text in marks:
        assert low <= value <= high
        assert float(text.replace("−", "-")) == pytest.approx(value, rel=1e-12)
    assert [text for _, text in marks] == texts


def test_distance_of_a_scale_bar_is_told_in_perspective(image: vtray.Image) -> None:
    bar = find_marks(image, Annotations(scalebar="nm", at=tuple(TARGET))).scale_bar
    distance = np.linalg.norm(TARGET - EYE)
    assert bar is not None
    assert bar.note == f"at a distance of {distance:.3g} nm"
    assert bar.text == f"{bar.length:g} nm"
    other = find_marks(image, Annotations(scalebar="{length} nm", at=tuple(TARGET))).scale_bar
    assert other is not None
    assert other.note == ""


WRONG: list[tuple[Mapping[str, Any], str]] = [
    ({"legend": 7}, r"legend: expected pairs of a name and a colour, such as .*, or None, got 7"),
    ({"legend": True}, "legend: expected pairs of a name and a colour"),
    ({"legend": [("O", "red"), "H"]}, r"legend\[1\]: expected pairs of a name and a colour"),
    (
        {"legend": {"O": "redd"}},
        r"legend\[0\]: expected a name such as .*, got 'redd'; did you mean",
    ),
    ({"legend": {" ": "red"}}, r"legend\[0\]: expected pairs of a name and a colour"),
    ({"axes": "xyz"}, "axes: expected True, False or up to three directions by name"),
    ({"axes": {"a": (1, 0)}}, r"axes: expected .*, got 'a': \(1, 0\)"),
    ({"axes": {"a": (0, 0, 0)}}, "axes: expected directions of a length above 0, got 'a'"),
    ({"axes": dict.fromkeys("abcd", (1, 0, 0))}, "axes: expected True, False or up to three"),
    ({"labels": 3}, r"labels: expected pairs of a text and a point, such as .*, got 3"),
    ({"labels": [("O", (0, 0))]}, r"labels\[0\]: expected pairs of a text and a point"),
    ({"labels": {"O": (0, 0, np.nan)}}, r"labels\[0\]: expected pairs of a text and a point"),
    ({"labels": [("", (0, 0, 0))]}, r"labels\[0\]: expected pairs of a text and a point"),
    ({"labels": {"O": (10**400, 0, 0)}}, r"labels\[0\]: expected pairs of a text and a point"),
    ({"labels": {"O": (1, 0, 1j)}}, r"labels\[0\]: expected pairs of a text and a point"),
    ({"axes": {"a": (10**400, 0, 0)}}, "axes: expected .*, got 'a': "),
    ({"labels": "OH"}, r"labels\[0\]: expected pairs of a text and a point, .*got 'O'"),
    ({"time": True}, 'time: expected a number or a text such as "12.5 ps", got True'),
    ({"time": np.inf}, "time: expected a number or a text"),
    ({"frame": 1.5}, "frame: expected an integer or None, got 1.5"),
    ({"title": 3}, "title: expected a text or None, got 3"),
]


@pytest.mark.parametrize(("wanted", "message"), WRONG)
def test_what_is_wrong_is_told(image: vtray.Image, wanted: Mapping[str, Any], message: str) -> None:
    with pytest.raises(FigureError, match=message) as error:
        find_marks(image, Annotations(**wanted))
    assert "\n" not in str(error.value)
