"""All finders by their names, and how one attempt is made and kept."""

import os
import shutil
import traceback
from importlib import import_module
from pathlib import Path
from random import Random

FINDERS = {
    "scenes": "scene files with some parts exchanged",
    "arguments": "lists of arguments",
    "arrays": "damaged and strange files of arrays",
    "pictures": "damaged pictures to replay",
    "kernels": "damaged kernels on disk",
    "faults": "signals and limits at random moments",
    "truth": "random scenes beside their picture as the rules say it",
    "values": "strange values in code",
    "bounces": "random scenes of all materials, taken in all ways",
    "styles": "random scenes cut, faded, in fog and in lines",
}


def try_once(name: str, seed: int, number: int, failures: Path) -> bool:
    """Make one attempt; tell whether no promise was broken.

    Parameters
    ----------
    name
        The finder.
    seed, number
        What its random numbers come from.
    failures
        Where a folder with what was tried, and why it failed, is left behind. A crash of the whole
        process leaves it, too.
    """
    folder = failures / f"{name}-{seed}-{number}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    before = Path.cwd()
    try:
        import_module(f"fuzz.{name}").attempt(Random(f"{name} {seed} {number}"), folder)
    except Exception:  # noqa: BLE001 - whatever it is, it is a failure
        (folder / "why.txt").write_text(traceback.format_exc())
        return False
    finally:
        os.chdir(before)
    shutil.rmtree(folder)
    return True
