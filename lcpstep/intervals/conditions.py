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

    __rand__, __ror__ = __and__, __or__


def sides(x: Any) -> tuple[Any, Any]:
    """Where x certainly holds and where it certainly does not."""
    return (x.yes, x.no) if isinstance(x, Condition) else (np.bool_(x), ~np.bool_(x))
