"""Device functions on disk: what Numba has made of them, for kernels that are compiled later.

A kernel calls some hundred device functions, and most of the time of compiling it goes into these,
one after the other, before LLVM sees any. Nearly all of them are the same for other shapes, lights
and films, but each process would begin anew. So what Numba has made of each, in LLVM's language,
goes into a file of its own beside the kernels, by the same rules: what could make it wrong is in
its name or in that of its folder. To Numba this is its cache, of which it asks before it compiles.

Only functions of vtray's own are kept, and only while a kernel is compiled that is kept itself:
what others make of them, a test for instance that changes a constant, stays in its process.

In the files, functions go by names that say what they are, as others call them by these. What
Numba itself adds for a function, to find the larger of two numbers for instance, it would number
in each process anew, so it goes by a hash of its content.
"""

# ruff: noqa: ANN401, SLF001
# mypy: allow-untyped-calls

import contextlib
from collections.abc import Callable
from typing import Any

import msgspec
from blake3 import blake3
from llvmlite import binding
from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import compile_result
from numba.core.environment import Environment
from numba.core.funcdesc import PythonFunctionDescriptor
from numba.core.typing.templates import Signature

from vtray.base.compiler.function_names import UnnamedError, full_name
from vtray.base.compiler.kept_types import pickled, symbol_of, unpickled
from vtray.base.compiler.mode import is_kept
from vtray.base.compiler.numba_pipeline import DeviceLibrary
from vtray.base.compiler.object_code import (
    PART_MARK,
    object_file,
    object_name,
    read_struct,
    write_struct,
)
from vtray.base.compiler.parts import kept_part, know_part
from vtray.base.compiler.unseen import KeptPart

_DIGEST_BYTES = 12


class KeptFunction(msgspec.Struct, frozen=True):
    """What is kept of a function that has been compiled for some types.

    Attributes
    ----------
    symbol
        Its name in LLVM's language.
    code
        The function there, and nothing of what it calls.
    added
        What Numba has added for it alone.
    called
        The names of the files of the functions that it calls.
    parts
        The parts that it calls.
    arguments, returned, is_inlined
        What its arguments are called, the type that it returns, pickled, and whether it is put
        into what calls it.
    """

    symbol: str
    code: bytes
    added: tuple[bytes, ...]
    called: tuple[str, ...]
    parts: tuple[KeptPart, ...]
    arguments: tuple[str, ...]
    returned: bytes
    is_inlined: bool


class KeptFunctions(NullCache):
    """What Numba asks before it compiles a device function.

    Parameters
    ----------
    function
        The function in Python.
    is_inlined
        Whether it is put into what calls it.
    """

    def __init__(self, function: Callable[..., object], is_inlined: bool) -> None:
        self._function = function
        self._is_inlined = is_inlined

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return what is kept of the function for some types of arguments, None if nothing is."""
        arguments = tuple(sig)
        name = self._name(arguments)
        kept = _read(name) if name else None
        library = _library_of(name, kept, target_context) if name and kept else None
        if kept is None or library is None:
            return None
        returned = unpickled(kept.returned)
        descriptor = PythonFunctionDescriptor(
            native=True,
            modname=self._function.__module__,
            qualname=self._function.__qualname__,
            unique_name=kept.symbol,
            doc="",
            typemap=None,
            restype=returned,
            calltypes=None,
            args=list(kept.arguments),
            kws=(),
            mangler=lambda *_, **__: kept.symbol,
            argtypes=arguments,
            inline=kept.is_inlined,
        )
        return compile_result(
            typing_context=None,
            target_context=target_context,
            entry_point=_entry_of(library, descriptor, target_context),
            typing_error=None,
            type_annotation=None,
            library=library,
            objectmode=False,
            lifted=(),
            fndesc=descriptor,
            signature=Signature(returned, arguments, None),
        )

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what Numba has made of the function for some types of arguments."""
        name = self._name(tuple(sig))
        if name is None:
            return
        with contextlib.suppress(UnnamedError):
            _write(name, _kept_of(data))
            _names[data.library] = name
            _libraries[name] = data.library

    def _name(self, arguments: tuple[Any, ...]) -> str | None:
        """Return the name of the file for some types of arguments, None if there is none."""
        if not is_kept():
            return None
        try:
            symbol = symbol_of(full_name(self._function), arguments)
        except UnnamedError:
            return None
        return object_name(full_name(self._function), f"{symbol} {self._is_inlined}")


_libraries: dict[str, DeviceLibrary] = {}
_names: dict[DeviceLibrary, str] = {}
_added: dict[str, DeviceLibrary] = {}
_renamings: dict[JITCodeLibrary, tuple[bytes, dict[str, str]]] = {}


def _kept_of(result: Any) -> KeptFunction:
    """Return what is kept of a function, given Numba's result."""
    library, descriptor = result.library, result.fndesc
    module = JITCodeLibrary._get_module_for_linking(library).clone()
    added: list[bytes] = []
    called: list[str] = []
    for each in dict.fromkeys(library._linking_libraries):
        if each in _names:
            called.append(_names[each])
        elif isinstance(each, DeviceLibrary):
            raise UnnamedError  # it could not be kept itself
        else:
            added.append(_renamed(each, module))
    parts = tuple(
        kept_part(each.name)
        for each in module.functions
        if each.is_declaration and PART_MARK in each.name
    )
    return KeptFunction(
        descriptor.mangled_name,
        module.as_bitcode(),
        tuple(added),
        tuple(called),
        parts,
        tuple(descriptor.args),
        pickled(descriptor.restype),
        descriptor.inline,
    )


def _renamed(added: JITCodeLibrary, module: Any) -> bytes:
    """Return what Numba has added, with names that are a hash of it, also where it is called."""
    if added not in _renamings:
        _renamings[added] = _renaming(JITCodeLibrary._get_module_for_linking(added))
    code, names = _renamings[added]
    for each in module.functions:
        if each.is_declaration and each.name in names:
            each.name = names[each.name]
    return code


def _renaming(added: Any) -> tuple[bytes, dict[str, str]]:
    """Return what Numba has added with other names, and these for those that it had."""
    renamed = added.clone()
    digest = blake3(added.as_bitcode()).hexdigest(_DIGEST_BYTES)
    names: dict[str, str] = {}
    for k, each in enumerate(each for each in renamed.functions if not each.is_declaration):
        names[each.name] = f"added.{digest}.{k}"
        each.name = names[each.name]
    return renamed.as_bitcode(), names


def _library_of(name: str, kept: KeptFunction, context: Any) -> DeviceLibrary | None:
    """Return a function as Numba's library, None if something that it calls is not kept."""
    if name in _libraries:
        return _libraries[name]
    called: list[Any] = []
    for each in kept.called:
        if each not in _libraries:
            found = _read(each)
            if found is None or _library_of(each, found, context) is None:
                return None
        called.append(_libraries[each])
    for code in kept.added:
        digest = blake3(code).hexdigest()
        if digest not in _added:
            _added[digest] = _library(code, [], context)
        called.append(_added[digest])
    for part in kept.parts:
        know_part(part)
    _libraries[name] = _library(kept.code, called, context)
    _names[_libraries[name]] = name
    return _libraries[name]


def _entry_of(library: DeviceLibrary, descriptor: PythonFunctionDescriptor, context: Any) -> object:
    """Return what stands for a function where Numba would have one that Python calls."""
    return context.get_executable(library, descriptor, Environment.from_fndesc(descriptor))


def _library(code: bytes, called: list[Any], context: Any) -> DeviceLibrary:
    """Return code in LLVM's language as Numba's library, with what it calls."""
    made = DeviceLibrary(context.codegen(), "function")
    made._final_module = made._shared_module = binding.parse_bitcode(code)
    made._linking_libraries = called
    made._finalized = True
    return made


def _read(name: str) -> KeptFunction | None:
    file = object_file(name)
    return read_struct(file, KeptFunction) if file else None


def _write(name: str, kept: KeptFunction) -> None:
    file = object_file(name)
    if file:
        write_struct(file, kept)
