"""Gaps of any form over windows: the scene's callbacks on intervals of time and state."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.audit.anchors import Anchors
from lcpstep.audit.flat import own
from lcpstep.audit.motion import Bounds
from lcpstep.audit.polynomials import Polynomials
from lcpstep.audit.windows import Seen, Windows
from lcpstep.intervals import Interval, NotEnclosed, enclose
from lcpstep.kernels import states
from lcpstep.kernels.model import Model

Array = NDArray[np.float64]
ROUNDING = 1e-14


class Curved:
    """Contacts with g(t, q) and a computed motion.

    why   the gap cannot be evaluated on intervals, or ""

    Parameters
    ----------
    scene : Scene;  m : Model;  motion : Polynomials
    error : (absolute, relative)   of the positions; the first may be (m, n_q), one for each piece and coordinate
    drift : (m, n_q)   how much of it steps have added up, or None
    """

    def __init__(
        self,
        scene: Scene,
        m: Model,
        motion: Polynomials,
        error: tuple[Any, float],
        drift: Array | None = None,
    ) -> None:
        self.scene, self.m, self.motion, self.error, self.why = scene, m, motion, error, ""
        self.drift = drift
        self.anchors: Anchors | None = None
        contacts: Any = scene.contacts
        bound, self.contacts = contacts.lipschitz, contacts
        self.bound = None if bound is None else np.asarray(bound, dtype=float)
        self.p, self.n_c, self.n_q = np.array(scene.p), scene.n_c, scene.n_q

    def seen(self, w: Windows, *, rough: bool) -> Seen:
        """Bounds over windows."""
        boxes, q_a, q_b = self.motion.boxes(w.k, w.a, w.b)
        at_a, at_b = self.values(w.a, q_a, w.c), self.values(w.b, q_b, w.c)
        n, rows = len(w.a), np.arange(len(w.a))
        nothing = np.full(n, -np.inf)
        size = np.max(np.abs(np.concatenate([q_a, q_b], axis=1)), axis=1)
        state = own(self.error[0], w.k) + self.error[1] * np.repeat(size[:, None], self.n_q, axis=1)
        limit = None if self.bound is None else self.bound[w.c]
        if limit is not None or self.why:  # no more is asked for, or known
            low, high = (nothing, -nothing) if limit is None else (-limit, limit)
            smooth, worst = np.full(n, limit is not None), state.max(axis=1)
            return Seen(nothing, nothing, -nothing, low, high, at_a, at_b, worst, np.zeros(n), smooth, worst)
        slack = [Interval(x.place.lo - e, x.place.hi + e) for x, e in zip(boxes, state.T, strict=True)]
        try:
            gap, G, rate, curve, smooth = self.enclosed(w, slack, boxes)
        except NotEnclosed as why:
            self.why = str(why)
            return self.seen(w, rough=rough)
        speed, error = rate, ROUNDING * (size + np.abs(at_a) + np.abs(at_b))
        drifted, near = np.zeros(n), error
        known = None if rough else self.anchors  # most windows do without
        beside = state if known is None else known.errors(w, size)
        # A gradient without a bound, as in a disc's centre, tells nothing
        with np.errstate(invalid="ignore"):
            for i in range(self.n_q):
                g = Interval(G[0][rows, w.c, i], G[1][rows, w.c, i])
                speed = speed + g * boxes[i].speed
                error = error + g.size * state[:, i]
                near = near + g.size * beside[:, i]
                if self.drift is not None:
                    drifted += g.size * self.drift[w.k, i]
            slow, computed = ROUNDING * speed.size, error - drifted
        error = np.minimum(error, near)
        return Seen(gap.lo, speed.lo, speed.hi, curve.lo, curve.hi, at_a, at_b, error, slow, smooth, computed)

    def lowest(self, a: Array, b: Array, lo: Array, hi: Array) -> Array:
        """Lower bounds (n, n_c) of all gaps over windows [a, b] and boxes of the state (n, n_q); -inf: none."""
        q = [Interval(x, y) for x, y in zip(lo.T, hi.T, strict=True)]
        v = [Interval(np.full(len(a), -np.inf), np.full(len(a), np.inf))] * self.n_q
        try:
            found = enclose(self.contacts.gap, Interval(a, b), q, v, self.p, (self.n_c,))
        except NotEnclosed:  # smaller windows may pass
            return np.full((len(a), self.n_c), -np.inf)
        size = np.maximum(np.abs(lo), np.abs(hi)).max(axis=1)
        return np.asarray(found.lo - ROUNDING * (size[:, None] + np.abs(found.hi)))

    def enclosed(self, w: Windows, q: list[Interval], boxes: list[Bounds]) -> Any:
        """Gap, Jacobian, rate and acceleration, and where the last is one, by the callbacks on intervals."""
        c, t, v = self.contacts, Interval(w.a, w.b), [x.speed for x in boxes]
        rows = np.arange(len(w.a))

        def of(f: Any, *shape: int) -> Any:
            return enclose(f, t, q, v, self.p, shape)

        gap, G = of(c.gap, self.n_c), of(c.jacobian, self.n_c, self.n_q)
        rate: Any = Interval(np.zeros(len(rows)), np.zeros(len(rows)))
        smooth = ~(gap.branched | G.branched)
        if c.gap_t is not None:
            g_t = of(c.gap_t, self.n_c)
            rate, smooth = Interval(g_t.lo[rows, w.c], g_t.hi[rows, w.c]), smooth & ~g_t.branched
        unknown = np.full(len(rows), np.inf)
        curve: Any = Interval(-unknown, unknown)
        if c.bias is not None:
            bias = of(c.bias, self.n_c)
            curve, smooth = Interval(bias.lo[rows, w.c], bias.hi[rows, w.c]), smooth & ~bias.branched
            for i in range(self.n_q):
                curve = curve + Interval(G.lo[rows, w.c, i], G.hi[rows, w.c, i]) * boxes[i].curve
        else:
            smooth = np.zeros(len(rows), dtype=bool)
        return Interval(gap.lo[rows, w.c], gap.hi[rows, w.c]), (G.lo, G.hi), rate, curve, smooth

    def looked(self, k: Any, c: Any, t: Array) -> tuple[Array, float]:
        """Gaps of contacts c at times in the pieces k, and how far they may be off."""
        q = self.motion.windows(k, t, t)[:, 0]
        return self.values(t, q, c), float(
            np.max(self.error[0]) + self.error[1] * np.max(np.abs(q), initial=1.0)
        )

    def values(self, t: Array, q: Array, c: Any) -> Array:
        """Gaps of contacts c at times and positions."""
        every = states.gaps_at(self.m, np.ascontiguousarray(t), np.ascontiguousarray(q))
        return np.asarray(every[np.arange(len(t)), c])
