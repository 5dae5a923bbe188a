"""All scenes use the same few kernels: none is compiled anew for another kind of array.

Only the tracer is compiled for each purpose: a picture with one ray a pixel, one with samples, and
what the rays meet.
"""

import sys
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

import vtray
from conftest import compiled_only
from vtray.base.compiler.compiled import Kernel
from vtray.rendering import pixel_rays, renderer

pytestmark = compiled_only

ONE_RAY = {"trace_tile", "_expose"}
HIERARCHY = {
    *("bound_spheres", "find_extent", "set_keys", "sort_range", "take_numbers", "gather_spheres"),
    *("split_ranges", "finish_subtrees", "finish_top"),
}
WHITE = (255, 255, 255)
BALL = vtray.Sphere((0, 0, 5), 1, WHITE, 1)
FLOOR = vtray.Plane((0, 5, 5), (0, -1, 0), WHITE, 0.5)


@pytest.fixture
def used(monkeypatch: pytest.MonkeyPatch) -> Callable[..., set[str]]:
    """Let kernels forget what is loaded; return what tells their names, if each has one type.

    That of the tracer is one for each of some purposes.
    """
    assert pixel_rays
    assert renderer  # with them, all kernels are imported
    modules = [module for name, module in sys.modules.items() if name.startswith("vtray.")]
    found = {id(item): item for module in modules for item in vars(module).values()}
    kernels = [item for item in found.values() if isinstance(item, Kernel)]
    for kernel in kernels:
        monkeypatch.setattr(kernel, "_native", {})

    def names(purposes: int = 1) -> set[str]:
        types = {kernel.__name__: list(kernel._native) for kernel in kernels}
        several = {name: len(of_one) for name, of_one in types.items() if len(of_one) > 1}
        assert several == ({"trace_tile": purposes} if purposes > 1 else {})
        return {name for name, of_one in types.items() if of_one}

    return names


def strided(array: NDArray) -> NDArray:
    wide = np.zeros((2 * len(array), *array.shape[1:]), array.dtype)
    wide[::2] = array
    return wide[::2]


def unaligned(array: NDArray) -> NDArray:
    shifted = np.zeros(array.nbytes + 1, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    shifted[...] = array
    return shifted


def frozen(array: NDArray) -> NDArray:
    array.flags.writeable = False
    return array


KINDS: list[Callable[[NDArray], object]] = [
    *(np.array, np.asfortranarray, strided, unaligned, frozen),
    *(lambda array: array[::-1], lambda array: array.astype(array.dtype.newbyteorder(">"))),
    *(
        lambda array: array.astype(np.float32) if array.dtype == np.float64 else array,
        np.ndarray.tolist,
    ),
]


def clouds(count: int) -> Iterator[vtray.Spheres]:
    """Return the same spheres, given in all kinds of arrays."""
    random = np.random.default_rng(0)
    center, radius, lambert = random.random((count, 3)), random.random(count), random.random(count)
    color = random.integers(0, 255, (count, 3)).astype(np.uint8)
    for kind in KINDS:
        yield vtray.Spheres(*map(kind, (center, radius, color, lambert)))
        yield vtray.Spheres(kind(center), 0.1, WHITE, 1)


def bonds(count: int) -> Iterator[vtray.Cylinders]:
    """Return the same cylinders, given in all kinds of arrays."""
    random = np.random.default_rng(0)
    start, end = random.random((2, count, 3))
    radius = random.random(count)
    color = random.integers(0, 255, (count, 3)).astype(np.uint8)
    for kind in KINDS:
        arrays = (kind(start), kind(end), kind(radius), kind(color))
        yield vtray.Cylinders(*arrays, color_end=kind(color))
        yield vtray.Cylinders(kind(start), kind(end), 0.1, WHITE, 1)


def render(
    *objects: object, lights: int = 1, projection: str = "perspective", **settings: object
) -> vtray.Image:
    """Render objects at a few pixels."""
    view = {"center": (0, 0, 0), "normal": (0, 0, 1), "focus": 10, "resolution": (1, 1)}
    camera = vtray.Camera(**view, size=(3, 2), projection=projection)
    scene = vtray.Scene(camera, [vtray.Light((0, -5, 5), 1)] * lights, list(objects))
    return vtray.render(scene, 1, warn=str, **settings)  # some have no light


def test_scenes_with_few_spheres_need_what_the_first_needed(used: Callable[..., set[str]]) -> None:
    render(BALL, FLOOR)
    assert used() == ONE_RAY
    for few in clouds(5):
        render(few)
        render(BALL, few, FLOOR)
        render(few, few)
    for count in (0, 1):
        for cloud in clouds(count):
            render(cloud)
    render()
    render(FLOOR)
    render(BALL, lights=0, projection="orthographic")
    render(FLOOR, size=(1, 1), exposure=2.0)
    assert used() == ONE_RAY
    for background in ("transparent", "white"):
        image = render(FLOOR, size=(1, 1), background=background, exposure=2.0)
    assert used() == ONE_RAY | {"_composite"}
    image.ids  # noqa: B018 - traces
    assert used(2) == ONE_RAY | {"_composite"}


def test_scenes_with_a_hierarchy_need_one_more_set(used: Callable[..., set[str]]) -> None:
    for many in clouds(200):
        render(many)
        render(BALL, many, FLOOR)
    assert used() == ONE_RAY | HIERARCHY


def test_cylinders_need_what_the_first_needed(used: Callable[..., set[str]]) -> None:
    post = vtray.Cylinder((0, 0, 5), (1, 0, 5), 1)
    image = render(post, samples=2, keep_lights=True)
    image.relight([2.0]).depth  # noqa: B018 - traces
    vtray.trace_pixel(image, 0, 0)
    needed = ONE_RAY | {"add_up_rows", "trace_pixel"}
    assert used(2) == needed
    for few in bonds(3):
        render(few)
        render(BALL, few, FLOOR, post, projection="orthographic")
    assert used(3) == needed
    for many in bonds(200):
        render(many)
        render(BALL, many, FLOOR)
    render(many, vtray.Spheres(np.random.default_rng(1).random((200, 3)), 0.1))
    of_cylinders = {"bound_cylinders", "gather_cylinders"}
    assert used(3) == needed | HIERARCHY | of_cylinders


def test_samples_other_lights_and_single_rays_need_a_kernel_each(
    used: Callable[..., set[str]],
) -> None:
    for objects in [(BALL, FLOOR), (), (BALL, *clouds(2))]:
        image = render(*objects, samples=2, keep_lights=True, filter="mitchell")
        image.relight([2.0]).recolor(0, "red") if objects else image.relight([2.0])
        image.expose(3.0).depth  # noqa: B018 - traces
        vtray.trace_pixel(image, 0, 0)
    assert used(2) == ONE_RAY | {"add_up_rows", "trace_pixel"}


def test_each_purpose_has_a_tracer_of_its_own(used: Callable[..., set[str]]) -> None:
    for purposes, samples in ((1, 1), (2, 3)):
        for keep in (False, True):
            image = render(BALL, samples=samples, keep_lights=keep)
            assert used(purposes) == ONE_RAY
    image.depth  # noqa: B018 - traces
    image.ids  # noqa: B018 - does not trace again
    assert used(3) == ONE_RAY
