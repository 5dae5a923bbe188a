"""Pictures of a movie that the workers of a Dask cluster take.

A few for each worker are on their way at a time, so that memory does not grow with the movie. What
a worker had that dies, the scheduler gives to another. Pictures come back as files, and stay here.
"""

import contextlib
import pickle
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from vtray.animation.coming import Coming
from vtray.animation.done import Done
from vtray.animation.film import Film
from vtray.animation.script import Script, Take
from vtray.animation.stage import Stage
from vtray.animation.unit import Taken, Unit, take_picture, unpacked
from vtray.base.atomic_file import write_whole
from vtray.base.errors import RenderError, VtrayError
from vtray.base.extras import need
from vtray.base.version import __version__
from vtray.scene.scene import Scene

PER_WORKER = 2
"""Pictures that a worker has: one is traced while the next is read, or the last is packed."""

PATIENCE = 1.0
"""Seconds after which the cluster is looked at again."""

LARGEST = {"distributed.admin.large-graph-warning-threshold": "100 TB"}
"""What is sent with a task before Dask warns of it: scenes are as large as they are."""


def connect(address: str, timeout: float = 10.0) -> Any:  # noqa: ANN401
    """Return a client of the cluster whose scheduler is at an address, or in a file of its own.

    Raises
    ------
    ExtraError
        distributed is not installed.
    RenderError
        The scheduler cannot be reached.
    """
    distributed: Any = need("distributed", "dask", "--dask")
    key = "address"
    if address.endswith(".json"):
        key = "scheduler_file"
        if not Path(address).is_file():  # it would be waited for without end
            raise RenderError(f"--dask: {address}: there is no such scheduler file")
    try:
        return distributed.Client(**{key: address}, timeout=timeout, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        words = f"no scheduler of Dask can be reached there: {reason}"
        raise RenderError(f"--dask: {address}: {words}") from None


def check_client(client: Any) -> None:  # noqa: ANN401
    """Raise an error if a client cannot be used.

    Parameters
    ----------
    client
        What is given as such.

    Raises
    ------
    ExtraError
        distributed is not installed.
    RenderError
        It is none, there are no workers, or their vtray is of another version.
    """
    distributed: Any = need("distributed", "dask", "client")
    if not isinstance(client, distributed.Client) or client.asynchronous:
        words = "expected a distributed.Client, not an asynchronous one"
        raise RenderError(f"client: {words}, got {type(client).__name__}")
    if client.status in ("closing", "closed"):
        raise RenderError(f"client: expected one that is connected, and it is {client.status}")

    def version() -> str:  # as it is no function of a module, it travels as code
        try:
            from vtray.base.version import __version__
        except ImportError:
            return ""
        return __version__

    found = client.run(version)
    if not found:
        words = "start some, or wait for them by client.wait_for_workers(1)"
        raise RenderError(f"{_place(client)}: the cluster has no workers; {words}")
    for address, there in found.items():
        if there != __version__:
            what = f"vtray {there}" if there else "no vtray"
            raise RenderError(f"{address}: this worker has {what}, and here is {__version__}")


def take_elsewhere(
    film: Film, script: Script, done: Done, stage: Stage, check: Callable[[], None]
) -> None:
    """Let workers take all pictures that are missing; `check` raises what goes wrong here.

    Parameters
    ----------
    film, script
        The movie.
    done
        Its pictures that are done.
    stage
        Where the last of these is compared with its scene.
    check
        Raises what goes wrong with the movie.

    Raises
    ------
    RenderError
        The cluster cannot be used, or ends.
    """
    from distributed import CancelledError
    from distributed.comm.core import CommClosedError

    client, place = film.client, _place(film.client)
    flight = None
    try:
        flight = _Flight(film, script, done, stage, check)
        flight.go()
    except (Exception, CancelledError) as error:
        is_cut = isinstance(error, (CommClosedError, CancelledError))
        if not is_cut and (isinstance(error, VtrayError) or client.status == "running"):
            raise
        raise RenderError(f"{place}: the cluster has ended") from error
    finally:
        if flight is not None:
            flight.end()


class _Flight:
    """Pictures on their way."""

    def __init__(
        self, film: Film, script: Script, done: Done, stage: Stage, check: Callable[[], None]
    ) -> None:
        self._film, self._script, self._done, self._stage = film, script, done, stage
        self._check = check
        self._holds = stage.holds()  # all frames of particles are drawn alike
        self._landed: SimpleQueue[Any] = SimpleQueue()
        self._flying: dict[Any, int] = {}
        self._unseen = script.source.stored is None
        self._looked_at = 0.0
        self._workers = 0
        ending = film.output.name(0).suffix
        unit = Unit(film.look, script.make, stage.common, ending, script.source.stored)
        self._unit = self._keep(unit)
        self._one = self._keep(script.first) if script.source.repeats else None

    def go(self) -> None:
        """Have all pictures taken."""
        with ThreadPoolExecutor(1) as maker:
            is_bound = self._script.source.is_bound
            coming = Coming(self._takes(), None if is_bound else maker)
            while (take := coming.take()) is not None:
                self._send_in_time(take)
                del take
            while self._flying:
                self._land()

    def end(self) -> None:
        """Let no more be taken."""
        with contextlib.suppress(Exception):  # the cluster may be gone
            if self._flying and self._film.client.status == "running":
                self._film.client.cancel([*self._flying])
        self._flying.clear()

    def _takes(self) -> Iterator[Take]:
        """Give what is to be taken, after the last that is done is compared with its scene."""
        script, done = self._script, self._done
        k = max(done.count - 1, 0)
        if self._unseen:
            coming = script.takes(k)
            if done.count:
                self._check_last(next(coming, None))
        else:
            coming = script.takes_in_file(done.count)
            if done.count:
                self._check_last(script.take_again(k) if k < script.total else None)
        k = done.count
        for take in coming:
            if self._unseen and take.item is None:
                break
            if take.k not in done:
                yield take
            k = take.k + 1
        else:
            return
        # There is a worker that does not see the file.
        for take in script.takes(k):
            if take.k not in done:
                yield take

    def _check_last(self, take: Take | None) -> None:
        shot = None if take is None else take.shot(self._script.make)
        self._film.check_last(self._stage, shot)

    def _send_in_time(self, take: Take) -> None:
        """Have a picture taken when its turn has come."""
        self._film.tell(len(self._done), self._script.total)
        if self._waits(take):
            while self._flying:
                self._land()
        while len(self._flying) >= PER_WORKER * max(self._count_workers(), 1):
            self._land()
        waits = self._waits(take)
        self._send(take)
        while waits and self._flying:
            self._land()

    def _waits(self, take: Take) -> bool:
        """Tell whether a picture may decide the exposure of those that follow."""
        if self._done.white is not None:
            return False
        is_scene = isinstance(take.item, Scene)
        return self._film.look.holds(take.item) if is_scene else self._holds

    def _send(self, take: Take) -> None:
        """Give a picture to the cluster."""
        import dask

        take = take if self._one is None else take._replace(item=None)
        packed = pickle.dumps(take, protocol=5)
        with dask.config.set(LARGEST):
            future = self._film.client.submit(
                take_picture,
                __version__,
                self._unit,
                packed,
                self._one,
                self._done.white,
                pure=False,
            )
        self._flying[future] = take.k
        future.add_done_callback(self._landed.put)

    def _land(self) -> None:
        """Wait for a picture, and write its file."""
        while True:
            self._check()
            try:
                future = self._landed.get(timeout=PATIENCE)
                break
            except Empty:
                self._count_workers()
        k = self._flying.pop(future)
        taken = self._result(future, k)
        if taken is None:
            self._unseen = True
            self._send(self._script.take_again(k))
            return
        film = self._film
        for message in taken.warnings:
            film.warn(message)
        with self._script.source.of_picture(k):
            film.check_size(taken.shape)
        if taken.white is not None:
            self._done.white = taken.white
        write_whole(film.output.name(k), lambda file: file.write(taken.content))
        film.accept(k)
        film.tell(len(self._done), self._script.total)

    def _result(self, future: Any, k: int) -> Taken | None:  # noqa: ANN401
        """Return what a task gives; raise what went wrong in it."""
        from distributed.scheduler import KilledWorker

        try:
            found: Taken | None = future.result()
        except KilledWorker as error:
            words = f"{error.allowed_failures + 1} workers have died of it; is memory too small?"
            raise RenderError(f"picture {k}: {words}") from None
        return found

    def _keep(self, what: Any) -> Any:  # noqa: ANN401
        """Return what stands for something that workers keep: each gets it once."""
        import dask

        with dask.config.set(LARGEST):
            packed = pickle.dumps(what, protocol=5)
            return self._film.client.submit(unpacked, packed, pure=False)

    def _count_workers(self) -> int:
        """Return how many workers there are."""
        now = time.monotonic()
        if now - self._looked_at >= PATIENCE:
            client = self._film.client
            self._workers = len(client.nthreads())
            self._looked_at = now
            if not self._workers:
                self._film.warn(f"{_place(client)}: the cluster has no workers; waiting for some")
        return self._workers


def _place(client: Any) -> str:  # noqa: ANN401
    """Return the address of a scheduler."""
    return str(client.scheduler.address if client.scheduler else "client")
