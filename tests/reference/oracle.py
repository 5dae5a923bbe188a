"""A second renderer of the same rules: plain, slow, and written on its own in NumPy.

It works on the scene as decoded JSON, on whole images, and tests every object against every ray.
Nothing of vtray is imported. With ``dtype=np.float64`` vtray must equal it to the last bit: both do
the same operations in the same order, and neither fuses a multiplication with an addition. With
``dtype=np.longdouble`` it tells how near both are to the truth. Cylinders and cones are worked out
by other formulas, and always in long doubles: where they are seen or in the way, vtray must equal
it as far as rounding allows, but for pixels that are in `doubt`.

Rays go through any places in the image, which are in pixels from the left and from the top; a pixel
itself is at integers.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from oracle_cone import Cone
from oracle_cylinder import Cylinder

ROUNDING = 2.0**-47
AXIAL = "cylinder", "cone"
WHITE = {"r": 255, "g": 255, "b": 255}
Scene = dict[str, Any]
Array = np.ndarray


class Seen(NamedTuple):
    """What rays see, each array of the shape of their places and more.

    Attributes
    ----------
    linear
        Linear light, (..., 3).
    depth
        Distance along the ray in scene units, infinite where nothing is, (...).
    normals
        Unit normals on the ray's side, 0 where nothing is, (..., 3).
    ids
        The place in ``scene["objects"]``, -1 where nothing is, (...).
    shadows
        Whether something is between the hit and a point light that it faces, (..., lights).
    parts
        What part of a cylinder is hit: its face, and 3 more in its second half; else 0, (...).
    """

    linear: Array
    depth: Array
    normals: Array
    ids: Array
    shadows: Array
    parts: Array


class Surfaces(NamedTuple):
    """What rays meet, (n, ...).

    Attributes
    ----------
    points, normals
        Where, and the unit normals there on the ray's side, (n, 3).
    colors, lamberts
        Of the surface, (n, 3) and (n,).
    errors
        What rounding errors of the points are relative to, (n,).
    parts
        As in `Seen`, (n,).
    """

    points: Array
    normals: Array
    colors: Array
    lamberts: Array
    errors: Array
    parts: Array


def render(scene: Scene, dtype: type = np.float64) -> Array:
    """Return the linear light of a scene, (height, width, 3)."""
    return look(scene, dtype=dtype).linear


def look(
    scene: Scene,
    columns: Any = None,
    rows: Any = None,
    dtype: type = np.float64,
    lens: Any = None,
) -> Seen:
    """Return what the rays through some places see; without places, those of all pixels.

    `lens` says where they go through the lens that the camera has then: how far to the right and
    down of its middle, in parts of its radius, (..., 2). What is seen is right but for rounding.
    """
    if columns is None:
        width, height = (int(n) for n in scene["camera"]["size"])
        rows, columns = np.mgrid[0:height, 0:width]
    columns, rows = np.broadcast_arrays(np.asarray(columns, dtype), np.asarray(rows, dtype))
    with np.errstate(all="ignore"):
        return _Render(scene, dtype, lens).look(columns, rows)


def doubt(scene: Scene) -> Array:
    """Tell in which pixels rounding may decide what cylinders show or hide, (height, width).

    What is seen there changes if cylinders are larger or smaller by what rounding may amount to.
    """
    rows, columns = np.mgrid[0 : scene["camera"]["size"][1], 0 : scene["camera"]["size"][0]]
    renders = []
    for first, last in ((0, 0), (1, 1), (-1, -1), (1, -1), (-1, 1)):
        render = _Render(scene, np.float64)
        # Those in the same place stay the same, so that the first of them is seen.
        places = [str(item.get("start")) + str(item.get("end")) for item in render.objects]
        ranks = np.unique(places, return_inverse=True)[1].astype(float)
        render.growth = (first + (last - first) * ranks / max(ranks.max(initial=0), 1)) / 4
        with np.errstate(all="ignore"):
            renders.append(render.look(columns.astype(float), rows.astype(float)))
    found = np.zeros(rows.shape, bool)
    for seen in renders[1:]:
        found |= (seen.ids != renders[0].ids) | (seen.parts != renders[0].parts)
        found |= (seen.shadows != renders[0].shadows).any(axis=-1)
    return found


def directions(scene: Scene, columns: Any, rows: Any) -> Array:
    """Return the unit directions of the rays through some places, (..., 3)."""
    return _Render(scene, np.float64).rays(np.asarray(columns), np.asarray(rows))[1]


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


def upright_axes(normal: Array, up: Array) -> tuple[Array, Array, Array]:
    """Return the camera's x', y', z', for y' opposite to the part of `up` square to z'."""
    forward = normal / np.sqrt(dot(normal, normal))
    down = -up / np.sqrt(dot(up, up))
    for _ in range(2):  # the first time may leave a part along z'
        down = down - dot(down, forward) * forward
        down = down / np.sqrt(dot(down, down))
    return cross(down, forward), down, forward


def cross(a: Array, b: Array) -> Array:
    """Return vector products over the last axis."""
    return np.stack(
        [
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ],
        axis=-1,
    )


def dot(a: Array, b: Array) -> Array:
    """Return scalar products over the last axis."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


class _Render:
    def __init__(self, scene: Scene, dtype: type, lens: Any = None) -> None:
        self.dtype = dtype
        camera = scene["camera"]
        self.places, self.lens = lens, camera.get("lens")
        self.width, self.height = (int(n) for n in camera["size"])
        self.pixel = [dtype(r) for r in camera["resolution"]]
        self.eye_distance = self.focus = dtype(camera["focus"])
        self.center = self.vector(camera["center"])
        normal = self.vector(camera["normal"])
        if "up" in camera:
            self.right, self.down, self.forward = upright_axes(normal, self.vector(camera["up"]))
        else:
            self.right, self.down, self.forward = axes(normal)
        self.parallel = camera.get("projection", "perspective") == "orthographic"
        # Rays from an eye far away start where they pass a plane nearby.
        view = self.width * self.pixel[0] + self.height * self.pixel[1]
        if self.focus > 2.0**30 * view:
            self.focus = view
        share = dtype(1) if self.parallel else 1 - self.focus / self.eye_distance
        self.shift = [share * length for length in self.pixel]
        # How far from there a ray may start.
        self.extent = self.width * self.shift[0] + self.height * self.shift[1]
        self.eye = -self.focus * self.forward
        # At the same distance spheres come before cylinders, these before cones, then planes.
        objects = scene["objects"]
        kinds = ["sphere", *AXIAL, "plane"]
        self.order = sorted(range(len(objects)), key=lambda k: kinds.index(objects[k]["type"]))
        self.objects = [objects[k] for k in self.order]
        self.lights = [item for item in scene["lights"] if item.get("type", "point") == "point"]
        # By how much of the bound on rounding each cylinder or cone is enlarged.
        self.growth = np.zeros(len(objects))
        self.cylinders = [self.cylinder(item) for item in self.objects]

    def vector(self, xyz: dict[str, float]) -> Array:
        return np.array([xyz["x"], xyz["y"], xyz["z"]], self.dtype)

    def place(self, xyz: dict[str, float]) -> Array:
        return self.vector(xyz) - self.center

    def cylinder(self, item: Scene) -> Cylinder | None:
        if item["type"] not in AXIAL:
            return None
        center = self.center.astype(np.longdouble)
        start, end = (
            np.array([item[name][axis] for axis in "xyz"], np.longdouble) - center
            for name in ("start", "end")
        )
        if item["type"] == "cone":
            return Cone(start, end, item["radius"], item["radius_end"])
        return Cylinder(start, end, item["radius"])

    def color(self, item: Scene, name: str = "color") -> Array:
        return np.array([item.get(name, item["color"])[c] for c in "rgb"], self.dtype)

    def light_color(self, light: Scene) -> Array:
        return np.array([light.get("color", WHITE)[c] for c in "rgb"], self.dtype) / self.dtype(255)

    def magnitude(self, item: Scene) -> Any:
        if item["type"] in AXIAL:
            way = self.vector(item["end"]).astype(np.longdouble) - self.vector(item["start"])
            length = self.dtype(np.sqrt(dot(way, way)))
            widest = max(item["radius"], item.get("radius_end", 0.0))
            return np.abs(self.place(item["start"])).sum() + length + self.dtype(widest)
        return np.abs(self.place(item["center"])).sum() + self.dtype(item.get("radius", 0))

    def normal(self, plane: Scene) -> Array:
        normal = self.vector(plane["normal"])
        return normal / np.sqrt(dot(normal, normal))

    def look(self, columns: Array, rows: Array) -> Seen:
        """Return what is seen."""
        starts, rays = self.rays(columns, rows)
        depth, hit, faces = self.nearest(starts, rays)
        linear = np.zeros((*hit.shape, 3), self.dtype)
        normals, shadows = np.zeros_like(linear), np.zeros((*hit.shape, len(self.lights)), bool)
        parts = np.zeros(hit.shape, int)
        met = hit >= 0
        surfaces = self.surfaces(hit[met], faces[met], starts[met], rays[met], depth[met])
        normals[met], parts[met] = surfaces.normals, surfaces.parts
        linear[met], shadows[met] = self.shade(surfaces)
        depth = depth + (self.eye_distance - self.focus)
        return Seen(linear, depth, normals, np.array([*self.order, -1])[hit], shadows, parts)

    def rays(self, columns: Array, rows: Array) -> tuple[Array, Array]:
        """Return where rays start, and their unit directions, both (..., 3)."""
        u = (columns - self.dtype(self.width) / 2)[..., None]
        v = (rows - self.dtype(self.height) / 2)[..., None]
        beside = u * self.shift[0] * self.right + v * self.shift[1] * self.down
        aside = u * self.pixel[0] * self.right + v * self.pixel[1] * self.down
        ray = aside + self.eye_distance * self.forward
        ray = np.broadcast_to(self.forward, aside.shape) if self.parallel else ray
        ray = ray / np.sqrt(dot(ray, ray))[..., None]
        if self.places is None:
            return self.eye + beside, ray
        return self.bent(self.eye + beside, ray)

    def bent(self, starts: Array, rays: Array) -> tuple[Array, Array]:
        """Return rays from places in the lens that meet given ones where these are sharp."""
        distance = self.lens["focus_distance"]
        left = (distance - self.eye_distance) + self.focus
        sharp = starts + rays * (left / dot(rays, self.forward))[..., None]
        right, down = self.places[..., :1], self.places[..., 1:]
        radius = self.lens["radius"] * left / distance
        starts = starts + radius * (right * self.right + down * self.down)
        ways = sharp - starts
        return starts, ways / np.sqrt(dot(ways, ways))[..., None]

    def nearest(self, starts: Array, rays: Array) -> tuple[Array, Array, Array]:
        """Return the distance, the number and the face of the nearest object for each ray."""
        best = np.full(rays.shape[:-1], np.inf, self.dtype)
        hit, faces = np.full(rays.shape[:-1], -1), np.zeros(rays.shape[:-1], int)
        forward = dot(rays, self.forward)
        for k, item in enumerate(self.objects):
            face = np.zeros_like(faces)
            if item["type"] in AXIAL:
                distance, face = self.meet_cylinder(k, starts, rays)
            else:
                find = self.meet_sphere if item["type"] == "sphere" else self.meet_plane
                distance = find(item, starts, rays, forward)
            nearer = distance < best
            best[nearer], hit[nearer], faces[nearer] = distance[nearer], k, face[nearer]
        return best, hit, faces

    def meet_sphere(self, item: Scene, starts: Array, rays: Array, forward: Array) -> Array:
        radius = self.dtype(item["radius"])
        arm = starts - self.place(item["center"])
        middle = -dot(arm, rays)
        foot = arm + middle[..., None] * rays
        squared = radius * radius - dot(foot, foot)
        half = np.sqrt(squared)
        distance = np.full(middle.shape, np.inf, self.dtype)
        magnitude = self.magnitude(item) + (self.extent + self.focus)
        for t in (middle + half, middle - half):  # the near one last: it wins
            bound = ROUNDING * (np.abs(t) + magnitude)
            seen = (squared > 0) & (t * forward - self.focus > bound)
            distance[seen] = t[seen]
        return distance

    def meet_plane(self, item: Scene, starts: Array, rays: Array, forward: Array) -> Array:
        normal, point = self.normal(item), self.place(item["center"])
        descent = dot(rays, normal)
        t = dot(point - starts, normal) / descent
        depth = t * forward - self.focus
        bound = ROUNDING * (np.abs(point).sum() + (self.extent + self.focus) + np.abs(t))
        return np.where((descent != 0) & (depth * np.abs(descent) > bound), t, self.dtype(np.inf))

    def meet_cylinder(self, k: int, starts: Array, rays: Array) -> tuple[Array, Array]:
        """Return the distances, and which face is met."""
        cylinder, item = self.cylinders[k], self.objects[k]
        shape = rays.shape[:-1]
        starts, rays = starts.reshape(-1, 3), rays.reshape(-1, 3)
        magnitude = self.magnitude(item) + (self.extent + self.focus)
        away = np.abs(dot(cylinder.start - starts, rays))
        larger = self.growth[k] * ROUNDING * (magnitude + away)
        found = cylinder.cross(starts, rays, ROUNDING * magnitude, larger)
        depth = found.at * dot(rays, self.forward) - self.focus
        bound = ROUNDING * (np.abs(found.at) + magnitude)
        seen = depth * found.steepness > bound
        first = np.where(seen[0], 0, 1)[None]
        at = np.take_along_axis(np.where(seen, found.at, np.inf), first, 0)[0]
        face = np.take_along_axis(found.face, first, 0)[0]
        return at.astype(self.dtype).reshape(shape), face.reshape(shape)

    def surface_of_cylinder(
        self, k: int, face: Array, points: Array, distance: Array
    ) -> tuple[Array, Array]:
        """Return the normals at points of faces, and which part of a cylinder is met there."""
        cylinder = self.cylinders[k]
        magnitude = self.magnitude(self.objects[k]) + (self.extent + self.focus) + distance
        second = cylinder.is_second(points, (1 + self.growth[k]) * ROUNDING * magnitude)
        return cylinder.normal(points, face).astype(self.dtype), face + 3 * second

    def surfaces(
        self, hit: Array, faces: Array, starts: Array, rays: Array, distance: Array
    ) -> Surfaces:
        """Return what rays meet that meet something, object by object."""
        points = starts + distance[:, None] * rays
        normals, colors = np.zeros_like(points), np.zeros_like(points)
        lamberts, magnitudes = np.zeros_like(distance), np.zeros_like(distance)
        parts = np.zeros(len(points), int)
        for k in np.unique(hit):
            item, mine = self.objects[k], hit == k
            color = self.color(item)
            if item["type"] in AXIAL:
                normal, part = self.surface_of_cylinder(
                    k, faces[mine], points[mine], distance[mine]
                )
                color = np.where((part >= 3)[:, None], self.color(item, "color_end"), color)
                parts[mine] = part
            elif item["type"] == "sphere":
                normal = points[mine] - self.place(item["center"])
                length = np.sqrt(dot(normal, normal))[:, None]
                normal = np.where(length > 0, normal / length, -rays[mine])
            else:
                normal = self.normal(item)
            normals[mine], colors[mine] = normal, color
            lamberts[mine], magnitudes[mine] = item["lambert"], self.magnitude(item)
        normals = np.where((dot(normals, rays) > 0)[:, None], -normals, normals)
        errors = magnitudes + (self.extent + self.focus) + distance
        return Surfaces(points, normals, colors, lamberts, errors, parts)

    def shade(self, found: Surfaces) -> tuple[Array, Array]:
        """Return light and shadows of points, (n, ...), light by light."""
        total = np.zeros(found.points.shape, self.dtype)
        shadows = np.zeros((len(total), len(self.lights)), bool)
        for k, light in enumerate(self.lights):
            place = self.place(light["location"])
            way = place - found.points
            height = dot(found.normals, way)
            cosine = height / np.sqrt(dot(way, way))
            cosine[~(height > self.light_reach(place, found.errors))] = 0
            lit = cosine > 0
            shadows[lit, k] = self.blocked(found.points[lit], found.errors[lit], place)
            cosine[shadows[:, k]] = 0
            strength = cosine * found.lamberts * self.dtype(light["intensity"])
            total = total + strength[:, None] * found.colors * self.light_color(light)
        return total, shadows

    def blocked(self, points: Array, error: Array, light: Array) -> Array:
        """Tell which points any object hides from a light."""
        hidden = np.zeros(len(points), bool)
        for k, item in enumerate(self.objects):
            reach = ROUNDING * (error + self.magnitude(item))
            if item["type"] in AXIAL:
                hidden |= self.cylinder_hides(k, points, reach, light)
            else:
                hides = self.sphere_hides if item["type"] == "sphere" else self.plane_hides
                hidden |= hides(item, points, reach, light)
        return hidden

    def cylinder_hides(self, k: int, points: Array, reach: Array, light: Array) -> Array:
        cylinder = self.cylinders[k]
        larger = self.growth[k] * reach
        ends = np.broadcast_to(light.astype(np.longdouble), points.shape)
        end_reach = self.light_reach(light, self.magnitude(self.objects[k]))
        light_depth = dot(light, self.forward)
        if light_depth < 0:  # the part behind the image plane does not count
            depth = dot(points, self.forward)
            share = depth / (depth - light_depth)
            ends = points + share[:, None] * (ends - points)
            end_reach = reach + share * end_reach
        start = cylinder.outside(points, larger)
        end = cylinder.outside(ends, self.growth[k] * end_reach)
        near, far = cylinder.cross(points, ends - points, reach, larger).at
        ahead = near + far > 0  # false for NaN
        enters = ahead & ((end < -end_reach) | (near + far < 2))
        leaves = (end > end_reach) & ((start < -reach) | ahead)
        return ~np.bool_(cylinder.is_nothing) & np.where(start > reach, enters, leaves)

    def sphere_hides(self, item: Scene, points: Array, reach: Array, light: Array) -> Array:
        center, radius = self.place(item["center"]), self.dtype(item["radius"])
        arm, way = points - center, light - points
        light_arm = np.broadcast_to(light - center, points.shape)
        light_depth = dot(light, self.forward)
        end_reach = self.light_reach(light, self.magnitude(item))
        if light_depth < 0:  # the part behind the image plane does not count
            depth = dot(points, self.forward)
            share = depth / (depth - light_depth)
            way = share[:, None] * way
            light_arm = arm + way
            end_reach = reach + share * end_reach
        start = dot(arm, arm) - radius * radius
        end = dot(light_arm, light_arm) - radius * radius
        slack = reach * (2 * radius + reach)
        end_slack = end_reach * (2 * radius + end_reach)
        toward = -dot(arm, way)
        length2 = dot(way, way)
        moment = cross(arm, way)
        passes = dot(moment, moment) < radius * radius * length2
        enters = (toward > 0) & passes & ((end < -end_slack) | (toward < length2))
        inside = start < -slack
        on = ~inside & (start <= slack)
        leaves = end > end_slack
        return np.where(inside, leaves, np.where(on, leaves & (toward > 0), enters))

    def light_reach(self, light: Array, magnitude: Any) -> Any:
        return ROUNDING * (magnitude + (np.abs(light).sum() + np.abs(self.center).sum()))

    def plane_hides(self, item: Scene, points: Array, reach: Array, light: Array) -> Array:
        normal, point = self.normal(item), self.place(item["center"])
        offset = dot(point, normal)
        start = dot(points, normal) - offset
        end = dot(light, normal) - offset
        if abs(end) <= self.light_reach(light, np.abs(point).sum()):
            return np.zeros(len(points), bool)
        opposite = (np.abs(start) > reach) & (np.sign(start) != np.sign(end))
        light_depth, depth = dot(light, self.forward), dot(points, self.forward)
        crossing = np.abs(start) * light_depth + abs(end) * depth
        return opposite & (crossing > reach * (np.abs(start) + abs(end)))
