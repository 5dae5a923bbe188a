"""What the documents say is so."""

import json
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from PIL import Image
from strict import STRICT

import vtray
from conftest import compiled_only
from vtray.base.extras import PACKAGES

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]


def blocks(kind: str) -> dict[str, str]:
    """Return the code blocks behind a comment `kind: name`, in all documents, by name."""
    pattern = rf"<!-- {kind}: (.*) -->\n```\w*\n((?:.*\n)*?)```"
    found = [
        pair for path in DOCUMENTS for pair in re.findall(pattern, path.read_text(encoding="utf-8"))
    ]
    assert len(dict(found)) == len(found), f"two blocks have one name: {found}"
    return dict(found)


PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def modules(requirements: list[str]) -> set[str]:
    """Return what the packages of requirements are imported as."""
    names = (re.match(r"[\w-]+", text)[0] for text in requirements)
    return {name.replace("-", "_") for name in names} - {"vtray"}


# As after the README's first command, which installs no extra.
NOT_INSTALLED = set().union(*map(modules, PROJECT["optional-dependencies"].values()))
FRESH = f"import sys; sys.modules.update(dict.fromkeys({sorted(NOT_INSTALLED)}))\n"


@compiled_only
@pytest.mark.parametrize(("name", "code"), blocks("example").items())
def test_examples_run(name: str, code: str, tmp_path: Path) -> None:
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    command = [sys.executable, *STRICT, "-c", FRESH + code]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    pictures = list(tmp_path.glob("*.png"))
    assert len(pictures) == 1, name
    images = ROOT / "docs" / "images"
    for shown in (images / pictures[0].name, images / "pages" / pictures[0].name):
        if not shown.exists():
            continue
        with Image.open(shown) as expected, Image.open(pictures[0]) as made:
            assert expected.tobytes() == made.tobytes()
    for scene in tmp_path.glob("*.json"):
        vtray.load(scene)


@compiled_only
@pytest.mark.parametrize(("command", "output"), blocks("output").items())
def test_outputs_are_what_the_commands_print(command: str, output: str) -> None:
    program, *arguments = shlex.split(command)
    run = [str(Path(sys.executable).with_name(program)), *arguments]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == output
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(("name", "code"), blocks("arrays").items())
def test_arrays_are_those_of_the_object(name: str, code: str, tmp_path: Path) -> None:
    command = [sys.executable, *STRICT, "-c", code]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    scene = json.loads((ROOT / "scenes" / "first.json").read_text(encoding="utf-8"))
    scene["objects"] = [json.loads(blocks("object")[name])]
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    (spheres,) = vtray.load(tmp_path / "scene.json").objects
    assert isinstance(spheres, vtray.Spheres)
    assert len(spheres) == 1000


def test_remedies_are_what_the_extras_install() -> None:
    extras = {name: modules(PROJECT["optional-dependencies"][name]) for name in PACKAGES}
    assert {name: modules(list(packages)) for name, packages in PACKAGES.items()} == extras


def test_caption_counts_the_lights_of_the_scene() -> None:
    (count,) = re.findall(r"lit by (\d+) lights", README)
    assert int(count) == len(vtray.load(ROOT / "scenes" / "room.json").lights)


def test_blocks_are_found() -> None:
    assert list(blocks("command")) == ["run", "test"]
    assert all(f"<!-- command: {name} -->" in README for name in blocks("command"))
    assert set(blocks("example")) == {"arrays", "data", "code", "knot"}
    assert len(blocks("output")) == 1
    assert list(blocks("arrays")) == list(blocks("object")) == ["atoms"]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document: Path) -> None:
    for link in re.findall(r"\]\(([^)#\s]+)", document.read_text(encoding="utf-8")):
        if "://" not in link:
            assert (document.parent / link).exists(), link


def test_options_of_the_command_are_on_its_page() -> None:
    command = [str(Path(sys.executable).with_name("vtray")), "--help"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    options = set(re.findall(r"--[a-z]+", text))
    assert len(options) >= 6
    page = (ROOT / "docs" / "command.md").read_text(encoding="utf-8")
    table = page[page.index("## Options") : page.index("## Success")]
    assert options <= set(re.findall(r"--[a-z]+", table))


def test_format_table_names_all_keys() -> None:
    schema = json.loads((ROOT / "docs" / "scene.schema.json").read_text(encoding="utf-8"))
    keys = set(schema["properties"])
    for part in schema["$defs"].values():
        keys |= set(part["properties"])
    page = (ROOT / "docs" / "scene-file.md").read_text(encoding="utf-8")
    words = set(re.findall(r"\w+", page[page.index("## Keys") :]))
    assert keys <= words


def test_readme_is_short() -> None:
    assert len(README.splitlines()) <= 150


def test_architecture_names_all_modules() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    for module in (ROOT / "src" / "vtray").rglob("[a-z]*.py"):
        assert f"`{module.stem}`" in text, module.stem
