"""What tells compiled functions and types apart in all processes.

Numba's own names have numbers and addresses in them, which are others in each process.
"""

# ruff: noqa: ANN401

import io
import pickle
import sys
from importlib import import_module
from typing import Any

import numba
from blake3 import blake3

from vtray.base.compiler.function_names import UnnamedError, check_own, full_name

types: Any = numba.types

_NAME_BYTES = 12


def symbol_of(name: str, arguments: tuple[Any, ...]) -> str:
    """Return the name of a function that is compiled for some types.

    Parameters
    ----------
    name
        That of the function with its module.
    arguments
        Numba's types of the arguments.

    Raises
    ------
    UnnamedError
        There is none: the function is not vtray's own, or is given one that is not.
    """
    check_own(name)
    digest = blake3(_text_of(arguments).encode()).hexdigest(_NAME_BYTES)
    named = f"{name}.{digest}"
    return f"_ZN{len(named)}{named}E"  # Numba expects names of C++


def pickled(kind: Any) -> bytes:
    """Return a type of Numba's, or a tuple of types, in bytes.

    Raises
    ------
    UnnamedError
        It is or holds a function that is not vtray's own.
    """
    content = io.BytesIO()
    _Pickler(content).dump(kind)
    return content.getvalue()


def unpickled(content: bytes) -> Any:
    """Return what `pickled` was given; the bytes must be this user's own, as machine code is."""
    return _Unpickler(io.BytesIO(content)).load()


class _Pickler(pickle.Pickler):
    """Writes functions as their names."""

    def persistent_id(self, obj: Any) -> tuple[str, str] | None:
        """Return the names of a function's module and of the function, None for all else."""
        if not isinstance(obj, types.Callable) or isinstance(obj, types.NamedTupleClass):
            return None
        if not isinstance(obj, types.Dispatcher):
            raise UnnamedError
        function: Any = obj.dispatcher.py_func
        check_own(full_name(function))
        named = getattr(sys.modules[function.__module__], function.__name__, None)
        if getattr(named, "_numba_type_", None) != obj:
            raise UnnamedError
        return function.__module__, function.__name__


class _Unpickler(pickle.Unpickler):
    """Finds functions by their names."""

    def persistent_load(self, pid: tuple[str, str]) -> Any:
        """Return the type of a function."""
        module, name = pid
        return getattr(import_module(module), name)._numba_type_


def _text_of(kind: Any) -> str:
    """Return what tells a type from others."""
    if isinstance(kind, tuple):
        return ", ".join(map(_text_of, kind))
    if isinstance(kind, types.Dispatcher):
        name = full_name(kind.dispatcher.py_func)
        check_own(name)
        return f"{name} {kind.dispatcher.targetoptions.get('forceinline')}"
    if isinstance(kind, types.BaseTuple):
        made_by = getattr(kind, "instance_class", tuple)
        return f"{full_name(made_by)}({_text_of(tuple(kind.types))})"
    if isinstance(kind, types.NamedTupleClass):
        return f"class {full_name(kind.instance_class)}"
    if isinstance(kind, types.Optional):
        return f"{_text_of(kind.type)} or none"
    if isinstance(kind, types.Callable):
        raise UnnamedError
    return str(kind)
