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
from kernel_sources import IN_C, MERGED, POINTERS, SCALARS, Kernel, Type, kernel, kernels, marks

# What Cython is not to be told again
DECLARED = {f"cython.{mark}" for mark in ("ccall", "cfunc", "nogil", "final")}
LIBRARY = {"math": "libc.math"}


def signature(k: Kernel, f: ast.FunctionDef) -> str | None:
    """A function as C declares it; None: it is Python's."""
    args, marked = [a for a in f.args.args if a.arg != "self"], marks(f)
    kinds, result = [k.type_of(a.annotation) for a in args], k.type_of(f.returns)
    if marked & {"cython.ccall", "cython.cfunc"} and "cython.ufunc" not in marked:
        how, free = "cpdef" if "cython.ccall" in marked else "cdef", "cython.nogil" in marked
    elif f.name.startswith("__") or marked or not {None, "object"}.isdisjoint((result, *kinds)):
        return None
    else:
        how, free = "cdef", True
    first = len(args) - len(f.args.defaults)
    own = ["self"] if len(args) < len(f.args.args) else []
    for i, (kind, a) in enumerate(zip(kinds, args, strict=True)):
        own.append(f"{kind or 'object'} {a.arg}" + "=*" * (i >= first))
    return f"{how} {result or 'object'} {f.name}({', '.join(own)})" + " noexcept nogil" * free


def declared(k: Kernel, f: ast.FunctionDef, owner: str | None = None) -> list[str]:
    """Lines that declare a function, or a method of the class `owner`; none where it is Python's."""
    line = signature(k, f)
    if line is None or re.search(rf"^ *cp?def [^(#]*\b{f.name}\b[ \w\"]*\(", k.header, re.MULTILINE):
        return []
    local = variables(k, f, owner)
    if k.name in MERGED:
        begin = f.body[ast.get_docstring(f) is not None].lineno - 1
        body = k.text.splitlines()[begin : f.end_lineno]
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


@functools.cache
def names_in_c(root: Path, module: str) -> set[str]:
    """What C knows of a kernel by itself: functions, classes and constants."""
    k = kernel(root, module)
    if module in IN_C:
        return set(re.findall(r"\w+", k.header))
    functions = {name for name, f in k.functions.items() if signature(k, f)}
    return functions | set(k.fields) | set(own_numbers(k)) | by_themselves(k)


def by_themselves(k: Kernel) -> set[str]:
    """Words of what the `.pxd` file of a kernel declares besides classes."""
    return set(re.findall(r"\w+", " ".join(re.findall(r"^cdef (?!class)([^#\n]*)", k.header, re.MULTILINE))))


def cimported(k: Kernel) -> dict[str, str]:
    """What C imports of all that a kernel does, and from where."""
    kernels_ = set(kernels(k.root))
    own = {
        name: home for name, home in k.homes.items() if home in kernels_ and name in names_in_c(k.root, home)
    }
    return own | {name: LIBRARY[home] for name, home in k.homes.items() if home in LIBRARY}


@functools.cache
def needed(root: Path, name: str) -> frozenset[str]:
    """The kernels whose declarations Cython reads for one."""
    found, new = {name}, [name]
    while new:
        more = set(cimported(kernel(root, new.pop())).values()) - found - set(LIBRARY.values())
        found |= more
        new += more
    return frozenset(found)


def own_numbers(k: Kernel) -> dict[str, Type]:
    """The types of the constants that a kernel makes, but for those that its `.pxd` file has."""
    told, known = by_themselves(k), constants(k.root, k.name).items()
    return {
        n: kind for n, kind in known if kind in SCALARS and n.isupper() and n not in told and n not in k.homes
    }


def declarations(root: Path, name: str) -> str:
    """What Cython reads as the `.pxd` file of a kernel."""
    k = kernel(root, name)
    if name in IN_C:
        return k.header
    own = [line for f in k.functions.values() for line in declared(k, f)]
    lines = [*numbers(k), *with_methods(k), *own]
    words = set(re.findall(r"\w+", "\n".join(lines)))
    told = set(re.findall(r"\w+", " ".join(re.findall(r"cimport(.*)", k.header))))
    homes = {name: home for name, home in cimported(k).items() if name in words - told}
    homes |= dict.fromkeys(words.intersection(POINTERS), "lcpstep.pointers")
    cimports = [
        f"from {home} cimport {', '.join(sorted(n for n in homes if homes[n] == home))}"
        for home in sorted(set(homes.values()))
    ]
    return "\n".join(["cimport cython", *cimports, *lines, ""])


def numbers(k: Kernel) -> list[str]:
    """Lines that declare a kernel's constants, and those that it takes from where C does not know them."""
    known, elsewhere = constants(k.root, k.name), cimported(k)
    taken = {n: known.get(n) for n in k.homes if n.isupper() and n not in elsewhere}
    return [f"cdef {kind} {n}" for n, kind in (own_numbers(k) | taken).items() if kind in SCALARS]


def source(root: Path, name: str) -> str:
    """A kernel as Cython reads it: what C knows is cimported, nothing declared again; lines stay where they are."""
    k = kernel(root, name)
    lines, in_c = k.text.split("\n"), cimported(k)
    for node in ast.walk(k.tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and "cython.ufunc" not in marks(node):
            for mark in node.decorator_list:
                if ast.unparse(mark) in DECLARED:
                    lines[mark.lineno - 1] = ""
    for node in k.tree.body:
        if isinstance(node, ast.ImportFrom):
            begin, end = node.lineno - 1, node.end_lineno or node.lineno
            lines[begin:end] = [imported(node, in_c), *[""] * (end - begin - 1)]
    return "\n".join(lines)


def imported(node: ast.ImportFrom, in_c: dict[str, str]) -> str:
    """A line that imports the same, what C knows from C."""
    known = [ast.unparse(name) for name in node.names if (name.asname or name.name) in in_c]
    others = [ast.unparse(name) for name in node.names if (name.asname or name.name) not in in_c]
    home = LIBRARY.get(str(node.module), node.module)
    c = [f"from cython.cimports.{home} import {', '.join(known)}"] if known else []
    python = [f"from {node.module} import {', '.join(others)}"] if others else []
    return "; ".join([*c, *python])
