"""Makes all pictures of the gallery again: `python examples/make_gallery.py`."""

import subprocess
import sys
from pathlib import Path

HELPERS = ("gallery", "make_gallery")
SCRIPTS = sorted(
    path for path in Path(__file__).resolve().parent.glob("*.py") if path.stem not in HELPERS
)


def main() -> None:
    """Run each script."""
    for script in SCRIPTS:
        print(script.stem)
        subprocess.run([sys.executable, str(script)], check=True)


if __name__ == "__main__":
    main()
