"""Particles of objects of OpenMM, ParmEd, HOOMD-blue and freud.

None of the libraries is imported: what an object is, is told by its attributes.

References
----------
http://docs.openmm.org/latest/api-python/app.html,
https://parmed.github.io/ParmEd/html/structure.html,
https://gsd.readthedocs.io/en/stable/schema-hoomd.html,
https://hoomd-blue.readthedocs.io/en/stable/hoomd/box.html,
https://freud.readthedocs.io/en/stable/topics/datainputs.html
"""

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.crystal_cell import edges_of
from vtray.scene.particles.elements import symbols_of
from vtray.scene.particles.from_chemistry import bonds_of_pairs, columns_of_atoms
from vtray.scene.particles.particles import Particles

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

HOOMD = ("mass", "charge", "velocity", "orientation", "angmom", "body", "image")
"""What else HOOMD-blue may know of each particle, beside its place, type and diameter."""

_USUAL: dict[str, Any] = {"mass": 1, "orientation": (1, 0, 0, 0), "body": -1}
"""What particles of HOOMD-blue have of these where nothing is said; else 0."""

_ZERO: Any = (0.0, 0.0, 0.0)


def particles_of_simulation(given: Any) -> Particles | None:  # noqa: ANN401
    """Return the particles of an object of one of these libraries; None if it is none.

    Those of OpenMM and ParmEd are in ångström; those of HOOMD-blue and freud as they are, around
    the middle of their box.

    Raises
    ------
    SceneError
        It has no places.
    """
    if hasattr(given, "coordinates") and hasattr(given, "residues") and hasattr(given, "bonds"):
        return _of_parmed(given)
    if hasattr(getattr(given, "topology", None), "getPeriodicBoxVectors"):
        return _of_openmm(given)
    if hasattr(getattr(given, "particles", None), "typeid") and hasattr(given, "configuration"):
        return of_hoomd(given, _said(given.particles))
    if hasattr(getattr(given, "box", None), "Lx") and hasattr(given, "points"):
        return _of_freud(given.box, given.points)
    if isinstance(given, tuple) and len(given) == 2 and hasattr(given[0], "Lx"):
        return _of_freud(*given)
    return None


def of_hoomd(frame: Any, names: Iterable[str], number: int = 0) -> Particles:  # noqa: ANN401
    """Return the particles of a frame of a GSD file, or of a snapshot of HOOMD-blue.

    Parameters
    ----------
    frame
        The frame.
    names
        Which of `HOOMD` are columns.
    number
        That of the frame.

    Raises
    ------
    SceneError
        It has no places.
    """
    import numpy as np

    particles = frame.particles
    if particles.position is None:
        raise SceneError("the frame has no places; expected particles.position")
    columns: dict[str, Array] = {}
    if particles.typeid is not None:
        kinds = np.array(particles.types or ["A"], np.str_)
        columns["type"] = kinds[np.asarray(particles.typeid, np.int64)]
    widths = 1.0 if particles.diameter is None else particles.diameter
    columns["radius"] = np.full(len(particles.position), widths, np.float64) / 2
    columns |= {name: np.array(getattr(particles, name)) for name in names}
    box, bonds = frame.configuration.box, frame.bonds
    cell = None if box is None else _edges_of_box(*map(float, box))
    return Particles(
        np.array(particles.position),
        name_columns(columns),
        bonds=np.array(bonds.group, np.int64) if bonds.N else None,
        cell=cell,
        origin=_around_middle(cell),
        periodic=None if cell is None else (True, True, frame.configuration.dimensions == 3),
        frame=number,
    )


def _said(particles: Any) -> list[str]:  # noqa: ANN401
    """Return which of `HOOMD` are not what all particles have where nothing is said."""
    import numpy as np

    known = {name: getattr(particles, name, None) for name in HOOMD}
    return [
        name
        for name, values in known.items()
        if values is not None and np.any(np.asarray(values) != _USUAL.get(name, 0))
    ]


def _of_freud(box: Any, points: Any) -> Particles:  # noqa: ANN401
    """Return points of freud in their box."""
    import numpy as np

    cell = _edges_of_box(box.Lx, box.Ly, box.Lz, box.xy, box.xz, box.yz)
    return Particles(
        np.array(points),
        cell=cell,
        origin=_around_middle(cell),
        periodic=None if cell is None else tuple(map(bool, box.periodic)),
    )


def _edges_of_box(x: float, y: float, z: float, xy: float, xz: float, yz: float) -> "Cell | None":
    """Return the edges of a box by its lengths and tilts; None if it has no lengths."""
    import numpy as np

    if not (x or y or z):
        return None
    return np.array([(x, 0.0, 0.0), (xy * y, y, 0.0), (xz * z, yz * z, z)])


def _around_middle(cell: "Cell | None") -> Any:  # noqa: ANN401
    """Return the corner of a cell whose middle is the origin of the places."""
    return _ZERO if cell is None else (cell[0] + cell[1] + cell[2]) / -2


def _of_parmed(structure: Any) -> Particles:  # noqa: ANN401
    """Return the atoms and bonds of a structure of ParmEd."""
    import numpy as np

    if structure.coordinates is None:
        raise SceneError("the structure has no places; give them as structure.coordinates = ...")
    atoms = structure.atoms
    numbers = np.array([atom.element for atom in atoms], np.int64)
    columns: dict[str, Array] = {"element": symbols_of(numbers)} if numbers.any() else {}
    columns["name"] = np.array([atom.name for atom in atoms], np.str_)
    columns["resname"] = np.array([atom.residue.name for atom in atoms], np.str_)
    columns["resid"] = np.array([atom.residue.number for atom in atoms])
    columns["charge"] = np.array([atom.charge for atom in atoms], np.float64)
    pairs = [(bond.atom1.idx, bond.atom2.idx) for bond in structure.bonds]
    sizes = structure.box
    return Particles(
        np.array(structure.coordinates),
        columns,
        bonds=bonds_of_pairs(pairs),
        cell=None if sizes is None else edges_of([float(size) for size in sizes], "box"),
    )


def _of_openmm(given: Any) -> Particles:  # noqa: ANN401
    """Return the atoms and bonds of what has a topology of OpenMM, and places or a context."""
    import numpy as np

    topology, places = given.topology, getattr(given, "positions", None)
    box = topology.getPeriodicBoxVectors()
    if hasattr(given, "context"):  # a simulation
        state = given.context.getState(getPositions=True)
        places = state.getPositions(asNumpy=True)
        box = None if box is None else state.getPeriodicBoxVectors()
    if places is None:
        raise SceneError("expected places beside the topology, got none")
    atoms = list(topology.atoms())
    columns = columns_of_atoms(atoms)
    columns["chain"] = np.array([atom.residue.chain.id for atom in atoms], np.str_)
    pairs = [(one.index, two.index) for one, two in topology.bonds()]
    return Particles(
        _in_angstrom(places),
        columns,
        bonds=bonds_of_pairs(pairs),
        cell=None if box is None else _in_angstrom(box),
    )


def _in_angstrom(quantity: Any) -> "Array":  # noqa: ANN401
    """Return numbers with a unit of OpenMM in ångström."""
    import numpy as np

    units: Any = sys.modules[type(quantity).__module__.rpartition(".")[0]]
    return np.array(quantity.value_in_unit(units.angstrom), np.float64)
