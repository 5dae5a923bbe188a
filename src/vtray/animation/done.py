"""Pictures of a movie that are done: they stay until it is whole, so that another run can go on.

Beside them stands a record of what cannot be told from the pictures themselves. A run that goes on
makes the scene of the last of them again, whose hash it must have.
"""

import contextlib
import shutil
import threading
from pathlib import Path
from typing import Any

import msgspec

from vtray.animation.output import Output
from vtray.base.atomic_file import write_whole
from vtray.base.errors import OutputError, ProvenanceError
from vtray.base.file_lock import FileLock, HeldError
from vtray.base.version import __version__
from vtray.image.provenance import Provenance, read_provenance
from vtray.scene.default_light import lights_of
from vtray.scene.fingerprint import scene_hash
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style

GO_ON = "--resume (in Python, resume=True) goes on"

LOCK = ".lock"
"""The ending of the file that says that a run is at work."""

PART = "movie.part"
"""The movie in its folder, before it takes its name."""


class Record(msgspec.Struct, forbid_unknown_fields=True):
    """What is not told by the pictures.

    Attributes
    ----------
    version
        The version of vtray.
    marks
        What is painted on all pictures, as text.
    count
        How many are done from the first on: further numbered pictures may be those of a run before.
    white
        The light that becomes white in all pictures, once that is known.
    further
        Which others are done, of which some before are still missing.
    """

    version: str
    marks: str
    count: int = 0
    white: float | None = None
    further: list[int] = []


class Done:
    """The pictures that are done of a movie, which no other run touches until they are released.

    Parameters
    ----------
    output
        Where it goes.
    marks
        What is painted on all pictures, as text.
    resume
        Whether to go on from those that there are.

    Raises
    ------
    OutputError
        There are some, and they are another movie's, or nobody has said to go on from them; another
        run is at work on them; or the folder cannot be made.

    Attributes
    ----------
    count : int
        How many there are from the first on, none of them missing.
    """

    def __init__(self, output: Output, marks: str, *, resume: bool) -> None:
        self.output = output
        self.count = 0
        self._further: set[int] = set()
        self._record = Record(__version__, marks)
        self._lock = threading.Lock()
        self._held = self._hold()
        try:
            self._look(resume=resume)
        except BaseException:
            self._held.release()
            raise

    def __len__(self) -> int:
        return self.count + len(self._further)

    def __contains__(self, k: int) -> bool:
        return k < self.count or k in self._further

    def release(self) -> None:
        """Let another run go on; where there is nothing yet, leave nothing behind."""
        if not len(self) and self._says_nothing():
            self.output.record.unlink(missing_ok=True)
        self._held.release()
        self._leave_folder()

    @property
    def white(self) -> float | None:
        """The light that becomes white in all pictures; None if that is not known yet."""
        return self._record.white

    @white.setter
    def white(self, value: float) -> None:
        with self._lock:
            self._record.white = value
            self._write()

    def add(self, k: int) -> None:
        """Say that a picture is done."""
        with self._lock:
            self._further.add(k)
            self._move_on()
            self._record.count, self._record.further = self.count, sorted(self._further)
            self._write()

    def told(self) -> str:
        """Say how many there are."""
        return "1 picture" if len(self) == 1 else f"{len(self)} pictures"

    def how_to_go_on(self) -> str:
        """Say how another run goes on; "" if there is nothing."""
        return f"{self.output.path}: {self.told()} done; {GO_ON}" if self.count else ""

    def check_last(
        self, scene: Scene, settings: RenderSettings, style: Style, *, holds: bool
    ) -> None:
        """Raise OutputError if the last before one that is missing is not the picture of a scene.

        Parameters
        ----------
        scene
            The scene, with the camera and the lights of the picture.
        settings, style
            How it is rendered.
        holds
            Whether it has the exposure of the first picture.
        """
        last = self.output.name(self.count - 1)
        try:
            told = read_provenance(last)
        except ProvenanceError as error:
            raise OutputError(f"{error}; remove it to go on") from None
        for name, (was, is_now) in _pairs(told, scene, settings, style, holds).items():
            if was != is_now:
                raise self._other(f"were made with {name} {_shown(was)}, not {_shown(is_now)}")
        whole = Scene(scene.camera, lights_of(scene), scene.objects, scene.render, scene.style)
        if told.scene != scene_hash(whole):
            raise self._other(f"are of other scenes, as {last.name} is")

    def finish(self, part: Path | None) -> None:
        """Put the whole movie in its place, and take away what was needed until then."""
        if part is not None:
            with part.open("rb") as whole:
                write_whole(self.output.path, lambda file: shutil.copyfileobj(whole, file))
            part.unlink()
            for k in range(self.count):
                self.output.name(k).unlink(missing_ok=True)
        self.output.record.unlink(missing_ok=True)
        self.release()

    def _hold(self) -> FileLock:
        """Make the folder, and hold it against other runs."""
        folder, record = self.output.folder, self.output.record
        self._stays = self.output.format is None and folder.is_dir()
        try:
            folder.mkdir(exist_ok=True)
            return FileLock(record.with_name(f"{record.name}{LOCK}"))
        except HeldError:
            words = "is being made by another run; wait for that, or choose another name"
            raise OutputError(f"{self.output.path}: {words}") from None
        except FileExistsError:
            raise self._in_the_way() from None
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise OutputError(f"{folder}: cannot be made: {reason}") from None

    def _says_nothing(self) -> bool:
        """Tell whether nothing stands beside the record in a folder that is made for that."""
        if self.output.format is None:
            return True
        with contextlib.suppress(OSError):
            kept = {path for path in self.output.folder.iterdir() if path.suffix != LOCK}
            return kept == {self.output.record}
        return False

    def _leave_folder(self) -> None:
        """Remove the folder, unless something is in it, or it was there for numbered pictures."""
        if not self._stays:
            with contextlib.suppress(OSError):
                self.output.folder.rmdir()

    def _look(self, *, resume: bool) -> None:
        """Look which pictures an earlier run has done."""
        kept = self._kept()
        if kept is not None:
            while self.count < kept.count and self.output.name(self.count).is_file():
                self.count += 1
        if kept is None or not self.count:
            self._write()
            return
        self._further = {
            k for k in kept.further if k > self.count and self.output.name(k).is_file()
        }
        self._move_on()
        if not resume:
            words = f"holds {self.told()} that an earlier run has done"
            raise OutputError(f"{self._place}: {words}; {GO_ON}, or remove it")
        self._check(kept)
        self._record = kept

    def _move_on(self) -> None:
        """Count those from the first on, none of which is missing."""
        while self.count in self._further:
            self._further.remove(self.count)
            self.count += 1

    def _in_the_way(self) -> OutputError:
        """Give the error for a folder that is something else."""
        words = "is in the way: pictures are kept there until the movie is whole"
        return OutputError(f"{self.output.folder}: {words}; remove it")

    @property
    def _place(self) -> Path:
        """What is to be removed to begin anew."""
        return self.output.record if self.output.format is None else self.output.folder

    def _kept(self) -> Record | None:
        """Return what an earlier run has told; None if there was none."""
        record = self.output.record
        try:
            content = record.read_bytes()
        except FileNotFoundError:
            if self.output.format is not None:
                others = (path.suffix != LOCK for path in self.output.folder.iterdir())
                if any(others):
                    raise self._in_the_way() from None
            return None
        except OSError as error:
            raise OutputError(f"{record}: cannot be read: {error.strerror or error}") from None
        try:
            return msgspec.json.decode(content, type=Record)
        except msgspec.DecodeError as error:
            raise OutputError(f"{record}: is not understood: {error}; remove it") from None

    def _check(self, kept: Record) -> None:
        """Raise OutputError if pictures are those of another movie."""
        if kept.version != __version__:
            raise self._other(f"were made by vtray {kept.version}, and this is {__version__}")
        if kept.marks != self._record.marks:
            raise self._other("have other annotations")

    def _other(self, words: str) -> OutputError:
        """Give the error for pictures of another movie."""
        verb, rest = words.split(" ", 1)
        if len(self) == 1:
            verb = {"were": "was", "have": "has", "are": "is"}[verb]
        told = f"its {self.told()} {verb} {rest}"
        return OutputError(f"{self._place}: {told}; do the same again, or remove it")

    def _write(self) -> None:
        content = msgspec.json.encode(self._record)
        write_whole(self.output.record, lambda file: file.write(content))


def _pairs(
    told: Provenance, scene: Scene, settings: RenderSettings, style: Style, holds: bool
) -> dict[str, tuple[Any, Any]]:
    """Return how a picture was made, and how it would be now, by the names of settings."""
    now = {**msgspec.structs.asdict(settings), **msgspec.structs.asdict(style)}
    now["size"] = tuple(map(int, settings.size or scene.camera.size))
    found = {name: (told.told(name), value) for name, value in now.items()}
    if told.lock is not None and not holds:
        found["exposure"] = "that of the first", now["exposure"]
    return found


def _shown(value: object) -> str:
    """Return a setting as it is shown in messages."""
    return "x".join(map(str, value)) if isinstance(value, tuple) else str(value)
