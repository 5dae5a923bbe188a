"""How kernels are compiled.

Every compile-time decision is made here:

- ``error_model="numpy"``: a division by zero gives infinity or NaN, as in C, and loops vectorise.
- ``nogil=True``: kernels of several threads run side by side.
- No ``fastmath``, no fused multiply-add: pictures are equal to the last bit on every processor.
- ``forceinline=True`` for device functions: LLVM left some calls in inner loops, which were not
  vectorised then (a million spheres: 0.62 s without it, 0.22 s with it).
- ``_nrt=False``: no reference counts on arrays. Kernels allocate nothing, and the counting in inner
  loops kept them from being vectorised (a room with 64 lights: 0.55 s with it, 0.09 s without).
- No index is below 0, but for a constant such as ``-1``: nobody looks whether one is (`items`).

Kernels are compiled once per machine: `object_code` keeps them on disk and loads them. Numba is
imported only to compile, and where a kernel cannot be called without it, of which `canary` warns.
"""

import contextlib
import os
import sys
import threading
import time
from collections.abc import Callable
from functools import cached_property, partial, update_wrapper
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vtray.base.compiler.canary import (
    compare_with_python,
    new_arguments,
    sing,
    warn_of_slow_starts,
)
from vtray.base.compiler.elf_loader import NOTHING
from vtray.base.compiler.function_names import full_name
from vtray.base.compiler.kernel_folder import cache_folder
from vtray.base.compiler.mode import is_for_kernels
from vtray.base.compiler.native_call import (
    NativeCall,
    Pinned,
    Types,
    UnsupportedError,
    caller,
    unpack,
    unpinned,
)
from vtray.base.compiler.object_code import (
    ObjectCode,
    compile_object,
    link,
    object_file,
    object_name,
    read_object_code,
    write_object_code,
)
from vtray.base.compiler.parts import (
    compile_sooner,
    get_help,
    learn,
    load_parts,
    make_parts,
    new_name,
    with_names,
)
from vtray.base.compiler.unseen import pass_on
from vtray.base.errors import RenderError

Function = TypeVar("Function", bound=Callable[..., Any])
Value = TypeVar("Value")

_OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False}

_POLL_SECONDS = 0.05

_COMPILING = threading.RLock()
_on_disk: set[str] = set()
"""How the files of those kernels begin that were on disk when `was_compiled` looked."""

_loading = [0.0]
_trusted: list[bool] = []
_waiting: list[Callable[[bool], object]] = []
_held = contextlib.ExitStack()


def device(function: Function) -> Function:
    """Compile a small scalar function that kernels call."""
    return function if _is_off() else cast("Function", Device(function))


def seldom(function: Function) -> Function:
    """Compile a device function that is large and seldom called, as a function of its own.

    Inlined wherever it may be called, it would take most of the time of compiling.
    """
    return function if _is_off() else cast("Function", Seldom(function))


def written_in_llvm(writer: str) -> Callable[[Function], Function]:
    """Take the code of a device function from what writes it in LLVM's language.

    This is for the few instructions that a compiler does not find by itself. The function itself
    says what they do, and does it where nothing is compiled.

    Parameters
    ----------
    writer
        ``"module:name"`` of a function as `numba.extending.intrinsic` takes it. It is imported
        only to compile.
    """

    def decorate(function: Function) -> Function:
        return function if _is_off() else cast("Function", Written(function, writer))

    return decorate


def part(function: Function) -> Function:
    """Compile a function that kernels call once for hundreds of rays, apart from them.

    Its machine code is kept on disk on its own, so kernels that differ in other things share it.
    The annotation says what it returns: a number, a truth value, or nothing.
    """
    return function if _is_off() else cast("Function", Part(function))


def long_part(function: Function) -> Function:
    """Compile a part that takes longer than others, and so is begun before these."""
    if not _is_off():
        compile_sooner(function)
    return part(function)


def passing_on(*classes: type) -> Callable[[Function], Function]:
    """Compile a kernel or part once, whatever is in tuples that it hands to parts as they are.

    Parameters
    ----------
    classes
        Those of the tuples, which lie `apart`. Into these, the function and what it calls must not
        look; parts may.
    """

    def decorate(function: Function) -> Function:
        pass_on(function, classes)
        return function

    return decorate


def kernel(function: Function) -> Function:
    """Compile a loop over arrays, and keep the machine code on disk."""
    return function if _is_off() else cast("Function", Kernel(function))


def loading_seconds() -> float:
    """Return how long this process has compiled kernels, or loaded them from disk."""
    return _loading[0]


def before_compiling(tell: Callable[[bool], object] | None) -> None:
    """Set what is called, once, before a kernel is compiled, which takes seconds; None for nothing.

    Parameters
    ----------
    tell
        Called, from any thread, with whether what is compiled is kept for later processes.
    """
    _waiting[:] = [tell] if tell else []


def was_compiled(function: Callable[..., object]) -> bool:
    """Tell whether a kernel is on disk, for whatever types; True where kernels are not kept."""
    folder = cache_folder() if isinstance(function, Kernel) and not function.is_loaded else None
    if folder is None:
        return True
    start = f"{full_name(uncompiled(function))}-"
    if start not in _on_disk:
        with contextlib.suppress(FileNotFoundError):  # somebody has deleted it
            if any(name.startswith(start) for name in os.listdir(folder)):
                _on_disk.add(start)
    return start in _on_disk


def compile_ahead(function: Callable[..., object], *arguments: object) -> None:
    """Compile a kernel before its turn, so that other processes can begin with its parts.

    Nothing is run. Meanwhile this process may compile other kernels; the first call makes the parts
    that are still missing.
    """
    if isinstance(function, Kernel):
        function.compile_ahead(arguments)


def uncompiled(function: Function) -> Function:
    """Return a device function as plain Python, for a single call that is not worth compiling."""
    plain: Function = getattr(function, "__wrapped__", function)
    return plain


def pinned(argument: Value) -> Value:
    """Return a stand-in for an argument that many calls of kernels share.

    Taking apart a scene of forty arrays takes 40 microseconds; this does it once for all calls.
    """
    if _is_off():
        return argument
    try:
        return cast("Value", Pinned(argument))
    except UnsupportedError:
        return argument


def input_array(values: ArrayLike, dtype: type[np.generic]) -> NDArray[Any]:
    """Return an array that kernels read in the one form in which they take it.

    Each type, order or flag of an array is another type to the compiler, which compiles everything
    anew for it. So what comes from outside is brought into one form: row by row, aligned, and
    read-only. It is copied only where it must be.
    """
    array = np.require(values, dtype, ["C", "A"]).view()
    array.flags.writeable = False
    return array


class Device:
    """A function that is compiled when a kernel, or Python, calls it for the first time."""

    _options: ClassVar[dict[str, Any]] = {**_OPTIONS, "forceinline": True}

    def __init__(self, function: Callable[..., object]) -> None:
        update_wrapper(self, function)
        self._function = function

    def __call__(self, *arguments: object) -> object:  # noqa: D102
        return self._dispatcher(*arguments)

    @cached_property
    def _dispatcher(self) -> Callable[..., object]:
        """The function as Numba's decorator returns it."""
        import numba

        from vtray.base.compiler.numba_pipeline import PythonPipeline

        compiled: Callable[..., object] = numba.njit(
            self._function, pipeline_class=PythonPipeline, **self._options
        )
        return compiled

    @cached_property
    def _called(self) -> Any:  # noqa: ANN401
        """The function for compiled code alone that Numba calls."""
        return self._unwrapped()

    @cached_property
    def _called_by_kernels(self) -> Any:  # noqa: ANN401
        """The same for machine code that is called without Numba, where parts are apart."""
        from vtray.base.compiler.kept_functions import KeptFunctions

        called = self._unwrapped()
        is_inlined = self._options.get("forceinline", False)
        called._cache = KeptFunctions(self._function, is_inlined)  # noqa: SLF001 - as Numba does
        return called

    def _unwrapped(self) -> Any:  # noqa: ANN401
        """Return the function as something that compiles it for compiled code.

        Without the wrappers through which Python would call it, kernels compile in half the time.
        """
        import numba

        options = {**self._options, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        return numba.njit(self._function, pipeline_class=self._pipeline, **options)

    @property
    def _pipeline(self) -> type[Any]:
        """Numba's way to compiled code."""
        from vtray.base.compiler.numba_pipeline import DevicePipeline

        return DevicePipeline

    @property
    def _numba_type_(self) -> object:
        """What Numba asks for where compiled code calls this."""
        import numba

        dispatcher: Any = self._called_by_kernels if is_for_kernels() else self._called
        return numba.types.Dispatcher(dispatcher)


class Seldom(Device):
    """A function that is compiled as one of its own within the machine code of a kernel."""

    # Said in so many words: Numba hands options on to what is called.
    _options: ClassVar[dict[str, Any]] = {**_OPTIONS, "forceinline": False}

    @property
    def _pipeline(self) -> type[Any]:
        """Numba's way to compiled code."""
        from vtray.base.compiler.numba_pipeline import SeldomPipeline

        return SeldomPipeline


class Written:
    """A function that compiled code calls, and whose own code is written in LLVM's language."""

    def __init__(self, function: Callable[..., object], writer: str) -> None:
        self.__wrapped__ = function
        self._writer = writer

    @cached_property
    def _numba_type_(self) -> object:
        """What Numba asks for where compiled code calls this."""
        import numba
        from numba.core.typing.templates import make_intrinsic_template

        module, name = self._writer.split(":")
        write = getattr(import_module(module), name)
        make: Any = make_intrinsic_template
        return numba.types.Function(make(self, write, name))


class Part(Device):
    """A function whose machine code is kept on disk on its own, and called by that of kernels."""

    @property
    def _numba_type_(self) -> object:
        """What Numba asks for where compiled code calls this."""
        return self._name if is_for_kernels() else super()._numba_type_

    @cached_property
    def _name(self) -> object:
        """What this is to the machine code of kernels."""
        from vtray.base.compiler.numba_pipeline import type_of_calls

        return type_of_calls(self._function, partial(new_name, self._function, _OPTIONS))


class Kernel(Device):
    """A function whose machine code is kept on disk."""

    _options: ClassVar[dict[str, Any]] = _OPTIONS

    def __init__(self, function: Callable[..., object]) -> None:
        super().__init__(function)
        # For each tuple of types; None where it is Numba that calls the code.
        self._native: dict[Types, NativeCall | None] = {}
        self._ahead: dict[Types, ObjectCode] = {}

    def __call__(self, *arguments: object) -> object:  # noqa: D102
        try:
            types, words = unpack(arguments)
        except UnsupportedError:
            return self._dispatcher(*unpinned(arguments))
        if types not in self._native:
            with _COMPILING:
                if types not in self._native:
                    start = time.perf_counter()
                    self._native[types] = self._load(types, unpinned(arguments))
                    _loading[0] += time.perf_counter() - start
        native = self._native[types]
        if native is None:
            return self._dispatcher(*unpinned(arguments))
        return native(words)

    @property
    def is_loaded(self) -> bool:
        """Whether this process has it, for whatever types."""
        return bool(self._native)

    def compile_ahead(self, arguments: tuple[object, ...]) -> None:
        """Compile what Python calls, if it is new and can be kept, without its parts."""
        with contextlib.suppress(UnsupportedError), _COMPILING:
            types, _ = unpack(arguments)
            file = self._file(types)
            is_known = types in self._native or types in self._ahead
            if not is_known and file and not file.exists():
                start = time.perf_counter()
                # Whatever goes wrong, the call says it.
                with contextlib.suppress(Exception):
                    self._ahead[types] = self._compiled(arguments, is_kept=True)
                _loading[0] += time.perf_counter() - start

    def _load(self, types: Types, arguments: tuple[object, ...]) -> NativeCall | None:
        """Return what calls the machine code, None if Numba does."""
        failure = None
        try:
            if self._is_trusted():
                return self._native_call(types, arguments)
        # Who makes errors of warnings wants to see them; short of memory, Numba would take more.
        except (Warning, RenderError, MemoryError):
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, Numba can do it or explains it
            failure = error
        if _in_thread(self._compile_for_python, arguments) and failure:
            warn_of_slow_starts(failure)
        return None

    def _is_trusted(self) -> bool:
        """Tell whether calls without Numba are right, as the canary shows before the first."""
        if not _trusted:
            _trusted.append(_Canary(sing).is_right())
        return _trusted[0]

    def _native_call(self, types: Types, arguments: tuple[object, ...]) -> NativeCall:
        """Return what calls the machine code without Numba, from disk or newly compiled."""
        file = self._file(types)
        compiled = read_object_code(file) if file else None
        parts = load_parts(compiled) if compiled else None
        if compiled is None or parts is None:
            ahead = self._ahead.pop(types, None)
            compiled = ahead or self._compiled(arguments, is_kept=file is not None)
            parts = _in_thread(make_parts, compiled)
            if parts is None:
                compiled = self._compiled(arguments, is_kept=file is not None, is_anew=True)
                parts = _in_thread(make_parts, compiled)
            if file:
                write_object_code(file, with_names(compiled))
        return caller(link(compiled, parts or NOTHING), compiled.layout)

    def _compiled(
        self, arguments: tuple[object, ...], *, is_kept: bool, is_anew: bool = False
    ) -> ObjectCode:
        """Compile what Python calls; if it is kept, other processes begin with its parts."""
        if _waiting:
            _waiting.pop()(is_kept)
        if is_kept:
            get_help()
        compiled = _in_thread(compile_object, self._function, arguments, _OPTIONS, is_anew)
        if is_kept:
            _in_thread(learn, compiled)
        return compiled

    def _compile_for_python(self, arguments: tuple[object, ...]) -> bool:
        """Compile the function as Numba calls it; tell whether it is compiled at all."""
        import numba

        # Where Numba's file of settings turns it off, this is the function itself.
        compiler = getattr(self._dispatcher, "compile", None)
        if compiler:
            compiler(tuple(map(numba.typeof, arguments)))
        return compiler is not None

    def _file(self, types: Types) -> Path | None:
        """Return the file of the machine code, None if the function is none of vtray's own."""
        return object_file(object_name(full_name(self._function), "".join(types)))


class _Canary(Kernel):
    """A kernel that must do what plain Python does before any other is called without Numba."""

    def is_right(self) -> bool:
        """Tell whether it does; it is called without Numba, once."""
        arguments = new_arguments()
        types, _ = unpack(arguments)
        return self._load(types, arguments) is not None

    def _is_trusted(self) -> bool:
        return True

    def _native_call(self, types: Types, arguments: tuple[object, ...]) -> NativeCall:
        native = super()._native_call(types, arguments)
        compare_with_python(native, arguments)
        return native


def _in_thread(function: Callable[..., Value], *arguments: object) -> Value:
    """Return what a function returns, called in a thread that Ctrl-C does not wait for.

    LLVM calls back into Python when it is done with its long work. In the main thread, Python would
    raise KeyboardInterrupt there, after seconds, and it would be lost.
    """
    from concurrent.futures import Future, wait

    outcome: Future[Value] = Future()

    def work() -> None:
        try:
            outcome.set_result(function(*arguments))
        except BaseException as error:  # noqa: BLE001 - raised again by who waits
            outcome.set_exception(error)

    try:
        threading.Thread(target=work, daemon=True).start()
    except RuntimeError:  # no more threads are allowed
        work()
    # Once Polars is imported, Ctrl-C does not end a wait any more: look from time to time.
    while not wait((outcome,), _POLL_SECONDS).done:
        pass
    return outcome.result()


def _wait_for_compiler() -> None:
    """Let this process be forked only when no thread compiles: its child could never go on."""
    numba = sys.modules.get("numba.core.compiler_lock")
    llvm = getattr(sys.modules.get("llvmlite.binding.ffi"), "lib", None)
    # From the outermost on; Numba lets go of its own before machine code is written.
    for lock in (
        _COMPILING,
        getattr(numba, "global_compiler_lock", None),
        getattr(llvm, "_lock", None),
    ):
        if lock:
            _held.enter_context(lock)


def _let_compile() -> None:
    """Let threads compile again, in this process or its child."""
    _held.pop_all().close()


if hasattr(os, "register_at_fork"):  # not in Windows
    os.register_at_fork(
        before=_wait_for_compiler, after_in_parent=_let_compile, after_in_child=_let_compile
    )


def _is_off() -> bool:
    """Tell whether everything shall run as plain Python, as Numba's setting says."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in {"", "0"}
