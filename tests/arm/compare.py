"""Compares the pictures of this machine with those of an aarch64 one, which is emulated.

    make arm

It takes seven minutes, most of them for the compiler under emulation, and 700 MB in build/arm.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "reference"))

from machine import ROOT, aarch64_machine, this_machine
from machine_code import inexact_in

from vtray.base.compiler.kept_functions import KeptFunction
from vtray.base.compiler.object_code import read_object_code, read_struct

FOLDER = ROOT / "build" / "arm"
DRAWINGS = Path(__file__).with_name("drawings.py")


def differences(here: Path, there: Path) -> Iterator[str]:
    """Give what differs between the files of two machines."""
    names = {file.name for folder in (here, there) for file in folder.iterdir()}
    for name in sorted(names):
        if not ((here / name).is_file() and (there / name).is_file()):
            yield f"{name}: is only on one machine"
        elif not name.endswith(".npz"):
            if (here / name).read_bytes() != (there / name).read_bytes():
                yield f"{name}: other bytes"
        else:  # the frame around the arrays is of Python's version
            with np.load(here / name) as these, np.load(there / name) as those:
                if these.files != those.files:
                    yield f"{name}: other arrays"
                for key in set(these.files) & set(those.files):
                    if these[key].tobytes() != those[key].tobytes():
                        yield f"{name}: {key}: other numbers"


def inexact_kernels(folder: Path) -> Iterator[str]:
    """Give what kernels do that IEEE 754 does not define."""
    for file in folder.rglob("*.kernel"):
        kernel = read_object_code(file)
        if kernel is None:
            # What kernels call is kept as well, before it is machine code.
            if read_struct(file, KeptFunction) is None:
                yield f"{file.name}: (damaged)"
            continue
        # The parts that it calls are files of their own.
        for name in sorted(inexact_in(kernel.code) - set(kernel.parts)):
            yield f"{file.name}: {name}"


def main() -> None:
    """Draw on both machines, twice on the other, and end with status 1 if anything differs."""
    there = aarch64_machine(FOLDER)
    here = this_machine(FOLDER)
    print("this machine", flush=True)
    here.run(DRAWINGS, FOLDER / "here")
    print("aarch64, with the compiler", flush=True)
    first = there.run(DRAWINGS, FOLDER / "there")
    kept = {file: file.stat().st_mtime_ns for file in there.kernels.rglob("*.kernel")}
    print("aarch64, with kernels from disk", flush=True)
    again = there.run(DRAWINGS, FOLDER / "again")

    found = [f"aarch64: {line}" for line in differences(FOLDER / "here", FOLDER / "there")]
    found += [f"aarch64 again: {line}" for line in differences(FOLDER / "there", FOLDER / "again")]
    found += [line for machine in (here, there) for line in inexact_kernels(machine.kernels)]
    if (first.split()[-1], again.split()[-1]) != ("compiled", "loaded"):
        found.append("aarch64: kernels were not kept on disk, or not loaded from there")
    if not kept or kept != {file: file.stat().st_mtime_ns for file in kept}:
        found.append("aarch64: kernels were written again")
    files = len(list((FOLDER / "here").iterdir()))
    print(*found, f"{files} files, {len(kept)} kernels, {len(found)} differences", sep="\n")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
