"""Numba's compiler, without the work that is of no use to kernels.

Numba makes machine code of each function by itself, so that Python could call it. Here that is of
use for a kernel alone, into which LLVM has put all device functions by then.
"""

# mypy: allow-untyped-calls

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler


class Pipeline(Compiler):
    """Numba's usual way from a function in Python to one in LLVM's language."""

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
        made = Library(targetctx.codegen(), "function")
        super().__init__(typingctx, targetctx, made, args, return_type, flags, locals)


class _NoEnvironments:
    """Passes over what Numba keeps for those functions that Python calls."""

    def set_env(self, name: str, environment: object) -> None:
        """Do nothing."""


class Library(JITCodeLibrary):
    """A function and all that it calls, in LLVM's language."""

    codegen = _NoEnvironments()

    def object_code(self) -> bytes:
        """Return an object file of this machine."""
        self._ensure_finalized()
        code: bytes = self._codegen._tm.emit_object(self._final_module)  # noqa: SLF001
        return code

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        """Return 0: the function is nowhere in memory."""
        self._ensure_finalized()
        return 0

    def _finalize_final_module(self) -> None:
        """Leave the module, which has been optimized, as it is."""
        self._finalized = True
