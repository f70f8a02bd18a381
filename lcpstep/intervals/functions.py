"""The functions of `math` and numpy that users' functions call, for intervals and for numbers alike."""

from __future__ import annotations

import builtins
import math
import operator
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from lcpstep.intervals.conditions import Condition, sides
from lcpstep.intervals.moving import Moving, either, rate_of
from lcpstep.intervals.numbers import Interval, bounds
from lcpstep.intervals.paths import NotEnclosed, current


def by_name(name: str, plain: Callable[..., Any]) -> Callable[[Any], Any]:
    """A function of one number that intervals have as a method."""

    def f(x: Any) -> Any:
        if isinstance(x, Interval):
            return getattr(x, name)()
        return plain(x)

    return f


def interval(x: Any) -> Interval:
    """An interval, of a number as well."""
    return x if isinstance(x, Interval) else Interval(*bounds(x))


def smaller(x: Any, y: Any) -> Any:
    """The smaller of two."""
    if not (isinstance(x, Interval) or isinstance(y, Interval)):
        return min(x, y)
    own, other = interval(x), interval(y)
    meets(own, other)
    lo, hi = np.minimum(own.lo, other.lo), np.minimum(own.hi, other.hi)
    return one_of(x, y, own.hi <= other.lo, other.hi <= own.lo, lo, hi)


def larger(x: Any, y: Any) -> Any:
    """The larger of two."""
    if not (isinstance(x, Interval) or isinstance(y, Interval)):
        return max(x, y)
    own, other = interval(x), interval(y)
    meets(own, other)
    lo, hi = np.maximum(own.lo, other.lo), np.maximum(own.hi, other.hi)
    return one_of(x, y, own.lo >= other.hi, other.lo >= own.hi, lo, hi)


def one_of(x: Any, y: Any, first: Any, second: Any, lo: Any, hi: Any) -> Interval:
    """Bounds of what is x in windows of the first kind and y in those of the second; with its rate, if known."""
    if not (isinstance(x, Moving) or isinstance(y, Moving)):
        return Interval(lo, hi)
    return Moving(lo, hi, either(rate_of(x), rate_of(y), first, second))


def meets(x: Interval, y: Interval) -> None:
    """Take note of windows in which either may be the larger one."""
    both = (x.hi > y.lo) & (y.hi > x.lo)
    if np.any(both):
        current().mark(both)


def least(*x: Any) -> Any:
    """The builtin min."""
    return _of_all(smaller, x)


def most(*x: Any) -> Any:
    """The builtin max."""
    return _of_all(larger, x)


def _of_all(f: Callable[[Any, Any], Any], x: Any) -> Any:
    values = list(x[0]) if len(x) == 1 else list(x)
    result = values[0]
    for y in values[1:]:
        result = f(result, y)
    return result


def whole(x: Any = 0, *more: Any) -> Any:
    """The builtin int: towards zero."""
    if isinstance(x, Condition):
        return int(bool(x))
    if not isinstance(x, Interval):
        return int(x, *more)
    return x.floor() if x >= 0.0 else x.ceil()


def number(x: Any = 0.0) -> Any:
    """The builtin float."""
    if isinstance(x, Condition):
        return float(bool(x))
    return x if isinstance(x, Interval) else float(x)


def is_a(x: Any, kinds: Any) -> bool:
    """The builtin isinstance, for which what lies between bounds is a number."""
    of_numbers: list[tuple[Any, type]] = [(number, float), (whole, int)]
    wanted = kinds if isinstance(kinds, tuple) else (kinds,)
    known: Any = True if isinstance(x, Condition) else 0.0 if isinstance(x, Interval) else x
    return isinstance(known, tuple(next((own for f, own in of_numbers if f is y), y) for y in wanted))


def kind_of(*x: Any) -> Any:
    """The builtin type: nobody knows which of two kinds of numbers the user's function would be given."""
    if isinstance(x[0], (Condition, Interval)):
        raise NotEnclosed("it asks of what kind a number is")
    own: Any = type
    return own(*x)


def remainder_of_c(x: Any, y: Any) -> Any:
    """`math.fmod`: with the sign of x."""
    if not (isinstance(x, Interval) or isinstance(y, Interval)):
        return math.fmod(x, y)
    return x - y * whole(x / y)


def length(*x: Any) -> Any:
    """`math.hypot`."""
    if not any(isinstance(y, Interval) for y in x):
        return math.hypot(*x)
    total = interval(x[0]).power(2)
    for y in x[1:]:
        total = total + interval(y).power(2)
    return Interval(np.maximum(total.lo, 0.0), total.hi).sqrt()


def angle(y: Any, x: Any) -> Any:
    """`math.atan2`."""
    if not (isinstance(x, Interval) or isinstance(y, Interval)):
        return math.atan2(y, x)
    x, y = interval(x), interval(y)
    if x > 0.0:
        return (y / x).arctan()
    if y > 0.0:
        return 0.5 * math.pi - (x / y).arctan()
    if y < 0.0:
        return -0.5 * math.pi - (x / y).arctan()
    raise NotEnclosed("an angle that may jump by a turn")


def with_sign(x: Any, y: Any) -> Any:
    """`math.copysign`."""
    if not (isinstance(x, Interval) or isinstance(y, Interval)):
        return math.copysign(x, y)
    return abs(x) if y >= 0.0 else -abs(x)


def sign(x: Any) -> Any:
    """`numpy.sign`."""
    if not isinstance(x, Interval):
        return np.sign(x)
    if x > 0.0:
        return 1.0
    return -1.0 if x < 0.0 else 0.0


def where(condition: Any, x: Any, y: Any) -> Any:
    """`numpy.where`."""
    if not any(isinstance(z, (Condition, Interval)) for z in (condition, x, y)):
        return np.where(condition, x, y)
    yes, no = sides(condition)
    if np.any(~(yes | no)):
        current().mark(~(yes | no))
    value = either(x, y, yes, no)
    return one_of(x, y, yes, no, value.lo, value.hi)


def interpolated(x: Any, xp: Any, fp: Any, left: Any = None, right: Any = None, period: Any = None) -> Any:
    """`numpy.interp`: linear between points of a table, and constant beyond its ends, which may jump there."""
    if not isinstance(x, Interval):
        return np.interp(x, xp, fp, left, right, period)
    if period is not None:
        raise NotEnclosed("a table that is repeated")
    if left is not None and x < xp[0]:
        return left
    if right is not None and x > xp[-1]:
        return right
    places, values = np.asarray(xp, dtype=float), np.asarray(fp, dtype=float)
    lo, hi = np.atleast_1d(x.lo), np.atleast_1d(x.hi)
    a, b = np.interp(lo, places, values), np.interp(hi, places, values)
    least_, most_ = np.minimum(a, b), np.maximum(a, b)
    first, last = np.searchsorted(places, lo, side="right"), np.searchsorted(places, hi, side="left")
    for k in np.flatnonzero(last > first):
        inner = values[first[k] : last[k]]
        least_[k], most_[k] = min(least_[k], inner.min()), max(most_[k], inner.max())
    current().mark(last > first)
    slack = 1e-15 * np.max(np.abs(values))
    return Interval(least_ - slack, most_ + slack)


def objects(make: Callable[..., Any]) -> Callable[..., Any]:
    """An array that can hold intervals: `numpy.zeros` and the like."""

    def f(shape: Any, *_: Any, **__: Any) -> Any:
        return make(shape).astype(object)

    return f


METHODS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "exp": "exp", "log": "log", "sqrt": "sqrt", "sinh": "sinh",
    "cosh": "cosh", "tanh": "tanh", "floor": "floor", "ceil": "ceil", "atan": "arctan", "asin": "arcsin",
    "acos": "arccos",
}  # fmt: skip
MATH: dict[str, Callable[..., Any]] = {
    name: by_name(method, getattr(math, name)) for name, method in METHODS.items()
} | {
    "fabs": abs, "fmod": remainder_of_c, "hypot": length, "atan2": angle, "copysign": with_sign, "pow": operator.pow,
}  # fmt: skip
NUMPY: dict[str, Callable[..., Any]] = {
    method: by_name(method, getattr(np, method)) for method in METHODS.values()
} | {
    "abs": abs, "absolute": abs, "fabs": abs, "hypot": length, "arctan2": angle, "copysign": with_sign, "sign": sign,
    "fmod": remainder_of_c, "minimum": smaller, "maximum": larger, "where": where, "interp": interpolated,
    "mod": operator.mod, "remainder": operator.mod, "power": operator.pow, "float64": number,
    "zeros": objects(np.zeros), "ones": objects(np.ones), "empty": objects(np.zeros),
}  # fmt: skip
BUILTINS: dict[str, Callable[..., Any]] = {
    "min": least, "max": most, "int": whole, "float": number, "isinstance": is_a, "type": kind_of,
}  # fmt: skip
UFUNCS: dict[Any, Callable[..., Any]] = {
    getattr(np, name): f for name, f in NUMPY.items() if isinstance(getattr(np, name), np.ufunc)
} | {
    np.add: operator.add, np.subtract: operator.sub, np.multiply: operator.mul, np.divide: operator.truediv,
    np.negative: operator.neg, np.power: operator.pow, np.square: lambda x: x**2, np.less: operator.lt,
    np.less_equal: operator.le, np.greater: operator.gt, np.greater_equal: operator.ge, np.equal: operator.eq,
    np.not_equal: operator.ne, np.floor_divide: operator.floordiv,
}  # fmt: skip


def apply(ufunc: Any, inputs: tuple[Any, ...]) -> Any:
    """One of numpy's functions of intervals, and of arrays element by element, as with any object."""
    if ufunc not in UFUNCS:
        raise NotEnclosed(f"numpy.{ufunc.__name__} is not known for intervals")
    x = [i if isinstance(i, Interval) or np.ndim(i) else float(i) for i in inputs]
    if any(np.ndim(i) for i in x if not isinstance(i, Interval)):
        return ufunc(*[(i if isinstance(i, np.ndarray) else boxed(i)).astype(object) for i in x])
    return UFUNCS[ufunc](*x)


def boxed(x: Any) -> Any:
    """An array without dimensions that holds x."""
    box = np.empty((), dtype=object)
    box[()] = x
    return box


class Module(SimpleNamespace):
    """A module whose functions take intervals; the others are as they were."""

    def __getattr__(self, name: str) -> Any:
        """What is not replaced."""
        return getattr(self.__dict__["_own"], name)


STANDS_FOR: dict[int, Any] = {id(math): Module(_own=math, **MATH), id(np): Module(_own=np, **NUMPY)}
STANDS_FOR |= {id(getattr(math, name)): f for name, f in MATH.items()}
STANDS_FOR |= {id(getattr(np, name)): f for name, f in NUMPY.items()}
STANDS_FOR |= {id(getattr(builtins, name)): f for name, f in BUILTINS.items()}
