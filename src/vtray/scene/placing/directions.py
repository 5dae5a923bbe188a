"""Vectors in plain Python, for what is done once for a scene: 3-tuples of floats."""

import math

from vtray.base.exact_math import hypotenuse
from vtray.scene.vectors import Direction, Vector

Vec = tuple[float, float, float]


def unit(vector: Direction | Vector) -> Vec:
    """Return a vector of any length, not all zero, scaled to length 1."""
    x, y, z = vector.x, vector.y, vector.z
    # A power of two first: squares of tiny and of huge numbers would be lost.
    exponent = math.frexp(max(abs(x), abs(y), abs(z)))[1]
    x, y, z = (math.ldexp(value, -exponent) for value in (x, y, z))
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def dot(a: Vec, b: Vec) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec:
    """Return the vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def times(factor: float, vector: Vec) -> Vec:
    """Return a vector so many times as long."""
    return factor * vector[0], factor * vector[1], factor * vector[2]


def along(start: Vec, distance: float, direction: Vec) -> Vec:
    """Return the point at a distance from another in a direction."""
    x, y, z = start
    return x + distance * direction[0], y + distance * direction[1], z + distance * direction[2]


def are_parallel(a: Vec, b: Vec, sine: float = 1e-9) -> bool:
    """Tell whether two unit vectors point the same or opposite ways, within an angle's sine."""
    return hypotenuse(*cross(a, b)) < sine


def are_square(a: Vec, b: Vec, sine: float = 1e-3) -> bool:
    """Tell whether two unit vectors are at right angles, within an angle of this sine."""
    return abs(dot(a, b)) <= sine


def view_axes(forward: Vec, up: Vec) -> tuple[Vec, Vec]:
    """Return the unit axes right and down of a camera that looks along `forward`.

    Parameters
    ----------
    forward, up
        Unit vectors, not parallel. What of `up` is square to `forward` points up in the image.
    """
    # Twice: the first time may leave a part along `forward` that rounding made.
    down = along((0.0, 0.0, 0.0), -1.0, up)
    for _ in range(2):
        down = along(down, -dot(down, forward), forward)
        length = math.sqrt(dot(down, down))
        down = (down[0] / length, down[1] / length, down[2] / length)
    return cross(down, forward), down


def beside(up: Vec) -> Vec:
    """Return a unit vector square to a unit vector, for what has to begin somewhere around it.

    It is the world's axis after that which is nearest to the vector, x for z, y for x, and z for y;
    or as near to it as can be.
    """
    nearest = max(range(3), key=lambda k: (abs(up[k]), k))
    x, y, z = (1.0 if k == (nearest + 1) % 3 else 0.0 for k in range(3))
    _, behind = view_axes(up, (x, y, z))
    return -behind[0], -behind[1], -behind[2]


def camera_axes(forward: Vec) -> tuple[Vec, Vec]:
    """Return the axes right and down for a camera that looks along the unit vector `forward`.

    They are (1, 0, 0) and (0, 1, 0), turned by the smallest rotation that takes (0, 0, 1) to
    `forward`; for (0, 0, -1) by 180 degrees about (0, 1, 0).

    References
    ----------
    Rodrigues' rotation formula, with ``1 / (1 + z)`` written as ``(1 - z) / (x*x + y*y)`` in the
    back half, where ``1 + z`` would lose digits.
    """
    x, y, z = forward
    if z >= 0.0:
        turn = 1.0 / (1.0 + z)
        return (1.0 - x * x * turn, -x * y * turn, -x), (-x * y * turn, 1.0 - y * y * turn, -y)
    side = hypotenuse(x, y)
    if side == 0.0:
        return (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    a, b, turn = x / side, y / side, 1.0 - z
    return (1.0 - a * a * turn, -a * b * turn, -x), (-a * b * turn, 1.0 - b * b * turn, -y)
