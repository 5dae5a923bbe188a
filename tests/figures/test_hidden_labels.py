"""Labels of particles that are behind something, and of those whose own balls are before them."""

import vtray
from conftest import JIT, once
from vtray.figures.point_labels import shown_labels

SIZE = (90, 60) if JIT else (30, 20)


@once
def test_labels_of_what_is_hidden_are_left_out() -> None:
    scene = vtray.Scene()
    places = [(0, 0, 0), (3, 0, 0), (3, 0, -4)]
    scene.add_spheres(places, radius=[1.0, 1.0, 0.5])
    scene.add_sphere((-3, 0, 0), 1)
    scene.camera = vtray.Camera.orthographic((0, 0, 9), (0, 0, 0), 6, size=SIZE)
    image = vtray.render(scene, exposure=1)
    labels = list(zip("abcd", [*places, (-3, 0, 0)], strict=True))
    assert [label.text for label in shown_labels(image, labels, hide=True)] == ["a", "b", "d"]
