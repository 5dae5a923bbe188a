"""Numba's steps from a function in Python to one in LLVM's language, without the needless ones.

Most of the time of compiling goes into these, five hundred times for a first picture. Numba's own
pipeline also looks for what kernels do without (closures, contexts, literals, expressions of
arrays), writes down what each step does to whom, and finds out after each where variables end,
which matters to who counts references.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from typing import Any

from numba.core import typed_passes
from numba.core.analysis import dead_branch_prune, rewrite_semantic_constants
from numba.core.interpreter import Interpreter
from numba.core.ir_utils import build_definitions, raise_on_unsupported_feature
from numba.core.postproc import PostProcessor
from numba.core.rewrites.static_getitem import RewriteConstGetitems, RewriteConstSetitems
from numba.core.rewrites.static_raise import RewriteConstRaises
from numba.core.ssa import reconstruct_ssa


def take_all_steps(state: Any) -> Any:
    """Return what Numba's compiler returns of a function, given where it begins."""
    _read(state)
    _drop_dead_branches(state)
    _tell_constants(state)
    _assign_once(state)
    typed_passes.NopythonTypeInference().run_pass(state)
    _join_assignments(state)
    typed_passes.NativeLowering().run_pass(state)
    typed_passes.NoPythonBackend().run_pass(state)
    return state.cr


def _read(state: Any) -> None:
    """Read what Python's interpreter would do."""
    state.func_ir = Interpreter(state.func_id).interpret(state.bc)
    state.nargs = state.func_ir.arg_count
    PostProcessor(state.func_ir).run()


def _drop_dead_branches(state: Any) -> None:
    """Drop what is never done for arguments of these types, as some of them are None."""
    rewrite_semantic_constants(state.func_ir, state.args)
    dead_branch_prune(state.func_ir, state.args)


def _tell_constants(state: Any) -> None:
    """Tell indices that are constants, which tuples want, from others, and exceptions, too."""
    blocks = state.func_ir.blocks
    for kind in (RewriteConstRaises, RewriteConstGetitems, RewriteConstSetitems):
        rewrite: Any = kind(state)
        for key, block in blocks.items():
            if rewrite.match(state.func_ir, block, state.typemap, state.calltypes):
                blocks[key] = rewrite.apply()


def _assign_once(state: Any) -> None:
    """Give each assignment a variable of its own, of a type of its own."""
    state.func_ir = reconstruct_ssa(state.func_ir)
    state.func_ir._definitions = build_definitions(state.func_ir.blocks)  # noqa: SLF001
    dead_branch_prune(state.func_ir, state.args)


def _join_assignments(state: Any) -> None:
    """Let branches assign to one variable again where they meet."""
    strip: Any = typed_passes.PreLowerStripPhis()
    state.func_ir = strip._strip_phi_nodes(state.func_ir)  # noqa: SLF001
    raise_on_unsupported_feature(state.func_ir, state.typemap)
