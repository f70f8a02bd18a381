"""How models go into files and to other processes: numbers stay read-only, functions go by name.

Python's `pickle` does not take a function along but its name, under which the other side must find it again. A
lambda or a function made inside another has no such name, and pickle's own message names neither the callback nor
its place: `Pickled` does. `copy`, and picklers that take the code of functions along, are left to do so.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from dataclasses import fields
from functools import partial
from types import FunctionType, MappingProxyType
from typing import Any, cast

import numpy as np

from lagrangian.derived import Derived, derived_from

BY_VALUE = ("copy", "cloudpickle", "dill")  # modules that need no name of a function


class Pickled:
    """Base of frozen dataclasses that hold a user's numbers and functions."""

    def __getstate__(self) -> dict[str, Any]:
        """The fields, fit for pickle."""
        kept = {x.name: getattr(self, x.name) for x in fields(cast(Any, self))}
        return {name: _outgoing(f"{type(self).__name__}.{name}", x) for name, x in kept.items()}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        """Take the fields over as they were; they have been checked when the object was made."""
        for name, x in state.items():
            object.__setattr__(self, name, _incoming(x))


class ReadOnly(dict[str, Any]):
    """On the way: a mapping that was read-only and becomes so again."""


def _outgoing(name: str, x: Any) -> Any:
    """A field as pickle takes it; PicklingError names one whose function has no name to be found by."""
    if isinstance(x, MappingProxyType):
        return ReadOnly(x)
    f = x
    while isinstance(f, partial):
        f = f.func
    if not isinstance(f, FunctionType):
        return x
    derived = derived_from(f)
    if derived is not None and f is x:
        return derived
    if _found(f.__module__, f.__qualname__) is not f and not any(module in BY_VALUE for module in _callers()):
        from pickle import PicklingError

        where = f"{f.__code__.co_filename}, line {f.__code__.co_firstlineno}"
        raise PicklingError(
            f"{name}: {f.__qualname__!r} ({where}) cannot be pickled, for no other process finds it by that name; "
            "write it as a function of its own at the top of a module, and what it takes from around it into p"
        )
    return x


def _incoming(x: Any) -> Any:
    """The field that was sent."""
    if isinstance(x, ReadOnly):
        return MappingProxyType(dict(x))
    if isinstance(x, Derived):
        return x.function()
    parts = (
        [x]
        if isinstance(x, np.ndarray)
        else [getattr(x, part, None) for part in ("data", "indices", "indptr")]
    )
    for part in parts:  # of an array, or of a sparse matrix
        if isinstance(part, np.ndarray):
            part.flags.writeable = False
    return x


def _found(module: str, name: str) -> Any:
    """What a name stands for in a module; None where there is none."""
    x: Any = sys.modules.get(module)
    for part in name.split("."):
        x = getattr(x, part, None)
    return x


def _callers() -> Iterator[str]:
    """Packages whose functions are being run."""
    frame = sys._getframe(1)
    while frame is not None:
        yield frame.f_globals.get("__name__", "").partition(".")[0]
        frame = frame.f_back  # type: ignore[assignment]
