"""The settings of a render as options of a command, made from their definition."""

import argparse
import re
import typing
from collections.abc import Callable
from typing import Any, Literal

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.checks.limits import alternatives, limits_alone
from vtray.scene.colors.names import to_rgb
from vtray.scene.settings import Settings, kinds_of
from vtray.scene.vectors import Color

_INTEGER = r"-?[0-9]{1,20}"
_NUMBER = r"-?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"


def add_settings(group: argparse._ArgumentGroup, settings: type[Settings]) -> None:
    """Add an option for each setting, and those that stand for one of its values.

    Parameters
    ----------
    group
        Where to add them.
    settings
        The definition of the settings.
    """
    for name, (kind, option) in kinds_of(settings).items():
        place = group.add_mutually_exclusive_group() if option.flags else group
        flag = f"--{name.replace('_', '-')}"
        read = _reader(kind, option.words)
        reading: dict[str, Any] = {"type": read}
        (*others, last) = alternatives(kind)
        if last is bool:
            place.add_argument(flag, help=option.help, action=argparse.BooleanOptionalAction)
            continue
        if not others and typing.get_origin(last) is Literal:
            reading = {"choices": typing.get_args(last)}
        place.add_argument(flag, metavar=option.form, help=option.help, **reading)
        for short, value in option.flags.items():
            place.add_argument(
                short,
                dest=name,
                action="store_const",
                const=read(value),
                help=f"the same as {flag} {value}",
            )


def wrong(expected: str, text: str) -> argparse.ArgumentTypeError:
    """Return the error for the value of an option, to be raised."""
    return argparse.ArgumentTypeError(f"expected {expected}, got {text}")


def _reader(kind: Any, words: str) -> Callable[[str], Any]:  # noqa: ANN401
    """Return what reads the value of an option as one of a kind."""

    def read(text: str) -> Any:  # noqa: ANN401
        hint = ""
        try:
            return msgspec.convert(_read(text, kind), kind)
        except msgspec.ValidationError:
            pass
        except SceneError as error:
            hint = "".join(str(error).partition("; ")[1:])
        raise wrong(words or _expected(kind), f"{text}{hint}")

    return read


def _expected(kind: Any) -> str:  # noqa: ANN401
    """Return what the checks of a scene say is expected, without the quotes of a file."""
    from vtray.scene.checks.scene_words import expected

    return expected(limits_alone(kind)).replace('"', "")


def _read(text: str, kind: Any) -> Any:  # noqa: ANN401
    """Return what a text says as one of the alternatives of a kind; the text if it is none."""
    parts = alternatives(kind)
    for part in parts:
        if typing.get_origin(part) is Literal and text in typing.get_args(part):
            return text
        if typing.get_origin(part) is tuple:
            sides = typing.get_args(part)
            pieces = text.split("x")
            if len(pieces) == len(sides):
                return tuple(map(_read, pieces, sides))
    if int in parts:
        return int(text) if re.fullmatch(_INTEGER, text) else text
    if float in parts and re.fullmatch(_NUMBER, text):
        value = float(text)
        return value if abs(value) != float("inf") else text
    return Color(*to_rgb(text, "")) if Color in parts else text
