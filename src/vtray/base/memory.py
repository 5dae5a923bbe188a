"""How much memory there is, and how much is used.

What there is, is the least of what the machine has and what this process and its groups may have.
It is looked at before the work, since an array that does not fit costs minutes, and LLVM ends the
process where it gets no memory.
"""

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from vtray.base.errors import RenderError

BYTES_PER_PIXEL = 3 * 8 + 3 + 4
"""Film, pixels, and the copy that the image encoder makes."""

BYTES_PER_SAMPLED_PIXEL = BYTES_PER_PIXEL + 8 + 4 + 8 + 1 + 1
"""The same with coverage, and what says which pixels get samples."""

BYTES_PER_PIXEL_AND_MORE = 175
"""With a background, or with depth, normals or ids, as measured."""

BYTES_PER_PIXEL_SHOWN = 110
"""While a picture grows: what there is of it, and copies that are shown and written."""

BYTES_PER_PIXEL_DENOISED = 300
"""For denoising: light, what guides it, and what the library takes."""

BYTES_PER_PIXEL_STARRY = 120
"""For the light of points that shine, as measured at 2000 x 2000 and 4000 x 4000 pixels: 113."""

BYTES_PER_PIXEL_IN_ORDERS = 150
"""For light by how often it was scattered: a film of it, and an array for each."""

BYTES_PER_SPHERE = 80
"""The hierarchy, and what it takes to build it, beside the arrays that were given."""


class Bytes(NamedTuple):
    """Memory in the three ways in which systems count it.

    Attributes
    ----------
    addresses
        All that has an address, shared libraries too (``ulimit -v``).
    data
        What the process has asked for itself (``ulimit -d``).
    resident
        What lies in the memory of the machine.
    """

    addresses: int
    data: int
    resident: int


NOTHING = Bytes(0, 0, 0)

START = Bytes(330_000_000, 100_000_000, 110_000_000)
"""What the least picture takes once kernels are compiled, as measured with Python 3.11 on Linux:
with 310, 80 and 105 MB it failed."""

COMPILER = Bytes(500_000_000, 320_000_000, 320_000_000)
"""What Numba and the compiling of the largest kernel take beside that."""

_REMEDY = "more memory for this process"

# What the system's loader of shared libraries says where memory is short.
_LOADER = ("failed to map segment", "cannot map zero-fill", "cannot allocate", "out of memory")


def check_memory(width: int, height: int, samples: int = 1, least: int = 0, more: int = 0) -> None:
    """Raise RenderError if an image of this size cannot be held in memory.

    Parameters
    ----------
    width, height
        In pixels.
    samples
        Of each pixel.
    least
        Bytes that each pixel takes at least, for what is done with it later.
    more
        Bytes that each pixel takes beside that.
    """
    what = f"camera.size: an image of {width} x {height} pixels needs"
    bytes_per_pixel = BYTES_PER_PIXEL if samples == 1 else BYTES_PER_SAMPLED_PIXEL
    _check(width * height * (max(bytes_per_pixel, least) + more), what, "a smaller size")


def check_memory_of_lights(rays: int, lights: int) -> None:
    """Raise RenderError if the lights of so many rays cannot be kept in memory."""
    what = f"keep_lights: {lights} lights for {rays} rays need"
    _check(rays * (8 * lights + 6), what, "a smaller size, fewer samples or fewer lights")


def check_memory_of_spheres(count: int) -> None:
    """Raise RenderError if so many spheres cannot be held in memory."""
    _check(count * BYTES_PER_SPHERE, f"objects: {count} spheres need", "fewer spheres")


def check_memory_of_start() -> None:
    """Raise RenderError if there is no memory for the libraries that every picture needs."""
    _check(0, "vtray needs", _REMEDY)


def check_memory_of_compiler() -> None:
    """Raise RenderError if kernels cannot be compiled, which LLVM would end the process for."""
    loaded = "numba" in sys.modules
    needed = COMPILER if not loaded else Bytes(*(size // 2 for size in COMPILER))
    _check(needed, "compiling for this machine, only this once, needs", _REMEDY)


def available_memory() -> int:
    """Return how many more bytes this process can have."""
    return max(min(limit.left for limit in _limits()), 0)


def lack_of_memory(needed: int | Bytes, start: Bytes = NOTHING) -> str | None:
    """Say what is needed and what there is; None if it is enough.

    Parameters
    ----------
    needed
        Bytes that are needed now.
    start
        What the process will have taken when all libraries are loaded.
    """
    each = needed if isinstance(needed, Bytes) else Bytes(needed, needed, needed)
    used = _used()
    for limit in _limits():
        to_come = max(start[limit.counts] - used[limit.counts], 0)
        total = each[limit.counts] + to_come
        if total > limit.left:
            return f"{readable(total)} of memory, {limit}"
    return None


def why_out_of_memory(error: BaseException) -> str | None:
    """Say what is missing if an error comes from a lack of memory; None if it does not.

    A library that cannot be loaded for that reason is no missing library.
    """
    if not is_out_of_memory(error):
        return None
    said = str(error).splitlines()[0] if str(error).startswith("Unable to allocate") else ""
    least = min(_limits(), key=lambda limit: limit.left)
    more = f" ({said[0].lower()}{said[1:]})" if said else ""
    return f"out of memory{more}: {least}; expected a smaller picture or scene, or {_REMEDY}"


def is_out_of_memory(error: BaseException | None) -> bool:
    """Tell whether an error, or what led to it, comes from a lack of memory."""
    while error is not None:
        if isinstance(error, MemoryError):
            return True
        if isinstance(error, (OSError, ImportError)):
            said = str(error).lower()
            if any(words in said for words in _LOADER):
                return True
        error = error.__cause__ or error.__context__
    return False


class _Limit(NamedTuple):
    """A limit of memory.

    Attributes
    ----------
    counts
        Which of `Bytes` it counts.
    left
        How many bytes are left of it.
    words
        What it is; "" for the memory of the machine.
    """

    counts: int
    left: int
    words: str

    def __str__(self) -> str:
        """Say how much there is."""
        words = f" ({self.words})" if self.words else ""
        return f"{readable(max(self.left, 0))} is available{words}"


def _check(needed: int | Bytes, what: str, instead: str) -> None:
    """Raise RenderError if there is less memory than needed, with the rest of the start."""
    lack = lack_of_memory(needed, START)
    if lack:
        message = f"{what} {lack}; expected {instead}"
        raise RenderError(message)


def _limits() -> Iterator[_Limit]:
    """Give all limits of this process."""
    yield from _limits_of_process()
    yield from _limits_of_groups()
    yield _Limit(2, _left_in_machine(), "")


def _used() -> Bytes:
    """Return what this process uses; what is not known counts as what a start takes."""
    with contextlib.suppress(OSError, ValueError):
        size, resident, _, _, _, data, _ = map(int, _read("/proc/self/statm").split())
        page = os.sysconf("SC_PAGE_SIZE")
        return Bytes(size * page, data * page, resident * page)
    return START


def _limits_of_process() -> Iterator[_Limit]:
    """Give the limits that the shell's ``ulimit`` sets."""
    if sys.platform == "win32":
        return
    import resource

    for counts, which, option in (
        (0, resource.RLIMIT_AS, "ulimit -v"),
        (1, resource.RLIMIT_DATA, "ulimit -d"),
    ):
        most = resource.getrlimit(which)[0]
        if 0 <= most < sys.maxsize and most != resource.RLIM_INFINITY:
            words = f"the limit of this process is {readable(most)}, {option}"
            yield _Limit(counts, most - _used()[counts], words)


def _limits_of_groups(
    groups: str | Path = "/proc/self/cgroup", root: str | Path = "/sys/fs/cgroup"
) -> Iterator[_Limit]:
    """Give the limits of the control groups of Linux that this process belongs to.

    References
    ----------
    https://docs.kernel.org/admin-guide/cgroup-v2.html
    """
    lines = _read(groups).splitlines()
    for line in lines:
        _, controllers, path = line.split(":", 2)
        if not controllers:
            names = "memory.max", "memory.current", ""
            tops = [f"{root}", f"{root}/unified"]
        elif "memory" in controllers.split(","):
            names = "memory.limit_in_bytes", "memory.usage_in_bytes", "total_"
            tops = [f"{root}/memory"]
        else:
            continue
        for top in tops:
            # Within a container, the path may be one of the machine's.
            inner = os.path.normpath(f"/{path.lstrip('/')}")
            while inner != "/":
                yield from _limit_of_group(top + inner, *names)
                inner = os.path.dirname(inner)
            yield from _limit_of_group(top, *names)


def _limit_of_group(folder: str, most: str, used: str, prefix: str) -> Iterator[_Limit]:
    """Give the limit of one group, if it has one."""
    text = _read(f"{folder}/{most}").strip()
    if text.isdigit() and int(text) < 2**60:
        taken = int(_read(f"{folder}/{used}").strip() or 0)
        found = dict(line.split() for line in _read(f"{folder}/memory.stat").splitlines())
        # Copies of files are given up where memory is needed.
        spare = sum(int(found.get(f"{prefix}{kind}_file", 0)) for kind in ("active", "inactive"))
        words = f"the limit of its control group is {readable(int(text))}"
        yield _Limit(2, int(text) - taken + spare, words)


def _read(path: str | Path) -> str:
    """Return a text file of the system, "" if there is none."""
    # Each picture begins with a dozen of these; by `pathlib` they take twice as long.
    with contextlib.suppress(OSError), open(path, "rb", 0) as file:
        return file.read().decode()
    return ""


def _left_in_machine() -> int:
    """Return how many bytes the machine has left."""
    with contextlib.suppress(OSError, IndexError, ValueError):
        return int(_read("/proc/meminfo").split("MemAvailable:")[1].split()[0]) * 1024
    import psutil

    available: int = psutil.virtual_memory().available
    return available


def readable(size: int) -> str:
    """Return a number of bytes as people read it."""
    return f"{size / 10**9:,.1f} GB" if size >= 10**9 else f"{size / 10**6:,.0f} MB"


def peak_memory() -> int:
    """Return the most memory that this process has used so far, in bytes."""
    if sys.platform == "win32":
        import psutil

        return int(psutil.Process().memory_info().peak_wset)
    import resource

    # What getrusage tells in Linux begins with the memory of the process that started this one.
    with contextlib.suppress(OSError, IndexError, ValueError), open("/proc/self/status") as status:
        return int(status.read().split("VmHWM:")[1].split()[0]) * 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
