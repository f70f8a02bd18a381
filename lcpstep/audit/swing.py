"""The gap of one linear degree of freedom in closed form above a flat obstacle, as a kernel.

    y = rest + C exp(-delta tau) cos(w tau - phi) + S cos(Omega t - psi),   |y^(n)| <= C w0^n + S Omega^n,  w0^2 = w2

for delta >= 0, so that the state at the start of a flight bounds its acceleration. Of a body without a spring and a
damper the first term is a parabola. Other motions are left to `motion.Oscillation`.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.audit.limits import SLACK

if not cython.compiled:
    from math import cos, hypot, sin, sqrt

    from lcpstep.audit.cells import Cells
    from lcpstep.audit.clear import Gap
    from lcpstep.events.flight.motion import Flight, absolute, steady
    from lcpstep.pointers import abs, nan


class Swing(Gap):
    """The gap of a flight in closed form.

    amplitude   of the oscillation that is left of a flight, a bound from its start on; with `most`, how large the
        numbers are that its positions are made of, `bound` and `middle`, between which and beyond G y'' does not go
    fast        the largest velocity of what moves by itself
    left, right    how long the gap is known to part from zero at both ends;  begin_above, end_above : `place` then
    force_at, force    a time, and the force over the mass then, times G, as it was last asked for

    Parameters
    ----------
    cells, motion, frame, state, limits : see `Gap`;  s : Flight
    """

    def __init__(self, cells: Cells, motion: Any, frame: Any, state: Any, limits: Any, s: Flight) -> None:
        Gap.__init__(self, cells, motion, frame, [s.G], state, limits)
        self.s = s
        self.swings = s.w2 > s.delta * s.delta and s.delta >= 0.0
        self.known = self.swings or (s.w2 == 0.0 and s.delta == 0.0)
        self.forced = hypot(s.X, s.Y)
        self.height = s.f0 / s.w2 if self.swings else 0.0
        self.per_root = 1.0 / sqrt(s.w2 - s.delta * s.delta) if self.swings else 0.0
        self.amplitude, self.force, self.force_at = 0.0, 0.0, nan
        self.left = self.right = self.begin_above = self.end_above = 0.0
        self.middle, self.turning = 0.0 if self.swings else s.G * s.f0, s.Omega * s.Omega * self.forced
        self.most, self.bound = 0.0, (1.0 + SLACK) * abs(s.G) * self.turning
        self.fast = self.cells.whole_fast[0] + abs(s.G * s.Omega) * self.forced

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        absolute(self.s, tau)
        self.place, self.bend = self.s.offset + self.s.G * self.s.y_tau, self.s.G * self.s.a_tau

    def size(self, z: float, w: float) -> float:
        """How large an oscillation is that has this place and velocity."""
        rate = (w + self.s.delta * z) * self.per_root
        return sqrt(z * z + rate * rate)

    def begin(self, t: float, y: float, w: float) -> None:
        """A flight begins at time t with this absolute state."""
        if self.swings:
            rest, rate = steady(self.s, t)
            self.amplitude = (1.0 + SLACK) * self.size(y - rest - self.height, w - rate)
            self.most = self.amplitude + self.forced + abs(self.height)
            self.bound = (1.0 + SLACK) * abs(self.s.G) * (self.s.w2 * self.amplitude + self.turning)


def driven(s: Flight, t: float) -> tuple[float, float]:
    """G F(t), and its rate over Omega."""
    if s.Omega == 0.0:
        return 0.0, 0.0
    c, q = cos(s.Omega * t), sin(s.Omega * t)
    return s.G * (s.fc * c + s.fs * q), s.G * (s.fs * c - s.fc * q)
