"""Numba's side of `compiled`: a kernel and its callees become machine code once, together.

Left to itself, numba turns every callee into machine code of its own, and optimises it again in each caller
that it is linked into: a kernel of a hundred functions is translated several times over. Here callees are
only linked, and the kernel that Python calls is optimised, with all of them in it. This module is imported
when the first kernel is compiled.

Source: `numba.core.codegen` and `numba.core.typed_passes`, which the classes below change in one point each.
"""

from __future__ import annotations

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering


class Part(JITCodeLibrary):
    """A callee and what it calls in its turn, to be linked; never run by itself."""

    def finalize(self) -> None:
        """Link, and leave optimising to the kernel."""
        for library in dict.fromkeys(self._linking_libraries):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class LowerPart(NativeLowering):
    """From numba's intermediate representation to LLVM's, and no further."""

    _name = "lower_part"

    def run_pass(self, state: Any) -> bool:
        """Leave the code behind where callers find it."""
        state.library = Part(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        state.flags.no_compile = True
        super().run_pass(state)
        state.library.finalize()
        result = state["cr"]
        own: list[Any] = []
        key = own.append  # numba looks a callee up by a built-in function, of which every list has its own
        state.targetctx.insert_user_function(key, result.fndesc, [state.library])
        state["cr"] = result._replace(cfunc=key)
        return True


class Callee(CompilerBase):
    """Compiler of a function that only kernels call."""

    def define_pipelines(self) -> list[Any]:
        """Numba's pipeline but for its last step."""
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.add_pass_after(LowerPart, NativeLowering)
        pipeline.passes = [(step, text) for step, text in pipeline.passes if step is not NativeLowering]
        pipeline.finalize()
        return [pipeline]
