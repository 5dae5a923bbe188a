"""Elements beside those of ASE."""

import ase.data as ase_data
import numpy as np
import pytest
from ase.data.colors import cpk_colors, jmol_colors
from ase.data.vdw_alvarez import vdw_radii

from vtray.base.errors import SceneError
from vtray.scene.particles.elements import (
    SYMBOLS,
    atomic_numbers,
    colors_of,
    radii_of,
    symbol_of,
    symbols_of,
    symbols_or_none,
)

ALL = np.array(SYMBOLS[1:])


def test_symbols_are_those_of_ase() -> None:
    assert list(SYMBOLS) == ase_data.chemical_symbols
    assert atomic_numbers(SYMBOLS).tolist() == list(range(119))
    assert symbols_of(range(119)).tolist() == list(SYMBOLS)


def test_radii_are_those_of_ase() -> None:
    covalent = radii_of(ALL)
    assert covalent[:96].tolist() == ase_data.covalent_radii[1:97].tolist()
    assert set(covalent[96:]) == {2}
    known = np.full(118, np.nan)
    known[: len(vdw_radii) - 1] = vdw_radii[1:]
    expected = np.where(np.isnan(known), covalent + 1, known)
    assert radii_of(ALL, "vdw").tolist() == expected.tolist()
    assert (radii_of(["X"], "vdw"), radii_of(["X"])) == (2, 1)


@pytest.mark.parametrize(("scheme", "theirs"), [("jmol", jmol_colors), ("cpk", cpk_colors)])
def test_colors_are_those_of_ase(scheme: str, theirs: np.ndarray) -> None:
    known = len(theirs) - 1
    found = colors_of(ALL, scheme)
    assert (np.abs(found[:known] - 255 * theirs[1:]) <= 0.5).all()
    assert (found[known:] == (255, 20, 147)).all()


def test_heavy_hydrogen_is_hydrogen() -> None:
    assert atomic_numbers(["D", "T"]).tolist() == [1, 1]


@pytest.mark.parametrize(
    ("name", "symbol"),
    [
        *[("FE", "Fe"), ("fe", "Fe"), (" C ", "C"), ("C1", "C"), ("Fe3+", "Fe"), ("O_w", "O")],
        *[("X", "X"), ("OW", None), ("", None), ("1", None), ("A", None), ("Carbon", None)],
    ],
)
def test_symbols_as_people_write_them(name: str, symbol: str | None) -> None:
    assert symbol_of(name) == symbol


def test_names_that_are_no_elements() -> None:
    assert symbols_or_none(["A", "B"]) is None
    assert symbols_or_none([1, 2]) is None
    assert symbols_or_none(["", ""]) is None
    assert symbols_or_none(["", "A", "C"]) is None
    assert symbols_or_none(["fe", "", "O"]).tolist() == ["Fe", "X", "O"]
    assert symbols_or_none(np.array([b"FE", b"o"])).tolist() == ["Fe", "O"]


def test_errors() -> None:
    with pytest.raises(
        SceneError, match=r"^element\[1\]: expected the symbol of an element, got 'Q"
    ):
        radii_of(["H", "Qq"])
    with pytest.raises(SceneError, match=r"^element\[2\]: expected an atomic number from 0 to 118"):
        symbols_of([1, 2, 119])
    with pytest.raises(SceneError, match="^radii: expected 'covalent' or 'vdw', got 'atomic'"):
        radii_of(["H"], "atomic")
    with pytest.raises(SceneError, match="^colors: expected 'jmol' or 'cpk', got 'vmd'"):
        colors_of(["H"], "vmd")
