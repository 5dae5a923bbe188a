"""Elements: symbols, radii and colours.

References
----------
B. Cordero et al., Covalent radii revisited, Dalton Trans. 2008, 2832.
S. Alvarez, A cartography of the van der Waals territories, Dalton Trans. 2013, 42, 8617.
https://jmol.sourceforge.net/jscolors/
"""

import math
import re
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.checks.object_column import MISSING_NAME
from vtray.scene.particles.few_names import texts_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[Any]


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


SYMBOLS = _words(
    """
    X H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As
    Se Br Kr Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd
    Tb Dy Ho Er Tm Yb Lu Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am
    Cm Bk Cf Es Fm Md No Lr Rf Db Sg Bh Hs Mt Ds Rg Cn Nh Fl Mc Lv Ts Og
    """
)
"""By atomic number; X, with 0, is what is no element."""

NO_ELEMENT = SYMBOLS[0]
"""Such as the sites without mass of some models of water."""

_COVALENT = _words(
    """
    1 0.31 0.28 1.28 0.96 0.84 0.76 0.71 0.66 0.57 0.58 1.66 1.41 1.21 1.11 1.07 1.05 1.02 1.06
    2.03 1.76 1.7 1.6 1.53 1.39 1.39 1.32 1.26 1.24 1.32 1.22 1.22 1.2 1.19 1.2 1.2 1.16 2.2
    1.95 1.9 1.75 1.64 1.54 1.47 1.46 1.42 1.39 1.45 1.44 1.42 1.39 1.39 1.38 1.39 1.4 2.44 2.15
    2.07 2.04 2.03 2.01 1.99 1.98 1.98 1.96 1.94 1.92 1.92 1.89 1.9 1.87 1.87 1.75 1.7 1.62 1.51
    1.44 1.41 1.36 1.36 1.32 1.45 1.46 1.48 1.4 1.5 1.5 2.6 2.21 2.15 2.06 2 1.96 1.9 1.87 1.8
    1.69 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2 2
    """
)
"""Å, by Cordero et al. (2008) to curium; 2 from there on, and 1 for X."""

_VDW = _words(
    """
    nan 1.2 1.43 2.12 1.98 1.91 1.77 1.66 1.5 1.46 1.58 2.5 2.51 2.25 2.19 1.9 1.89 1.82 1.83
    2.73 2.62 2.58 2.46 2.42 2.45 2.45 2.44 2.4 2.4 2.38 2.39 2.32 2.29 1.88 1.82 1.86 2.25 3.21
    2.84 2.75 2.52 2.56 2.45 2.44 2.46 2.44 2.15 2.53 2.49 2.43 2.42 2.47 1.99 2.04 2.06 3.48
    3.03 2.98 2.88 2.92 2.95 nan 2.9 2.87 2.83 2.79 2.87 2.81 2.83 2.79 2.8 2.74 2.63 2.53 2.57
    2.49 2.48 2.41 2.29 2.32 2.45 2.47 2.6 2.54 nan nan nan nan nan 2.8 2.93 2.88 2.71 2.82 2.81
    2.83 3.05 3.4 3.05 2.7 nan nan nan nan
    """
)
"""Å, by Alvarez (2013) to einsteinium, but for a few."""

_JMOL = _words(
    """
    ff1493 ffffff d9ffff cc80ff c2ff00 ffb5b5 909090 3050f8 ff0d0d 90e050 b3e3f5 ab5cf2 8aff00
    bfa6a6 f0c8a0 ff8000 ffff30 1ff01f 80d1e3 8f40d4 3dff00 e6e6e6 bfc2c7 a6a6ab 8a99c7 9c7ac7
    e06633 f090a0 50d050 c88033 7d80b0 c28f8f 668f8f bd80e3 ffa100 a62929 5cb8d1 702eb0 00ff00
    94ffff 94e0e0 73c2c9 54b5b5 3b9e9e 248f8f 0a7d8c 006985 c0c0c0 ffd98f a67573 668080 9e63b5
    d47a00 940094 429eb0 57178f 00c900 70d4ff ffffc7 d9ffc7 c7ffc7 a3ffc7 8fffc7 61ffc7 45ffc7
    30ffc7 1fffc7 00ff9c 00e675 00d452 00bf38 00ab24 4dc2ff 4da6ff 2194d6 267dab 266696 175487
    d0d0e0 ffd123 b8b8d0 a6544d 575961 9e4fb5 ab5c00 754f45 428296 420066 007d00 70abfa 00baff
    00a1ff 008fff 0080ff 006bff 545cf2 785ce3 8a4fe3 a136d4 b31fd4 b31fba b30da6 bd0d87 c70066
    cc0059 d1004f d90045 e00038 e6002e eb0026
    """
)
"""Those of Jmol to meitnerium; X is pink."""

_CPK = _words(
    """
    ff1493 ffffff ffc0cb b22222 ff1493 00ff00 c8c8c8 8f8fff f00000 daa520 ff1493 0000ff 228b22
    808090 daa520 ffa500 ffc832 00ff00 ff1493 ff1493 808090 ff1493 808090 ff1493 808090 808090
    ffa500 ff1493 a52a2a a52a2a a52a2a ff1493 ff1493 ff1493 ff1493 a52a2a ff1493 ff1493 ff1493
    ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 808090 ff1493 ff1493 ff1493 ff1493
    ff1493 a020f0 ff1493 ff1493 ffa500 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493
    ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493
    ff1493 daa520 ff1493 ff1493 ff1493 ff1493 ff1493 ff1493 ffffff ffffff ffffff ffffff ff1493
    ffffff ff1493 ffffff ffffff ffffff ffffff ffffff ffffff ffffff ffffff ffffff ffffff ffffff
    """
)
"""Those of RasMol to lawrencium; X is pink."""

_NONMETALS = frozenset(
    _words("X H He B C N O F Ne Si P S Cl Ar Ge As Se Br Kr Te I Xe At Rn Ts Og")
)
"""Elements that are no metals, those on the border among them."""

_ANIONS = frozenset(_words("N O F S Cl Se Br Te I"))
"""Nonmetals that metals give electrons to."""

_SEMIMETALS = frozenset(_words("B Si Ge As Te"))
"""Nonmetals of which solids are made whose atoms are all bound to each other."""

_PINK = "ff1493"
"""Of elements that a scheme does not know."""

_MORE = 1.0
"""Å by which a van-der-Waals radius that is not known is taken to be larger than the covalent."""

_NUMBERS = {symbol: number for number, symbol in enumerate(SYMBOLS)} | {"D": 1, "T": 1}
"""Atomic numbers by symbols; those of heavy hydrogen too."""

_LABEL = re.compile(r"([A-Za-z]{1,2})(?:[0-9+*'_-].*)?")
"""A symbol, and what tells atoms of one element apart: C1, Fe3+."""

RADII = ("covalent", "vdw")
"""The kinds of radii."""

SCHEMES = ("jmol", "cpk")
"""The schemes of colours."""


def symbol_of(name: str) -> str | None:
    """Return the symbol of an element as people may write it: "FE", "fe", "C1", "Fe3+"; or None."""
    label = _LABEL.fullmatch(name.strip())
    symbol = label[1].capitalize() if label else ""
    return symbol if symbol in _NUMBERS else None


def are_symbols(names: Iterable[str | None]) -> bool:
    """Tell whether all names are symbols, as they are written: "Ca", and not "CA" or "C1"."""
    return set(names).issubset(SYMBOLS)


def symbols_of(numbers: "ArrayLike") -> "NDArray[np.str_]":
    """Return the symbols of atomic numbers.

    Raises
    ------
    SceneError
        A number is none of 0 (for X) to 118.
    """
    import numpy as np

    given = np.asarray(numbers)
    wrong = ((given < 0) | (given >= len(SYMBOLS))).nonzero()[0]
    if len(wrong):
        first = int(wrong[0])
        problem = f"expected an atomic number from 0 to {len(SYMBOLS) - 1}, got {given[first]}"
        raise SceneError(f"element[{first}]: {problem}")
    found: NDArray[np.str_] = np.array(SYMBOLS)[given]
    return found


def symbols_or_none(names: "ArrayLike") -> "NDArray[np.str_] | None":
    """Return the symbols for names of atoms as people may write them; None if one is no element.

    Where a name is missing among others, that is X.
    """
    import numpy as np

    given = np.asarray(names)
    if given.dtype.kind not in "US" or given.ndim != 1:
        return None
    listed = given.astype(np.str_).tolist()
    known = {name: symbol_of(name) or "" for name in set(listed)}
    if known.keys() - {MISSING_NAME}:
        known[MISSING_NAME] = NO_ELEMENT
    return texts_of(listed, known.__getitem__) if all(known.values()) else None


def symbols_among(names: "Array") -> "NDArray[np.str_] | None":
    """Return the symbols for names of atoms, X where one is no element; None if none is one."""
    listed = names.tolist()
    known = {name: symbol_of(name) for name in set(listed)}
    if not any(known.values()):
        return None
    return texts_of(listed, lambda name: known[name] or NO_ELEMENT)


def atomic_numbers(symbols: "ArrayLike") -> "NDArray[np.int64]":
    """Return the atomic numbers of symbols; 0 for X, which stands for no element.

    Raises
    ------
    SceneError
        One is no symbol. The message names its index.
    """
    import numpy as np

    listed = np.asarray(symbols, np.str_).tolist()
    try:
        return np.fromiter(map(_NUMBERS.__getitem__, listed), np.int64, len(listed))
    except KeyError:
        first, name = next((i, s) for i, s in enumerate(listed) if s not in _NUMBERS)
        message = f"element[{first}]: expected the symbol of an element, got {short(name)!r}"
        raise SceneError(message) from None


def radii_of(symbols: "ArrayLike", kind: str = "covalent") -> "NDArray[np.float64]":
    """Return the radii of elements.

    Parameters
    ----------
    symbols
        Such as "Fe".
    kind
        "covalent", by Cordero et al. (2008), or "vdw", by Alvarez (2013). Where these know none,
        2 Å stand for a covalent radius, 1 Å for that of X, and 1 Å more for a van-der-Waals radius.

    Returns
    -------
    array (n,)
        In Å.

    Raises
    ------
    SceneError
        There is no such element, or no such kind.
    """
    numbers = atomic_numbers(symbols)
    return _radii(_one_of(kind, RADII, "radii"))[numbers]


def colors_of(symbols: "ArrayLike", scheme: str = "jmol") -> "NDArray[np.uint8]":
    """Return the colours of elements.

    Parameters
    ----------
    symbols
        Such as "Fe".
    scheme
        "jmol", or "cpk", that of RasMol.

    Returns
    -------
    array (n, 3)
        From 0 to 255.

    Raises
    ------
    SceneError
        There is no such element, or no such scheme.
    """
    numbers = atomic_numbers(symbols)
    return _colors(_one_of(scheme, SCHEMES, "colors"))[numbers]


def are_metals(symbols: "ArrayLike") -> "NDArray[np.bool_]":
    """Tell which symbols are those of metals, (n,)."""
    return ~_are_among(_NONMETALS)[atomic_numbers(symbols)]


def are_of_solids(symbols: "ArrayLike") -> "NDArray[np.bool_]":
    """Tell which symbols are those of metals and semimetals, (n,)."""
    return ~_are_among(_NONMETALS - _SEMIMETALS)[atomic_numbers(symbols)]


def are_anions(symbols: "ArrayLike") -> "NDArray[np.bool_]":
    """Tell which symbols are those of nonmetals that metals give electrons to, (n,)."""
    return _are_among(_ANIONS)[atomic_numbers(symbols)]


@cache
def _are_among(chosen: frozenset[str]) -> "NDArray[np.bool_]":
    """Tell by atomic number which elements are among some."""
    import numpy as np

    return np.array([symbol in chosen for symbol in SYMBOLS])


@cache
def _radii(kind: str) -> "NDArray[np.float64]":
    """Return the radii of all elements by atomic number."""
    import numpy as np

    covalent = [float(radius) for radius in _COVALENT]
    if kind == "covalent":
        return np.array(covalent)
    known = [float(radius) for radius in _VDW]
    known += [math.nan] * (len(covalent) - len(known))
    pairs = zip(known, covalent, strict=True)
    return np.array([one + _MORE if math.isnan(radius) else radius for radius, one in pairs])


@cache
def _colors(scheme: str) -> "NDArray[np.uint8]":
    """Return the colours of all elements by atomic number."""
    import numpy as np

    known = _JMOL if scheme == "jmol" else _CPK
    digits = [*known, *[_PINK] * (len(SYMBOLS) - len(known))]
    return np.array([list(bytes.fromhex(color)) for color in digits], np.uint8)


def _one_of(given: str, known: tuple[str, ...], name: str) -> str:
    """Return a choice, or raise SceneError if it is none of those that there are."""
    if given in known:
        return given
    words = " or ".join(map(repr, known))
    raise SceneError(f"{name}: expected {words}, got {short(str(given))!r}")
