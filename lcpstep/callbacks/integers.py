"""Numbers of callbacks in machine code: what Python would not let pass is an exception here, or no number.

Numba's integers have 64 bits and wrap around, `1 // 0` is 0 and `2**-1` is 0; these raise. A variable that is read
before it is assigned is zero to numba; here it is not-a-number where it is a real one. Real numbers otherwise follow
IEEE 754, as numpy's do: `1.0 / 0.0` is infinite, `math.sqrt(-1.0)` not-a-number.
"""

from __future__ import annotations

import math
import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.lowering import Lower

BITS = 64
DIVISIONS = {operator.floordiv, operator.mod, operator.truediv}
OVERFLOWING = {operator.add: "sadd", operator.sub: "ssub", operator.mul: "smul"}  # LLVM's names
IN_PLACE = {
    operator.ifloordiv: operator.floordiv, operator.imod: operator.mod, operator.itruediv: operator.truediv,
    operator.ipow: operator.pow, operator.iadd: operator.add, operator.isub: operator.sub,
    operator.imul: operator.mul, operator.ilshift: operator.lshift,
}  # fmt: skip


class Checked(Lower):
    """Lowering with the arithmetic of integers checked."""

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Raise where the result would be another number than Python's."""
        kinds = [self.typeof(x.name) for x in (expr.lhs, expr.rhs)]
        if all(isinstance(kind, types.Integer) for kind in kinds):
            self._check(IN_PLACE.get(op, op), expr, kinds)
        return super().lower_binop(resty, expr, op)

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """What has never been assigned is no number."""
        if expr.op in ("null", "undef") and isinstance(resty, types.Float):
            return self.context.get_constant(resty, math.nan)
        return super().lower_expr(resty, expr)

    def _check(self, op: Any, expr: Any, kinds: list[Any]) -> None:
        word = self.context.get_value_type(types.int64)
        signed = all(kind.signed for kind in kinds)
        a, b = (
            self.context.cast(self.builder, self.loadvar(x.name), kind, types.int64)
            for x, kind in zip((expr.lhs, expr.rhs), kinds, strict=True)
        )
        zero = word(0)
        if op in DIVISIONS:
            self._raise_if(self.builder.icmp_signed("==", b, zero), ZeroDivisionError, "division by zero")
        elif op is operator.pow and kinds[1].signed:
            said = (
                "an integer to the power of a negative one, which machine code cannot tell from a real number"
            )
            self._raise_if(self.builder.icmp_signed("<", b, zero), ValueError, said)
            real = ir.DoubleType()
            power = cgutils.get_or_insert_function(
                self.module, ir.FunctionType(real, [real, real]), "llvm.pow.f64"
            )
            about = self.builder.call(power, [self.builder.sitofp(x, real) for x in (a, b)])
            below = self.builder.fcmp_ordered("<", about, real(-(2.0 ** (BITS - 1))))
            above = self.builder.fcmp_ordered(">=", about, real(2.0 ** (BITS - 1)))
            self._raise_if(self.builder.or_(below, above), OverflowError, TOO_LARGE)
        elif op is operator.lshift:
            outside = self.builder.icmp_unsigned(">=", b, word(BITS))
            moved = self.builder.shl(a, self.builder.and_(b, word(BITS - 1)))
            back = self.builder.ashr(moved, self.builder.and_(b, word(BITS - 1)))
            lost = self.builder.icmp_signed("!=", back, a)
            self._raise_if(self.builder.or_(outside, lost), OverflowError, TOO_LARGE)
        elif op in OVERFLOWING and signed:
            f = cgutils.get_or_insert_function(
                self.module,
                ir.FunctionType(ir.LiteralStructType([word, ir.IntType(1)]), [word, word]),
                f"llvm.{OVERFLOWING[op]}.with.overflow.i{BITS}",
            )
            both = self.builder.call(f, [a, b])
            self._raise_if(self.builder.extract_value(both, 1), OverflowError, TOO_LARGE)

    def _raise_if(self, condition: Any, error: type[Exception], said: str) -> None:
        with cgutils.if_unlikely(self.builder, condition):
            self.call_conv.return_user_exc(
                self.builder, error, (said,), loc=self.loc, func_name=self.func_ir.func_id.func_name
            )


TOO_LARGE = f"an integer beyond {BITS} bits, which machine code cannot hold"
