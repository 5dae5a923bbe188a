"""The names of movies: of files that can be nothing else, and of numbered pictures.

What reads options asks for them, and need not load what writes movies.
"""

import re
from pathlib import Path

NUMBER = re.compile(r"%(0[1-9])?d")
"""Where the number of a picture stands in a name."""

ALONE = (".mp4", ".gif")
"""The endings of movies that are no pictures, too."""


def is_numbered(path: Path) -> bool:
    """Tell whether a name is that of numbered pictures."""
    return NUMBER.search(path.name) is not None
