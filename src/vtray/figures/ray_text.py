"""The rays of a pixel in words: what ``vtray --pixel`` prints."""

from collections.abc import Sequence
from typing import Any

from vtray.figures.traced_rays import (
    Exposed,
    Hit,
    Layer,
    ShadowFan,
    Surface,
    TracedRays,
    Veil,
    WayToLight,
)
from vtray.scene.colors.color_light import light_of_numbers
from vtray.scene.colors.tone_map_names import is_encoded
from vtray.scene.light_types import AnyLight, measure_of, strength_of
from vtray.scene.scene import Scene

WHITE = (255.0, 255.0, 255.0)


def describe(tree: TracedRays) -> str:
    """Return how a pixel got its value, as text of some lines."""
    (column, row), (width, height) = tree.pixel, tree.view.size
    lines = [
        f"pixel        column {column}, row {row} of {width} x {height}",
        f"ray          from {_vector(tree.origin)} towards {_vector(tree.direction)}",
    ]
    for layer in tree.layers:
        lines += _describe_layer(layer, tree.scene)
    if tree.layers:
        lines.append(f"behind       {100 * tree.share:.4g} % of the light passes all layers")
    if tree.lamp is not None:
        lines.append(_describe_lamp(tree.scene.lights[tree.lamp], tree.lamp))
    elif tree.hit is None:
        lines.append("hit          nothing in front of the image plane")
    else:
        lines += _describe_hit(tree.hit, tree.scene)
        lines += _describe_lights(tree.lights, tree.hit, tree.share, tree.scene)
    of = "the sum over all lights" if tree.lamp is None else "that of the lamp"
    of = "the sum over all layers and lights" if tree.layers else of
    lines.append(f"light        {_vector(tree.light)}, {of}")
    if tree.veil is not None:
        lines.append(_describe_veil(tree.veil))
    if tree.exposed is not None:
        lines += _describe_exposure(tree.exposed, tree)
    return "\n".join(lines)


def _describe_layer(layer: Layer, scene: Scene) -> list[str]:
    """Return the lines on a layer."""
    first, *others = _describe_hit(layer.hit, scene)
    return [
        first.replace("hit  ", "layer", 1),
        *others,
        f"  seen       {100 * layer.share:.4g} % of its light",
        *_describe_lights(layer.lights, layer.hit, layer.share, scene),
    ]


def _describe_lights(ways: Sequence[WayToLight], hit: Hit, share: float, scene: Scene) -> list[str]:
    """Return the lines on all lights at a hit, of whose light a share is seen."""
    told = [way for way in ways if not _is_idle(way)]
    lines = [line for way in told for line in _describe_light(way, hit, share, scene)]
    if len(told) < len(ways):
        lines.append(_describe_others(len(ways) - len(told), bool(told)))
    return lines


def _describe_lamp(light: AnyLight, number: int) -> str:
    """Return the line on a lamp that is seen."""
    kind = str(type(light).__struct_config__.tag)
    return f"lamp         lights[{number}], a {kind} of {measure_of(light)} {strength_of(light):g}"


def _describe_hit(hit: Hit, scene: Scene) -> list[str]:
    """Return the lines on what the ray hit."""
    return [
        f"hit          {hit.surface}, {hit.distance:.10g} away",
        *_describe_copy(hit.surface, scene),
        f"  point      {_vector(hit.point)}",
        f"  normal     {_vector(hit.normal)}, on the ray's side",
        f"  material   color {_color(hit.surface.color, scene)}, lambert {hit.surface.lambert:g}",
    ]


def _color(color: Sequence[float], scene: Scene) -> str:
    """Return a colour as it was given, and as light if that is something else."""
    shown = "(" + ", ".join(f"{channel:g}" for channel in color) + ")"
    tonemap = scene.render.tonemap
    return f"{shown}, as light {_vector(_as_light(color, scene))}" if is_encoded(tonemap) else shown


def _as_light(color: Sequence[float], scene: Scene) -> list[float]:
    """Return a colour as light, 255 for white."""
    table = light_of_numbers(scene.render.tonemap)
    return [float(table[int(channel)]) for channel in color]


def _describe_copy(surface: Surface, scene: Scene) -> list[str]:
    """Return the line on where a copy stands, none for what is not copied."""
    item: Any = scene.objects[surface.object]
    return (
        [] if surface.copy is None else [f"  copy       moved by {_vector(item.at[surface.copy])}"]
    )


def _describe_light(way: WayToLight, hit: Hit, share: float, scene: Scene) -> list[str]:
    """Return the lines on a light: its direction, what blocks it or what it adds."""
    name = f"lights[{way.light}]"
    if isinstance(way, ShadowFan):
        first = f"{name:12} {way.kind}: {way.outcome}"
        shown = f"{way.share:.6g}" if way.shares is None else _vector(way.shares)
        first += f", {shown} of its light"
        factor, strength = "share", way.measure
        amount = shown
    else:
        first = f"{name:12} towards {_vector(way.direction)}, {way.distance:.10g} away"
        factor, strength, amount = "cosine", "intensity", f"{way.cosine:.6g}"
    if not way.arrives:
        return [first, f"  adds       nothing: {_obstacle(way)}"]
    factors = f"{factor} {amount} x lambert {hit.surface.lambert:g}"
    factors += f" x {strength} {way.intensity:g} x color"
    if way.color != WHITE:
        factors += (
            f" x {_vector([channel / 255 for channel in _as_light(way.color, scene)])} of the light"
        )
    if share < 1.0:
        factors += f" x {share:.6g} that is seen"
    return [first, f"  adds       {_vector(way.adds)} = {factors}"]


def _describe_veil(veil: Veil) -> str:
    """Return the line on fog."""
    share = f"{100 * veil.share:.4g} % of what is seen {veil.distance:.10g} away"
    return f"fog          {share}, which leaves {_vector(veil.light)}"


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


def _describe_exposure(exposed: Exposed, tree: TracedRays) -> list[str]:
    """Return the lines on the value before and after exposure."""
    lines, share = [], f"{100 * exposed.background:.3g}"
    shine = exposed.stars or (0.0, 0.0, 0.0)
    left = tree.light if tree.veil is None else tree.veil.light
    if exposed.light != tuple(one + two for one, two in zip(left, shine, strict=True)):
        traced = [one - two for one, two in zip(exposed.light, shine, strict=True)]
        lines.append(f"samples      {_vector(traced)}, the mean of all rays of the pixel")
    if exposed.stars is not None:
        lines.append(f"stars        {_vector(shine)}, added to that")
    if exposed.drawn is not None:
        lines.append(f"drawn        {_vector(exposed.drawn)}, what lines and shade leave of it")
    if exposed.sky is not None:
        lines.append(f"sky          {_vector(exposed.sky)}, seen in {share} % of the pixel")
    what = "the brightest channel of the picture" if exposed.brightest else "what becomes 255"
    white = f"{exposed.white:.10g}"
    more = "".join(f" + {_vector(overlay)}" for overlay in exposed.overlays)
    formula = f"floor(255 x light / {white}{more}), {white} is {what}"
    if is_encoded(exposed.tonemap):
        behind = f", with {more[3:]} of their own colours" if more else ""
        formula = f'tone map "{exposed.tonemap}" of light / {white}{behind}, {white} is {what}'
    lines.append(f"exposure     {formula if exposed.white > 0.0 else 'the whole picture is black'}")
    is_color = exposed.background and exposed.sky is None
    behind = f", {share} % of it background" if is_color else ""
    lines.append(f"value        ({', '.join(map(str, exposed.value))}){behind}")
    return lines


def _vector(vector: Sequence[float]) -> str:
    """Return a vector as people read it."""
    return "(" + ", ".join(f"{part + 0.0:.6g}" for part in vector) + ")"
