"""Skies of many colours by the rules alone: which rays go to them, and what each counts.

Plain, slow, and written on its own in long doubles. Nothing of vtray's lights is imported.
"""

from typing import Any

import numpy as np

Array = np.ndarray
Scene = dict[str, Any]
Long = np.longdouble

PI = 4 * np.arctan(Long(1))
GRADIENT_ROWS = 1025
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
PEAK = 4
CLEAR_DAY = {
    "zenith": {"r": 85, "g": 140, "b": 230},
    "horizon": {"r": 235, "g": 240, "b": 245},
    "ground": {"r": 120, "g": 110, "b": 100},
}


def is_colorful(light: Scene) -> bool:
    """Tell whether a light is a sky whose colour changes."""
    return light.get("gradient") is not None or light.get("image") is not None


class SkyOracle:
    """A sky, given as decoded JSON, its picture as nested lists or an array."""

    def __init__(self, light: Scene, up: Array) -> None:
        image = light.get("image")
        picture = _gradient(light["gradient"]) if image is None else np.asarray(image)
        self.picture = picture.astype(np.float32).astype(Long)
        self.height, self.width, _ = self.picture.shape
        self._turn(light, up)
        brightness = self.picture @ LUMINANCE
        self.edges = PI * np.clip((np.arange(self.height + 2) - Long(0.5)) / self.height, 0, 1)
        self.bands = np.cos(self.edges[:-1]) - np.cos(self.edges[1:])
        self.level = (self.bands @ self._means(brightness)).sum() / (2 * self.width)
        self.counts = np.maximum(brightness - self.level, 0)
        self.is_by_brightness = bool(brightness.max() > PEAK * self.level)

    def _turn(self, light: Scene, up: Array) -> None:
        """Set the axes: ahead to the middle of the picture, to the left of it, and up."""
        if light.get("up") is not None:
            up = np.array([light["up"][axis] for axis in "xyz"], Long)
        self.up = up / np.abs(up).max()
        self.up = self.up / np.sqrt((self.up**2).sum())
        size = np.abs(self.up)
        largest = max(k for k in range(3) if size[k] == size.max())
        ahead = np.eye(3)[(largest + 1) % 3].astype(Long)
        ahead = ahead - (ahead @ self.up) * self.up
        ahead = ahead / np.sqrt((ahead**2).sum())
        left = np.cross(self.up, ahead)
        turn = PI * Long(np.fmod(light.get("rotation", 0.0), 360.0)) / 180
        self.ahead = np.cos(turn) * ahead + np.sin(turn) * left
        self.left = np.cos(turn) * left - np.sin(turn) * ahead

    def _corners(self, values: Array, row: Any, column: Any) -> list[Array]:
        """Return values of a picture at the four nodes around cells."""
        rows = [np.clip(row - 1, 0, self.height - 1), np.clip(row, 0, self.height - 1)]
        columns = [column % self.width, (column + 1) % self.width]
        return [values[r, c] for r in rows for c in columns]

    def _means(self, values: Array) -> Array:
        """Return the means of values over cells, (height + 1, width)."""
        rows, columns = np.indices((self.height + 1, self.width))
        return sum(self._corners(values, rows, columns)) / 4

    def _at(self, values: Array, down: Array, across: Array) -> Array:
        """Return values of a picture, interpolated at places of the map."""
        row, column = np.floor(down).astype(int), np.floor(across).astype(int)
        y, x = down - row, across - column
        a, b, c, d = self._corners(values, row, column)
        if values.ndim == 3:
            x, y = x[:, None], y[:, None]
        return (1 - y) * ((1 - x) * a + x * b) + y * ((1 - x) * c + x * d)

    def _places(self, ways: Array) -> tuple[Array, Array, Array]:
        """Return where directions are on the map, down and across, and the angle from above."""
        left, ahead, height = ways @ self.left, ways @ self.ahead, ways @ self.up
        angle = np.arctan2(np.sqrt(left**2 + ahead**2), height)
        turn = np.mod(np.arctan2(left, -ahead) / (2 * PI), 1)
        across = np.mod(turn * self.width - Long(0.5), self.width)
        return angle / PI * self.height + Long(0.5), across, angle

    def weights(self, ways: Array, normal: Array) -> Array:
        """Return what rays count for red, green and blue, (rays, 3)."""
        down, across, angle = self._places(ways)
        light = self._at(self.picture, down, across)
        if not self.is_by_brightness:
            return light
        row = np.floor(down).astype(int)
        cosine = np.maximum(ways @ normal, 0)
        total = (self.bands @ self._means(self.counts)).sum()
        per_angle = self._at(self.counts, down, across) * self.bands[row] / np.diff(self.edges)[row]
        density = PI * per_angle / total / np.sin(angle) * self.width / (2 * PI)
        factor = np.where(cosine > 0, cosine / (cosine / 2 + density / 2), 0)
        return factor[:, None] * light

    def bright_ways(self, points: Array) -> Array:
        """Return directions to where the sky is bright, for points of the square, (rays, 3)."""
        means = self._means(self.counts)
        rows = np.concatenate([[0], np.cumsum(self.bands * means.sum(axis=1))])
        return np.array([self._bright_way(u, v, means, rows) for u, v in points.astype(Long)])

    def _bright_way(self, u: Any, v: Any, means: Array, rows: Array) -> Array:
        row, y = _pick(rows, v)
        column, x = _pick(np.concatenate([[0], np.cumsum(means[row])]), u)
        a, b, c, d = self._corners(self.counts, row, column)
        y = _bend(y, a + b, c + d)
        x = _bend(x, a + y * (c - a), b + y * (d - b))
        angle = self.edges[row] + y * (self.edges[row + 1] - self.edges[row])
        turn = 2 * PI * (column + x + Long(0.5)) / self.width
        level = -np.cos(turn) * self.ahead + np.sin(turn) * self.left
        return np.sin(angle) * level + np.cos(angle) * self.up


def _pick(sums: Array, u: Any) -> tuple[int, Any]:
    """Return the part in which a share of a sum is, and where in it."""
    target = u * sums[-1]
    part = int(np.searchsorted(sums, target, side="right")) - 1
    return part, (target - sums[part]) / (sums[part + 1] - sums[part])


def _bend(u: Any, first: Any, last: Any) -> Any:
    """Return where the integral of a line from 0 on is a share of the whole one."""
    if first == last:
        return u
    root = np.sqrt(first**2 + u * (last**2 - first**2))
    return (root - first) / (last - first)


def _gradient(colors: Scene) -> Array:
    """Return the picture of a gradient."""
    found = {**CLEAR_DAY, **colors}
    light = {key: np.array([found[key][c] for c in "rgb"], Long) / 255 for key in CLEAR_DAY}
    h = np.cos(PI * (np.arange(GRADIENT_ROWS) + Long(0.5)) / GRADIENT_ROWS)[:, None, None]
    above = light["horizon"] + (light["zenith"] - light["horizon"]) * h * (2 - h)
    below = light["ground"] + (light["horizon"] - light["ground"]) * (1 - np.abs(h)) ** 8
    return np.where(h >= 0, above, below)
