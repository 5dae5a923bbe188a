"""What the numbers were measured on."""

import os
import platform
import re
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from peers.programs import CUBE_PEERS, describe

CPU_INFO = Path("/proc/cpuinfo")


def machine() -> dict[str, str]:
    """Return name and value of all that bears on the numbers."""
    # "OVITO, Tachyon" is OVITO.
    by_package = {peer.name.split(",")[0]: peer for peer in CUBE_PEERS}
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "processor": f"{_processor()}, {cores()} cores",
        "load before the run": _load(),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
        "vtray": version("vtray"),
        "Numba": version("numba"),
        **{name: describe(peer) for name, peer in by_package.items()},
    }


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _processor() -> str:
    """Return the name of the processor."""
    text = CPU_INFO.read_text() if CPU_INFO.exists() else ""
    found = re.search(r"^model name\s*: *(.+)$", text, re.MULTILINE)
    return found[1] if found else platform.processor() or "unknown processor"


def _load() -> str:
    """Return how many processes were running in the last minute, besides this one."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
