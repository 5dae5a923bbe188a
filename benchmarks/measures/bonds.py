"""What bonds cost: vtray with the atoms of a ball-and-stick model alone, and with their bonds."""

from collections.abc import Sequence
from pathlib import Path

from measures.own_scenes import ByThreads, time_own_scenes
from scenes.ball_and_stick import write_scenes


def time_bonds(
    count: int, threads: Sequence[int], folder: Path, repeats: int
) -> dict[str, ByThreads]:
    """Time vtray on so many atoms, and on these and twice as many bonds."""
    scenes = write_scenes(count, folder)
    named = {
        f"{count:,} atoms": scenes["atoms"],
        f"{count:,} atoms, {2 * count:,} bonds": scenes["bonds"],
    }
    return time_own_scenes(named, threads, repeats)
