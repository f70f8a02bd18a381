"""A user's functions in plain Python, also those that the user has compiled: numpy checks all indices.

While a callback runs here, whatever numba has made of a function runs as the Python that it was made of, however the
callback comes to it: by its name, a module, a class, a dictionary, an import. What has no Python that could take its
place is refused by name. All but callbacks call machine code as ever.
"""

from __future__ import annotations

import functools
import sys
import threading
import weakref
from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

JITCLASS = "numba.experimental.jitclass"
TYPED = "numba.typed."
BOXES = "numba.experimental.jitclass.boxing"  # module of the objects of compiled classes
LOCK = threading.RLock()  # what is collected may be so within


class Unchecked(TypeError):
    """What numba has compiled, where it checks no index and there is no Python to run in its place."""

    def __init__(self, name: str, maker: str) -> None:
        super().__init__(
            f"{name!r} is made by {maker}, in whose machine code no index is checked; functions that numba.njit or "
            "numba.vectorize has made are taken"
        )


class Unavailable(Exception):
    """Raised in the place of a function that is not at hand: it has not failed, whatever it is asked for."""


def source(f: Any) -> Any:
    """The Python function inside one that its user has compiled; f itself where it is no such function."""
    inside = getattr(f, "py_func", None)
    return inside if isinstance(inside, FunctionType) else f


def in_order(name: str, f: Any, names: tuple[str, ...]) -> None:
    """ValueError for a function that takes arguments of these names in another order: it would get others."""
    code = getattr(source(f), "__code__", None)
    taken = code.co_varnames[: code.co_argcount] if code is not None else ()
    if taken != names and sorted(taken) == sorted(names):
        raise ValueError(f"{name}: expected f({', '.join(names)}), got f({', '.join(taken)})")


def python(f: Any) -> Callable[..., Any]:
    """A callback that runs in Python alone."""
    f, in_python = source(f), InPython()

    @functools.wraps(f, updated=())
    def plain(*given: Any) -> Any:
        with in_python:
            return f(*given)

    return plain


class Depth(threading.local):
    """How many callbacks a thread is in."""

    depth = 0


class InPython:
    """What this thread calls within runs in Python, whoever has compiled it; `with` takes it again and again.

    From the first time on, as long as this is there, calls of machine code look whether a callback calls them.
    """

    def __init__(self) -> None:
        self.begun: list[Replaced] = []
        self.seen = (0, 0)  # modules and classes there were
        weakref.finalize(self, _end, self.begun).atexit = False

    def __enter__(self) -> None:
        boxes = _specialized()
        if self.seen != (len(sys.modules), len(boxes)):  # something has been imported since
            self.seen = (len(sys.modules), len(boxes))
            with LOCK:
                for x in [*REPLACED, *map(_boxed, boxes.values())]:
                    if x not in self.begun and x.found():
                        x.begin()
                        self.begun.append(x)
        LOCAL.depth += 1

    def __exit__(self, *what: object) -> None:
        LOCAL.depth -= 1


def _end(begun: list[Replaced]) -> None:
    with LOCK:
        for x in begun:
            x.end()


class Replaced:
    """A method of a class of numba's that is another one in callbacks, as long as somebody needs it.

    Parameters
    ----------
    module, name : of the class, which is looked at only where it has been imported
    instead : f(usual, x, arguments, keywords) in the place of usual(x, *arguments, **keywords), which is the method
    method : its name
    """

    def __init__(self, module: str, name: str, instead: Callable[..., Any], method: str = "__call__") -> None:
        self.module, self.name, self.instead, self.method = module, name, instead, method
        self.users = 0
        self.cls: Any = None
        self.own: Any = None

    def found(self) -> bool:
        """Whether the class has been imported."""
        self.cls = self.cls or getattr(sys.modules.get(self.module), self.name, None)
        return self.cls is not None

    def begin(self) -> None:
        """For one more."""
        self.users += 1
        if self.users == 1:
            self.own = vars(self.cls).get(self.method)
            setattr(self.cls, self.method, self._replacement(getattr(self.cls, self.method)))

    def end(self) -> None:
        """For one less: after the last the class is as numba has made it."""
        self.users -= 1
        if self.users == 0 and self.own is None:
            delattr(self.cls, self.method)
        elif self.users == 0:
            setattr(self.cls, self.method, self.own)

    def _replacement(self, usual: Callable[..., Any]) -> Callable[..., Any]:
        """In the place of the class's own, which serves all but callbacks."""

        def method(x: Any, *given: Any, **named: Any) -> Any:
            return self.instead(usual, x, given, named) if LOCAL.depth else usual(x, *given, **named)

        return method


def _specialized() -> dict[Any, type]:
    """The classes of the objects of compiled classes, as numba keeps them."""
    found: dict[Any, type] = getattr(sys.modules.get(BOXES), "_cache_specialized_box", {})
    return found


def _boxed(cls: type) -> Replaced:
    """Whatever is read from an object of a compiled class is machine code."""
    if cls not in BOXED:
        BOXED[cls] = Replaced(BOXES, cls.__name__, _refused(JITCLASS), "__getattribute__")
        BOXED[cls].cls = cls
    return BOXED[cls]


def _by_python(usual: Callable[..., Any], f: Any, given: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """A function of `numba.njit`; typed lists and dictionaries look at indices themselves, and have no Python."""
    if f.py_func.__module__.startswith(TYPED):
        return usual(f, *given, **named)
    return f.py_func(*given, **named)


def _one_by_one(_: Callable[..., Any], f: Any, given: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """A function of `numba.vectorize`, which takes numbers and arrays, and maybe one to fill after these."""
    inside = f._dispatcher.py_func
    takes = inside.__code__.co_argcount
    filled = (*given[takes:], *(named.pop("out", None) or ()))
    values = np.frompyfunc(inside, takes, 1)(*given[:takes], **named)
    if isinstance(values, np.ndarray):
        values = np.array(values.tolist()) if values.size else values.astype(float)
    if not filled:
        return values
    filled[0][...] = values
    return filled[0]


def name_of(x: Any) -> str:
    """What the user calls something that numba has made."""
    if type(x).__module__ == BOXES:
        return type(x).__name__
    inside = getattr(getattr(x, "kernel_ir", None), "func_id", None)  # of a stencil, which has no name
    return str(getattr(x, "__name__", None) or getattr(inside, "func_name", type(x).__name__))


def _refused(maker: str) -> Callable[..., Any]:
    """In the place of what cannot be replaced."""

    def refuse(_: Callable[..., Any], x: Any, *__: Any) -> Any:
        raise Unchecked(name_of(x), maker)

    return refuse


LOCAL = Depth()
REPLACED = [
    Replaced("numba.core.dispatcher", "Dispatcher", _by_python),
    Replaced("numba.np.ufunc.dufunc", "DUFunc", _one_by_one),
    Replaced("numba.np.ufunc.gufunc", "GUFunc", _refused("numba.guvectorize")),
    Replaced("numba.stencils.stencil", "StencilFunc", _refused("numba.stencil")),
    Replaced("numba.experimental.jitclass.base", "JitClassType", _refused(JITCLASS)),
]
BOXED: dict[type, Replaced] = {}
