"""What a process does that compiles parts for another one, which `helpers` has started."""

import os
import signal
import sys

from vtray.base.compiler.helpers import DONE
from vtray.base.compiler.parts import compile_kept, tell_instead


def work() -> None:
    """Compile the parts that standard input names, and tell which others these call."""
    # The other process ends this one; Ctrl-C is for that alone.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=0)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    tell_instead(answers.write)
    from vtray.base.compiler import kept_functions  # noqa: F401 - loads Numba

    for order in sys.stdin.buffer:
        compile_kept(order)
        answers.write(DONE)
