"""Pictures made by hand, and files read without the libraries that wrote them."""

import struct
import zlib
from typing import Any

import msgspec
import numpy as np

import vtray
from vtray.image.orders import Orders
from vtray.image.surfaces import Surfaces
from vtray.scene.settings import RenderSettings

SCENE = vtray.Scene(
    vtray.Camera((0, 0, 0), (0, 0, 1), focus=1, size=(9, 7), resolution=(0.1, 0.1)),
    [vtray.Light((0, 0, 0), 1)],
    [vtray.Sphere((0, 0, 5), 1, (255, 0, 0), 1)],
)


class HandMade(vtray.Image):
    """A picture whose pixels of 8 and 16 bits are made here, not by what is tested."""

    def develop(self, bits: int = 8) -> np.ndarray:
        maximum = 2**bits - 1
        values = np.floor(maximum * self.linear / max(self.white, 1e-300))
        if self.settings.background == "transparent":
            values = np.dstack([values, maximum * self.alpha])
        return values.astype(np.uint8 if bits == 8 else np.uint16)


def hand_made(
    width: int = 9, height: int = 7, *, chance: int = 1, covered: bool = True, **settings: Any
) -> HandMade:
    """Return a picture of random numbers."""
    random = np.random.default_rng(chance)
    linear = random.uniform(0, 1000, (height, width, 3))
    alpha = random.integers(0, 6, (height, width)) / 5
    depth = np.where(alpha > 0, random.uniform(1, 9, (height, width)), np.inf)
    normals = random.normal(size=(height, width, 3))
    ids = random.integers(0, 2**31 - 1, (height, width, 2)).astype(np.int32)
    ids[alpha == 0], linear[alpha == 0] = -1, 0

    def look() -> Surfaces:
        assert covered, "this picture must do without"
        halves, copies = np.zeros((height, width), np.int8), np.full((height, width), -1, np.int32)
        return Surfaces(depth, normals, ids, halves, copies)

    how = RenderSettings(**settings)
    white = float(linear.max()) if how.exposure == "max" else 255 / how.exposure
    shares = random.uniform(0, 1, (height, width, 3))

    def orders(_scene: vtray.Scene) -> Orders:
        assert covered, "this picture must do without"
        return Orders(linear * shares, linear * (1 - shares), 0 * linear)

    given: dict[str, Any] = {"look": look, "albedo": lambda _: shares, "alpha": alpha}
    given["orders"] = orders
    return HandMade(linear, None, white, SCENE, how, {}, **given)


def read_exr(data: bytes) -> tuple[dict[str, tuple[str, bytes]], dict[str, np.ndarray]]:
    """Read an EXR of scan lines, as "OpenEXR File Layout" describes it: attributes, channels."""
    magic, version = struct.unpack_from("<II", data)
    assert (magic, version) == (20000630, 2)
    at, attributes = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = (kind.decode(), data[at + 4 : at + 4 + size])
        at += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    assert (left, top) == (0, 0)
    width, height = right + 1, bottom + 1
    assert attributes["compression"] == ("compression", b"\x03")  # ZIP, 16 lines at a time
    kinds, listed = {}, attributes["channels"][1]
    while len(listed) > 1:
        name, rest = listed.split(b"\0", 1)
        kinds[name.decode()] = {0: np.dtype("<u4"), 2: np.dtype("<f4")}[rest[0]]
        listed = rest[16:]
    channels = {name: np.empty((height, width), kind) for name, kind in kinds.items()}
    offsets = struct.unpack_from(f"<{-(-height // 16)}Q", data, at + 1)
    for offset in offsets:
        first, size = struct.unpack_from("<ii", data, offset)
        raw = _unpack(data[offset + 8 : offset + 8 + size], width, min(16, height - first), kinds)
        for row in range(first, min(first + 16, height)):
            for name, kind in kinds.items():
                channels[name][row] = np.frombuffer(raw, kind, width)
                raw = raw[4 * width :]
    return attributes, channels


def _unpack(packed: bytes, width: int, rows: int, kinds: dict[str, Any]) -> bytes:
    size = 4 * width * rows * len(kinds)
    if len(packed) == size:
        return packed
    differences = np.frombuffer(zlib.decompress(packed), np.uint8).astype(int)
    differences[1:] -= 128
    bytes_ = (np.cumsum(differences) % 256).astype(np.uint8)
    both = np.empty(size, np.uint8)
    both[0::2], both[1::2] = bytes_[: -(-size // 2)], bytes_[-(-size // 2) :]
    return both.tobytes()


def png_chunks(data: bytes) -> list[tuple[str, bytes]]:
    """Return the chunks of a PNG, each with a right checksum."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, []
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        content = data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length) == (zlib.crc32(name + content),)
        chunks.append((name.decode(), content))
        at += 12 + length
    return chunks


def settings_dict(settings: RenderSettings) -> dict[str, Any]:
    """Return all settings by their names."""
    return msgspec.structs.asdict(settings)
