"""Where the commands begin: ``vtray``, ``python -m vtray``, and ``vtray-diff``.

Signals are taken care of before all else, so that Ctrl-C ends a command from its first line on.
"""

import sys

from vtray.base.signals import leave_on_signals

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> "NoReturn":
    """Run the command ``vtray`` and exit."""
    leave_on_signals()
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
