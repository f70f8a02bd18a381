"""The gap of one linear degree of freedom in closed form above a flat obstacle, as a kernel.

    y = rest + C exp(-delta tau) cos(w tau - phi) + S cos(Omega t - psi),   |y^(n)| <= C w0^n + S Omega^n,  w0^2 = w2

for delta >= 0, so that the state at the start of a flight bounds its acceleration. Of a body without a spring and a
damper the first term is a parabola. Other motions are left to `motion.Oscillation`.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt
from typing import Any

import cython

from lcpstep.audit.cells import Cells
from lcpstep.audit.clear import Gap
from lcpstep.audit.limits import SLACK
from lcpstep.events.flight.motion import Flight, absolute
from lcpstep.pointers import abs, nan


class Swing(Gap):
    """The gap of a flight in closed form.

    amplitude   of the oscillation that is left of a flight, a bound from its start on; with `most`, how large the
        numbers are that its positions are made of, `bound` and `middle`, between which and beyond G y'' does not go,
        and `damped`, which a damper's part of it does not exceed;  root : of w2
    fast        the largest velocity of what moves by itself
    alone       whether the obstacle rests in the frame: the gap is known without asking for either
    low, high   bounds of G y'' in the piece at hand;  met : what rounding makes of what moves there
    left, right    how long the gap is known to part from zero at both ends;  begin_above, end_above : `place` then
    y, w        absolute state last asked for (`stand`)
    wave_at, cosine, sine   of Omega t at the time last asked for;  frame_at, shift, drag : the frame at such a time

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
        self.amplitude, self.cosine, self.sine, self.wave_at = 0.0, 1.0, 0.0, nan
        self.y = self.w = self.shift = self.drag = 0.0
        self.frame_at = nan
        self.left = self.right = self.begin_above = self.end_above = 0.0
        self.middle, self.turning = 0.0 if self.swings else s.G * s.f0, s.Omega * s.Omega * self.forced
        self.most, self.bound = 0.0, (1.0 + SLACK) * abs(s.G) * self.turning
        self.alone, self.low, self.high, self.met = not motion.given, 0.0, 0.0, 0.0
        self.damped = 0.0
        self.root = sqrt(s.w2) if self.swings else 0.0
        self.fast = self.cells.whole_fast[0] + abs(s.G * s.Omega) * self.forced

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        absolute(self.s, tau)
        self.place, self.bend = self.s.offset + self.s.G * self.s.y_tau, self.s.G * self.s.a_tau

    def stand(self, t: float, q: float, v: float) -> None:
        """The absolute state at time t, from that relative to the frame."""
        if self.frame.given and t != self.frame_at:
            self.frame.fill(t, self.q, self.v, self.moving)
            self.frame_at, self.shift, self.drag = t, self.moving[0], self.moving[1]
        self.y, self.w = q + self.shift, v + self.drag

    def begin(self, t: float, q: float, v: float) -> None:
        """A flight begins at time t with this state."""
        if self.swings:
            self.stand(t, q, v)
            turn(self, t)
            z = self.y - self.s.X * self.cosine - self.s.Y * self.sine - self.height
            rate = self.w - self.s.Omega * (self.s.Y * self.cosine - self.s.X * self.sine)
            rate = (rate + self.s.delta * z) * self.per_root
            self.amplitude = (1.0 + SLACK) * sqrt(z * z + rate * rate)
            self.most = self.amplitude + self.forced + abs(self.height)
            self.bound = (1.0 + SLACK) * abs(self.s.G) * (self.s.w2 * self.amplitude + self.turning)
            self.damped = 2.0 * self.s.delta * abs(self.s.G) * self.root * self.amplitude


def turn(g: Swing, t: float) -> None:
    """Where the force is in its turn: g.cosine and g.sine; those last asked for are still there."""
    if g.s.Omega != 0.0 and t != g.wave_at:
        g.wave_at, g.cosine, g.sine = t, cos(g.s.Omega * t), sin(g.s.Omega * t)


def driven(g: Swing, t: float) -> tuple[float, float]:
    """G F(t), and its rate over Omega."""
    if g.s.Omega == 0.0:
        return 0.0, 0.0
    turn(g, t)
    fc, fs = g.s.G * g.s.fc, g.s.G * g.s.fs
    return fc * g.cosine + fs * g.sine, fs * g.cosine - fc * g.sine
