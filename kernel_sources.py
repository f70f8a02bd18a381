"""The Python sources of kernels, as `declarations` reads them.

A kernel is a file that imports `cython`. Its annotations are its types in C; what these cannot tell stands in a
`.pxd` file beside it: the fields of classes, and what is C in itself.
"""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator
from pathlib import Path

SCALARS = ("bint", "Py_ssize_t", "double")  # each holds those before it
POINTERS = ("Doubles", "Indices", "Flags", "Callback")
WORDS = {"int": "Py_ssize_t", "float": "double", "bool": "bint", "Any": "object"} | {x: x for x in POINTERS}
IN_C = {
    "lcpstep.pointers",
    "lcpstep.arrays",
    "lcpstep.kernels.roundings",
    "lcpstep.stepping.pieces.codes",
}  # whose `.pxd` says all
MERGED = IN_C | {
    "lcpstep.kernels.vectors",
    "lcpstep.kernels.one_row",
    "lcpstep.kernels.quadratic",
    "lcpstep.stepping.pieces.times",
}  # short functions, merged into the modules that use them
Type = str | None  # as Cython writes it; of classes, where several modules meet, "module:name"


class Kernel:
    """A kernel's source, and what its names stand for.

    homes       the module that each name is imported from
    classes, functions   by name
    fields      of each class, as far as the `.pxd` file tells them
    """

    def __init__(self, root: Path, name: str) -> None:
        self.root, self.name = root, name
        self.path = path_of(root, name)
        self.text = self.path.read_text(encoding="utf-8")
        self.header = read(self.path.with_suffix(".pxd"))
        self.tree = ast.parse(self.text)
        imports = [node for node in self.tree.body if isinstance(node, ast.ImportFrom)]
        self.homes = {name.asname or name.name: str(node.module) for node in imports for name in node.names}
        for module, names in re.findall(r"^from (\S+) cimport (.+)$", self.header, re.MULTILINE):
            self.homes |= dict.fromkeys(re.split(r",\s*", names), module)
        self.classes = {node.name: node for node in self.tree.body if isinstance(node, ast.ClassDef)}
        self.functions = functions_of(self.tree)
        self.methods = {name: functions_of(node) for name, node in self.classes.items()}
        self.fields = fields_of(self.header)

    def type_of(self, annotation: ast.expr | None) -> Type:
        """C's name of a type, None where it has none."""
        if isinstance(annotation, ast.Constant) and annotation.value is None:
            return "void"
        if isinstance(annotation, ast.Name):
            return WORDS.get(annotation.id) or (annotation.id if self.knows(annotation.id) else None)
        if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "tuple":
            kinds = [self.type_of(kind) for kind in getattr(annotation.slice, "elts", [])]
            return f"({', '.join(map(str, kinds))})" if kinds and set(kinds) <= set(SCALARS) else None
        return None

    def knows(self, name: str) -> bool:
        """Whether a name is that of a kernel's class."""
        home = self.home_of(name)
        return home is not None and name in home.fields

    def home_of(self, name: str) -> Kernel | None:
        """The kernel that a name is from; None: of no kernel."""
        module = self.name if name in self.classes or name in self.functions else self.homes.get(name, "")
        known = module.startswith("lcpstep.") and path_of(self.root, module).exists()
        return kernel(self.root, module) if known else None


@functools.cache
def path_of(root: Path, module: str) -> Path:
    """Where the source of a module lies."""
    return root / f"{module.replace('.', '/')}.py"


@functools.cache
def kernel(root: Path, name: str) -> Kernel:
    """The kernel of that name."""
    return Kernel(root, name)


@functools.cache
def kernels(root: Path) -> list[str]:
    """The names of all kernels."""
    files = sorted(root.glob("lcpstep/**/*.py"))
    found = [file for file in files if re.search("^import cython$", read(file), re.MULTILINE)]
    return sorted({".".join(file.relative_to(root).with_suffix("").parts) for file in found} | IN_C)


def read(path: Path) -> str:
    """The text of a file, none where there is none."""
    return path.read_text(encoding="utf-8") if path.exists() else ""


def functions_of(node: ast.Module | ast.ClassDef) -> dict[str, ast.FunctionDef]:
    """Functions of a module, or methods of a class."""
    return {f.name: f for f in node.body if isinstance(f, ast.FunctionDef)}


def fields_of(header: str) -> dict[str, dict[str, str]]:
    """The types of the fields of each class that a `.pxd` file has."""
    found: dict[str, dict[str, str]] = {}
    for line in header.splitlines():
        if match := re.match(r"cdef class (\w+).*:", line):
            found[match[1]] = {}
        elif found and (match := re.match(r"    cdef (?:public |readonly )?([\w.]+) (.+)$", line)):
            next(reversed(found.values())).update(dict.fromkeys(re.split(r",\s*", match[2]), match[1]))
    return found


def marks(f: ast.FunctionDef | ast.ClassDef) -> set[str]:
    """What decorates a function or a class."""
    return {ast.unparse(mark) for mark in f.decorator_list}


def qualified(k: Kernel, kind: Type) -> Type:
    """A type, of classes with the module that they are from."""
    home = k.home_of(kind) if kind else None
    return f"{home.name}:{kind}" if home and kind in home.classes else kind


def bases(k: Kernel, kind: Type) -> Iterator[tuple[Kernel, str]]:
    """A class, and those that it is derived from."""
    while kind and ":" in kind:
        module, name = kind.split(":")
        home = kernel(k.root, module)
        yield home, name
        parents = home.classes[name].bases
        kind = qualified(home, ast.unparse(parents[0])) if parents else None
