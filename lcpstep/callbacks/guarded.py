"""Numba's side of `callbacks`: a C function around a user's function, which lets no exception through in silence.

Its signature is that of `lcpstep.kernels.function`: plain pointers, and how many numbers they point to.

Numba's own wrapper prints the exception, and `out` keeps what stood in it. This one fills `out` with
not-a-numbers and notes name, t, q and v by a call into Python. The user's function is merged into the wrapper: that
saves more than its indices cost to check. This module is imported when the first callback is compiled or loaded.

Source: `CPUContext.create_cfunc_wrapper` and `CFunc` of numba, which this follows.
"""

from __future__ import annotations

import ctypes
import functools
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering, NopythonTypeInference
from numba.np.arrayobj import make_array, populate_array

from lcpstep.callbacks.faults import Fault, note
from lcpstep.callbacks.integers import Checked
from lcpstep.callbacks.unchecked import RefuseUnchecked
from lcpstep.callbacks.writing import RefuseWriting

ALL_ONES = 0xFF  # the bytes of a not-a-number
NOTE = "lcpstep_note"  # the symbol under which machine code finds `_note`
ITEM = 8  # bytes of a number
NUMBERS, SIZE = ctypes.POINTER(ctypes.c_double), ctypes.c_ssize_t


@ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_double, NUMBERS, SIZE, NUMBERS, SIZE)
def _note(name: bytes, t: float, q: Any, n_q: int, v: Any, n_v: int) -> None:
    note(Fault(name.decode(), t, np.array(q[:n_q]), np.array(v[:n_v])))


llvm.add_symbol(NOTE, ctypes.cast(_note, ctypes.c_void_p).value)


def signature(n: int, ndim: int) -> tuple[Any, ...]:
    """Types of t, of n arrays that are read, and of `out`."""
    read = types.Array(types.float64, 1, "C", readonly=True)
    return types.float64, *(read,) * n, types.Array(types.float64, ndim, "C")


class Wrapped(Checked):
    """Lowering of a function together with the C function around it."""

    def create_cfunc_wrapper(self) -> None:
        """Call the function; on an exception blank `out` and note what happened."""
        context, described, convention = self.context, self.fndesc, self.context.call_conv
        module = context.create_module("callback")
        inner = convention.get_function_type(described.restype, described.argtypes)
        kinds = described.argtypes[1:]
        pointer, word = ir.DoubleType().as_pointer(), context.get_value_type(types.intp)
        outer = ir.FunctionType(ir.VoidType(), [ir.DoubleType(), *[pointer] * 4, word.as_pointer()])
        wrapper = ir.Function(module, outer, described.llvm_cfunc_wrapper_name)
        callee = ir.Function(module, inner, described.llvm_func_name)
        builder = ir.IRBuilder(wrapper.append_basic_block("entry"))
        t, q, v, p, out, sizes = wrapper.args
        size = [builder.load(cgutils.gep_inbounds(builder, sizes, i)) for i in range(5)]
        read = [(q, size[0]), (v, size[1]), (p, size[2])] if len(kinds) == 4 else [(q, size[0]), (p, size[2])]
        shape = size[3 : 3 + kinds[-1].ndim]
        arrays = [array(context, builder, kind, x, [n]) for kind, (x, n) in zip(kinds, read, strict=False)]
        arrays.append(array(context, builder, kinds[-1], out, shape))
        status, _ = convention.call_function(
            builder, callee, described.restype, described.argtypes, [t, *arrays], attrs=("alwaysinline",)
        )
        with builder.if_then(status.is_error, likely=False):
            number = functools.reduce(builder.mul, shape)
            cgutils.memset(builder, out, builder.mul(number, word(ITEM)), ALL_ONES)
            name = context.insert_const_string(module, self.func_ir.func_id.func.__name__)
            given = name, t, q, size[0], v, size[1]
            noted = ir.FunctionType(ir.VoidType(), [x.type for x in given])
            builder.call(cgutils.get_or_insert_function(module, noted, NOTE), given)
        builder.ret_void()
        self.library.add_ir_module(module)


def array(context: Any, builder: Any, kind: Any, data: Any, shape: list[Any]) -> Any:
    """An array of numba's around numbers that somebody else keeps."""
    word = context.get_value_type(types.intp)
    strides = [word(ITEM)] if len(shape) == 1 else [builder.mul(shape[1], word(ITEM)), word(ITEM)]
    made = make_array(kind)(context, builder)
    populate_array(made, data=data, shape=shape, strides=strides, itemsize=word(ITEM), meminfo=None)
    return made._getvalue()


@register_pass(mutates_CFG=True, analysis_only=False)
class LowerChecked(NativeLowering):
    """From numba's intermediate representation to LLVM's, with integers checked."""

    _name = "lower_checked"

    @property
    def lowering_class(self) -> type[Checked]:
        """In the place of numba's own."""
        return Checked


@register_pass(mutates_CFG=True, analysis_only=False)
class LowerWrapped(NativeLowering):
    """The same with the wrapper above."""

    _name = "lower_wrapped"

    @property
    def lowering_class(self) -> type[Checked]:
        """In the place of numba's own."""
        return Wrapped


class CalleeCompiler(CompilerBase):
    """Compiler of functions that callbacks call."""

    checks_indices = True  # numba's own do not
    lowering: type[NativeLowering] = LowerChecked

    def define_pipelines(self) -> list[Any]:
        """Numba's pipeline but for the step of lowering, and a look at what is written into and what is called."""
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.add_pass_after(RefuseWriting, NopythonTypeInference)
        pipeline.add_pass_after(RefuseUnchecked, NopythonTypeInference)
        pipeline.add_pass_after(self.lowering, NativeLowering)
        pipeline.passes = [(step, text) for step, text in pipeline.passes if step is not NativeLowering]
        pipeline.finalize()
        return [pipeline]


class Compiler(CalleeCompiler):
    """Compiler of a callback."""

    lowering = LowerWrapped


class Guarded(CFunc):
    """A callback as a C function."""

    def __init__(self, f: Any, arguments: tuple[Any, ...], options: dict[str, Any]) -> None:
        super().__init__(f, (arguments, types.void), {}, options, pipeline_class=Compiler)

    def compile(self: Any) -> None:
        """Machine code from the cache or afresh; what `print` needs of the interpreter is tied to it."""
        context = self._targetdescr.target_context
        with global_compiler_lock:
            result = self._cache.load_overload(self._sig, context)
            if result is None:
                result = self._compile_uncached()
                self._cache.save_overload(self._sig, result)
            self.result = result  # keeps that alive
            self._wrapper_address = result.library.get_pointer_to_function(
                result.fndesc.llvm_cfunc_wrapper_name
            )
            result.library.codegen.set_env(context.get_env_name(result.fndesc), result.environment)
