"""A user's functions in a file: what they are and a checksum of it, never their code to be run.

A function counts as the same where its source without comments, that of all functions that it calls, and the values
that they read are the same. One without a source (typed into a terminal) is told by its byte code, which belongs to a
version of Python.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib
import inspect
import textwrap
from dataclasses import dataclass
from types import CodeType, FunctionType
from typing import Any

from lcpstep import fingerprint
from lcpstep.errors import LcpStepError

OWN = ("lagrangian.scenes.", "lagrangian.profiles")  # where functions are taken from by their name alone


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
        raise LcpStepError(f"{self.name}: {self.reason}")


def require(f: Any) -> None:
    """LcpStepError for a function that did not come with its file, before a run begins that needs it."""
    if isinstance(f, Absent):
        f()


def described(f: Any) -> dict[str, str]:
    """Name, source and checksum of a function; an object that is called has no checksum."""
    if isinstance(f, Absent):
        return {"function": f.name, "source": f.source, "sha256": f.sha256}
    plain = getattr(f, "py_func", f)
    if not isinstance(plain, FunctionType):
        return {"function": f"an object of class {type(f).__name__}", "source": "", "sha256": ""}
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


def read_values(f: FunctionType) -> list[str]:
    """What f reads from around it, but functions, which are told by their own sources."""
    named = [*fingerprint.values_read(f), *fingerprint.cells(f)]
    texts = ((name, fingerprint.value_text(x)) for name, x in named if not hasattr(x, "py_func"))
    return sorted(f"{name}={text}" for name, text in texts if not text.startswith(fingerprint.UNKNOWN))


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
