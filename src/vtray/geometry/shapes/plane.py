"""The plane: where a ray meets it, and whether it blocks a shadow ray."""

import math

from vtray.base.compiler.compiled import device


@device
def intersect_plane(height: float, descent: float) -> float:
    """Return the distance at which a ray meets a plane, ``inf`` if it is parallel.

    Parameters
    ----------
    height
        The signed distance from the ray's origin to the plane, along the plane's normal.
    descent
        The ray's unit direction times the plane's normal.
    """
    return height / descent if descent != 0.0 else math.inf


@device
def plane_blocks(
    start: float, end: float, start_depth: float, end_depth: float, reach: float
) -> bool:
    """Tell whether a plane lies between a point and a light, in front of the image plane.

    Parameters
    ----------
    start
        The point's signed distance from the plane.
    end
        The light's, 0 if it lies in the plane: then nothing lies between.
    start_depth, end_depth
        Signed distances of point and light from the image plane.
    reach
        How far rounding may have moved the point: one nearer to the plane than that is on it.
    """
    opposite = ((start > reach) & (end < 0.0)) | ((start < -reach) & (end > 0.0))
    # The crossing's depth is (|start| end_depth + |end| start_depth) / (|start| + |end|).
    crossing = abs(start) * end_depth + abs(end) * start_depth
    return opposite & (crossing > reach * (abs(start) + abs(end)))
