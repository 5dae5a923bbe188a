"""The bar that shows progress on stderr."""

import pytest

from vtray.base import progress
from vtray.base.progress import ProgressBar


def test_bar_that_stays(capsys: pytest.CaptureFixture[str]) -> None:
    bar = ProgressBar("frame", stays=True)
    bar("frames", 1, 4)
    bar("frames", 4, 4)
    bar.close()
    shown = capsys.readouterr().err
    assert "frames: 100%" in shown
    assert shown.endswith("\n")


def test_total_that_is_not_known(capsys: pytest.CaptureFixture[str]) -> None:
    bar = ProgressBar("frame", stays=True)
    bar("frames", 3, 0)
    bar.close()
    assert "frames: 3frame " in capsys.readouterr().err


def test_bar_that_waits_and_goes(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    bar = ProgressBar()
    bar("trace", 1, 2)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(progress, "DELAY_SECONDS", -1.0)
    bar("trace", 2, 2)
    bar.close()
    bar.close()  # once more does nothing
    shown = capsys.readouterr().err
    assert "trace: 100%" in shown
    assert shown.endswith("\r")
