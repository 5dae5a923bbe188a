"""What copies cost: vtray with spheres alone and at many places, as copies and written out."""

from collections.abc import Sequence
from pathlib import Path

from measures.own_scenes import ByThreads, time_own_scenes
from scenes.copied_cube import write_scenes

FEW, MANY = 4, 10
"""Places along each of the three axes: of what is written out, too, and of what is only copied."""


def time_copies(
    count: int, threads: Sequence[int], folder: Path, repeats: int
) -> dict[str, ByThreads]:
    """Time vtray on so many spheres, alone and at places."""
    return time_own_scenes(write_scenes(count, FEW, MANY, folder), threads, repeats)
