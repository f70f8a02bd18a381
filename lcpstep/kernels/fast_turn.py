"""Where a gap turns within a step of a finished run, as looks ahead from some of its states show; see `fast_gaps`.

From a state the gap is followed straight on, as far as a step goes and a little beyond. It turns fast where it bends
so much, by h^2 |g''| / 8, that it has to come back within the step: its line through both ends is left by far less.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import gap_rates, gaps, mass, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import size_of_product
from lcpstep.pointers import Doubles, abs, after, max, min, whole
from lcpstep.shelf import Shelf

NEAR = 1.0 / 64.0  # of a step: of the differences
FASTER = 10.0  # than a step
PLAIN, LEAST_SHARE = 1e-2, 1e-4  # of the gap there, and of all looked at: how far it leaves its line
ROUNDING = 1e-12  # of the coordinates, and of the way that the obstacle goes in the time since zero


class Looks:
    """Looks ahead from states of a run, spread over it by the golden ratio.

    m, t, q, v      the model and the run, its states (count, n_q);  mean  its mean step
    k, share, h     the look at hand: after which state, where in the step, and how long that is
    g, bent         (looks, n_c)   gaps at all looks, and by how much they bend within a step
    largest         (n_c,)   of each gap
    start, end, other, x, G, force     gaps (n_c,), a place, normals and forces for a while

    Parameters
    ----------
    m : Model;  t, q, v : of the run;  steps : taken by it;  looks : how many;  golden : the ratio, less one
    """

    def __init__(self, m: Model, t: Any, q: Any, v: Any, steps: int, looks: int, golden: float) -> None:
        n_c, n_q = m.n_c, m.n_q
        self.m, self.looks, self.golden, self.count = m, looks, golden, len(t)
        work = np.zeros((2 * looks + 4) * n_c + n_q * (n_c + n_q + 2))
        self.kept = t, q, v, work
        self.t, self.q, self.v = doubles(t), doubles(q), doubles(v)
        self.mean = (t[-1] - t[0]) / steps
        x = Shelf(work)
        self.g, self.bent, self.largest = x.take(looks * n_c), x.take(looks * n_c), x.take(n_c)
        self.start, self.end, self.other = x.take(n_c), x.take(n_c), x.take(n_c)
        self.x, self.G = x.take(n_q), x.take(n_q * n_c)
        self.force = x.rest
        self.k, self.share, self.h = 0, 0.0, 0.0


def first_turn(
    m: Model, t: Any, q: Any, v: Any, steps: int, looks: int, golden: float, faster: float = FASTER
) -> tuple[int, int]:
    """The first of so many looks at a run at which a gap turns so much faster than a step, and which gap.

    Returns
    -------
    look and contact; -1 and 0 where there is none
    """
    found = find(Looks(m, t, q, v, steps, looks, golden), faster)
    return (found // m.n_c, found % m.n_c) if found >= 0 else (-1, 0)


@cython.cfunc
def find(s: Looks, faster: float) -> int:
    """Kernel of `first_turn`."""
    with cython.nogil:
        for i in range(s.looks):
            look(s, i)
        for j in range(s.looks * s.m.n_c):
            if turns(s, j // s.m.n_c, j % s.m.n_c, faster):
                return j
    return -1


def look(s: Looks, i: int) -> None:
    """Gaps at look i, and by how much they bend within the step."""
    n, g = s.m.n_c, after(s.g, i * s.m.n_c)
    go_to(s, i)
    ahead(s, s.share - NEAR, s.start)
    ahead(s, s.share, g)
    ahead(s, s.share + NEAR, s.end)
    for c in range(n):
        s.bent[i * n + c] = abs(s.start[c] - 2.0 * g[c] + s.end[c]) / (8.0 * NEAR * NEAR)
        s.largest[c] = max(s.largest[c], abs(g[c]))


def turns(s: Looks, i: int, c: int, faster: float) -> bool:
    """Whether gap c bends by more at look i than it leaves its line through the ends of the step, or around it."""
    bent = s.bent[i * s.m.n_c + c]
    if not bent > faster * LEAST_SHARE * s.largest[c]:
        return False
    go_to(s, i)
    ahead(s, 0.0, s.start)
    ahead(s, 1.0, s.end)
    slope = s.end[c] - s.start[c]
    left = abs(s.g[i * s.m.n_c + c] - s.start[c] - s.share * slope)
    most = max(LEAST_SHARE * s.largest[c], PLAIN * min(abs(s.start[c]), abs(s.end[c])))
    if not (left > most and bent > faster * left and left > rounding(s, c)):
        return False
    for place in range(-2, 4):  # steps after the state, besides the ends of its own
        if place < 0 or place > 1:
            ahead(s, place, s.other)
            if not bent > faster * abs(s.other[c] - s.start[c] - place * slope):
                return False
    return True


def rounding(s: Looks, c: int) -> float:
    """How far rounding may lead gap c off its line.

    At rest near zero the coordinates are themselves rounding, of what forces that cancel make in a step.
    """
    n, t, pushed = s.m.n_q, s.t[s.k], 0.0
    q, v, M = after(s.q, s.k * n), after(s.v, s.k * n), after(s.force, n)
    gap_rates(s.m, t, q, v, s.G, s.other)
    total_force(s.m, t, q, v, s.force)
    mass(s.m, t, q, v, M)
    size = abs(s.other[c] * t) + size_of_product(s.G, q, c, n)
    for j in range(n):  # as if no coordinate moved another one
        pushed += abs(s.G[c * n + j] * s.force[j] / M[j * n + j])
    return ROUNDING * (size + s.h * s.h * pushed)


def go_to(s: Looks, i: int) -> None:
    """Make look i that at hand: one in each part of the run, at a place of its own."""
    part = i * s.golden
    at = (i + (part - whole(part))) / (s.looks + 1) * (s.count - 1)
    s.k = whole(at)
    s.share, s.h = at - s.k, min(s.t[s.k + 1] - s.t[s.k], s.mean)


def ahead(s: Looks, share: float, g: Doubles) -> None:
    """Every gap on the straight line from the state, so much of its step later; times stay within the run."""
    n, length = s.m.n_q, share * s.h
    q, v = after(s.q, s.k * n), after(s.v, s.k * n)
    for j in range(n):
        s.x[j] = q[j] + length * v[j]
    gaps(s.m, min(max(s.t[s.k] + length, s.t[0]), s.t[s.count - 1]), s.x, v, g)
