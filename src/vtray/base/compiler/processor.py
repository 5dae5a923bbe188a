"""Which processor this is, as far as compiled code depends on it."""

import contextlib
import os
import sys
from functools import cache
from pathlib import Path

CPUINFO = Path("/proc/cpuinfo")
"""What Linux tells of each processor, one after the other."""

_TOLD = ("vendor_id", "cpu family", "model", "model name", "stepping", "flags")


@cache
def processor() -> str:
    """Return a text that differs where code for this processor might not run, or not as fast."""
    return _told_by_linux() or _told_by_llvm()


def _told_by_linux() -> str:
    """Return what Linux tells of an x86-64, which takes no time, "" if it tells too little."""
    if sys.platform != "linux" or os.uname().machine != "x86_64":
        return ""
    found: dict[str, str] = {}
    with contextlib.suppress(OSError), CPUINFO.open() as lines:
        for line in lines:
            key, _, value = line.partition(":")
            if not value:  # an empty line: the next processor
                break
            found[key.strip()] = value.strip()
    return "\n".join(found[key] for key in _TOLD) if set(_TOLD) <= set(found) else ""


def _told_by_llvm() -> str:
    """Return what LLVM tells, which has to be loaded for that."""
    from llvmlite import binding

    told = binding.get_process_triple(), binding.get_host_cpu_name()
    return "\n".join([*told, binding.get_host_cpu_features().flatten()])
