"""Compiled kernels on disk, and their way into memory without Numba.

Importing Numba takes longer than rendering most scenes, and only its compiler is needed. So each
kernel's object code, as LLVM has made it, goes into a file of its own, from which it is loaded
within a millisecond: by `elf_loader`, or where that is not enough by LLVM's linker.

A file is used only if all that could make its code wrong is as it was: the types of the arguments,
the processor, Python, Numba with its settings, and LLVM are part of its name, the sources of vtray
that of its folder, and it begins with a hash of the rest. In any other case the kernel is compiled
again, and the file replaced as a whole, so that several processes may do so at once.
"""

import contextlib
import gc
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec, module_from_spec
from itertools import count
from pathlib import Path
from typing import Any, TypeVar

import msgspec
from blake3 import blake3

from vtray.base.compiler.elf_loader import NOTHING, load
from vtray.base.compiler.function_names import OWN, full_name
from vtray.base.compiler.kernel_folder import SUFFIX, cache_folder, read_kept, write_kept
from vtray.base.compiler.mode import compiling
from vtray.base.compiler.native_call import Layout, TupleLayout
from vtray.base.compiler.processor import processor
from vtray.base.compiler.unseen import (
    KeptPart,
    Unsaid,
    all_unseen,
    is_open,
    kept_parts,
    unsaid_of,
    unseen_by,
)
from vtray.base.memory import check_memory_of_compiler, check_memory_of_start

SETTINGS_FILE = Path(".numba_config.yaml")
"""Settings of Numba's, in the folder in which Python was started.

References
----------
https://numba.readthedocs.io/en/stable/reference/envvars.html
"""

PART_MARK = "-"
"""What is in the name of a part, and of no function of C."""

_HASH_BYTES = 32
_KEY_BYTES = 12

_OBJECTS_TO_COLLECT = 20_000
"""How many more objects there may be, while Numba compiles, before Python looks for dead ones.

With its usual 700, looking takes a tenth of all compiling; with these, 3 MB more are needed.
"""

Struct = TypeVar("Struct", bound=msgspec.Struct)

_number = count()


class ObjectCode(msgspec.Struct, frozen=True):
    """A compiled kernel, or a part.

    Attributes
    ----------
    symbol
        The name of its entry point in the code.
    layout
        What it returns.
    code
        An object file of this machine.
    parts
        The names of the parts that it calls.
    open_parts
        What is known of those among them that are open.
    key, names
        Of a kernel, what is unsaid in all of them.
    """

    symbol: str
    layout: str | TupleLayout
    code: bytes
    parts: tuple[str, ...] = ()
    open_parts: tuple[KeptPart, ...] = ()
    key: str = ""
    names: dict[str, str] = {}


def object_name(function: str, types: str) -> str:
    """Return the name of the machine code of a function with arguments of some types."""
    circumstances = [*_circumstances(), *_numba_settings()]
    key = blake3("\n".join([function, types, *circumstances]).encode()).hexdigest()
    return f"{function}-{key[:16]}"


def object_file(name: str) -> Path | None:
    """Return the file for machine code of some name, None if nothing can be kept.

    The name of its folder tells only whether vtray's own sources have changed, so nothing else is
    kept.
    """
    folder = cache_folder() if name.startswith(OWN) else None
    return folder and folder / f"{name}{SUFFIX}"


def read_object_code(file: Path) -> ObjectCode | None:
    """Return what a file holds, None if it is missing, damaged, or not to be trusted."""
    return read_struct(file, ObjectCode)


def write_object_code(file: Path, compiled: ObjectCode) -> None:
    """Write a file, whole; if that fails, the next process compiles again."""
    write_struct(file, compiled)


def read_struct(file: Path, kind: type[Struct]) -> Struct | None:
    """Return what a file in the folder holds, None if that is missing, damaged, or not trusted."""
    content = read_kept(file) or b""
    checksum, body = content[:_HASH_BYTES], content[_HASH_BYTES:]
    with contextlib.suppress(msgspec.DecodeError):
        if checksum == blake3(body).digest():
            return msgspec.msgpack.decode(body, type=kind)
    return None


def write_struct(file: Path, content: msgspec.Struct) -> None:
    """Write a file in the folder, whole, if that can be."""
    body = msgspec.msgpack.encode(content)
    with contextlib.suppress(OSError):
        write_kept(file, blake3(body).digest() + body)


def compile_object(
    function: Callable[..., object],
    arguments: tuple[object, ...],
    options: Mapping[str, Any],
    is_anew: bool = False,
) -> ObjectCode:
    """Compile a kernel with Numba, if it was not yet for arguments that are the same to it.

    Parameters
    ----------
    function
        The Python function.
    arguments
        Values of the types that it is compiled for.
    options
        Numba's.
    is_anew
        Whether it is compiled in any case.
    """
    check_memory_of_compiler()
    import numba

    from vtray.base.compiler.in_memory import hidden, in_memory
    from vtray.base.compiler.numba_pipeline import ENTRY

    typeof: Any = numba.typeof
    types = tuple(in_memory(typeof(argument)) for argument in arguments)
    unseen, unsaid = unseen_by(function), _unsaid_in(types)
    own = tuple(hidden(kind, unseen) for kind in types)
    name = object_name(full_name(function), ", ".join(map(str, own)))
    file = object_file(name) if unseen else None
    found = read_object_code(file) if file and not is_anew else None
    if found:
        return msgspec.structs.replace(found, key=unsaid.key)
    result = _compile(function, own, options, unsaid)
    code = result.library.object_code(result.fndesc, result.target_context)
    made = ObjectCode(ENTRY, _layout(result.signature.return_type), code, _parts_in(result))
    made = msgspec.structs.replace(made, open_parts=_open_parts(made), key=unsaid.key)
    if file:
        write_object_code(file, made)
    return made


def compile_part(
    function: Callable[..., object],
    types: tuple[Any, ...],
    options: Mapping[str, Any],
    name: str,
    unsaid: Unsaid | None = None,
) -> ObjectCode:
    """Compile a part with Numba, for arguments of some of its types."""
    result = _compile(function, types, options, unsaid)
    code = result.library.part_code(result.fndesc.llvm_func_name, name)
    made = ObjectCode(name, _layout(result.signature.return_type), code, _parts_in(result))
    return msgspec.structs.replace(made, open_parts=_open_parts(made))


def _unsaid_in(types: tuple[Any, ...]) -> Unsaid:
    """Return what some types say that code may not see."""
    from vtray.base.compiler.in_memory import tuples_in

    unseen = all_unseen()
    found = {full_name(kind.made_by): kind for own in types for kind in tuples_in(own)}
    found = {name: kind for name, kind in sorted(found.items()) if name in unseen}
    text = ", ".join(f"{name} {kind}" for name, kind in found.items())
    unsaid = unsaid_of(blake3(text.encode()).hexdigest(_KEY_BYTES) if found else "")
    unsaid.types = found
    return unsaid


def _compile(
    function: Callable[..., object],
    types: tuple[Any, ...],
    options: Mapping[str, Any],
    unsaid: Unsaid | None,
) -> Any:  # noqa: ANN401
    """Return Numba's result for a function of its own in memory."""
    import numba
    from numba.core.compiler_lock import global_compiler_lock

    from vtray.base.compiler.numba_pipeline import KernelPipeline

    # The wrappers through which Python would call it need Numba in memory.
    unwrapped: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    compiler: Any = numba.njit(function, pipeline_class=KernelPipeline, **options, **unwrapped)
    is_own = function.__module__.startswith(OWN)
    # One thread after the other, as what is changed for the time of compiling is all threads'.
    with global_compiler_lock, compiling(is_own, unsaid), _fewer_collections(), _hurried():
        compiler.compile(types)
    return compiler.overloads[types]


def _parts_in(result: Any) -> tuple[str, ...]:  # noqa: ANN401
    """Return the names of the parts that compiled code calls."""
    return tuple(sorted(name for name in result.library.called() if PART_MARK in name))


def _open_parts(code: ObjectCode) -> tuple[KeptPart, ...]:
    """Return what is known of the open parts that newly compiled code calls."""
    return tuple(kept_parts[name] for name in code.parts if is_open(name))


@contextlib.contextmanager
def _fewer_collections() -> Iterator[None]:
    """Let Python look less often for objects that nothing needs."""
    usual = gc.get_threshold()
    gc.set_threshold(max(usual[0], _OBJECTS_TO_COLLECT) if usual[0] else 0, *usual[1:])
    try:
        yield
    finally:
        gc.set_threshold(*usual)


@contextlib.contextmanager
def _hurried() -> Iterator[None]:
    """Let Numba leave what is of no use here, as long as a thread compiles.

    - It takes its time at each call of LLVM, once more for each function that has led to the one
      that it compiles: a tenth of all compiling.
    - It makes and drops an error for each overload that does not fit. Where colorama is installed,
      to paint them all is a twentieth of all compiling.
    - It looks again and again at the parameters of what writes operators.
    """
    from llvmlite.binding import ffi
    from numba.core import base, errors
    from numba.core.registry import cpu_target

    _ = cpu_target.target_context  # whoever is told of calls has asked for it by now
    lock: Any = ffi.lib._lock  # noqa: SLF001 - llvmlite lets only who has asked take that back
    told, lock._cblist = lock._cblist, []  # noqa: SLF001
    others: list[tuple[Any, str, object]] = [
        (errors, "_termcolor_inst", _NoColors()),
        (base, "_has_loc", _takes_place),
    ]
    usual = [getattr(module, name) for module, name, _ in others]
    for module, name, value in others:
        setattr(module, name, value)
    try:
        yield
    finally:
        for (module, name, _), value in zip(others, usual, strict=True):
            setattr(module, name, value)
        lock._cblist += told  # noqa: SLF001


@cache
def _takes_place(writer: Callable[..., object]) -> bool:
    """Tell whether what writes an operator takes the place that it has in the source, as Numba."""
    return "loc" in inspect.signature(writer).parameters


class _NoColors:
    """Leaves text as it is, whatever it is for."""

    def __getattr__(self, _purpose: str) -> Callable[[str], str]:
        return str


def link(compiled: ObjectCode, parts: Mapping[str, int] = NOTHING) -> int:
    """Load object code into memory for the rest of the process; return its function's address.

    Parameters
    ----------
    compiled
        The code.
    parts
        The addresses of the parts that it calls.

    Raises
    ------
    RuntimeError
        It is not object code of this machine, or it needs something that there is not.
    """
    entry = load(compiled.code, compiled.symbol, parts)
    if entry is not None:
        return entry
    try:
        return _link(compiled, parts)
    except RuntimeError:  # a symbol is missing
        return _link(compiled, {**_helpers(), **parts})


def _link(compiled: ObjectCode, others: Mapping[str, int]) -> int:
    """Let LLVM load object code that may call C's library, and others at some addresses."""
    from llvmlite.binding import JITLibraryBuilder

    builder = JITLibraryBuilder().add_object_img(compiled.code).add_current_process()
    for name, address in others.items():
        builder.import_symbol(name, address)
    library = builder.export_symbol(compiled.symbol).link(_linker(), f"kernel{next(_number)}")
    entry: int = library[compiled.symbol]
    # While Python ends, a thread may still be in there.
    library.detach()
    return entry


def _helpers() -> dict[str, int]:
    """Return the addresses of the C functions that Numba calls, for instance to reshape an array.

    Importing them without the rest of Numba takes 3 ms.
    """
    spec = find_spec("numba")
    found = spec and PathFinder.find_spec("numba._helperlib", spec.submodule_search_locations)
    if not found or not found.loader:
        return {}
    module = module_from_spec(found)
    found.loader.exec_module(module)
    return {f"numba_{name}": address for name, address in module.c_helpers.items()}


@cache
def _linker() -> object:
    """Return LLVM's linker."""
    check_memory_of_start()
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.create_lljit_compiler(suppress_errors=True)


def _layout(returned: Any) -> Layout:  # noqa: ANN401 - a type of Numba's
    """Return how a value of a type of Numba's lies in memory."""
    import numba
    from numba.np.numpy_support import as_dtype

    types: Any = numba.types
    if isinstance(returned, types.NoneType):
        return ""
    if isinstance(returned, types.BaseTuple):
        made_by = getattr(returned, "instance_class", tuple)
        items = [_layout(item) for item in returned.types]
        return TupleLayout(f"{made_by.__module__}:{made_by.__qualname__}", items)
    return str(as_dtype(returned).str[1:])


@cache
def _circumstances() -> list[str]:
    """Return what the compiled code depends on, besides the sources and the arguments."""
    import llvmlite

    return [sys.version, _numba_version(), llvmlite.__version__, processor()]


def _numba_settings() -> list[str]:
    """Return what Numba reads before it compiles: the environment, and a file in this folder."""
    found = sorted(f"{name}={value}" for name, value in os.environ.items() if name[:6] == "NUMBA_")
    with contextlib.suppress(OSError):
        # Without the package that reads it, Numba passes it over.
        if SETTINGS_FILE.is_file() and find_spec("yaml"):
            found.append(f"{SETTINGS_FILE}={SETTINGS_FILE.read_bytes().hex()}")
    return found


def _numba_version() -> str:
    """Return the version of Numba, without importing it."""
    numba = find_spec("numba")
    if numba is None or numba.origin is None:
        return "none"
    return Path(numba.origin).with_name("_version.py").read_text()
