"""Impacts of `Located`: their impulses. How sequences of them end is in `sequences`.

    0 <= u+ + r min(u-, 0)   complementary to  p >= 0   the contacts that fire, and the closed ones that a chain of
                                                        contacts connects with them

Sources: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); G. Osorio, Complex
Behavior in Impacting Systems, eq. 4.2.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import ACCUMULATION, IMPACT
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.together import CROSSED, gap_rounding, moment_untold, order_matters
from lcpstep.kernels.vectors import clear
from lcpstep.pointers import Doubles, abs, inf, max, min
from lcpstep.stepping.pieces.chosen import solve_chosen
from lcpstep.stepping.pieces.codes import CLOSED, CORNER, GROUND, INERTIA, LEFT, OPEN, STOPS
from lcpstep.stepping.pieces.corners import choose_jumping
from lcpstep.stepping.pieces.magnitudes import LEAST, speed_terms, velocity_of
from lcpstep.stepping.pieces.refine import NONE
from lcpstep.stepping.pieces.sequences import (
    IN_A_ROW,
    MANY_AT_ONCE,
    at_this_instant,
    choose_collapsing,
    choose_connected,
    is_over,
    measure_velocities,
    note_hit,
)
from lcpstep.stepping.pieces.smooth import ON_THE_SURFACE
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import count_turn, idle, release, stick

SAME_SPEED = 1e-6  # relative: contacts that close at one time, and are as alike in speed, land together
SMALL = 1e-3  # beside its change: a gap velocity that may be but rounding


def strike(m: Model, plan: Plan, w: Work, first: int, t: float) -> int:
    """The impact of contact `first`, and of those that fire with it, or (CORNER) of those whose velocity jumps.

    Returns how many took part, -1 where the impact was not solved. What is held from all sides cannot leave every
    obstacle as its restitution asks, and speeds carried along beside the velocities may not agree with these: where
    no impulses answer, they but end the approach that the velocities have.
    """
    n_s = answer(m, plan, w, first, t, False)
    if n_s >= 0 or first == CORNER:
        return n_s
    for c in range(w.n_c):
        w.velocity[c], w.fall[c] = velocity_of(w, c), 0.0
    if w.velocity[first] < 0.0:
        return answer(m, plan, w, first, t, True)
    touch(w, first)
    return 0


def touch(w: Work, c: int) -> None:
    """Contact c is at rest on its obstacle, and the forces decide what becomes of it."""
    w.gap[c] = w.velocity[c] = 0.0
    w.grounded[c], w.touching = GROUND, True


def answer(m: Model, plan: Plan, w: Work, first: int, t: float, drifted: bool) -> int:
    """One attempt at an impact, at time t: how many took part, -1 where it was not solved.

    Drifted, the second attempt: closed contacts have speeds, as they have at a corner, and none rebounds.
    """
    if first != CORNER and w.close_hits[first] >= MANY_AT_ONCE:
        measure_velocities(w)
    n_s = choose_jumping(m, plan, w, t) if first == CORNER else choose_struck(m, plan, w, first, t)
    if n_s == 0:
        return 0
    if w.closed_now > 0:
        n_s = choose_connected(w, n_s)
    collapsed = False
    for k in range(n_s):
        c = w.chosen[k]
        w.z[k] = w.b[k] = 0.0
        w.plastic[c] = 0
        if w.status[c] == OPEN:
            if first != CORNER:
                note_hit(plan, w, c)
                if drifted:
                    w.close_hits[c] = IN_A_ROW
                w.plastic[c] = 1 if drifted or is_over(m, plan, w, c, n_s == 1, t) else 0
                collapsed = collapsed or (w.plastic[c] == 1 and w.close_hits[c] >= IN_A_ROW)
            r = 0.0 if w.plastic[c] == 1 else m.restitution[c]
            w.b[k] = w.velocity[c] + r * min(w.before[c], 0.0)
        elif drifted or first == CORNER:
            w.b[k] = w.velocity[c]
    together = choose_collapsing(plan, w, first, n_s) if collapsed else n_s
    if together > n_s and solve_chosen(m, plan, w, INERTIA, together, NONE):
        n_s = together
    else:  # walls without clearance cannot all be met where their speeds differ by rounding
        clear(w.z, n_s)
        if not solve_chosen(m, plan, w, INERTIA, n_s, NONE):
            return -1
    if apply(plan, w, n_s) == 0.0:
        idle(w)
    for k in range(n_s):
        after_impact(m, plan, w, w.chosen[k], w.z[k], t)
    w.events += 1
    return n_s


def choose_struck(m: Model, plan: Plan, w: Work, first: int, t: float) -> int:
    """Contacts that fire now; their number, the velocities of all gaps before the impact into `before`.

    The gaps of those chosen are zero from now on; what falls freely has the speed that it has left with (`fall`).
    Those that close with one speed land together, those that touched before are pushed together, and so are those
    of which rounding hides which came first, where that matters, if by a third one. Others whose gaps happen to be
    zero at the same time are struck one after another, as they would be a little apart.
    """
    for c in range(w.n_c):
        # A gap within the slack may still be open: its speed is not yet the one that it will close with
        closing = c == first or (
            w.gap[c] <= plan.slack and abs(w.velocity[c] + w.fall[c]) <= SAME_SPEED * w.fall[c]
        )
        # Rounding must not add up over chattering: it strikes with the speed that it left with
        if w.fall[c] > 0.0 and w.velocity[c] < 0.0 and closing:
            w.velocity[c] = -w.fall[c]
        w.before[c], w.place[c] = w.velocity[c], 0  # 1: strikes with the first
    w.chosen[0] = first
    if w.n_c == 1:
        w.gap[first], w.grounded[first] = 0.0, GROUND
        return 1
    u, n_s, k = w.velocity[first], 1, 0
    touched = w.grounded[first] >= GROUND and w.last[first] < 0.0
    since = w.sigma - w.last[first] if w.last[first] >= 0.0 else inf
    untold = rounding_of_time(w, t)
    crossing = moment_untold(rounding_of_gap(m, plan, w, first), min(u, -LEAST), since)
    w.gap[first], w.grounded[first] = 0.0, GROUND
    while k < n_s:
        for c in range(w.n_c):
            # Beside obstacles that move gaps tell less than a time does, and than that in which the first is crossed
            missed = untold * abs(w.velocity[c])
            passed = min(crossing * abs(w.velocity[c]), CROSSED * plan.slack)
            # the slack knows nothing of the lengths within a curved gap, whose rounding may be more
            met = w.gap[c] <= plan.slack + missed + passed or not m.flat
            if met and w.place[c] == 0 and c != first and w.status[c] == OPEN and w.velocity[c] < 0.0:
                near = w.gap[c] <= plan.slack + missed
                pushed = touched and w.grounded[c] >= GROUND and w.last[c] < 0.0
                alike = abs(w.velocity[c] - u) <= SAME_SPEED * abs(u)
                if (near and (pushed or alike)) or tied(m, plan, w, w.chosen[k], c, missed + passed):
                    w.chosen[n_s], w.place[c] = c, 1
                    w.gap[c], w.grounded[c] = 0.0, GROUND
                    n_s += 1
        k += 1
    return n_s


def rounding_of_time(w: Work, t: float) -> float:
    """What time t is rounded by where an obstacle moves, by whose place bodies on it are known; else 0."""
    for c in range(w.n_c):
        if w.gap_t[c] != 0.0:
            return 4.0 * RESOLUTION * abs(t)
    return 0.0


def tied(m: Model, plan: Plan, w: Work, d: int, c: int, missed: float) -> bool:
    """Whether contact c has come with contact d, up to rounding, and the order of their impacts matters.

    Along closed contacts, as into the apex of a wedge, both have come together as far as these have been kept on
    their surfaces. Contacts that have struck at this instant already are in the midst of a sequence, which has an
    order, unless no time at all has passed since: from a corner, in which they all touch.
    """
    unknown = missed + rounding_of_gap(m, plan, w, c)
    if w.closed_now > 0:
        unknown += ON_THE_SURFACE * plan.slack
    if at_this_instant(plan, w, d) or at_this_instant(plan, w, c):
        unknown = 0.0
    if w.gap[c] > unknown:
        return False
    W, n, r = w.W, w.n_c, m.restitution
    return order_matters(W[d * n + d], W[c * n + c], W[d * n + c], r[d], r[c], w.velocity[d], w.velocity[c])


def rounding_of_gap(m: Model, plan: Plan, w: Work, c: int) -> float:
    """Rounding of gap c: of its terms, of the way of a step, and of that so far as long as it counts as zero.

    At the apex of a corner that is the origin the terms vanish, and what the way there has left of them does not.
    """
    step = plan.h * speed_terms(plan, w, c)
    here = gap_rounding(m, w.G, w.q, c, step)
    return max(here, min(plan.slack, here + NOISE * (w.steps - 1) * step))


def apply(plan: Plan, w: Work, n_s: int) -> float:
    """Velocities after the impulses z of the chosen contacts, what rounding leaves of zero is zero; the largest z."""
    n, largest = w.n_q, 0.0
    for i in range(n):
        w.v_try[i] = abs(w.v[i])
    for k in range(n_s):
        c, p = w.chosen[k], w.z[k]
        if p > 0.0:
            largest = max(largest, p)
            for i in range(n):
                w.v[i] += w.MG[c * w.n_q + i] * p
                w.v_try[i] += abs(w.MG[c * w.n_q + i] * p)
    for i in range(n):
        w.swing[i] = max(w.swing[i], w.v_try[i])
    zero_speeds(w, w.v_try)
    for k in range(n_s):
        if w.z[k] > 0.0:
            push(plan, w, w.chosen[k], w.z[k])
    return largest


def zero_speeds(w: Work, terms: Doubles) -> None:
    """Velocities that are rounding of what impacts have made them of are zero.

    A damper would pull by them at a body that rests, and let it go from its obstacle; and in the next step, which
    knows no impacts, such a velocity is none of rounding beside itself, and bodies at rest on each other part.
    """
    for i in range(w.n_q):
        if abs(w.v[i]) <= NOISE * terms[i]:
            w.v[i] = 0.0


def push(plan: Plan, w: Work, d: int, p: float) -> None:
    """Gap velocities after the impulse of contact d; a contact that touches may be left at rest by it."""
    for c in range(w.n_c):
        change = w.W[c * w.n_c + d] * p
        if change != 0.0:
            w.velocity[c] += change
            w.fall[c] = 0.0
            u = abs(w.velocity[c])
            touches = u <= SMALL * abs(change) and w.gap[c] <= plan.slack
            if touches and u <= NOISE * speed_terms(plan, w, c):
                touch(w, c)
            elif w.grounded[c] == LEFT:
                w.grounded[c], w.touching = GROUND, True


def after_impact(m: Model, plan: Plan, w: Work, c: int, p: float, t: float) -> None:
    """Note the impact of a contact; the velocity it leaves with, to the last digit.

    The impulse in the log has that of the hops left; among those of kept states that is one of the forces to come.
    """
    r, before = m.restitution[c], min(w.before[c], 0.0)
    w.impulse[c] += p
    if w.status[c] == CLOSED:
        if p > 0.0:
            w.velocity[c] = 0.0
            w.record.note(t, c, 0.0, 0.0, p, IMPACT)
        elif w.velocity[c] > NOISE * speed_terms(plan, w, c):
            release(m, plan, w, c, t, w.velocity[c])
        else:
            w.velocity[c] = 0.0
        return
    if p == 0.0:
        if w.velocity[c] < 0.0:  # by rounding, which no impulse ends
            touch(w, c)
        return
    count_turn(m, plan, w, c, before, True)
    if w.plastic[c] == 1:
        T = 0.0
        if w.half[c] < 0.0 and w.close_hits[c] < IN_A_ROW:
            T = min(r * before / w.half[c] / (1.0 - r), w.end - w.sigma)
            p += -2.0 * w.half[c] * T / w.W[c * w.n_c + c]
        w.record.note(t + T, c, before, 0.0, p, IMPACT if r <= STOPS else ACCUMULATION)
        stick(w, c, t + T)
        return
    w.velocity[c] = -r * before if r > 0.0 else 0.0
    w.fall[c] = w.velocity[c] if plan.plain and plan.steady else 0.0
    w.record.note(t, c, before, w.velocity[c], p, IMPACT)
    if r == 0.0:
        stick(w, c, t)
    elif before == 0.0:
        w.touching = True
