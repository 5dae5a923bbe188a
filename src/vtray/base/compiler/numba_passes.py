"""Numba's steps from a function in Python to one in LLVM's language, without the needless ones.

Most of the time of compiling goes into these, five hundred times for a first picture. Numba's own
pipeline also looks for what kernels do without (closures, contexts, literals, expressions of
arrays), writes down what each step does to whom, and finds out after each where variables end,
which matters to who counts references.
"""

# ruff: noqa: ANN401
# mypy: allow-untyped-calls

from contextlib import AbstractContextManager, nullcontext
from typing import Any

import numba
from numba.core import interpreter, ir, lowering, typed_passes
from numba.core.analysis import dead_branch_prune, rewrite_semantic_constants
from numba.core.ir_utils import build_definitions, raise_on_unsupported_feature
from numba.core.rewrites.static_getitem import RewriteConstGetitems, RewriteConstSetitems
from numba.core.rewrites.static_raise import RewriteConstRaises
from numba.core.ssa import reconstruct_ssa
from numba.core.transforms import canonicalize_cfg
from numba.core.typeinfer import Propagate, TypeInferer


def take_all_steps(state: Any) -> Any:
    """Return what Numba's compiler returns of a function, given where it begins."""
    _read(state)
    _drop_dead_branches(state)
    _tell_constants(state)
    _assign_once(state)
    _find_types(state)
    _join_assignments(state)
    _Lowering().run_pass(state)
    typed_passes.NoPythonBackend().run_pass(state)
    return state.cr


def _read(state: Any) -> None:
    """Read what Python's interpreter would do."""
    state.func_ir = _Reader(state.func_id).interpret(state.bc)
    state.nargs = state.func_ir.arg_count
    state.func_ir.blocks = canonicalize_cfg(state.func_ir.blocks)


class _Reader(interpreter.Interpreter):
    """What reads what Python's interpreter would do, with neither ``with`` nor dictionaries."""

    def post_process(self, peepholes: Any, func_ir: Any) -> Any:
        """Return what was read, as Numba's next steps want it."""
        return super().post_process([each for each in peepholes if each not in _NEEDLESS], func_ir)


_NEEDLESS: Any = (
    interpreter.peep_hole_delete_with_exit,
    interpreter.peep_hole_fuse_dict_add_updates,
)


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


def _find_types(state: Any) -> None:
    """Find the type of each variable, and with it what each call calls."""
    found = _TypesOfVariables(state.typingctx, state.func_ir, _Warnings())
    calls: Any = state.typingctx.callstack
    with calls.register(state.targetctx.target, found, state.func_id, state.args):
        for k, (name, kind) in enumerate(zip(state.func_ir.arg_names, state.args, strict=True)):
            found.seed_argument(name, k, kind)
        found.build_constraint()
        found.propagate()
        state.typemap, state.return_type, state.calltypes = found.unify()


class _Warnings:
    """Leaves warnings to Python: vtray's own functions give Numba no reason for any."""

    def catch_warnings(self, **_: object) -> AbstractContextManager[None]:
        """Do nothing."""
        return _NOTHING


_NOTHING = nullcontext()


class _TypesOfVariables(TypeInferer):
    """What Numba finds of the types of variables, but that what is counted is no constant.

    Before a loop, what it counts is a constant, which is a type of its own. Numba would compile all
    that the loop calls for this constant, find that it changes, and compile it again.
    """

    def typeof_expr(self, inst: Any, target: Any, expr: Any) -> None:
        """Note what the type of a variable depends on, given what is assigned to it."""
        if expr.op != "phi":
            super().typeof_expr(inst, target, expr)
            return
        for each in expr.incoming_values:
            if each is not ir.UNDEFINED:
                self.constraints.append(_OneOf(target.name, each.name, inst.loc))


class _OneOf(Propagate):
    """A variable is what another one is, unless another way led to where it is."""

    def __call__(self, found: Any) -> None:
        kind = found.typevars[self.src].type
        if kind is not None:
            found.typevars[self.dst].add_type(numba.types.unliteral(kind), loc=self.loc)
        found.refine_map[self.dst] = self


def _join_assignments(state: Any) -> None:
    """Let branches assign to one variable again where they meet."""
    strip: Any = typed_passes.PreLowerStripPhis()
    state.func_ir = strip._strip_phi_nodes(state.func_ir)  # noqa: SLF001
    raise_on_unsupported_feature(state.func_ir, state.typemap)


class _Lowering(typed_passes.NativeLowering):
    """Numba's step from instructions with types to LLVM's language."""

    @property
    def lowering_class(self) -> Any:
        """What takes it."""
        return _Lower


class _Lower(lowering.Lower):
    """What writes instructions in LLVM's language, and notes for no error where it was."""

    def lower_block(self, block: Any) -> None:
        """Write what a block does."""
        self.pre_block(block)
        for each in block.body:
            self.loc = each.loc
            self.lower_inst(each)
        self.post_block(block)
