"""Elements by their masses, beside those of ASE."""

import ase.data as ase_data
import numpy as np
import pytest

from vtray.scene.particles.masses import elements_of_masses

STABLE = [z for z in range(1, 84) if z not in (43, 61)]
"""Technetium and promethium have no standard weight."""


def test_weights_are_those_of_ase() -> None:
    symbols = [ase_data.chemical_symbols[z] for z in STABLE]
    assert elements_of_masses(ase_data.atomic_masses[STABLE]).tolist() == symbols


@pytest.mark.parametrize("z", STABLE)
def test_weights_off_by_more_than_rounding_are_those_of_nothing(z: int) -> None:
    carbon, weight = ase_data.atomic_masses[6], ase_data.atomic_masses[z]
    known = elements_of_masses(np.array([carbon, weight + 0.009]))
    assert known.tolist() == ["C", ase_data.chemical_symbols[z]]
    assert elements_of_masses(np.array([carbon, weight - 0.0009 * weight - 0.015])) is None


@pytest.mark.parametrize(
    ("masses", "expected"),
    [
        ([12.01, 16.0, 14.01, 1.008], "C O N H"),  # of Amber
        ([12.0, 16.0, 1.0, 15.9994], "C O H O"),
        ([15.9994, 1.008, 1.008, 0.0], None),
        ([13.019, 14.027, 15.035, 16.043, 14.0067], "C C C C N"),  # hydrogens in carbons
        ([2.014, 15.999], "H O"),
        ([0.0, 0.0], None),
        ([1.0], None),
        ([1.0, 4.0, 12.0], None),  # in units of their own
        ([72.0, 45.0], None),  # of Martini
        ([12.011, 72.0], None),
        ([3.024, 9.994, 15.999], None),  # of hydrogen as heavy as integrators want it
        ([12.011, np.nan], None),
        ([12.011, np.inf], None),
        ([12.011, -1.008], None),
        ([0.012, 0.001], None),  # in kg
        ([12.011, -0.001], None),
        ([], None),
        (["12.011"], None),
        ([[12.011, 1.008]], None),
        (np.linspace(1.0, 200.0, 1000), None),
    ],
)
def test_masses_tell_elements_where_all_do(masses: list[object], expected: str | None) -> None:
    found = elements_of_masses(np.array(masses))
    assert (None if found is None else found.tolist()) == (expected and expected.split())


def test_names_tell_what_has_no_mass() -> None:
    water = np.array([15.9994, 1.008, 1.008, 0.0])
    found = elements_of_masses(water, np.array(["OW", "HW1", "HW2", "MW"]))
    assert found.tolist() == ["O", "H", "H", "X"]
    assert elements_of_masses(water, np.array(["OW", "HW1", "HW2", "BB"])) is None
    assert elements_of_masses(water[::-1], np.array(["OW", "HW1", "HW2", "MW"])) is None
