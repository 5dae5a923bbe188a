"""Files of NumPy arrays, .npz and .npy: read with care, written whole."""

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from vtray.atomic_file import write_whole
from vtray.errors import SceneError, why_unreadable
from vtray.json_tree import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Arrays = dict[str, NDArray[Any]]

_BEGINNINGS = {".npz": (b"PK\x03\x04", b"PK\x05\x06"), ".npy": (b"\x93NUMPY",)}


def read_arrays(path: Path, names: Collection[str], alone: str) -> "tuple[Arrays, list[str]]":
    """Read arrays from a file.

    Parameters
    ----------
    path
        A .npz file, or a .npy file, which holds one array.
    names
        The arrays to read, where a .npz file has them; no other is looked at.
    alone
        What the array of a .npy file is called.

    Returns
    -------
    arrays : dict
        What the file has of these arrays, of any shape and dtype but objects.
    others : list of str
        The names of all other arrays of the file.

    Raises
    ------
    SceneError
        If the file cannot be read, is damaged, or holds pickled objects, which could do harm.
    """
    suffix = path.name[-4:]  # not path.suffix, which is empty for a file called .npz
    try:
        with path.open("rb") as file:
            return _read(file, suffix, names, alone)
    except SceneError:
        raise
    except (OSError, ValueError, MemoryError) as error:  # a path with a null byte is a ValueError
        raise SceneError(why_unreadable(error, f"{suffix} file")) from None


def write_arrays(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write a .npz file, uncompressed, whole or not at all.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    import numpy as np

    write_whole(path, lambda file: np.savez(file, allow_pickle=False, **arrays))


def _read(
    file: BinaryIO, suffix: str, names: Collection[str], alone: str
) -> "tuple[Arrays, list[str]]":
    """Read arrays from an open file."""
    import numpy as np

    beginning = file.read(6)
    if not beginning.startswith(_BEGINNINGS[suffix]):
        problem = "holds something else" if beginning else "is empty"
        writer = "numpy.savez" if suffix == ".npz" else "numpy.save"
        raise SceneError(f"{problem}; expected a {suffix} file as {writer} writes it")
    file.seek(0)
    loaded = _guarded(np.load, file, allow_pickle=False)
    if suffix == ".npy":
        return {alone: loaded}, []
    with loaded:
        found = [name for name in names if name in loaded.files]
        arrays = {name: _guarded(loaded.__getitem__, name, place=f"{name}: ") for name in found}
        return arrays, [name for name in loaded.files if name not in names]


def _guarded(load: Callable[..., Any], source: object, place: str = "", **options: Any) -> Any:  # noqa: ANN401
    """Load something; raise SceneError if the file is damaged."""
    try:
        return load(source, **options)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - a damaged file makes NumPy raise almost anything
        if "allow_pickle" in str(error):
            problem = "holds Python objects; expected numbers"
        else:
            problem = f"is damaged or cut short ({short(str(error), 100)}); write it again"
        raise SceneError(place + problem) from None
