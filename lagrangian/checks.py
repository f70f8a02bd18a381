"""Checks of what a user hands in; each error names the argument and says what was expected."""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian.plain import Unavailable, in_order, python

Array = NDArray[np.float64]
Callback = Callable[[float, Any, Any, Any, Any], Any]  # f(t, q, v, p, out), fills out, returns None
MANY = 50  # numbers in a message
LARGEST = 2**62  # whole number: kernels count in 64 bits
ASYMMETRY = 1e-12  # of the largest entry: what rounding may leave


def array(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Own, read-only, contiguous copy of a real, finite array of the given shape (a scalar fits size one)."""
    given = _real(name, value)
    result = np.ascontiguousarray(given)
    if result.ndim < len(shape) and result.size == 1:
        result = result.reshape((1,) * len(shape))
    if result.shape != shape:
        raise ValueError(f"{name}: expected shape {shape}, got {np.shape(given)}")
    return _finite(name, value, result)


def _finite(name: str, value: ArrayLike, result: Array) -> Array:
    """An array of one's own, read-only from here on; ValueError where it is not finite."""
    if not np.isfinite(result).all():
        raise ValueError(f"{name}: expected finite numbers, got {value!r}")
    result.flags.writeable = False
    return result


def number(name: str, value: Any, *, least: float = -np.inf, most: float = np.inf) -> float:
    """A finite real number within [least, most]."""
    try:
        result = _real(name, value).item()
    except ValueError:
        raise ValueError(f"{name}: expected a number, got {value!r}") from None
    if not np.isfinite(result):
        raise ValueError(f"{name}: expected a finite number, got {value!r}")
    if not least <= result <= most:
        raise ValueError(f"{name}: expected a value in [{least:g}, {most:g}], got {value!r}")
    return result


def positive(name: str, value: Any) -> float:
    """A finite real number greater than zero."""
    result = number(name, value)
    if result <= 0.0:
        raise ValueError(f"{name}: expected a positive number, got {value!r}")
    return result


def matrix(name: str, value: ArrayLike) -> Array:
    """A matrix of at least one row and column; a number stands for one by one."""
    shape = np.atleast_2d(_real(name, value)).shape
    if len(shape) != 2 or 0 in shape:
        raise ValueError(f"{name}: expected a matrix, got shape {shape}")
    return array(name, np.atleast_2d(np.array(value)), (shape[0], shape[1]))


def _real(name: str, value: ArrayLike) -> Array:
    """Numbers, and nothing that could be taken for such: no text, no truth values, nothing masked."""
    try:
        given = np.array(value)  # a copy
        texts = given.dtype == object and any(isinstance(x, (str, bytes, bool)) for x in given.flat)
        if given.dtype.kind not in "iufO" or texts or _holds_truth(value) or _is_masked(value):
            raise TypeError
        return given.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError):  # an integer beyond all floating-point numbers
        raise ValueError(f"{name}: expected real numbers, got {value!r}") from None


def _is_masked(value: Any) -> bool:
    """Whether an array has masked entries; there are none before `numpy.ma` has been loaded, which takes its time."""
    ma: Any = sys.modules.get("numpy.ma")
    return ma is not None and isinstance(value, ma.MaskedArray) and bool(ma.is_masked(value))


def _holds_truth(value: Any) -> bool:
    """Whether a list, or one inside it, has a truth value among its numbers, which numpy takes for 0 or 1."""
    if isinstance(value, (list, tuple)):
        return any(map(_holds_truth, value))
    return isinstance(value, (bool, np.bool_))


def vector(name: str, value: ArrayLike) -> Array:
    """Real finite numbers in one dimension, any number of them; a number stands for one."""
    given = _real(name, value)
    if given.ndim == 0:
        given = given.reshape(1)
    if given.ndim != 1:
        raise ValueError(f"{name}: expected one dimension, got shape {given.shape}")
    return _finite(name, given, given)


def increasing(parameter: str, values: ArrayLike) -> Array:
    """Values of a parameter, each larger than the one before; at least one."""
    result = vector(parameter, values)
    if len(result) == 0 or np.any(np.diff(result) <= 0.0):
        raise ValueError(f"values: expected increasing values of {parameter}, got {result.tolist()}")
    return result


def per_contact(name: str, value: ArrayLike, n_c: int) -> Array:
    """One number per contact; a single number stands for all."""
    return array(name, np.broadcast_to(_real(name, value), (n_c,)) if np.ndim(value) == 0 else value, (n_c,))


def restitution(value: ArrayLike, n_c: int) -> Array:
    """One coefficient of restitution per contact, each in [0, 1]."""
    r = per_contact("restitution", value, n_c)
    if np.any((r < 0.0) | (r > 1.0)):
        raise ValueError(f"restitution: expected values in [0, 1], got {value!r}")
    return r


def count(name: str, value: Any) -> int:
    """A positive integer that kernels can count to."""
    try:
        result = operator.index(value)
    except TypeError:
        result = 0
    if result < 1 or isinstance(value, bool):
        raise ValueError(f"{name}: expected a positive integer, got {value!r}")
    if result > LARGEST:
        raise ValueError(f"{name}: expected an integer of at most {LARGEST}, got {value!r}")
    return result


def limit(name: str, value: Any) -> int:
    """The same, of what may be as large as 1e6, and is written so."""
    whole = isinstance(value, (float, np.floating)) and value.is_integer()
    return count(name, int(value) if whole else value)


def period(value: Any) -> float:
    """A positive time, or infinity where nothing repeats."""
    try:
        result = float(_real("period", value).item())
    except ValueError:
        result = math.nan
    if not result > 0.0:
        raise ValueError(f"period: expected a positive time or math.inf, got {value!r}")
    return result


def instance(name: str, value: Any, *kinds: type) -> None:
    """TypeError for an object of another class."""
    if not isinstance(value, kinds):
        raise TypeError(f"{name}: expected a {' or '.join(kind.__name__ for kind in kinds)}, got {value!r}")


def function(name: str, value: Any, of: str) -> None:
    """TypeError for what cannot be called."""
    if not callable(value):
        raise TypeError(f"{name}: expected a function of {of}, got {value!r}")


def callbacks(of: Any, needed: tuple[str, ...], optional: tuple[str, ...]) -> None:
    """ValueError for an attribute that is no function, though it is needed, or given."""
    for name in needed + optional:
        f = getattr(of, name)
        if not callable(f) and (name in needed or f is not None):
            raise ValueError(f"{name}: expected a function f(t, q, v, p, out), got {f!r}")


def has(name: str, value: Any, attribute: str, what: str) -> None:
    """TypeError for an object without what is asked of it; `what` it was expected to be, in words."""
    if not hasattr(value, attribute):
        raise TypeError(f"{name}: expected {what}, got {value!r}")


def filled(name: str, value: Any, kind: type, what: str) -> None:
    """TypeError for what is no collection of this kind with at least one entry."""
    if not isinstance(value, kind) or not value:
        raise TypeError(f"{name}: expected {what}, at least one, got {value!r}")


def symmetric(name: str, value: Array) -> Array:
    """A symmetric matrix up to rounding, or an error that names the two entries that are furthest apart."""
    apart = np.abs(value - value.T)
    if np.max(apart, initial=0.0) > ASYMMETRY * np.max(np.abs(value), initial=0.0):
        i, j = sorted(np.unravel_index(int(np.argmax(apart)), apart.shape))
        raise ValueError(
            f"{name}: expected a symmetric matrix, got {value[i, j]:g} in row {i}, column {j} and {value[j, i]:g} in "
            f"row {j}, column {i}; forces without a potential are given by lagrangian.System"
        )
    return value


def mass_matrix(name: str, value: Array) -> Array:
    """A symmetric positive definite matrix, or an error that says which of the two it is not."""
    symmetric_mass(name, value)
    lowest = float(np.linalg.eigvalsh(value)[0])
    if lowest <= 0.0:
        raise ValueError(
            f"{name}: the mass matrix must be positive definite, its lowest eigenvalue is {lowest:g}"
        )
    return value


def symmetric_mass(name: str, value: Array) -> None:
    """ValueError unless a matrix is symmetric up to rounding."""
    scale = np.max(np.abs(value), initial=0.0)
    if not np.allclose(value, value.T, rtol=0.0, atol=ASYMMETRY * scale):
        raise ValueError(f"{name}: the mass matrix must be symmetric, got\n{value}")


def evaluate(
    name: str,
    f: Callback,
    at: tuple[float, Array, Array, Array],
    shape: tuple[int, ...],
    speeds: tuple[str, str] = ("v", ""),
) -> Array:
    """Value of a callback in plain Python; an error if it does not fill `out` of the given shape.

    speeds : what its third argument is called, and what it is if not the velocity of the coordinates
    """
    out = np.full(shape, np.nan)
    t, q, v, p = at
    letter, words = speeds
    call = f"f(t, q, {letter}, p, out)"
    in_order(name, f, ("t", "q", letter, "p", "out"))

    def where() -> str:
        return f"at t = {t:.9g}, q = {shown(q)}, {words}{letter} = {shown(v)}"

    try:
        returned = python(f)(t, read_only(q), read_only(v), read_only(p), out)
    except Unavailable:
        raise
    except Exception as error:  # the user's code may raise anything; the message says whose it is
        sizes = f"q of shape {q.shape}, {words}{letter}" if words else f"q, {letter}"
        raise ValueError(
            f"{name}: {call} with {sizes} of shape {v.shape}, p of shape {p.shape} and out of "
            f"shape {shape} failed {where()}: {said(error, letter)}"
        ) from error
    if returned is not None:
        raise ValueError(f"{name}: expected {call} to fill `out`, but it returned {returned!r}")
    if not np.all(np.isfinite(out)):
        found = f"{where()}: {shown(out)}"
        hint = "; every entry is to be set, as out[0] = ..., zeros too" if np.any(np.isnan(out)) else ""
        raise ValueError(f"{name}: out (shape {shape}) is not finite or not filled {found}{hint}")
    return out


def read_only(x: Array) -> Array:
    """A view of x through which it cannot be changed."""
    view = x.view()
    view.flags.writeable = False
    return view


def said(error: BaseException, letter: str = "v") -> str:
    """What an exception says, and what it is; what the third argument of the callback is called."""
    if "read-only" in str(error):
        return f"{error}; q, {letter} and p are not the callback's to change"
    if isinstance(error, IndexError) and "only integers" in str(error):
        return f"{error}; p holds numbers by their places, p[0], p[1], ..., in the order of `parameters`"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


class ReadOnly(dict[str, Any]):
    """A dictionary that stays as it is; copies and pickles are like it, and `dict(x)` is one that can be changed."""

    def _refuse(self, *arguments: Any, **keywords: Any) -> Any:
        raise TypeError("parameters: what has been made from them would not change; make another scene")

    __setitem__ = __delitem__ = __ior__ = update = setdefault = pop = popitem = clear = _refuse

    def __reduce__(self) -> Any:
        return ReadOnly, (dict(self),)


def labels(name: str, values: Any, n: int) -> tuple[str, ...]:
    """Names with units, n of them or none."""
    given = (values,) if isinstance(values, str) or not np.iterable(values) else tuple(values)
    if not all(isinstance(x, str) for x in given) or len(given) not in (0, n):
        raise ValueError(f"{name}: expected {n} names with units, as 'angle [rad]', got {values!r}")
    return given


def shown(x: NDArray[Any]) -> str:
    """The numbers of an array for a message: all of them, or the first few and how many."""
    if x.size <= MANY:
        return str(x.tolist())
    return f"[{', '.join(map(str, x.flat[:3].tolist()))}, ... {x.size} numbers]"
