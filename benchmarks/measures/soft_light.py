"""Soft light: whether it is right, beside Mitsuba where that is installed, and what it costs."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import vtray
from peers.host import host
from peers.host.soft_scene import write_scene
from peers.mitsuba import program as mitsuba
from peers.peer import python_of_peers
from peers.programs import is_installed
from scenes import clouds
from scenes.lamps import for_mitsuba, lamp_scene, lamps, sky_scene
from timing import vtray_process
from timing.jobs import Job, Spread, run_interleaved, run_once

Floats = NDArray[np.float64]

DIRECT = mitsuba.SCRIPT.with_name("mitsuba_soft.py")
DR_JIT = mitsuba.SCRIPT.with_name("mitsuba_sky.py")
WHITE = 255.0
FINE = 2e-3
"""The tolerance of pictures that others are compared with: from each point, nearly all the fans."""
FAR_ERRORS = 4.0
ROUNDING = 1e-5
"""What Mitsuba's numbers of 24 bits may do to a pixel, 1 for white."""
TOLERANCES = (1.0, 0.03, 0.008)
"""What the sky is timed with: for 1, each point has one fan of 64 rays."""
THEIRS = (
    ("Mitsuba, `direct`", DIRECT, 16),
    ("Mitsuba, shading in Dr.Jit", DR_JIT, 16),
    ("Mitsuba, shading in Dr.Jit", DR_JIT, 64),
    ("Mitsuba, shading in Dr.Jit", DR_JIT, 256),
)
"""What the others are timed with: what it is called, the script, and samples a pixel."""
EVERY = 4
"""The errors under the sky are those of one pixel in so many, across and down."""
WARM = 2
"""How many pictures Mitsuba makes, of which the last is timed."""


class Sizes(NamedTuple):
    """How much is measured.

    Attributes
    ----------
    seeds
        How many pictures of each lamp vtray makes, and for each of those Mitsuba makes four.
    samples
        For each of those of Mitsuba, its samples a pixel.
    cubes, side
        Numbers of spheres under the sky, and the side of the picture.
    reference
        How many pictures are the one that is right.
    clouds, cloud_side
        The same in the studio.
    """

    seeds: int
    samples: int
    cubes: tuple[int, ...]
    side: int
    reference: int
    clouds: tuple[int, ...]
    cloud_side: int


FULL = Sizes(8, 64, (100_000, 1_000_000), 512, 4, (1_000, 10_000, 100_000), clouds.SIDE)
QUICK = Sizes(2, 16, (10_000,), 128, 1, (1_000,), 256)


class Difference(NamedTuple):
    """How far Mitsuba's picture is from vtray's, in shares of white.

    Attributes
    ----------
    mean
        The mean of vtray's less that of Mitsuba's.
    mean_error
        Its standard error.
    pixel_error
        The standard error of the difference of a pixel, on average.
    far
        The share of pixels that are off by more than `FAR_ERRORS` times their own.
    """

    mean: float
    mean_error: float
    pixel_error: float
    far: float


class SkyRow(NamedTuple):
    """A picture under the sky.

    Attributes
    ----------
    program, quality
        Which one, and what it was told.
    error
        Root of the mean square of what its channels are off, in shares of white.
    tracing
        For numbers of threads, the seconds.
    """

    program: str
    quality: str
    error: float
    tracing: dict[int, Spread]


class StudioRow(NamedTuple):
    """A picture in the studio.

    Attributes
    ----------
    tracing
        The seconds.
    rays
        How many were cast.
    error
        The mean of the estimated errors of pixels in which something is, in steps of 255.
    """

    tracing: Spread
    rays: int
    error: float


@dataclass
class SoftLight:
    """All that is measured here.

    Attributes
    ----------
    lamps
        For each lamp, how far Mitsuba is from vtray; None if it is not installed.
    sky
        For each scene under the sky, the pictures.
    studio
        For each scene in the studio, vtray's picture.
    """

    lamps: dict[str, Difference | None]
    sky: dict[str, list[SkyRow]]
    studio: dict[str, StudioRow]


def measure_soft_light(
    sizes: Sizes, threads: Sequence[int], folder: Path, repeats: int
) -> SoftLight:
    """Measure all of it; the studio with as many threads as there may be."""
    return SoftLight(
        compare_lamps(sizes, threads[-1], folder),
        {
            f"{count:,} spheres, {sizes.side} x {sizes.side}": time_sky(
                count, sizes, threads, folder, repeats
            )
            for count in sizes.cubes
        },
        time_studio(sizes, threads[-1], folder, repeats),
    )


def compare_lamps(sizes: Sizes, threads: int, folder: Path) -> dict[str, Difference | None]:
    """Compare Mitsuba's picture of each lamp with vtray's."""
    if not is_installed(mitsuba.PEER):
        return dict.fromkeys(lamps())
    found: dict[str, Difference | None] = {}
    for name, lamp in lamps().items():
        scene = lamp_scene(lamp.light)
        ours = [_light(scene, FINE, seed, threads) for seed in range(sizes.seeds)]
        path = folder / "lamp.npz"
        write_scene(for_mitsuba(scene, lamp), path)
        run_once(_mitsuba_job(path, threads, sizes.samples, 4 * sizes.seeds))
        found[name] = difference(np.stack(ours), np.load(_mitsuba_picture(path, sizes.samples)))
    return found


def difference(ours: Floats, theirs: Floats) -> Difference:
    """Compare the means of pictures with other random numbers, (pictures, height, width, 3)."""
    off = _mean(ours) - _mean(theirs)
    error = np.hypot(_error(ours), _error(theirs))
    each_mean = [pictures.mean(axis=(1, 2, 3), dtype=np.float64) for pictures in (ours, theirs)]
    is_far = np.abs(off) > FAR_ERRORS * error + ROUNDING
    return Difference(
        mean=float(off.mean()),
        mean_error=math.hypot(*(float(_error(means)) for means in each_mean)),
        pixel_error=float(error.mean()),
        far=float(is_far.any(axis=-1).mean()),
    )


def time_sky(
    count: int, sizes: Sizes, threads: Sequence[int], folder: Path, repeats: int
) -> list[SkyRow]:
    """Time vtray and Mitsuba on the cube of so many spheres under a sky."""
    scene = sky_scene(count, sizes.side)
    path = folder / f"sky-{count}.json"
    scene.save(path)
    theirs = folder / f"sky-{count}-mitsuba.npz"
    # A surface that chooses rays by the cosine finds a sky of one colour best.
    write_scene(for_mitsuba(scene, lamps()["sky"], emitter_samples=0), theirs)
    there = is_installed(mitsuba.PEER)
    ours = {(t, n): _sky_job(path, t, n) for t in TOLERANCES for n in threads}
    others = {
        (script, samples, n): _mitsuba_job(theirs, n, samples, WARM, script)
        for _, script, samples in THEIRS
        for n in threads
        if there
    }
    # What is compiled for the first picture is on disk afterwards.
    for job in [*ours.values(), *others.values()][:: len(threads)]:
        run_once(job)
    timings = run_interleaved([*ours.values(), *others.values()], repeats)

    small = scene.camera.size[0] // EVERY
    scene.render = scene.render.replace(size=(small, small))
    right = _mean([_light(scene, FINE, 1 + k, threads[-1]) for k in range(sizes.reference)])
    rows = []
    for tolerance in TOLERANCES:
        with np.load(_sky_picture(path, tolerance)) as picture:
            error = _rms(picture["linear"] / WHITE, right)
        tracing = {n: timings[ours[tolerance, n].name].inner for n in threads}
        rows.append(SkyRow(vtray_process.NAME, f"tolerance {tolerance:g}", error, tracing))
    for name, script, samples in THEIRS:
        error = math.nan
        if there:
            error = _rms(np.load(_mitsuba_picture(theirs, samples, script))[-1], right)
        tracing = {n: timings[others[script, samples, n].name].inner for n in threads if there}
        rows.append(SkyRow(name, f"{samples} samples", error, tracing))
    return rows


def time_studio(sizes: Sizes, threads: int, folder: Path, repeats: int) -> dict[str, StudioRow]:
    """Time vtray on clouds of spheres in studio light."""
    scenes = {
        f"{count:,} spheres {kind}": clouds.make_scene(kind, count, sizes.cloud_side)
        for kind in clouds.CLOUDS
        for count in sizes.clouds
    }
    jobs, errors, rays = [], {}, {}
    for name, scene in scenes.items():
        path = folder / f"{name}.json"
        scene.save(path)
        command = vtray_process.command(path, path.with_suffix(".png"), threads)
        jobs.append(Job(name, command, vtray_process.trace_seconds))
        image = vtray.render(scene, threads=threads)
        errors[name] = float(image.error[np.isfinite(image.depth)].mean())
        rays[name] = int(image.stats["rays"])
    timings = run_interleaved(jobs, repeats)
    return {name: StudioRow(timings[name].inner, rays[name], errors[name]) for name in scenes}


def _light(scene: vtray.Scene, tolerance: float, seed: int, threads: int) -> Floats:
    """Return vtray's light, in shares of white."""
    return vtray.render(scene, tolerance=tolerance, seed=seed, threads=threads).linear / WHITE


def _sky_job(scene: Path, tolerance: float, threads: int) -> Job:
    command = vtray_process.command(scene, _sky_picture(scene, tolerance), threads)
    return Job(
        f"vtray, {tolerance:g}, {threads}",
        [*command, "--tolerance", str(tolerance)],
        inner_seconds=vtray_process.trace_seconds,
    )


def _sky_picture(scene: Path, tolerance: float) -> Path:
    return scene.with_name(f"{scene.stem} {tolerance:g}.npz")


def _mitsuba_job(
    scene: Path, threads: int, samples: int, pictures: int, script: Path = DIRECT
) -> Job:
    output = _mitsuba_picture(scene, samples, script)
    arguments = [str(threads), str(scene), str(output), str(samples), str(pictures)]
    return Job(
        output.stem + f", {threads}",
        [python_of_peers(), str(script), *arguments],
        inner_seconds=host.trace_seconds,
    )


def _mitsuba_picture(scene: Path, samples: int, script: Path = DIRECT) -> Path:
    return scene.with_name(f"{scene.stem} {script.stem} {samples}.npy")


def _rms(picture: Floats, right: Floats) -> float:
    """Return how far a picture is off, where the right one has its pixels."""
    return float(np.sqrt(np.square(picture[::EVERY, ::EVERY] - right).mean()))


def _mean(pictures: Sequence[Floats] | Floats) -> Floats:
    return np.mean(pictures, axis=0, dtype=np.float64)


def _error(values: Floats) -> Floats:
    """Return the standard error of the mean along the first axis."""
    deviation: Floats = np.std(values, axis=0, ddof=1, dtype=np.float64)
    return deviation / math.sqrt(len(values))
