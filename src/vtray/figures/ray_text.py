"""The rays of a pixel in words: what ``vtray --pixel`` prints."""

from vtray.figures.hit_text import (
    NO_HIT,
    describe_hit,
    describe_lamp,
    describe_lights,
    vector_text,
)
from vtray.figures.path_text import describe_path
from vtray.figures.traced_rays import Exposed, Layer, TracedRays, Veil
from vtray.scene.colors.tone_map_names import is_encoded
from vtray.scene.scene import Scene


def describe(tree: TracedRays) -> str:
    """Return how a pixel got its value, as text of some lines."""
    (column, row), (width, height) = tree.pixel, tree.view.size
    which = "" if tree.sample is None else f", sample {tree.sample}"
    lines = [
        f"pixel        column {column}, row {row} of {width} x {height}{which}",
        f"ray          from {vector_text(tree.origin)} towards {vector_text(tree.direction)}",
    ]
    lines += describe_path(tree) if tree.path else _describe_direct(tree)
    if tree.veil is not None:
        lines.append(_describe_veil(tree.veil))
    if tree.exposed is not None:
        lines += _describe_exposure(tree.exposed, tree)
    return "\n".join(lines)


def _describe_direct(tree: TracedRays) -> list[str]:
    """Return the lines on a ray from whose hit none goes on, and on its light."""
    lines = []
    for layer in tree.layers:
        lines += _describe_layer(layer, tree.scene)
    if tree.layers:
        passed = "all layers" if tree.veil is None else "all layers and fog"
        lines.append(f"behind       {100 * tree.share:.4g} % of the light passes {passed}")
    if tree.lamp is not None:
        lines.append(describe_lamp(tree.scene.lights[tree.lamp], tree.lamp))
    elif tree.hit is None:
        lines.append(NO_HIT)
    else:
        lines += describe_hit(tree.hit, tree.scene)
        seen = tree.share, tree.share, tree.share
        lines += describe_lights(tree.lights, tree.hit, seen, tree.scene)
    of = "the sum over all lights" if tree.lamp is None else "that of the lamp"
    of = "the sum over all layers and lights" if tree.layers else of
    return [*lines, f"light        {vector_text(tree.light)}, {of}"]


def _describe_layer(layer: Layer, scene: Scene) -> list[str]:
    """Return the lines on a layer."""
    first, *others = describe_hit(layer.hit, scene)
    through = f", through {100 * layer.fog:.4g} % fog" if layer.fog else ""
    return [
        first.replace("hit  ", "layer", 1),
        *others,
        f"  seen       {100 * layer.share:.4g} % of its light{through}",
        *describe_lights(layer.lights, layer.hit, 3 * (layer.share,), scene),
    ]


def _describe_veil(veil: Veil) -> str:
    """Return the line on fog."""
    share = f"{100 * veil.share:.4g} % of what is seen {veil.distance:.10g} away"
    if veil.is_counted:
        return f"fog          {share}, which is left out above"
    return f"fog          {share}, which leaves {vector_text(veil.light)}"


def _describe_exposure(exposed: Exposed, tree: TracedRays) -> list[str]:
    """Return the lines on the value before and after exposure."""
    lines, share = [], f"{100 * exposed.background:.3g}"
    shine = exposed.stars or (0.0, 0.0, 0.0)
    left = tree.light if tree.veil is None else tree.veil.light
    if exposed.light != tuple(one + two for one, two in zip(left, shine, strict=True)):
        traced = [one - two for one, two in zip(exposed.light, shine, strict=True)]
        lines.append(f"samples      {vector_text(traced)}, the mean of all rays of the pixel")
    if exposed.stars is not None:
        lines.append(f"stars        {vector_text(shine)}, added to that")
    if exposed.drawn is not None:
        lines.append(f"drawn        {vector_text(exposed.drawn)}, what lines and shade leave of it")
    if exposed.sky is not None:
        lines.append(f"sky          {vector_text(exposed.sky)}, seen in {share} % of the pixel")
    what = "the brightest channel of the picture" if exposed.brightest else "what becomes 255"
    white = f"{exposed.white:.10g}"
    more = "".join(f" + {vector_text(overlay)}" for overlay in exposed.overlays)
    formula = f"floor(255 x light / {white}{more}), {white} is {what}"
    if is_encoded(exposed.tonemap):
        behind = f", with {more[3:]} of their own colours" if more else ""
        formula = f'tone map "{exposed.tonemap}" of light / {white}{behind}, {white} is {what}'
    lines.append(f"exposure     {formula if exposed.white > 0.0 else 'the whole picture is black'}")
    is_color = exposed.background and exposed.sky is None
    behind = f", {share} % of it background" if is_color else ""
    lines.append(f"value        ({', '.join(map(str, exposed.value))}){behind}")
    return lines
