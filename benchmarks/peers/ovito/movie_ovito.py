"""OVITO, from arrays to an .mp4 by `render_anim`: see movie_clock.py for the arguments.

Its light comes from a place of its own.
"""

import os
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.arrays_clock import hold_to_cores
from peers.movie_clock import COLOR, FPS, RADIUS, Movie, time_movie


def make(movie: Movie) -> None:
    """Make the movie with the Tachyon renderer."""
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline, StaticSource
    from ovito.vis import TachyonRenderer, Viewport

    data = DataCollection()
    particles = data.create_particles(count=len(movie.start))
    particles.create_property("Position", data=movie.start)
    particles.create_property("Color", data=[[part / 255 for part in COLOR]] * len(movie.start))
    particles.vis.radius = RADIUS

    def move(frame: int, moved: DataCollection) -> None:
        moved.particles_.positions_[...] = movie.start + frame * movie.step

    pipeline = Pipeline(source=StaticSource(data=data))
    pipeline.modifiers.append(move)
    pipeline.add_to_scene()
    size = movie.side, movie.side
    view = Viewport(type=Viewport.Type.Perspective, camera_dir=(-1, -1, -1))
    view.zoom_all(size=size)
    renderer = TachyonRenderer(antialiasing=False, ambient_occlusion=False, shadows=True)
    last = movie.frames - 1
    view.render_anim(filename=movie.output, size=size, fps=FPS, range=(0, last), renderer=renderer)
    pipeline.remove_from_scene()


if __name__ == "__main__":
    # Its renderers take all cores that they find, whatever they are told.
    hold_to_cores(int(sys.argv[4]))
    os.environ["OVITO_THREAD_COUNT"] = sys.argv[4]
    time_movie(make, lambda: 0.0)
