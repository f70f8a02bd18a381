"""Functions of the ready scenes, and of belts, as C, written from their Python source when the package is built.

A function f(t, q, v, p, out), or f(t, x, p, out) of a system with modes, of scalars and entries of arrays, with
`math`, numbers and such functions of its module, branches and loops over ranges is translated word for word; q, v, x
and p are read within their bounds alone. Others stay Python, and are compiled when they are used
(`lcpstep.callbacks.compiling`). The module that comes out has

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

from ready_words import HEAD, Helpers, Untranslatable, Words

ARGUMENTS = ["t", "q", "v", "p", "out"], ["t", "x", "p", "out"]
TYPES = {"float": "double ", "Any": "double* ", "None": "void "}
FUNCTION = """
cdef void {c_name}(double t, double* {q}, double* v, double* p, double* out, Py_ssize_t* sizes) noexcept nogil:
{body}

FUNCTIONS[{key!r}] = {print!r} + (<size_t> {c_name},)
"""
HELPER = """
cdef inline {type}{c_name}({given}, Py_ssize_t* sizes) noexcept nogil:
{body}
"""


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
