"""The engine of threads: they take tiles from a queue, and write to one film."""

from collections.abc import Callable, Sequence

import numpy as np

from vtray.base.compiler.compiled import pinned
from vtray.base.pool import Progress, run_tasks
from vtray.base.tiles import NO_TILE, Tile
from vtray.geometry.packets.packet import Packet
from vtray.geometry.packets.workspace import Workspace
from vtray.rendering.engines.engine import Cast, Done
from vtray.transport.film import Film
from vtray.transport.integrators.direct import trace_tile
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import SceneArrays, new_memory


class Threads:
    """Threads of this process.

    Parameters
    ----------
    threads
        How many to use at the most.
    """

    def __init__(self, threads: int) -> None:
        self._threads = threads
        # The scene, taken apart once for all passes of a picture, and the memory of each thread.
        self._scene: SceneArrays | None = None
        self._pinned: SceneArrays | None = None
        self._memory: list[tuple[Packet, Workspace]] = []

    def trace(
        self,
        scene: SceneArrays,
        sampling: Sampling,
        tiles: Sequence[Tile],
        film: Film,
        progress: Progress | None = None,
        done: Done | None = None,
    ) -> Cast:
        """Trace tiles; see `Engine.trace`. If one fails, or on Ctrl-C, the others are given up."""
        stop = np.zeros(1, np.bool_)
        results: list[tuple[float, int]] = []
        world, spare = self._begin(scene)
        places, canvas, flag = pinned(sampling), pinned(film), pinned(stop)
        # This thread compiles or loads what all others then have.
        trace_tile(world, places, *NO_TILE, canvas, *spare[0], flag)

        def new_worker() -> Callable[[Tile], None]:
            try:
                packet, work = spare.pop()
            except IndexError:  # more threads than there were for the passes before
                packet, work = self._new_memory(scene)

            def trace_one(tile: Tile) -> None:
                results.append(trace_tile(world, places, *tile, canvas, packet, work, flag))
                if done is not None and not stop[0]:
                    done(tile)

            return trace_one

        def hurry() -> None:
            stop[0] = True

        run_tasks(tiles, new_worker, self._threads, stop=hurry, progress=progress)
        return Cast(max(peak for peak, _ in results), sum(rays for _, rays in results))

    def _begin(self, scene: SceneArrays) -> tuple[SceneArrays, list[tuple[Packet, Workspace]]]:
        """Return what kernels take for a scene, and memory for some threads, at least for one."""
        if self._pinned is None or scene is not self._scene:
            self._scene, self._pinned, self._memory = scene, pinned(scene), []
            self._new_memory(scene)
        return self._pinned, [*self._memory]

    def _new_memory(self, scene: SceneArrays) -> tuple[Packet, Workspace]:
        """Return memory for one more thread."""
        packet, work = new_memory(scene)
        made = pinned(packet), pinned(work)
        self._memory.append(made)
        return made
