"""Files that were compressed: as if they had been unpacked before."""

import contextlib
import io
import os
from collections.abc import Iterator
from pathlib import Path

from vtray.base.errors import SceneError
from vtray.base.input_file import read_stream
from vtray.scene.readers.packing import packing_of, unpacking
from vtray.scene.readers.reader_table import Given

BY_PATH = ("ase_file", "cif_file", "mdanalysis_file")
"""The readers of texts that open files by their names."""

BY_FILE = (
    "xyz_file",
    "pdb_file",
    "lammps_dump_file",
    "lammps_data_file",
    "table_file",
    "ply_file",
    "vtk_file",
)
"""The readers of texts that take files which are open."""

BINARY = ("npz", "parquet", "traj", "tpr")
"""What these do not read from compressed files, as it is no text."""


@contextlib.contextmanager
def unpacked(given: Given, module: str, what: str) -> Iterator[Given]:
    """Give a file as its reader takes it: unpacked, in memory or in a folder of its own.

    Parameters
    ----------
    given
        The file.
    module
        The reader.
    what
        What it reads, in words.

    Raises
    ------
    SceneError
        The file is compressed and no text, or cannot be unpacked.
    OSError
        What is in it is larger than the quarter of the memory that is available.
    """
    packing = packing_of(given.path)
    if not packing:
        yield given
        return
    if given.format in BINARY or module not in (*BY_PATH, *BY_FILE):
        raise SceneError(f"is compressed, which {what} may not be; unpack it first")
    with unpacking(given.file, packing) as stream:
        content = read_stream(stream)
    if module in BY_FILE:
        yield given._replace(file=io.BytesIO(content))
        return
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / os.path.basename(given.path)[: -len(packing)]
        path.write_bytes(content)
        with path.open("rb") as file:
            yield given._replace(file=file, path=str(path))
