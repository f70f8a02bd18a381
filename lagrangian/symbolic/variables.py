"""The author's symbols, and the real ones that callbacks are written in: what an expression may contain."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy
from sympy import Derivative, Expr, Symbol
from sympy.core.function import AppliedUndef

from lagrangian import checks
from lagrangian.symbolic.expressions import stepped
from lagrangian.symbolic.source import printed


@dataclass(frozen=True)
class Variables:
    """The author's symbols, and the real ones that callbacks are written in: q[0], v[0], p[0], t."""

    coordinates: tuple[Expr, ...]
    q: tuple[Symbol, ...]
    v: tuple[Symbol, ...]
    t: Symbol
    named: dict[str, Symbol]  # plain symbols, by name
    functions: dict[Expr, Symbol]  # functions of time and their derivatives
    outward: dict[Symbol, Expr]  # as the author writes them, with the assumptions met in what was read

    @classmethod
    def of(cls, coordinates: list[Any], velocities: Any, parameters: Iterable[str]) -> Variables:
        """Give everything that an expression may contain its place."""
        time, names = _time(coordinates), list(parameters)
        rates = _velocities(coordinates, velocities, time)
        q, v, p = (_places(*x) for x in (("q", len(coordinates)), ("v", len(rates)), ("p", len(names))))
        t = Symbol("t", real=True)
        authors = [*coordinates, *rates, *map(Symbol, names), time]
        if twice := sorted({str(x) for x in authors if [*map(str, authors)].count(str(x)) > 1}):
            raise ValueError(f"coordinates, velocities, parameters, time: {', '.join(twice)} given twice")
        inward = dict(zip(authors, [*q, *v, *p, t], strict=True))
        functions = {
            x.diff(time): y for x, y in zip(coordinates, v, strict=True) if isinstance(x, AppliedUndef)
        }
        functions |= {x: y for x, y in inward.items() if not isinstance(x, Symbol)}
        named = {x.name: y for x, y in inward.items() if isinstance(x, Symbol)}
        return cls(tuple(coordinates), q, v, t, named, functions, {y: x for x, y in inward.items()})

    def read(self, name: str, value: Any, without: Iterable[Symbol] = ()) -> Expr:
        """An expression of the author's in q, v, t, p; an error that names the argument if it is none."""
        expression = _expression(name, value).doit()
        symbols = expression.free_symbols
        parts = expression.atoms(AppliedUndef, Derivative)
        unknown = [x for x in symbols if x.name not in self.named] + [
            x for x in parts if x not in self.functions
        ]
        if unknown:
            raise ValueError(
                f"{name}: unknown {', '.join(sorted(map(str, unknown)))}; expected an expression in the "
                f"coordinates, their first derivatives, the time and the parameters, each with a value"
            )
        plain = {x: self.named[x.name] for x in symbols}
        self.outward.update({y: x for x, y in plain.items()})
        result = stepped(expression.xreplace(self.functions | plain))
        if result.is_real is False or result.has(sympy.I, sympy.zoo, sympy.oo, -sympy.oo, sympy.nan):
            raise ValueError(f"{name}: expected a real, finite expression, got {expression}")
        if present := result.free_symbols & set(without):
            raise ValueError(f"{name}: expected no velocities, got {self.names(present)}")
        printed(name, result)
        return result

    def written(self, expression: Expr) -> Expr:
        """An expression in q, v, t, p in the author's symbols."""
        return expression.xreplace(self.outward)

    def names(self, symbols: Iterable[Symbol]) -> str:
        """What the author calls them."""
        return ", ".join(sorted(str(self.outward[x]) for x in symbols))


def _time(coordinates: list[Any]) -> Symbol:
    """The symbol of time: the argument of the coordinates that are functions, otherwise t."""
    if not coordinates or not all(isinstance(q, Symbol | AppliedUndef) for q in coordinates):
        raise ValueError(f"coordinates: expected symbols or functions of time, got {coordinates}")
    times = {q.args for q in coordinates if isinstance(q, AppliedUndef)} or {(Symbol("t"),)}
    time = next(iter(times))
    if len(times) > 1 or len(time) > 1 or not isinstance(time[0], Symbol):
        raise ValueError(f"coordinates: expected functions of one and the same time, got {coordinates}")
    return time[0]


def _velocities(coordinates: list[Any], velocities: Any, time: Symbol) -> list[Any]:
    """The symbols of the velocities: those given, or the derivatives of the coordinates."""
    rates = [q.diff(time) if isinstance(q, AppliedUndef) else None for q in coordinates]
    if velocities is None and None in rates:
        raise ValueError("velocities: expected one symbol for each coordinate, as these are plain symbols")
    given = rates if velocities is None else sequence(velocities)
    if len(given) != len(rates):
        raise ValueError(f"velocities: expected {len(rates)}, one for each coordinate, got {len(given)}")
    for x, rate in zip(given, rates, strict=True):
        if x != rate and not isinstance(x, Symbol | AppliedUndef):
            raise ValueError(f"velocities: expected symbols, in the order of the coordinates, got {x!r}")
    return given


def _places(letter: str, n: int) -> tuple[Symbol, ...]:
    return tuple(Symbol(f"{letter}[{i}]", real=True) for i in range(n))


def sequence(value: Any) -> list[Any]:
    """One expression, or several in a list, tuple, or matrix."""
    return list(value) if np.iterable(value) and not isinstance(value, str) else [value]


def _expression(name: str, value: Any) -> Expr:
    try:
        result = sympy.sympify(value, strict=True)
    except (sympy.SympifyError, TypeError):
        result = None
    if not isinstance(result, Expr) or result.is_Matrix:
        raise ValueError(f"{name}: expected a sympy expression, got {value!r}")
    return result


def parameter_values(given: Mapping[Any, float]) -> dict[str, float]:
    """Names and values of parameters, checked."""
    if not isinstance(given, Mapping):
        raise ValueError(f"parameters: expected a mapping from names to numbers, got {given!r}")
    return {str(x): checks.number(f"parameters[{str(x)!r}]", value) for x, value in given.items()}
