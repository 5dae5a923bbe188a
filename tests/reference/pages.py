"""The code in the pages of the docs, and running it.

    python tests/pages.py [PAGE ...]    runs pages, all if none is named, and keeps their pictures

The blocks of a page run in their order, in one process and in a folder of their own, where
`scenes/` is that of the repository:

- ``python`` runs in names that all blocks of the page share;
- ``sh`` runs in a shell that ends at the first error;
- ``json title="x.json"`` is written to that file;
- ``text`` right after one of these, or after a comment that follows it, is what it prints; after
  `sh` it may be an error, and the status is 1 then.

A comment ``<!-- smaller in tests: 1_000_000 -> 4_000, ... -->`` says what stands for something else
where a page would take long: tests then see that its code runs, and make small pictures.

Pictures of the page are those of `docs/images/pages` with the name of a file that a block wrote.
"""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PICTURES = DOCS / "images" / "pages"
GALLERY = ("gallery", "frames")
"""Pages of pictures, each by a script in `examples`."""
NOT_RUN = ("architecture", "benchmarks", "changelog", *GALLERY, "measured", "reference", "rules")
PAGES = sorted(page for page in DOCS.glob("*.md") if page.stem not in NOT_RUN)
NEEDED = {
    "eight-figures": ("MDAnalysisTests",),
    "inside": ("MDAnalysisTests",),
    "movies": ("distributed",),
}
"""Packages that pages need, and without which they are not run."""

_BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_SMALLER = re.compile(r"<!-- smaller in tests: (.*?) -->", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_TITLE = re.compile(r'title="([^"]+)"')


class Block(NamedTuple):
    """A block of code.

    Attributes
    ----------
    kind
        Its language.
    title
        The file that it shows, "" if it shows none.
    text
        The code.
    line
        The line of the page where it begins.
    printed
        What it should print; None if the page does not say.
    """

    kind: str
    title: str
    text: str
    line: int
    printed: str | None


def blocks(page: str) -> list[Block]:
    """Return the blocks of a page in their order; what one prints is a part of it."""
    found: list[Block] = []
    end = -1
    for match in _BLOCK.finditer(page):
        kind, more, text = match.groups()
        between = _COMMENT.sub("", page[end : match.start()])
        if kind == "text" and found and not between.strip():
            found[-1] = found[-1]._replace(printed=text)
            continue
        end = match.end()
        title = _TITLE.search(more)
        line = page.count("\n", 0, match.start()) + 2
        found.append(Block(kind, title[1] if title else "", text, line, None))
    return found


def smaller_of(page: Path) -> dict[str, str]:
    """Return what tests put for which words of a page, so that it takes less time."""
    found = _SMALLER.search(page.read_text(encoding="utf-8"))
    pairs = re.split(r";\s+", found[1]) if found else []
    return dict(re.split(r"\s+->\s+", pair, maxsplit=1) for pair in pairs)


def made_smaller(text: str, smaller: Mapping[str, str]) -> str:
    """Return code with other words for some."""
    for words, fewer in smaller.items():
        text = text.replace(words, fewer)
    return text


def run_page(page: Path, smaller: Mapping[str, str] = MappingProxyType({})) -> None:
    """Run the blocks of a page in the current folder.

    Parameters
    ----------
    page
        The page.
    smaller
        What stands for which words of the code.

    Raises
    ------
    AssertionError
        A block printed something else, or a command failed.
    """
    names: dict[str, Any] = {"__name__": page.stem}
    for block in blocks(made_smaller(page.read_text(encoding="utf-8"), smaller)):
        place = f"{page.name}:{block.line}"
        if block.title and block.kind != "python":
            Path(block.title).write_text(block.text, encoding="utf-8")
        elif block.kind == "python":
            printed = _run_python(block, place, names)
            expected = block.printed or ""
            assert printed == expected, f"{place}: printed\n{printed}\ninstead of\n{expected}"
        elif block.kind == "sh":
            _run_shell(block, place)


def _run_python(block: Block, place: str, names: dict[str, Any]) -> str:
    """Run a block of Python, its first line at the line of the page; return what it prints."""
    code = compile("\n" * (block.line - 1) + block.text, place.rpartition(":")[0], "exec")
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream):
        exec(code, names)  # noqa: S102  the page is ours
    return stream.getvalue()


def _run_shell(block: Block, place: str) -> None:
    """Run a block of commands, with the `vtray` of this Python."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    done = subprocess.run(
        ["sh", "-e", "-c", block.text],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "PATH": path},
        check=False,
    )
    expected = block.printed or ""
    status = 1 if expected.startswith("Error") else 0
    assert done.stdout == expected, f"{place}: printed\n{done.stdout}\ninstead of\n{expected}"
    assert done.returncode == status, f"{place}: ended with {done.returncode}"


def shown_pictures(page: Path) -> list[str]:
    """Return the names of the pictures that a page shows of those that it makes."""
    found = re.findall(r"\(images/pages/([\w.-]+)\)", page.read_text(encoding="utf-8"))
    return list(dict.fromkeys(found))


def main() -> None:
    """Run the pages that are named; keep their pictures."""
    for page in [DOCS / f"{name}.md" for name in sys.argv[1:]] or PAGES:
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            Path("scenes").symlink_to(ROOT / "scenes")
            run_page(page)
            PICTURES.mkdir(exist_ok=True)
            for name in shown_pictures(page):
                shutil.copyfile(name, PICTURES / name)


if __name__ == "__main__":
    main()
