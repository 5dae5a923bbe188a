"""The rays of a path over surfaces in words, bounce by bounce: a part of ``vtray --pixel``."""

import math

from vtray.figures.hit_text import (
    NO_HIT,
    describe_hit,
    describe_lamp,
    describe_lights,
    share_text,
    vector_text,
)
from vtray.figures.traced_rays import Choice, Hit, PathRay, TracedRays
from vtray.scene.materials import Emissive, Lambert
from vtray.scene.scene import Scene

WHOLE = (1.0, 1.0, 1.0)


def describe_path(tree: TracedRays) -> list[str]:
    """Return the lines on all rays over surfaces, and on the light that they bring."""
    lines, parents = [], {ray.parent for ray in tree.path}
    for number, ray in enumerate(tree.path):
        if ray.parent is not None:
            lines += _describe_start(number, ray)
        if ray.passes != WHOLE:
            lines.append(f"  glass      leaves {share_text(ray.passes)} of that on the way")
        lines += _describe_met(ray, tree)
        if ray.hit is not None:
            lines += _describe_surface(ray, ray.hit, tree.scene)
            lines += _describe_onward(ray, tree, goes_on=number in parents)
    return [*lines, _describe_sum(tree)]


def _describe_start(number: int, ray: PathRay) -> list[str]:
    """Return the lines on a ray that goes on from a surface."""
    name = f"ray {number}"
    before = f"ray {ray.parent}" if ray.parent else "the first ray"
    return [
        f"{name:12} {ray.how} where {before} hits, towards {vector_text(ray.direction)}",
        f"  seen       {share_text(ray.seen)} of its light",
    ]


def _describe_met(ray: PathRay, tree: TracedRays) -> list[str]:
    """Return the lines on what a ray meets that is no surface, and the light of that."""
    lines = []
    if ray.lamp is not None:
        lines.append(describe_lamp(tree.scene.lights[ray.lamp], ray.lamp))
    elif ray.hit is None and ray.distance < math.inf:
        lines.append(f"hit          a surface {ray.distance:.10g} away, too late to be lit")
    elif ray.hit is None:
        lines.append(NO_HIT if ray.parent is None else "hit          nothing")
    if ray.parent is not None and max(ray.met) > 0.0:
        of = tree.path[ray.parent]
        is_weighed = of.shown is None and of.choice is not None and of.choice.density is not None
        what = "of skies and suns" if ray.lamp is None else "of the lamp"
        what = "of lamps, skies and suns, weighed against shadow rays" if is_weighed else what
        lines.append(f"  adds       {vector_text(ray.met)} {what}")
    return lines


def _describe_surface(ray: PathRay, hit: Hit, scene: Scene) -> list[str]:
    """Return the lines on a surface, and on the light that it shows."""
    material = None if isinstance(ray.material, Lambert) else ray.material
    lines = describe_hit(hit, scene, material)
    if ray.choice is not None and ray.choice.share < 1.0:
        lines.append(f"  chosen     of two blended materials, with chance {ray.choice.share:.4g}")
    if isinstance(material, Emissive) or max(ray.shines) > 0.0:
        lines.append(f"  adds       {vector_text(ray.shines)} by shining")
    return lines + describe_lights(ray.lights, hit, ray.shown, scene)


def _describe_onward(ray: PathRay, tree: TracedRays, *, goes_on: bool) -> list[str]:
    """Return the line on how a path goes on from a surface, or ends there."""
    if isinstance(ray.material, Emissive):
        return []
    if goes_on:
        return [] if ray.choice is None else [_describe_choice(ray.choice)]
    depth = int(tree.scene.render.depth)
    if _surfaces_before(ray, tree) >= depth:
        bounces = "1 bounce" if depth == 1 else f"{depth} bounces"
        return [f"  ends       after {bounces}, the depth of the picture"]
    if ray.choice is None:
        is_matt = isinstance(ray.material, Lambert)
        return [] if is_matt else ["  ends       as too little would be seen of more"]
    chance = ray.choice.goes_on
    if chance == 0.0:
        return ["  ends       as nothing would be seen of more"]
    return [f"  ends       by chance: it would have gone on with chance {chance:.4g}"]


def _describe_choice(choice: Choice) -> str:
    """Return the line on how a path goes on."""
    text = f"  onward     {choice.how}"
    if choice.chance < 1.0:
        text += f", with chance {choice.chance:.4g}"
    if choice.density is not None:
        text += f", density {choice.density:.4g} per steradian"
    return f"{text}; goes on with chance {choice.goes_on:.4g}" if choice.goes_on < 1.0 else text


def _describe_sum(tree: TracedRays) -> str:
    """Return the line on the light of all rays."""
    peak = max(math.fsum(ray.light[k] for ray in tree.path) for k in range(3))
    firefly = tree.scene.render.firefly
    is_limited = firefly != "off" and peak > 255.0 * firefly and tree.path[0].lamp is None
    limited = f", limited to a brightest channel of {255 * firefly:g}" if is_limited else ""
    return f"light        {vector_text(tree.light)}, the sum over all rays{limited}"


def _surfaces_before(ray: PathRay, tree: TracedRays) -> int:
    """Return how many surfaces are between a ray and the camera."""
    count = 0
    while ray.parent is not None:
        ray, count = tree.path[ray.parent], count + 1
    return count
