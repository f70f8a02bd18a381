"""Packages whose names are imported from their modules when they are first asked for (PEP 562)."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any


def lazily(package: dict[str, Any], names: dict[str, str]) -> Callable[[str], Any]:
    """`__getattr__` of a package.

    Parameters
    ----------
    package : `globals()` of the package, which keeps what has been imported
    names : those that each module gives the package; all others are names of modules. None may be both
    """
    name_of_it = package["__name__"]
    home = {name: module for module, given in names.items() for name in given.split()}

    def found(name: str) -> Any:
        if name in home:
            package[name] = getattr(import_module(home[name]), name)
            return package[name]
        module = f"{name_of_it}.{name}"
        try:
            return import_module(module)
        except ModuleNotFoundError as error:
            if error.name != module:
                raise
            raise AttributeError(f"module {name_of_it!r} has no attribute {name!r}") from None

    return found
