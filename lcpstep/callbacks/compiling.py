"""The user's functions in machine code, so that nothing written into them can harm the process.

Indices are checked, the arrays that q, v and p come in are read-only, and an exception leaves `out` not-a-number and
is noted (`lcpstep.callbacks.faults`). What cannot be compiled runs in plain Python, where numpy checks the same.

Nothing here imports numba before something is compiled.
"""

from __future__ import annotations

import functools
import inspect
import os
import re
import warnings
from collections.abc import Hashable
from types import CodeType, FunctionType, MethodType
from typing import Any, cast
from weakref import WeakSet

import numpy as np

from lcpstep.callbacks import NoCompiler, NotCompiled, UncompiledCallback, built, fingerprint, functions
from lcpstep.callbacks.faults import Callback, name_of

SECOND_ORDER, FIRST_ORDER = 5, 4  # arguments of f(t, q, v, p, out) and f(t, x, p, out)
OPTIONS = {"error_model": "numpy", "boundscheck": True}
# Numba reads and writes through these without looking at the length of the array: `boundscheck` does not reach into
# its own implementations of functions of numpy
UNCHECKED = {
    "flat", "take_along_axis", "carray", "farray", "as_strided", "bincount", "delete", "getitem_unchecked",
}  # fmt: skip
TOLD: WeakSet[Any] = WeakSet()  # functions that a warning was given for
REGISTRY: dict[Any, Any] = {}  # the warnings themselves, as Python remembers them
MADE: dict[Any, Any] = {}  # C functions by what they were made from
STARRED = inspect.CO_VARARGS | inspect.CO_VARKEYWORDS
PLACE = re.compile(r'File "(.+)", line (\d+)|(?:at|from) (\S+) \((\d+)\)')  # as numba names it
COLOURS = re.compile(r"\x1b\[[0-9;]*m")
ENCLOSED = re.compile(r"= freevar\((\w+):")
HEADINGS = ("Failed in nopython mode", "- Resolution failure for")  # of numba's pages, above what went wrong
AGAIN = re.compile(r"(?:,? defined at|\. Raised from) \S+ \(\d+\)$")  # the place, which is told anyway
FAILED: dict[Any, NotCompiled] = {}  # what cannot be made


def address(f: Callback, ndim: int) -> int:
    """Address of callback f(t, q, v, p, out) as a C function, for an `out` of ndim dimensions.

    Its signature is that of `lcpstep.kernels.function`. Raises NotCompiled where it cannot be compiled.
    """
    return built.address(f) or int(_made(f, SECOND_ORDER, ndim).address)


def first_order_address(f: Callback) -> int:
    """The same of a function f(t, x, p, out) of a first-order system."""
    return built.address(f) or int(_made(f, FIRST_ORDER, 1).address)


def disabled() -> bool:
    """Whether the environment asks for plain Python (`NUMBA_DISABLE_JIT=1`)."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def warn(what: str, f: Callback, why: NotCompiled) -> None:
    """Say, once for each function, that it cannot be compiled, where in it, and why."""
    told = NoCompiler if isinstance(why, NoCompiler) else f  # which concerns all functions alike
    if isinstance(told, Hashable):
        if told in TOLD:
            return
        TOLD.add(told)
    message = f"{what} cannot be compiled and runs in plain Python: {why}"
    if isinstance(why, NoCompiler):
        message = (
            f"{why.reason}: functions that were not built with the library run in plain Python, {what} first"
        )
    warnings.warn_explicit(message, UncompiledCallback, why.file, why.line, registry=REGISTRY)


def _made(f: Callback, takes: int, ndim: int) -> Any:
    """C function of a callback, made once."""
    function = _function(f, takes)
    depends = fingerprint.dependencies(function)
    # Where nobody can tell whether a value has changed, the function itself must be the same
    key = takes, ndim, depends, function if fingerprint.UNKNOWN in depends else None
    if key in MADE:
        return MADE[key]
    kind = takes, ndim, frozenset(map(_make, fingerprint.reached(function)))
    if kind in FAILED:
        raise FAILED[kind]
    try:
        MADE[key] = _machine_code(function, takes, ndim)
    except NotCompiled as why:
        FAILED[kind] = why
        raise
    return MADE[key]


def _function(f: Any, takes: int) -> FunctionType:
    """A plain function that does what f does, and takes so many arguments and no others."""
    functions.require(f)
    given: tuple[Any, ...] = ()
    keywords: dict[str, Any] = {}
    if isinstance(f, functools.partial):
        f, given, keywords = f.func, f.args, f.keywords
    f = getattr(f, "py_func", f)
    if not isinstance(f, FunctionType):
        kind = "a method" if isinstance(f, MethodType) else f"an object of class {type(f).__name__}"
        home = getattr(f, "__func__", None) or type(f).__call__
        raise _unfit(home, f"{name_of(f)} is {kind}, and only functions are compiled")
    code = f.__code__
    exactly = (code.co_argcount, code.co_kwonlyargcount) == (takes, 0) and not code.co_flags & STARRED
    if exactly and not given and not keywords:
        return f
    user = _with_defaults(f, keywords) if keywords or code.co_kwonlyargcount else f
    enter = _enter if takes == SECOND_ORDER else _enter_first_order
    known = {"user": user, "given": given, "__name__": __name__}  # what is kept on disk belongs to a module
    return FunctionType(enter.__code__, known, f.__name__)


def _enter(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Call a function with more arguments: given ones before these, or ones with a default after them."""
    user(*given, t, q, v, p, out)  # type: ignore[name-defined]  # noqa: F821


def _enter_first_order(t: float, x: Any, p: Any, out: Any) -> None:
    user(*given, t, x, p, out)  # type: ignore[name-defined]  # noqa: F821


def _with_defaults(f: FunctionType, keywords: dict[str, Any]) -> FunctionType:
    """Function f with other defaults, and none of its arguments by keyword only, which numba cannot call."""
    code, takes = f.__code__, f.__code__.co_argcount + f.__code__.co_kwonlyargcount
    names = code.co_varnames[:takes]
    if code.co_flags & STARRED or not keywords.keys() <= set(names):
        raise _unfit(f, f"{f.__name__} takes any arguments by keyword")
    positional = dict(zip(names[: code.co_argcount][::-1], (f.__defaults__ or ())[::-1], strict=False))
    defaults = positional | (f.__kwdefaults__ or {}) | keywords
    values = tuple(defaults[name] for name in names if name in defaults)
    code = code.replace(co_argcount=takes, co_kwonlyargcount=0)
    return FunctionType(code, f.__globals__, f.__name__, values, f.__closure__)


def _unfit(f: Any, reason: str) -> NotCompiled:
    code = getattr(f, "__code__", None)
    return NotCompiled(reason, *((code.co_filename, code.co_firstlineno) if code else ("<unknown>", 0)))


def _machine_code(f: FunctionType, takes: int, ndim: int) -> Any:
    """C function of f."""
    try:
        from lcpstep.callbacks.guarded import signature
    except ImportError as error:
        code = f.__code__
        reason = f"numba cannot be imported ({error})"
        raise NoCompiler(reason, code.co_filename, code.co_firstlineno) from error
    for g in fingerprint.reached(f):
        called = {getattr(x, "__name__", "") for x in _read(g)}  # by whatever name they were imported
        if unchecked := UNCHECKED & (_names(g) | called):
            raise _unfit(g, f"numba does not check the indices of {min(unchecked)!r}")
        if "objmode" in _names(g):
            raise _unfit(g, f"{g.__name__} goes back to Python by objmode")
        if g.__code__.co_flags & inspect.CO_VARKEYWORDS:  # numba fails without a word
            raise _unfit(g, f"{g.__name__} takes any arguments by keyword")
        if any(g in fingerprint.reached(callee) for _, callee in fingerprint.callees(g)):
            raise _unfit(g, f"{g.__name__} calls itself")
    prints = any("print" in _names(g) for g in fingerprint.reached(f))  # which makes arrays of its own
    try:
        return _compiled(f, signature(takes - 2, ndim), nrt=prints)
    except Exception:  # numba's errors share no base class
        try:
            return _compiled(f, signature(takes - 2, ndim), nrt=True)
        except Exception as error:
            entered = f.__code__ in (_enter.__code__, _enter_first_order.__code__)
            raise _explained(error, (f.__globals__["user"] if entered else f).__code__) from error


def _names(f: FunctionType) -> set[str]:
    """Names of globals and attributes in the code of f."""
    return {name for code in fingerprint.codes(f.__code__) for name in code.co_names}


def _compiled(f: FunctionType, arguments: tuple[Any, ...], nrt: bool) -> Any:
    """C function of f, with numba's counting of references where f makes arrays or lists; that takes longer."""
    from lcpstep.callbacks.guarded import Guarded, Wrapped, array
    from lcpstep.callbacks.machine_code import OnDisk

    options = OPTIONS | {"_nrt": nrt}
    parts = Wrapped.create_cfunc_wrapper, array
    wrapper = " ".join(fingerprint.code_text(cast(FunctionType, part)) for part in parts)
    copy = _twin(f, nrt, f"callback {options} {wrapper}")
    c_function: Any = Guarded(copy, arguments, options)
    inner = any(isinstance(x, FunctionType) or hasattr(x, "py_func") for _, x in fingerprint.cells(f))
    if not inner and fingerprint.UNKNOWN not in fingerprint.dependencies(
        f
    ):  # what it reads cannot change unseen
        c_function._cache = OnDisk(copy)
    c_function.compile()
    return c_function


def _twin(f: FunctionType, nrt: bool, variant: str) -> FunctionType:
    """A copy of f whose callees are compiled, with a name of its own."""
    twins = {g: _callee(g, nrt, fingerprint.dependencies(g)) for _, g in fingerprint.callees(f)}
    return fingerprint.with_twins(f, twins, f"{variant} {fingerprint.dependencies(f)}")


@functools.cache
def _callee(f: FunctionType, nrt: bool, dependencies: str) -> Any:
    """A function that callbacks call, its indices checked as theirs; made anew where what it reads has changed."""
    import numba

    from lcpstep.callbacks.guarded import CalleeCompiler

    options = OPTIONS | {"nogil": True, "_nrt": nrt, "pipeline_class": CalleeCompiler}
    return numba.njit(**options)(_twin(f, nrt, f"callee {OPTIONS} {nrt}"))


def _read(f: FunctionType) -> list[Any]:
    """What f reads from around it."""
    names = fingerprint.global_names(f)
    return [f.__globals__.get(name) for name in names] + [x for _, x in fingerprint.cells(f)]


def _make(f: FunctionType) -> Any:
    """What compiling depends on mostly, so that functions made over and over are not tried over and over."""
    return f.__code__, *map(_kind, _read(f))


def _kind(x: Any) -> Any:
    """The same of what a function reads."""
    if isinstance(x, tuple):
        return type(x), *map(_kind, x)
    return (x.dtype.str, x.ndim) if isinstance(x, np.ndarray) else getattr(x, "__code__", type(x))


def _explained(error: Exception, code: CodeType) -> NotCompiled:
    """From numba's pages of explanation: the reason, and the line that it names last."""
    text = COLOURS.sub("", str(error)) or type(error).__name__
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    said = [line for line in lines if not line.startswith(HEADINGS)] or lines
    reason = AGAIN.sub("", said[0])
    enclosed = ENCLOSED.search(text)
    if enclosed and "object at 0x" in reason:  # numba names a part of its own
        reason = f"it reads {enclosed[1]!r} from the function around it, which is no number, array or tuple"
    shown_call = next((line[3:].strip() for line in said if line.startswith(">>>")), "")
    if reason.endswith("signature:") and shown_call:
        reason = f"no compiled form of {shown_call}"
        if "(readonly array" in shown_call and "Cannot modify readonly array" in text:
            reason = "it writes into an array that it may only read (q, v, p and global arrays)"
    places = [(a or c, int(b or d)) for a, b, c, d in PLACE.findall(text)]
    own = [line for file, line in places if os.path.basename(file) == os.path.basename(code.co_filename)]
    return NotCompiled(reason, code.co_filename, own[-1] if own else code.co_firstlineno)
