"""Types of variables and constants of kernels: those of all that is assigned to them, as far as it is known.

    found, most = False, 0.0           bint, double
    c = s.mode[i] + n                  Py_ssize_t: an entry of `Indices`, and an argument
    n_a, n_f = gather(s, plastic)      what the function says that it returns

What is not known so, or would be another number in C than in Python, is left to Cython or to an annotation.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from pathlib import Path

from kernel_sources import SCALARS, Kernel, Type, bases, kernel, path_of, qualified

ENTRIES = {"Doubles": "double", "Indices": "Py_ssize_t", "Flags": "Py_ssize_t"}
OF_POINTERS = {"abs": "double", "max": "double", "min": "double", "inf": "double", "nan": "double"}
OF_PYTHON = {"len": "Py_ssize_t", "int": "Py_ssize_t", "float": "double", "range": "Indices"}


def joined(kinds: list[Type]) -> Type:
    """The type that holds values of all these; None where one is not known."""
    if len(set(kinds)) == 1:
        return kinds[0]
    numbers = kinds and set(kinds) <= set(SCALARS)
    return max(kinds, key=lambda kind: SCALARS.index(str(kind))) if numbers else None


def infer(k: Kernel, known: dict[str, Type], x: ast.expr) -> Type:
    """The type of an expression; None where it is not known."""
    of = functools.partial(infer, k, known)
    match x:
        case ast.Constant(value):
            kinds: dict[type, str] = {bool: "bint", int: "Py_ssize_t", float: "double"}
            return kinds.get(type(value))
        case ast.Name(name):
            return known.get(name) or constant_type(k, name)
        case ast.UnaryOp(op=ast.Not()):
            return "bint"
        case ast.Compare(left=a, ops=ops, comparators=others):
            of_objects = all(isinstance(op, ast.Is | ast.IsNot | ast.In | ast.NotIn) for op in ops)
            return "bint" if of_objects or joined([of(part) for part in (a, *others)]) in SCALARS else None
        case ast.UnaryOp(operand=inner):
            return joined([of(inner), "Py_ssize_t"])
        case ast.BoolOp(values=parts):
            return joined([of(part) for part in parts])
        case ast.IfExp(body=a, orelse=b):
            return joined([of(a), of(b)])
        case ast.BinOp(left=a, op=op, right=b):
            both = joined([of(a), of(b), "Py_ssize_t"])
            broken = isinstance(op, ast.Div) or (isinstance(op, ast.Pow) and not isinstance(b, ast.Constant))
            return None if broken and both == "Py_ssize_t" else both
        case ast.Attribute(attr="shape"):
            return "Indices"
        case ast.Attribute(value=owner, attr=name):
            return field_type(k, of(owner), name)
        case ast.Subscript(value=owner, slice=index) if not isinstance(index, ast.Slice):
            return entry_type(str(of(owner)), index)
        case ast.GeneratorExp(elt=element):
            return next((name for name, kind in ENTRIES.items() if kind == of(element)), None)
        case ast.Call(func=ast.Name(name)):
            return result_type(k, name)
        case ast.Call(func=ast.Attribute(value=owner, attr=name)):
            return method_type(k, of(owner), name)
    return None


def entry_type(owner: str, index: ast.expr) -> Type:
    """The type of one of several numbers."""
    if owner.startswith("("):
        return owner.strip("()").split(", ")[ast.literal_eval(index)]
    return ENTRIES.get(owner)


def constant_type(k: Kernel, name: str) -> Type:
    """The type of a module's constant, or of one that it imports."""
    home = k.homes.get(name, k.name)
    if home == "lcpstep.pointers":
        return OF_POINTERS.get(name)
    return constants(k.root, home).get(name) if name.isupper() and path_of(k.root, home).exists() else None


@functools.cache
def constants(root: Path, module: str) -> dict[str, Type]:
    """The types of a module's constants, numbers alone."""
    k = kernel(root, module)
    found: dict[str, Type] = {}
    for node in k.tree.body:
        if isinstance(node, ast.Assign):
            for target in node.targets:
                for name, value in pairs(target, node.value):
                    found[name] = infer(k, found, value)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found[node.target.id] = k.type_of(node.annotation)
    for name, home in k.homes.items():
        if name.isupper() and home != module and home.startswith("lcpstep."):
            found[name] = constant_type(k, name)
    return found


def pairs(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """Names, and what is assigned to them."""
    if isinstance(target, ast.Name):
        yield target.id, value
    elif isinstance(target, ast.Tuple):
        values = value.elts if isinstance(value, ast.Tuple) else None
        for i, name in enumerate(target.elts):
            if isinstance(name, ast.Name):
                yield name.id, values[i] if values else ast.Subscript(value, ast.Constant(i))


def field_type(k: Kernel, owner: Type, name: str) -> Type:
    """The type of a field."""
    known = ((home, home.fields.get(c, {}).get(name)) for home, c in bases(k, owner))
    return next((qualified(home, kind) for home, kind in known if kind), None)


def method_type(k: Kernel, owner: Type, name: str) -> Type:
    """The type that a method returns."""
    known = ((home, home.methods[c].get(name)) for home, c in bases(k, owner))
    return next((qualified(home, home.type_of(f.returns)) for home, f in known if f), None)


def result_type(k: Kernel, name: str) -> Type:
    """The type that a function returns, or that of a class's instance."""
    home = k.homes.get(name)
    if home == "lcpstep.pointers" and name in OF_POINTERS:
        return OF_POINTERS[name]
    if home == "math":
        return "bint" if name.startswith("is") else "double"
    owner = k.home_of(name)
    if owner and name in owner.functions:
        return qualified(owner, owner.type_of(owner.functions[name].returns))
    if owner and name in owner.classes:
        return qualified(k, name)
    return OF_PYTHON.get(name)


def bindings(f: ast.FunctionDef) -> Iterator[tuple[str, ast.expr | None]]:
    """The local variables of a function, and what is assigned to them; None: what is not looked into."""
    for node in ast.walk(f):
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    yield from pairs(target, value)
            case ast.AugAssign(target=ast.Name(name) as target, op=op, value=value):
                yield name, ast.BinOp(target, op, value)
            case ast.NamedExpr(target=ast.Name(name), value=value):
                yield name, value
            case ast.For(target=target, iter=ast.Call(func=ast.Name("range"))):
                yield ast.unparse(target), ast.Constant(0)
            case ast.For(target=target):
                yield from ((x.id, None) for x in ast.walk(target) if isinstance(x, ast.Name))


Assigned = dict[str, list[ast.expr | None]]


def told(k: Kernel, known: dict[str, Type], assigned: Assigned) -> Iterator[tuple[str, list[Type]]]:
    """The types of all that is assigned to each variable."""
    for name, values in assigned.items():
        yield name, [infer(k, known, value) if value else None for value in values]


def variables(k: Kernel, f: ast.FunctionDef, owner: str | None) -> dict[str, str]:
    """The types of a function's local variables, as far as all that is assigned to them is known."""
    fixed = {a.arg: qualified(k, k.type_of(a.annotation)) for a in f.args.args}
    if owner:
        fixed["self"] = qualified(k, owner)
    parameters = set(fixed)
    for node in ast.walk(f):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            fixed[node.target.id] = qualified(k, k.type_of(node.annotation))
    assigned: Assigned = {}
    for name, value in bindings(f):
        if name not in fixed:
            assigned.setdefault(name, []).append(value)
    known = dict(fixed)
    for _ in range(2 * len(assigned)):  # first from what is known of each, for one may need the other
        before = dict(known)
        for name, kinds in told(k, known, assigned):
            known[name] = joined([kind for kind in kinds if kind])
        if known == before:
            break
    for _ in assigned:  # then without those of which not all is known
        lost = [
            name for name, kinds in told(k, known, assigned) if known[name] and joined(kinds) != known[name]
        ]
        if not lost:
            break
        known |= dict.fromkeys(lost)
    wanted = (*SCALARS, "object")
    return {name: str(kind) for name, kind in known.items() if kind in wanted and name not in parameters}
