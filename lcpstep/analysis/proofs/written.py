"""Obstacles that a user wrote as a function: the same Python function, run on power series in balls.

It may do arithmetic and call the functions of `math` (or numpy's of the same name) on the time and the parameters. A
branch, a table, a function of the state, or one that calls others, is refused. What it computes of numbers alone is
taken as Python rounds it.
"""

from __future__ import annotations

import math
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
from flint import arb

from lagrangian.checks import said
from lagrangian.plain import InPython, source
from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.obstacles import Formula

FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "sqrt")
CONSTANTS = ("pi", "e", "tau", "inf")


class Series:
    """A power series that arithmetic and functions can be done with, but nothing decided by."""

    __array_ufunc__ = None
    __slots__ = ("x",)

    def __init__(self, x: Any) -> None:
        self.x = x

    def __add__(self, other: Any) -> Series:
        return Series(self.x + _raw(other))

    def __radd__(self, other: Any) -> Series:
        return Series(_raw(other) + self.x)

    def __sub__(self, other: Any) -> Series:
        return Series(self.x - _raw(other))

    def __rsub__(self, other: Any) -> Series:
        return Series(_raw(other) - self.x)

    def __mul__(self, other: Any) -> Series:
        return Series(self.x * _raw(other))

    def __rmul__(self, other: Any) -> Series:
        return Series(_raw(other) * self.x)

    def __truediv__(self, other: Any) -> Series:
        return Series(self.x / _raw(other))

    def __rtruediv__(self, other: Any) -> Series:
        return Series(_raw(other) / self.x)

    def __pow__(self, other: Any) -> Series:
        if isinstance(other, Series):
            raise TypeError("a power that depends on time")
        return Series(self.x ** (int(other) if float(other).is_integer() else _raw(other)))

    def __neg__(self) -> Series:
        return Series(-self.x)

    def __bool__(self) -> bool:
        raise TypeError("a branch on a number that depends on time")

    def _compared(self, other: Any) -> bool:
        raise TypeError("a branch on a number that depends on time")

    __lt__ = __le__ = __gt__ = __ge__ = _compared
    __eq__ = __ne__ = _compared
    __hash__ = None  # type: ignore[assignment]


def _raw(x: Any) -> Any:
    return x.x if isinstance(x, Series) else arb(float(x))


def _function(name: str) -> Callable[[Any], Series]:
    def f(x: Any) -> Series:
        return Series(getattr(_raw(x), name)())

    return f


class Functions:
    """What stands for the modules `math` and `numpy`."""

    def __getattr__(self, name: str) -> Any:
        raise TypeError(f"{name} is none of the functions {', '.join(FUNCTIONS)}")


SHIM = Functions()
for _name in FUNCTIONS:
    setattr(SHIM, _name, _function(_name))
for _name in CONSTANTS:
    setattr(SHIM, _name, getattr(math, _name))
REPLACED = {
    id(getattr(module, name)): getattr(SHIM, name)
    for module in (math, np)
    for name in FUNCTIONS
    if hasattr(module, name)
}


@dataclass(frozen=True)
class Written:
    """Entry out[index, 0] of a callback at the time theta/omega of the first period, which is repeated."""

    name: str
    function: FunctionType
    p: tuple[float, ...]
    rows: int
    index: int
    omega: arb

    def corners(self, phase: float) -> list[arb]:
        """Where a period ends and the next begins: there the numbers may not fit to the last digit."""
        turn = math.floor(phase / (2.0 * math.pi))
        return [2 * arb.pi() * (turn + k) for k in (-1, 0, 1, 2)]

    def formula(self, phase: float) -> Formula:
        """The function of the time since the period began."""
        start = 2 * arb.pi() * math.floor(phase / (2.0 * math.pi))
        return lambda theta: self._at((theta - start) / self.omega)

    def _at(self, time: Any) -> Any:
        out = np.empty((self.rows, 3), dtype=object)
        try:
            with InPython():
                self.function(Series(time), None, None, self.p, out)
            return _raw(out[self.index, 0]) + 0 * time
        except Exception as error:  # the user's code may raise anything
            raise NotProved(
                f"{self.name}: {self.function.__qualname__!r} ({self._place(error)}) cannot be enclosed: "
                f"{said(error)}"
            ) from error

    def _place(self, error: BaseException) -> str:
        """File and line of the callback that an error came from; its first line where it came from what it left."""
        code = self.function.__code__
        lines = [at for frame, at in traceback.walk_tb(error.__traceback__) if frame.f_code is code]
        return f"{code.co_filename}, line {lines[-1] if lines else code.co_firstlineno}"


def on_series(name: str, f: Any) -> FunctionType:
    """A callback that computes with `Series`: the same code, other functions."""
    plain = source(f)
    if not isinstance(plain, FunctionType):
        raise NotProved(f"{name}: {f!r} is no Python function, and cannot be enclosed")
    names = {key: _replaced(x) for key, x in plain.__globals__.items() if key in plain.__code__.co_names}
    same = FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)
    same.__qualname__ = plain.__qualname__
    return same


def _replaced(x: Any) -> Any:
    if isinstance(x, ModuleType) and x.__name__ in ("math", "numpy"):
        return SHIM
    return REPLACED.get(id(x), x)
