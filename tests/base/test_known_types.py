"""What is remembered of types is what Numba finds."""

import operator

import numba
from numba.core.typing.context import Context

from vtray.base.compiler.known_types import remembering


def test_what_numba_finds_by_itself_is_known_where_functions_are_written() -> None:
    context = Context()
    remembered = remembering(context).resolve_value_type(operator.neg)
    usual = context.resolve_value_type(operator.neg)
    signature = usual.get_call_type(context, (numba.float64,), {})
    assert remembered.get_impl_key(signature) == usual.get_impl_key(signature)
