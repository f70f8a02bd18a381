"""A user's functions in plain Python, also those that the user has compiled: numpy checks all indices."""

from __future__ import annotations

from collections.abc import Iterator
from types import CellType, FunctionType, ModuleType
from typing import Any

LIBRARIES = {"numpy", "scipy", "math", "numba", "builtins"}  # they call nothing of the user's


def python(f: Any) -> Any:
    """A callback that neither is compiled by its user nor calls what is; f itself where nothing is."""
    return _plain(f, {})


def _plain(x: Any, made: dict[Any, Any]) -> Any:
    """X without anything compiled; `made` has the functions so far, which may call each other."""
    if not _compiled(x, set()):
        return x
    if isinstance(x, ModuleType):
        return Members(x, made)
    f = getattr(x, "py_func", x)
    return made[f] if f in made else _copy(f, made)


def _compiled(x: Any, seen: set[Any]) -> bool:
    """Whether x is compiled by its user, or a function that calls what is, or a module that holds such."""
    if isinstance(getattr(x, "py_func", None), FunctionType):
        return True
    name = x.__name__ if isinstance(x, ModuleType) else getattr(x, "__module__", None) or ""
    if x.__class__ not in (FunctionType, ModuleType) or name.partition(".")[0] in LIBRARIES or x in seen:
        return False
    seen.add(x)
    if isinstance(x, ModuleType):
        return any(isinstance(getattr(y, "py_func", None), FunctionType) for y in vars(x).values())
    return any(_compiled(y, seen) for y in [*_globals(x).values(), *_cells(x)])


def _copy(f: FunctionType, made: dict[Any, Any]) -> FunctionType:
    """Function f with plain functions around it."""
    around, closure = dict(f.__globals__), tuple(CellType() for _ in f.__closure__ or ())
    copy = made[f] = FunctionType(f.__code__, around, f.__name__, f.__defaults__, closure or None)
    copy.__kwdefaults__ = f.__kwdefaults__
    around.update({name: _plain(x, made) for name, x in _globals(f).items()})
    for cell, x in zip(closure, _cells(f), strict=True):
        cell.cell_contents = _plain(x, made)
    return copy


def _globals(f: FunctionType) -> dict[str, Any]:
    """Globals that f may read."""
    return {name: f.__globals__[name] for name in f.__code__.co_names if name in f.__globals__}


def _cells(f: FunctionType) -> Iterator[Any]:
    """Values of the function around f that f reads."""
    return (cell.cell_contents for cell in f.__closure__ or ())


class Members:
    """In the place of a module: what it holds, without anything compiled."""

    def __init__(self, module: ModuleType, made: dict[Any, Any]) -> None:
        self._module, self._made = module, made

    def __getattr__(self, name: str) -> Any:
        """One of them."""
        return _plain(getattr(self._module, name), self._made)
