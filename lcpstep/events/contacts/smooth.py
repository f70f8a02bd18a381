"""The motion of a system with contacts between events, as a field that the Runge-Kutta method follows."""

from __future__ import annotations

import cython

from lcpstep.events.contacts.held import right_hand_side
from lcpstep.events.contacts.loose import straying_seen
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.step import step
from lcpstep.events.rows.held import size_of_pushes
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles, after


class Smooth(Rubbing):
    """Y = (q, v) with the rows of the modes held."""

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Dy = (v, v'); False where it is not finite, or the rows cannot be held."""
        if not right_hand_side(self, t, y, dy):
            return False
        copy(after(self.loads, self.stage * self.n_r), self.multiplier, self.n_r)
        return True

    def rate_terms(self) -> float:
        """Of what the rows held push with, where their forces are sought at each state."""
        return 0.0 if self.constant else size_of_pushes(self.rows)

    def proceed(self) -> int:
        """A step that meets the tolerance, up to the first event within it; a status."""
        return step(self)

    def straying_at(self, place: float, h: float, level: float) -> int:
        """The first contact of which a row has left its rest at that fraction of the step, or -1: by dense output."""
        self.at(place, self.seen)
        return straying_seen(self, self.rows.t0 + place * h, level)
