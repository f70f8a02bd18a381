"""Scenes of one's own in files: `lcpstep simulate my_scene.py` runs what its function `scene()` returns."""

from __future__ import annotations

import importlib.util
import inspect
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

from lagrangian import HybridScene, Scene
from lcpstep.errors import LcpStepError, UnknownName

FUNCTION = "scene"
ENDING = ".py"
READ: dict[tuple[Path, int], ModuleType] = {}


def is_file(name: str) -> bool:
    """Whether a scene is named by a file."""
    return name.endswith(ENDING)


def maker(file: str | Path) -> Callable[..., Any]:
    """The function `scene` of a file, which is run for it.

    Raises
    ------
    LcpStepError   there is no such file, it fails, or it has no such function
    """
    path = Path(file)
    if not path.is_file():
        raise LcpStepError(
            f"scene: there is no file {str(file)!r}; lcpstep new {path.stem} writes one to start from"
        )
    made = getattr(_module(path), FUNCTION, None)
    if not callable(made):
        raise LcpStepError(
            f"scene: {path.name} has no function {FUNCTION}(); lcpstep new NAME writes an example of one"
        )
    return made


def known_parameters(make: Callable[..., Any]) -> dict[str, Any]:
    """Parameters of a scene's function with their defaults."""
    given = inspect.signature(make).parameters.values()
    return {p.name: p.default for p in given if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)}


def made(file: str | Path, values: Mapping[str, Any], t_end: float | None = None) -> Scene | HybridScene:
    """The scene of a file with these parameters, up to a time.

    Raises
    ------
    UnknownName   a parameter that the function does not take
    LcpStepError   the function fails, or returns no scene; the message names the line
    """
    make = maker(file)
    known = known_parameters(make)
    for name in values:
        if name not in known:
            raise UnknownName(f"parameter of {Path(file).name}", name, known)
    if t_end is not None and "t_end" in known:
        values = {**values, "t_end": t_end}
    found = _attempt(Path(file), lambda: make(**values))
    if not isinstance(found, (Scene, HybridScene)):
        raise LcpStepError(
            f"scene: {FUNCTION}() of {Path(file).name} is to return a lagrangian.Scene, not {found!r}"
        )
    if t_end is not None and "t_end" not in known:
        found = replace(found, t_span=(found.t_span[0], t_end))
    return found


def _module(path: Path) -> ModuleType:
    """The file as a module, which finds its neighbours, and whose functions other processes find by its name.

    It is read once, and again where it has changed.
    """
    key = path.resolve(), path.stat().st_mtime_ns
    if key not in READ:
        READ[key] = _executed(path)
    return READ[key]


def _executed(path: Path) -> ModuleType:
    folder, name = str(path.resolve().parent), path.stem
    if name in sys.modules and getattr(sys.modules[name], "__file__", None) != str(path.resolve()):
        name = f"{name}_scene"
    spec = importlib.util.spec_from_file_location(name, path.resolve())
    if spec is None or spec.loader is None:
        raise LcpStepError(f"scene: {path.name} cannot be read as Python")
    module = importlib.util.module_from_spec(spec)
    if folder not in sys.path:
        sys.path.append(folder)
    sys.modules[name] = module
    loader = spec.loader
    _attempt(path, lambda: loader.exec_module(module))
    return module


def _attempt(path: Path, what: Callable[[], Any]) -> Any:
    """Run something of the user's; LcpStepError with the line of the file where it fails."""
    try:
        return what()
    except (LcpStepError, KeyboardInterrupt):
        raise
    except BaseException as error:  # also what calls sys.exit
        own = [x for x in traceback.extract_tb(error.__traceback__) if Path(x.filename).name == path.name]
        line = (
            getattr(error, "lineno", None)
            if isinstance(error, SyntaxError)
            else own[-1].lineno
            if own
            else None
        )
        where = f"{path.name}, line {line}" if line else path.name
        raise LcpStepError(f"scene: {where}: {type(error).__name__}: {error}") from error
