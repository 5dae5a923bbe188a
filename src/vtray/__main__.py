"""Where the commands begin: ``vtray``, ``python -m vtray``, and ``vtray-diff``.

Signals are taken care of before all else, so that Ctrl-C ends a command from its first line on.
"""

import gc
import sys

from vtray.base.signals import leave_on_signals

COLLECTIONS = (100_000, 20, 100)
"""How seldom Python looks for garbage. Until it renders, a command makes fewer objects than that,
and nearly all to stay: to look through them takes 8 ms of 130."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> "NoReturn":
    """Run the command ``vtray`` and exit."""
    leave_on_signals()
    gc.set_threshold(*COLLECTIONS)
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
