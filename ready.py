"""Functions of the ready scenes, and of belts, as C, written from their Python source when the package is built.

A function f(t, q, v, p, out), or f(t, x, p, out) of a system with modes, of scalars and entries of arrays, with
`math`, numbers and such functions of its module, branches and loops over ranges is translated word for word; q, v, x
and p are read within their bounds alone. Others stay Python, and are compiled when they are used
(`lcpstep.callbacks`). The module that comes out has

    FUNCTIONS = {(module, name): (code, constants, names, numbers, called, address)}

of C functions with the signature of `lcpstep.kernels.function`; from the other entries one can tell whether a
function is still the one that was built, and those that it calls.
"""

from __future__ import annotations

import ast
import contextlib
import math
import re
from pathlib import Path
from types import CodeType
from typing import Any

ARGUMENTS = ["t", "q", "v", "p", "out"], ["t", "x", "p", "out"]
SIZES = {"q": 0, "x": 0, "v": 1, "p": 2}  # places of the lengths of arrays
TYPES = {"float": "double ", "Any": "double* ", "None": "void "}
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
FUNCTION = """
cdef void {c_name}(double t, double* {q}, double* v, double* p, double* out, Py_ssize_t* sizes) noexcept nogil:
{body}

FUNCTIONS[{key!r}] = {print!r} + (<size_t> {c_name},)
"""
HELPER = """
cdef inline {type}{c_name}({given}, Py_ssize_t* sizes) noexcept nogil:
{body}
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


def numbers_of(tree: ast.Module) -> dict[str, float]:
    """Numbers that a module gives names to."""
    found: dict[str, Any] = {}
    for node in tree.body:
        if not isinstance(node, ast.Assign):
            continue
        target = node.targets[0]
        try:
            value = eval(
                ast.unparse(node.value), {"__builtins__": {"range": range}, "math": math}, dict(found)
            )
        except Exception:
            continue
        if isinstance(target, ast.Name):
            target, value = ast.Tuple([target]), (value,)
        if isinstance(target, ast.Tuple) and isinstance(value, (tuple, range)):
            pairs = zip(target.elts, value, strict=True)
            found |= {ast.unparse(name): x for name, x in pairs if type(x) in (int, float)}
    return found


def helpers_of(tree: ast.Module) -> Helpers:
    """Functions of a module, of numbers and arrays, that others may call."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef) and not node.decorator_list]
    fit = {}
    for node in functions:
        said = [ast.unparse(a.annotation) if a.annotation else "" for a in node.args.args]
        result = ast.unparse(node.returns) if node.returns else ""
        if set(said) <= {"float", "Any"} and result in ("float", "None") and not node.args.defaults:
            fit[node.name] = node
    return fit


class Module:
    """The functions of one module, translated as they are asked for."""

    def __init__(self, file: Path, name: str) -> None:
        self.tree, self.name = ast.parse(file.read_text()), name
        self.numbers, self.helpers = numbers_of(self.tree), helpers_of(self.tree)
        compiled = compile(self.tree, file, "exec").co_consts
        self.codes = {c.co_name: c for c in compiled if isinstance(c, CodeType)}
        self.made: dict[str, tuple[Any, ...]] = {}  # helpers: what tells whether they have changed
        self.text: list[str] = []
        self.under_way: list[str] = []

    def c_name(self, function: str) -> str:
        """Of the C function."""
        return f"{self.name.replace('.', '_')}_{function}"

    def translated(self, function: ast.FunctionDef) -> tuple[str, tuple[Any, ...], list[str]]:
        """The body in Cython; code, constants, names and numbers; and the helpers, with those that these call."""
        words = Words(function, self.numbers, self.helpers)
        body = function.body[1:] if ast.get_docstring(function) else function.body
        lines = "\n".join(ast.unparse(ast.fix_missing_locations(words.visit(node))) for node in body)
        called = list[str]()
        for name in words.called:
            called += [name, *self.helper(name)]
            lines = re.sub(rf"\bhelp_{name}\(", f"{self.c_name(name)}_(", lines)
        code = self.codes[function.name]
        text = "\n".join(f"    {line}" for line in lines.splitlines())
        return text, (code.co_code, code.co_consts, code.co_names, words.read), called

    def helper(self, name: str) -> list[str]:
        """Translate a helper; those that it calls."""
        if name in self.under_way:
            raise Untranslatable(f"{name} calls itself")
        if name not in self.made:
            self.under_way.append(name)
            try:
                function = self.helpers[name]
                body, told, called = self.translated(function)
            finally:
                self.under_way.pop()
            given = ", ".join(f"{TYPES[ast.unparse(a.annotation)]}{a.arg}" for a in function.args.args)  # type: ignore[arg-type]
            result = TYPES[ast.unparse(function.returns)]  # type: ignore[arg-type]
            self.text.append(
                HELPER.format(type=result, c_name=f"{self.c_name(name)}_", given=given, body=body)
            )
            self.made[name] = (*told, called)
        return list(self.made[name][4])

    def callback(self, function: ast.FunctionDef) -> str:
        """A function that kernels call, and what it calls that has not been there yet."""
        body, told, called = self.translated(function)
        known = {name: self.made[name][:4] for name in called}
        new, self.text = self.text, []
        return "".join(new) + FUNCTION.format(
            c_name=self.c_name(function.name),
            q="x" if function.args.args[1].arg == "x" else "q",
            body=body,
            key=(self.name, function.name),
            print=(*told, known),
        )


def source(folder: Path) -> str:
    """The module in Cython, of all functions of the ready scenes that can be translated."""
    parts = [HEAD]
    for file in sorted(
        [
            folder / "lagrangian" / "friction.py",
            folder / "lagrangian" / "profiles.py",
            *(folder / "lagrangian" / "scenes").glob("*.py"),
        ]
    ):
        module = Module(file, ".".join(file.relative_to(folder).with_suffix("").parts))
        for node in module.tree.body:
            if isinstance(node, ast.FunctionDef) and [a.arg for a in node.args.args] in ARGUMENTS:
                with contextlib.suppress(Untranslatable):
                    parts.append(module.callback(node))
    return "".join(parts)
