"""How long each renderer takes for a scene, and vtray with more and more threads."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import vtray
from peers.camera_space import View, view_from_eye
from peers.peer import Peer
from peers.programs import PEERS, is_installed
from scenes.cube import write_cube
from scenes.few_objects import Json
from timing import vtray_process
from timing.jobs import Job, Timing, run_interleaved
from timing.same_picture import difference, is_same

THREADS = (1, 2)
Writer = Callable[[View, Path], Path]


class Row(NamedTuple):
    """One renderer with one number of threads; `note` says how its picture compares."""

    program: str
    threads: int
    timing: Timing | None
    note: str


def time_scene(document: Json, folder: Path, repeats: int) -> list[Row]:
    """Time all renderers on a scene."""
    scene = folder / "scene.json"
    scene.write_text(json.dumps(document))
    return time_file(scene, PEERS, THREADS, repeats)


def time_cube(
    count: int, side: int, peers: Sequence[Peer], threads: Sequence[int], folder: Path, repeats: int
) -> list[Row]:
    """Time renderers on a cube of spheres."""
    return time_file(write_cube(count, folder, side), peers, threads, repeats)


def time_threads(scene: Path, counts: Sequence[int], repeats: int) -> list[Timing]:
    """Time vtray on a scene file with several numbers of threads."""
    jobs = [_vtray_job(scene, threads) for threads in counts]
    timings = run_interleaved(jobs, repeats)
    return [timings[job.name] for job in jobs]


def time_file(
    scene: Path, peers: Sequence[Peer], threads: Sequence[int], repeats: int
) -> list[Row]:
    """Time vtray and other renderers on a scene file; what they write goes beside it."""
    view = _view(scene)
    jobs = [_vtray_job(scene, count) for count in threads]
    written: dict[Writer, Path] = {}
    for peer in filter(is_installed, peers):
        if peer.write_scene not in written:
            written[peer.write_scene] = peer.write_scene(view, scene.parent)
        size = (view.width, view.height)
        jobs += [_peer_job(peer, written[peer.write_scene], size, count) for count in threads]
    timings = run_interleaved(jobs, repeats)

    ours = _picture(scene.parent, _job_name(vtray_process.NAME, threads[0]))
    rows = [_own_row(ours, count, timings) for count in threads]
    return rows + [_row(ours, peer, count, timings) for peer in peers for count in threads]


def _view(path: Path) -> View:
    """Return a scene for the other renderers, as bright as vtray's exposure makes it."""
    scene = vtray.load(path)
    peak = float(vtray.render(scene).linear.max())
    return view_from_eye(scene, 255 / peak if peak > 0 else 1.0)


def _job_name(program: str, threads: int) -> str:
    return f"{program}-{threads}"


def _vtray_job(scene: Path, threads: int) -> Job:
    name = _job_name(vtray_process.NAME, threads)
    command = vtray_process.command(scene, _picture(scene.parent, name), threads)
    return Job(name, command, vtray_process.trace_seconds, phases=vtray_process.phases)


def _peer_job(peer: Peer, scene: Path, size: tuple[int, int], threads: int) -> Job:
    name = _job_name(peer.name, threads)
    command = peer.command(scene, _picture(scene.parent, name), threads, size)
    return Job(name, command, lambda output: peer.phases(output).trace, phases=peer.phases)


def _own_row(ours: Path, threads: int, timings: Mapping[str, Timing]) -> Row:
    """Return vtray's times; with any number of threads, its picture should be the same."""
    name = _job_name(vtray_process.NAME, threads)
    found = difference(ours, _picture(ours.parent, name))
    return Row(vtray_process.NAME, threads, timings[name], str(found))


def _row(ours: Path, peer: Peer, threads: int, timings: Mapping[str, Timing]) -> Row:
    """Return the times of a renderer, if it is there and its picture counts."""
    name = _job_name(peer.name, threads)
    if name not in timings:
        return Row(peer.name, threads, None, "not installed")
    found = difference(ours, _picture(ours.parent, name), peer.column)
    if is_same(found):
        return Row(peer.name, threads, timings[name], str(found))
    note = f"another picture: {peer.apart or found}"
    return Row(peer.name, threads, timings[name] if peer.apart else None, note)


def _picture(folder: Path, name: str) -> Path:
    return folder / f"{name}.png"
