"""What files hold beside the picture has one table."""

import argparse
import io
import json
from pathlib import Path

import numpy as np
import pytest
from examples import one_sphere
from pictures import HandMade, hand_made, read_exr

import vtray
from conftest import once
from vtray.commands import options
from vtray.image.aovs import AOVS, Aov, aov_of
from vtray.image.formats.exr_file import write_exr
from vtray.image.formats.image_format import check_format
from vtray.image.formats.npz_file import write_npz
from vtray.image.formats.picture import How


@once
@pytest.mark.parametrize("name", AOVS)
def test_arrays_are_as_the_table_says(name: str) -> None:
    document = one_sphere()
    document["camera"].update(size=[12, 9], resolution=[0.4, 0.4])
    image = vtray.render(vtray.loads(json.dumps(document)))
    found, row = getattr(image, name), AOVS[name]
    channels = len(row.channels)
    assert (found.dtype, found.shape) == (row.dtype, (9, 12, channels)[: 2 + (channels > 1)])
    assert aov_of(image, name) is found
    assert getattr(vtray.Image, name).__doc__


@pytest.mark.parametrize("ending", [".npz", ".exr"])
def test_all_are_told(ending: str, tmp_path: Path) -> None:
    hand_made().save(tmp_path / f"a{ending}", aov=AOVS)
    assert vtray.read_provenance(tmp_path / f"a{ending}").aov == tuple(AOVS)


class WithMore(HandMade):
    """A picture of which more is known."""

    samples_taken = np.full((7, 9), -1, np.int32)
    shares = np.linspace(0, 1, 7 * 9 * 3).reshape(7, 9, 3)


@pytest.fixture
def picture(monkeypatch: pytest.MonkeyPatch) -> WithMore:
    monkeypatch.setitem(AOVS, "samples_taken", Aov("int32", ("count",)))
    monkeypatch.setitem(AOVS, "shares", Aov("float64", ("share.R", "share.G", "share.B")))
    image = hand_made()
    image.__class__ = WithMore
    return image


def test_new_row_is_an_option(picture: WithMore) -> None:
    assert options.parse(["a.json", "a.npz", "--aov", "shares,ids"]).aov == ("shares", "ids")
    names = "depth, normals, ids, copies, raw, albedo, error, samples, direct, indirect, emission"
    names += ", samples_taken, shares"
    with pytest.raises(argparse.ArgumentTypeError, match=f"expected names of {names} with"):
        options._aov("light")
    assert check_format(Path("a.npz"), aov=["shares", "ids"]).aov == ("ids", "shares")
    with pytest.raises(vtray.OutputError, match=f"aov: expected names of {names}, got 'light'"):
        check_format(Path("a.npz"), aov=["light"])


def test_new_row_is_written(picture: WithMore) -> None:
    how = How(aov=("samples_taken", "shares"))
    file = io.BytesIO()
    write_npz(picture, how, file)
    file.seek(0)
    with np.load(file) as found:
        np.testing.assert_array_equal(found["shares"], picture.shares)
        np.testing.assert_array_equal(found["samples_taken"], picture.samples_taken)
    file = io.BytesIO()
    write_exr(picture, how, file)
    _, channels = read_exr(file.getvalue())
    assert set(channels) == {*"RGB", "count", "share.R", "share.G", "share.B"}
    assert (channels["count"] == 2**32 - 1).all()
    np.testing.assert_array_equal(channels["share.G"], picture.shares[..., 1].astype("f4"))
