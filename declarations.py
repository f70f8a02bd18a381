"""Declarations of kernels for Cython, made from their Python source when the package is built.

    def strike(s: Rubbing, t: float) -> bool     becomes     cdef bint strike(Rubbing s, double t) noexcept nogil

`int` is Py_ssize_t, `float` double, `bool` bint, `Doubles` and `Indices` are pointers, classes of kernels themselves,
`Any` a Python object. A function that takes or returns one stays Python's, but for `@cython.ccall`, which C and
Python call, and `@cython.cfunc`, which C calls: both hold Python's lock, without `@cython.nogil`. Capitals are
constants. What the annotations do not tell stands in the `.pxd` file beside the source (`kernel_sources`).
"""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path

from inference import constants, variables
from kernel_sources import IN_C, MERGED, POINTERS, SCALARS, Kernel, marks

DECLARED = {
    f"cython.{mark}" for mark in ("ccall", "cfunc", "nogil", "final")
}  # not to be said to Cython again
LIBRARY = {"math": "libc.math"}


def signature(k: Kernel, f: ast.FunctionDef) -> str | None:
    """A function as C declares it; None: it is Python's."""
    args = [a for a in f.args.args if a.arg != "self"]
    kinds = [k.type_of(a.annotation) for a in args]
    result = k.type_of(f.returns)
    first = len(args) - len(f.args.defaults)
    own = [f"{t} {a.arg}" + "=*" * (i >= first) for i, (t, a) in enumerate(zip(kinds, args, strict=True))]
    given = ", ".join(["self"] * (len(args) < len(f.args.args)) + own)
    marked = marks(f)
    if "cython.ufunc" in marked:
        return None
    if "cython.ccall" in marked or "cython.cfunc" in marked:
        given, result = given.replace("None ", "object "), result or "object"
        free = " noexcept nogil" if "cython.nogil" in marked else ""
        if "cython.ccall" in marked:
            return f"cpdef {result} {f.name}({given}){free}"
        return f"cdef {result} {f.name}({given})" + " noexcept" * (result in (*SCALARS, "void"))
    if f.name.startswith("__") or marked or not {None, "object"}.isdisjoint((result, *kinds)):
        return None
    return f"cdef {result} {f.name}({given}) noexcept nogil"


def declared(k: Kernel, f: ast.FunctionDef, owner: str | None = None) -> list[str]:
    """Lines that declare a function, or a method of the class `owner`; none where it is Python's."""
    line = signature(k, f)
    if line is None or re.search(rf"\b{f.name}\b[ \w\"]*\(", k.header):
        return []
    local = variables(k, f, owner)
    if k.name in MERGED:
        body = k.text.splitlines()[f.body[1].lineno - 1 : f.end_lineno]  # without what it says of itself
        first = [f"    cdef {kind} {name}" for name, kind in local.items()]
        return [line.replace("cdef", "cdef inline") + ":", *first, *body, ""]
    known = ", ".join(f"{name}={kind}" for name, kind in local.items())
    return [f"@cython.locals({known})", line] if local else [line]


@functools.cache
def derived_from(root: Path) -> set[str]:
    """Names of classes that others are derived from."""
    files = (path.read_text(encoding="utf-8") for path in root.glob("lcpstep/**/*.py"))
    return {base for text in files for base in re.findall(r"^class \w+\((\w+)", text, re.MULTILINE)}


def with_methods(k: Kernel) -> list[str]:
    """The `.pxd` file, with the methods of its classes; those without relatives are final."""
    lines = k.header.splitlines()
    for name, methods in k.methods.items():
        heads = [i for i, line in enumerate(lines) if re.match(rf"cdef class {name}\b.*:$", line)]
        if not heads:
            continue
        outside = (i for i in range(heads[0] + 1, len(lines)) if not lines[i].startswith("    "))
        end = next(outside, len(lines))
        made = [f"    {line}" for f in methods.values() for line in declared(k, f, name)]
        lines[end:end] = made or ["    pass"] * (end == heads[0] + 1)
        if not k.classes[name].bases and name not in derived_from(k.root):
            lines.insert(heads[0], "@cython.final")
    return lines


def declarations(root: Path, name: str) -> str:
    """What Cython reads as the `.pxd` file of a kernel."""
    k = Kernel(root, name)
    if name in IN_C:
        return k.header
    own = [line for f in k.functions.values() for line in declared(k, f)]
    lines = [*numbers(k), *with_methods(k), *own]
    words = set(re.findall(r"\w+", "\n".join(lines)))
    told = set(re.findall(r"\w+", " ".join(re.findall(r"cimport(.*)", k.header))))
    homes = {name: k.homes[name] for name in words & k.cimported - told}
    homes |= dict.fromkeys(words.intersection(POINTERS), "lcpstep.pointers")
    cimports = [f"from {LIBRARY.get(home, home)} cimport {name}" for name, home in sorted(homes.items())]
    return "\n".join(["cimport cython", *cimports, *lines, ""])


def numbers(k: Kernel) -> list[str]:
    """Lines that declare a kernel's constants, but for those that the `.pxd` file has or C imports."""
    told = set(re.findall(r"\w+", k.header)) | k.cimported
    known = constants(k.root, k.name).items()
    return [
        f"cdef {kind} {name}"
        for name, kind in known
        if kind in SCALARS and name.isupper() and name not in told
    ]
