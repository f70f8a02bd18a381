"""What checks no index in machine code although callbacks do: functions and classes that numba has made otherwise.

A callback's callees are compiled anew with their indices checked (`callbacks`). What else numba would call in it, it
calls as its user has compiled it: a function out of a tuple or from a default, `vectorize`, `cfunc`, a compiled
class. A callback that does so is not compiled; in Python (`lagrangian.plain`) indices are checked, or it is refused.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import errors, ir
from numba.core.compiler_machinery import AnalysisPass, register_pass

from lagrangian.plain import name_of

# By the names of classes, for these lie elsewhere in other versions of numba
MADE = {"DUFunc": "numba.vectorize", "GUFunc": "numba.guvectorize", "StencilFunc": "numba.stencil"}
KINDS = {
    "ClassType": "numba.experimental.jitclass", "FunctionType": "numba.cfunc", "UndefinedFunctionType": "numba.cfunc",
    "FunctionPrototype": "numba.cfunc",
}  # fmt: skip


@register_pass(mutates_CFG=False, analysis_only=True)
class RefuseUnchecked(AnalysisPass):
    """After inference of types: all that is called checks its indices."""

    _name = "refuse_unchecked"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """NumbaTypeError names what does not, and its line."""
        for block in state.func_ir.blocks.values():
            for assign in block.find_insts(ir.Assign):
                what = unchecked(state.typemap[assign.target.name])
                if what:
                    raise errors.NumbaTypeError(f"numba does not check the indices of {what}", loc=assign.loc)
            for call in block.find_exprs(op="call"):
                key: Any = getattr(state.typemap[call.func.name], "typing_key", None)
                integers = all(isinstance(kind, types.Integer) for kind in state.calltypes[call].args)
                if key in (divmod, pow) and integers:
                    raise errors.NumbaTypeError(
                        f"{key.__name__} of integers is not that of Python", loc=call.loc
                    )
        return False


def unchecked(kind: Any) -> str:
    """What of this type checks no index, with its maker; "" where nothing."""
    if isinstance(kind, types.BaseTuple):
        return next(filter(None, map(unchecked, kind)), "")
    kind = getattr(kind, "class_type", kind)  # of a compiled class's objects
    if isinstance(kind, types.Omitted):  # a default, as it is in Python
        return unchecked(getattr(kind.value, "_numba_type_", None))
    if isinstance(kind, types.Dispatcher):
        compiler = kind.dispatcher._compiler.pipeline_class
        own = getattr(compiler, "checks_indices", False)
        return "" if own else f"{kind.dispatcher.py_func.__name__!r}, which is not called by its own name"
    if isinstance(kind, types.Function) and type(kind.typing_key).__name__ in MADE:
        return f"{name_of(kind.typing_key)!r}, made by {MADE[type(kind.typing_key).__name__]}"
    maker = KINDS.get(type(kind).__name__, "")
    return f"{getattr(kind, 'class_name', None) or 'a function'!r}, made by {maker}" if maker else ""
