"""What faded shapes make up, as arrays."""

import numpy as np

from vtray.base.capacity import MAX_NUMBERS
from vtray.geometry.world import Bodies
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.bodies import FadedBodies, has_faded
from vtray.rendering.joined import joined, rows_of
from vtray.scene.scene import Plane


def pack_bodies(kept: Acceleration, planes: list[Plane]) -> Bodies | None:
    """Return the bodies of all faded shapes; None if there are none. Each plane is its own."""
    if not has_faded(kept.bodies, planes):
        return None
    none = np.zeros(1, np.int32)
    sources = len(kept.shapes) + len(kept.copied)
    found = kept.bodies or FadedBodies((none,) * sources, np.zeros(0))
    of_planes = np.arange(len(planes), dtype=np.int32) + len(found.opacity)
    bodies = [*found.of_sources, of_planes]
    row, step = rows_of(bodies)
    ranges = kept.ranges
    k = np.where(ranges.copied < 0, ranges.kind, len(kept.shapes) + ranges.copied)
    k, begin = np.append(k, sources), np.append(ranges.begin, 0)
    return Bodies(
        np.append(ranges.first, kept.count),
        np.append(ranges.each, MAX_NUMBERS),
        row[k] + begin * step[k],
        step[k],
        joined(bodies, np.int32),
        np.append(found.opacity, [plane.opacity for plane in planes]),
    )
