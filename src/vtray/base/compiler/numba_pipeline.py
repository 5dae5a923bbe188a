"""Numba's compiler, without the work that is of no use to kernels.

Numba optimizes each function together with all that it calls, and makes machine code of it, so that
Python could call it. Here that is of use for a kernel alone, into which LLVM puts all device
functions. They are only simplified, each by itself: without that, loops are not vectorised.

A kernel takes its arguments from memory, word by word, for which its machine code begins with an
entry point; tuples of arrays stay there (`in_memory`).

Parts of kernels have machine code of their own. Where code calls them there is only a name, which
the linker finds.
"""

# mypy: allow-untyped-calls

import inspect
from collections.abc import Callable
from functools import cache
from typing import Any

import numba
from llvmlite import binding, ir
from numba.core import cgutils
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.targetconfig import ConfigStack
from numba.core.typing.templates import make_intrinsic_template

from vtray.base.compiler.elf_loader import IS_KNOWN
from vtray.base.compiler.in_memory import WORD, load, word_count
from vtray.base.compiler.known_types import remembering
from vtray.base.compiler.numba_passes import take_all_steps
from vtray.base.compiler.plain_calls import DeviceContext, KernelContext, context_of

ENTRY = "entry"
"""The name of the entry point: ``int entry(result *, exception **, const char *words)``."""

RETURNED: dict[object, Any] = {
    None: numba.types.none,
    bool: numba.types.boolean,
    int: numba.types.int64,
    float: numba.types.float64,
}
"""What parts may return, by their annotations: nobody looks into a part for that."""


class _NoEnvironments:
    """Passes over what Numba keeps for those functions that Python calls."""

    def set_env(self, name: str, environment: object) -> None:
        """Do nothing."""


class DeviceLibrary(JITCodeLibrary):
    """A function in LLVM's language, to be put into others with all that it calls."""

    codegen = _NoEnvironments()

    def finalize(self) -> None:
        """Leave what the function calls apart: kernels take each function once."""
        self._raise_if_finalized()
        self._finalized = True

    def add_all_called(self, module: binding.ModuleRef) -> None:
        """Put all that the function calls, and that what it calls calls, into a module, once.

        LLVM takes in only what is called by then, so what calls comes before what it calls.
        """
        seen: set[JITCodeLibrary] = set()
        called: list[JITCodeLibrary] = []

        def visit(library: JITCodeLibrary) -> None:
            for each in library._linking_libraries:  # noqa: SLF001
                if each not in seen:
                    seen.add(each)
                    visit(each)
                    called.append(each)

        visit(self)
        for library in reversed(called):
            module.link_in(JITCodeLibrary._get_module_for_linking(library), preserve=True)  # noqa: SLF001

    def _get_module_for_linking(self) -> binding.ModuleRef:
        """Return the function with all that it calls, as Numba's own libraries want it."""
        module = JITCodeLibrary._get_module_for_linking(self).clone()  # noqa: SLF001
        self.add_all_called(module)
        return module

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        """Return 0: the function is nowhere in memory."""
        self._ensure_finalized()
        return 0


class SeldomLibrary(DeviceLibrary):
    """A function that is never put into others, and all that it calls."""

    def add_ir_module(self, ir_module: ir.Module) -> None:
        """Take the function itself, as Numba has written it."""
        for function in ir_module.functions:
            if function.blocks:
                function.attributes.add("noinline")
                # Without tables for exceptions of C++, code is loaded without LLVM.
                function.attributes.add("nounwind")
        super().add_ir_module(ir_module)


class KernelLibrary(DeviceLibrary):
    """A kernel and all that it calls, optimized."""

    def finalize(self) -> None:
        """Take in all that the kernel calls, and optimize it."""
        own = {function.name for function in self._final_module.functions}
        self.add_all_called(self._final_module)
        for function in self._final_module.functions:
            # What nobody else calls takes no arguments that it does not use.
            if not function.is_declaration and function.name not in own:
                function.linkage = "internal"
        self._linking_libraries = []
        JITCodeLibrary.finalize(self)

    def _finalize_final_module(self) -> None:
        """Put nothing into Numba's own memory."""
        self._finalized = True

    def part_code(self, name: str, symbol: str) -> bytes:
        """Return an object file of this machine with a function under another name."""
        self._ensure_finalized()
        self._final_module.get_function(name).name = symbol
        return self._emitted()

    def called(self) -> set[str]:
        """Return the names of what the code calls and does not hold."""
        return {each.name for each in self._final_module.functions if each.is_declaration}

    def object_code(self, called: Any, context: Any) -> bytes:  # noqa: ANN401
        """Return an object file of this machine that begins with an entry point.

        Parameters
        ----------
        called, context
            What Numba says of the function that the entry point calls, and of its compiler.
        """
        self._ensure_finalized()
        # Not before: the function would be put into its entry, and LLVM forget what arguments are.
        module = self._codegen._create_empty_module(ENTRY)  # noqa: SLF001
        _write_entry(module, called, context)
        self._final_module.link_in(binding.parse_assembly(str(module)))
        return self._emitted()

    def _emitted(self) -> bytes:
        code: bytes = _machine(self._codegen).emit_object(self._final_module)
        return code


class DevicePipeline(Compiler):
    """Numba's usual way from a function in Python to one in LLVM's language."""

    library: type[DeviceLibrary] = DeviceLibrary
    context: type[KernelContext] = DeviceContext

    def __init__(
        self,
        typingctx: Any,  # noqa: ANN401
        targetctx: Any,  # noqa: ANN401
        library: None,  # noqa: ARG002 - it is made here
        args: Any,  # noqa: ANN401
        return_type: Any,  # noqa: ANN401
        flags: Any,  # noqa: ANN401
        locals: Any,  # noqa: A002, ANN401
    ) -> None:
        made = self.library(targetctx.codegen(), "function")
        context = context_of(self.context, targetctx)
        known = remembering(typingctx)
        super().__init__(known, context, made, args, return_type, flags, locals)

    def _compile_core(self) -> Any:  # noqa: ANN401
        """Compile the function with only those of Numba's steps that kernels need."""
        with ConfigStack().enter(self.state.flags.copy()):
            return take_all_steps(self.state)


class SeldomPipeline(DevicePipeline):
    """The same for a function that is never put into others."""

    library = SeldomLibrary
    # LLVM would let it return its fourth number by way of the old unit for floats.
    context = KernelContext


class KernelPipeline(DevicePipeline):
    """The same for a kernel."""

    library = KernelLibrary
    context = KernelContext


class PythonPipeline(Compiler):
    """Numba's way to a function that Python calls."""

    def __init__(
        self,
        typingctx: Any,  # noqa: ANN401
        targetctx: Any,  # noqa: ANN401
        *others: Any,  # noqa: ANN401
    ) -> None:
        super().__init__(typingctx, context_of(KernelContext, targetctx), *others)


def type_of_calls(
    function: Callable[..., object], symbol_of: Callable[[tuple[Any, ...]], str]
) -> Any:  # noqa: ANN401
    """Return the type that a part is to compiled code: calls of it are calls of a name.

    Parameters
    ----------
    function
        The part.
    symbol_of
        Returns the name, given the types of the arguments.
    """
    returned = RETURNED[function.__annotations__["return"]]

    def define(_: object, *types: Any) -> tuple[Any, Any]:  # noqa: ANN401
        return returned(*types), _write_call

    def _write_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ANN401
        convention, types = context.call_conv, signature.args
        kind = convention.get_function_type(returned, types)
        called = cgutils.get_or_insert_function(builder.module, kind, symbol_of(types))
        called.attributes.add("nounwind")  # as in `SeldomLibrary`
        status, value = convention.call_function(builder, called, returned, types, arguments)
        with cgutils.if_unlikely(builder, status.is_error):
            convention.return_status_propagate(builder, status)
        return value

    # Numba asks what the arguments are called.
    parameters = inspect.signature(function).parameters.values()
    first = inspect.Parameter("_", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    define.__signature__ = inspect.Signature([first, *parameters])  # type: ignore[attr-defined]
    make: Any = make_intrinsic_template
    return numba.types.Function(make(function, define, function.__name__))


@cache
def _machine(codegen: Any) -> Any:  # noqa: ANN401
    """Return what writes machine code for this processor.

    Numba has each constant's address written out, in 64 bits, wherever it is read. Where
    `elf_loader` places code and constants side by side, how far they are apart does, in 32.
    """
    if not IS_KNOWN:
        return codegen._tm  # noqa: SLF001
    options: dict[str, Any] = {"opt": numba.config.OPT}  # type: ignore[attr-defined]
    codegen._customize_tm_options(options)  # noqa: SLF001
    options |= {"reloc": "pic", "codemodel": "small"}
    target = binding.Target.from_triple(binding.get_process_triple())
    return target.create_target_machine(**options)


def _write_entry(module: ir.Module, called: Any, context: Any) -> None:  # noqa: ANN401
    """Write the entry point of a function."""
    kind = context.call_conv.get_function_type(called.restype, called.argtypes)
    function = ir.Function(module, kind, called.llvm_func_name)
    entry_kind = ir.FunctionType(kind.return_type, [*kind.args[:2], WORD.as_pointer()])
    entry = ir.Function(module, entry_kind, ENTRY)
    entry.attributes.add("nounwind")
    builder = ir.IRBuilder(entry.append_basic_block())
    result, exception, words = entry.args
    arguments, at = [], 0
    for each in called.argtypes:
        arguments.append(load(context, builder, each, builder.gep(words, [WORD(at)])))
        at += word_count(each)
    packed = context.get_arg_packer(called.argtypes).as_arguments(builder, arguments)
    builder.ret(builder.call(function, [result, exception, *packed]))
