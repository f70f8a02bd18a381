"""An impact of `Located`, as kernels: the impulses (`impulses`), and state and gaps made to agree after it."""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gaps
from lcpstep.kernels.linear import grow_factor
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.status import DONE, LCP_FAILED, NOT_FINITE
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, abs, after, max
from lcpstep.stepping.pieces.codes import CORNER, GROUND, OPEN
from lcpstep.stepping.pieces.impulses import strike, zero_speeds
from lcpstep.stepping.pieces.keep import keep_event
from lcpstep.stepping.pieces.magnitudes import speed_terms, velocity_of, with_terms
from lcpstep.stepping.pieces.smooth import push_held, renew_forces, renew_mobility
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import count_turn, idle, stick


def event(m: Model, plan: Plan, w: Work, c: int) -> int:
    """The impact of contact c at w.sigma, or that of a corner, and what it changes."""
    now = w.t_step + w.sigma
    if c != CORNER and take_touch(m, plan, w, c, now, 0.0):
        return DONE
    if not renew_mobility(m, plan, w, now):
        return NOT_FINITE
    n_s = strike(m, plan, w, c, now)
    if n_s <= 0:
        idle(w)
        return LCP_FAILED if n_s < 0 else DONE
    if plan.plain:  # rounding of the state must not add up over many impacts
        for k in range(n_s):
            d = w.chosen[k]
            lift(w, w.q, d, -height(m, w, d))
            straighten(m, w, d)
        if n_s > 1:
            straighten_all(m, w, n_s)
        zero_speeds(w, w.v_try)
    if not renew_forces(m, plan, w, now):
        return NOT_FINITE
    keep_event(w, now)
    return DONE


def take_touch(m: Model, plan: Plan, w: Work, c: int, t: float, slow: float) -> bool:
    """Take contact c, whose gap is zero at t, as a touch if it does not strike; whether it was one.

    It stays closed if it rises no faster than `slow`, or by no more than rounding.
    """
    still = NOISE * speed_terms(plan, w, c)
    if not w.velocity[c] >= -still:
        return False
    w.gap[c], w.grounded[c] = 0.0, GROUND
    if w.velocity[c] <= still or w.velocity[c] <= slow:
        stick(w, c, t)
        count_turn(m, plan, w, c, 0.0, False)
    idle(w)
    return True


def lift(w: Work, x: Doubles, c: int, distance: float) -> None:
    """Move x, which is q or v, along M^-1 G_c^T so that G_c x grows by the distance."""
    W = product(w.G, after(w.MG, c * w.n_q), c, w.n_q)
    if W > 0.0:
        for i in range(w.n_q):
            x[i] += w.MG[c * w.n_q + i] * distance / W


def straighten(m: Model, w: Work, d: int) -> None:
    """The velocities that gap d has left with, and the gap velocities of the contacts in flight that go with them.

    Without the latter the rounding of the Delassus matrix acts the same way at every impact: at a mass ratio of 1e12
    it turns the motion by a ten-thousandth. Gap velocities finer than the velocities resolve stay as they are.
    """
    error = w.velocity[d] - product(m.G, w.v, d, w.n_q)
    if error == 0.0 or not w.W[d * w.n_c + d] > 0.0:
        return
    lift(w, w.v, d, error)
    for c in range(w.n_c):
        if w.status[c] == OPEN and w.grounded[c] == 0:
            change = w.W[c * w.n_c + d] * error / w.W[d * w.n_c + d]
            if abs(change) <= NOISE * abs(w.velocity[c]):
                w.velocity[c] += change


def straighten_all(m: Model, w: Work, n_s: int) -> None:
    """State and gaps of the contacts struck at once, together: put right one by one, each spoils those before it."""
    for level in range(2):
        x = w.q if level == 0 else w.v
        worst = size = 0.0
        for k in range(n_s):
            d = w.chosen[k]
            w.residual[k] = height(m, w, d) if level == 0 else product(m.G, w.v, d, w.n_q) - w.velocity[d]
            worst = max(worst, abs(w.residual[k]))
            for i in range(w.n_q):
                size = max(size, abs(m.G[d * w.n_q + i] * x[i]))
        if worst > NOISE * size:
            put_right(w, x, n_s)


def straighten_struck(m: Model, w: Work, t: float, n_s: int) -> None:
    """State and gaps of any contacts, struck at t: the velocities that they have left with, and places of several.

    One by one these would turn the rounding of impulses that depend on each other over and over, into a tumble: a
    block that falls flat on three feet.
    """
    if n_s > 1:
        gaps(m, t, w.q, w.v, w.gap_try)
        for k in range(n_s):
            w.residual[k] = w.gap_try[w.chosen[k]]
        put_right(w, w.q, n_s)
    for k in range(n_s):
        d = w.chosen[k]
        w.residual[k] = velocity_of(w, d) - w.velocity[d]
    put_right(w, w.v, n_s)


def put_right(w: Work, x: Doubles, n_s: int) -> None:
    """Take what `residual` says is left in the chosen contacts, the independent ones, out of x, which is q or v."""
    n_k = 0
    for k in range(n_s):
        w.held[n_k] = w.chosen[k]
        if grow_factor(w.W, w.n_c, w.problem, w.n_c, w.held, w.doubt, n_k):
            w.change[n_k] = -w.residual[k]
            n_k += 1
    push_held(w, w.MG, w.n_c, n_k, x)


def height(m: Model, w: Work, c: int) -> float:
    """The gap c of a flat contact at rest, from the coordinates."""
    return product(m.G, w.q, c, w.n_q) + m.offset[c]


def remeasure(m: Model, plan: Plan, w: Work) -> None:
    """Gaps of open contacts well off their obstacles and their velocities from the state, where they have drifted.

    They are carried on from piece to piece beside it; what rounding makes of each impact adds up where no impact of
    their own puts them right.
    """
    for c in range(w.n_c):
        if w.status[c] == OPEN and w.grounded[c] == 0 and w.gap[c] > plan.slack:
            g, place = with_terms(w, m.G, c, w.q, m.offset[c])
            u, speed = with_terms(w, m.G, c, w.v, 0.0)
            if g > plan.slack and abs(g - w.gap[c]) > NOISE * place:
                w.gap[c] = g
            if abs(u - w.velocity[c]) > NOISE * speed:
                w.velocity[c] = u
