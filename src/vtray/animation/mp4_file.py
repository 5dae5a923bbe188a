"""Movies as MP4: H.264 by the ffmpeg that imageio-ffmpeg brings, through a pipe.

References
----------
https://trac.ffmpeg.org/wiki/Encode/H.264
"""

import contextlib
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.animation.feed import Feed
from vtray.base.errors import OutputError
from vtray.base.extras import need
from vtray.base.signals import LastStep

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pixels = NDArray[np.uint8]

QUALITY = 17
"""The constant rate factor: 0 is lossless, 23 usual; at 17, no difference is seen."""

PRESET = "veryfast"
"""How long ffmpeg looks for what may be left out. A hundred thousand balls that move come at 8.9
pictures of 1024 x 1024 a second on two cores, with "medium" at 6.7; the files are as large.
"""

COLORS = "bt709"
"""The colours that players take H.264 of any size for, where they are told."""

TOLD = f"setparams=colorspace={COLORS}:color_primaries={COLORS}:color_trc=iec61966-2-1:range=tv"
"""What the file says of its colours: primaries and brightness are those of sRGB."""


def find_ffmpeg(output: Path) -> str:
    """Return the path of ffmpeg.

    Raises
    ------
    ExtraError
        imageio-ffmpeg is not installed.
    OutputError
        It brings no ffmpeg for this machine.
    """
    library: Any = need("imageio_ffmpeg", "movies", f"{output}: writing .mp4")
    try:
        found: str = library.get_ffmpeg_exe()
    except RuntimeError as error:
        message = f"{output}: there is no ffmpeg ({error}); write a .gif or .webp file instead"
        raise OutputError(message) from None
    return found


def write_mp4(path: Path, feed: Feed, fps: float) -> None:
    """Write a movie with even sides: of others, the last row or column is there twice."""
    pictures = iter(feed)
    first = next(pictures)
    height, width = _even(first).shape[:2]
    command = [
        find_ffmpeg(path),
        *("-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
        *("-s", f"{width}x{height}", "-r", f"{fps:.15g}", "-i", "pipe:0", "-an"),
        *("-vf", f"scale=out_color_matrix={COLORS}:out_range=tv,format=yuv420p,{TOLD}"),
        *("-c:v", "libx264", "-preset", PRESET, "-crf", str(QUALITY)),
        *("-movflags", "+faststart", "-f", "mp4", str(path)),
    ]
    with tempfile.TemporaryFile() as said:
        # In a session of its own, so that Ctrl-C reaches only the process that asks for it.
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=said,
            start_new_session=True,
        )
        with LastStep(process.kill):
            try:
                _feed(process, first, pictures)
            finally:
                if process.poll() is None:
                    process.kill()
                    process.wait()
        if process.returncode:
            said.seek(0)
            lines = said.read().decode(errors="replace").strip().splitlines()
            reason = lines[-1][:200] if lines else _end_of(process.returncode)
            message = f"{path}: ffmpeg cannot write it: {reason}"
            raise OutputError(message)


def _end_of(status: int) -> str:
    """Say how a process has ended, by its status."""
    words = signal.strsignal(-status) if status < 0 else None
    return f"status {status}" if words is None else words.lower()


def _feed(process: "subprocess.Popen[bytes]", first: "Pixels", others: "Iterator[Pixels]") -> None:
    """Give all pictures to ffmpeg, and wait until it has written them."""
    assert process.stdin is not None  # noqa: S101 - it is a pipe
    with contextlib.suppress(BrokenPipeError):  # it says why
        process.stdin.write(_even(first).tobytes())
        for pixels in others:
            process.stdin.write(_even(pixels).tobytes())
        process.stdin.close()
    process.wait()


def _even(pixels: "Pixels") -> "Pixels":
    """Return pixels, (height, width, 3), with even sides."""
    import numpy as np

    height, width = pixels.shape[:2]
    return np.pad(pixels[..., :3], ((0, height % 2), (0, width % 2), (0, 0)), "edge")
