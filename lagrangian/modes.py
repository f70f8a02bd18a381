"""Modes of a system with a discrete state, the guards that leave them, the surfaces between them; see `hybrid`."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from lagrangian.pickling import Pickled

Function = Callable[[float, Any, Any, Any], Any]  # f(t, x, p, out), fills out, returns None
RISING, FALLING, BOTH = 1, -1, 0


@dataclass(frozen=True, eq=False)
class Guard(Pickled):
    """When a mode is left, and for which.

    Parameters
    ----------
    value : function filling out (1,)   the guard function
    target : name of the mode entered
    direction : 1 where it rises through zero (default), -1 where it falls, 0 for either
    reset : function filling out (n_x,) with the state after the switch, or None where the state stays
    at_once : whether the mode is left immediately when it is entered with the guard already passed
        True (default) for "while the value is below zero, stay"; False for a guard that must be crossed. A guard
        of direction 0 is always of the second kind.
    """

    value: Function
    target: str
    direction: int = RISING
    reset: Function | None = None
    at_once: bool = True

    def __post_init__(self) -> None:
        if not callable(self.value):
            raise ValueError(f"guard.value: expected a function f(t, x, p, out), got {self.value!r}")
        if not isinstance(self.direction, Hashable) or self.direction not in (RISING, FALLING, BOTH):
            raise ValueError(f"guard.direction: expected 1, -1 or 0, got {self.direction!r}")
        if self.reset is not None and not callable(self.reset):
            raise ValueError(f"guard.reset: expected a function f(t, x, p, out) or None, got {self.reset!r}")


@dataclass(frozen=True, eq=False)
class Mode(Pickled):
    """A vector field, and the guards that leave it; of guards reached at one time the first acts.

    Parameters
    ----------
    field : function filling out (n_x,)   x' = field(t, x, p)
    guards : the guards of this mode
    """

    field: Function
    guards: Sequence[Guard] = ()

    def __post_init__(self) -> None:
        if not callable(self.field):
            raise ValueError(f"mode.field: expected a function f(t, x, p, out), got {self.field!r}")
        object.__setattr__(self, "guards", _guards("mode.guards", self.guards))


@dataclass(frozen=True, eq=False)
class Surface(Pickled):
    """A switching surface H(t, x) = 0 between two modes, on which the motion may slide.

    Parameters
    ----------
    value : function filling out (1,)   H
    below, above : names of the modes for H < 0 and H > 0
    sliding : name of the mode of sliding
    guards : guards that leave the sliding mode, besides its end and other surfaces of the modes beside it
    """

    value: Function
    below: str
    above: str
    sliding: str = "sliding"
    guards: Sequence[Guard] = ()

    def __post_init__(self) -> None:
        if not callable(self.value):
            raise ValueError(f"surface.value: expected a function f(t, x, p, out), got {self.value!r}")
        if self.below == self.above:
            raise ValueError(f"surface: expected two different modes, got {self.below!r} on both sides")
        object.__setattr__(self, "guards", _guards("surface.guards", self.guards))


def _guards(name: str, values: Any) -> tuple[Guard, ...]:
    """Guards in a tuple."""
    guards = tuple(values) if isinstance(values, Iterable) else (values,)
    if not all(isinstance(guard, Guard) for guard in guards):
        raise TypeError(f"{name}: expected guards in a list, got {values!r}")
    return guards
