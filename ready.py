"""Functions of the ready scenes as C, written from their Python source when the package is built.

A function f(t, q, v, p, out) of scalars and entries of arrays, with `math`, numbers of its module, branches and loops
over ranges is translated word for word; q, v and p are read within their bounds alone. Others stay Python, and are
compiled when they are used (`lcpstep.callbacks`). The module that comes out has

    FUNCTIONS = {(module, name): (code, constants, names, numbers, address)}

of C functions with the signature of `lcpstep.kernels.function`; from the other entries one can tell whether a
function is still the one that was built.
"""

from __future__ import annotations

import ast
import math
from pathlib import Path
from types import CodeType
from typing import Any

ARGUMENTS = ["t", "q", "v", "p", "out"]
MATH = {"acos", "asin", "atan", "atan2", "cos", "exp", "floor", "hypot", "log", "sin", "sqrt", "tan"}
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
FUNCTION = """
cdef void {c_name}(double t, double* q, double* v, double* p, double* out, Py_ssize_t* sizes) noexcept nogil:
{body}

FUNCTIONS[{key!r}] = {print!r} + (<size_t> {c_name},)
"""


class Untranslatable(Exception):
    """What has no word in C here."""


class Words(ast.NodeTransformer):
    """The body of a function in the words of Cython; `numbers` are those of its module, `read` those it reads."""

    def __init__(self, numbers: dict[str, float], local: set[str]) -> None:
        self.numbers, self.local, self.read = numbers, local, dict[str, float]()

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
        """The end of the function, and no value."""
        if node.value is not None:
            raise Untranslatable(ast.unparse(node))
        return node

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """A variable, or a number of the module."""
        if node.id in self.local or node.id == "t":
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
        known = {f"math.{f}": f for f in MATH} | OWN
        if name not in known or node.keywords:
            raise Untranslatable(name)
        return ast.Call(ast.Name(known[name]), [self.visit(x) for x in node.args], [])

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
        if array not in ("q", "v", "p") or not isinstance(node.ctx, ast.Load):
            raise Untranslatable(ast.unparse(node))
        size = f"sizes[{('q', 'v', 'p').index(array)}]"
        return ast.parse(f"entry({array}, {ast.unparse(self.visit(index))}, {size})", mode="eval").body

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Powers are products; whole numbers are divided as others are."""
        if isinstance(node.op, ast.Pow):
            power = getattr(node.right, "value", None)
            if power not in POWERS:
                raise Untranslatable(ast.unparse(node))
            return ast.Call(ast.Name(POWERS[power]), [self.visit(node.left)], [])
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Div):
            left, right = (
                ast.Constant(float(x.value)) if isinstance(x, ast.Constant) else x for x in (left, right)
            )
        self.visit(node.op)
        return ast.BinOp(left, node.op, right)


def numbers_of(tree: ast.Module) -> dict[str, float]:
    """Numbers that a module gives names to."""
    found: dict[str, Any] = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                value = eval(ast.unparse(node.value), {"__builtins__": {}, "math": math}, dict(found))
            except Exception:
                continue
            if type(value) in (int, float):
                found[node.targets[0].id] = value
    return found


def translated(function: ast.FunctionDef, numbers: dict[str, float]) -> tuple[str, dict[str, float]]:
    """The body of a function in Cython, and the module's numbers that it reads."""
    local = {n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    words = Words(numbers, local)
    body = function.body[1:] if ast.get_docstring(function) else function.body
    return "\n".join(ast.unparse(ast.fix_missing_locations(words.visit(node))) for node in body), words.read


def source(folder: Path) -> str:
    """The module in Cython, of all functions of the ready scenes that can be translated."""
    parts = [HEAD]
    for file in sorted(
        [folder / "lagrangian" / "profiles.py", *(folder / "lagrangian" / "scenes").glob("*.py")]
    ):
        module = ".".join(file.relative_to(folder).with_suffix("").parts)
        tree = ast.parse(file.read_text())
        codes = {c.co_name: c for c in compile(tree, file, "exec").co_consts if isinstance(c, CodeType)}
        for node in tree.body:
            if isinstance(node, ast.FunctionDef) and [a.arg for a in node.args.args] == ARGUMENTS:
                try:
                    body, read = translated(node, numbers_of(tree))
                except Untranslatable:
                    continue
                code = codes[node.name]
                parts.append(
                    FUNCTION.format(
                        c_name=f"{module.replace('.', '_')}_{node.name}",
                        body="\n".join(f"    {line}" for line in body.splitlines()),
                        key=(module, node.name),
                        print=(code.co_code, code.co_consts, code.co_names, read),
                    )
                )
    return "".join(parts)
