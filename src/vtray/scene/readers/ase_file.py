"""Files of atoms that ASE reads.

References
----------
https://wiki.fysik.dtu.dk/ase/ase/io/io.html
"""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.particles.from_objects import from_ase
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_room, told
from vtray.scene.readers.reader_table import READERS, Given

_TIMES = 4
"""Bytes of memory for a byte of a file, as measured with POSCAR: 3."""

_NAMES = {
    "poscar": "vasp",
    "xdatcar": "vasp-xdatcar",
    "outcar": "vasp-out",
    "vasprun": "vasp-xml",
    "cell": "castep-cell",
    "castep": "castep-castep",
}
"""What ASE calls files, where the table of readers calls them otherwise."""

_WHOLE = {"do_not_split_by_at_sign": True}
"""A name is that of a file, @ in it or not."""


def read(given: Given) -> Particles:
    """Read a frame of a file that ASE reads.

    Raises
    ------
    SceneError
        ASE cannot read it, or it has no such frame.
    ExtraError
        ASE is not installed.
    """
    return read_asked(steps(given), given)


def read_asked(all_steps: Steps, given: Given) -> Particles:
    """Read the frame that is asked for, whose number is only known when the others are met."""
    # Of the frames that were met, only those that may be asked for are kept.
    met: deque[Any] = deque(maxlen=max(-given.frame, 1))
    count = 0
    for step in all_steps:
        met.append(step)
        count += 1
        if count == given.frame + 1:
            break
    if not count:
        raise SceneError(f"holds no frame; expected {READERS[given.format].what}")
    frame_number(given.frame, count)
    found: Particles = met[0 if given.frame < 0 else -1]()
    return found


def steps(given: Given) -> Steps:
    """Give what makes particles of each frame, one after the other."""
    return steps_of_atoms(given, _frames)


def steps_of_atoms(given: Given, open_frames: Callable[[Given], Iterator[Any]]) -> Steps:
    """Give what makes particles of atoms of ASE, as some function gives them of a file."""
    what = READERS[given.format].what
    check_room(given.file, _TIMES)
    with told("ASE", what):
        all_atoms = open_frames(given)
    number = 0
    while True:
        with told("ASE", what):
            atoms = next(all_atoms, None)
        if atoms is None:
            return
        yield partial(_particles_of, atoms, number, what)
        number += 1


def _frames(given: Given) -> Iterator[Any]:
    """Give the frames of a file."""
    io: Any = need("ase.io", "atoms", f"reading {READERS[given.format].what}")
    frames: Iterator[Any] = io.iread(
        given.path, ":", _NAMES.get(given.format, given.format), **_WHOLE
    )
    return frames


def _particles_of(atoms: Any, number: int, what: str) -> Particles:  # noqa: ANN401
    """Return atoms of ASE as particles."""
    with told("ASE", what):
        return replace(from_ase(atoms), frame=number)
