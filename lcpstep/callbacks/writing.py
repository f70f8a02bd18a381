"""Numba's holes in read-only arrays, closed: functions of numpy through which machine code would write into q, v, p.

Numba refuses `q[0] = 1.0`, for it knows that q is read-only, but a few of its own functions forget it: they return q
itself as an array that may be written into, or write into what they are given.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np
from numba import types
from numba.core import errors
from numba.core.compiler_machinery import AnalysisPass, register_pass

# Which of the arguments is written into, or comes back as an array that may be: all where there is none
HOLES: dict[Any, int | None] = {
    np.ascontiguousarray: 0, np.asfortranarray: 0, np.fill_diagonal: 0, np.dot: 2, np.nditer: None,
}  # fmt: skip


@register_pass(mutates_CFG=False, analysis_only=True)
class RefuseWriting(AnalysisPass):
    """After inference of types: no array that may only be read goes through one of these holes."""

    _name = "refuse_writing"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """NumbaTypeError names the function and its line."""
        for block in state.func_ir.blocks.values():
            for call in block.find_exprs(op="call"):
                name = written(state.typemap[call.func.name], state.calltypes[call])
                if name:
                    raise errors.NumbaTypeError(
                        f"through np.{name} it could write into an array that it may only read (q, v, p and global "
                        "arrays); a copy may be written into",
                        loc=call.loc,
                    )
        return False


def written(function: Any, signature: Any) -> str:
    """The name of the hole that a call is; "" where it is none."""
    key = getattr(function, "typing_key", None)
    if not isinstance(key, Hashable) or key not in HOLES:
        return ""
    place = HOLES[key]
    given = signature.args if place is None else signature.args[place : place + 1]
    return str(getattr(key, "__name__", key)) if any(map(_read_only, given)) else ""


def _read_only(kind: Any) -> bool:
    """Whether it is an array, or some in a tuple, that may only be read."""
    if isinstance(kind, types.BaseTuple):
        return any(map(_read_only, kind))
    return isinstance(kind, types.Array) and not kind.mutable
