"""From particles to objects of a scene, step by step."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.base.number import is_number, number_of
from vtray.scene.checks.choices import yes_or_no
from vtray.scene.checks.given_array import array_of
from vtray.scene.checks.scene_words import show
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.particles.bond_objects import Between, BondObjects
from vtray.scene.particles.bonds import Bonds, bonds_between, find_bonds
from vtray.scene.particles.boundary import Images, images_on_boundary, tolerance_of
from vtray.scene.particles.cell import (
    THIN,
    cell_edges,
    holds_particles,
    times_of,
    translations,
    unwrapped,
    wrapped,
)
from vtray.scene.particles.coloring import Coloring, color_particles, faded
from vtray.scene.particles.elements import NO_ELEMENT
from vtray.scene.particles.expression import mask
from vtray.scene.particles.from_objects import as_particles
from vtray.scene.particles.hydrogen_bonds import DASHES, criterion_of, find_hydrogen_bonds
from vtray.scene.particles.made_of import (
    MadeOf,
    remember,
    remember_cell,
    remember_ends,
    repeated,
    written_out,
)
from vtray.scene.particles.opacity import opacities, see_through
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.shining import check_dull, check_shining, shining
from vtray.scene.particles.shown_bonds import Times, crossing, within_cell
from vtray.scene.particles.sites import are_sites
from vtray.scene.particles.styles import (
    COVERED,
    STYLES,
    ball_radii,
    radius_beside,
    screen_radii,
    stick_radius,
    style_of,
)
from vtray.scene.placing.look_at import argument
from vtray.scene.spheres import Spheres
from vtray.scene.stars import Stars

if TYPE_CHECKING:
    from vtray.scene.camera import Camera
    from vtray.scene.colors.color_scale import ColorScale
    from vtray.scene.colors.names import AnyColor, Rgb
    from vtray.scene.objects import Object
    from vtray.scene.particles.radii import Radii

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SCALES = (1e-20, 1e20, "a number from 1e-20 to 1e20")
"""What radii may be multiplied by: enough for any two units of length."""

CELL_COLOR = (70, 70, 70)

_WITH_CELL = "; vtray.Particles(positions, cell=...) are particles with a cell"
"""What helps who gives the cell of positions in place of whether it is shown."""

WRITTEN_OUT = 500_000
"""Spheres and cylinders up to which all cells are written out, about 50 MB: copies of small cells,
whose boxes overlap, are traced seven times as slowly."""


class HasObjects(Protocol):
    """A scene, as far as particles are added to it."""

    objects: "list[Object]"

    @property
    def camera(self) -> "Camera | None": ...  # noqa: D102


@dataclass(frozen=True, eq=False)
class Drawn:
    """What `Scene.add_particles` has added.

    Attributes
    ----------
    spheres : Spheres
        The particles; none where they shine.
    bonds : Cylinders or None
        The bonds: first those that are whole, then the halves of those that cross the border.
        Where far faces show particles again, those within a cell.
    hydrogen_bonds : Cylinders or None
        The hydrogen bonds, six dashes for each; as `bonds`.
    boundary : tuple of Spheres, Cylinders or None, and Cylinders or None; or None
        The particles that far faces of the cell show again, and all bonds and hydrogen bonds
        that lead to them or from one cell to another. Where there are `copies`, those between
        cells are `Copies`, too, which follow it in the scene.
    cell : tuple of Cylinders and Spheres, or None
        The cell's edges, and its corners.
    copies : Copies or None
        What stands at all places of a cell that is shown several times, with `spheres`, `bonds`
        and `hydrogen_bonds`, which are then not among the objects of the scene themselves. None
        where these are so few that they hold all cells, one after the other, and opaque.
    stars : Stars or None
        The particles, those of all cells that are shown, if they shine.
    color_scale : ColorScale or None
        How values became colours, if they did.
    legend : list
        What colours stand for, as names and colours, where they are those of elements or
        categories.
    indices : array (n,)
        Which of the particles were drawn.
    style : str
        The style.
    categories : sequence or None
        The names or integers that have a colour each, in the order of the palette, if such were
        coloured; or the elements of the legend.
    """

    spheres: Spheres
    bonds: Cylinders | None
    hydrogen_bonds: Cylinders | None
    boundary: "tuple[Spheres, Cylinders | None, Cylinders | None] | None"
    cell: tuple[Cylinders, Spheres] | None
    copies: Copies | None
    stars: Stars | None
    color_scale: "ColorScale | None"
    legend: "list[tuple[str, Rgb]]"
    indices: Integers
    style: str
    categories: Sequence[Any] | None = None


class _Placed(NamedTuple):
    """Particles where they are drawn.

    Attributes
    ----------
    positions
        Of all of them, (n, 3).
    bonds, hydrogen_bonds
        Those to draw, between any of them.
    rows
        Which are drawn, (k,).
    places
        Translations of the copies of all, (m, 3).
    times
        How many times the cell is shown along each of its edges.
    images
        Which of them are shown again on the boundary; None if that is not asked for.
    """

    positions: NDArray[Any]
    bonds: Bonds | None
    hydrogen_bonds: Bonds | None
    rows: Integers
    places: Floats
    times: Times
    images: Images | None

    @property
    def stands_as_copies(self) -> bool:
        """Whether several cells are shown that have too many objects to be written out."""
        count = len(self.rows)
        if self.bonds is not None:
            count += len(self.bonds) + len(crossing(self.bonds))
        if self.hydrogen_bonds is not None:
            count += 2 * DASHES * len(self.hydrogen_bonds)
        most = WRITTEN_OUT // max(count, 1)
        return len(self.places) > 1 and len(self.places) > most


class _Solid(NamedTuple):
    """Particles as objects that hide what is behind them; see `Drawn`."""

    spheres: Spheres
    bonds: Cylinders | None
    hydrogen_bonds: Cylinders | None

    @property
    def parts(self) -> list[Spheres | Cylinders]:
        """Those that there are."""
        return [part for part in self if part is not None]

    def see_through(self, opacity: Floats) -> "_Solid":
        """Return the same as opaque as the particles are, (n,)."""
        spheres, *others = self
        bonds, hydrogen_bonds = (
            None if part is None else see_through(part, opacity) for part in others
        )
        return _Solid(see_through(spheres, opacity), bonds, hydrogen_bonds)

    def written_out(self, places: Floats) -> "_Solid":
        """Return the same at several places, one after the other."""
        spheres, *others = self
        bonds, hydrogen_bonds = (
            None if part is None else written_out(part, places) for part in others
        )
        return _Solid(written_out(spheres, places), bonds, hydrogen_bonds)


def draw(
    scene: HasObjects,
    given: Any,  # noqa: ANN401
    *,
    style: str | None,
    radii: "Radii | None",
    scale: float,
    coloring: Mapping[str, Any],
    select: Any,  # noqa: ANN401
    highlight: Any,  # noqa: ANN401
    opacity: Any,  # noqa: ANN401
    background: "AnyColor | None",
    bonds: Any,  # noqa: ANN401
    bond_radius: float | None,
    hydrogen_bonds: Any,  # noqa: ANN401
    emission: Any,  # noqa: ANN401
    stretched: Mapping[str, Any],
    cell: bool | None,
    replicate: Sequence[int],
    boundary: Any,  # noqa: ANN401
    wrap: bool,
    unwrap: bool,
    camera: "Camera | None",
) -> Drawn:
    """Add particles to a scene, as `Scene.add_particles` says, whose parameters these are."""
    particles = as_particles(given, "add_particles: ")
    bonds, hydrogen_bonds, boundary = map(_plain, (bonds, hydrogen_bonds, boundary))
    size = _number(scale, "scale", *SCALES)
    cell = None if cell is None else yes_or_no(cell, "cell", _WITH_CELL)
    shines = emission is not None
    if shines and opacity is not None:
        raise SceneError("opacity: expected None with emission, as what shines hides nothing")
    if shines:
        asked = {"radii": radii, "bonds": bonds, "hydrogen_bonds": hydrogen_bonds}
        coloring = check_shining(style, coloring, {**asked, "boundary": boundary})
    else:
        check_dull(stretched)
    wanted = criterion_of(hydrogen_bonds)
    name = "points" if shines else style_of(style, particles, bonds, wanted is not None)
    if name == "points" and radii is not None:
        words = "points have none, as they are as large as pixels; give scale, or another style"
        raise SceneError(f"radii: {words}")
    times = times_of(replicate)
    rows = np.flatnonzero(_without_sites(particles, chosen(particles, select, "select")))
    pairs = None
    if wanted is not None:
        pairs = find_hydrogen_bonds(particles, wanted, by_distance=bonds is True)
    placed = _place(particles, name, rows, bonds, pairs, times, boundary, wrap=wrap, unwrap=unwrap)
    found = color_particles(particles, rows, **coloring)
    kept = None if highlight is None else chosen(particles, highlight, "highlight")
    if kept is not None and opacity is None:
        usual = "black" if shines else "white"
        behind = usual if background is None else background
        found = found._replace(colors=faded(found.colors, kept[rows], behind))
    seen_through = None if opacity is None else opacities(particles, opacity, kept)
    before = len(scene.objects)
    if shines:
        positions, places = placed.positions[rows], placed.places
        stars = shining(particles, rows, positions, places, emission, found, stretched)
        solid = _Solid(Spheres(np.zeros((0, 3)), 0.0), None, None)
        again = copies = None
        scene.objects.append(stars)
    else:
        stars = None
        solid, again, between = _solid(
            particles, placed, found, name, radii, size, bond_radius, _seen_by(scene, camera)
        )
        solid, again, copies = _add(scene, solid, again, between, placed, seen_through)
    edges = None
    is_usual = cell is None and not shines
    if cell or (is_usual and _holds_what_is_drawn(particles, placed.positions)):
        edges = _edges(particles, times)
        scene.objects.extend(edges)
    if particles.cell is not None:
        remember_cell(scene.objects[before:])
    legend = list(found.legend)
    return Drawn(
        *solid, again, edges, copies, stars, found.scale, legend, rows, name, found.categories
    )


def _solid(
    particles: Particles,
    placed: _Placed,
    found: Coloring,
    style: str,
    radii: "Radii | None",
    scale: float,
    bond_radius: float | None,
    camera: "Camera | None",
) -> tuple[_Solid, _Solid | None, list[Between]]:
    """Return particles, bonds and hydrogen bonds as objects, and those on and across the boundary.

    The first are without the copies of their cell.
    """
    if radii is None and placed.bonds is not None:
        radii = radius_beside(particles, style, placed.bonds, placed.positions)
    radius = _radii(particles, style, radii, scale, placed, camera)
    balls = _spheres(particles, placed, radius, found)
    bonds, times = (placed.bonds, placed.hydrogen_bonds), placed.times
    thick = 0.0
    if bonds != (None, None):
        thick = stick_radius(particles, style, radii, scale)
        if bond_radius is not None:
            thick = _number(bond_radius, "bond_radius")
    made = BondObjects(particles, placed.positions, placed.rows, thick, radius, found.colors)
    if placed.images is None:
        return _Solid(balls, *made.of_cell(*bonds)), None, []
    one, two = (None if some is None else within_cell(some) for some in bonds)
    solid = _Solid(balls, *made.of_cell(one, two))
    alone = not placed.stands_as_copies
    beyond = made.beyond(*bonds, placed.images, times, between=alone)
    again = _Solid(_again(balls, placed.images), *beyond)
    return solid, again, [] if alone else made.between(*bonds, times)


def _add(
    scene: HasObjects,
    solid: _Solid,
    again: _Solid | None,
    between: Sequence[Between],
    placed: _Placed,
    seen_through: Floats | None,
) -> tuple[_Solid, _Solid | None, Copies | None]:
    """Add objects to a scene, at all places; return what they have become.

    Parameters
    ----------
    scene
        The scene.
    solid, again, between
        Those of a cell, those on the boundary, and what joins copies of the cell.
    placed
        Where these are.
    seen_through
        How opaque particles are, (n,), if they are not.
    """
    if seen_through is not None:
        solid = solid.see_through(seen_through)
        again = None if again is None else again.see_through(seen_through)
    copies = None
    parts = [] if again is None else [part for part in again.parts if len(part)]
    joining = [_joining(some, placed.places, seen_through) for some in between]
    if placed.stands_as_copies:
        copies = Copies(solid.parts, placed.places)
    elif len(placed.places) > 1:
        solid = solid.written_out(placed.places)
    if copies is None and seen_through is not None and len(solid.parts + parts) > 1:
        # One object, so that balls and bonds are one body.
        copies, parts = Copies(solid.parts + parts, np.zeros((1, 3))), []
    scene.objects.extend([*(solid.parts if copies is None else [copies]), *joining, *parts])
    return solid, again, copies


def _joining(between: Between, places: Floats, seen_through: Floats | None) -> Copies:
    """Return what joins copies of the cell, which stand at places, (m, 3)."""
    part, ends = between
    part = part if seen_through is None else see_through(part, seen_through)
    return remember_ends(Copies(part, places[ends[:, 0]]), ends)


def chosen(particles: Particles, given: Any, name: str) -> NDArray[np.bool_]:  # noqa: ANN401
    """Return which particles an expression or an array chooses, (n,).

    Raises
    ------
    SceneError
        It is neither.
    """
    if given is None:
        return np.ones(len(particles), np.bool_)
    if isinstance(given, str):
        return mask(particles, given, name)
    words = f"expected an expression, or an array of {len(particles)} bool"
    found = array_of(given, name, words)
    if found.dtype != np.bool_ or found.shape != (len(particles),):
        raise SceneError(f"{name}: {words}, got {show(given)}")
    return found


def _without_sites(particles: Particles, are_chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which of the chosen particles are drawn, (n,): sites only where they are chosen alone.

    Beside atoms, whose balls they are in, they would be balls around these.
    """
    sites = are_sites(particles.columns)
    if sites is None:
        return are_chosen
    are_drawn = are_chosen & ~sites
    return are_drawn if are_drawn.any() else are_chosen


def _place(
    particles: Particles,
    style: str,
    rows: Integers,
    bonds: Any,  # noqa: ANN401
    hydrogen_bonds: Bonds | None,
    times: tuple[int, int, int],
    boundary: Any,  # noqa: ANN401
    *,
    wrap: bool,
    unwrap: bool,
) -> _Placed:
    """Return where particles are drawn, and the bonds between those that are."""
    wrap, unwrap = yes_or_no(wrap, "wrap"), yes_or_no(unwrap, "unwrap")
    if wrap and unwrap:
        raise SceneError("unwrap: expected False with wrap=True, as it undoes that")
    if bonds is None and STYLES[style].stick is not None:
        bonds = True if particles.bonds is None else particles.bonds
    found = None
    if bonds is not None and bonds is not False:
        found = _bonds_of(particles, bonds)
    positions: NDArray[Any] = particles.positions
    if wrap or unwrap:
        known = found
        if unwrap and known is None and particles.bonds is not None:
            known = bonds_between(particles, particles.bonds)
        if unwrap and bonds is True and NO_ELEMENT in particles.columns.get("element", ()):
            # Sites that are no elements stay with their molecules.
            known = find_bonds(particles, with_sites=True)
        positions, moves = unwrapped(particles, known) if unwrap else wrapped(particles)
        found = None if found is None else found.after(moves)
        hydrogen_bonds = None if hydrogen_bonds is None else hydrogen_bonds.after(moves)
    if len(rows) < len(particles):
        drawn = np.zeros(len(particles), np.bool_)
        drawn[rows] = True
        found, hydrogen_bonds = _among(found, drawn), _among(hydrogen_bonds, drawn)
    tolerance, images = tolerance_of(boundary), None
    if tolerance is not None:
        images = images_on_boundary(particles, positions, rows, times, tolerance)
    places = translations(particles, times)
    return _Placed(positions, found, hydrogen_bonds, rows, places, times, images)


def _among(bonds: Bonds | None, drawn: NDArray[np.bool_]) -> Bonds | None:
    """Return the bonds between particles that are drawn, (n,)."""
    if bonds is None:
        return None
    return bonds.some(drawn[bonds.pairs[:, 0]] & drawn[bonds.pairs[:, 1]])


def _bonds_of(particles: Particles, bonds: Any) -> Bonds:  # noqa: ANN401
    """Return the bonds that are asked for."""
    if bonds is True:
        if "element" not in particles.columns and len(particles):
            if particles.bonds is not None:
                return bonds_between(particles, particles.bonds)
            words = "which ones there are follows from elements, and there is no column element"
            raise SceneError(f"bonds: {words}; give a length, as bonds=2.5 or --cutoff 2.5")
        return find_bonds(particles)
    if isinstance(bonds, str) and bonds == "file":
        if particles.bonds is None:
            raise SceneError('bonds: "file" are those that are known, and there are none')
        return bonds_between(particles, particles.bonds)
    if is_number(bonds):
        if not 0.0 < number_of(bonds) < np.inf:
            raise SceneError(f"bonds: expected a length > 0, got {show(bonds)}")
        return find_bonds(particles, cutoff=number_of(bonds))
    return bonds_between(particles, bonds)


def _radii(
    particles: Particles,
    style: str,
    radii: "Radii | None",
    scale: float,
    placed: _Placed,
    camera: "Camera | None",
) -> Floats | float:
    """Return the radii of all particles that are drawn, or one for all."""
    if style == "points":
        if camera is None:
            remedy = "set scene.camera first, for instance to vtray.Camera.fit(particles.positions)"
            raise SceneError(
                f'style: "points" are as large as pixels, which needs a camera; {remedy}'
            )
        positions, places = placed.positions[placed.rows], placed.places
        if placed.images is not None:
            places = np.concatenate([places, np.unique(placed.images.steps, axis=0)])
        return screen_radii(positions, camera, COVERED * scale, places)
    found = ball_radii(particles, style, radii, scale)
    return found if isinstance(found, float) else found[placed.rows]


def _spheres(
    particles: Particles, placed: _Placed, radius: Floats | float, found: Coloring
) -> Spheres:
    """Return the particles as spheres."""
    whole = len(placed.rows) == len(particles)
    positions = placed.positions if whole else placed.positions[placed.rows]
    spheres = Spheres(positions, radius, found.colors).with_scale(found.scale)
    return remember(spheres, MadeOf(particles, placed.rows, "particle"))


def _again(balls: Spheres, images: Images) -> Spheres:
    """Return the balls of particles that are shown again."""
    return repeated(balls, images.particles, images.steps, images.copies)


def _holds_what_is_drawn(particles: Particles, positions: NDArray[Any]) -> bool:
    """Tell whether there is a cell that holds particles; warn if it holds hardly any."""
    if particles.cell is None:
        return False
    if holds_particles(particles, positions):
        return True
    words = "not drawn, as it holds less than a quarter of the particles"
    remedy = "wrap=True (--wrap) brings them into it, cell=True (--cell) draws it"
    warn_caller(f"cell: {words}; {remedy}")
    return False


def _edges(particles: Particles, times: tuple[int, int, int]) -> tuple[Cylinders, Spheres]:
    """Return the edges of the cell, or of the block of cells, with round corners."""
    corners, starts, ends, longest = cell_edges(particles, times)
    radius = THIN * longest
    return Cylinders(starts, ends, radius, CELL_COLOR), Spheres(corners, radius, CELL_COLOR)


def _seen_by(scene: HasObjects, camera: Any) -> "Camera | None":  # noqa: ANN401
    """Return the camera that is given, or that of the scene, which has maybe none."""
    if camera is None:
        return scene.camera
    from vtray.scene.camera import Camera

    found: Camera = argument("add_particles", "camera", camera, Camera)
    return found


def _plain(given: Any) -> Any:  # noqa: ANN401
    """Return a truth of NumPy as Python's own, and all else as it is."""
    return bool(given) if isinstance(given, np.bool_) else given


def _number(
    value: Any,  # noqa: ANN401
    name: str,
    least: float = 0.0,
    most: float = np.inf,
    words: str = "a number > 0",
) -> float:
    """Return a number > 0 between two limits, as words say."""
    number = number_of(value)
    if not (0.0 < number < np.inf and least <= number <= most):
        raise SceneError(f"{name}: expected {words}, got {show(value)}")
    return number
