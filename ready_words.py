"""The body of a Python function in the words of Cython, for `ready`: each has one in C, or the function stays Python.

Those that C lacks are defined in `HEAD`, at the top of the module that comes out.
"""

from __future__ import annotations

import ast
import math
import re
from typing import Any

SIZES = {"q": 0, "x": 0, "v": 1, "p": 2}  # places of the lengths of arrays
MATH = {
    "acos",
    "asin",
    "atan",
    "atan2",
    "copysign",
    "cos",
    "exp",
    "floor",
    "hypot",
    "log",
    "sin",
    "sqrt",
    "tan",
}
OWN = {"abs": "abs", "int": "whole", "range": "range"}  # Python's functions, and what they are here
POWERS = {2: "square", 3: "cube"}
HEAD = f"""# cython: language_level=3, cdivision=True, infer_types=True
from libc.math cimport {", ".join(sorted(MATH))}, fabs as abs

cdef double nan = float("nan")

cdef inline double entry(double* x, Py_ssize_t i, Py_ssize_t n) noexcept nogil:
    return x[i] if 0 <= i < n else nan

cdef inline Py_ssize_t whole(double x) noexcept nogil:
    return <Py_ssize_t> x

cdef inline double square(double x) noexcept nogil:
    return x * x

cdef inline double cube(double x) noexcept nogil:
    return x * (x * x)

FUNCTIONS = {{}}
"""


class Untranslatable(Exception):
    """What has no word in C here."""


Helpers = dict[str, ast.FunctionDef]


class Words(ast.NodeTransformer):
    """The body of a function in the words of Cython.

    numbers, helpers    of its module; helpers: functions that others call
    read, called        those of them that it uses
    counters            variables of its loops, which are not negative
    """

    def __init__(self, function: ast.FunctionDef, numbers: dict[str, float], helpers: Helpers) -> None:
        nodes = list(ast.walk(function))
        self.numbers, self.helpers = numbers, helpers
        self.read, self.called = dict[str, float](), list[str]()
        self.local = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        self.local |= {a.arg for a in function.args.args if ast.unparse(a.annotation or a) == "float"}
        loops = [n for n in nodes if isinstance(n, ast.For)]
        ranges = {ast.unparse(n.target) for n in loops if re.fullmatch(r"range\(\d+\)", ast.unparse(n.iter))}
        stored = [n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)]
        self.counters = {name for name in ranges if stored.count(name) == 1}
        self.returns = ast.unparse(function.returns) if function.returns else "None"

    def generic_visit(self, node: ast.AST) -> ast.AST:
        """Everything that is not known to be the same in C is refused."""
        same = (
            ast.Assign, ast.AugAssign, ast.If, ast.While, ast.For, ast.Constant, ast.Tuple, ast.UnaryOp, ast.USub,
            ast.Not, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Compare, ast.BoolOp, ast.And, ast.Or, ast.IfExp,
            ast.cmpop, ast.expr_context,
        )  # fmt: skip
        if not isinstance(node, same) or (isinstance(node, ast.Constant) and isinstance(node.value, str)):
            raise Untranslatable(ast.dump(node))
        if isinstance(node, (ast.Assign, ast.AugAssign)) and isinstance(
            node.value, (ast.Compare, ast.BoolOp)
        ):
            raise Untranslatable(ast.unparse(node))
        return super().generic_visit(node)

    def visit_Return(self, node: ast.Return) -> ast.AST:
        """The end of the function, and the value of a helper."""
        if (node.value is None) != (self.returns == "None"):
            raise Untranslatable(ast.unparse(node))
        return super().generic_visit(node) if node.value is not None else node

    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        """A call of a helper that fills the output."""
        if not isinstance(node.value, ast.Call):
            raise Untranslatable(ast.unparse(node))
        node.value = self.visit(node.value)
        return node

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """A variable, or a number of the module."""
        if node.id in self.local:
            return node
        if node.id not in self.numbers:
            raise Untranslatable(node.id)
        self.read[node.id] = self.numbers[node.id]
        return ast.Constant(self.numbers[node.id])

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """A number of `math`."""
        if ast.unparse(node) != "math.pi":
            raise Untranslatable(ast.unparse(node))
        return ast.Constant(math.pi)

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """A function of `math`, or one of Python's that C has."""
        name = ast.unparse(node.func)
        if name in self.helpers:
            return self.help(name, node)
        known = {f"math.{f}": f for f in MATH} | OWN
        if name not in known or node.keywords:
            raise Untranslatable(name)
        return ast.Call(ast.Name(known[name]), [self.visit(x) for x in node.args], [])

    def help(self, name: str, node: ast.Call) -> ast.AST:
        """A call of a helper; it has arrays by the same names."""
        wanted = self.helpers[name].args.args
        if node.keywords or len(node.args) != len(wanted):
            raise Untranslatable(ast.unparse(node))
        given: list[Any] = []
        for argument, x in zip(wanted, node.args, strict=True):
            array = ast.unparse(argument.annotation or argument) != "float"
            if array and ast.unparse(x) != argument.arg:
                raise Untranslatable(ast.unparse(node))
            given.append(x if array else self.visit(x))
        self.called.append(name)
        return ast.Call(ast.Name(f"help_{name}"), [*given, ast.Name("sizes")], [])

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        """An entry of an array: of the output, or, within its bounds, of the others."""
        array = ast.unparse(node.value)
        index: Any = node.slice
        if array == "out":
            if isinstance(index, ast.Tuple):
                i, j = (ast.unparse(self.visit(k)) for k in index.elts)
                index = ast.parse(f"({i}) * sizes[4] + {j}", mode="eval").body
            else:
                index = self.visit(index)
            return ast.Subscript(node.value, index, node.ctx)
        if array not in SIZES or not isinstance(node.ctx, ast.Load):
            raise Untranslatable(ast.unparse(node))
        size = f"sizes[{SIZES[array]}]"
        return ast.parse(f"entry({array}, {ast.unparse(self.visit(index))}, {size})", mode="eval").body

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Powers are products; whole numbers are divided as others are."""
        if isinstance(node.op, ast.Pow):
            power = getattr(node.right, "value", None)
            if power not in POWERS:
                raise Untranslatable(ast.unparse(node))
            return ast.Call(ast.Name(POWERS[power]), [self.visit(node.left)], [])
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Mod):  # that of C differs where something is negative
            positive = isinstance(right, ast.Constant) and type(right.value) is int and right.value > 0
            if not (positive and ast.unparse(left) in self.counters):
                raise Untranslatable(ast.unparse(node))
            return ast.BinOp(left, node.op, right)
        if isinstance(node.op, ast.Div):
            left, right = (
                ast.Constant(float(x.value)) if isinstance(x, ast.Constant) else x for x in (left, right)
            )
        self.visit(node.op)
        return ast.BinOp(left, node.op, right)
