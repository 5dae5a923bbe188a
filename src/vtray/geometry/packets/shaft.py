"""Conservative tests that leave out, for a whole block of rays, what none of them can meet.

A sphere is left out only if every ray of the block misses it by more than rounding could explain,
so the picture is the same to the last bit as with all objects tested. Each comparison is false
for NaN, which keeps the sphere.
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, dot, scale, sub


@device
def outside_shaft(center: Vec, radius: float, light: Vec, box_center: Vec, box_half: Vec) -> bool:
    """Tell whether a sphere lies wholly outside the shaft from a light to a box of hits.

    The shaft is the convex hull of light and box. The line from the point of its axis that is
    nearest to the sphere's centre, through that centre, is tried as a separating direction.

    Parameters
    ----------
    center, radius
        The sphere, its radius widened by the margin.
    light
        The shaft's tip.
    box_center, box_half
        The centre and the half extents of the box.
    """
    axis = sub(box_center, light)
    arm = sub(center, light)
    length2 = dot(axis, axis)
    along = dot(arm, axis) / length2 if length2 > 0.0 else 0.0
    away = sub(arm, scale(min(max(along, 0.0), 1.0), axis))
    spread = box_half[0] * abs(away[0]) + box_half[1] * abs(away[1]) + box_half[2] * abs(away[2])
    gap = dot(arm, away) - max(0.0, dot(axis, away) + spread)
    return (gap > 0.0) & (gap * gap > radius * radius * dot(away, away))
