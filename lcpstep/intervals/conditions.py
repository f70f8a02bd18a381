"""Comparisons of intervals, which hold in some windows, fail in others, and are open in the rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.intervals.paths import current


class Condition:
    """A comparison: where it certainly holds, and where it certainly does not."""

    def __init__(self, yes: Any, no: Any) -> None:
        self.yes, self.no = yes, no

    def __bool__(self) -> bool:
        """One way or the other: see `paths`."""
        paths = current()
        yes, no = paths.spread(self.yes), paths.spread(self.no)
        return bool(paths.choose([(True, ~no), (False, ~yes)]))

    def __and__(self, other: Any) -> Condition:
        """Both."""
        yes, no = sides(other)
        return Condition(self.yes & yes, self.no | no)

    def __or__(self, other: Any) -> Condition:
        """At least one."""
        yes, no = sides(other)
        return Condition(self.yes | yes, self.no & no)

    def __invert__(self) -> Condition:
        """The opposite."""
        return Condition(self.no, self.yes)

    def __xor__(self, other: Any) -> Condition:
        """One of them alone."""
        yes, no = sides(other)
        return Condition((self.yes & no) | (self.no & yes), (self.yes & yes) | (self.no & no))

    def __eq__(self, other: Any) -> Condition:  # type: ignore[override]
        """Whether both hold or both do not; another number than True and False is neither."""
        if isinstance(other, Condition) or other in (True, False):
            return ~(self ^ other)
        return Condition(np.bool_(False), np.bool_(True))

    def __ne__(self, other: Any) -> Condition:  # type: ignore[override]
        return ~(self == other)

    __hash__ = None  # type: ignore[assignment]

    def __mul__(self, other: Any) -> Any:
        """A number where it holds, and zero of it where it does not."""
        return NotImplemented if isinstance(other, Condition) else other * float(bool(self))

    __rand__, __ror__, __rxor__, __rmul__ = __and__, __or__, __xor__, __mul__


def sides(x: Any) -> tuple[Any, Any]:
    """Where x certainly holds and where it certainly does not."""
    return (x.yes, x.no) if isinstance(x, Condition) else (np.bool_(x), ~np.bool_(x))
