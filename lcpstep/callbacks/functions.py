"""A user's functions in a file: what they are and a checksum of it, never their code to be run.

A function counts as the same where its source without comments, that of all functions that it calls, and the values
that they read are the same; an object that is called, or a method, where its attributes are, too. Lists, dictionaries
and objects of the user's own are read with all they hold, unless the function writes into them, as where it counts
its calls. One without a source (typed into a terminal) is told by its byte code, which belongs to a version of
Python.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib
import inspect
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, is_dataclass
from types import CodeType, FunctionType, MethodType, SimpleNamespace
from typing import Any

import numpy as np

from lagrangian.plain import Unavailable
from lcpstep.callbacks import fingerprint
from lcpstep.errors import LcpStepError

# Methods that leave what they are of as it is
READS = ("get", "items", "keys", "values", "index", "count", "copy")
HOLDERS = (list, tuple, set, frozenset, Mapping, np.ndarray)
OWN = ("lagrangian.scenes.", "lagrangian.profiles")  # where functions are taken from by their name alone


class MissingFunction(LcpStepError, Unavailable):
    """What is raised by a function that did not come with its file."""


@dataclass(frozen=True, eq=False)
class Absent:
    """In the place of a function that did not come with its file.

    Attributes
    ----------
    name, source, sha256 : what the function was called, its text for a reader, and the checksum that tells it
    reason : why it is not here
    """

    name: str
    source: str
    sha256: str
    reason: str

    def __call__(self, *arguments: Any) -> Any:
        """LcpStepError: what to do."""
        raise MissingFunction(f"{self.name}: {self.reason}")


def require(f: Any) -> None:
    """LcpStepError for a function that did not come with its file, before a run begins that needs it."""
    if isinstance(f, Absent):
        f()


def described(f: Any) -> dict[str, str]:
    """Name, source and checksum of a function; none of what is called and not written in Python."""
    if isinstance(f, Absent):
        return {"function": f.name, "source": f.source, "sha256": f.sha256}
    plain = getattr(f, "py_func", f)
    if not isinstance(plain, FunctionType):
        return {"function": f"an object of class {type(f).__name__}", "source": "", "sha256": _of_object(f)}
    name = f"{plain.__module__}:{plain.__qualname__}"
    return {"function": name, "source": whole_source(plain), "sha256": checksum(plain)}


def found(name: str, source: str, sha256: str) -> Any:
    """The function of that name among those of the ready scenes; `Absent` where it is none of these, or another."""
    module, _, inner = name.partition(":")
    if module.startswith(OWN) and inner.isidentifier():
        f = getattr(importlib.import_module(module), inner, None)
        if isinstance(f, FunctionType) and checksum(f) == sha256:
            return f
        return Absent(name, source, sha256, "it is another one in this version of lcpstep than in the file's")
    reason = "files carry no code that is run; give the scene that was run as load(path, scene=...)"
    return Absent(name, source, sha256, reason)


def checksum(f: FunctionType) -> str:
    """A number that is the same exactly if the function is, and what it reads."""
    parts = [f"{plain_source(g)} {read_values(g)}" for g in fingerprint.reached(f)]
    return hashlib.sha256("\n".join(sorted(parts)).encode()).hexdigest()


def _of_object(f: Any) -> str:
    """The checksum of an object that is called, or of a method: what it does, and the attributes that it reads."""
    method = f if isinstance(f, MethodType) else f.__call__
    if not isinstance(method, MethodType) or not isinstance(method.__func__, FunctionType):
        return ""
    own = method.__self__
    called = _methods(own if isinstance(own, type) else type(own), method.__func__)
    changed = frozenset[str]().union(*(written(g.__code__) for g in called))
    held = {name: x for name, x in _attributes(own).items() if name not in changed}
    text = f"{sorted(map(checksum, called))} {told(held, method.__module__)}"
    return hashlib.sha256(text.encode()).hexdigest()


def _methods(kind: type, f: FunctionType) -> set[FunctionType]:
    """A method and those of its class that it names, theirs, and so on: they may write into the object as well."""
    found, todo = set(), [f]
    while todo:
        g = todo.pop()
        if g not in found:
            found.add(g)
            named = [
                getattr(kind, name, None) for code in fingerprint.codes(g.__code__) for name in code.co_names
            ]
            todo += [h for h in named if isinstance(h, FunctionType)]
    return found


def _attributes(x: Any) -> dict[str, Any]:
    """Those of an object, in its slots as well."""
    state: Any = object.__getstate__(x)
    parts = state if isinstance(state, tuple) else (state,)
    return {name: value for part in parts for name, value in (part or {}).items()}


def read_values(f: FunctionType) -> list[str]:
    """What f reads from around it, but functions, which are told by their own sources, and what it writes into."""
    inner = [name for name in fingerprint.names_read(f.__code__) if "." in name]
    named = {name: fingerprint.member(f, name) for name in inner}  # lists and the like in a module
    named = {name: x for name, x in named.items() if isinstance(x, HOLDERS)}
    named |= dict([*fingerprint.values_read(f), *fingerprint.cells(f)])
    texts = {}
    for name, x in named.items():
        if hasattr(x, "py_func"):
            continue
        texts[name] = fingerprint.value_text(x)
        if fingerprint.UNKNOWN in texts[name]:
            known = isinstance(x, HOLDERS) or _own(x, f.__module__)
            texts[name] = (
                told(x, f.__module__) if known and name.split(".")[0] not in written(f.__code__) else ""
            )
    return sorted(f"{name}={text}" for name, text in texts.items() if text)


def told(x: Any, module: str, within: tuple[int, ...] = ()) -> str:
    """What a value holds, as a text that is the same in every process; of objects of other modules their class."""
    text = fingerprint.value_text(x)
    if fingerprint.UNKNOWN not in text:
        return text
    kind, inside = type(x).__qualname__, (*within, id(x))
    if id(x) in within:
        return kind
    if isinstance(x, np.ndarray):
        return f"{kind} {x.shape} {told(x.tolist(), module, inside)}"
    if isinstance(x, Mapping):
        return f"{kind} {sorted((str(k), told(y, module, inside)) for k, y in x.items())}"
    if isinstance(x, (list, tuple)):
        return f"{kind} {[told(y, module, inside) for y in x]}"
    if isinstance(x, (set, frozenset)):
        return f"{kind} {sorted(told(y, module, inside) for y in x)}"
    if _own(x, module):
        return f"{kind} {told(_attributes(x), module, inside)}"
    return kind


def _own(x: Any, module: str) -> bool:
    """Whether it is an object of which all attributes are told."""
    return is_dataclass(x) or isinstance(x, SimpleNamespace) or type(x).__module__ == module


@functools.cache
def written(code: CodeType) -> frozenset[str]:
    """Names of what code writes into or may change by a method, and of attributes that it sets."""
    try:
        nodes = ast.walk(ast.parse(source_of(code)))
    except SyntaxError:  # the line of a lambda, cut out of what is around it: it cannot set anything
        return frozenset()
    return frozenset(name for node in nodes for name in _written_by(node))


def _written_by(node: ast.AST) -> Iterator[str]:
    """The same of one part of its text."""
    if isinstance(node, (ast.Global, ast.Nonlocal)):
        yield from node.names
    place: Any = None
    if isinstance(node, (ast.Subscript, ast.Attribute)) and not isinstance(node.ctx, ast.Load):
        place = node
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr not in READS:
        place = node.func.value
    while isinstance(place, (ast.Subscript, ast.Attribute)):
        if isinstance(place, ast.Attribute):
            yield place.attr
        place = place.value
    if isinstance(place, ast.Name):
        yield place.id


def plain_source(f: FunctionType) -> str:
    """The source as Python reads it, without comments; byte code where there is none."""
    text = source_of(f.__code__)
    if not text:
        return fingerprint.code_text(f)
    try:
        return ast.unparse(ast.parse(text))
    except SyntaxError:  # the line of a lambda, cut out of what is around it
        return text


def whole_source(f: FunctionType) -> str:
    """The function and those that it calls, for a reader."""
    others = sorted(fingerprint.reached(f) - {f}, key=lambda g: g.__qualname__)
    return "\n".join(source_of(g.__code__) for g in (f, *others))


@functools.cache
def source_of(code: CodeType) -> str:
    """Its text; empty where nobody has kept it, or its file has been edited since it was read."""
    try:
        now = compile("".join(inspect.findsource(code)[0]), code.co_filename, "exec", dont_inherit=True)
    except (OSError, TypeError, ValueError, SyntaxError):
        return ""
    return textwrap.dedent(inspect.getsource(code)) if code in fingerprint.codes(now) else ""
