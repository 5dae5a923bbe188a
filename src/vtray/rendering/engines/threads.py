"""The engine of threads: they take tiles from a queue, and write to one film."""

from collections.abc import Callable, Sequence

import numpy as np

from vtray.base.compiler.compiled import pinned
from vtray.base.pool import Progress, run_tasks
from vtray.base.tiles import Tile
from vtray.geometry.packets.packet import new_packet
from vtray.geometry.packets.workspace import new_workspace
from vtray.rendering.engines.engine import Cast, Done
from vtray.transport.film import Film
from vtray.transport.integrators.direct import trace_tile
from vtray.transport.lights.crowd import sharing_lights
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import SceneArrays, depth_of


class Threads:
    """Threads of this process.

    Parameters
    ----------
    threads
        How many to use at the most.
    """

    def __init__(self, threads: int) -> None:
        self._threads = threads

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
        world, places = pinned(scene), pinned(sampling)
        sharing = sharing_lights(scene.lights.crowd)
        canvas, flag = pinned(film), pinned(stop)

        def new_worker() -> Callable[[Tile], None]:
            packet, work = (
                pinned(new_packet()),
                pinned(new_workspace(scene.world, sharing, depth_of(scene))),
            )

            def trace_one(tile: Tile) -> None:
                results.append(trace_tile(world, places, *tile, canvas, packet, work, flag))
                if done is not None and not stop[0]:
                    done(tile)

            return trace_one

        def hurry() -> None:
            stop[0] = True

        run_tasks(tiles, new_worker, self._threads, stop=hurry, progress=progress)
        return Cast(max(peak for peak, _ in results), sum(rays for _, rays in results))
