"""PDB files, with NumPy alone.

References
----------
https://www.wwpdb.org/documentation/file-format-content/format33/sect9.html
"""

import re
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.beads import are_beads, types_of_beads
from vtray.scene.particles.crystal_cell import edges_of
from vtray.scene.particles.elements import symbol_of
from vtray.scene.particles.few_names import texts_of
from vtray.scene.particles.pairs import reach_residues
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed, parsed_all, whole_or_texts
from vtray.scene.readers.frames import Steps, frame_number
from vtray.scene.readers.libraries import check_room
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.rows import check_places

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_ATOM = (b"ATOM", b"HETATM")

_WIDTH = 80
"""Characters of a line that are looked at."""

_TIMES = 8
"""Bytes of memory for a byte of a file."""


class _Model(NamedTuple):
    """The lines of a frame.

    Attributes
    ----------
    atoms
        Those of atoms.
    numbers
        Where each stands in the file, from 1.
    cell
        The edges of the cell, if there is one.
    """

    atoms: list[bytes]
    numbers: list[int]
    cell: "Cell | None"


def read(given: Given) -> Particles:
    """Read a model of a PDB file.

    Columns are ``element``, ``name``, ``resname``, ``resid``, ``chain``, ``occupancy`` and
    ``tempfactor``, and ``altloc`` where it is used. Elements are those of columns 77 and 78; where
    these are blank, of the first two characters of the name, in which a symbol stands to the right.
    In files whose names all begin in the first of these, as CHARMM and NAMD write them, a symbol
    has one letter, but for ions and a few metals, halogens and selenium.
    Bonds are those of CONECT, where they reach each atom of all residues with more than one; most
    files name but a few of them, which are not read. There is a cell where the atoms are all that
    it repeats; not where its space group makes others of them, as in most crystals of proteins.

    Raises
    ------
    SceneError
        The file has no such model, or it is not right. The message names the line.
    """
    found = [*steps(given)]
    if not found:
        raise SceneError("expected lines that begin with ATOM or HETATM; there are none")
    return found[frame_number(given.frame, len(found))]()


def steps(given: Given) -> Steps:
    """Give what reads each model, one after the other."""
    check_room(given.file, _TIMES)
    models, conects = _models_of(given.file.read())
    for number, model in enumerate(models):
        yield partial(_read_model, model, conects, number)


def _read_model(model: _Model, conects: list[bytes], number: int) -> Particles:
    """Return what the lines of a model say."""
    import numpy as np

    atoms, numbers, cell = model
    lines = np.array([line[:_WIDTH].ljust(_WIDTH) for line in atoms], f"S{_WIDTH}")
    table = lines.view("S1").reshape(len(atoms), _WIDTH)
    places = [_numbers(table, start, start + 8, numbers, "xyz"[i]) for i, start in _PLACES]
    columns: dict[str, Array] = {}
    names, residues = _text(table, 12, 16, strip=False), _text(table, 17, 21)
    columns["name"] = _text(table, 12, 16)
    given = _text(table, 76, 78, strip=False)
    if are_beads(columns["name"]) and not np.char.strip(given).any():
        columns["type"] = types_of_beads(columns["name"])
    elif (elements := _elements_of(given, names, residues)) is not None:
        columns = {"element": elements, **columns}
    columns["resname"] = residues
    columns["chain"] = _text(table, 21, 22)
    columns["resid"] = whole_or_texts(_text(table, 22, 26))
    altloc = _text(table, 16, 17)
    if (altloc != "").any():
        columns["altloc"] = altloc
    for name, start in (("occupancy", 54), ("tempfactor", 60)):
        if (_text(table, start, start + 6) != "").all():
            columns[name] = _numbers(table, start, start + 6, numbers, name)
    positions = np.stack(places, axis=1)
    check_places(positions, numbers)
    bonds = _bonds_of(conects, table) if conects else None
    return Particles(positions, columns, bonds=bonds, cell=cell, frame=number)


_IONS = {
    "SOD": "Na",
    "CLA": "Cl",
    "POT": "K",
    "CAL": "Ca",
    "CES": "Cs",
    "LIT": "Li",
    "RUB": "Rb",
    "BAR": "Ba",
    "CAD": "Cd",
}
"""What CHARMM calls ions."""

_NAMED = """
    ALA ARG ASN ASP CYS GLN GLU GLY HIS ILE LEU LYS MET PHE PRO SER THR TRP TYR VAL
    CYX HID HIE HIP HSD HSE HSP MSE
"""

_AMINO_ACIDS = frozenset(_NAMED.split())
"""Residues whose CA is no calcium."""

_SURE = ("CL", "BR", "FE", "ZN", "MG", "MN", "CU", "SE")
"""Beginnings of names that stand for a symbol of two letters, whatever the residue."""

_PLACES = ((0, 30), (1, 38), (2, 46))
"""Where x, y and z begin in a line."""


def _models_of(content: bytes) -> "tuple[list[_Model], list[bytes]]":
    """Return the models of a file, each with the cell that was named last, and lines of bonds."""
    conects: list[bytes] = []
    models: list[_Model] = []
    cell = None
    now = _Model([], [], None)
    for number, line in enumerate(content.splitlines(), 1):
        if line.startswith(_ATOM):
            now.atoms.append(line)
            now.numbers.append(number)
        elif line.startswith((b"END", b"MODEL")):
            if now.atoms:
                models.append(now._replace(cell=cell))
            now = _Model([], [], None)
        elif line.startswith(b"CRYST1"):
            cell = _cell_of(line.decode("latin-1"), number) if _is_whole(line) else None
        elif line.startswith(b"CONECT"):
            conects.append(line)
    return [*models, now._replace(cell=cell)] if now.atoms else models, conects


def _bonds_of(conects: list[bytes], table: "Array") -> "Array | None":
    """Return the bonds that lines name, (m, 2); None if they are not all that there are.

    Serial numbers that are none, as in files with more atoms than these have digits for, name no
    atom, and so do those of other models.
    """
    import numpy as np

    serials = _text(table, 6, 11).tolist()
    row_of = {serial: row for row, serial in enumerate(serials)}
    if len(row_of) < len(serials):
        return None
    pairs = set()
    for line in conects:
        named = [line[i : i + 5].decode("latin-1").strip() for i in range(6, 31, 5)]
        first, *others = [row_of.get(serial) for serial in named]
        for other in others:
            if first is not None and other is not None and first != other:
                pairs.add((min(first, other), max(first, other)))
    bonds = np.array(sorted(pairs), np.int64).reshape(-1, 2)
    residues = np.ascontiguousarray(table[:, 17:27]).view("S10").ravel()
    return bonds if reach_residues(bonds, residues) else None


def _is_whole(line: bytes) -> bool:
    """Tell whether the atoms are all of a cell: its space group is P 1, or is not named."""
    return line[55:66].replace(b" ", b"") in (b"", b"P1")


def _cell_of(line: str, number: int) -> "Cell | None":
    """Return the edges of the cell that a line says."""
    starts = (6, 15, 24, 33, 40, 47, 54)
    try:
        found = [parsed(line[i:j]) for i, j in pairwise(starts)]
    except ValueError:
        found = [0.0]
    return edges_of(found, f"line {number}")


def _text(table: "Array", start: int, end: int, strip: bool = True) -> "Array":
    """Return some characters of all lines as text."""
    import numpy as np

    found: Array = np.ascontiguousarray(table[:, start:end]).view(f"S{end - start}").ravel()
    listed = found.tolist()
    if strip:
        return texts_of(listed, lambda entry: entry.decode("latin-1").strip())
    return texts_of(listed, lambda entry: entry.decode("latin-1"))


def _numbers(table: "Array", start: int, end: int, lines: list[int], name: str) -> "Array":
    """Return some characters of all lines as numbers."""
    import numpy as np

    found = np.ascontiguousarray(table[:, start:end]).view(f"S{end - start}").ravel()
    listed = found.tolist()
    try:
        return parsed_all(listed)
    except ValueError:
        for line, entry in zip(lines, listed, strict=True):
            if not re.fullmatch(rb"\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*", entry):
                shown = short(entry.decode("latin-1"))
                place = f"line {line}: columns {start + 1} to {end}"
                raise SceneError(f"{place}: {name} must be a number, got {shown!r}") from None
        raise


def _elements_of(columns: "Array", names: "Array", residues: "Array") -> "Array | None":
    """Return the elements of atoms, X where one is not known; None if none is."""
    triples = [*zip(columns.tolist(), names.tolist(), residues.tolist(), strict=True)]
    different = set(triples)
    # With a symbol to the right, the names of carbon, nitrogen, oxygen begin with a blank.
    is_left = all(name[:1].isalpha() for _, name, _ in different) and any(
        residue in _AMINO_ACIDS or not name[1:2].isalpha() for _, name, residue in different
    )
    known = {triple: _element_of(*triple, is_left) for triple in different}
    if not any(known.values()):
        return None
    return texts_of(triples, lambda triple: known[triple] or "X")


def _element_of(column: str, name: str, residue: str, is_left: bool) -> str | None:
    """Return the element of an atom.

    Parameters
    ----------
    column, name, residue
        The columns of the element, of the name, and the name of the residue.
    is_left
        Whether all names of the file begin in the first of their columns.
    """
    if column.strip():
        return symbol_of(re.sub(r"[0-9+-]", "", column))
    if is_left:
        return _element_of_left(name.strip(), residue)
    name = name.ljust(4)
    two = name[:2]
    # Names of hydrogen that have four characters begin one column before.
    if two[0].isalpha() and not (two[0] == "H" and name[3] != " "):
        found = symbol_of(two) if two[1].isalpha() else symbol_of(two[0])
        if found is not None:
            return found
    return symbol_of(next((letter for letter in name if letter.isalpha()), ""))


def _element_of_left(name: str, residue: str) -> str | None:
    """Return the element of an atom whose name has its symbol to the left."""
    letters = re.match(r"[A-Za-z]*", name)
    word = letters[0].upper() if letters else ""
    if word in _IONS:
        return _IONS[word]
    if word[:2] in _SURE or word == re.sub(r"[0-9+-]", "", residue).upper():
        found = symbol_of(word[:2])
        if found is not None:
            return found
    return symbol_of(word[:1])
