"""What the catalogue says of a scene: how to make it, what goes wrong on it, and what its answer is."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lagrangian.scene import Scene


@dataclass(frozen=True)
class Entry:
    """A scene of the catalogue.

    Attributes
    ----------
    make : function of the scene's parameters, all with defaults, that returns the scene
    hazard : what usually goes wrong, in one line
    answer : what is known of the motion exactly, or checkable without a solver, in one line
    """

    make: Callable[..., Scene]
    hazard: str
    answer: str

    @property
    def about(self) -> str:
        """What moves, in one line: the first of the function's docstring."""
        return (inspect.getdoc(self.make) or "").splitlines()[0]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters that are numbers or words, with their default values."""
        given = inspect.signature(self.make).parameters.values()
        return {p.name: p.default for p in given if isinstance(p.default, (int, float, str))}
