"""What Numba has found of the types of operators and functions, remembered.

It tries all that ``+`` may mean each time it sees one, also for types that it has seen: when it
infers the types of a function, and again when it writes it. That took a sixth of all compiling.
"""

# mypy: allow-untyped-calls

from collections.abc import Callable
from functools import cache
from typing import Any

import numba
from numba.core.datamodel.models import OpaqueModel
from numba.core.datamodel.registry import register_default
from numba.core.typing.context import BaseContext, Context

from vtray.base.compiler.own_builtins import own_templates, written_for

types: Any = numba.types


class _Remembering(Context):
    """What Numba knows of types, with what it has found."""

    def __init__(self, context: BaseContext) -> None:
        self.__dict__ = context.__dict__

    def refresh(self) -> None:
        """Do nothing: Numba looks for what is new before each function, which takes its time."""

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:  # noqa: ANN401
        """Return the signature of a function for arguments of some types."""
        if kws or (isinstance(func, types.Type) and not isinstance(func, types.Function)):
            return super().resolve_function_type(func, args, kws)
        return _once((func, *args), super().resolve_function_type, func, args, kws)

    def resolve_value_type(self, val: Any) -> Any:  # noqa: ANN401
        """Return the type of what is known while compiling."""
        if not callable(val) or hasattr(type(val), "_numba_type_"):
            return super().resolve_value_type(val)
        if id(val) not in _callables:
            found = super().resolve_value_type(written_for(val))
            if type(found) is types.Function:
                own = own_templates(val)
                found = _Function((*own, *found.templates)) if own else _function(found)
            _callables[id(val)] = val, found
        return _callables[id(val)][1]


class _Function(types.Function):  # type: ignore[misc]
    """A function or operator of Numba's, with what it returns for which arguments."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:  # noqa: ANN401
        """Return its signature for arguments of some types."""
        if kws:
            return super().get_call_type(context, args, kws)
        return _once((self, *args), super().get_call_type, context, args, kws)


register_default(_Function)(OpaqueModel)

_callables: dict[int, tuple[Callable[..., object], Any]] = {}
"""Functions and operators with their types by their identities: not all of them have a hash.

Not those that tell their types themselves, which depend on what they are compiled for.
"""

_signatures: dict[tuple[Any, ...], Any] = {}


def _once(call: tuple[Any, ...], find: Callable[..., Any], *arguments: Any) -> Any:  # noqa: ANN401
    """Return what is remembered of a call of a function; what is not, is found first."""
    if call not in _signatures:
        _signatures[call] = find(*arguments)
    return _signatures[call]


@cache
def _function(kind: Any) -> _Function:  # noqa: ANN401
    """Return a function that remembers, and knows what Numba finds where nothing is remembered."""
    found = _Function(kind.templates)
    found._impl_keys = kind._impl_keys  # noqa: SLF001 - Numba has no other way to share them
    return found


@cache
def remembering(context: BaseContext) -> Context:
    """Return what Numba knows of types as what remembers."""
    context.refresh()
    return _Remembering(context)
