"""mmCIF files, as the Protein Data Bank has them, by gemmi.

References
----------
https://mmcif.wwpdb.org/dictionaries/mmcif_pdbx_v50.dic/Index/, https://gemmi.readthedocs.io
"""

from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.crystal_cell import edges_of
from vtray.scene.particles.elements import symbols_among
from vtray.scene.particles.few_names import texts_of
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed_all, whole_or_texts
from vtray.scene.readers.frames import Steps
from vtray.scene.readers.libraries import check_room, told

if TYPE_CHECKING:
    from typing import BinaryIO

    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

_TIMES = 20
"""Bytes of memory for a byte of a file, as measured: 18."""

_ATOMS, _PLACES = "_atom_site.", ("Cartn_x", "Cartn_y", "Cartn_z")
"""The category of atoms, and what it calls their places."""

_TEXTS = {
    "name": ("label_atom_id", "auth_atom_id"),
    "resname": ("label_comp_id", "auth_comp_id"),
    "chain": ("auth_asym_id", "label_asym_id"),
    "resid": ("auth_seq_id", "label_seq_id"),
    "altloc": ("label_alt_id",),
}
"""Columns of texts, and what they are in a file, in the order of preference: that of PDB files."""

_NUMBERS = {"occupancy": "occupancy", "tempfactor": "B_iso_or_equiv"}
"""Columns of numbers, and what they are in a file."""

_MODEL = "pdbx_PDB_model_num"

_CELL = ("length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma")

_GROUPS = ("_symmetry.space_group_name_H-M", "_space_group.name_H-M_alt")

_WHOLE = ("", "P1")
"""Space groups of cells whose atoms are all in the file: of no others, or not said."""


def is_mmcif(content: bytes) -> bool:
    """Tell whether a CIF file has places of atoms in space, and not in a cell's coordinates."""
    return f"{_ATOMS}{_PLACES[0]}".lower().encode() in content.lower()


def steps(file: "BinaryIO") -> Steps:
    """Give what makes particles of each model of a file, one after the other."""
    cif: Any = need("gemmi", "atoms", "reading an mmCIF file").cif
    check_room(file, _TIMES)
    with told("gemmi", "an mmCIF file"):
        document = cif.read_string(file.read())
    number = 0
    for block in document:
        models = _entries(block, _MODEL)
        count = len(block.find_values(f"{_ATOMS}{_PLACES[0]}"))
        starts = [i for i in range(1, len(models)) if models[i] != models[i - 1]]
        for begin, end in zip([0, *starts], [*starts, count], strict=True):
            if begin < end:
                yield partial(_read_model, cif, block, range(begin, end), number)
                number += 1


def _read_model(cif: Any, block: Any, rows: range, number: int) -> Particles:  # noqa: ANN401
    """Return the atoms of a model, which are in some rows."""
    import numpy as np

    def texts(names: tuple[str, ...]) -> "Array | None":
        found = next((some for name in names if (some := _entries(block, name, rows))), None)
        return None if found is None else texts_of(found, cif.as_string)

    columns: dict[str, Array] = {}
    symbols = texts(("type_symbol",))
    elements = None if symbols is None else symbols_among(symbols)
    if elements is not None:
        columns["element"] = elements
    for name, called in _TEXTS.items():
        found = texts(called)
        if found is not None and (name != "altloc" or (found != "").any()):
            columns[name] = whole_or_texts(found) if name == "resid" else found
    for name, wanted in _NUMBERS.items():
        entries = _entries(block, wanted, rows)
        if entries and not any(map(cif.is_null, entries)):
            columns[name] = _numbers(cif, entries, rows, wanted)
    places = [_numbers(cif, _entries(block, name, rows), rows, name) for name in _PLACES]
    return Particles(np.stack(places, axis=1), columns, cell=_cell_of(cif, block), frame=number)


def _entries(block: Any, name: str, rows: range | None = None) -> list[str]:  # noqa: ANN401
    """Return what atoms in some rows, or all, have of one name, as it is written.

    That is nothing if they have none.
    """
    column = block.find_values(f"{_ATOMS}{name}")
    if rows is None or len(rows) == len(column):
        return list(column)
    return [column[row] for row in rows] if len(column) else []


def _numbers(cif: Any, entries: list[str], rows: range, name: str) -> "Array":  # noqa: ANN401
    """Return entries as numbers; behind these may be how sure they are, in brackets."""
    import numpy as np

    if not entries:
        raise SceneError(f"expected {_ATOMS}{name} of all atoms; there is none")
    try:
        found = parsed_all(entries)
    except ValueError:
        found = np.array([cif.as_number(entry) for entry in entries])
    wrong = np.flatnonzero(~np.isfinite(found))
    if len(wrong):
        first = int(wrong[0])
        problem = f"{_ATOMS}{name} must be a number, got {short(entries[first])!r}"
        raise SceneError(f"atom {rows[first] + 1}: {problem}")
    return found


def _cell_of(cif: Any, block: Any) -> "Cell | None":  # noqa: ANN401
    """Return the edges of the cell, if the atoms are all that are in it."""
    group = next((found for name in _GROUPS if (found := block.find_value(name))), "?")
    if cif.as_string(group).replace(" ", "") not in _WHOLE:
        return None
    sizes = [block.find_value(f"_cell.{name}") or "?" for name in _CELL]
    if any(map(cif.is_null, sizes)):
        return None
    return edges_of([cif.as_number(size) for size in sizes], "_cell")
