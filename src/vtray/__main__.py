"""``python -m vtray`` is the command ``vtray``."""

from vtray.cli import main

if __name__ == "__main__":
    main()
