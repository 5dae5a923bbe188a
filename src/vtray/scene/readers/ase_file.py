"""Files of atoms that ASE reads.

References
----------
https://wiki.fysik.dtu.dk/ase/ase/io/io.html
"""

from typing import Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.particles.from_objects import from_ase
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import READERS, Given

_TIMES = 25
"""Bytes of memory for a byte of a file, as measured with CIF."""

_NAMES = {
    "pdb": "proteindatabank",
    "poscar": "vasp",
    "xdatcar": "vasp-xdatcar",
    "outcar": "vasp-out",
    "vasprun": "vasp-xml",
    "cell": "castep-cell",
    "aims": "aims",
}
"""What ASE calls files, where the table of readers calls them otherwise."""


def read(given: Given) -> Particles:
    """Read a frame of a file that ASE reads.

    Raises
    ------
    SceneError
        ASE cannot read it, or it has no such frame.
    ExtraError
        ASE is not installed.
    """
    what = READERS[given.format].what
    io: Any = need("ase.io", "atoms", f"reading {what}")
    check_room(given.path, _TIMES)
    name = _NAMES.get(given.format, given.format)
    with told("ASE", what):
        frames = io.read(given.path, index=":", format=name, do_not_split_by_at_sign=True)
    if not frames:
        raise SceneError(f"holds no frame; expected {what}")
    number = frame_number(given.frame, len(frames))
    return from_ase(frames[number])
