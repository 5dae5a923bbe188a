"""Lights that go with a camera which goes around a scene."""

from vtray.base.errors import SceneError
from vtray.scene.light_types import Ambient, AnyLight, Light, RectangleLight, Sky, SphereLight, Sun
from vtray.scene.placing.directions import Vec, are_parallel, dot, unit
from vtray.scene.placing.moved import turned_about
from vtray.scene.vectors import Direction, Vector


def turned_light(light: AnyLight, degrees: float, middle: Vec, axis: Vec) -> AnyLight:
    """Return a light turned about a line, as `Camera.orbit` turns a camera.

    Parameters
    ----------
    light
        The light.
    degrees
        By how much, counterclockwise as seen against the axis.
    middle, axis
        A point of the line and its unit direction, in world space.

    Raises
    ------
    SceneError
        It is a sky with a picture that is not upright about this line.
    """

    def turned(vector: Vector | Direction) -> Vec:
        return turned_about((vector.x, vector.y, vector.z), axis, degrees)

    def moved(point: Vector) -> Vector:
        x, y, z = turned(Vector(point.x - middle[0], point.y - middle[1], point.z - middle[2]))
        return Vector(x + middle[0], y + middle[1], z + middle[2])

    if isinstance(light, Light | SphereLight):
        return light.replace(location=moved(light.location))
    if isinstance(light, RectangleLight):
        one, other = (Vector(*turned(edge)) for edge in light.edges)
        return light.replace(location=moved(light.location), edges=(one, other))
    if isinstance(light, Sun):
        return light.replace(direction=Direction(*turned(light.direction)))
    if isinstance(light, Sky) and (light.gradient or light.image):
        return _turned_sky(light, degrees, axis)
    assert isinstance(light, Ambient | Sky)  # noqa: S101 - the same from everywhere
    return light


def _turned_sky(sky: Sky, degrees: float, axis: Vec) -> Sky:
    """Return a sky of many colours, turned; without `up` of its own, the axis is up for it."""
    up = axis if sky.up is None else unit(sky.up)
    if are_parallel(up, axis):
        return sky.replace(rotation=sky.rotation + (degrees if dot(up, axis) > 0 else -degrees))
    if sky.image is not None:
        words = "a sky with a picture turns about its own up alone"
        raise SceneError(f"turntable: lights: {words}; give the camera the same, or lights='still'")
    return sky.replace(up=Direction(*turned_about(up, axis, degrees)))
