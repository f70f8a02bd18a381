"""Intervals: numbers of which two bounds are known, for many windows at once.

    [a, b] + [c, d] = [a + c, b + d],   [a, b] [c, d] = [min(ac, ad, bc, bd), max(...)],   and so on

Rounding moves bounds outwards (`rounding`). Source: R. Moore, R. Kearfott,
M. Cloud, Introduction to Interval Analysis (SIAM 2009).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.intervals.conditions import Condition
from lcpstep.intervals.paths import NotEnclosed, current
from lcpstep.intervals.rounding import added, inverted, moved_out, multiplied, subtracted, wave


class Interval:
    """All numbers from lo to hi, for every window.

    Parameters
    ----------
    lo, hi : (n,) or numbers   the bounds
    """

    __slots__ = ("hi", "lo", "minus")

    def __init__(self, lo: Any, hi: Any, minus: Any = None) -> None:
        self.lo, self.hi = lo, hi
        self.minus = minus  # the number that this is minus of, if known: -x * x is no product of two

    def __repr__(self) -> str:
        return f"Interval({self.lo}, {self.hi})"

    @property
    def width(self) -> Any:
        """Hi - lo."""
        return self.hi - self.lo

    @property
    def size(self) -> Any:
        """The largest |x|."""
        return np.maximum(np.abs(self.lo), np.abs(self.hi))

    def __add__(self, other: Any) -> Interval:
        c, d = bounds(other)
        if c is None:
            return NotImplemented
        return Interval(*added(self.lo, self.hi, c, d))

    def __sub__(self, other: Any) -> Interval:
        c, d = bounds(other)
        if c is None:
            return NotImplemented
        return Interval(*subtracted(self.lo, self.hi, c, d))

    def __rsub__(self, other: Any) -> Interval:
        c, d = bounds(other)
        if c is None:
            return NotImplemented
        return Interval(*subtracted(c, d, self.lo, self.hi))

    def __mul__(self, other: Any) -> Interval:
        c, d = bounds(other)
        if c is None:
            return NotImplemented
        if other is self:
            return self.power(2)
        if isinstance(other, Interval) and (other.minus is self or self.minus is other):
            return -self.power(2)
        return Interval(*multiplied(self.lo, self.hi, c, d))

    def __truediv__(self, other: Any) -> Interval:
        return self * inverse(other)

    def __rtruediv__(self, other: Any) -> Interval:
        return inverse(self) * other

    def __floordiv__(self, other: Any) -> Any:
        return (self / other).floor()

    def __mod__(self, other: Any) -> Interval:
        x = self - other * (self / other).floor()
        c, d = bounds(other)
        return Interval(np.maximum(x.lo, np.minimum(c, 0.0)), np.minimum(x.hi, np.maximum(d, 0.0)))

    def __pow__(self, n: Any) -> Interval:
        if isinstance(n, Interval):
            return (n * self.log()).exp()
        if float(n) == int(n):
            return self.power(int(n)) if n >= 0 else inverse(self.power(-int(n)))
        if float(n) == 0.5:
            return self.sqrt()
        current().need(self.hi >= 0.0, "a power of a negative number")
        lo = np.maximum(self.lo, 0.0)
        if n < 2.0:
            current().mark(self.lo <= 0.0)
        x, y = lo**n, self.hi**n
        return outwards(np.minimum(x, y), np.maximum(x, y), 8.0)

    def __rpow__(self, base: Any) -> Interval:
        return (self * float(np.log(base))).exp()

    def power(self, n: int) -> Interval:
        """The n-th power, n >= 0."""
        if n == 0:
            return Interval(1.0, 1.0)
        x, y = self.lo**n, self.hi**n
        if n % 2 == 1:
            return outwards(x, y, 1.0 + n)
        zero = (self.lo <= 0.0) & (self.hi >= 0.0)
        return outwards(np.where(zero, 0.0, np.minimum(x, y)), np.maximum(x, y), 1.0 + n)

    def __neg__(self) -> Interval:
        return Interval(-self.hi, -self.lo, self)

    def __pos__(self) -> Interval:
        return self

    def __abs__(self) -> Interval:
        zero = (self.lo < 0.0) & (self.hi > 0.0)
        if np.any(zero):
            current().mark(zero)
        a, b = np.abs(self.lo), np.abs(self.hi)
        return Interval(np.where(zero, 0.0, np.minimum(a, b)), np.maximum(a, b))

    __radd__, __rmul__ = __add__, __mul__

    # --- comparisons --------------------------------------------------------------------------------------------

    def __lt__(self, other: Any) -> Condition:
        c, d = bounds(other)
        return Condition(self.hi < c, self.lo >= d)

    def __le__(self, other: Any) -> Condition:
        c, d = bounds(other)
        return Condition(self.hi <= c, self.lo > d)

    def __gt__(self, other: Any) -> Condition:
        return ~(self <= other)

    def __ge__(self, other: Any) -> Condition:
        return ~(self < other)

    def __eq__(self, other: Any) -> Condition:  # type: ignore[override]
        c, d = bounds(other)
        same = (self.lo == d) & (self.hi == c)
        return Condition(same, (self.hi < c) | (self.lo > d))

    def __ne__(self, other: Any) -> Condition:  # type: ignore[override]
        return ~(self == other)

    __hash__ = None  # type: ignore[assignment]

    def __bool__(self) -> bool:
        """Whether it is not zero."""
        return bool(self != 0.0)

    # --- what ends it -------------------------------------------------------------------------------------------

    def __float__(self) -> float:
        raise NotEnclosed("it makes one number of one that lies between bounds")

    def __index__(self) -> int:
        """A place in a table: one way for each that the window may mean.

        What Python takes for a place is a whole number, which its bounds surround by rounding.
        """
        paths = current()
        lo, hi = (np.broadcast_to(np.round(x), paths.at.shape) for x in (self.lo, self.hi))
        if np.any((lo != hi)[paths.active]):
            raise NotEnclosed("it looks up a table at a place that lies between bounds")
        places = np.unique(lo[paths.active]).astype(int).tolist()
        return int(str(paths.choose([(k, lo == k) for k in places])))

    # --- functions, by the names by which numpy asks an object for them ------------------------------------------

    def floor(self) -> Interval:
        """The whole number below; one way for each of two."""
        a, b = np.floor(self.lo), np.floor(self.hi)
        paths = current()
        steps, many = paths.spread(b > a), paths.spread(b > a + 1.0)
        paths.mark(many)
        if paths.choose([("below", np.ones_like(steps)), ("above", steps & ~many)]) == "below":
            return Interval(a, np.where(many, b, a))
        return Interval(b, b)

    def ceil(self) -> Interval:
        """The whole number above."""
        return -((-self).floor())

    def sqrt(self) -> Interval:
        """Square root, which has a corner at zero; of what is negative by the width of the window, that of zero."""
        current().need(self.hi >= 0.0, "a square root of a negative number")
        if np.any(self.lo <= 0.0):
            current().mark(self.lo <= 0.0)
        return outwards(np.sqrt(np.maximum(self.lo, 0.0)), np.sqrt(self.hi))

    def exp(self) -> Interval:
        """Exponential."""
        x = outwards(np.exp(self.lo), np.exp(self.hi), 8.0)
        return Interval(np.maximum(x.lo, 0.0), x.hi)

    def log(self) -> Interval:
        """Natural logarithm."""
        current().need(self.hi > 0.0, "a logarithm of a negative number")
        return outwards(np.log(np.maximum(self.lo, 0.0)), np.log(self.hi), 8.0)

    def sin(self) -> Interval:
        """Sine."""
        return Interval(*wave(self.lo, self.hi, 0.25, np.sin))

    def cos(self) -> Interval:
        """Cosine."""
        return Interval(*wave(self.lo, self.hi, 0.0, np.cos))

    def tan(self) -> Interval:
        """Tangent."""
        turns = np.floor(self.lo / np.pi + 0.5) != np.floor(self.hi / np.pi + 0.5)
        x = outwards(np.tan(self.lo), np.tan(self.hi), 8.0)
        return Interval(np.where(turns, -np.inf, x.lo), np.where(turns, np.inf, x.hi))

    def sinh(self) -> Interval:
        """Hyperbolic sine."""
        return outwards(np.sinh(self.lo), np.sinh(self.hi), 8.0)

    def cosh(self) -> Interval:
        """Hyperbolic cosine."""
        a, b = np.cosh(self.lo), np.cosh(self.hi)
        zero = (self.lo <= 0.0) & (self.hi >= 0.0)
        return outwards(np.where(zero, 1.0, np.minimum(a, b)), np.maximum(a, b), 8.0)

    def tanh(self) -> Interval:
        """Hyperbolic tangent."""
        return outwards(np.tanh(self.lo), np.tanh(self.hi), 8.0)

    def arctan(self) -> Interval:
        """Inverse tangent."""
        return outwards(np.arctan(self.lo), np.arctan(self.hi), 8.0)

    def arcsin(self) -> Interval:
        """Inverse sine."""
        current().need((self.hi >= -1.0) & (self.lo <= 1.0), "an inverse sine of a number beyond 1")
        current().mark((self.lo <= -1.0) | (self.hi >= 1.0))
        return outwards(np.arcsin(np.maximum(self.lo, -1.0)), np.arcsin(np.minimum(self.hi, 1.0)), 8.0)

    def arccos(self) -> Interval:
        """Inverse cosine."""
        return 0.5 * np.pi - self.arcsin()

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """What numpy's scalars and functions do with an interval."""
        from lcpstep.intervals.functions import apply

        if method != "__call__" or options:
            raise NotEnclosed(f"numpy.{ufunc.__name__} is not known for intervals")
        return apply(ufunc, inputs)


def bounds(x: Any) -> tuple[Any, Any]:
    """Lower and upper bound, of a number the same; None of what is no number."""
    if isinstance(x, Interval):
        return x.lo, x.hi
    if isinstance(x, (int, float, np.floating, np.integer)):
        x = float(x)
        return x, x
    return None, None


def outwards(lo: Any, hi: Any, units: float = 1.0) -> Interval:
    """Bounds moved by more than the rounding of what made them."""
    return Interval(*moved_out(lo, hi, units))


def inverse(x: Any) -> Any:
    """1 / x, without bounds where x may be zero."""
    if not isinstance(x, Interval):
        c, _ = bounds(x)
        if c is None:
            raise NotEnclosed(f"it divides by {x!r}")
        return outwards(1.0 / c, 1.0 / c)
    return Interval(*inverted(x.lo, x.hi))
