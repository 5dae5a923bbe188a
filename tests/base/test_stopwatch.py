"""Laps of a stopwatch."""

import pytest

from vtray.base import stopwatch
from vtray.base.stopwatch import Stopwatch


def test_what_belongs_to_no_step_is_in_none(monkeypatch: pytest.MonkeyPatch) -> None:
    now, apart = [10.0], [3.0]
    monkeypatch.setattr(stopwatch.time, "perf_counter", lambda: now[0])
    plain, clock = Stopwatch(), Stopwatch(lambda: apart[0])
    now[0], apart[0] = 12.0, 3.5
    plain.lap("build")
    clock.lap("build")
    now[0] = 13.0
    plain.lap("trace")
    clock.lap("trace")
    assert plain.seconds == {"build": 2.0, "trace": 1.0}
    assert clock.seconds == {"build": 1.5, "trace": 1.0}
    now[0], apart[0] = 14.0, 9.0  # another thread has done more meanwhile
    clock.lap("develop")
    assert clock.seconds["develop"] == 0.0
