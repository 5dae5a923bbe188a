"""How device functions call each other: they return their value, and nothing else.

A function that Numba has compiled returns whether it raised an exception, writes its value and the
exception to where the caller says, and the caller looks at all that after each call. An array goes
from one to the other taken apart, in seven words. Both together were a third of all that LLVM was
given (141,000 lines for README's room, 93,000 without). Device functions raise nothing. So they are
functions as in C, told apart by their names; Numba's own convention is left to what is not put into
its callers (kernels, parts, and what is seldom called), and to Numba's own functions.

Where one of these fails in a device function, that returns 0.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

import contextlib
from typing import Any

import numba
from llvmlite import ir
from numba.core import cgutils
from numba.core.callconv import RETCODE_OK, CPUCallConv, Status
from numba.core.cpu import CPUContext

from vtray.base.compiler.function_names import UnnamedError
from vtray.base.compiler.items import Item, is_of_item
from vtray.base.compiler.kept_types import symbol_of
from vtray.base.compiler.known_types import remembering
from vtray.base.compiler.mode import is_kept

types: Any = numba.types

_MARK = ".plain"
"""What the names of plain functions end with."""


_LIKE_ARRAYS = "__array__"
"""What Numba asks of each array: whether it only looks like one. None of vtray's do."""


def is_plain(function: ir.Function) -> bool:
    """Tell whether a function returns its value and nothing else."""
    return bool(function.name.endswith(_MARK))


class PlainCalls(CPUCallConv):
    """Numba's convention, but for functions that are plain."""

    def plain_type(self, returned: Any, arguments: Any) -> ir.FunctionType:
        """Return the type of a plain function."""
        values = [self.context.get_value_type(each) for each in arguments if _is_passed(each)]
        if isinstance(returned, types.Optional):
            return ir.FunctionType(self.context.get_value_type(returned), values)
        return ir.FunctionType(self.get_return_type(returned).pointee, values)

    def decorate_function(
        self, fn: ir.Function, args: Any, fe_argtypes: Any, noalias: bool = False
    ) -> None:
        """Give the arguments of a function their names."""
        if not is_plain(fn):
            super().decorate_function(fn, args, fe_argtypes, noalias)
            return
        passed = [name for name, each in zip(args, fe_argtypes, strict=True) if _is_passed(each)]
        for argument, name in zip(fn.args, passed, strict=True):
            argument.name = f"arg.{name}"

    def decode_arguments(self, builder: ir.IRBuilder, argtypes: Any, func: ir.Function) -> Any:
        """Write what gives the arguments of a function as values; return these."""
        if not is_plain(func):
            return super().decode_arguments(builder, argtypes, func)
        passed = iter(func.args)
        return [next(passed) if _is_passed(each) else None for each in argtypes]

    def return_value(self, builder: ir.IRBuilder, retval: Any) -> None:
        """Write what returns a value."""
        if is_plain(builder.function):
            builder.ret(retval)
        else:
            super().return_value(builder, retval)

    def return_optional_value(
        self, builder: ir.IRBuilder, retty: Any, valty: Any, value: Any
    ) -> None:
        """Write what returns a value that may be None."""
        if is_plain(builder.function):
            builder.ret(self.context.cast(builder, value, valty, retty))
        else:
            super().return_optional_value(builder, retty, valty, value)

    def return_status_propagate(self, builder: ir.IRBuilder, status: Status) -> None:
        """Write what returns where something called has failed."""
        if status.excinfoptr is None:
            builder.unreachable()
        elif is_plain(builder.function):
            _return_nothing(builder)
        else:
            super().return_status_propagate(builder, status)

    def return_user_exc(
        self,
        builder: ir.IRBuilder,
        exc: Any,
        exc_args: Any = None,
        loc: Any = None,
        func_name: Any = None,
    ) -> None:
        """Write what returns where an exception would be raised."""
        if is_plain(builder.function):
            _return_nothing(builder)
        else:
            super().return_user_exc(builder, exc, exc_args, loc, func_name)

    def call_function(
        self,
        builder: ir.IRBuilder,
        callee: ir.Function,
        resty: Any,
        argtys: Any,
        args: Any,
        attrs: Any = None,
    ) -> tuple[Status, Any]:
        """Write a call; return what Numba knows of how it went, and the value."""
        if not is_plain(callee):
            found: tuple[Status, Any] = super().call_function(
                builder, callee, resty, argtys, args, attrs
            )
            return found
        passed = [arg for arg, each in zip(args, argtys, strict=True) if _is_passed(each)]
        value = builder.call(callee, passed)
        if isinstance(resty, types.Optional):
            optional = self.context.make_helper(builder, resty, value=value)
            is_none = builder.not_(cgutils.as_bool_bit(builder, optional.valid))
            return _WENT_WELL._replace(is_none=is_none), optional.data
        return _WENT_WELL, self.context.get_returned_value(builder, resty, value)


class KernelContext(CPUContext):
    """What Numba knows of the machine, for functions that call plain ones."""

    def __init__(self, context: CPUContext) -> None:
        self.__dict__.update(context.__dict__)
        self.typing_context = remembering(context.typing_context)
        # What these call must be none of Numba's for others, nor be taken for that.
        self.cached_internal_func = {}
        self._sizes: dict[str, int] = {}

    def get_abi_sizeof(self, ty: ir.Type) -> int:
        """Return the size of a type in bytes, which Numba lets LLVM find out each time."""
        name = str(ty)
        if name not in self._sizes:
            self._sizes[name] = super().get_abi_sizeof(ty)
        return self._sizes[name]

    def refresh(self) -> None:
        """Do nothing: Numba looks for what is new before each function, which takes its time."""

    def get_function(self, fn: Any, sig: Any, _firstcall: bool = True) -> Any:
        """Return what writes a call of a function of Numba's, or of one that is new."""
        if is_of_item(fn, sig):
            return Item(self.get_function, fn, sig)
        try:
            return super().get_function(fn, sig, False)
        except NotImplementedError:
            if fn == _LIKE_ARRAYS:
                raise
            super().refresh()
            return super().get_function(fn, sig, False)

    @property
    def call_conv(self) -> PlainCalls:
        """How functions are called."""
        return PlainCalls(self)

    def mangler(self, name: str, argtypes: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
        """Return the name of a function in machine code."""
        if is_kept():
            with contextlib.suppress(UnnamedError):
                return symbol_of(name, argtypes)
        mangled: str = super().mangler(name, argtypes, abi_tags=abi_tags, uid=uid)
        return mangled

    def declare_function(self, module: ir.Module, fndesc: Any) -> ir.Function:
        """Write the declaration of a function."""
        if not fndesc.mangled_name.endswith(_MARK):
            return super().declare_function(module, fndesc)
        kind = self.call_conv.plain_type(fndesc.restype, fndesc.argtypes)
        function = cgutils.get_or_insert_function(module, kind, fndesc.mangled_name)
        self.call_conv.decorate_function(function, fndesc.args, fndesc.argtypes)
        if fndesc.inline:
            function.attributes.add("alwaysinline")
        return function


class DeviceContext(KernelContext):
    """The same for functions that are plain themselves."""

    def mangler(self, name: str, argtypes: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
        """Return the name of a function in machine code."""
        return super().mangler(name, argtypes, abi_tags=abi_tags, uid=uid) + _MARK


def _is_passed(kind: Any) -> bool:
    """Tell whether an argument is one in machine code: defaults that are not given are none."""
    return not isinstance(kind, types.Omitted)


def _return_nothing(builder: ir.IRBuilder) -> None:
    returned = builder.function.function_type.return_type
    builder.ret(cgutils.get_null_value(returned))


_NO, _YES = cgutils.false_bit, cgutils.true_bit

_WENT_WELL = Status(
    code=RETCODE_OK,
    is_ok=_YES,
    is_none=_NO,
    is_error=_NO,
    is_stop_iteration=_NO,
    is_python_exc=_NO,
    is_user_exc=_NO,
    excinfoptr=None,
)

_contexts: dict[type[KernelContext], KernelContext] = {}


def context_of(kind: type[KernelContext], context: CPUContext) -> KernelContext:
    """Return what Numba knows of the machine, as a context of some kind."""
    if kind not in _contexts:
        context.refresh()
        _contexts[kind] = kind(context)
    return _contexts[kind]
