"""A short run of the finder of scenes whose picture is not what the rules say."""

import json
from pathlib import Path

import numpy as np
import pytest

import oracle
from conftest import compiled_only
from fuzz import truth

pytestmark = compiled_only


@pytest.mark.parametrize("seed", range(3))
def test_random_scenes_are_what_the_rules_say(seed: int) -> None:
    for number in range(25):
        scene = truth.random_scene(np.random.default_rng((seed, number)))
        assert truth.fault_of(scene) is None, json.dumps(scene)


def test_a_fault_is_found_and_saved_as_a_small_scene(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(oracle, "ROUNDING", 1e-3)  # of another bound, hits and shadows are others
    assert truth.main(["--seconds", "1e-4", "--seed", "4", "--failures", str(tmp_path)]) == 1
    told = capsys.readouterr().out
    assert told.startswith("truth: seed 4\n")
    path = tmp_path / "truth-4-0.json"
    assert str(path) in told
    small = json.loads(path.read_text())
    assert truth.fault_of(small) is not None
    assert len(small["objects"]) < len(truth.random_scene(np.random.default_rng((4, 0)))["objects"])
