"""How much memory there is, and how much is used."""

import contextlib
import sys

from vtray.errors import RenderError

BYTES_PER_PIXEL = 3 * 8 + 3 + 4
"""Film, pixels, and the copy that the image encoder makes."""

BYTES_PER_SAMPLED_PIXEL = BYTES_PER_PIXEL + 8 + 4 + 8 + 1 + 1
"""The same with coverage, and what says which pixels get samples."""

BYTES_PER_SPHERE = 80
"""The hierarchy, and what it takes to build it, beside the arrays that were given."""

ALWAYS_FITS = 2**28
"""What needs fewer bytes is not looked at: asking takes longer than it does."""


def check_memory(width: int, height: int, samples: int = 1) -> None:
    """Raise RenderError if an image of this size cannot be held in memory."""
    what = f"camera.size: an image of {width} x {height} pixels needs"
    bytes_per_pixel = BYTES_PER_PIXEL if samples == 1 else BYTES_PER_SAMPLED_PIXEL
    _check(width * height * bytes_per_pixel, what, "a smaller size")


def check_memory_of_lights(rays: int, lights: int) -> None:
    """Raise RenderError if the lights of so many rays cannot be kept in memory."""
    what = f"keep_lights: {lights} lights for {rays} rays need"
    _check(rays * (8 * lights + 5), what, "a smaller size, fewer samples or fewer lights")


def check_memory_of_spheres(count: int) -> None:
    """Raise RenderError if so many spheres cannot be held in memory."""
    _check(count * BYTES_PER_SPHERE, f"objects: {count} spheres need", "fewer spheres")


def _check(needed: int, what: str, instead: str) -> None:
    """Raise RenderError if there is less memory than needed."""
    if needed < ALWAYS_FITS:
        return
    import psutil

    available = psutil.virtual_memory().available
    if needed > available:
        message = (
            f"{what} {in_gigabytes(needed)} of memory, {in_gigabytes(available)} is available; "
            f"expected {instead}"
        )
        raise RenderError(message)


def in_gigabytes(size: int) -> str:
    """Return a number of bytes as people read it."""
    return f"{size / 10**9:,.1f} GB"


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
