"""vtray, from arrays to an .mp4: see movie_clock.py for the arguments.

With PROCESSES, workers of a Dask cluster take the pictures, each with a thread.
"""

import contextlib
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))  # for `peers`
from peers.movie_clock import COLOR, FPS, RADIUS, Movie, time_movie

TOWARDS_LIGHT = (2.0, -1.7, 2.6)
"""In sides of the cube."""


def main() -> None:
    """Make the movie."""
    import vtray as vt

    with contextlib.ExitStack() as stack:
        client = None
        if len(sys.argv) > 6:
            from distributed import Client, LocalCluster

            cluster = LocalCluster(
                n_workers=int(sys.argv[6]), threads_per_worker=1, dashboard_address=":0"
            )
            client = stack.enter_context(Client(stack.enter_context(cluster)))

        def make(movie: Movie) -> None:
            length = float(movie.start.max())
            size = movie.side, movie.side
            camera = vt.Camera.fit(movie.start, view="iso", size=size)
            light = vt.Light([length * part for part in TOWARDS_LIGHT])

            def scene(k: int) -> vt.Scene:
                made = vt.Scene(camera, [light])
                made.add_spheres(movie.start + k * movie.step, RADIUS, color=COLOR)
                return made

            threads = None if client is not None else movie.threads
            vt.animate(
                *(scene, movie.output),
                frames=movie.frames,
                fps=FPS,
                threads=threads,
                client=client,
            )

        def seconds_of_workers() -> float:
            return 0.0 if client is None else sum(client.run(time.process_time).values())

        time_movie(make, seconds_of_workers)


if __name__ == "__main__":
    main()
