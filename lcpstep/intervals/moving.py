"""Intervals with bounds of their rate: what a function of time is, and how fast it changes, in every window.

    (x y)' = x' y + x y',   f(x)' = f'(x) x'

The rules of differentiation, with intervals for numbers. What comes from an operation that has none here is a plain
interval, whose rate is not known. Source: R. Moore, R. Kearfott, M. Cloud, Introduction to Interval Analysis (SIAM
2009), section 6.3.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.intervals.numbers import Interval, bounds, inverse


class Moving(Interval):
    """All numbers from lo to hi, for every window, and bounds of the rate at which they change.

    Parameters
    ----------
    lo, hi : (n,) or numbers   the bounds
    rate : Interval or a number
    """

    __slots__ = ("rate",)

    def __init__(self, lo: Any, hi: Any, rate: Any, minus: Any = None) -> None:
        super().__init__(lo, hi, minus)
        self.rate = rate

    def __add__(self, other: Any) -> Any:
        return _of(still(self) + still(other), self.rate + rate_of(other)) if _fits(other) else NotImplemented

    def __sub__(self, other: Any) -> Any:
        return _of(still(self) - still(other), self.rate - rate_of(other)) if _fits(other) else NotImplemented

    def __rsub__(self, other: Any) -> Any:
        return _of(still(other) - still(self), rate_of(other) - self.rate) if _fits(other) else NotImplemented

    def __mul__(self, other: Any) -> Any:
        if not _fits(other):
            return NotImplemented
        if other is self:
            return self.power(2)
        if isinstance(other, Moving) and (other.minus is self or self.minus is other):
            return -self.power(2)
        x, y = still(self), still(other)
        return _of(x * y, times(self.rate, y) + times(rate_of(other), x))

    def __truediv__(self, other: Any) -> Any:
        return self * _inverse(other)

    def __rtruediv__(self, other: Any) -> Any:
        return _inverse(self) * other

    def __mod__(self, other: Any) -> Any:
        x = self - other * (self / other).floor()
        c, d = bounds(other)
        return Moving(np.maximum(x.lo, np.minimum(c, 0.0)), np.minimum(x.hi, np.maximum(d, 0.0)), x.rate)

    def __pow__(self, n: Any) -> Any:
        if isinstance(n, Interval):
            return (n * self.log()).exp()
        if float(n) == int(n):
            return self.power(int(n)) if n >= 0 else _inverse(self.power(-int(n)))
        x = still(self)
        return _of(x**n, times(self.rate, float(n) * x ** (float(n) - 1.0)))

    def power(self, n: int) -> Any:
        """The n-th power, n >= 0."""
        x = still(self)
        return _of(x.power(n), times(self.rate, float(n) * x.power(n - 1)) if n > 0 else 0.0)

    def __neg__(self) -> Moving:
        return Moving(-self.hi, -self.lo, -self.rate, self)

    def __abs__(self) -> Any:
        return _of(abs(still(self)), either(self.rate, -self.rate, self.lo >= 0.0, self.hi <= 0.0))

    __radd__, __rmul__ = __add__, __mul__
    __hash__ = None

    # --- functions ----------------------------------------------------------------------------------------------

    def floor(self) -> Any:
        """The whole number below; where it jumps the window holds a branch."""
        return _of(still(self).floor(), 0.0)

    def sqrt(self) -> Any:
        """Square root."""
        root = still(self).sqrt()
        return _of(root, times(self.rate, inverse(2.0 * root)))

    def exp(self) -> Any:
        """Exponential."""
        x = still(self).exp()
        return _of(x, times(self.rate, x))

    def log(self) -> Any:
        """Natural logarithm."""
        return _of(still(self).log(), times(self.rate, inverse(still(self))))

    def sin(self) -> Any:
        """Sine."""
        return _of(still(self).sin(), times(self.rate, still(self).cos()))

    def cos(self) -> Any:
        """Cosine."""
        return _of(still(self).cos(), times(self.rate, -still(self).sin()))

    def tan(self) -> Any:
        """Tangent."""
        x = still(self).tan()
        return _of(x, times(self.rate, 1.0 + x.power(2)))

    def sinh(self) -> Any:
        """Hyperbolic sine."""
        return _of(still(self).sinh(), times(self.rate, still(self).cosh()))

    def cosh(self) -> Any:
        """Hyperbolic cosine."""
        return _of(still(self).cosh(), times(self.rate, still(self).sinh()))

    def tanh(self) -> Any:
        """Hyperbolic tangent."""
        x = still(self)
        return _of(x.tanh(), times(self.rate, inverse(x.cosh().power(2))))

    def arctan(self) -> Any:
        """Inverse tangent."""
        x = still(self)
        return _of(x.arctan(), times(self.rate, inverse(1.0 + x.power(2))))

    def arcsin(self) -> Any:
        """Inverse sine."""
        x = still(self)
        return _of(x.arcsin(), times(self.rate, inverse((1.0 - x.power(2)).sqrt())))


def part(x: Interval, at: Any) -> Interval:
    """An interval for some of the windows, with its rate if that is known."""
    if not isinstance(x, Moving):
        return Interval(x.lo[at], x.hi[at])
    return Moving(x.lo[at], x.hi[at], part(x.rate, at) if isinstance(x.rate, Interval) else x.rate)


def still(x: Any) -> Any:
    """The numbers without their rate."""
    return Interval(x.lo, x.hi) if isinstance(x, Moving) else x


def rate_of(x: Any) -> Any:
    """Bounds of the rate: none of what is a plain interval."""
    if isinstance(x, Moving):
        return x.rate
    return (
        Interval(np.full_like(x.lo, -np.inf), np.full_like(x.lo, np.inf)) if isinstance(x, Interval) else 0.0
    )


def times(rate: Any, factor: Any) -> Any:
    """Their product, zero of what does not change."""
    if not isinstance(rate, Interval) and rate == 0.0:
        return 0.0
    return _interval(rate) * _interval(factor)


def either(x: Any, y: Any, first: Any, second: Any) -> Any:
    """X in the windows of the first kind, y in those of the second, one of both elsewhere."""
    x, y = _interval(x), _interval(y)
    lo = np.where(first, x.lo, np.where(second, y.lo, np.minimum(x.lo, y.lo)))
    return Interval(lo, np.where(first, x.hi, np.where(second, y.hi, np.maximum(x.hi, y.hi))))


def _of(value: Interval, rate: Any) -> Moving:
    return Moving(value.lo, value.hi, rate)


def _fits(x: Any) -> bool:
    return bounds(x)[0] is not None


def _interval(x: Any) -> Interval:
    return x if isinstance(x, Interval) else Interval(np.float64(x), np.float64(x))


def _inverse(x: Any) -> Any:
    y = inverse(still(x))
    return _of(y, times(rate_of(x), -y.power(2)))
