"""The motion of a mechanism between events, as a field that the Runge-Kutta method follows."""

from __future__ import annotations

from typing import Any

import cython

if not cython.compiled:
    from lcpstep.events.general.held import right_hand_side
    from lcpstep.events.general.step import missed
    from lcpstep.events.general.switching import SWITCHES
    from lcpstep.events.hybrid.state import Motion
    from lcpstep.events.rows.held import size_of_pushes
    from lcpstep.kernels.rungekutta import RungeKutta
    from lcpstep.pointers import Doubles


class Smooth(RungeKutta):
    """Y = (q, v) with the rows held of a mechanism, which is given to it after both have been made."""

    mechanism: Any

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Dy = (v, v'); False where it is not finite or the rows have become dependent."""
        return right_hand_side(self.mechanism, t, y, dy)

    def rate_terms(self) -> float:
        """Of what the rows held push with."""
        return size_of_pushes(self.mechanism)

    def miss(self, t: float, tau: float) -> float:
        """By the gap of the contact that meets its surface."""
        return missed(self.mechanism, tau)


class Watched(Motion):
    """The same of a system with modes, whose guards are watched along it."""

    mechanism: Any

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Dy = (v, v') in the mode at hand; as above."""
        return right_hand_side(self.mechanism, t, y, dy)

    def rate_terms(self) -> float:
        """As above."""
        return size_of_pushes(self.mechanism)

    def miss(self, t: float, tau: float) -> float:
        """By the guard that acts, or as above."""
        if self.mechanism.event_kind == SWITCHES:
            return Motion.miss(self, t, tau)
        return missed(self.mechanism, tau)
