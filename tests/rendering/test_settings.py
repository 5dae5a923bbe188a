"""Settings have one definition, with which all that knows of them agrees."""

import argparse
import ast
import inspect
import re
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import pytest
from msgspec import Meta

import vtray
from vtray.commands.setting_options import add_settings
from vtray.scene import settings
from vtray.scene.checks.limits import NonNegative, Positive
from vtray.scene.settings import Option, RenderSettings, Settings, kinds_of, overridden
from vtray.scene.style import PICTURE

NAMES = RenderSettings.__struct_fields__


def test_render_takes_all_settings() -> None:
    parameters = inspect.signature(vtray.render).parameters
    others = ("scene", "threads", "progress", "lock", "keep_lights", "tile", "warn")
    others += ("on_update", "update_seconds")
    assert tuple(name for name in parameters if name not in others) == PICTURE
    for name in PICTURE:
        assert parameters[name].kind is inspect.Parameter.KEYWORD_ONLY
        assert parameters[name].default is None
        assert f"\n{name}\n    " in inspect.getdoc(vtray.render)


def test_what_type_checkers_see_is_what_there_is() -> None:
    tree = ast.parse(Path(settings.__file__).read_text())
    (stub,) = (
        part.args
        for part in ast.walk(tree)
        if isinstance(part, ast.FunctionDef) and part.name == "__init__"
    )
    names = [argument.arg for argument in stub.args[1:]]
    defaults = map(ast.literal_eval, stub.defaults)
    assert dict(zip(names, defaults, strict=True)) == msgspec.structs.asdict(RenderSettings())
    assert tuple(names) == NAMES


def test_settings_are_described() -> None:
    for name in NAMES:
        assert f"\n{name} : " in inspect.getdoc(RenderSettings)
        assert re.search(rf"\n(\w+, )*{name}\b", inspect.getdoc(vtray.Provenance))


def test_settings_that_are_given() -> None:
    own = RenderSettings(samples=4, seed=1)
    given = {"samples": None, "seed": 7, "scene": "no setting"}
    assert overridden(own, given) == RenderSettings(samples=4, seed=7)


class More(RenderSettings, frozen=True):
    """Settings with some that there are not.

    Attributes
    ----------
    lens : float
        Its width.
    """

    lens: Annotated[NonNegative, Option("WIDTH", "width of the lens")] = 0.0
    light_paths: Annotated[Literal["one", "all"], Option("NAME", "one, all")] = "one"
    bounces: Annotated[
        Annotated[int, Meta(ge=0, le=9, description="an integer from 0 to 9")], Option("N", "most")
    ] = 2
    clip: Annotated[
        tuple[Positive, Positive] | None,
        Option("NEARxFAR", "what is seen", "two numbers", {"--near": "1x2"}),
    ] = None


@pytest.fixture
def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(exit_on_error=False)
    add_settings(made.add_argument_group("settings"), More)
    return made


def test_new_settings_are_options(parser: argparse.ArgumentParser) -> None:
    given = ["--lens", ".5", "--light-paths", "all", "--bounces", "0", "--clip", "1x2.5e1"]
    found = vars(parser.parse_args(given))
    new = {"lens": 0.5, "light_paths": "all", "bounces": 0, "clip": (1.0, 25.0)}
    assert found == {**dict.fromkeys(NAMES), **new}
    assert overridden(More(), found) == More(**new)
    assert parser.parse_args(["--near"]).clip == (1.0, 2.0)
    assert "--lens WIDTH" in parser.format_help()
    assert "the same as --clip 1x2" in parser.format_help()


@pytest.mark.parametrize(
    ("option", "text", "message"),
    [
        ("lens", "-1", "expected a number ≥ 0, got -1"),
        ("lens", "1e999", "expected a number ≥ 0, got 1e999"),
        ("bounces", "1.0", "expected an integer from 0 to 9, got 1.0"),
        ("bounces", "99999999999999999999", "expected an integer from 0 to 9, got 9999"),
        ("light-paths", "two", "invalid choice"),
        ("clip", "1x0", "expected two numbers, got 1x0"),
        ("clip", "1", "expected two numbers, got 1"),
    ],
)
def test_new_settings_are_checked(
    option: str, text: str, message: str, parser: argparse.ArgumentParser
) -> None:
    with pytest.raises(argparse.ArgumentError, match=message):
        parser.parse_args([f"--{option}={text}"])


def test_new_settings_are_checked_in_code() -> None:
    with pytest.raises(vtray.SceneError, match=r"More.lens: expected a number ≥ 0, got -1"):
        More(lens=-1)
    with pytest.raises(vtray.SceneError, match=r'More.light_paths: expected "one" or "all", got'):
        More().replace(light_paths="two")
    assert tuple(kinds_of(More)) == More.__struct_fields__
    properties = msgspec.json.schema(More)["$defs"]["More"]["properties"]
    assert properties["lens"] == {
        "description": "a number ≥ 0",
        "type": "number",
        "minimum": 0,
        "default": 0.0,
    }


def test_every_setting_has_a_default_and_can_be_written() -> None:
    assert Settings() == Settings(**msgspec.structs.asdict(Settings()))
    assert tuple(kinds_of(Settings)) == Settings.__struct_fields__ == NAMES


def test_code_may_write_an_integrator_as_files_do() -> None:
    given = {"type": "path", "depth": 12}
    assert RenderSettings(integrator=given) == RenderSettings(integrator="path", depth=12)
    assert RenderSettings(depth=3).replace(integrator={"type": "whitted"}) == RenderSettings(
        integrator="whitted", depth=3
    )
    assert given == {"type": "path", "depth": 12}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"type": "way"}, 'RenderSettings.integrator: expected "direct", "whitted" or "path"'),
        (
            {"type": "path", "depth": 99},
            "RenderSettings.depth: expected an integer from 0 to 64, got 99",
        ),
        ({"type": "path", "size": 1}, "RenderSettings.integrator: expected"),
        ({"depth": 1}, "RenderSettings.integrator: expected"),
    ],
)
def test_an_integrator_that_is_not_as_in_files_is_refused(
    given: dict[str, object], message: str
) -> None:
    with pytest.raises(vtray.SceneError, match=re.escape(message)):
        RenderSettings(integrator=given)
