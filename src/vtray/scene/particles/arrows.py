"""Arrows for vectors: a shaft, which is a cylinder, and a head, which is a cone, for each."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from vtray.base.errors import SceneError
from vtray.scene.checks.choices import is_one_of
from vtray.scene.checks.columns import POINT, RADIUS, check_arrays
from vtray.scene.checks.limits import Positive
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.cones import Cones
from vtray.scene.cylinders import Cylinders

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from vtray.scene.colors.color_scale import ColorMap
    from vtray.scene.colors.names import AnyColor
    from vtray.scene.objects import Object

    Floats = NDArray[np.float64]
else:
    Floats = Any

CALL = "add_arrows: "

PIVOTS = {"tail": 0.0, "middle": 0.5, "tip": 1.0}
"""What is at the position of an arrow, as a share of its length."""

THINNESS = 0.05
"""Radius of the shafts, as a share of the median length, where it is not given."""

HEAD_WIDTH, HEAD_LENGTH = 2.5, 6.0
"""Radius and length of a head, in radii of its shaft."""

MOST_HEAD = 0.5
"""The largest part of its length that the head of an arrow has: shorter arrows are smaller ones."""


class Arrows(NamedTuple):
    """What arrows are made of, one row for each; those of length 0 are never seen.

    Attributes
    ----------
    shafts : Cylinders
        From the tails into the heads.
    heads : Cones
        From there to the tips.
    """

    shafts: Cylinders
    heads: Cones


class AddingArrows:
    """Adds arrows to the objects of a scene."""

    __slots__ = ()

    if TYPE_CHECKING:
        objects: list[Object]

    @explain_unknown
    def add_arrows(
        self,
        positions: "ArrayLike",
        vectors: "ArrayLike",
        scale: float = 1.0,
        radius: "ArrayLike | None" = None,
        color: "AnyColor | ArrayLike | Sequence[AnyColor] | None" = None,
        lambert: "ArrayLike" = 1.0,
        *,
        pivot: Literal["tail", "middle", "tip"] = "tail",
        cmap: "ColorMap | None" = None,
        clim: tuple[float, float] | None = None,
        nan_color: "AnyColor" = "gray",
    ) -> Arrows:
        """Add an arrow for each of many vectors: velocities, forces, spins.

        Parameters
        ----------
        positions
            Where they are, in world space, (n, 3).
        vectors
            Where they point, (n, 3), finite. Those of length 0 leave nothing to be seen.
        scale
            Length of an arrow in scene units, for a vector of length 1, > 0.
        radius
            Radius of the shafts in scene units, (n,), or one for all, ≥ 0; by default 0.05 times
            the median length of the arrows that have one. Heads are 2.5 times as wide, and 6 radii
            long; an arrow that is less than twice as long as that is a smaller one as a whole.
        color
            The colours, in any of the ways of `add_spheres`. By default white or, with `cmap`, by
            the lengths of the vectors, not multiplied by `scale`.
        lambert
            Share of the light that the surfaces scatter, from 0 to 1, (n,), or one for all.
        pivot
            What of an arrow is at its position: "tail", "middle" or "tip".
        cmap, clim, nan_color
            As for `add_spheres`.

        Returns
        -------
        Arrows
            What was added: its `shafts` and `heads`, whose rows are those of the positions.

        Raises
        ------
        SceneError
            If an argument is not right. The message names the place, for instance
            ``add_arrows: vectors[17, 2]``.

        Examples
        --------
        >>> import vtray
        >>> scene = vtray.Scene()
        >>> vectors = [(0, 0, 1), (0, 0, 2)]
        >>> arrows = scene.add_arrows([(0, 0, 0), (1, 0, 0)], vectors, color="tomato")
        >>> arrows.heads.end.tolist()
        [[0.0, 0.0, 1.0], [1.0, 0.0, 2.0]]
        """
        from vtray.scene.checks.scene_check import from_code

        given = {"positions": positions, "vectors": vectors}
        columns = {"positions": POINT, "vectors": POINT}
        if radius is not None:
            given["radius"], columns["radius"] = radius, RADIUS
        found = check_arrays(columns, given, CALL)
        factor = from_code(scale, Positive, f"{CALL}scale")
        if not is_one_of(pivot, PIVOTS):
            words = ", ".join(f'"{name}"' for name in PIVOTS)
            raise SceneError(f"{CALL}pivot: expected one of {words}, got {pivot!r}")
        lengths, ways = _lengths_and_ways(found["vectors"])
        if color is None:
            color = "white" if cmap is None else lengths
        geometry = _geometry(found, factor * lengths, ways, PIVOTS[pivot])
        shaft, head = ({**part, "lambert": lambert} for part in geometry)
        colors = {"cmap": cmap, "clim": clim, "nan_color": nan_color}
        shafts = Cylinders.colored(shaft, {"color": color}, CALL, **colors)  # type: ignore[arg-type]
        same = {"cmap": None, "clim": None, "nan_color": nan_color}
        heads = Cones.colored(head, {"color": shafts.color}, CALL, **same)  # type: ignore[arg-type]
        arrows = Arrows(shafts, heads.with_scale(shafts.color_scale))
        self.objects.extend(arrows)
        return arrows


def _lengths_and_ways(vectors: "NDArray[Any]") -> tuple[Floats, Floats]:
    """Return the lengths of vectors, (n,), and their unit directions, (n, 3); 0 for none."""
    import numpy as np

    vectors = vectors.astype(np.float64)
    # In parts of the largest coordinate, so that no square overflows.
    largest = np.abs(vectors).max(axis=1, initial=0.0)
    parts = vectors / np.where(largest > 0, largest, 1.0)[:, np.newaxis]
    x, y, z = parts.T
    lengths = np.sqrt(x * x + y * y + z * z)
    ways = parts / np.where(lengths > 0, lengths, 1.0)[:, np.newaxis]
    return lengths * largest, ways


def _geometry(
    found: dict[str, Any], lengths: Floats, ways: Floats, pivot: float
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the geometry of shafts and of heads, for arrows so long in such directions."""
    import numpy as np

    seen = lengths[lengths > 0]
    radius = found.get("radius")
    if radius is None:
        radius = THINNESS * float(np.sort(seen)[len(seen) // 2]) if len(seen) else 0.0
    head = HEAD_LENGTH * np.broadcast_to(np.asarray(radius, np.float64), len(lengths))
    room = MOST_HEAD * lengths
    share = np.where(head > room, room, head) / np.where(head > 0, head, 1.0)
    radii, head = radius * share, head * share
    start = found["positions"] - pivot * lengths[:, np.newaxis] * ways
    # Into the middle of the head, so that there is no seam.
    inside, neck, tip = (
        start + along[:, np.newaxis] * ways
        for along in (lengths - head / 2, lengths - head, lengths)
    )
    shaft = {"start": start, "end": inside, "radius": radii}
    return shaft, {"start": neck, "end": tip, "radius": HEAD_WIDTH * radii, "radius_end": 0.0}
