"""Where the commands begin: ``vtray``, ``python -m vtray``, and ``vtray-diff``.

Signals are taken care of before all else, so that Ctrl-C ends a command from its first line on.
"""

import gc
import sys

from vtray.base.signals import leave_on_signals

OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""More than a command makes until it renders: nothing of it is garbage, and to look for some in it
takes Python 8 ms of 130, and of the compiling a tenth."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> "NoReturn":
    """Run the command ``vtray`` and exit."""
    leave_on_signals()
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    from vtray.commands.cli import run
    from vtray.commands.command import leave

    leave(run(sys.argv[1:]))


def diff() -> "NoReturn":
    """Run the command ``vtray-diff`` and exit."""
    leave_on_signals()
    from vtray.commands.command import leave
    from vtray.commands.diff import run

    leave(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
