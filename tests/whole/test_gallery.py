"""The gallery: each script runs, and its picture is there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pages
import pytest
from PIL import Image
from shown_pictures import assert_same_picture
from strict import STRICT

from conftest import compiled_only

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
IMAGES = ROOT / "docs" / "images" / "gallery"
HELPERS = ("gallery", "make_gallery")
SCRIPTS = sorted(path for path in EXAMPLES.glob("*.py") if path.stem not in HELPERS)
CHEAP = ("dislocation", "layers", "reference_scenes")
FEWER = dict.fromkeys(("dislocation", "reference_scenes"), ("samples=16", "samples=3"))
"""What takes the place of which words of a script, so that it takes less time."""
MOST_BYTES = 300_000


def picture_of(script: Path) -> Path:
    """Return the picture that a script makes."""
    (picture,) = IMAGES.glob(f"{script.stem}.*")
    return picture


def run_script(script: Path, *arguments: object) -> None:
    """Run a script as its users do; a warning is an error."""
    done = subprocess.run(
        [sys.executable, *STRICT, str(script), *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(EXAMPLES), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@compiled_only
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_script_runs(script: Path, tmp_path: Path) -> None:
    shown = picture_of(script)
    made = tmp_path / f"small{shown.suffix}"
    run_script(script, made, "--small")
    with Image.open(shown) as large, Image.open(made) as small:
        assert small.width == pytest.approx(large.width / 8, abs=2)
        assert small.height == pytest.approx(large.height / 8, abs=2)
        assert small.convert("L").getextrema()[1] > 128, "it is dark"


@compiled_only
@pytest.mark.parametrize("name", CHEAP)
def test_picture_is_what_the_script_makes(name: str, tmp_path: Path) -> None:
    shown = picture_of(EXAMPLES / f"{name}.py")
    made, script = tmp_path / shown.name, EXAMPLES / f"{name}.py"
    if name in FEWER:
        text = script.read_text(encoding="utf-8")
        assert FEWER[name][0] in text
        (tmp_path / "scenes").symlink_to(ROOT / "scenes")
        script = tmp_path / "examples" / script.name
        script.parent.mkdir()
        script.write_text(text.replace(*FEWER[name]), encoding="utf-8")
    run_script(script, made)
    # Decoders of JPEG differ a little, and NumPy's sines on other processors.
    assert_same_picture(made, shown, has_fewer_samples=name in FEWER)


def test_gallery_shows_each_picture_with_its_script() -> None:
    texts = [(ROOT / "docs" / f"{name}.md").read_text("utf-8") for name in pages.GALLERY]
    page = "".join(texts)
    shown = re.findall(r"\(images/gallery/([\w.]+)\)", page)
    included = re.findall(r'--8<-- "examples/([\w.]+)"', page)
    assert sorted(shown) == sorted(path.name for path in IMAGES.glob("*"))
    assert [Path(name).stem for name in shown] == [
        Path(name).stem for name in included if name != "gallery.py"
    ]
    assert {f"{script.stem}.py" for script in SCRIPTS} == set(included) - {"gallery.py"}


@pytest.mark.parametrize("folder", ["gallery", "pages"])
def test_pictures_are_small_files(folder: str) -> None:
    for path in (ROOT / "docs" / "images" / folder).glob("*"):
        assert path.stat().st_size < MOST_BYTES, path.name


@pytest.mark.parametrize("name", ["tour", "eight_figures", "inside"])
def test_notebook_is_kept_without_outputs(name: str) -> None:
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    nbformat.validate(notebook)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert len(cells) > 8
    assert not any(cell.outputs or cell.execution_count for cell in cells)


@compiled_only
@pytest.mark.parametrize(("name", "least"), [("tour", 7), ("eight_figures", 9), ("inside", 6)])
def test_notebook_runs_from_start_to_end(name: str, least: int, tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    for module in pages.NEEDED.get(name.replace("_", "-"), ()):
        pytest.importorskip(module)
    notebook = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=4)
    page = ROOT / "docs" / f"{name.replace('_', '-')}.md"
    smaller = pages.smaller_of(page) if page.exists() else {}
    for cell in notebook.cells:
        if smaller:
            cell.source = pages.made_smaller(cell.source, smaller)
        else:  # sizes and places in pictures, the numbers of three digits
            cell.source = re.sub(r"\b\d{3}\b", lambda found: str(int(found[0]) // 4), cell.source)
    # Its files are written into a folder beside `scenes`, as `examples` is.
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    (tmp_path / "examples").mkdir()
    where = {"metadata": {"path": str(tmp_path / "examples")}}
    client = nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources=where)
    client.execute()
    shown = [
        output.data
        for cell in notebook.cells
        if cell.cell_type == "code"
        for output in cell.outputs
        if "data" in output
    ]
    assert sum("image/png" in data for data in shown) >= least
    printed = [o for c in notebook.cells for o in c.get("outputs", []) if o.output_type == "stream"]
    # MDAnalysis asks for widgets that notebooks may do without.
    warned = [o.text for o in printed if o.name != "stdout" and "TqdmWarning" not in o.text]
    assert not warned
