"""Runs finders for some time: ``python -m fuzz`` in the folder of the tests."""

import argparse
import sys
import time
from pathlib import Path
from random import SystemRandom

from fuzz.finders import FINDERS, try_once


def main() -> int:
    """Run the finders in turn; return how many failures there were."""
    parser = argparse.ArgumentParser(prog="fuzz", description="Try to break vtray.")
    parser.add_argument("finders", nargs="*", choices=[[], *FINDERS], help=", ".join(FINDERS))
    parser.add_argument("--seconds", type=float, default=300.0, help="how long, all together")
    parser.add_argument("--seed", type=int, help="that of an earlier run, to repeat it")
    parser.add_argument("--first", type=int, default=0, help="number of the first attempt")
    parser.add_argument("--failures", type=Path, default=Path("build/fuzz"), help="where they go")
    options = parser.parse_args()
    seed = SystemRandom().randrange(10**9) if options.seed is None else options.seed
    names = options.finders or list(FINDERS)
    failures = 0
    for name in names:
        end = time.monotonic() + options.seconds / len(names)
        number, failed = options.first, 0
        while time.monotonic() < end:
            failed += not try_once(name, seed, number, options.failures.absolute())
            number += 1
        print(f"{name:10} seed {seed}, attempts {options.first} to {number - 1}: {failed} failed")
        failures += failed
    if failures:
        print(f"what was tried is in {options.failures}")
    return min(failures, 1)


if __name__ == "__main__":
    sys.exit(main())
