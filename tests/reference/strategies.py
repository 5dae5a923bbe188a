"""Random scenes, as decoded JSON."""

import math
from random import Random
from typing import Any

import pytest
from hypothesis import strategies as st

Scene = dict[str, Any]

may_be_dark = pytest.mark.filterwarnings("ignore:lights")
"""For tests that render random scenes, of which some have no light."""


def _xyz(x: float, y: float, z: float) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def _coordinates(size: float) -> st.SearchStrategy[float]:
    """Coordinates up to a size, often round ones so that things touch, coincide and line up."""
    steps = st.integers(-8, 8).map(lambda k: k * size / 8)
    return steps | st.floats(-size, size, allow_subnormal=False)


def places(size: float) -> st.SearchStrategy[dict[str, float]]:
    """Points in a cube."""
    return st.builds(_xyz, *[_coordinates(size)] * 3)


def directions() -> st.SearchStrategy[dict[str, float]]:
    """Vectors of any length but zero; often along an axis, or nearly opposite to (0, 0, 1)."""
    near_back = st.floats(1e-12, 1e-3).map(lambda x: _xyz(x, -x / 3, -1.0))
    axis = st.sampled_from([_xyz(*v) for v in ((0, 0, 1), (0, 0, -1), (0, -1, 0), (3, 0, 0))])
    any_way = places(2.0).filter(lambda v: math.hypot(*v.values()) > 1e-9)
    return axis | any_way | near_back


def colors() -> st.SearchStrategy[dict[str, int]]:
    """Colours."""
    return st.fixed_dictionaries({c: st.integers(0, 255) for c in "rgb"})


@st.composite
def scenes(draw: st.DrawFn, most_objects: int = 8) -> Scene:
    """Scenes of all sizes, from 1e-6 to 1e9."""
    size = draw(st.sampled_from([1.0, 1.0, 1.0, 1e-6, 1e3, 1e9]))
    focus = size * draw(st.sampled_from([0.01, 0.5, 2.0, 100.0, 1e8]))
    width, height = draw(st.integers(1, 24)), draw(st.integers(1, 24))
    view = size * draw(st.sampled_from([0.2, 1.0, 3.0]))
    material = {"color": colors(), "lambert": st.floats(0, 1)}
    radii = st.sampled_from([0.0, 1e-6, 0.1, 0.25, 0.5, 1.0, 3.0, 1e4]).map(lambda r: r * size)
    sphere = st.fixed_dictionaries(
        {"type": st.just("sphere"), "center": places(size), "radius": radii, **material}
    )
    plane = st.fixed_dictionaries(
        {"type": st.just("plane"), "center": places(size), "normal": directions(), **material}
    )
    light = st.fixed_dictionaries({"location": places(2 * size), "intensity": st.floats(0, 2)})
    objects = draw(st.lists(sphere | sphere | plane, max_size=most_objects))
    lights = draw(st.lists(light, max_size=4))
    center = draw(places(size / 2))
    if objects and draw(st.booleans()):
        first = objects[0]
        beside = first.get("radius", 0.0) * draw(st.sampled_from([0.0, 0.5, 1.0]))
        location = dict(first["center"], x=first["center"]["x"] + beside)
        lights.append({"location": location, "intensity": 1.0})  # inside, or on the surface
        objects.append({**draw(st.sampled_from(objects)), **draw(st.fixed_dictionaries(material))})
    if objects and draw(st.booleans()):
        center = objects[-1]["center"]  # the image plane cuts an object in half
    camera = {
        "center": center,
        "normal": draw(directions()),
        "focus": focus,
        "size": [width, height],
        "resolution": [view / width, view / height],
    }
    return {"camera": camera | draw(views(camera)), "lights": lights, "objects": objects}


@st.composite
def cylinder_scenes(draw: st.DrawFn) -> Scene:
    """Scenes as those of `scenes`, with cylinders that often touch, coincide, or hold a light."""
    scene = draw(scenes(most_objects=4))
    camera, objects, lights = scene["camera"], scene["objects"], scene["lights"]
    size = max(abs(n) for n in (*camera["center"].values(), camera["resolution"][0])) or 1.0
    sizes = [item["center"] for item in objects] + [item["location"] for item in lights]
    size = max([size, *(abs(n) for place in sizes for n in place.values())])
    radii = st.sampled_from([0.0, 1e-6, 0.1, 0.25, 0.5, 1.0, 1e4]).map(lambda r: r * size)
    material = {"color": colors(), "lambert": st.floats(0, 1)}
    cylinder = st.fixed_dictionaries(
        {
            "type": st.just("cylinder"),
            "start": places(size),
            "end": places(size),
            "radius": radii,
            **material,
        },
        optional={"color_end": colors()},
    )
    found = draw(st.lists(cylinder, min_size=1, max_size=4))
    first = found[0]
    if draw(st.booleans()):
        found.append({**first, **draw(st.fixed_dictionaries(material))})
    share = draw(st.sampled_from([0.0, 0.25, 1.0]))
    between = {a: (1 - share) * first["start"][a] + share * first["end"][a] for a in "xyz"}
    if draw(st.booleans()):
        lights.append({"location": between, "intensity": 1.0})  # within, or on a cap
    elif draw(st.booleans()):
        camera["center"] = between  # the image plane cuts it
    return {**scene, "objects": draw(st.permutations([*objects, *found]))}


@st.composite
def copied_scenes(draw: st.DrawFn) -> Scene:
    """Scenes as those of the others, in which copies take the place of some objects."""
    scene = draw(scenes(most_objects=4) | cylinder_scenes())
    size = max(abs(n) for n in (*scene["camera"]["center"].values(), 1e-6))
    parts = [item for item in scene["objects"] if item["type"] != "plane"]
    chosen = [item for item in parts if draw(st.booleans())] or parts[:1]
    if not chosen:
        return scene
    others = [item for item in scene["objects"] if not any(item is part for part in chosen)]
    at = draw(st.lists(places(draw(st.sampled_from([0.1, 1.0, 4.0])) * size), max_size=4))
    copies = {"type": "copies", "objects": chosen, "at": at}
    return {**scene, "objects": draw(st.permutations([*others, copies]))}


def views(camera: dict[str, Any]) -> st.SearchStrategy[dict[str, Any]]:
    """Return optional keys of a camera, often none."""
    ways = {"up": directions().filter(lambda up: not _near_parallel(up, camera["normal"]))}
    kinds = {"projection": st.sampled_from(["perspective", "orthographic", "orthographic"])}
    return st.just({}) | st.fixed_dictionaries({}, optional=ways | kinds)


def _near_parallel(one: dict[str, float], two: dict[str, float]) -> bool:
    a, b = list(one.values()), list(two.values())
    cross = [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]
    return math.hypot(*cross) <= 1e-6 * math.hypot(*a) * math.hypot(*b)


def crowd(seed: int, spheres: int = 200, **camera: Any) -> Scene:
    """Return a scene of many spheres in view, some planes, and lights all around."""
    random = Random(seed)

    def place(size: float) -> dict[str, float]:
        return _xyz(*(random.uniform(-size, size) for _ in range(3)))

    def material() -> dict[str, Any]:
        color = {c: random.randrange(256) for c in "rgb"}
        return {"color": color, "lambert": random.uniform(0.2, 1)}

    scale = 10.0 ** random.randint(-6, 9)
    largest = random.choice([0.02, 0.1, 0.4]) * scale
    return {
        "camera": {
            "center": place(scale),
            "normal": place(1.0),
            # The last is nearly a parallel projection: rays of a block differ in their last digits.
            "focus": random.choice([0.3, 2.0, 1e9]) * scale,
            "size": [51, 35],
            "resolution": [0.02 * scale, 0.03 * scale],
            **camera,
        },
        "lights": [
            {"location": place(random.choice([3, 3, 1e10]) * scale), "intensity": random.random()}
            for _ in range(random.randint(1, 6))
        ],
        "objects": [
            {"type": "sphere", "center": place(2 * scale), "radius": random.uniform(0, largest)}
            | material()
            for _ in range(spheres)
        ]
        + [
            {"type": "plane", "center": place(2 * scale), "normal": place(1.0)} | material()
            for _ in range(random.randint(0, 4))
        ],
    }


def thicket(seed: int, cylinders: int = 30, by: float = 0.0, **camera: Any) -> Scene:
    """Return a scene of cylinders of two colours, spheres and a plane, moved as a whole."""
    random = Random(seed)

    def place(size: float) -> list[float]:
        return [random.uniform(-size, size) for _ in range(3)]

    def material(*names: str) -> dict[str, Any]:
        colors = {name: {c: random.randrange(256) for c in "rgb"} for name in names}
        return {**colors, "lambert": random.uniform(0.2, 1)}

    def moved(point: list[float]) -> dict[str, float]:
        return _xyz(*(p + by for p in point))

    objects: list[Scene] = []
    for _ in range(cylinders):
        start, way = place(3), place(random.choice([0.1, 1.0, 4.0]))
        end = [p + w for p, w in zip(start, way, strict=True)]
        radius = random.choice([0.02, 0.2, 0.6])
        objects.append(
            {"type": "cylinder", "start": moved(start), "end": moved(end), "radius": radius}
            | material("color", *random.choice([[], ["color_end"]]))
        )
        if random.random() < 0.3:  # a ball at its end
            objects.append({"type": "sphere", "center": moved(end), "radius": radius * 1.5})
            objects[-1] |= material("color")
    wall = {"type": "plane", "center": moved([0, 4, 0]), "normal": _xyz(*place(1.0))}
    return {
        "camera": {
            "center": moved([0, 0, -2]),
            "normal": _xyz(0.1 * random.random(), 0.05, 1),
            "focus": 4.0,
            "size": [28, 21],
            "resolution": [0.18, 0.18],
            **camera,
        },
        "lights": [{"location": moved(place(8)), "intensity": random.random()} for _ in range(3)],
        "objects": [*objects, wall | material("color")],
    }
