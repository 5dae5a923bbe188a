"""How long each renderer takes for a scene, and vtray with more and more threads."""

import json
from pathlib import Path
from typing import NamedTuple

import vtray_process
from camera_space import View, view_from_eye
from measure import Job, Timing, run_interleaved
from peers import PEERS, Peer, is_installed
from same_picture import difference, is_same
from scenes import Json

import vtray

THREADS = (1, 2)


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
    view = _view(scene)
    jobs = [_vtray_job(scene, threads) for threads in THREADS]
    for peer in filter(is_installed, PEERS):
        jobs += _peer_jobs(peer, view, folder)
    timings = run_interleaved(jobs, repeats)
    return [
        _row(folder, name, threads, timings)
        for name in (vtray_process.NAME, *(peer.NAME for peer in PEERS))
        for threads in THREADS
    ]


def time_threads(document: Json, folder: Path, counts: list[int], repeats: int) -> list[Timing]:
    """Time vtray on a scene with several numbers of threads."""
    scene = folder / "scene.json"
    scene.write_text(json.dumps(document))
    jobs = [_vtray_job(scene, threads) for threads in counts]
    timings = run_interleaved(jobs, repeats)
    return [timings[job.name] for job in jobs]


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
    return Job(name, command, vtray_process.trace_seconds)


def _peer_jobs(peer: Peer, view: View, folder: Path) -> list[Job]:
    """Write the scene for another renderer; return what is to be run."""
    scene = (folder / "scene").with_suffix(peer.ENDING)
    scene.write_text(peer.export(view))
    size = (view.width, view.height)
    names = {threads: _job_name(peer.NAME, threads) for threads in THREADS}
    return [
        Job(name, peer.command(scene, _picture(folder, name), count, size), peer.trace_seconds)
        for count, name in names.items()
    ]


def _row(folder: Path, program: str, threads: int, timings: dict[str, Timing]) -> Row:
    """Return the times of a renderer, if it is there and its picture is the same."""
    name = _job_name(program, threads)
    if name not in timings:
        return Row(program, threads, None, "not installed")
    ours = _picture(folder, _job_name(vtray_process.NAME, THREADS[0]))
    column = next((peer.COLUMN for peer in PEERS if program == peer.NAME), 0)
    found = difference(ours, _picture(folder, name), column)
    if not is_same(found):
        return Row(program, threads, None, f"another picture: {found}")
    return Row(program, threads, timings[name], str(found))


def _picture(folder: Path, name: str) -> Path:
    return folder / f"{name}.png"
