"""Python source of callbacks from expressions in q, v, t, p."""

from __future__ import annotations

import sympy
from sympy import Expr, Symbol
from sympy.printing.pycode import PythonCodePrinter

from lagrangian.symbolic.expressions import Equations


def source_of(found: Equations) -> str:
    """Python source of all callbacks."""
    vectors = {name: getattr(found, name) for name in ("force", "gap", "gap_t", "bias", "energy")}
    matrices = {"mass": found.M} | {name: getattr(found, name) for name in ("force_q", "force_v", "jacobian")}
    targets = [(name, x, [f"out[{i}]" for i in range(x.rows)]) for name, x in vectors.items()]
    targets += [
        (name, x, [f"out[{i}, {j}]" for i in range(x.rows) for j in range(x.cols)])
        for name, x in matrices.items()
    ]
    functions = [_function(name, list(x), places) for name, x, places in targets if places]
    return "\n\n".join(['"""Derived by lagrangian.symbolic."""\n\nimport math\n', *functions])


def _function(name: str, expressions: list[Expr], places: list[str]) -> str:
    """Source of one callback; what its expressions share is computed once."""
    origin = "gaps" if name in ("gap", "jacobian", "gap_t", "bias") else "lagrangian, dissipation, forces"
    label = f"{origin}: {name}"
    shared: list[tuple[Symbol, Expr]] = []
    if not any(e.has(sympy.Piecewise) for e in expressions):  # whose cases must not be computed outside them
        shared, expressions = sympy.cse(expressions, sympy.numbered_symbols("a", real=True))
    lines = [f"{x} = {printed(label, e)}" for x, e in shared]
    lines += [f"{place} = {printed(label, e)}" for place, e in zip(places, expressions, strict=True)]
    body = "".join(f"    {line}\n" for line in lines)
    return f"def {name}(t, q, v, p, out):\n{body}"


def printed(name: str, expression: Expr) -> str:
    """The expression as Python; an error where Python's math knows no such function."""
    printer = PythonCodePrinter({"fully_qualified_modules": True})
    try:
        text = str(printer.doprint(expression))
    except (NotImplementedError, ValueError):  # no such function; the derivative of one that has none
        text = "None"
    # "None" stands where a Piecewise has no last case, "Not supported" for unknown functions
    if "None" in text or "Not supported" in text or printer.module_imports.keys() - {"math"}:
        raise ValueError(f"{name}: cannot be written with Python's math functions alone: {expression}")
    return text
