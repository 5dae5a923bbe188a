"""Random copies: some objects of a scene at several places."""

from typing import Any

import numpy as np

SHARE = 0.3
"""How many of the random scenes hold copies, from 0 to 1."""


def with_copies(random: np.random.Generator, scene: dict[str, Any]) -> dict[str, Any]:
    """Return a scene in which copies take the place of some of its bounded shapes.

    Those places are often such that copies touch, coincide, or are far away.
    """
    parts = [item for item in scene["objects"] if item["type"] in ("sphere", "cylinder", "cone")]
    if not parts:
        return scene
    chosen = [item for item in parts if random.random() < 0.5] or parts[:1]
    others = [item for item in scene["objects"] if not any(item is part for part in chosen)]
    first = chosen[0]
    size = max(first["radius"], *(abs(n) for n in _extent(chosen)), 1e-9)
    rows = [np.zeros(3)] if random.random() < 0.7 else []
    for _ in range(random.integers(0, 6)):
        way = np.roll([0.0, 0.0, 1.0], random.integers(3))
        if random.random() < 0.5:
            way = random.normal(size=3)
        away = random.choice([0.0, 2 * first["radius"], size / 4, size, 1e6 * size])
        rows.append(way * away)
    at = [dict(zip("xyz", map(float, row), strict=True)) for row in rows]
    copies = {"type": "copies", "objects": chosen, "at": at}
    place = int(random.integers(len(others) + 1))
    return {**scene, "objects": [*others[:place], copies, *others[place:]]}


def _extent(parts: list[dict[str, Any]]) -> list[float]:
    """Return how far objects are from the first, axis by axis."""
    points = np.array([list((part.get("center") or part["start"]).values()) for part in parts])
    extent: list[float] = np.ptp(points, axis=0).tolist()
    return extent
