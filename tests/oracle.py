"""A second renderer of the same rules: plain, slow, and written on its own in NumPy.

It works on the scene as decoded JSON, on whole images, and tests every object against every ray.
Nothing of vtray is imported. With ``dtype=np.float64`` vtray must equal it to the last bit: both do
the same operations in the same order, and neither fuses a multiplication with an addition. With
``dtype=np.longdouble`` it tells how near both are to the truth.
"""

import math
from typing import Any

import numpy as np

ROUNDING = 2.0**-47
Scene = dict[str, Any]
Array = np.ndarray


def render(scene: Scene, dtype: type = np.float64) -> Array:
    """Return the linear light of a scene, (height, width, 3)."""
    with np.errstate(all="ignore"):
        return _Render(scene, dtype).linear()


def develop(linear: Array) -> Array:
    """Return the pixels of linear light."""
    peak = linear.max()
    if peak == 0:
        return np.zeros(linear.shape, np.uint8)
    pixels = np.floor(255 * linear / peak)
    return np.where(linear == peak, 255, pixels).astype(np.uint8)


def axes(normal: Array) -> tuple[Array, Array, Array]:
    """Return the camera's x', y', z'."""
    x, y, z = unit = normal / np.sqrt(dot(normal, normal))
    if z >= 0:
        k = 1 / (1 + z)
        return (
            np.array([1 - x * x * k, -x * y * k, -x]),
            np.array([-x * y * k, 1 - y * y * k, -y]),
            unit,
        )
    side = np.sqrt(x * x + y * y) if unit.dtype == np.longdouble else math.hypot(x, y)
    if side == 0:
        return np.array([-1, 0, 0], unit.dtype), np.array([0, 1, 0], unit.dtype), unit
    a, b, k = x / side, y / side, 1 - z
    return (
        np.array([1 - a * a * k, -a * b * k, -x]),
        np.array([-a * b * k, 1 - b * b * k, -y]),
        unit,
    )


def dot(a: Array, b: Array) -> Array:
    """Return scalar products over the last axis."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


class _Render:
    def __init__(self, scene: Scene, dtype: type) -> None:
        self.dtype = dtype
        camera = scene["camera"]
        self.width, self.height = (int(n) for n in camera["size"])
        self.pixel = [dtype(r) for r in camera["resolution"]]
        self.focus = dtype(camera["focus"])
        self.center = self.vector(camera["center"])
        self.right, self.down, self.forward = axes(self.vector(camera["normal"]))
        self.eye = -self.focus * self.forward
        # At the same distance spheres come before planes.
        self.objects = sorted(scene["objects"], key=lambda item: item["type"] == "plane")
        self.lights = scene["lights"]

    def vector(self, xyz: dict[str, float]) -> Array:
        return np.array([xyz["x"], xyz["y"], xyz["z"]], self.dtype)

    def place(self, xyz: dict[str, float]) -> Array:
        return self.vector(xyz) - self.center

    def color(self, item: Scene) -> Array:
        return np.array([item["color"][c] for c in "rgb"], self.dtype)

    def magnitude(self, item: Scene) -> Any:
        return np.abs(self.place(item["center"])).sum() + self.dtype(item.get("radius", 0))

    def normal(self, plane: Scene) -> Array:
        normal = self.vector(plane["normal"])
        return normal / np.sqrt(dot(normal, normal))

    def linear(self) -> Array:
        """Return the image, object by object and light by light."""
        rays = self.rays()
        distance, hit = self.nearest(rays)
        film = np.zeros((self.height, self.width, 3), self.dtype)
        for k, item in enumerate(self.objects):
            mine = hit == k
            if mine.any():
                film[mine] = self.shade(item, rays[mine], distance[mine])
        return film

    def rays(self) -> Array:
        """Return the unit direction of each pixel's ray, (height, width, 3)."""
        j, i = np.mgrid[0 : self.height, 0 : self.width].astype(self.dtype)
        u = ((i - self.dtype(self.width) / 2) * self.pixel[0])[..., None]
        v = ((j - self.dtype(self.height) / 2) * self.pixel[1])[..., None]
        ray = u * self.right + v * self.down - self.eye
        return ray / np.sqrt(dot(ray, ray))[..., None]

    def nearest(self, rays: Array) -> tuple[Array, Array]:
        """Return the distance and the number of the nearest object for each ray."""
        best = np.full(rays.shape[:2], np.inf, self.dtype)
        hit = np.full(rays.shape[:2], -1)
        forward = dot(rays, self.forward)
        for k, item in enumerate(self.objects):
            find = self.meet_sphere if item["type"] == "sphere" else self.meet_plane
            distance = find(item, rays, forward)
            nearer = distance < best
            best[nearer], hit[nearer] = distance[nearer], k
        return best, hit

    def meet_sphere(self, item: Scene, rays: Array, forward: Array) -> Array:
        radius = self.dtype(item["radius"])
        arm = self.eye - self.place(item["center"])
        middle = -dot(arm, rays)
        foot = arm + middle[..., None] * rays
        squared = radius * radius - dot(foot, foot)
        half = np.sqrt(squared)
        distance = np.full(middle.shape, np.inf, self.dtype)
        for t in (middle + half, middle - half):  # the near one last: it wins
            seen = (squared > 0) & (t * forward - self.focus > ROUNDING * (np.abs(t) + self.focus))
            distance[seen] = t[seen]
        return distance

    def meet_plane(self, item: Scene, rays: Array, forward: Array) -> Array:
        normal, point = self.normal(item), self.place(item["center"])
        descent = dot(rays, normal)
        t = dot(point - self.eye, normal) / descent
        depth = t * forward - self.focus
        bound = ROUNDING * (np.abs(point).sum() + self.focus + np.abs(t))
        return np.where((descent != 0) & (depth * np.abs(descent) > bound), t, self.dtype(np.inf))

    def shade(self, item: Scene, rays: Array, distance: Array) -> Array:
        """Return the light of points on one object, (n, 3)."""
        points = self.eye + distance[:, None] * rays
        if item["type"] == "sphere":
            normal = points - self.place(item["center"])
            normal = normal / np.sqrt(dot(normal, normal))[:, None]
        else:
            normal = np.broadcast_to(self.normal(item), points.shape)
        normal = np.where((dot(normal, rays) > 0)[:, None], -normal, normal)
        error = self.magnitude(item) + self.focus + distance
        total = np.zeros(points.shape, self.dtype)
        for light in self.lights:
            place = self.place(light["location"])
            way = place - points
            height = dot(normal, way)
            cosine = height / np.sqrt(dot(way, way))
            cosine[~(height > ROUNDING * (error + np.abs(place).sum()))] = 0
            cosine[self.blocked(points, error, place)] = 0
            strength = cosine * self.dtype(item["lambert"]) * self.dtype(light["intensity"])
            total = total + strength[:, None] * self.color(item)
        return total

    def blocked(self, points: Array, error: Array, light: Array) -> Array:
        """Tell which points any object hides from a light."""
        hidden = np.zeros(len(points), bool)
        for item in self.objects:
            hides = self.sphere_hides if item["type"] == "sphere" else self.plane_hides
            hidden |= hides(item, points, ROUNDING * (error + self.magnitude(item)), light)
        return hidden

    def sphere_hides(self, item: Scene, points: Array, reach: Array, light: Array) -> Array:
        center, radius = self.place(item["center"]), self.dtype(item["radius"])
        arm, way = points - center, light - points
        light_arm = np.broadcast_to(light - center, points.shape)
        light_depth = dot(light, self.forward)
        if light_depth < 0:  # the part behind the image plane does not count
            depth = dot(points, self.forward)
            way = (depth / (depth - light_depth))[:, None] * way
            light_arm = arm + way
        start = dot(arm, arm) - radius * radius
        end = dot(light_arm, light_arm) - radius * radius
        slack = reach * (2 * radius + reach)
        toward = -dot(arm, way)
        length2 = dot(way, way)
        moment = np.stack(
            [
                arm[:, 1] * way[:, 2] - arm[:, 2] * way[:, 1],
                arm[:, 2] * way[:, 0] - arm[:, 0] * way[:, 2],
                arm[:, 0] * way[:, 1] - arm[:, 1] * way[:, 0],
            ],
            axis=-1,
        )
        passes = dot(moment, moment) < radius * radius * length2
        enters = (toward > 0) & passes & ((end < 0) | (toward < length2))
        inside = start < -slack
        on = ~inside & (start <= slack)
        leaves = end > slack
        return np.where(inside, leaves, np.where(on, leaves & (toward > 0), enters))

    def plane_hides(self, item: Scene, points: Array, reach: Array, light: Array) -> Array:
        normal, point = self.normal(item), self.place(item["center"])
        offset = dot(point, normal)
        start = dot(points, normal) - offset
        end = dot(light, normal) - offset
        if abs(end) <= ROUNDING * (np.abs(point).sum() + np.abs(light).sum()):
            return np.zeros(len(points), bool)
        opposite = (np.abs(start) > reach) & (np.sign(start) != np.sign(end))
        light_depth, depth = dot(light, self.forward), dot(points, self.forward)
        crossing = np.abs(start) * light_depth + abs(end) * depth
        return opposite & (crossing > reach * (np.abs(start) + abs(end)))
