"""Clip planes by a plain rule of their own, in long doubles; nothing of vtray is imported.

All crossings of a line with the surfaces of objects, and with the clip planes, are listed. One of a
surface counts if no clip plane leaves it out; one of a clip plane counts, where cuts are closed, if
it lies within an object and no other clip plane leaves it out. Of all that count, the first before
the image plane is seen, and anything between a point and a light hides it. Where one clip plane
cuts several objects, that is seen within which the point is deepest.
"""

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray
Real = np.longdouble
Scene = dict[str, Any]
NEAR = 1e-9
"""Crossings nearer than that to where a shadow ray starts are the start itself."""


class Seen(NamedTuple):
    """What the rays through the middles of all pixels see, each (height, width, ...)."""

    linear: Array
    depth: Array
    normals: Array
    ids: Array
    caps: Array


class Crossings(NamedTuple):
    """The crossings of rays with an object, each (m, n): what they are, and where."""

    at: Array
    counts: Array
    wall: Array
    """The clip plane, -1 for the object's own surface."""


def _vector(item: Any) -> Array:
    return np.array([item[axis] for axis in "xyz"], Real)


def _dot(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


class _Cutting:
    def __init__(
        self,
        scene: Scene,
        planes: list[tuple[Any, float]],
        is_capped: bool,
        cap: Any,
    ) -> None:
        self.scene, self.is_capped, self.cap = scene, is_capped, cap
        camera = scene["camera"]
        self.center, forward = _vector(camera["center"]), _vector(camera["normal"])
        self.forward = forward / np.sqrt(_dot(forward, forward))
        self.walls = []
        for normal, distance in planes:
            unit = np.array(normal, Real)
            self.walls.append((unit / np.sqrt(_dot(unit, unit)), Real(distance)))

    def within(self, points: Array, but: int = -1) -> Array:
        """Tell whether no clip plane, but maybe one, leaves out points."""
        found = np.ones(points.shape[:-1], bool)
        for k, (normal, distance) in enumerate(self.walls):
            if k != but:
                found &= _dot(points, normal) <= distance
        return found

    def depth_in(self, item: Scene, points: Array) -> Array:
        """Return how deep points are within the side of an object, below 0 inside; +inf beyond."""
        if item["type"] == "sphere":
            away = points - _vector(item["center"])
            return _dot(away, away) - Real(item["radius"]) ** 2
        start, end = _vector(item["start"]), _vector(item["end"])
        axis = end - start
        height = _dot(points - start, axis) / _dot(axis, axis)
        beside = points - start - height[..., None] * axis
        deep = _dot(beside, beside) - Real(item["radius"]) ** 2
        return np.where((height > 0) & (height < 1), deep, np.inf)

    def roots(self, item: Scene, starts: Array, rays: Array) -> list[Array]:
        """Return where rays cross the surface of an object, NaN for nowhere."""
        if item["type"] == "plane":
            normal = _vector(item["normal"])
            return [_dot(_vector(item["center"]) - starts, normal) / _dot(rays, normal)]
        if item["type"] == "sphere":
            arm = starts - _vector(item["center"])
            return _quadratic(
                _dot(rays, rays), _dot(arm, rays), _dot(arm, arm) - Real(item["radius"]) ** 2
            )
        start, end = _vector(item["start"]), _vector(item["end"])
        axis = end - start
        length2 = _dot(axis, axis)
        arm = starts - start
        height, rise = _dot(arm, axis) / length2, _dot(rays, axis) / length2
        beside, aside = arm - height[..., None] * axis, rays - rise[..., None] * axis
        sides = _quadratic(
            _dot(aside, aside),
            _dot(beside, aside),
            _dot(beside, beside) - Real(item["radius"]) ** 2,
        )
        found = [
            np.where((height + t * rise >= 0) & (height + t * rise <= 1), t, np.nan) for t in sides
        ]
        for cap in (0, 1):
            t = (cap - height) / rise
            spot = beside + t[..., None] * aside
            inside = _dot(spot, spot) <= Real(item["radius"]) ** 2
            found.append(np.where(inside, t, np.nan))
        return found

    def crossings(self, item: Scene, starts: Array, rays: Array) -> Crossings:
        at, counts, walls = [], [], []
        for t in self.roots(item, starts, rays):
            at.append(t)
            counts.append(self.within(starts + t[..., None] * rays) & np.isfinite(t))
            walls.append(np.full(t.shape, -1))
        if self.is_capped and item["type"] != "plane":
            for k, (normal, distance) in enumerate(self.walls):
                t = (distance - _dot(starts, normal)) / _dot(rays, normal)
                points = starts + t[..., None] * rays
                at.append(t)
                counts.append(self.within(points, k) & (self.depth_in(item, points) < 0))
                walls.append(np.full(t.shape, k))
        return Crossings(np.stack(at), np.stack(counts), np.stack(walls))

    def look(self) -> Seen:
        camera = self.scene["camera"]
        width, height = camera["size"]
        rows, columns = np.mgrid[0:height, 0:width].astype(Real)
        x, y = (
            (columns - width / 2) * camera["resolution"][0],
            (rows - height / 2) * camera["resolution"][1],
        )
        right, down = _axes(self.forward)
        beside = x[..., None] * right + y[..., None] * down
        focus = Real(camera["focus"])
        if camera.get("projection") == "orthographic":
            starts = self.center + beside - focus * self.forward
            rays = np.broadcast_to(self.forward, beside.shape)
        else:
            starts = np.broadcast_to(self.center - focus * self.forward, beside.shape)
            rays = beside + focus * self.forward
        rays = rays / np.sqrt(_dot(rays, rays))[..., None]
        best = np.full(x.shape, np.inf, Real)
        power, ids = np.full(x.shape, np.inf, Real), np.full(x.shape, -1)
        caps = np.full(x.shape, -1)
        for k, item in enumerate(self.scene["objects"]):
            found = self.crossings(item, starts, rays)
            for t, counts, wall in zip(*found, strict=True):
                points = starts + t[..., None] * rays
                seen = counts & (_dot(points - self.center, self.forward) > 0)
                deep = self.depth_in(item, points) if wall.flat[0] >= 0 else np.zeros_like(t)
                same = np.abs(t - best) <= 1e-14 * np.abs(t)
                nearer = seen & np.where(same, deep < power, t < best)
                best[nearer], ids[nearer], caps[nearer] = t[nearer], k, wall[nearer]
                power[nearer] = deep[nearer]
        points = starts + np.where(np.isfinite(best), best, 0)[..., None] * rays
        normals, colors = np.zeros(points.shape, Real), np.zeros(points.shape, Real)
        for k, item in enumerate(self.scene["objects"]):
            mine = ids == k
            normal = self.normals(item, points[mine], caps[mine])
            away = _dot(normal, rays[mine]) > 0
            normals[mine] = normal * np.where(away, -1, 1)[..., None]
            color = [item["color"][c] for c in "rgb"] if self.cap is None else self.cap
            colors[mine] = np.array([item["color"][c] for c in "rgb"], Real)
            colors[mine & (caps >= 0)] = np.array(color, Real)
            colors[mine] *= Real(item["lambert"])
        linear = np.zeros(points.shape, Real)
        for light in self.scene["lights"]:
            way = _vector(light["location"]) - points
            cosine = _dot(normals, way) / np.sqrt(_dot(way, way))
            lit = (cosine > 0) & ~self.hidden(points, way)
            linear += np.where(lit, cosine, 0)[..., None] * Real(light["intensity"]) * colors
        return Seen(linear, best, normals, ids, caps)

    def normals(self, item: Scene, points: Array, caps: Array) -> Array:
        """Return the unit normals at points of an object, on either side."""
        if item["type"] == "plane":
            found = np.broadcast_to(_vector(item["normal"]), points.shape)
        elif item["type"] == "sphere":
            found = points - _vector(item["center"])
        else:
            start, end = _vector(item["start"]), _vector(item["end"])
            axis = (end - start) / np.sqrt(_dot(end - start, end - start))
            height = _dot(points - start, axis)
            beside = points - start - height[..., None] * axis
            length = np.sqrt(_dot(end - start, end - start))
            from_cap = np.minimum(np.abs(height), np.abs(length - height))
            from_side = np.abs(np.sqrt(_dot(beside, beside)) - Real(item["radius"]))
            found = np.where((from_side <= from_cap)[..., None], beside, axis)
        found = np.array(found, Real)
        for k, (normal, _) in enumerate(self.walls):
            found[caps == k] = normal
        size = np.sqrt(_dot(found, found))
        return found / np.where(size > 0, size, 1)[..., None]

    def hidden(self, points: Array, way: Array) -> Array:
        """Tell whether anything lies between points and a light, before the image plane."""
        found = np.zeros(points.shape[:-1], bool)
        for item in self.scene["objects"]:
            at, counts, _ = self.crossings(item, points, way)
            before = _dot(points + at[..., None] * way - self.center, self.forward) > 0
            found |= (counts & (at > NEAR) & (at < 1) & before).any(axis=0)
        return found


def _quadratic(a: Array, half: Array, c: Array) -> list[Array]:
    root = np.sqrt(half * half - a * c)
    return [(-half - root) / a, (-half + root) / a]


def _axes(forward: Array) -> tuple[Array, Array]:
    x, y, z = forward
    k = 1 / (1 + z)
    return (
        np.array([1 - x * x * k, -x * y * k, -x]),
        np.array([-x * y * k, 1 - y * y * k, -y]),
    )


def look(
    scene: Scene, planes: list[tuple[Any, float]], *, is_capped: bool = False, cap: Any = None
) -> Seen:
    """Return what is seen of a scene of spheres, cylinders and planes that clip planes cut.

    Parameters
    ----------
    scene
        The scene as decoded JSON, whose camera looks forwards.
    planes
        A normal and a distance from the origin of each; what lies on the side that the normal
        points to is left out.
    is_capped, cap
        Whether cuts are closed, and the red, green and blue of all that closes them, if given.
    """
    with np.errstate(all="ignore"):
        return _Cutting(scene, planes, is_capped, cap).look()
