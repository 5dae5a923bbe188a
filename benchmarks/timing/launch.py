"""Runs a command and prints, as JSON, what it took and what it printed.

    python -I -S launch.py COMMAND [ARGUMENT ...]

A process of its own because a process counts the memory of the one that started it as its own peak,
and this one is small.
"""

import json
import os
import subprocess
import sys
import time


def main() -> None:
    """Run the command in the arguments."""
    start = time.perf_counter()
    process = subprocess.Popen(
        sys.argv[1:],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    output = process.stdout.read() if process.stdout else b""
    memory = float("nan")
    if hasattr(os, "wait4"):
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        memory = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    else:
        process.wait()
    seconds = time.perf_counter() - start
    text = output.decode(errors="replace")
    json.dump(
        {"seconds": seconds, "status": process.returncode, "memory": memory, "output": text},
        sys.stdout,
    )


if __name__ == "__main__":
    main()
