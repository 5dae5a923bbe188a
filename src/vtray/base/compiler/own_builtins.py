"""Python's ``min``, ``max`` and ``int`` of numbers, written where they are called.

Numba makes functions of these, one for all that they are called with, which it compiles in each
process: fifteen for a first picture, which take as long as a large kernel. What these call in the
end is a few instructions, which are written at once here, and are the same.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls, disable-error-code="untyped-decorator"

import operator
from collections.abc import Callable
from typing import Any

import numba
from numba.core.imputils import builtin_registry
from numba.core.typing.templates import AbstractTemplate, signature
from numba.cpython import builtins
from numba.cpython.builtins import do_minmax

types: Any = numba.types

_CAST_INT = getattr(builtins, "cast_int", int)
"""What Numba's function for ``int`` calls; before 0.66, it has none."""


class _Least(AbstractTemplate):
    """The type of ``min`` of two numbers or more."""

    key = min

    def generic(self, args: Any, kws: Any) -> Any:
        """Return what is known of a call, None if it is none of these."""
        if kws or len(args) < 2 or not all(isinstance(each, types.Number) for each in args):
            return None
        kind = self.context.unify_types(*args)
        return kind and signature(kind, *args)

    def get_impl_key(self, sig: Any) -> object:  # noqa: ARG002
        """Return by what Numba finds what writes it."""
        return _write_least


class _Greatest(_Least):
    """The type of ``max`` of two numbers or more."""

    key = max

    def get_impl_key(self, sig: Any) -> object:  # noqa: ARG002
        """Return by what Numba finds what writes it."""
        return _write_greatest


def _write_least(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return do_minmax(context, builder, sig.args, args, operator.lt)


def _write_greatest(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return do_minmax(context, builder, sig.args, args, operator.gt)


for _write in (_write_least, _write_greatest):
    builtin_registry.lower(_write, types.VarArg(types.Any))(_write)


def own_templates(function: Callable[..., object]) -> tuple[type, ...]:
    """Return the types that a function of Python has before those that Numba gives it."""
    return (_Least,) if function is min else (_Greatest,) if function is max else ()


def written_for(function: Callable[..., object]) -> Callable[..., object]:
    """Return what is called in the end where a function of Python is called."""
    return _CAST_INT if function is int else function
