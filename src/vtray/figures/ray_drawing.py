"""The rays of a pixel as a drawing: a cut through the scene along the camera ray."""

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.base.extras import need
from vtray.base.number import integer_of
from vtray.figures.drawn.objects import (
    colored_parts,
    cut_shapes,
    shape_of,
    where_met,
)
from vtray.figures.fan_lines import DOME, FanLines, fan_lines, is_around, lamp_shape
from vtray.figures.path_drawing import draw_path
from vtray.figures.pen import BLOCKED, FAINT, INK, LIT, RAY
from vtray.figures.scale_bar import is_orthographic, round_length
from vtray.figures.section import Section, choose_section
from vtray.figures.stage import SUN, Stage
from vtray.figures.traced_rays import ShadowFan, ShadowRay, Surface, TracedRays, WayToLight
from vtray.geometry.vector import Vec
from vtray.scene.checks.scene_words import show
from vtray.scene.scene import Plane

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

MOST_LABELS = 4
"""With more lights, only the main one has a label, and the rest are thin."""

NEAR = 0.02
"""An image plane nearer to the eye than this share of the drawing is not drawn."""

WHOLE = 0.97
"""Outlines are not drawn of what the drawing cuts through in so much of their width."""

NORMAL = 0.13
"""How long a normal is drawn, as a share of the drawing."""

MOST_BLOCKERS = 3
"""Of so many surfaces that stop rays of a fan, outlines are drawn."""


def draw(tree: TracedRays, ax: "Axes | None", light: int | None) -> "Axes":
    """Draw the rays of a pixel; see `RayTree.draw`."""
    need("matplotlib", "figure", "RayTree.draw")
    way = _main_way(tree, light)
    if ax is None:
        from vtray.figures.shown_figure import ShownFigure

        ax = ShownFigure.new(8, 5.5, dpi=150).add_axes((0.02, 0.08, 0.96, 0.82))
    is_path = light is None and len(tree.path) > 1
    along = tree.path[1].direction if is_path else None if way is None else way.direction
    drawing = _Drawing(tree, choose_section(tree, along), ax)
    drawing.frame()
    drawing.surroundings()
    drawing.camera()
    if tree.hit is None:
        drawing.miss()
    else:
        drawing.surface(tree.hit.surface, filled=True)
        few = len(tree.lights) <= MOST_LABELS
        for other in tree.lights:
            thin = not few and other is not way
            if isinstance(other, ShadowFan):
                drawing.shadow_fan(other, thin=thin, main=other is way)
            else:
                drawing.shadow_ray(other, thin=thin)
        drawing.hit()
        draw_path(drawing, drawing.once)
    drawing.captions(way, is_path=is_path)
    return ax


def _main_way(tree: TracedRays, light: int | None) -> WayToLight | None:
    """Return the way to a light that lies in the plane of the drawing."""
    if light is not None:
        place = integer_of(light)
        for way in tree.lights:
            if way.light == place:
                return way
        lights = f"the {len(tree.lights)} lights of the hit"
        message = f"light: expected one of {lights}, got {show(light)}"
        raise RenderError(message)
    # The one that adds most; if none does, one that something blocks.
    return max(tree.lights, key=lambda way: (sum(way.adds), bool(way.blockers)), default=None)


class _Drawing(Stage):
    """A drawing of rays while it is made."""

    def __init__(self, tree: TracedRays, section: Section, ax: "Axes") -> None:
        super().__init__(tree, section, ax)
        self.labels: list[Floats] = []
        self.drawn: set[str] = set()  # names, as colours differ on one surface

    def surroundings(self) -> None:
        """Draw what the plane of the drawing cuts, apart from what rays meet."""
        from matplotlib.collections import PatchCollection

        scene = self.tree.scene
        style: dict[str, Any] = {
            "facecolors": "#eef0f2",
            "edgecolors": "#c3c8ce",
            "linewidths": 0.8,
            "zorder": 1,
        }
        cuts = PatchCollection(cut_shapes(scene, self.section, self.box), **style)
        self.front(self.ax.add_collection(cuts, autolim=False))
        for item in scene.objects:
            if isinstance(item, Plane):
                normal = np.array([item.normal.x, item.normal.y, item.normal.z], float)
                normal /= np.abs(normal).max()
                center = np.array([item.center.x, item.center.y, item.center.z])
                self.draw_plane(center, normal / np.linalg.norm(normal), "#eef0f2", "#b4bac1", 1)

    def draw_plane(
        self,
        center: Floats,
        normal: Floats,
        face: str | Vec,
        edge: str,
        zorder: float,
    ) -> None:
        """Draw the line in which a plane meets the plane of the drawing."""
        from matplotlib.patches import Polygon

        slope = self.section.turn(normal)
        if np.hypot(*slope) < 1e-9:
            return
        distance = float(normal @ (center - self.section.origin)) / np.hypot(*slope)
        slope = slope / np.hypot(*slope)
        foot = self.section(self.section.origin) + slope * distance
        along = np.array([-slope[1], slope[0]])
        # Its body lies on the side away from the eye.
        thick = slope * math.copysign(0.02 * self.size, (foot - self.origin) @ slope)
        middle = foot + along * float((self.box.mean(0) - foot) @ along)
        ends = [middle - 2 * self.size * along, middle + 2 * self.size * along]
        body = Polygon([*ends, ends[1] + thick, ends[0] + thick], fc=face, ec="none", zorder=zorder)
        self.front(self.ax.add_patch(body))
        (line,) = self.ax.plot(*np.array(ends).T, color=edge, lw=1.2, zorder=zorder)
        self.front(line)

    def camera(self) -> None:
        """Draw the eye, the image plane with its pixel, and the camera ray."""
        ends = self.image_plane()
        name = "start of the ray" if is_orthographic(self.tree.scene.camera) else "eye"
        self.ax.plot(*self.origin, "o", ms=7, color=INK, zorder=7)
        if np.hypot(*(self.pixel - self.origin)) > NEAR * self.size:
            self.ax.plot(*np.array(ends).T, color=INK, lw=2.2, solid_capstyle="butt", zorder=4)
            self.ax.plot(*self.pixel, "s", ms=5, mfc="white", mec=RAY, mew=1.6, zorder=7)
            low = min(ends, key=lambda end: float(end[1]))
            self.note("image plane", low, (-5, 1), ha="right", va="bottom")
            self.note(name, self.origin, (0, -9), ha="center", va="top")
        else:  # no room to show it: the edges of the view instead
            for end in ends:
                way = (end - self.origin) / max(float(np.hypot(*(end - self.origin))), 1e-300)
                self.line(self.origin, self.origin + way * 2 * self.size, FAINT, lw=0.8)
            focus = self.tree.view.focus
            text = f"{name}\nimage plane {focus:.3g} in front" if focus > 0.0 else name
            self.note(text, self.origin, (-5, -9), ha="left", va="top")
        self.line(self.origin, self.end, RAY, lw=1.8, arrow=0.55)

    def miss(self) -> None:
        """Say that the ray goes on."""
        self.arrow(self.pixel, self.end, RAY, lw=0)
        lamp = self.tree.lamp
        text = "hits nothing" if lamp is None else f"sees lights[{lamp}]"
        self.note(text, self.end, (-6, 9), ha="right", va="bottom", color=RAY)

    def surface(self, surface: Surface, *, filled: bool) -> None:
        """Draw what a ray meets."""
        self.drawn.add(str(surface))
        scene, section = self.tree.scene, self.section
        shape = shape_of(scene, surface)
        if shape is None:
            center, normal = np.array(surface.center), np.array(surface.normal)
            self.draw_plane(center, normal, _shade(surface.color), INK, 2)
            return
        if not shape.share(section) > WHOLE:
            style = {"fill": False, "ec": FAINT, "lw": 0.8, "ls": (0, (2, 2)), "zorder": 2}
            self.front(self.ax.add_patch(shape.outline(section, **style)))
        for part, color in colored_parts(scene, surface, shape):
            if part.cut(section).reach[0] > 0:
                face = (*_shade(color), 0.85 if filled else 0.35)
                (body,) = part.sections(section, fc=face, ec=INK, lw=1.2, zorder=2)
                self.front(self.ax.add_patch(body))

    def once(self, surface: Surface) -> None:
        """Draw what a ray meets, if it is not drawn already."""
        if str(surface) not in self.drawn:
            self.surface(surface, filled=True)

    def shadow_ray(self, ray: ShadowRay, *, thin: bool) -> None:
        """Draw the ray to a light: solid if it arrives, dashed up to what blocks it."""
        goal, shown = self.light_place(ray)
        color = LIT if ray.arrives else BLOCKED
        strength = 0.3 if thin else 1.0
        if ray.arrives:
            head = None if thin else 0.55 if shown else 1.0
            self.line(self.end, goal, LIT, lw=1.8 * strength, arrow=head, alpha=strength)
            text = f"adds {_numbers(ray.adds)}"
        elif ray.cosine == 0:
            self.line(self.end, goal, BLOCKED, lw=1.1, ls=(0, (1, 2.5)), alpha=strength)
            text = "behind the surface"
        else:
            assert self.tree.hit is not None  # noqa: S101
            assert ray.blocker is not None  # noqa: S101
            start = self.tree.hit.point
            stop = self.section(where_met(self.tree.scene, ray.blocker, start, ray.direction))
            if str(ray.blocker) not in self.drawn:
                self.surface(ray.blocker, filled=False)
            if not thin:
                self.line(self.end, stop, BLOCKED, lw=1.8, ls=(0, (4, 2.2)))
            self.line(stop, goal, BLOCKED, lw=1.0, ls=(0, (1, 2.5)), alpha=0.7 * strength)
            size = 5 if thin else 9
            self.ax.plot(*stop, "X", ms=size, mfc=BLOCKED, mec="white", mew=size / 9, zorder=8)
            text = f"blocked by {_label(ray.blocker)}"
        if shown:
            self.sun(goal, LIT, 0.5 if thin else 1.0)
        if not thin:
            away = "" if shown else f", {ray.distance:.3g} away"
            self.light_label(f"lights[{ray.light}]{away}\n{text}", goal, color)

    def shadow_fan(self, fan: ShadowFan, *, thin: bool, main: bool) -> None:
        """Draw the rays to a light that is no point, as `shadow_ray` draws one."""
        goal, shown, lines = self._fan_place(fan)
        strength = 1.0 if main else 0.35
        if main:
            for blocker in fan.blockers[:MOST_BLOCKERS]:
                if str(blocker) not in self.drawn:
                    self.surface(blocker, filled=False)
            self.ax.plot(*self.section(lines.stops).T, ".", ms=4, color=BLOCKED, zorder=6)
        if not fan.arrives:
            self.line(self.end, goal, BLOCKED, lw=1.1, ls=(0, (1, 2.5)), alpha=strength)
        self._fan_lines(lines.arriving, LIT, "solid", strength)
        self._fan_lines(lines.stopped, BLOCKED, (0, (4, 2.2)), strength)
        lamp = lamp_shape(self.tree.scene, fan) if shown else None
        if lamp is not None and lamp.corners is not None:
            self.panel(self.section(lamp.corners), LIT, strength)
        elif lamp is not None:
            self.ball(goal, lamp.radius, LIT, strength)
        if not thin:
            text = f"{fan.outcome}\nadds {_numbers(fan.adds)}"
            if fan.rays and not fan.arrives:
                text = "behind the surface" if fan.is_behind else _blocked_by(fan)
            text = f"lights[{fan.light}], {fan.kind}: {text}"
            radius = 0.0 if lamp is None else lamp.radius
            self.light_label(text, goal, LIT if fan.arrives else BLOCKED, radius)

    def _fan_lines(
        self,
        ends: Floats,
        color: str,
        style: str | tuple[float, tuple[float, ...]],
        strength: float,
    ) -> None:
        """Draw lines from the hit to places, (n, 3); those that leave the plane are fainter."""
        assert self.tree.hit is not None  # noqa: S101
        ways = ends - np.array(self.tree.hit.point)
        lengths = np.maximum(np.linalg.norm(ways, axis=1), 1e-300)
        leaving = np.abs(ways @ self.section.normal) / lengths
        self.lines(self.end, self.section(ends), color, style, strength * (0.9 - 0.7 * leaving))

    def _fan_place(self, fan: ShadowFan) -> tuple[Floats, bool, FanLines]:
        """Return where the middle of a fan ends, whether the light is there, and its lines."""
        scene, hit = self.tree.scene, self.tree.hit
        assert hit is not None  # noqa: S101
        if is_around(fan):
            lines = fan_lines(scene, hit, fan, 1.0, DOME * hit.distance)
            up = self.section.turn(fan.direction)
            up /= max(float(np.hypot(*up)), 1e-9)
            ends = self.section(np.concatenate([lines.arriving, lines.stopped])) - self.end
            # Beyond what is written at the normal.
            reach = max(float((ends @ up).max(initial=0.0)), (NORMAL + 0.05) * self.size)
            return self.end + up * reach, False, lines
        goal, shown = self.light_place(fan)
        if shown and lamp_shape(scene, fan) is not None:
            return goal, True, fan_lines(scene, hit, fan, 1.0, math.inf)
        whole, part = self.place_of(fan) - self.end, goal - self.end
        share = float(np.hypot(*part) / max(np.hypot(*whole), 1e-300))
        longest = hit.distance * min(SUN * share, 1.0)
        return goal, False, fan_lines(scene, hit, fan, share, longest)

    def light_label(self, text: str, place: Floats, color: str, radius: float = 0.0) -> None:
        """Write beside a light, away from its ray and from other labels."""
        extent = self.box[1] - self.box[0]
        share = (place - self.box[0]) / extent
        above = (place[1] >= self.end[1] and share[1] < 0.92) or share[1] < 0.08
        level = share[1] + (0.07 if above else -0.07)
        if any(np.hypot(*(other - [share[0], level])) < 0.15 for other in self.labels):
            above = not above
            level = share[1] + (0.07 if above else -0.07)
        self.labels.append(np.array([share[0], level]))
        side = "left" if share[0] < 0.25 else "right" if share[0] > 0.75 else "center"
        shift = ({"left": -8, "right": 8, "center": 0}[side], 12 if above else -12)
        dark = "#8a5d00" if color == LIT else color
        beside = place + np.array([0.0, radius if above else -radius])
        self.note(text, beside, shift, color=dark, ha=side, va="bottom" if above else "top")

    def hit(self) -> None:
        """Draw the hit and the normal there."""
        hit = self.tree.hit
        assert hit is not None  # noqa: S101
        normal = self.section.turn(hit.normal)
        tip = self.end + normal * NORMAL * self.size
        self.arrow(self.end, tip, INK, lw=1.6)
        away = normal / max(float(np.hypot(*normal)), 1e-9)
        self.note(
            "normal", tip, _points(7 * away), ha=_side(away[0]), va=_level(away[1]), color=INK
        )
        self.ax.plot(*self.end, "o", ms=5, color=INK, zorder=9)
        self.name(hit.surface, away)

    def name(self, surface: Surface, away: Floats) -> None:
        """Write what is hit, on the side that the normal, and rays that go on, leave free."""
        shape, text = shape_of(self.tree.scene, surface), _label(surface)
        low, high = self.box if shape is None else shape.bounds(self.section)
        middle, half = (low + high) / 2, (high - low) / 2
        if shape is None or not ((self.box[0] < middle) & (middle < self.box[1])).all():
            side, level = _side(-away[0]), _level(-away[1])
            if side == "left" and self.end[0] + 1.1 * self.width(text) > self.box[1, 0]:
                side = "right"
            self.note(text, self.end, _points(-14 * away), ha=side, va=level)
            return
        room = max(0.18 * (self.box[1, 0] - self.box[0, 0]), 1.1 * self.width(text))
        if 2 * half[0] > room:
            self.note(text, middle, (0, 0), ha="center", va="center")
        elif middle[0] + half[0] + room < self.box[1, 0] and len(self.tree.path) < 2:
            self.note(text, middle + half * (1, 0), (6, 0), ha="left", va="center")
        else:
            above = away[1] < 0
            place = middle + half * (1, 1 if above else -1)
            level = "bottom" if above else "top"
            self.note(text, place, (0, 3 if above else -3), ha="right", va=level)

    def captions(self, way: WayToLight | None, *, is_path: bool) -> None:
        """Write what is shown, and how long a unit is."""
        tree = self.tree
        column, row = tree.pixel
        title = f"pixel ({column}, {row})"
        if tree.hit is not None:
            title += f"  ·  light {_numbers(tree.light)}"
        if tree.exposed is not None:
            title += f"  ·  value {_numbers(tree.exposed.value)}"
            color = tuple(channel / 255 for channel in tree.exposed.value)
            style: dict[str, Any] = {"mfc": color, "mec": INK, "mew": 0.6, "clip_on": False}
            self.ax.plot(0.008, 1.032, "s", ms=11, transform=self.ax.transAxes, **style)
        left = 0.0 if tree.exposed is None else 0.028
        style = {"transform": self.ax.transAxes, "color": INK, "fontsize": 10.5}
        self.ax.text(left, 1.03, title, va="center", **style)
        other = "upright in the image"
        if is_path:
            other = "and the ray that goes on first"
        elif isinstance(way, ShadowFan):
            other = f"and the {'normal' if is_around(way) else f'middle of lights[{way.light}]'}"
        elif way is not None:
            other = f"and the ray to lights[{way.light}]"
        text = f"A cut along the camera ray {other}; what lies off this plane is projected onto it."
        if len(tree.lights) > MOST_LABELS:
            arriving = sum(ray.arrives for ray in tree.lights)
            text = f"{arriving} of {len(tree.lights)} lights arrive.  {text}"
        style = {"transform": self.ax.transAxes, "color": FAINT, "fontsize": 7.5}
        self.ax.text(1, -0.03, text, ha="right", va="top", **style)
        length = round_length(0.2 * float(self.box[1, 0] - self.box[0, 0]))
        self.scale(float(self.box[0, 0]), length)


def _label(surface: Surface) -> str:
    """Return the name of a surface, in two lines if it is long."""
    return str(surface) if surface.copy is None else str(surface).replace(", ", ",\n")


def _blocked_by(fan: ShadowFan) -> str:
    """Return what blocks a fan of which no ray arrives."""
    blockers = fan.blockers
    return (
        f"blocked by {_label(blockers[0]) if len(blockers) == 1 else f'{len(blockers)} surfaces'}"
    )


def _shade(color: Vec) -> Vec:
    """Return a colour as Matplotlib takes it, from 0 to 1."""
    red, green, blue = color
    return red / 255, green / 255, blue / 255


def _numbers(values: Iterable[float]) -> str:
    """Return the channels of a colour as people read them."""
    return "(" + ", ".join(f"{value:.3g}" for value in values) + ")"


def _points(shift: Floats) -> tuple[float, float]:
    return float(shift[0]), float(shift[1])


def _side(x: float) -> str:
    """Return how text is aligned that lies to this side."""
    return "center" if abs(x) < 0.4 else "left" if x > 0 else "right"


def _level(y: float) -> str:
    """Return how text is aligned that lies at this height."""
    return "center" if abs(y) < 0.4 else "bottom" if y > 0 else "top"
