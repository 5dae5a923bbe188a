"""Code that only passes tuples on is compiled once, and does what Python does."""

import gc
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from vtray.base.compiler import compiled, object_code, parts, unseen
from vtray.base.compiler.compiled import Device, Kernel, Part, passing_on, pinned
from vtray.base.compiler.unseen import apart

pytestmark = pytest.mark.usefixtures("compiler", "forgotten")


@apart
class Load(NamedTuple):
    """What is carried, into which only those look who weigh it."""

    boxes: Any
    bags: Any


class Cart(NamedTuple):
    """What carries it."""

    load: Load
    wheels: Any
    weight: float


class Trip(NamedTuple):
    """How often; kernels make it themselves."""

    cart: Cart
    times: int


def weigh(cart: Any, number: int) -> float:
    total = cart.weight + number
    for k in range(cart.load.boxes.size):
        total += cart.load.boxes[k]
    return total + last_of(cart.load.bags)


def last_of(bags: Any) -> float:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    return 0.0 if bags is None else bags[-1]


def haul(trip: Any) -> float:
    total = 0.0
    for number in range(trip.times):
        total += weigh_apart(trip.cart, number) * trip.cart.wheels[number]
    return total


def travel(cart: Any, times: int) -> Any:
    return haul_apart(Trip(cart, times)) - weigh_apart(cart, times)


def look_and_travel(cart: Any, times: int) -> Any:
    return haul_apart(Trip(cart, times)) + cart.load.boxes[0]


def look(cart: Any) -> Any:
    return cart.load.boxes[0]


# Only what is vtray's own is kept on disk.
for own in (last_of, weigh, haul, travel, look_and_travel, look):
    own.__module__ = "vtray.tests"

last_of = Device(last_of)  # type: ignore[assignment]
weigh_apart, haul_apart = Part(weigh), Part(passing_on(Load)(haul))
for passes in (travel, look):
    passing_on(Load)(passes)

WHEELS, BOXES = np.array([2.0, 3.0, 5.0]), np.array([1.0, 10.0])
CARTS = {
    "boxes": Cart(Load(BOXES, None), WHEELS, 0.5),
    "bags": Cart(Load(BOXES, np.array([7.0, 100.0])), WHEELS, 0.5),
    "small": Cart(Load(BOXES.astype(np.float32), None), WHEELS, 0.5),
}


def wanted(cart: Cart, times: int) -> float:
    """Return what `travel` does, in plain Python."""
    own = cart.weight + sum(cart.load.boxes.tolist())
    own += 0.0 if cart.load.bags is None else cart.load.bags[-1]
    return float(sum((own + k) * WHEELS[k] for k in range(times)) - (own + times))


def see_that_it_travels(*names: str) -> None:
    """See that a kernel does what it should, without Numba."""
    kernel = Kernel(travel)
    for name in names:
        assert kernel(CARTS[name], 3) == wanted(CARTS[name], 3)
    assert None not in kernel._native.values()


@pytest.fixture
def forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let parts be kept in a folder of the test, and what is in memory be forgotten."""
    tmp_path.chmod(0o700)
    (tmp_path / "kernels").mkdir(mode=0o700)
    monkeypatch.setattr(object_code, "cache_folder", lambda: tmp_path / "kernels")
    monkeypatch.setattr(compiled, "_trusted", [True])
    monkeypatch.setattr(parts, "_call_for", lambda *_: None)  # other processes have no such module
    monkeypatch.setitem(sys.modules, "vtray.tests", sys.modules[__name__])
    for name, part in (("weigh", weigh_apart), ("haul", haul_apart)):
        monkeypatch.setattr(sys.modules[__name__], name, part)
    begin_anew(monkeypatch)


def begin_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forget what a new process would not know."""
    for name in ("_addresses", "_unkept", "_origins"):
        monkeypatch.setattr(parts, name, {})
    monkeypatch.setattr(unseen, "_unsaid", {})
    kept_parts: dict[str, unseen.KeptPart] = {}
    for module in (parts, object_code):
        monkeypatch.setattr(module, "kept_parts", kept_parts)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the names of what is compiled."""
    names: list[str] = []
    compile_it = object_code._compile

    def noting(function: Any, *arguments: Any) -> Any:
        names.append(function.__name__)
        return compile_it(function, *arguments)

    monkeypatch.setattr(object_code, "_compile", noting)
    return names


def test_only_what_looks_into_a_tuple_is_compiled_again(
    made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    see_that_it_travels("boxes")
    assert sorted(made) == ["haul", "travel", "weigh"]
    made.clear()
    see_that_it_travels("bags", "boxes")
    assert made == ["weigh"]
    made.clear()
    begin_anew(monkeypatch)
    see_that_it_travels("bags", "boxes")
    assert made == []
    see_that_it_travels("small", "bags")
    assert made == ["weigh"]


def test_where_nothing_is_kept_parts_are_compiled_once(
    made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(object_code, "cache_folder", lambda: None)
    see_that_it_travels("boxes", "bags", "small")
    assert (made.count("haul"), made.count("weigh")) == (1, 3)


def test_code_that_looks_into_it_calls_what_does_not(made: list[str]) -> None:
    see_that_it_travels("bags")
    made.clear()
    kernel, cart = Kernel(look_and_travel), CARTS["bags"]
    assert kernel(cart, 3) == wanted(cart, 3) + 114.5 + BOXES[0]
    assert made == ["look_and_travel"]


@pytest.mark.parametrize("lost", ["weigh", "haul", "travel"])
@pytest.mark.parametrize("damage", [Path.unlink, lambda file: file.write_bytes(b"damaged")])
@pytest.mark.parametrize("name", ["boxes", "small"])
def test_what_is_lost_is_compiled_again(
    lost: str,
    damage: Callable[[Path], object],
    name: str,
    made: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    see_that_it_travels("boxes")
    for file in tmp_path.glob(f"kernels/vtray.tests.{lost}-*"):
        damage(file)
    made.clear()
    begin_anew(monkeypatch)
    see_that_it_travels(name)
    assert set(made) >= {lost} | ({"weigh"} if name == "small" else set())
    made.clear()
    begin_anew(monkeypatch)
    see_that_it_travels(name)
    assert made == []


def test_who_says_it_looks_into_nothing_must_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vtray.base.compiler.canary._warned", [])
    kernel = Kernel(look)
    with pytest.warns(UserWarning, match="Unknown attribute 'boxes' of type .*Load-unseen"):
        assert kernel(CARTS["boxes"]) == BOXES[0]


def test_pinned_tuples_keep_what_they_hold() -> None:
    kernel, cart = Kernel(travel), CARTS["bags"]
    pins = [pinned(cart) for _ in range(100)]
    gc.collect()
    assert {kernel(pin, 3) for pin in pins} == {wanted(cart, 3)}
