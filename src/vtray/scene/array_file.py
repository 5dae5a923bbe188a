"""Files of NumPy arrays, .npz and .npy: read with care, written whole.

What an array says of itself is read and checked before room is made for its numbers: a small file
may claim, or hold compressed, more than any memory has.
"""

import io
import struct
import zipfile
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, BinaryIO, NamedTuple

from vtray.base.atomic_file import write_whole
from vtray.base.errors import SceneError, why_unreadable
from vtray.base.input_file import open_input
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Arrays = dict[str, Array]

_NPY = b"\x93NUMPY"
_BEGINNINGS = {".npz": (b"PK\x03\x04", b"PK\x05\x06"), ".npy": (_NPY,)}

_LONGEST_HEAD = 10_000
"""Bytes of what an array says of itself, at the most; for an array of numbers it is about 120."""

_SHOWN = 100
"""Bytes of something else that are read to show it."""

Check = Callable[["Arrays", list[str]], object]


class ArrayFileError(SceneError):
    """A file of arrays cannot be read; the message follows its name."""


def read_arrays(
    path: Path, names: Collection[str], alone: str, check: Check
) -> "tuple[Arrays, list[str]]":
    """Read arrays from a file.

    Parameters
    ----------
    path
        A .npz file, or a .npy file, which holds one array.
    names
        The arrays to read, where a .npz file has them; no other is looked at.
    alone
        What the array of a .npy file is called.
    check
        Called before any numbers are read, with arrays that have the shapes and the dtypes of those
        in the file, but no numbers of their own, and with the names of all others. What it raises
        is raised.

    Returns
    -------
    arrays : dict
        What the file has of these arrays, of any shape and dtype but objects.
    others : list of str
        The names of all other arrays of the file.

    Raises
    ------
    ArrayFileError
        If the file cannot be read, is damaged, does not fit into memory, or holds pickled objects,
        which could do harm.
    """
    suffix = path.name[-4:]  # not path.suffix, which is empty for a file called .npz
    try:
        with open_input(path) as file:
            return _read(file, suffix, names, alone, check)
    except SceneError:
        raise
    except (OSError, ValueError, MemoryError) as error:  # a path with a null byte is a ValueError
        raise ArrayFileError(why_unreadable(error, f"{suffix} file")) from None


def write_arrays(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write a .npz file, uncompressed, whole or not at all.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    import numpy as np

    write_whole(path, lambda file: np.savez(file, **arrays))


def read_text(file: BinaryIO, name: str, longest: int) -> str | None:
    """Return the text of a .npz file that is an array of this name, None if there is none.

    Raises
    ------
    Exception
        Of any kind, if the file is damaged, or the text takes more than so many bytes.
    """
    import numpy as np

    with zipfile.ZipFile(file) as whole:
        member = f"{name}.npy"
        if member not in whole.namelist():
            return None
        with whole.open(member) as stream:
            head = _read_head(stream)
        if isinstance(head, bytes) or head.bytes > longest:
            message = f"{name} is no text, or too long"
            raise ValueError(message)
        with whole.open(member) as stream:
            return str(np.lib.format.read_array(stream))


class _Head(NamedTuple):
    """What an array in a file says of itself.

    Attributes
    ----------
    shape, dtype
        Of the array.
    size
        Bytes of this, which stand in front of the numbers.
    """

    shape: tuple[int, ...]
    dtype: Any
    size: int

    @property
    def bytes(self) -> int:
        """How many bytes the numbers take."""
        count: int = self.dtype.itemsize
        for length in self.shape:
            count *= length
        return count


def _read(
    file: BinaryIO, suffix: str, names: Collection[str], alone: str, check: Check
) -> "tuple[Arrays, list[str]]":
    """Read arrays from an open file."""
    beginning = file.read(6)
    if not beginning.startswith(_BEGINNINGS[suffix]):
        problem = "holds something else" if beginning else "is empty"
        writer = "numpy.savez" if suffix == ".npz" else "numpy.save"
        raise ArrayFileError(f"{problem}; expected a {suffix} file as {writer} writes it")
    if suffix == ".npz":
        return _read_npz(file, names, check)
    import numpy as np

    size = file.seek(0, io.SEEK_END)
    file.seek(0)
    head = _guarded("", _read_head, file)
    _check_room([head])
    _check_length("", head, size)
    check({alone: _stand_in("", head)}, [])
    file.seek(0)
    return {alone: _guarded("", np.lib.format.read_array, file)}, []


def _read_npz(file: BinaryIO, names: Collection[str], check: Check) -> "tuple[Arrays, list[str]]":
    """Read arrays from an open .npz file."""
    import numpy as np

    with _guarded("", zipfile.ZipFile, file) as whole:
        # Of two of one name the last counts, as for all who read such files.
        members = {item.filename.removesuffix(".npy"): item for item in whole.infolist()}
        found = {name: members[name] for name in names if name in members}
        heads: dict[str, _Head] = {}
        strange: dict[str, Any] = {}
        for name, member in found.items():
            with _guarded(name, whole.open, member) as stream:
                head = _guarded(name, _read_head, stream)
            if isinstance(head, bytes):
                strange[name] = head
            else:
                heads[name] = head
        _check_room(heads.values())
        for name, head in heads.items():
            _check_length(name, head, found[name].file_size)
        arrays = strange | {name: _stand_in(name, head) for name, head in heads.items()}
        others = [name for name in members if name not in found]
        check(arrays, others)
        for name in heads:
            with _guarded(name, whole.open, found[name]) as stream:
                arrays[name] = _guarded(name, np.lib.format.read_array, stream)
    return arrays, others


def _read_head(file: IO[bytes]) -> "_Head | bytes":
    """Read what an array says of itself; return the beginning of what is no array."""
    import numpy as np

    beginning = file.read(8)
    if beginning[:6] != _NPY:
        return beginning + file.read(_SHOWN)
    kind = "<H" if beginning[6:7] == b"\x01" else "<I"
    length = file.read(struct.calcsize(kind))
    (size,) = struct.unpack(kind, length)
    if size > _LONGEST_HEAD:
        message = "the description of the array is too long"
        raise ValueError(message)
    read = getattr(np.lib.format, f"read_array_header_{1 if kind == '<H' else 2}_0")
    shape, _, dtype = read(io.BytesIO(length + file.read(size)))
    if dtype.hasobject:
        message = "holds Python objects; expected numbers"
        raise ArrayFileError(message)
    return _Head(shape, dtype, len(beginning) + len(length) + size)


def _check_room(heads: Iterable[_Head]) -> None:
    """Raise ArrayFileError if arrays do not fit into memory."""
    lack = lack_of_memory(sum(head.bytes for head in heads))
    if lack:
        raise ArrayFileError(f"is too large to hold in memory: it needs {lack}")


def _check_length(name: str, head: _Head, size: int) -> None:
    """Raise ArrayFileError if an array, of so many bytes, is shorter than it says."""
    if head.bytes > size - head.size:
        raise _damaged(name, f"{size - head.size} bytes of numbers, not {head.bytes}")


def _stand_in(name: str, head: _Head) -> "Array":
    """Return an array of a shape and a dtype that takes no memory."""
    import numpy as np

    array: Array = _guarded(name, np.broadcast_to, np.zeros((), head.dtype), head.shape)
    return array


def _guarded(name: str, load: Callable[..., Any], *arguments: object) -> Any:  # noqa: ANN401
    """Load something of an array; raise ArrayFileError if the file is damaged."""
    try:
        return load(*arguments)
    except MemoryError:
        raise
    except ArrayFileError as problem:
        raise ArrayFileError(f"{name}: {problem}" if name else str(problem)) from None
    except Exception as error:  # noqa: BLE001 - a damaged file makes NumPy raise almost anything
        raise _damaged(name, str(error)) from None


def _damaged(name: str, why: str) -> ArrayFileError:
    """Give the error for a file that is damaged."""
    place = f"{name}: " if name else ""
    return ArrayFileError(f"{place}is damaged or cut short ({short(why, 100)}); write it again")
