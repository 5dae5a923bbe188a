"""The rays of a pixel as a drawing: a cut through the scene along the camera ray."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.errors import RenderError
from vtray.extras import need
from vtray.scale_bar import length_text, round_length
from vtray.scene import Plane, Scene, Sphere
from vtray.spheres import Spheres

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from vtray.ray_tree import RayTree, ShadowRay, Surface

Floats = NDArray[np.float64]

INK, FAINT, RAY, LIT, BLOCKED = "#22262b", "#8b9199", "#1f5fa8", "#e39b00", "#c23b3b"
MOST_CIRCLES = 400
MOST_LABELS = 4
"""With more lights, only the main one has a label, and the rest are thin."""

FAR = 1.3
"""Lights farther away than this many camera rays are not drawn, only the way to them."""


@dataclass(frozen=True)
class Section:
    """The plane of the drawing.

    Attributes
    ----------
    origin
        A point of it in world space, (0, 0) in the drawing.
    across, up
        Its unit axes in world space, to the right and upwards in the drawing.
    normal
        Square to both.
    """

    origin: Floats
    across: Floats
    up: Floats
    normal: Floats

    def __call__(self, points: Any) -> Floats:  # noqa: ANN401
        """Return points in world space, (..., 3), in the drawing, (..., 2)."""
        way = np.asarray(points, float) - self.origin
        return np.stack([way @ self.across, way @ self.up], axis=-1)

    def turn(self, direction: Any) -> Floats:  # noqa: ANN401
        """Return a direction in world space as one in the drawing."""
        return self(np.asarray(direction) + self.origin)

    def cut(self, centers: Floats, radii: Any) -> Floats:  # noqa: ANN401
        """Return the radii of the circles that it cuts out of spheres; NaN if it misses them."""
        off = (centers - self.origin) @ self.normal
        squared = np.asarray(radii, float) ** 2 - off**2
        return np.sqrt(np.where(squared > 0, squared, np.nan))


def choose_section(tree: "RayTree", ray: "ShadowRay | None") -> Section:
    """Return the plane through the camera ray and a shadow ray, or upright if there is none.

    The drawing's right is where the camera looks, as far as it lies in the plane, so the image
    plane is a vertical line; up is up in the image, if the plane allows.
    """
    view = tree.view
    forward, down = np.array(view.forward), np.array(view.down)
    direction = np.array(tree.direction)
    other = -down if ray is None else np.array(ray.direction)
    normal = np.cross(direction, other)
    if np.linalg.norm(normal) < 1e-6:
        normal = np.cross(direction, -down)
    normal /= np.linalg.norm(normal)
    up = np.cross(normal, forward)
    up /= np.linalg.norm(up)
    rise = -up @ down
    if abs(rise) < 0.2 and ray is not None:
        rise = up @ other
    if rise < 0:
        up, normal = -up, -normal
    return Section(np.array(tree.origin), np.cross(up, normal), up, normal)


def draw(tree: "RayTree", ax: "Axes | None", light: int | None) -> "Axes":
    """Draw the rays of a pixel; see `RayTree.draw`."""
    need("matplotlib", "figure", "RayTree.draw")
    ray = _main_ray(tree, light)
    if ax is None:
        from matplotlib.figure import Figure

        ax = Figure(figsize=(8, 5.5), dpi=150).add_axes((0.02, 0.08, 0.96, 0.82))
    drawing = _Drawing(tree, choose_section(tree, ray), ax)
    drawing.frame()
    drawing.surroundings()
    drawing.camera()
    if tree.hit is None:
        drawing.miss()
    else:
        drawing.surface(tree.hit.surface, filled=True)
        few = len(tree.lights) <= MOST_LABELS
        for other in tree.lights:
            drawing.shadow_ray(other, thin=not few and other is not ray)
        drawing.hit()
    drawing.captions(ray)
    return ax


def _main_ray(tree: "RayTree", light: int | None) -> "ShadowRay | None":
    """Return the shadow ray that lies in the plane of the drawing."""
    if light is not None:
        if not 0 <= light < len(tree.lights):
            message = f"light: expected one of the {len(tree.lights)} shadow rays, got {light}"
            raise RenderError(message)
        return tree.lights[light]
    # The one that adds most; if none does, one that something blocks.
    return max(
        tree.lights,
        key=lambda ray: (sum(ray.adds), ray.blocker is not None and ray.cosine > 0),
        default=None,
    )


class _Drawing:
    """A drawing of rays while it is made."""

    def __init__(self, tree: "RayTree", section: Section, ax: "Axes") -> None:
        self.tree = tree
        self.section = section
        self.ax = ax
        self.origin = section(tree.origin)
        self.ray = section.turn(tree.direction)
        view = tree.view
        steep = float(np.dot(tree.direction, view.forward))
        self.plane_x = view.focus
        self.pixel = self.origin + self.ray * (view.focus / steep)
        self.end = self.origin + self.ray * self._ray_length()
        self.box = self._find_box()
        self.size = float(np.hypot(*(self.box[1] - self.box[0])))
        self.labels: list[Floats] = []
        self.drawn: set[Surface] = set()

    def _ray_length(self) -> float:
        """Return how long the camera ray is drawn."""
        tree = self.tree
        if tree.hit is not None:
            return tree.hit.distance
        steep = float(np.dot(tree.direction, tree.view.forward))
        reach = 3 * tree.view.focus
        if tree.scene is not None:
            for item in tree.scene.objects:
                if not isinstance(item, Plane) and (not isinstance(item, Spheres) or len(item)):
                    center, _ = _spheres_of(item)
                    ahead = (center - np.array(tree.origin)) @ np.array(tree.view.forward)
                    reach = max(reach, 1.15 * float(np.median(ahead)))
        return reach / steep

    def _find_box(self) -> Floats:
        """Return the corners of what is shown: lower left, upper right."""
        points = [self.origin, self.pixel, self.end, *self._image_plane()]
        length = float(np.hypot(*(self.end - self.origin)))
        hit = self.tree.hit
        if hit is not None:
            radius = hit.surface.radius
            if radius is not None:
                reach = min(radius, 0.5 * length)
                middle = self.section(hit.surface.center)
                if radius > reach:
                    middle = self.end
                points += [middle - reach, middle + reach]
            for ray in self.tree.lights:
                way = self.section(ray.location) - self.end
                points.append(self.end + way * min(1.0, 0.6 * length / max(np.hypot(*way), 1e-300)))
                if np.hypot(*way) < FAR * length:
                    points.append(self.section(ray.location))
        corners = np.array(points)
        low, high = corners.min(0), corners.max(0)
        margin = 0.06 * float(np.hypot(*(high - low)))
        return _widen(np.array([low - margin, high + [2 * margin, margin]]), self._aspect())

    def _aspect(self) -> float:
        """Return the width of the axes over their height."""
        area = self.ax.get_window_extent()
        return float(area.width / area.height)

    def _image_plane(self) -> tuple[Floats, Floats]:
        """Return the ends of the image in the drawing."""
        view, tree = self.tree.view, self.tree
        up = self.section.up
        along = np.array([up @ view.right, up @ view.down])
        steep = float(np.dot(tree.direction, view.forward))
        place = np.array(tree.origin) + np.array(tree.direction) * (view.focus / steep) - view.center
        pixel = np.array([place @ view.right, place @ view.down])
        half = np.array(view.size) * view.resolution / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(-half - pixel) / along, (half - pixel) / along])
        first = np.nanmax(np.where(along == 0, -np.inf, ends.min(0)))
        last = np.nanmin(np.where(along == 0, np.inf, ends.max(0)))
        straight = np.array([0.0, 1.0])
        return self.pixel + first * straight, self.pixel + last * straight

    def frame(self) -> None:
        """Set up the axes."""
        self.ax.set_aspect("equal")
        self.ax.set_xlim(self.box[:, 0])
        self.ax.set_ylim(self.box[:, 1])
        self.ax.set_axis_off()

    def front(self, artist: Any) -> Any:  # noqa: ANN401
        """Show an artist only in front of the image plane, where objects exist."""
        from matplotlib.patches import Rectangle

        (left, bottom), (right, top) = self.box
        start = max(left, min(self.pixel[0], right))
        region = Rectangle((start, bottom), right - start, top - bottom, transform=self.ax.transData)
        artist.set_clip_path(region)
        return artist

    def surroundings(self) -> None:
        """Draw what the plane of the drawing cuts, apart from what rays meet."""
        scene = self.tree.scene
        if scene is None:
            return
        from matplotlib.collections import EllipseCollection

        centers, radii = _cut_spheres(scene, self.section, self.box)
        circles = EllipseCollection(
            2 * radii,
            2 * radii,
            np.zeros(len(radii)),
            units="xy",
            offsets=centers,
            transOffset=self.ax.transData,
            facecolors="#eef0f2",
            edgecolors="#c3c8ce",
            linewidths=0.8,
            zorder=1,
        )
        self.front(self.ax.add_collection(circles, autolim=False))
        for item in scene.objects:
            if isinstance(item, Plane):
                normal = np.array([item.normal.x, item.normal.y, item.normal.z], float)
                normal /= np.abs(normal).max()
                center = np.array([item.center.x, item.center.y, item.center.z])
                self.draw_plane(center, normal / np.linalg.norm(normal), "#eef0f2", "#b4bac1", 1)

    def draw_plane(
        self, center: Floats, normal: Floats, face: Any, edge: Any, zorder: float  # noqa: ANN401
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
        ends = self._image_plane()
        self.ax.plot(*np.array(ends).T, color=INK, lw=2.2, solid_capstyle="butt", zorder=4)
        self.ax.plot(*self.pixel, "s", ms=5, mfc="white", mec=RAY, mew=1.6, zorder=7)
        self.ax.plot(*self.origin, "o", ms=7, color=INK, zorder=7)
        low = min(ends, key=lambda end: float(end[1]))
        self.note("image plane", low, (-5, 1), ha="right", va="bottom")
        name = "eye" if not self._parallel() else "start of the ray"
        self.note(name, self.origin, (0, -9), ha="center", va="top")
        self.line(self.origin, self.end, RAY, lw=1.8, arrow=0.55)

    def _parallel(self) -> bool:
        """Tell whether the camera is orthographic."""
        camera = self.tree.scene.camera if self.tree.scene is not None else None
        return getattr(camera, "projection", "perspective") == "orthographic"

    def miss(self) -> None:
        """Say that the ray goes on."""
        self.arrow(self.pixel, self.end, RAY, lw=0)
        self.note("hits nothing", self.end, (-6, 9), ha="right", va="bottom", color=RAY)

    def surface(self, surface: "Surface", *, filled: bool) -> None:
        """Draw a sphere or a plane that a ray meets."""
        self.drawn.add(surface)
        color = tuple(channel / 255 for channel in surface.color)
        center = np.array(surface.center)
        if surface.radius is None:
            assert surface.normal is not None  # noqa: S101
            self.draw_plane(center, np.array(surface.normal), color, INK, 2)
            return
        from matplotlib.patches import Circle

        cut = float(self.section.cut(center, surface.radius))
        middle = self.section(center)
        if not cut > 0.97 * surface.radius:
            outline = Circle(
                tuple(middle), surface.radius, fill=False, ec=FAINT, lw=0.8, ls=(0, (2, 2)), zorder=2
            )
            self.front(self.ax.add_patch(outline))
        if cut > 0:
            body = Circle(
                tuple(middle), cut, fc=(*color, 0.85 if filled else 0.35), ec=INK, lw=1.2, zorder=2
            )
            self.front(self.ax.add_patch(body))

    def shadow_ray(self, ray: "ShadowRay", *, thin: bool) -> None:
        """Draw the ray to a light: solid if it arrives, dashed up to what blocks it."""
        goal, shown = self._light_place(ray)
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
            assert ray.blocker is not None  # noqa: S101
            stop = self.section(_where_blocked(self.tree, ray))
            if ray.blocker not in self.drawn:
                self.surface(ray.blocker, filled=False)
            if not thin:
                self.line(self.end, stop, BLOCKED, lw=1.8, ls=(0, (4, 2.2)))
            self.line(stop, goal, BLOCKED, lw=1.0, ls=(0, (1, 2.5)), alpha=0.7 * strength)
            size = 5 if thin else 9
            self.ax.plot(*stop, "X", ms=size, mfc=BLOCKED, mec="white", mew=size / 9, zorder=8)
            text = f"blocked by {ray.blocker}"
        if shown:
            self.sun(goal, LIT, 0.5 if thin else 1.0)
        if not thin:
            away = "" if shown else f", {ray.distance:.3g} away"
            self.light_label(f"lights[{ray.light}]{away}\n{text}", goal, color)

    def _light_place(self, ray: "ShadowRay") -> tuple[Floats, bool]:
        """Return where a shadow ray ends in the drawing, and whether the light is there."""
        place = self.section(ray.location)
        low, high = self.box
        if (low <= place).all() and (place <= high).all():
            return place, True
        way = place - self.end
        inner = np.array([low, high]) * 0.78 + self.box.mean(0) * 0.22  # room for the text
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = np.where(way > 0, (inner[1] - self.end) / way, (inner[0] - self.end) / way)
        return self.end + way * float(np.nanmin(steps)), False

    def sun(self, place: Floats, color: str, size: float) -> None:
        """Draw a light."""
        self.ax.plot(*place, marker=(12, 1, 0), ms=17 * size, mfc=color, mec="none", zorder=7)
        self.ax.plot(*place, "o", ms=8 * size, mfc="#fff3cf", mec=color, mew=1.2 * size, zorder=8)

    def light_label(self, text: str, place: Floats, color: str) -> None:
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
        self.note(text, place, shift, color=dark, ha=side, va="bottom" if above else "top")

    def hit(self) -> None:
        """Draw the hit and the normal there."""
        hit = self.tree.hit
        assert hit is not None  # noqa: S101
        normal = self.section.turn(hit.normal)
        tip = self.end + normal * 0.13 * self.size
        self.arrow(self.end, tip, INK, lw=1.6)
        away = normal / max(float(np.hypot(*normal)), 1e-9)
        self.note("normal", tip, 7 * away, ha=_side(away[0]), va=_level(away[1]), color=INK)
        self.ax.plot(*self.end, "o", ms=5, color=INK, zorder=9)
        if hit.surface.radius is None:
            side, level = _side(-away[0]), _level(-away[1])
            self.note(str(hit.surface), self.end, -14 * away, ha=side, va=level)
        else:
            middle, radius = self.section(hit.surface.center), hit.surface.radius
            room = 0.18 * (self.box[1, 0] - self.box[0, 0])
            if 2 * radius > room:
                self.note(str(hit.surface), middle, (0, 0), ha="center", va="center")
            elif middle[0] + radius + room < self.box[1, 0]:
                place = middle + [radius, 0.0]
                self.note(str(hit.surface), place, (6, 0), ha="left", va="center")
            else:
                self.note(str(hit.surface), self.end, (-8, -8), ha="right", va="top")

    def captions(self, ray: "ShadowRay | None") -> None:
        """Write what is shown, and how long a unit is."""
        tree = self.tree
        column, row = tree.pixel
        title = f"pixel ({column}, {row})"
        if tree.hit is not None:
            title += f"  ·  light {_numbers(tree.light)}"
        if tree.exposed is not None:
            title += f"  ·  value {_numbers(tree.exposed.value)}"
            color = tuple(channel / 255 for channel in tree.exposed.value)
            style = {"mfc": color, "mec": INK, "mew": 0.6, "clip_on": False}
            self.ax.plot(0.008, 1.032, "s", ms=11, transform=self.ax.transAxes, **style)
        left = 0.0 if tree.exposed is None else 0.028
        style = {"transform": self.ax.transAxes, "color": INK, "fontsize": 10.5}
        self.ax.text(left, 1.03, title, va="center", **style)
        other = "upright in the image" if ray is None else f"and the ray to lights[{ray.light}]"
        text = f"A cut along the camera ray {other}; what lies off this plane is projected onto it."
        if len(tree.lights) > MOST_LABELS:
            arriving = sum(ray.arrives for ray in tree.lights)
            text = f"{arriving} of {len(tree.lights)} lights arrive.  {text}"
        style = {"transform": self.ax.transAxes, "color": FAINT, "fontsize": 7.5}
        self.ax.text(1, -0.03, text, ha="right", va="top", **style)
        length = round_length(0.2 * float(self.box[1, 0] - self.box[0, 0]))
        self._scale(length)

    def _scale(self, length: float) -> None:
        """Draw a scale bar below the drawing."""
        transform = self.ax.get_xaxis_transform()
        start = self.box[0, 0]
        self.ax.plot(
            [start, start + length], [-0.03] * 2, color=INK, lw=2, transform=transform,
            clip_on=False, solid_capstyle="butt",
        )
        self.ax.text(
            start + length / 2, -0.04, length_text(length), transform=transform, ha="center",
            va="top", fontsize=8, color=INK,
        )

    def line(
        self,
        start: Floats,
        end: Floats,
        color: str,
        *,
        arrow: float | None = None,
        **style: Any,  # noqa: ANN401
    ) -> None:
        """Draw a straight line, with an arrow head at a part of its length if wanted."""
        self.ax.plot(*np.array([start, end]).T, color=color, zorder=5, **style)
        if arrow is not None:
            self.arrow(start, start + arrow * (end - start), color, lw=0)

    def arrow(self, start: Floats, tip: Floats, color: str, lw: float) -> None:
        """Draw an arrow, whose shaft has the width `lw`."""
        shape = {"arrowstyle": "-|>", "color": color, "lw": lw, "mutation_scale": 14}
        shape |= {"shrinkA": 0, "shrinkB": 0}
        self.ax.annotate("", tuple(tip), tuple(start), arrowprops=shape, zorder=7)

    def note(
        self, text: str, place: Floats, shift: Iterable[float], *, color: str = INK, **style: Any  # noqa: ANN401
    ) -> None:
        """Write beside a place, legible on whatever is there."""
        from matplotlib.patheffects import withStroke

        self.ax.annotate(
            text,
            tuple(place),
            tuple(shift),
            textcoords="offset points",
            fontsize=8.5,
            color=color,
            path_effects=[withStroke(linewidth=2.5, foreground="white", alpha=0.9)],
            zorder=10,
            annotation_clip=False,
            **style,
        )


def _spheres_of(item: Sphere | Spheres) -> tuple[Floats, Floats]:
    """Return centres, (n, 3), and radii, (n,), of one or many spheres."""
    if isinstance(item, Sphere):
        center = np.array([[item.center.x, item.center.y, item.center.z]])
        return center, np.array([item.radius])
    radii = np.broadcast_to(np.asarray(item.radius, float), len(item))
    return np.asarray(item.center, float), radii


def _cut_spheres(scene: Scene, section: Section, box: Floats) -> tuple[Floats, Floats]:
    """Return the largest of the circles that a plane cuts out of spheres, within a box."""
    centers, radii = [np.zeros((0, 2))], [np.zeros(0)]
    for item in scene.objects:
        if isinstance(item, Plane):
            continue
        center, radius = _spheres_of(item)
        cut = section.cut(center, radius)
        flat = section(center)
        near = np.flatnonzero(((flat > box[0] - cut[:, None]) & (flat < box[1] + cut[:, None])).all(1))
        near = near[np.argsort(-cut[near])[:MOST_CIRCLES]]
        centers.append(flat[near])
        radii.append(cut[near])
    largest = np.argsort(-np.concatenate(radii))[:MOST_CIRCLES]
    return np.concatenate(centers)[largest], np.concatenate(radii)[largest]


def _widen(box: Floats, aspect: float) -> Floats:
    """Return a box around another one, whose width over its height is the aspect."""
    width, height = box[1] - box[0]
    grow = np.array([max(aspect * height - width, 0.0), max(width / aspect - height, 0.0)]) / 2
    return np.array([box[0] - grow, box[1] + grow])


def _where_blocked(tree: "RayTree", ray: "ShadowRay") -> Floats:
    """Return where in world space a shadow ray meets its blocker."""
    hit, blocker = tree.hit, ray.blocker
    assert hit is not None  # noqa: S101
    assert blocker is not None  # noqa: S101
    start, way = np.array(hit.point), np.array(ray.direction)
    arm = start - np.array(blocker.center)
    if blocker.normal is not None:
        normal = np.array(blocker.normal)
        return start - way * float(normal @ arm) / float(normal @ way)
    assert blocker.radius is not None  # noqa: S101
    toward = -float(arm @ way)
    foot = arm + toward * way
    half = math.sqrt(max(blocker.radius**2 - float(foot @ foot), 0.0))
    outside = float(arm @ arm) > blocker.radius**2 * (1 + 1e-9)
    return start + way * (toward - half if outside else toward + half)


def _numbers(values: Iterable[float]) -> str:
    """Return the channels of a colour as people read them."""
    return "(" + ", ".join(f"{value:.3g}" for value in values) + ")"


def _side(x: float) -> str:
    """Return how text is aligned that lies to this side."""
    return "center" if abs(x) < 0.4 else "left" if x > 0 else "right"


def _level(y: float) -> str:
    """Return how text is aligned that lies at this height."""
    return "center" if abs(y) < 0.4 else "bottom" if y > 0 else "top"
