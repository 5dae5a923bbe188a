"""The transfer function of sRGB against its formula, and what colours are as light."""

from decimal import Decimal, localcontext
from typing import get_args

import numpy as np
import pytest

import vtray
from vtray.scene.colors.color_light import as_light, light_of, light_of_numbers, numbers_of_light
from vtray.scene.colors.srgb import decode_srgb, encode_srgb
from vtray.scene.colors.tone_map_names import ToneMapName, is_encoded
from vtray.scene.vectors import Color


def true_light(encoded: Decimal) -> Decimal:
    """Return the light of a number of sRGB, by IEC 61966-2-1."""
    if encoded <= Decimal("0.04045"):
        return encoded / Decimal("12.92")
    return ((encoded + Decimal("0.055")) / Decimal("1.055")) ** Decimal("2.4")


def true_number(light: Decimal) -> Decimal:
    """Return the number of sRGB for some light, by IEC 61966-2-1."""
    if light <= Decimal("0.0031308"):
        return light * Decimal("12.92")
    return Decimal("1.055") * light ** (1 / Decimal("2.4")) - Decimal("0.055")


def test_each_number_is_decoded() -> None:
    found = decode_srgb(np.arange(256.0) / 255.0)
    for number, light in enumerate(found.tolist()):
        with localcontext(prec=40):
            assert abs(Decimal(light) - true_light(Decimal(number) / 255)) < Decimal(2.0**-43)
    assert (found[0], found[255]) == (0.0, 1.0)


def test_light_is_encoded() -> None:
    values = [*np.linspace(0, 1, 300).tolist(), 0.0031308, 0.00313, 0.0032, 1e-9]
    for light, number in zip(values, encode_srgb(np.array(values)).tolist(), strict=True):
        with localcontext(prec=40):
            assert abs(Decimal(number) - true_number(Decimal(light))) < Decimal(2.0**-42)
    black, white = encode_srgb(np.array([0.0, 1.0])).tolist()
    assert (black, white) == (0.0, 1.055 - 0.055)


@pytest.mark.parametrize("most", [255, 65535])
def test_there_and_back(most: int) -> None:
    numbers = np.arange(most + 1.0)
    light = decode_srgb(numbers / most)
    assert (np.diff(light) > 0.0).all()
    assert np.abs(most * encode_srgb(light) - numbers).max() < 0.002  # where both parts meet
    assert np.array_equal(np.rint(most * encode_srgb(light)), numbers)


def test_what_numbers_are_as_light() -> None:
    assert light_of_numbers("linear").tolist() == list(range(256))
    for tonemap in get_args(ToneMapName)[1:]:
        table = light_of_numbers(tonemap)
        assert is_encoded(tonemap)
        assert (table[0], table[255], table.shape) == (0.0, 255.0, (256,))
        assert np.array_equal(table, light_of_numbers("srgb"))
        # 188 is about half of the light of white.
        assert light_of(vtray.Color(188, 0, 255), tonemap)[0] == pytest.approx(128.2, abs=0.1)
    assert not is_encoded("linear")
    assert light_of(vtray.Color(188, 0, 255), "linear") == (188.0, 0.0, 255.0)
    with pytest.raises(ValueError, match="read-only"):
        light_of_numbers("srgb")[0] = 1.0


@pytest.mark.parametrize("tonemap", ["linear", "srgb"])
def test_colors_as_light_and_back(tonemap: ToneMapName) -> None:
    for k in range(256):
        color = Color(k, 255 - k, 7 * k % 256)
        light = as_light((color.r, color.g, color.b), tonemap)
        assert light == light_of(color, tonemap)
        assert numbers_of_light(light, tonemap) == (color.r, color.g, color.b)
    between = (0.5, 100.25, 254.9)
    assert numbers_of_light(as_light(between, tonemap), tonemap) == pytest.approx(between)
