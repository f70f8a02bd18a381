"""Users' functions evaluated on intervals: what `out` may be while time and state lie between bounds.

The same Python function is run, on intervals, in a copy whose globals have the functions of `functions` in the places
of those of `math` and numpy, and copies of the user's other functions that it calls. One that this cannot do, a
look-up at a place that is no whole number, says so (`NotEnclosed`).
"""

from __future__ import annotations

import dis
import functools
import os
import traceback
from collections.abc import Callable, Sequence
from types import CellType, CodeType, FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.intervals.functions import BUILTINS, STANDS_FOR
from lcpstep.intervals.moving import part, rate_of
from lcpstep.intervals.numbers import Interval
from lcpstep.intervals.paths import NotEnclosed, Paths

Array = NDArray[np.float64]


class Enclosed:
    """What a function may give in n windows: bounds of `out`, and where it need not be smooth.

    lo, hi : (n, *shape);  branched : (n,)
    """

    def __init__(self, lo: Array, hi: Array, branched: NDArray[np.bool_]) -> None:
        self.lo, self.hi, self.branched = lo, hi, branched


def enclose(
    f: Any,
    t: Interval,
    q: Sequence[Interval],
    v: Sequence[Interval],
    p: Array,
    shape: tuple[int, ...],
    rates: bool = False,
) -> Enclosed:
    """Bounds of the callback f(t, q, v, p, out), `out` of that shape, over windows of time and state.

    Parameters
    ----------
    f : callback;  t : Interval of (n,);  q, v : an Interval of (n,) for each coordinate;  p : (n_p,) numbers
    rates : also those of the rates of `out`, as those of t, q and v (`Moving`) make them: bounds (n, *shape, 2)

    Raises
    ------
    NotEnclosed   f cannot be evaluated on intervals; the message says where and why
    """
    n, kinds = len(t.lo), (2,) if rates else ()
    count = int(np.prod(shape + kinds))
    lo, hi = np.full((n, count), np.inf), np.full((n, count), -np.inf)
    copy, numbers = replaced(f), np.array([float(x) for x in p], dtype=object)

    def call(at: Any) -> Any:
        out = np.full(shape, np.nan, dtype=object)
        here = [part(x, at) for x in (t, *q, *v)]
        state = column(here[1 : 1 + len(q)]), column(here[1 + len(q) :])
        copy(here[0], *state, numbers.copy(), out)
        return out

    def unite(out: Any, at: Any, active: Any) -> None:
        rows = at[active]
        found = out.ravel()
        if rates:
            found = [y for x in found for y in (x, rate_of(x))]
        given = np.empty((2, len(at), count))
        for k, x in enumerate(found):
            given[0, :, k], given[1, :, k] = (x.lo, x.hi) if isinstance(x, Interval) else (float(x), float(x))
        lo[rows] = np.minimum(lo[rows], given[0, active])
        hi[rows] = np.maximum(hi[rows], given[1, active])

    paths = Paths(n)
    try:
        with np.errstate(all="ignore"):
            paths.follow(call, unite)
        if np.any(paths.visits == 0):
            raise NotEnclosed("it has no value there")
    except Exception as error:  # whatever a user's function raises for a number that is none
        raise NotEnclosed(f"{place(f, error)}: {said(error)}") from error
    return Enclosed(lo.reshape(n, *shape, *kinds), hi.reshape(n, *shape, *kinds), paths.branched)


def column(x: Sequence[Interval]) -> Any:
    """An array that holds intervals."""
    out = np.empty(len(x), dtype=object)
    for i, y in enumerate(x):
        out[i] = y
    return out


def said(error: Exception) -> str:
    """What an exception says."""
    words = str(error) or type(error).__name__
    return words if isinstance(error, NotEnclosed) else f"{type(error).__name__}: {words}"


def place(f: Any, error: Exception) -> str:
    """The callback and its line that an exception comes from, in words."""
    own = plain(f)
    name = getattr(own, "__name__", repr(own))
    code = getattr(own, "__code__", None)
    lines = [x for x in traceback.extract_tb(error.__traceback__) if code and x.filename == code.co_filename]
    if not lines:
        return name
    return f"{name} ({os.path.basename(lines[-1].filename)}, line {lines[-1].lineno})"


def plain(f: Any) -> Any:
    """The Python function itself, of one that numba has compiled or of a partial one."""
    while True:
        if isinstance(f, functools.partial):
            f = f.func
        elif hasattr(f, "py_func"):
            f = f.py_func
        else:
            return f


def replaced(f: Any) -> Any:
    """A copy of a function that takes intervals, by the values that its globals and closures have now."""
    copy, seen = _known(f)
    if any(now() is not then for now, then in seen):
        _known.cache_clear()
        copy, seen = _known(f)
    return copy


Seen = list[tuple[Callable[[], Any], Any]]  # what gives a value that a copy has taken over, and the value


@functools.lru_cache(maxsize=256)
def _known(f: Any) -> tuple[Any, Seen]:
    seen: Seen = []
    return _copy(f, {}, seen), seen


def _copy(f: Any, made: dict[int, Any], seen: Seen) -> Any:
    """The copy; made: those of the functions that are being copied, by id."""
    if id(f) in STANDS_FOR:
        return STANDS_FOR[id(f)]
    if id(f) in made:
        return made[id(f)]
    if isinstance(f, functools.partial):
        return functools.partial(_copy(f.func, made, seen), *f.args, **f.keywords)
    if hasattr(f, "py_func"):
        return _copy(f.py_func, made, seen)
    if not isinstance(f, FunctionType):
        return f
    refuse(f)
    own: dict[str, Any] = dict(BUILTINS)
    closure = tuple(CellType() for _ in f.__closure__ or ())
    copy = FunctionType(f.__code__, own, f.__name__, f.__defaults__, closure or None)
    copy.__kwdefaults__ = f.__kwdefaults__
    made[id(f)] = copy
    seen.append((functools.partial(getattr, f, "__code__"), f.__code__))
    for name in _names(f.__code__):
        if name in f.__globals__:
            own[name] = _copy(f.__globals__[name], made, seen)
            seen.append((functools.partial(f.__globals__.get, name), f.__globals__[name]))
    own["__builtins__"] = f.__globals__.get("__builtins__", __builtins__)
    for cell, old in zip(closure, f.__closure__ or (), strict=True):
        cell.cell_contents = _copy(old.cell_contents, made, seen)
        seen.append((functools.partial(getattr, old, "cell_contents", None), old.cell_contents))
    return copy


def refuse(f: FunctionType) -> None:
    """NotEnclosed for a function that decides by what intervals do not do as numbers do, named with its line."""
    for code in _codes(f.__code__):
        line, before, handlers = code.co_firstlineno, None, 0
        for step in dis.get_instructions(code):
            line = step.positions.lineno or line if step.positions else line
            handlers += (step.opname == "PUSH_EXC_INFO") - (step.opname == "WITH_EXCEPT_START")
            told = step.opname == "IS_OP" and before is not None and isinstance(before.argval, bool)
            if told or (handlers > 0 and step.opname in ("CHECK_EXC_MATCH", "POP_EXCEPT")):
                why = "it asks whether something is True" if told else "it catches an exception"
                where = f"{f.__name__} ({os.path.basename(code.co_filename)}, line {line})"
                raise NotEnclosed(f"{where}: {why}, which a number between bounds cannot tell")
            before = step if step.opname == "LOAD_CONST" else None


def _names(code: CodeType) -> set[str]:
    """The names that a function and those within it use."""
    return {name for x in _codes(code) for name in x.co_names}


def _codes(code: CodeType) -> list[CodeType]:
    """The code of a function and of those within it."""
    inner = [x for constant in code.co_consts if isinstance(constant, CodeType) for x in _codes(constant)]
    return [code, *inner]
