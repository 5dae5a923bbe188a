"""The rays of a pixel in words: what ``vtray --pixel`` prints."""

from collections.abc import Sequence
from typing import Any

from vtray.figures.traced_rays import Exposed, Hit, ShadowRay, Surface, TracedRays
from vtray.scene.scene import Scene

WHITE = (255.0, 255.0, 255.0)


def describe(tree: TracedRays) -> str:
    """Return how a pixel got its value, as text of some lines."""
    (column, row), (width, height) = tree.pixel, tree.view.size
    lines = [
        f"pixel        column {column}, row {row} of {width} x {height}",
        f"ray          from {_vector(tree.origin)} towards {_vector(tree.direction)}",
    ]
    if tree.hit is None:
        lines.append("hit          nothing in front of the image plane")
    else:
        lines += _describe_hit(tree.hit, tree.scene)
        for ray in tree.lights:
            lines += _describe_light(ray, tree.hit)
    which = "the points" if tree.left_out else "all lights"
    lines.append(f"light        {_vector(tree.light)}, the sum over {which}")
    if tree.left_out:
        lines.append(f"not shown    {_lights(tree.left_out)}: only points are shown ray by ray")
    if tree.exposed is not None:
        lines += _describe_exposure(tree.exposed, tree)
    return "\n".join(lines)


def _describe_hit(hit: Hit, scene: Scene) -> list[str]:
    """Return the lines on what the ray hit."""
    red, green, blue = hit.surface.color
    return [
        f"hit          {hit.surface}, {hit.distance:.10g} away",
        *_describe_copy(hit.surface, scene),
        f"  point      {_vector(hit.point)}",
        f"  normal     {_vector(hit.normal)}, on the ray's side",
        f"  material   color ({red:g}, {green:g}, {blue:g}), lambert {hit.surface.lambert:g}",
    ]


def _describe_copy(surface: Surface, scene: Scene) -> list[str]:
    """Return the line on where a copy stands, none for what is not copied."""
    item: Any = scene.objects[surface.object]
    return (
        [] if surface.copy is None else [f"  copy       moved by {_vector(item.at[surface.copy])}"]
    )


def _describe_light(ray: ShadowRay, hit: Hit) -> list[str]:
    """Return the lines on a light: its direction, what blocks it or what it adds."""
    name = f"lights[{ray.light}]"
    first = f"{name:12} towards {_vector(ray.direction)}, {ray.distance:.10g} away"
    if ray.cosine == 0.0:
        return [first, "  adds       nothing: it is behind the surface"]
    if ray.blocker is not None:
        return [first, f"  adds       nothing: {ray.blocker}, is in the way"]
    factors = f"cosine {ray.cosine:.6g} x lambert {hit.surface.lambert:g}"
    factors += f" x intensity {ray.intensity:g} x color"
    if ray.color != WHITE:
        factors += f" x {_vector([channel / 255 for channel in ray.color])} of the light"
    return [first, f"  adds       {_vector(ray.adds)} = {factors}"]


def _describe_exposure(exposed: Exposed, tree: TracedRays) -> list[str]:
    """Return the lines on the value before and after exposure."""
    lines = []
    if tree.left_out:
        lines.append(
            f"all lights   {_vector(exposed.light)}, the light of the pixel in the picture"
        )
    elif exposed.light != tree.light:
        lines.append(f"samples      {_vector(exposed.light)}, the mean of all rays of the pixel")
    what = "the brightest channel of the picture" if exposed.brightest else "what becomes 255"
    white = f"{exposed.white:.10g}"
    formula = f"floor(255 x light / {white}), {white} is {what}"
    lines.append(f"exposure     {formula if exposed.white > 0.0 else 'the whole picture is black'}")
    behind = f", {100 * exposed.background:.3g} % of it background" if exposed.background else ""
    lines.append(f"value        ({', '.join(map(str, exposed.value))}){behind}")
    return lines


def _lights(count: int) -> str:
    """Return a number of lights in words."""
    return "1 light" if count == 1 else f"{count} lights"


def _vector(vector: Sequence[float]) -> str:
    """Return a vector as people read it."""
    return "(" + ", ".join(f"{part + 0.0:.6g}" for part in vector) + ")"
