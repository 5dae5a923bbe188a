"""What to say of an argument or an attribute that there is not: what is meant instead.

A user of Matplotlib writes ``vmin``, one from Britain ``colour``; the message names the remedy.
"""

import functools
from collections.abc import Callable, Collection
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

_LIMITS = "the limits of the colour map are clim=(low, high)"

# What other programs call it, and what to say where there is this argument of vtray.
_MEANT = {
    "vmin": {"clim": _LIMITS, "low": 'did you mean "low"?'},
    "vmax": {"clim": _LIMITS, "high": 'did you mean "high"?'},
    "norm": {"clim": f"{_LIMITS}; for logarithms, give those of the values as color"},
    "alpha": {
        "background": 'for a transparent background, background="transparent"',
        "opacity": 'did you mean "opacity"?',
    },
    "c": {"color": 'did you mean "color"?'},
    "center": {"positions": 'did you mean "positions"?', "point": 'did you mean "point"?'},
    "points": {"positions": 'did you mean "positions"?'},
    "fov": {"fov_degrees": 'did you mean "fov_degrees"?'},
    "s": {"radius": 'did you mean "radius"?'},
}


def unknown_argument(call: str, name: str, known: Collection[str]) -> str:
    """Say that a call has no argument of a name, and what is meant."""
    return f"{call}() argument {name!r} is unknown; {_remedy(name, known, 'arguments')}"


def unknown_attribute(kind: str, name: str, known: Collection[str]) -> str:
    """Say that objects of a kind have no attribute of a name, and what is meant."""
    return f"{kind} has no attribute {name!r}; {_remedy(name, known, 'attributes')}"


def _remedy(name: str, known: Collection[str], what: str) -> str:
    """Say what is meant by a name, or what there is."""
    from vtray.scene.checks.scene_words import nearest

    told = [words for argument, words in _MEANT.get(name, {}).items() if argument in known]
    if told:
        return told[0]
    close = nearest(name, list(known), cutoff=0.6)
    return f"did you mean {close}?" if close else f"the {what} are {', '.join(known)}"


def explain_unknown(function: Callable[P, R]) -> Callable[P, R]:
    """Make the TypeError for an unknown argument of a function say what is meant.

    Parameters
    ----------
    function
        A function with named arguments alone, no ``*args`` and no ``**kwargs``; or the ``__init__``
        of a class.
    """
    code = function.__code__
    called_as = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    known = [name for name in names if name not in ("self", "cls")]

    @functools.wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> R:
        for name in kwargs:
            if name not in known:
                raise TypeError(unknown_argument(called_as, name, known))
        return function(*args, **kwargs)

    return called
