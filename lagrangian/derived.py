"""Modules of callbacks that were derived (`lagrangian.symbolic`): their source is all that they are.

A module is named by the content of its source, by which the machine code of its functions is found again; and it is
made again from its source wherever a pickled scene needs it.
"""

from __future__ import annotations

import linecache
import sys
from dataclasses import dataclass
from types import FunctionType, ModuleType
from typing import Any

PREFIX = "lagrangian_derived_"
DIGITS = 20
SOURCE = "SOURCE"  # under which a module knows its own source


@dataclass(frozen=True)
class Derived:
    """A derived callback on its way to another process."""

    source: str
    name: str

    def function(self) -> FunctionType:
        """The callback."""
        found: FunctionType = getattr(load(self.source), self.name)
        return found


def derived_from(f: FunctionType) -> Derived | None:
    """How a derived callback goes to another process; None for a function that is none."""
    source = f.__globals__.get(SOURCE) if f.__module__.startswith(PREFIX) else None
    return None if source is None else Derived(source, f.__name__)


def load(source: str) -> Any:
    """The source as a module; tracebacks and debuggers show its lines."""
    import hashlib

    name = PREFIX + hashlib.sha256(source.encode()).hexdigest()[:DIGITS]
    if name not in sys.modules:
        module, file = ModuleType(name), f"<{name}>"
        vars(module)[SOURCE] = source
        exec(compile(source, file, "exec"), vars(module))
        linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
        sys.modules[name] = module
    return sys.modules[name]
