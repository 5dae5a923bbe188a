"""The site: its pages run, and all of it can be built."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pages
import pytest
from PIL import Image
from shown_pictures import assert_same_picture, size_of
from strict import STRICT

import vtray
from conftest import compiled_only, once

PUBLIC = {name for name in vtray.__all__ if not name.startswith("_")}
SITE_PAGES = sorted(pages.DOCS.glob("*.md"))
REFERENCE = (pages.DOCS / "reference.md").read_text(encoding="utf-8")


@compiled_only
@pytest.mark.parametrize("page", pages.PAGES, ids=lambda page: page.stem)
def test_code_of_the_page_runs(page: Path, tmp_path: Path) -> None:
    for module in pages.NEEDED.get(page.stem, ()):
        pytest.importorskip(module)
    (tmp_path / "scenes").symlink_to(pages.ROOT / "scenes")
    smaller = pages.smaller_of(page)
    code = f"""
import pathlib
import pages
from vtray.base.compiler import helpers
helpers.MOST = 0  # the other worker keeps the other core busy
pages.run_page(pathlib.Path({str(page)!r}), {smaller})
"""
    done = subprocess.run(
        [sys.executable, *STRICT, "-c", code],
        cwd=tmp_path,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join([str(Path(pages.__file__).parent), *sys.path]),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    for name in pages.shown_pictures(page):
        made, shown = tmp_path / name, pages.PICTURES / name
        if size_of(made) != size_of(shown) and smaller:
            assert_smaller_picture(made, shown)
        else:
            assert_same_picture(made, shown, has_fewer_samples=bool(smaller))


def assert_smaller_picture(made: Path, shown: Path) -> None:
    """See that a picture is not empty, and of the shape of a larger one."""
    with Image.open(made) as one, Image.open(shown) as two:
        assert one.width < two.width / 2
        assert one.width / one.height == pytest.approx(two.width / two.height, rel=0.1)
        low, high = one.convert("L").getextrema()
    assert high - low > 60


def test_pages_are_found() -> None:
    names = {page.stem for page in pages.PAGES}
    assert {"index", "cameras", "outputs", "trace-a-pixel"} <= names
    assert sum(len(pages.blocks(page.read_text(encoding="utf-8"))) for page in pages.PAGES) > 20


def test_pictures_are_all_shown() -> None:
    shown = {name for page in pages.PAGES for name in pages.shown_pictures(page)}
    assert shown == {path.name for path in pages.PICTURES.glob("*")}


def test_reference_has_all_public_names() -> None:
    listed = re.findall(r"^::: vtray\.(\w+)$", REFERENCE, re.MULTILINE)
    assert len(set(listed)) == len(listed)
    assert set(listed) == PUBLIC


def test_blocks_of_a_page() -> None:
    page = """
Words.

```python title="not-written.py"
print(1)
```

```text
1
```

```json title="scene.json"
{}
```

Words.

```text
not printed
```
"""
    python, scene, other = pages.blocks(page)
    assert (python.kind, python.text, python.line, python.printed) == (
        "python",
        "print(1)\n",
        5,
        "1\n",
    )
    assert (scene.kind, scene.title, scene.printed) == ("json", "scene.json", None)
    assert other.kind == "text"


def test_words_of_a_page_are_made_smaller(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- smaller in tests: 1_000 -> 10;\n--size 9x9 -> --size 1x1 -->\n")
    smaller = pages.smaller_of(page)
    assert smaller == {"1_000": "10", "--size 9x9": "--size 1x1"}
    assert pages.made_smaller("x(1_000, 1_000)", smaller) == "x(10, 10)"
    page.write_text("Words.")
    assert pages.smaller_of(page) == {}


def test_each_word_that_is_made_smaller_is_there() -> None:
    for page in pages.PAGES:
        text = page.read_text(encoding="utf-8")
        notebook = pages.ROOT / "examples" / f"{page.stem.replace('-', '_')}.ipynb"
        text += notebook.read_text(encoding="utf-8") if notebook.exists() else ""
        for words in pages.smaller_of(page):
            assert text.count(words) > 1, f"{page.name}: {words}"


def test_comment_may_stand_before_what_is_printed() -> None:
    page = "```sh\ntrue\n```\n\n<!-- output: {} -->\n```text\n1\n```\n"
    assert [block.printed for block in pages.blocks(page.format("true"))] == ["1\n"]
    assert [block.printed for block in pages.blocks(page.format("true --> Words.<!--"))] == [
        None
    ] * 2


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ("```python\nprint(1)\n```\n\n```text\n2\n```\n", "printed\n1"),
        ("```python\nprint(1)\n```\n", "printed\n1"),
        ("```sh\nfalse\ntrue\n```\n", "ended with 1"),
        ("```sh\necho Error\n```\n\n```text\nError\n```\n", "ended with 0"),
    ],
)
def test_wrong_page_is_found_out(
    block: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    page = tmp_path / "page.md"
    page.write_text(block)
    with pytest.raises(AssertionError, match=message):
        pages.run_page(page)


@once
def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    if not (find_spec("mkdocs") and find_spec("mkdocstrings")):
        pytest.skip("MkDocs is not installed")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    done = subprocess.run(command, cwd=pages.ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "WARNING -" not in done.stderr
    made = {path.stem for path in tmp_path.glob("*.html")} - {"404"}
    assert made == {page.stem for page in SITE_PAGES}
    reference = (tmp_path / "reference.html").read_text(encoding="utf-8")
    for name in PUBLIC:
        assert f'id="vtray.{name}"' in reference
    # Nothing is loaded from other sites.
    loaded = re.findall(r'<(?:link|script|img)[^>]+(?:href|src)="(https?://[^"]+)"', reference)
    assert not [address for address in loaded if "canonical" not in address]


def test_pages_that_are_not_run_have_no_code() -> None:
    for name in set(pages.NOT_RUN) - set(pages.GALLERY):
        kinds = {
            block.kind for block in pages.blocks((pages.DOCS / f"{name}.md").read_text("utf-8"))
        }
        assert kinds <= {"text"}, name


def test_rules_stand_in_one_place() -> None:
    rules = (pages.DOCS / "rules.md").read_text(encoding="utf-8")
    assert re.findall(r"^(\d)\. \*\*", rules, re.MULTILINE) == list("12345678")
    others = [pages.ROOT / "README.md", *set(SITE_PAGES) - {pages.DOCS / "rules.md"}]
    for path in others:
        text = path.read_text(encoding="utf-8")
        assert "far side of the image plane" not in " ".join(text.split()), path.name
