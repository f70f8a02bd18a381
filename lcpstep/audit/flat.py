"""Gaps of flat contacts over windows: g = offset + G y - sigma(t), of any linear coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.audit.anchors import Anchors
from lcpstep.audit.limits import TIMES
from lcpstep.audit.motion import Oscillation
from lcpstep.audit.obstacle import Obstacle
from lcpstep.audit.polynomials import Polynomials
from lcpstep.audit.windows import Seen, Windows
from lcpstep.intervals import Interval
from lcpstep.kernels.model import Model

Array = NDArray[np.float64]
ROUNDING = 1e-14  # of the numbers that a gap is the difference of


def own(error: Any, k: Any) -> Any:
    """The absolute error of every coordinate in the pieces k, (n, n_q) or one for all."""
    return error[k] if np.ndim(error) else error


class Flat:
    """Flat contacts and a computed motion.

    why   what moves cannot be evaluated on intervals, or ""

    Parameters
    ----------
    scene : Scene;  m : Model;  motion : Oscillation or Polynomials
    error : (absolute, relative)   of the positions; the first may be (m, n_q), one for each piece and coordinate
    drift : (m, n_q)   how much of it steps have added up, or None
    """

    def __init__(
        self, scene: Scene, m: Model, motion: Oscillation | Polynomials, cuts: Array, error: tuple[Any, float],
        drift: Array | None = None,
    ) -> None:  # fmt: skip
        self.G, self.offset, self.motion, self.error = m.arrays["G"], m.arrays["offset"], motion, error
        self.why, self.drift = "", drift
        self.anchors: Anchors | None = None
        self.obstacle = Obstacle(scene, m, motion.absolute, cuts)
        self.linear = m

    def seen(self, w: Windows, *, rough: bool) -> Seen:
        """Bounds over windows."""
        if np.all(w.closed):
            return self.pressed(w, rough=rough)
        G = self.G[w.c]
        along, y_a, y_b = self.motion.along(G, w.k, w.a, w.b)
        offset = self.offset[w.c]
        size = self.motion.size(G, w.k) + np.abs(offset)
        at_a, at_b = y_a + offset, y_b + offset
        gap, speed, curve = along.place + Interval(offset, offset), along.speed, along.curve
        fast = along.speed.size
        smooth = np.ones(len(w.a), dtype=bool)
        if self.obstacle.moves:
            s, branched = self.obstacle.bounds(w.c, w.a, w.b, rough=rough)
            gap, speed, curve = gap - s.place, speed - s.speed, curve - s.curve
            s_a, s_b = self.obstacle.values(w.c, w.a), self.obstacle.values(w.c, w.b)
            size = size + np.maximum(np.abs(s_a), np.abs(s_b))
            at_a, at_b, smooth = at_a - s_a, at_b - s_b, ~branched
            fast = fast + s.speed.size
        absolute = np.sum(np.abs(G) * own(self.error[0], w.k), axis=1)
        rounding = ROUNDING * size
        rounding += TIMES * np.maximum(np.abs(w.a), np.abs(w.b)) * np.where(fast < np.inf, fast, 0.0)
        error = absolute + self.error[1] * size + rounding
        computed = error if self.drift is None else error - np.sum(np.abs(G) * self.drift[w.k], axis=1)
        if self.anchors is not None and not rough:  # most windows do without
            error = np.minimum(error, np.sum(np.abs(G) * self.anchors.errors(w, size), axis=1) + rounding)
        slow = ROUNDING * speed.size
        return Seen(gap.lo, speed.lo, speed.hi, curve.lo, curve.hi, at_a, at_b, error, slow, smooth, computed)

    def looked(self, k: Any, c: Any, t: Array) -> tuple[Array, float]:
        """Gaps of contacts c at times in the pieces k, and how far they may be off."""
        G = self.G[c]
        g = self.motion.place(G, k, t) + self.offset[c]
        if self.obstacle.moves:
            g = g - self.obstacle.values(c, t)
        size = np.max(self.motion.size(G, k) + np.abs(self.offset[c]), initial=0.0)
        absolute = np.max(np.sum(np.abs(G) * own(self.error[0], k), axis=1), initial=0.0)
        return g, float(absolute + (self.error[1] + ROUNDING) * size)

    def pressed(self, w: Windows, *, rough: bool) -> Seen:
        """Of one closed contact: what presses it, as if that were the gap, -(G y'' - sigma'') on the obstacle."""
        assert isinstance(self.motion, Oscillation)
        o, n = self.motion.o, len(w.a)
        G, offset, m = self.G[0, 0], self.offset[0], self.linear
        force: Any = Interval(np.full(n, G * o.f0 + o.w2 * offset), np.full(n, G * o.f0 + o.w2 * offset))
        if o.Omega != 0.0:
            angle = o.Omega * Interval(w.a, w.b)
            cosine, sine = (float(m.arrays[x][0] / m.arrays["M"][0, 0]) for x in ("cosine", "sine"))
            force = force + (G * cosine) * angle.cos() + (G * sine) * angle.sin()
        if self.obstacle.moves:
            s, _ = self.obstacle.bounds(w.c, w.a, w.b, rough=rough)
            force = force - s.speed * (2.0 * o.delta) - s.place * o.w2 - s.curve
        p = -force
        unknown = np.full(n, np.inf)
        error = ROUNDING * p.size
        return Seen(
            p.lo,
            -unknown,
            unknown,
            -unknown,
            unknown,
            p.hi,
            p.hi,
            error,
            error,
            np.zeros(n, dtype=bool),
            error,
        )
