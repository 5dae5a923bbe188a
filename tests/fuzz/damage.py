"""Ways to spoil data."""

import json
from random import Random
from typing import Any

STRANGE: list[Any] = [
    *(None, True, False, 0, -1, 1, 2, 3.5, -0.0, 1e-320, 5e-324, 1e-30, 1e13, 1e154, 1e300),
    *(1.8e308, -1.8e308, 10**400, 255, 256, 2**31, 2**63, 2**64, "", "sphere", "spheres", "\0"),
    *("\x1b[2J\u202e\nError: x", "ok.npz\n", "../a.npz", "é", [], {}, [0], [1, 1], [2, 3, 4]),
    *({"x": 0, "y": 0, "z": 1}, {"r": 1, "g": 2, "b": 3}, [[[[]]]]),
]


def damaged_bytes(data: bytes, random: Random) -> bytes:
    """Return data with some bytes changed, cut out, doubled or put in."""
    spoilt = bytearray(data)
    for _ in range(random.choice([1, 1, 1, 2, 5, 20])):
        # Beginnings and ends say what a file is, and the middle is often only pixels.
        within = min(random.choice([10, 200, 200, len(spoilt)]), len(spoilt))
        place = random.choice([0, len(spoilt) - within]) + random.randrange(within + 1)
        length = random.choice([1, 1, 2, 4, 8, 100])
        kind = random.randrange(5)
        if kind == 0 and place < len(spoilt):
            spoilt[place] ^= 1 << random.randrange(8)
        elif kind == 1:
            spoilt[place : place + length] = random.randbytes(length)
        elif kind == 2:
            del spoilt[place : place + length]
        elif kind == 3:
            spoilt[place:place] = spoilt[place : place + length]
        else:
            del spoilt[random.choice([place, len(spoilt) - length]) :]
    return bytes(spoilt)


def damaged_json(document: Any, random: Random) -> bytes:
    """Return a document with some values exchanged, keys renamed or missing, and broken text."""
    found: Any = json.loads(json.dumps(document))
    for _ in range(random.choice([0, 1, 1, 1, 2, 4])):
        found = _damaged_value(found, random, random.choice([0.2, 0.5, 0.9]))
    text = json.dumps(found).encode()
    return damaged_bytes(text, random) if random.random() < 0.3 else text


def _damaged_value(value: Any, random: Random, deeper: float) -> Any:
    """Return a value with one part changed."""
    if isinstance(value, dict) and value and random.random() < deeper + 0.3:
        key = random.choice(list(value))
        kind = random.random()
        if kind < 0.1:
            return {k: v for k, v in value.items() if k != key}
        if kind < 0.2:
            return {**value, str(random.choice(STRANGE)): value[key]}
        return {**value, key: _damaged_value(value[key], random, deeper)}
    if isinstance(value, list) and value and random.random() < deeper + 0.3:
        place = random.randrange(len(value))
        changed = [*value]
        changed[place] = _damaged_value(value[place], random, deeper)
        return changed * random.choice([1, 1, 1, 1, 2, 0])
    return random.choice(STRANGE)
