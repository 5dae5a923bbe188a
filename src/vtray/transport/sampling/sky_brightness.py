"""Directions to where a sky is bright.

Its map is filled by a table of rows and one of the cells in each row, and a cell between its four
nodes by the brightness that is interpolated there. So the density is that brightness itself, above
the level of the sky, but for what the width of a row changes within it.

References
----------
Karlík, Šik, Vévoda, Skřivan, Křivánek, "MIS Compensation: Optimizing Sampling Techniques in
Multiple Importance Sampling", ACM Transactions on Graphics 38 (6), 2019 (why only what is brighter
than on average counts).
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec
from vtray.transport.lights.sky import Brightness, Skies, count_of, node_at
from vtray.transport.sampling.sky_map import MapPlace, direction_at
from vtray.transport.sampling.table import find_part, linear_point, part_of


@device
def bright_direction(u: float, v: float, skies: Skies, bright: Brightness, sky: int) -> Vec:
    """Return a direction to where a sky is bright, for a point of the unit square.

    Parameters
    ----------
    u, v
        The point, from 0 to below 1.
    skies, bright, sky
        The sky, one that has a table.
    """
    first, columns, height = bright.first_row[sky], skies.columns[sky], skies.rows[sky]
    target = v * bright.total[sky]
    at = find_part(bright.rows, first, first + height + 1, target)
    row, y = at - first, part_of(bright.rows, at, target)
    begin = bright.first_cell[sky] + row * (columns + 1)
    target = u * bright.cells[begin + columns]
    at = find_part(bright.cells, begin, begin + columns, target)
    column, x = at - begin, part_of(bright.cells, at, target)
    node = node_at(skies, sky, row, column)
    below = node + columns + 1
    a, b = count_of(skies, bright, sky, node), count_of(skies, bright, sky, node + 1)
    c, d = count_of(skies, bright, sky, below), count_of(skies, bright, sky, below + 1)
    y = linear_point(y, a + b, c + d)
    x = linear_point(x, a + y * (c - a), b + y * (d - b))
    # At the top and at the bottom, a half of the cells is beyond the map.
    top, bottom = max(float(row), 0.5), min(row + 1.0, height + 0.5)
    return direction_at(skies, sky, column + x, top + y * (bottom - top))


@device
def bright_density(skies: Skies, bright: Brightness, sky: int, place: MapPlace) -> float:
    """Return the density of `bright_direction` at a place of the map, times pi."""
    columns, height = skies.columns[sky], skies.rows[sky]
    column, row = min(int(place.across), columns - 1), min(int(place.down), height)
    x, y = place.across - column, place.down - row
    node = node_at(skies, sky, row, column)
    below = node + columns + 1
    a, b = count_of(skies, bright, sky, node), count_of(skies, bright, sky, node + 1)
    c, d = count_of(skies, bright, sky, below), count_of(skies, bright, sky, below + 1)
    counts = (1.0 - y) * (a + x * (b - a)) + y * (c + x * (d - c))
    stretch = bright.band[bright.first_row[sky] + row] / max(place.aside, 1e-300)
    density: float = counts * stretch * columns / (2.0 * bright.total[sky])
    return density
