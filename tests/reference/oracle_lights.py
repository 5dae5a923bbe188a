"""Soft lights by the rules alone: where each ray to them goes, what it counts, and what stops it.

Plain, slow, and written on its own in long doubles, beside `oracle`, which gives the hits. Nothing
of vtray's lights is imported. Every ray is told against every object; one that rounding may decide
is in doubt: objects that are a little larger or smaller would stop it or not, or it is a little
askew.
"""

from typing import Any, NamedTuple

import numpy as np
import oracle
import sample_places
from oracle import ROUNDING, dot
from oracle_rectangle import panel_of
from oracle_sky import SkyOracle, is_colorful

Array = np.ndarray
Scene = dict[str, Any]
Long = np.longdouble

FIRST_FANS, ORDER = 2**28, 2**29
ORDER_DIGITS = 20
FAR = Long(2) ** 2000
"""How long rays are that end nowhere."""

PI = 4 * np.arctan(Long(1))
TURN = Long(2) ** -46
"""By how much rounding may turn a direction."""
SKY_TURN = Long(1e-6)
"""The same of one that is chosen by brightness: beside what is dark, a root makes much of it."""
# The first is a ray as it is.
CHANGES = [(0, 0), (1, 1), (-1, -1), (1, -1), (-1, 1)]
"""How objects are larger, and rays askew, in units of what rounding may amount to."""


class Hit(NamedTuple):
    """What the ray through the middle of a pixel meets.

    Attributes
    ----------
    item
        The object.
    point, normal
        Where it is met, relative to the middle of the image plane, and the unit normal there, (3,).
    error
        What its rounding error is relative to.
    """

    item: Scene
    point: Array
    normal: Array
    error: float


CLEARLY = 1e-9
"""How far above the horizon the whole of a lamp must be, as a sine."""


class Fan(NamedTuple):
    """The rays from a hit to a light, all (rays, ...).

    Attributes
    ----------
    points
        Points of the unit square, one for each ray.
    directions, lengths
        Unit vectors, and how long the rays are.
    weights
        What they count where they arrive, (rays, 1), or (rays, 3) for red, green and blue.
    arrives
        Whether they do.
    doubt
        Whether rounding decides that.
    turns, length_errors
        By how much rounding may change directions, and lengths.
    middle
        What all of a round lamp brings that is above the horizon as a whole, else None.
    """

    points: Array
    directions: Array
    lengths: Array
    weights: Array
    arrives: Array
    doubt: Array
    turns: Array
    length_errors: Array
    middle: float | None

    @property
    def shares(self) -> Array:
        """What arrives of the light, (1,) or (3,)."""
        if self.middle is not None and self.arrives.all():
            return np.array([self.middle])
        return np.where(self.arrives[:, None], self.weights, 0).mean(axis=0)

    @property
    def doubted_shares(self) -> Array:
        """What rays in doubt may make of it more, or less."""
        doubted = np.where(self.doubt[:, None], np.maximum(self.weights, 0), 0).mean(axis=0)
        if self.middle is None or not doubted.any() or not (self.arrives | self.doubt).all():
            return doubted
        # With all rays, the share is that at the middle, and not the mean of so few.
        return doubted + np.abs(self.middle - self.weights.mean(axis=0))


class _Rays(NamedTuple):
    """Rays from one point; `more` and `askew` are those of `CHANGES`."""

    start: Array
    error: Any
    ways: Array
    lengths: Array
    end_error: Any
    turn: Any
    more: int = 0
    askew: int = 0


class _Aim(NamedTuple):
    """Where rays to a light go: in a cone of some spread round an axis, or to all sides of it."""

    axis: Array
    spread: Any
    error: Any = 0.0
    turn: Any = TURN
    is_doubtful: bool = False


class SoftOracle:
    """The soft lights of a scene, given as decoded JSON without copies."""

    def __init__(self, scene: Scene) -> None:
        self.plain = oracle._Render(scene, np.float64)
        self.exact = oracle._Render(scene, Long)
        self.lights = [item for item in scene["lights"] if item.get("type", "point") != "point"]
        camera = scene["camera"]
        up = self.exact.vector(camera["up"]) if "up" in camera else -self.exact.down
        self.skies = {
            k: SkyOracle(one, up) for k, one in enumerate(self.lights) if is_colorful(one)
        }

    def hit(self, column: int, row: int) -> Hit | None:
        """Return what the ray through the middle of a pixel meets."""
        with np.errstate(all="ignore"):
            render = self.plain
            start, ray = render.rays(np.array([float(column)]), np.array([float(row)]))
            start = np.broadcast_to(start, ray.shape)
            distance, found, face = render.nearest(start, ray)
            if found[0] < 0:
                return None
            met = render.surfaces(found, face, start, ray, distance)
        item = render.objects[found[0]]
        return Hit(item, met.points[0], met.normals[0], float(met.errors[0]))

    def fan(self, hit: Hit, light: int, column: int, row: int, seed: int, rays: int) -> Fan:
        """Return the rays from a hit to one of the soft lights: the first fan of a pixel's middle.

        Parameters
        ----------
        hit
            The hit.
        light
            The light, counted among the soft ones.
        column, row, seed
            The pixel, and the seed.
        rays
            How many.
        """
        square = [pixel >> ORDER_DIGITS // 2 for pixel in (column, row)]
        order, _ = sample_places.pixel_keys(*square, ORDER + light, seed)
        place = sample_places.place_in_order(column, row, ORDER_DIGITS, order)
        keys = sample_places.pixel_keys(*square, FIRST_FANS + light, seed)
        numbers = np.array(sample_places.sobol(rays, place * rays), np.uint64)
        points = np.stack(
            [sample_places.owen(numbers[k], np.uint64(keys[k])) for k in range(2)], axis=-1
        )
        with np.errstate(all="ignore"):
            return self._fan(hit, self.lights[light], points, self.skies.get(light))

    def _fan(self, hit: Hit, light: Scene, points: Array, sky: SkyOracle | None) -> Fan:
        if light["type"] == "rectangle":
            return self._fan_to_rectangle(hit, light, points)
        point, normal = hit.point.astype(Long), hit.normal.astype(Long)
        aim = self._aim(hit, light)
        is_around = aim.spread is None
        by_brightness = np.zeros(len(points), bool)
        inner = points
        if sky is not None and sky.is_by_brightness:
            by_brightness = points[:, 0] < 0.5
            inner = np.stack([np.mod(2 * points[:, 0], 1), points[:, 1]], axis=-1)
        x, y = disc(inner.astype(Long))
        squared, turn = x * x + y * y, aim.turn
        if aim.spread is None:
            height, stretch = np.sqrt(np.maximum(1 - squared, 0)), Long(1)
            # Near the horizon, a root makes much of rounding.
            turn = TURN / np.maximum(height, TURN)
        else:
            height = 1 - aim.spread * squared
            stretch = np.sqrt(aim.spread * (2 - aim.spread * squared))
        one, other = frame(aim.axis)
        beside = (stretch * x)[:, None] * one + (stretch * y)[:, None] * other
        ways = beside + height[:, None] * aim.axis
        if sky is not None and by_brightness.any():
            ways[by_brightness] = sky.bright_ways(inner[by_brightness])
            turn = np.where(by_brightness, SKY_TURN, turn)
        cosines, weights = dot(ways, normal), np.ones(len(points), Long)
        if aim.spread is not None:
            squarely = (1 - aim.spread / 2) if "radiance" not in light else 1 / (2 * aim.spread)
            weights = np.maximum(cosines, 0) / squarely
        weights = weights[:, None] if sky is None else sky.weights(ways, normal)
        lengths, length_errors = self._lengths(hit, light, aim, ways, turn)
        rays = _Rays(point, hit.error, ways, lengths, hit.error + aim.error, turn)
        stopped, sure, maybe = self._stopped(rays)
        faces = (weights > 0).any(axis=1)
        arrives = faces & ~stopped
        grazes = (np.abs(cosines) <= 2 * turn) & (by_brightness | (not is_around))
        doubt = aim.is_doubtful | (faces & maybe & ~sure) | grazes
        turns = np.broadcast_to(turn, lengths.shape)
        middle = None
        if aim.spread is not None and aim.spread < 1:
            rise = dot(aim.axis, normal)
            is_above = rise > np.sqrt(aim.spread * (2 - aim.spread)) + Long(CLEARLY)
            whole = 1 if "radiance" not in light else (1 - aim.spread / 2) * 2 * aim.spread
            middle = float(rise * whole) if is_above else None
        return Fan(points, ways, lengths, weights, arrives, doubt, turns, length_errors, middle)

    def _fan_to_rectangle(self, hit: Hit, light: Scene, points: Array) -> Fan:
        """Return the rays to a rectangle lamp."""
        point, normal = hit.point.astype(Long), hit.normal.astype(Long)
        place = self.exact.place(light["location"])
        one, other = (self.exact.vector(edge).astype(Long) for edge in light["edges"])
        panel = panel_of(place - point, (one, other))
        error = np.abs(place).sum() + np.abs(self.exact.center).sum() + sum(panel.half)
        reach = ROUNDING * (hit.error + error)
        is_doubtful = abs(panel.height - reach) <= 2**-30 * reach
        panel = panel._replace(height=max(panel.height, reach))
        ways, slope = panel.ways(points)
        whole = PI if "radiance" in light else panel.square_integral
        share = panel.solid_angle / whole if panel.height > reach else Long(0)
        # Near its plane, rounding turns rays by more; in what is small, sums of arc tangents tell
        # places only as shares of it.
        vague = min(Long(2) ** -60 / panel.solid_angle, 1) * max(panel.half) / panel.height
        turn = TURN * slope + 2 * vague + reach / (32 * panel.height)
        cosines = dot(ways, normal)
        weights = (share * np.maximum(cosines, 0))[:, None]
        steep = dot(ways, panel.toward)
        lengths = panel.height / steep
        length_errors = reach + lengths * turn / steep
        rays = _Rays(point, hit.error, ways, lengths, hit.error + error, turn)
        stopped, sure, maybe = self._stopped(rays)
        faces = weights[:, 0] > 0
        arrives = faces & ~stopped
        doubt = is_doubtful | (faces & maybe & ~sure) | (np.abs(cosines) <= 2 * turn)
        return Fan(points, ways, lengths, weights, arrives, doubt, turn, length_errors, None)

    def _aim(self, hit: Hit, light: Scene) -> _Aim:
        """Return where rays to a light go."""
        normal = hit.normal.astype(Long)
        if light["type"] == "sun":
            way = -self.exact.vector(light["direction"])
            axis = unit(way / np.abs(way).max())
            spread = 2 * np.sin(Long(light.get("angle", 0.53)) / 4 * PI / 180) ** 2
            return _Aim(axis, spread, is_doubtful=0 < abs(axis[2]) < TURN)
        if light["type"] != "sphere":
            return _Aim(normal, None)
        place, radius = self.exact.place(light["location"]), Long(light["radius"])
        error = np.abs(place).sum() + np.abs(self.exact.center).sum() + radius
        way = place - hit.point
        distance = np.sqrt(dot(way, way))
        # On its surface, rounding decides whether a point is inside.
        is_doubtful = bool(np.abs(distance - radius) <= ROUNDING * (hit.error + error))
        if distance <= radius:
            return _Aim(normal, None, error, is_doubtful=is_doubtful)
        axis, sine = way / distance, radius / distance
        cosine = np.sqrt((1 - sine) * (1 + sine))
        # Near the surface, a root makes much of rounding, and the frame is cut where z is 0.
        turn = TURN / np.maximum(cosine, TURN)
        is_doubtful |= bool(0 < abs(axis[2]) < TURN)
        return _Aim(axis, sine**2 / (1 + cosine), error, turn, is_doubtful)

    def _lengths(
        self, hit: Hit, light: Scene, aim: _Aim, ways: Array, turn: Any
    ) -> tuple[Array, Array]:
        """Return how long rays are, and by how much rounding may change that, (rays,)."""
        if light["type"] == "sphere":
            way = self.exact.place(light["location"]) - hit.point
            reach, radius = ROUNDING * (hit.error + aim.error), Long(light["radius"])
            return sphere_lengths(way, radius, ways, aim.spread is None, reach, turn)
        lengths = np.full(len(ways), Long(light.get("distance", FAR)))
        return lengths, ROUNDING * (hit.error + lengths)

    def _stopped(self, rays: _Rays) -> tuple[Array, Array, Array]:
        """Tell which rays an object stops, which whatever rounding does, and which one may stop."""
        stopped, sure, maybe = np.zeros((3, len(rays.ways)), bool)
        kinds = {
            "sphere": self._sphere_stops,
            "plane": self._plane_stops,
            "cylinder": self._cylinder_stops,
            "cone": self._cylinder_stops,
        }
        for k, item in enumerate(self.exact.objects):
            reach = ROUNDING * (rays.error + self.exact.magnitude(item))
            end_reach = ROUNDING * (rays.end_error + self.exact.magnitude(item))
            told = []
            for more, askew in CHANGES:
                changed = rays._replace(more=more, askew=askew)
                told.append(kinds[item["type"]](k, changed, reach, end_reach))
            stopped |= told[0]
            sure |= np.all(told, axis=0)
            maybe |= np.any(told, axis=0)
        return stopped, sure, maybe

    def _cut(self, rays: _Rays, reach: Any, end_reach: Any) -> tuple[Array, Array]:
        """Return how long rays are up to the image plane, and how exact their ends are then."""
        depth = dot(rays.start, self.exact.forward) + rays.more * reach / 8
        descent = -(dot(rays.ways, self.exact.forward) + rays.askew * rays.turn)
        at = np.where(descent > 0, depth / np.where(descent > 0, descent, 1), np.inf)
        is_cut = at < rays.lengths
        lengths = np.where(is_cut, at, rays.lengths)
        return lengths, np.where(is_cut, reach + at / rays.lengths * end_reach, end_reach)

    def _sphere_stops(self, k: int, rays: _Rays, reach: Any, end_reach: Any) -> Array:
        item = self.exact.objects[k]
        arm = rays.start - self.exact.place(item["center"])
        away = np.sqrt(dot(arm, arm))
        radius = Long(item["radius"]) + rays.more * reach / 4
        larger = radius + rays.more * away * rays.turn
        lengths, end_reach = self._cut(rays, reach, end_reach)
        middle = -dot(arm, rays.ways)
        foot = arm + middle[:, None] * rays.ways
        crosses = (dot(foot, foot) < larger * larger) & (larger > 0)
        ends = arm + lengths[:, None] * rays.ways
        end = np.sqrt(dot(ends, ends)) - radius
        return _stops(away - radius, end, crosses, middle, lengths, reach, end_reach)

    def _cylinder_stops(self, k: int, rays: _Rays, reach: Any, end_reach: Any) -> Array:
        cylinder = self.exact.cylinders[k]
        assert cylinder is not None
        if cylinder.is_nothing:
            return np.zeros(len(rays.ways), bool)
        starts = np.broadcast_to(rays.start, rays.ways.shape)
        way = rays.start - cylinder.start
        away = np.sqrt(dot(way, way)) + cylinder.length
        larger = rays.more * reach / 4
        lengths, end_reach = self._cut(rays, reach, end_reach)
        near, far = cylinder.cross(
            starts, rays.ways, reach, larger + rays.more * away * rays.turn
        ).at
        start = cylinder.outside(starts, larger)
        end = cylinder.outside(starts + lengths[:, None] * rays.ways, larger)
        crosses, middle = ~np.isnan(near), (near + far) / 2
        return _stops(start, end, crosses, middle, lengths, reach, end_reach)

    def _plane_stops(self, k: int, rays: _Rays, reach: Any, end_reach: Any) -> Array:
        item = self.exact.objects[k]
        normal = self.exact.normal(item)
        height = dot(rays.start - self.exact.place(item["center"]), normal)
        height = height + rays.more * reach / 4
        rise = dot(rays.ways, normal) + rays.askew * rays.turn
        end = height + rays.lengths * rise
        apart = (np.abs(height) > reach) & (np.abs(end) > end_reach) & (height * end < 0)
        at = -height / np.where(rise != 0, rise, 1)
        forward = self.exact.forward
        depth = dot(rays.start, forward) + at * (dot(rays.ways, forward) + rays.askew * rays.turn)
        return apart & (depth > reach * (1 + rays.more / 4))


def unit(vector: Array) -> Array:
    """Return a vector of length 1."""
    return vector / np.sqrt(dot(vector, vector))


def disc(points: Array) -> tuple[Array, Array]:
    """Return points of the unit disc, by the four cases of Shirley's and Chiu's paper."""
    a, b = 2 * points[:, 0] - 1, 2 * points[:, 1] - 1
    cases = [(a > -b) & (a > b), a > -b, a < b, b != 0]
    radius = np.select(cases, [a, b, -a, -b], 0)
    turns = np.select(cases, [b / a, 2 - a / b, 4 + b / a, 6 - a / b], 0)
    return radius * np.cos(PI / 4 * turns), radius * np.sin(PI / 4 * turns)


def frame(axis: Array) -> tuple[Array, Array]:
    """Return two vectors square to a third, by the formula of Duff and others."""
    x, y, z = axis
    sign = Long(1 if z >= 0 else -1)
    a = -1 / (sign + z)
    b = x * y * a
    return (
        np.array([1 + sign * x * x * a, sign * b, -sign * x]),
        np.array([b, sign + y * y * a, -y]),
    )


def sphere_lengths(
    way: Array, radius: Any, ways: Array, is_far: bool, reach: Any, turn: Any
) -> tuple[Array, Array]:
    """Return how far it is to the near side of a sphere, or to the far one, and errors, (rays,)."""
    middle = dot(ways, way)
    beside = way - middle[:, None] * ways
    half = np.sqrt(np.maximum(radius * radius - dot(beside, beside), 0))
    # Near the outline, a root makes much of rounding.
    error = reach + turn * np.sqrt(dot(way, way))
    error = error + np.fmin(2 * radius * error / half, np.sqrt(2 * radius * error) + error)
    return middle + half if is_far else middle - half, error


def _stops(
    start: Any,
    end: Array,
    crosses: Array,
    middle: Array,
    lengths: Array,
    reach: Any,
    end_reach: Any,
) -> Array:
    """Tell which rays a closed surface stops.

    An end that rounding may have moved across the surface is on it: then only where the ray crosses
    the surface elsewhere it is stopped.

    Parameters
    ----------
    start, end
        How far outside the rays start and end, below 0 inside.
    crosses, middle
        Whether their lines cross the surface, and how far it is to half the way within.
    lengths
        How long they are.
    reach, end_reach
        How far rounding may have moved where they start and end.
    """
    ahead = crosses & (middle > 0)
    enters = ahead & ((end < -end_reach) | (middle < lengths))
    leaves = (end > end_reach) & ((start < -reach) | ahead)
    return np.where(start > reach, enters, leaves)
