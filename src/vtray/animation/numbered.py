"""What gives the particles or the scene of each picture by its number."""

from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.base.caller_warning import warn_caller
from vtray.scene.particles.from_objects import from_mdanalysis, is_mdanalysis


class Numbered(NamedTuple):
    """Frames that can be had by their numbers.

    Attributes
    ----------
    length
        How many there are.
    frame
        Gives the one with a number from 0.
    """

    length: int
    frame: Callable[[int], Any]


def numbered(given: Any) -> Numbered | None:  # noqa: ANN401
    """Return the frames of a list, or of whatever else has them by numbers; None if it has not.

    These are universes and groups of atoms of MDAnalysis, pipelines of OVITO, arrays (m, n, 3),
    trajectories of ASE, MDTraj and HOOMD-blue, stacks of Biotite.
    """
    if is_mdanalysis(given):
        return _of_mdanalysis(given)
    if hasattr(getattr(given, "trajectory", given), "ts"):
        problem = "the trajectory of a universe of MDAnalysis knows no elements, bonds or cell"
        warn_caller(f"{problem}; give the universe, and frames='0:100:5' for some of them")
    source: Any = getattr(given, "source", None)
    if hasattr(given, "compute") and hasattr(source, "num_frames"):
        return Numbered(source.num_frames, given.compute)
    # What has keys, such as a table, has nothing by numbers.
    if hasattr(given, "__len__") and hasattr(given, "__getitem__") and not hasattr(given, "keys"):
        return Numbered(len(given), given.__getitem__)
    return None


def _of_mdanalysis(group: Any) -> Numbered | None:  # noqa: ANN401
    """Return the frames of the trajectory of a group of atoms; None without one."""
    trajectory = getattr(group.universe, "trajectory", None)
    if trajectory is None:
        return None

    def frame(number: int) -> Any:  # noqa: ANN401
        trajectory[number]
        return from_mdanalysis(group)

    return Numbered(len(trajectory), frame)
