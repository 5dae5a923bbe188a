"""Pictures with cylinders beside those of the oracle, as far as rounding allows."""

from typing import Any

import numpy as np
import oracle
from oracle import ROUNDING

import vtray

Scene = dict[str, Any]


def load(document: Scene) -> vtray.Scene:
    """Return a scene; a cylinder may have a `color_end`, as only those of arrays have."""
    plain = [_without_ends(item) for item in document["objects"]]
    scene = vtray.load_dict({**document, "objects": plain})
    pairs = zip(scene.objects, document["objects"], strict=True)
    scene.objects = [_with_ends(found, item) for found, item in pairs]
    return scene


def _without_ends(item: Scene) -> Scene:
    """Return an object as a file may hold it."""
    plain = {key: value for key, value in item.items() if key != "color_end"}
    if item["type"] == "copies":
        plain["objects"] = [_without_ends(part) for part in item["objects"]]
    return plain


def _with_ends(found: Any, item: Scene) -> Any:
    """Return an object that was read, with two colours where it has."""
    if item["type"] == "copies":
        pairs = zip(found.objects, item["objects"], strict=True)
        return found.replace(objects=[_with_ends(part, inner) for part, inner in pairs])
    if "color_end" not in item:
        return found
    start, end = ([[item[name][c] for c in "xyz"]] for name in ("start", "end"))
    color, color_end = ([item[name][c] for c in "rgb"] for name in ("color", "color_end"))
    if item["type"] == "cone":
        radii = item["radius"], item["radius_end"]
        return vtray.Cones(start, end, *radii, color, item["lambert"], color_end)
    return vtray.Cylinders(start, end, item["radius"], color, item["lambert"], color_end)


def assert_near_oracle(document: Scene, image: vtray.Image) -> float:
    """Compare a picture with the oracle's; return the share of pixels that are in doubt.

    What shows no cylinder must be the same to the last bit.
    """
    seen, doubt = oracle.look(document), oracle.doubt(document)
    kinds = np.array([*(item["type"] in oracle.AXIAL for item in document["objects"]), False])
    places = image.ids[..., 0]
    is_sure = ~doubt
    np.testing.assert_array_equal(places[is_sure], seen.ids[is_sure])
    others = is_sure & ~kinds[seen.ids]
    np.testing.assert_array_equal(image.linear[others], seen.linear[others])
    np.testing.assert_array_equal(image.depth[others], seen.depth[others])
    np.testing.assert_array_equal(image.normals[others], seen.normals[others])
    for k in np.flatnonzero(kinds):
        mine = is_sure & (seen.ids == k)
        if mine.any():
            _compare(document, image, seen, mine, k)
    return float(doubt.mean())


def _compare(document: Scene, image: vtray.Image, seen: Any, mine: np.ndarray, number: int) -> None:
    """Compare the pixels that show a cylinder."""
    item = document["objects"][number]
    rows, columns = np.nonzero(mine)
    render = oracle._Render(document, np.float64)
    starts, rays = render.rays(columns.astype(float), rows.astype(float))
    depth, normals = seen.depth[mine], seen.normals[mine]
    error = ROUNDING * (render.magnitude(item) + render.extent + render.focus + depth)
    # A ray that meets the surface at a small angle carries errors far along it; at an outline, no
    # farther than half the way through what is that deep inside.
    is_round = seen.parts[mine] % 3 == 0
    places = starts + (depth - (render.eye_distance - render.focus))[:, None] * rays
    shape = render.cylinders[render.order.index(number)]
    axis = shape.frame[2].astype(float)
    is_cone = item["type"] == "cone"
    radius: Any = float(item["radius"])
    if is_cone:
        radius = np.where(is_round, np.maximum(shape.bend(places).astype(float), error), np.inf)
    steepness = 1.0 if is_cone else np.sqrt(np.square(np.cross(rays, axis)).sum(axis=-1))
    angle = np.abs(oracle.dot(rays, normals))
    along = error / np.maximum(angle, np.sqrt(error / radius) * steepness)
    assert (np.abs(image.depth[mine] - depth) <= along).all()
    turn = np.where(is_round, along / radius, 0) + 1e-14
    off = np.abs(image.normals[mine] - normals).max(axis=-1)
    assert (off <= turn).all()
    margin = np.zeros(len(rows))
    for light in document["lights"]:
        way = render.place(light["location"]) - places
        away = np.maximum(np.sqrt(oracle.dot(way, way)), 1e-300)
        reach = render.light_reach(render.place(light["location"]), render.magnitude(item))
        share = np.minimum(2 * turn + 2 * (along + reach + error) / away, 1)
        margin += share * item["lambert"] * light["intensity"] * 255
    assert (np.abs(image.linear[mine] - seen.linear[mine]).max(axis=-1) <= margin).all()
