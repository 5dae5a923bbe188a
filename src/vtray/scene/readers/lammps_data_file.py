"""Data files of LAMMPS, with NumPy alone.

References
----------
https://docs.lammps.org/read_data.html
"""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.column_names import IMAGES, name_columns
from vtray.scene.particles.elements import are_symbols
from vtray.scene.particles.masses import elements_of_masses
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.plain_numbers import parsed
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.lines import Lines
from vtray.scene.readers.reader_table import Given
from vtray.scene.readers.rows import check_places, read_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Cell = NDArray[np.float64]

Said = TypeVar("Said", float, str)

_STYLES = {
    "atomic": "id type x y z",
    "charge": "id type q x y z",
    "bond": "id mol type x y z",
    "angle": "id mol type x y z",
    "molecular": "id mol type x y z",
    "full": "id mol type q x y z",
    "amoeba": "id mol type q x y z",
    "dipole": "id type q x y z mux muy muz",
    "sphere": "id type diameter density x y z",
    "ellipsoid": "id type ellipsoid density x y z",
    "bpm/sphere": "id mol type diameter density x y z",
    "line": "id mol type line density x y z",
    "tri": "id mol type triangle density x y z",
    "body": "id type body mass x y z",
    "template": "id mol template atom type x y z",
    "spin": "id type x y z spx spy spz sp",
    "electron": "id type q espin eradius x y z",
    "dielectric": "id mol type q x y z mux muy muz area ed em epsilon curvature",
    "dpd": "id type theta x y z",
    "edpd": "id type temperature cv x y z",
    "mdpd": "id type rho x y z",
    "peri": "id type volume density x y z",
    "rheo": "id type status rho x y z",
    "rheo/thermal": "id type status rho energy x y z",
    "sph": "id type rho esph cv x y z",
    "smd": "id type mol volume mass kradius cradius x0 y0 z0 x y z",
}
"""The columns of the section Atoms, by its style; three integers, the images, may follow."""

_OPEN = {"hybrid": "id type x y z", "tdpd": "id type x y z"}
"""Likewise where others follow that are not said, so that images are not told from them."""

_BY_WIDTH = {5: "atomic", 8: "atomic", 7: "full", 10: "full"}
"""The style where none is named, by the number of columns."""

_INTEGERS = (
    "id",
    "mol",
    "type",
    "ellipsoid",
    "line",
    "triangle",
    "body",
    "template",
    "atom",
    "espin",
    "status",
)

_INTEGER = re.compile("[-+]?[0-9]+")

_COUNT = re.compile(r"\s*([0-9]{1,18})\s+([a-z ]+?)\s*")

_BOUNDS = re.compile(r"\s*(\S+)\s+(\S+)\s+([xyz])lo\s+[xyz]hi\s*")

_TILTS = re.compile(r"\s*(\S+)\s+(\S+)\s+(\S+)\s+xy\s+xz\s+yz\s*")

_EDGE = re.compile(r"\s*(\S+)\s+(\S+)\s+(\S+)\s+([abc]vec|abc\s+origin)\s*")

_OTHER = re.compile(r"[A-Z]|[-+0-9.]")
"""What titles of other sections, and their rows, begin with."""

_SECTIONS = {"Velocities": ("atoms", "IRRR"), "Bonds": ("bonds", "IIII")}
"""What is read beside the atoms: what counts its rows, and the kinds of their entries."""

_MASSES, _LABELS = "Masses", "Atom Type Labels"
"""The sections that say something of each type: its mass, and its name, which may stand for it."""


class _Types(NamedTuple):
    """What is said of the types of atoms, by their numbers as text, or by their names.

    Attributes
    ----------
    masses
        Their masses.
    notes
        The words behind these, which are often the names of elements.
    labels
        Their names by their numbers, if they have some.
    """

    masses: dict[str, float]
    notes: dict[str, str]
    labels: dict[str, str]

    def names_of(self, kinds: "Sequence[int | str]") -> "list[str]":
        """Return the names of types: their labels, if they have some, or their numbers."""
        return [self.labels.get(str(kind), str(kind)) for kind in kinds]

    def masses_of(self, names: "Sequence[str]") -> list[float]:
        """Return the masses of types; NaN where one is not known."""
        known = self._by_name(self.masses)
        return [known.get(name, math.nan) for name in names]

    def elements_of(self, names: "Sequence[str]") -> "list[str] | None":
        """Return the elements of types, if their names, the notes, or their masses tell them."""
        import numpy as np

        known = self._by_name(self.notes)
        noted = [known.get(name, "") for name in names]
        for found in ([*names], noted):
            if found and are_symbols(found):
                return found
        by_masses = elements_of_masses(np.array(self.masses_of(names)))
        return None if by_masses is None else by_masses.tolist()

    def _by_name(self, found: "Mapping[str, Said]") -> "dict[str, Said]":
        """Return what is said of types by their names."""
        return {self.labels.get(kind, kind): said for kind, said in found.items()}


class _Box:
    """What the head of a file says of the box.

    Attributes
    ----------
    bounds
        Least and greatest x, y and z.
    tilts
        By how much edges lean: xy, xz, yz.
    vectors
        The edges avec, bvec and cvec, and their origin, where a box is said so.
    """

    def __init__(self) -> None:
        self.bounds: dict[str, tuple[float, float]] = {}
        self.tilts = [0.0, 0.0, 0.0]
        self.vectors: dict[str, list[float]] = {}

    def take(self, line: str, number: int) -> bool:
        """Take a line of the head if it is one of the box, and tell whether it was."""
        if bound := _BOUNDS.fullmatch(line):
            low, high = _numbers(bound.group(1, 2), number)
            self.bounds[bound[3]] = (low, high)
        elif tilt := _TILTS.fullmatch(line):
            self.tilts = _numbers(tilt.group(1, 2, 3), number)
        elif edge := _EDGE.fullmatch(line):
            self.vectors[edge[4].split()[-1]] = _numbers(edge.group(1, 2, 3), number)
        else:
            return False
        return True

    def edges(self) -> "tuple[Cell | None, Cell]":
        """Return the edges of the box, if there is one, and its corner."""
        import numpy as np

        if {"avec", "bvec", "cvec"} <= self.vectors.keys():
            edges = np.array([self.vectors[name] for name in ("avec", "bvec", "cvec")])
            return edges, np.array(self.vectors.get("origin", [0.0, 0.0, 0.0]))
        if len(self.bounds) < 3:
            return None, np.zeros(3)
        x, y, z = (high - low for low, high in (self.bounds[name] for name in "xyz"))
        xy, xz, yz = self.tilts
        corner = np.array([self.bounds[name][0] for name in "xyz"])
        return np.array([(x, 0.0, 0.0), (xy, y, 0.0), (xz, yz, z)]), corner


def read(given: Given) -> Particles:
    """Read a data file.

    Columns are those of its style, with ``type``, a number or a label, ``charge`` (its q),
    ``radius`` (half its diameter), ``mass`` (of its types) and ``velocity``. LAMMPS knows no
    elements: they are those of the labels, or of the words behind the masses, if all are symbols,
    or else of the masses.

    Raises
    ------
    SceneError
        The file is not right, or another frame than its only one is asked for. The message names
        the line.
    """
    import numpy as np

    frame_number(given.frame, 1)
    box = _Box()
    atoms, sections, types = _sections_of(Lines(given.file), box)
    rows = {number: row for row, number in enumerate(atoms["id"].tolist())}
    positions = np.stack([atoms.pop(name) for name in "xyz"], axis=1)
    if "diameter" in atoms:
        atoms["radius"] = atoms.pop("diameter") / 2
    # Asked once for all atoms of a type.
    kinds, which = np.unique(atoms["type"], return_inverse=True)
    names = types.names_of(kinds.tolist())
    if types.labels:
        atoms["type"] = np.array(names)[which]
    elements = types.elements_of(names)
    if elements is not None:
        atoms = {"element": np.array(elements)[which], **atoms}
    if types.masses:
        atoms["mass"] = np.array(types.masses_of(names))[which]
    if "Velocities" in sections:
        ids, values = sections["Velocities"][:, 0], sections["Velocities"][:, 1:]
        atoms["velocity"] = np.zeros((len(rows), 3))
        atoms["velocity"][_places(ids, rows, "Velocities")] = values
    bonds = None
    if "Bonds" in sections:
        bonds = _places(sections["Bonds"][:, 2:].ravel(), rows, "Bonds").reshape(-1, 2)
    cell, origin = box.edges()
    return Particles(positions, name_columns(atoms), bonds=bonds, cell=cell, origin=origin)


def _sections_of(lines: Lines, box: _Box) -> "tuple[dict[str, Array], dict[str, Array], _Types]":
    """Read the whole file: return the columns of the atoms, sections of numbers, and the types."""
    import numpy as np

    counts: dict[str, int] = {}
    types = _Types({}, {}, {})
    atoms: dict[str, Array] = {}
    found: dict[str, Array] = {}
    lines.next()  # the first line is a title
    while (text := lines.next()) is not None:
        title, _, note = (part.strip() for part in text.partition("#"))
        count = _COUNT.fullmatch(title)
        if count:
            counts[count[2]] = int(count[1])
        elif title == "Atoms":
            atoms = _atoms_of(lines, counts.get("atoms", 0), note)
        elif title in _SECTIONS:
            counted, kinds = _SECTIONS[title]
            lines.next()
            rows = read_rows(lines, counts.get(counted, 0), kinds, more=True)
            found[title] = np.stack(rows, axis=1)
        elif title in (_MASSES, _LABELS):
            for kind, word, note in _of_types(lines, counts.get("atom types", 0), title):
                if title == _LABELS:
                    types.labels[kind] = word
                else:
                    (types.masses[kind],) = _numbers((word,), lines.number)
                    types.notes[kind] = note
        elif title and not box.take(title, lines.number) and not _OTHER.match(title):
            raise SceneError(f"line {lines.number}: expected a section, got {short(title)!r}")
    if not atoms:
        raise SceneError("expected the number of atoms, and a section Atoms; there is none")
    return atoms, found, types


def _of_types(lines: Lines, count: int, title: str) -> Iterator[tuple[str, str, str]]:
    """Give what a section says of each type, a word, and what is noted behind it."""
    lines.next()
    for k in range(count):
        text = lines.next()
        if text is None:
            raise SceneError(f"line {lines.number}: the file ends after {k} of {count} rows")
        row, _, note = text.partition("#")
        parts = row.split()
        if len(parts) < 2:
            raise SceneError(f"line {lines.number}: section {title}: expected a type and a word")
        yield parts[0], parts[1], note.strip()


def _atoms_of(lines: Lines, count: int, style: str) -> "dict[str, Array]":
    """Read the section Atoms."""
    import numpy as np

    lines.next()
    place = lines.place()
    first = (lines.next() or "").partition("#")[0].split()
    lines.go(place)
    name = (style.split() or [_BY_WIDTH.get(len(first), "")])[0]  # "hybrid" names others
    if name not in _STYLES and name not in _OPEN:
        problem = f"the style {short(style)!r} is not known" if style else "the style is not said"
        known = ", ".join((*_STYLES, *_OPEN))
        remedy = f"expected, as in 'Atoms # full', one of {known}"
        raise SceneError(f"line {lines.number - 1}: {problem}; {remedy}")
    names = (_STYLES | _OPEN)[name].split()
    kind_of = dict.fromkeys(names, "R") | dict.fromkeys((*_INTEGERS, *IMAGES), "I")
    entries = dict(zip(names, first, strict=False))
    if re.match("[A-Za-z]", entries.get("type", "")):
        kind_of["type"] = "S"  # called by their labels
    has_images = len(first) == len(names) + 3 and all(map(_INTEGER.fullmatch, first[-3:]))

    def rows_of(names: list[str]) -> "dict[str, Array]":
        kinds = "".join(kind_of[name] for name in names)
        return dict(zip(names, read_rows(lines, count, kinds, more=True), strict=True))

    try:
        columns = rows_of([*names, *IMAGES] if has_images else names)
    except SceneError:
        if not has_images:
            raise
        lines.go(place)
        columns = rows_of(names)  # some rows say no images
    positions = np.stack([columns[name] for name in "xyz"], axis=1)
    check_places(positions, range(lines.number - count + 1, lines.number + 1))
    return columns


def _places(ids: "Array", rows: dict[int, int], title: str) -> "Array":
    """Return which atoms have some ids."""
    import numpy as np

    try:
        return np.array([rows[int(number)] for number in ids.tolist()], np.int64)
    except KeyError as error:
        raise SceneError(f"section {title}: no atom has the id {error}") from None


def _numbers(texts: tuple[str, ...], line: int) -> list[float]:
    """Return texts as numbers."""
    try:
        return [parsed(text) for text in texts]
    except ValueError:
        shown = short(" ".join(texts))
        raise SceneError(f"line {line}: expected numbers, got {shown!r}") from None
