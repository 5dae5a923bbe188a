"""Damaged kernels on disk: read as they were written, or not at all."""

from pathlib import Path
from random import Random

from fuzz.damage import damaged_bytes
from vtray.base.compiler.native_call import TupleLayout
from vtray.base.compiler.object_code import ObjectCode, read_object_code, write_object_code


def attempt(random: Random, folder: Path) -> None:
    """Read a damaged kernel."""
    layout = random.choice(["", "f8", TupleLayout("builtins:tuple", ["f8", "i8"])])
    kernel = ObjectCode("symbol", layout, random.randbytes(random.choice([0, 10, 5000])))
    file = folder / "a.kernel"
    write_object_code(file, kernel)
    whole = file.read_bytes()
    assert read_object_code(file) == kernel
    spoilt = damaged_bytes(whole, random)
    file.write_bytes(spoilt)
    assert read_object_code(file) == (kernel if spoilt == whole else None)
