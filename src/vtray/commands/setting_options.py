"""The settings of a render as options of a command, made from their definition."""

import argparse
import math
import re
import typing
from collections.abc import Callable, Collection, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import msgspec

from vtray.base.errors import SceneError
from vtray.base.number import number_in
from vtray.commands.values import wrong
from vtray.scene.checks.limits import alternatives, limits_alone
from vtray.scene.colors.names import to_rgb
from vtray.scene.settings import kinds_of
from vtray.scene.style import taken
from vtray.scene.vectors import Color

_INTEGER = r"[+-]?[0-9]{1,20}"


def add_settings(group: argparse._ArgumentGroup, settings: type[msgspec.Struct]) -> None:
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
        flag = _flag(name)
        read = _reader(kind, option.words)
        if option.of is not None:
            read = _reader_of_part(settings, name)
        reading: dict[str, Any] = {"type": read}
        (*others, last) = alternatives(kind)
        if last is bool and not others:
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


def with_parts(arguments: Sequence[str], settings: type[msgspec.Struct]) -> list[str]:
    """Return arguments in which what follows an option of a part is its value, if it can be one.

    Parameters
    ----------
    arguments
        The arguments, such as ``--fog 5,20 scene.json`` or ``--fog scene.json``.
    settings
        The definition of the parts.
    """
    names = flags_of_parts(settings)
    return with_values_of(arguments, names, lambda flag, text: _can_be(settings, names[flag], text))


def flags_of_parts(settings: type[msgspec.Struct]) -> dict[str, str]:
    """Return the names of parts by their options, which may have a value."""
    return {_flag(name): name for name, (_, option) in kinds_of(settings).items() if option.of}


def value_apart(arguments: Sequence[str], flags: Collection[str]) -> str:
    """Return how to write a value that was taken for a file; "" if there is none.

    Parameters
    ----------
    arguments
        Those that `with_values_of` returns.
    flags
        The options that may have a value.
    """
    for option, word in pairwise(arguments):
        is_value = option[:-1] in flags and option.endswith("=") and not word.startswith("-")
        if is_value and not Path(word).exists():
            value = word if re.fullmatch(r"[\w.,:/+-]+", word) else f'"{word}"'
            words = "after a space, that is the name of a file, and there are too many of these"
            return f"{option[:-1]} {value}: {words}; write {option}{value}"
    return ""


def with_values_of(
    arguments: Sequence[str],
    flags: Collection[str],
    can_be: Callable[[str, str], bool] = lambda _flag, _text: False,
) -> list[str]:
    """Return arguments in which each of some options has a value after a ``=``, "" for none.

    Parameters
    ----------
    arguments
        The arguments.
    flags
        The options.
    can_be
        Tells whether what follows an option can be its value. A word that is no file is it anyway,
        and so is what begins with a ``=``, as if no space stood before it.
    """
    end = arguments.index("--") if "--" in arguments else len(arguments)
    found: list[str] = []
    for k, argument in enumerate(arguments):
        flag = found[-1][:-1] if found and found[-1].endswith("=") else ""
        follows = flag in flags and k < end
        if follows and argument.startswith("="):
            found[-1] += argument[1:]
        elif follows and (can_be(flag, argument) or _is_extra(arguments, k)):
            found[-1] += argument
        else:
            found.append(f"{argument}=" if argument in flags and k < end else argument)
    return found


def _can_be(settings: type[msgspec.Struct], name: str, argument: str) -> bool:
    """Tell whether an argument can be the value of a part, right or wrong."""
    looks_so = re.fullmatch(r"[+-]?[0-9.]+|[+-]?[.0-9][^/]*,[^/]*", argument)
    if looks_so or not math.isnan(number_in(argument)):
        return True
    try:
        taken(settings, name, argument, name)
    except SceneError:
        return False
    return True


def _is_extra(arguments: Sequence[str], k: int) -> bool:
    """Tell whether an argument is a word that is no file, beside others for SCENE and OUTPUT."""
    word = arguments[k]
    others = [text for text in (*arguments[:k], *arguments[k + 1 :]) if not text.startswith("-")]
    is_word = word.replace(",", "").isalpha()  # Å and µm are words, too
    return is_word and len(others) > 1 and not Path(word).exists()


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _reader_of_part(settings: type[msgspec.Struct], name: str) -> Callable[[str], Any]:
    """Return what reads the value of an option as a part."""

    def read(text: str) -> Any:  # noqa: ANN401
        try:
            return taken(settings, name, text, name)
        except SceneError as error:
            raise argparse.ArgumentTypeError(str(error).partition(": ")[2]) from None

    return read


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
    value = number_in(text)
    if float in parts and not math.isnan(value):
        return value if math.isfinite(value) else text
    return Color(*to_rgb(text, "")) if Color in parts else text
