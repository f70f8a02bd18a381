"""All that the machine code of a user's function depends on, as a text; and copies of functions that are named by it.

Machine code is kept on disk and linked by name. A name that carries the code of the function and of those that it
calls, and the values that it reads, is never taken for another.
"""

from __future__ import annotations

import dis
import functools
import hashlib
from collections.abc import Iterator, Mapping
from enum import Enum, EnumType
from types import BuiltinFunctionType, CellType, CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

FINGERPRINT = 12  # digits of it in a name
UNKNOWN = "<unknown>"  # a value of which nobody can tell whether it has changed


def with_twins(f: FunctionType, twins: Mapping[FunctionType, Any], variant: str) -> FunctionType:
    """A copy of f that names compiled twins in the place of plain functions.

    Its name carries a fingerprint of all that its machine code depends on, and of which variant this is, for machine
    code is linked and kept on disk by name: two variants must never share one.
    """
    named: dict[str, Any] = {}
    for name, g in callees(f):
        first, *path = name.split(".")
        named[first] = _with_member(named.get(first, f.__globals__.get(first)), path, twins[g])
    around = zip(f.__code__.co_freevars, f.__closure__ or (), strict=True)
    closure = tuple(CellType(named[name]) if name in named else cell for name, cell in around)
    copy = FunctionType(f.__code__, {**f.__globals__, **named}, f.__name__, f.__defaults__, closure)
    copy.__kwdefaults__ = f.__kwdefaults__
    fingerprint = hashlib.sha256(f"{dependencies(f)} {variant}".encode()).hexdigest()[:FINGERPRINT]
    copy.__qualname__ = f"{f.__qualname__}_{fingerprint}"
    copy.__module__ = __name__  # which numba imports with kept machine code: a file that was run is no module
    return copy


def _with_member(module: Any, path: list[str], twin: Any) -> Any:
    """The twin, or a copy of the module that a path leads through to it."""
    if not path:
        return twin
    copy = ModuleType(module.__name__)
    copy.__dict__.update(vars(module))
    setattr(copy, path[0], _with_member(getattr(module, path[0]), path[1:], twin))
    return copy


def callees(f: FunctionType) -> Iterator[tuple[str, FunctionType]]:
    """Functions that f names, whether as globals or in the function around it; those with twins already as well.

    Of modules that f names ("mine.helper") those that the user has compiled: numba takes no others.
    """
    named = [(name, f.__globals__.get(name)) for name in global_names(f)]
    for name, g in [*named, *cells(f)]:
        g = getattr(g, "py_func", g)
        if isinstance(g, FunctionType):
            yield name, g
    for name in names_read(f.__code__):
        if "." in name and isinstance(g := getattr(member(f, name), "py_func", None), FunctionType):
            yield name, g


def member(f: FunctionType, name: str) -> Any:
    """What a name with dots stands for, where it leads through modules only; None otherwise."""
    first, *path = name.split(".")
    value = f.__globals__.get(first)
    for attribute in path:
        value = getattr(value, attribute, None) if isinstance(value, ModuleType) else None
    return value


def cells(f: FunctionType) -> Iterator[tuple[str, Any]]:
    """Variables of the function around f that f reads."""
    for name, cell in zip(f.__code__.co_freevars, f.__closure__ or (), strict=True):
        yield name, cell.cell_contents


def global_names(f: FunctionType) -> list[str]:
    """Globals that f reads; its attribute names, which `co_names` mixes with these, left out."""
    return [name for name in names_read(f.__code__) if "." not in name]


@functools.cache
def names_read(code: CodeType) -> list[str]:
    """Globals that code and functions inside it read, and attributes of these that are read at once: "np", "np.pi".

    Of code, not of a function: IPython gives functions of an edited module their new code.
    """
    names: set[str] = set()
    for inner in codes(code):
        chain = ""
        for i in dis.get_instructions(inner):
            if i.opname == "LOAD_GLOBAL":
                chain = i.argval
            elif i.opname in ("LOAD_ATTR", "LOAD_METHOD") and chain:
                chain += f".{i.argval}"
            else:
                chain = ""
            names.update([chain] if chain else [])
    return sorted(names)


def codes(code: CodeType) -> Iterator[CodeType]:
    """The code of a function and of those defined inside it."""
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from codes(inner)


def dependencies(f: FunctionType) -> str:
    """All that the machine code of f depends on, as a text: the code of f and its callees, and what they read."""
    return "\n".join(sorted(map(code_text, reached(f))))


def reached(f: FunctionType) -> frozenset[FunctionType]:
    """F, its callees, theirs, and so on."""
    seen: set[FunctionType] = set()
    todo = [f]
    while todo:
        g = todo.pop()
        if g not in seen:
            seen.add(g)
            todo += [callee for _, callee in callees(g)]
    return frozenset(seen)


def code_text(f: FunctionType) -> str:
    """What one function is: its code, defaults and what it reads, as a text."""
    read = [f"{name}={value_text(value)}" for name, value in [*values_read(f), *cells(f)]]
    defaults = [value_text(x) for x in (f.__defaults__ or (), *(f.__kwdefaults__ or {}).items())]
    return f"{f.__module__}.{f.__qualname__} {instructions(f.__code__)} {defaults} {read}"


@functools.cache
def instructions(code: CodeType) -> str:
    """What code does, and that of the functions defined inside it, as a text."""
    texts = []
    for inner in codes(code):
        literals = [c for c in inner.co_consts if not isinstance(c, CodeType)]
        texts.append(f"{inner.co_code.hex()} {inner.co_names} {literals}")
    return str(texts)


def values_read(f: FunctionType) -> Iterator[tuple[str, Any]]:
    """What f reads by name: globals, and attributes of modules and classes, which numba freezes as well."""
    for name in names_read(f.__code__):
        first, *attributes = name.split(".")
        if first not in f.__globals__:
            continue
        value = f.__globals__[first]
        for attribute in attributes:
            frozen = isinstance(value, (ModuleType, type)) and hasattr(value, attribute)
            value = getattr(value, attribute) if frozen else None
        if not attributes or not value_text(value).startswith(UNKNOWN):
            yield name, value


def value_text(value: Any) -> str:
    """What numba freezes into machine code, as a text that is the same exactly if the value is."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        return f"{value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, tuple):
        functions = [x.py_func for x in value if isinstance(getattr(x, "py_func", None), FunctionType)]
        items = str([value_text(item) for item in value] + list(map(dependencies, functions)))
        return items if type(value) is tuple else f"{value_text(type(value))} {items}"
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name} {value_text(value.value)}"
    if isinstance(value, (bool, int, float, complex, str, np.generic, type(None))):
        return repr(value)
    if isinstance(value, type):
        members: Any = getattr(value, "_fields", "")  # of a named tuple
        return f"{value.__name__}{list(map(value_text, value)) if isinstance(value, EnumType) else members}"
    if isinstance(value, (ModuleType, FunctionType, BuiltinFunctionType, np.ufunc)):
        return value.__name__
    if isinstance(getattr(value, "py_func", None), FunctionType):
        return value.py_func.__name__  # one of `reached`, or in a tuple
    return f"{UNKNOWN} {id(value)}"
