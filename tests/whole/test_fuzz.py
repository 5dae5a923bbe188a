"""Each finder finds nothing in a few attempts, and finds what is broken on purpose."""

import json
from collections.abc import Iterable
from pathlib import Path
from random import Random

import oracle
import pytest

from conftest import JIT, compiled_only
from fuzz import damage, looks, truth
from fuzz.finders import FINDERS, try_once

ATTEMPTS: dict[str, Iterable[int]] = {
    "scenes": range(40),
    "arguments": range(60),
    "arrays": range(40),
    "pictures": range(60),
    "kernels": range(60),
    "faults": range(6),
    # Each kind of scene needs kernels of its own, which take four seconds to compile: so of the
    # first hundreds these are chosen, most of whose kernels other tests need as well.
    "truth": [*range(1, 6), 7, 8, 10, 11, *range(13, 19), *range(20, 24), 28, 29, 64, 76, 149],
}


UNCOMPILED: dict[str, Iterable[int]] = {
    "bounces": range(3),
    "styles": range(8),
    "values": range(60),
}
"""Those whose attempts need kernels of more kinds than tests have the time to compile."""


@pytest.mark.skipif(JIT, reason="would compile for minutes")
@pytest.mark.parametrize("name", UNCOMPILED)
def test_nothing_is_found_without_the_compiler(name: str, tmp_path: Path) -> None:
    failed = [k for k in UNCOMPILED[name] if not try_once(name, 1, k, tmp_path)]
    why = [(tmp_path / f"{name}-1-{k}" / "why.txt").read_text() for k in failed]
    assert not failed, "\n\n".join(why)


@compiled_only
@pytest.mark.parametrize("name", [name for name in FINDERS if name not in UNCOMPILED])
def test_nothing_is_found(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(looks, "SHARE", 0.0)
    failed = [k for k in ATTEMPTS.get(name, range(10)) if not try_once(name, 1, k, tmp_path)]
    why = [(tmp_path / f"{name}-1-{k}" / "why.txt").read_text() for k in failed]
    assert not failed, "\n\n".join(why)
    assert list(tmp_path.iterdir()) == []


@compiled_only
def test_what_is_found_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fuzz.kernels.read_object_code", lambda _: None)
    assert not try_once("kernels", 5, 3, tmp_path)
    (folder,) = tmp_path.iterdir()
    assert folder.name == "kernels-5-3"
    assert sorted(item.name for item in folder.iterdir()) == ["a.kernel", "why.txt"]
    assert "AssertionError" in (folder / "why.txt").read_text()


@compiled_only
def test_a_wrong_picture_is_found_and_saved_as_a_small_scene(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(oracle, "ROUNDING", 1e-3)  # of another bound, hits and shadows are others
    number = next(k for k in range(20) if not try_once("truth", 5, k, tmp_path))
    folder = tmp_path / f"truth-5-{number}"
    scene, small = (json.loads((folder / f"{n}.json").read_text()) for n in ("scene", "smaller"))
    assert truth.fault_of(small) is not None
    assert len(small["objects"]) <= len(scene["objects"])


@compiled_only
def test_the_same_seed_makes_the_same_attempt(tmp_path: Path) -> None:
    one, two = (damage.damaged_bytes(bytes(100), Random(7)) for _ in range(2))
    assert one == two != bytes(100)
