"""Hierarchies of spheres alone."""

from typing import Any, NamedTuple

from numpy.typing import NDArray

from vtray.base.pool import Progress
from vtray.geometry.bvh.build import build
from vtray.geometry.bvh.tree import Bvh, Frame
from vtray.geometry.shapes.columns import Columns
from vtray.geometry.shapes.sphere_columns import GivenSpheres


class Built(NamedTuple):
    """A hierarchy, and its spheres in the order of the leaves."""

    leaves: Columns
    bvh: Bvh
    frame: Frame
    tree_depth: int
    largest: float


def build_spheres(
    center: NDArray[Any], radius: NDArray[Any], threads: int, progress: Progress | None = None
) -> Built:
    """Build the hierarchy of spheres."""
    spheres = GivenSpheres(center, radius)
    tree = build(spheres, threads, progress)
    return Built(
        Columns(spheres.data, tree.numbers), tree.bvh, tree.frame, tree.tree_depth, tree.largest
    )
