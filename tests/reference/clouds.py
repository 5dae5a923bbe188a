"""Clouds of spheres that are hard on a hierarchy."""

from collections.abc import Callable

import numpy as np

import vtray

Cloud = Callable[[np.random.Generator, int], tuple[np.ndarray, object]]


def _uniform(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 3)), random.uniform(0, 0.2, n)


def _float32(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.normal(size=(n, 3)).astype(np.float32), np.float32(0.05)


def _one_point(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return np.full((n, 3), (0.1, -0.2, 0.7)), random.choice([0.5, 0.25, 0.125], n)


def _line(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 1)) * (1, 0, 0) + (0, 2, 5), 0.01


def _plane(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 3)) * (1, 1, 0), random.uniform(0, 0.1, n)


def _cluster_and_outlier(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    center = random.normal(size=(n, 3))
    center[n // 2] = 1e9, -1e9, 1e9
    return center, 0.1


def _geometric(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    size = 10.0 ** -random.uniform(0, 12, (n, 1))
    return size * random.normal(size=(n, 3)), 0.2 * size[:, 0]


def _geometric_to_nothing(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    size = 2.0 ** -np.arange(n)[:, None].clip(0, 1080)
    signs = np.where(np.arange(n) % 2, 1, -1)[:, None]  # the middle of them all is nearly 0
    return size * signs * (1.0, 0.5, -1.0), 0.1 * size[:, 0]


def _rounded(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.integers(-3, 4, (n, 3)).astype(float), 0.5


def _all_radii(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 3)), 10.0 ** random.uniform(-10, 0, n)


def _no_radius(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 3)), 0.0


def _far_away(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1, 1, (n, 3)) + np.array((1e7, -2e8, 3e6)), random.uniform(0, 0.2, n)


def _tiny(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1e-300, 1e-300, (n, 3)), 1e-301


def _huge(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return random.uniform(-1e300, 1e300, (n, 3)), random.uniform(0, 2e299, n)


def _subnormal(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return 5e-324 * random.integers(-9, 10, (n, 3)), 5e-324


def _same_place_and_radius(random: np.random.Generator, n: int) -> tuple[np.ndarray, object]:
    return np.repeat(random.uniform(-1, 1, (n // 5 + 1, 3)), 5, axis=0)[:n], 0.3


CLOUDS: dict[str, Cloud] = {
    function.__name__.removeprefix("_"): function
    for function in (
        _uniform,
        _float32,
        _one_point,
        _line,
        _plane,
        _cluster_and_outlier,
        _geometric,
        _geometric_to_nothing,
        _rounded,
        _all_radii,
        _no_radius,
        _far_away,
        _tiny,
        _huge,
        _subnormal,
        _same_place_and_radius,
    )
}


def cloud(name: str, count: int, seed: int) -> vtray.Spheres:
    """Return a cloud of spheres of random colours."""
    random = np.random.default_rng(seed)
    center, radius = CLOUDS[name](random, count)
    color = random.integers(0, 256, (count, 3), dtype=np.uint8)
    return vtray.Spheres(center, radius, color, random.uniform(0.2, 1, count))
