"""A hit of a ray in words, and the ways from there to all lights."""

from collections.abc import Sequence
from typing import Any

from vtray.figures.traced_rays import Hit, ShadowFan, Surface, WayToLight
from vtray.geometry.vector import Vec
from vtray.scene.colors.color_light import as_light
from vtray.scene.colors.tone_map_names import is_encoded
from vtray.scene.light_types import AnyLight, measure_of, strength_of
from vtray.scene.materials import Blend, Material, blended_in
from vtray.scene.scene import Scene

NO_HIT = "hit          nothing in front of the image plane"

WHITE = (255.0, 255.0, 255.0)


def describe_hit(hit: Hit, scene: Scene, material: Material | None = None) -> list[str]:
    """Return the lines on what the ray hit; `material` is what it is made of if it is not matt."""
    made = f"color {_color_text(hit, scene)}"
    made += f", lambert {hit.surface.lambert:g}" if material is None else f", {_words(material)}"
    return [
        f"hit          {hit.surface}, {hit.distance:.10g} away",
        *_describe_copy(hit.surface, scene),
        f"  point      {vector_text(hit.point)}",
        f"  normal     {vector_text(hit.normal)}, on the ray's side",
        f"  material   {made}",
    ]


def _words(material: Material) -> str:
    """Return the name of a material, and its numbers that are not 0."""
    if isinstance(material, Blend):
        first, second = (_words(one) for one in blended_in(material))
        return f"{first} blended with {material.weight:g} of {second}"
    words = str(type(material).__struct_config__.tag)
    for name in material.__struct_fields__:
        value = getattr(material, name)
        if name == "name" and value is not None:
            words = f"{words} {value}"
        elif isinstance(value, tuple) and any(value):
            words += f", {name} {vector_text(value)}"
        elif isinstance(value, bool) or not isinstance(value, float):
            words += f", {name}" if value is True else ""
        elif value:
            words += f", {name} {value:g}"
    return words


def describe_lamp(light: AnyLight, number: int) -> str:
    """Return the line on a lamp that is seen."""
    kind = str(type(light).__struct_config__.tag)
    return f"lamp         lights[{number}], a {kind} of {measure_of(light)} {strength_of(light):g}"


def describe_lights(
    ways: Sequence[WayToLight], hit: Hit, seen: Vec | None, scene: Scene
) -> list[str]:
    """Return the lines on all lights at a hit.

    Parameters
    ----------
    ways, hit, scene
        The ways to the lights, from what, of which scene.
    seen
        How much is seen of the hit, for red, green and blue; None where a coat shows of each light
        something else.
    """
    told = [way for way in ways if not _is_idle(way)]
    lines = [line for way in told for line in _describe_light(way, hit, seen, scene)]
    if len(told) < len(ways):
        lines.append(_describe_others(len(ways) - len(told), bool(told)))
    return lines


def _describe_light(way: WayToLight, hit: Hit, seen: Vec | None, scene: Scene) -> list[str]:
    """Return the lines on a light: its direction, what blocks it or what it adds."""
    name = f"lights[{way.light}]"
    if isinstance(way, ShadowFan):
        first = f"{name:12} {way.kind}: {way.outcome}"
        shown = f"{way.share:.6g}" if way.shares is None else vector_text(way.shares)
        first += f", {shown} of its light"
        factor, strength = "share", way.measure
        amount = shown
    else:
        first = f"{name:12} towards {vector_text(way.direction)}, {way.distance:.10g} away"
        factor, strength, amount = "cosine", "intensity", f"{way.cosine:.6g}"
    if not way.arrives:
        return [first, f"  adds       nothing: {_obstacle(way)}"]
    if seen is None:
        return [
            first,
            f"  adds       {vector_text(way.adds)}, as the coat shows {strength} {way.intensity:g}",
        ]
    factors = f"{factor} {amount} x lambert {hit.surface.lambert:g}"
    factors += f" x {strength} {way.intensity:g} x color"
    if way.color != WHITE:
        tint = [channel / 255 for channel in as_light(way.color, scene.render.tonemap)]
        factors += f" x {vector_text(tint)} of the light"
    if share_text(seen) != "1":
        factors += f" x {share_text(seen)} that is seen"
    return [first, f"  adds       {vector_text(way.adds)} = {factors}"]


def _describe_copy(surface: Surface, scene: Scene) -> list[str]:
    """Return the line on where a copy stands, none for what is not copied."""
    item: Any = scene.objects[surface.object]
    return (
        []
        if surface.copy is None
        else [f"  copy       moved by {vector_text(item.at[surface.copy])}"]
    )


def _color_text(hit: Hit, scene: Scene) -> str:
    """Return the colour of a hit, where it comes from, and as light if that is something else."""
    color, tonemap = hit.surface.color, scene.render.tonemap
    words = "(" + ", ".join(f"{channel:g}" for channel in color) + ")"
    if hit.pattern is not None:
        words += f" of its {hit.pattern.__struct_config__.tag}"
    if is_encoded(tonemap):
        words += f", as light {vector_text(as_light(color, tonemap))}"
    return words


def _is_idle(way: WayToLight) -> bool:
    """Tell whether a light adds nothing, and has none of the rays that many lights share."""
    return isinstance(way, ShadowFan) and not way.rays and not way.arrives


def _describe_others(count: int, are_others: bool) -> str:
    """Return the line on lights that have no rays."""
    which = f"{count} other" if are_others else f"{count}"
    noun = "light" if count == 1 else "lights"
    return (
        f"lights       {which} {noun} have no ray of those that all share: they are hidden or weak"
    )


def _obstacle(way: WayToLight) -> str:
    """Return why nothing of a light arrives."""
    if way.is_behind:
        return "it is behind the surface"
    blockers = way.blockers
    if len(blockers) == 1:
        return f"{blockers[0]}, is in the way"
    return f"{len(blockers)} surfaces are in the way"


def share_text(share: Vec) -> str:
    """Return a share of red, green and blue, as one number where they look alike."""
    red, green, blue = (f"{part:.6g}" for part in share)
    return red if red == green == blue else vector_text(share)


def vector_text(vector: Sequence[float]) -> str:
    """Return a vector as people read it."""
    return "(" + ", ".join(f"{part + 0.0:.6g}" for part in vector) + ")"
