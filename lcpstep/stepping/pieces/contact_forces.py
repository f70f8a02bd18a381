"""Forces of the closed contacts of `Located`: who needs none opens.

    0 <= alpha       complementary to  lambda >= 0       on all closed contacts, alpha the gap accelerations

at the start of a piece (`hold`), the same of gap velocities and impulses at its end (`stop_closed`), where normals
turn or obstacles move. A contact that would have to be pulled opens. Source: G. Osorio, Complex Behavior in Impacting
Systems, eq. 3.15.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.linear import solve_factored
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import add, clear, copy
from lcpstep.pointers import Doubles, abs, after, max, min
from lcpstep.stepping.pieces.chosen import solve_chosen
from lcpstep.stepping.pieces.codes import CLOSED, GROUND, INERTIA, LEFT, OPEN
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, speed_terms, velocity_of
from lcpstep.stepping.pieces.refine import FORCES, IMPULSES, factor_pressed, keep_closed
from lcpstep.stepping.pieces.smooth import answer_forces, mobilities, responses
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import count_turn, release, release_time, stick


def hold(m: Model, plan: Plan, w: Work, t: float) -> bool:
    """Forces of the contacts that rest from w.alpha, and the acceleration with them; who needs none opens.

    All that touch at rest are decided in one problem: to add them one by one could go on for ever.
    """
    n = w.n_q
    copy(w.a, w.a_free, w.n_q)
    clear(w.p, w.n_c)
    n_k = choose_resting(w)
    if n_k == 0:
        return True
    clear(w.fall, w.n_c)
    place = fit_responses(plan, w)
    W, MG = mobilities(plan, w, place), responses(plan, w, place)
    if not solve_chosen(m, plan, w, place, n_k, FORCES):
        return False
    for i in range(n):
        w.a_try[i] = abs(w.a_free[i])
    for k in range(n_k):
        c, force = w.chosen[k], w.z[k]
        w.p[c] = force
        if force > 0.0:
            for i in range(n):
                w.a[i] += MG[c * w.n_q + i] * force
                w.a_try[i] += abs(MG[c * w.n_q + i] * force)
    zero_rounding(plan, w)
    if plan.plain and n_k > 1 and keep_closed(w, W, MG, n_k):
        zero_rounding(plan, w)
    open_or_close(m, plan, w, W, n_k, t)
    return True


def open_or_close(m: Model, plan: Plan, w: Work, W: Doubles, n_k: int, t: float) -> None:
    """Of the chosen contacts those that need no force, and accelerate away, open; the others are closed from t on."""
    rest = w.end - w.sigma
    for k in range(n_k):
        c, force = w.chosen[k], w.z[k]
        if force == 0.0:
            alpha = leaving(m, plan, w, W, k, n_k, t)
            if alpha > 0.0:
                if w.status[c] == CLOSED:
                    at = release_time(w, c, t, rest, alpha / mobility(w, W, c, n_k))
                    release(m, plan, w, c, at, 0.0)
                w.grounded[c] = LEFT
                continue
        if w.status[c] == OPEN:
            stick(w, c, t)
            count_turn(m, plan, w, c, 0.0, False)
        w.older[c], w.older_time[c] = force, t + 0.5 * rest
        w.force_now[c] = force


def fit_responses(plan: Plan, w: Work) -> int:
    """Place of the matrices by which accelerations answer contact forces over a piece, at the normals at hand.

    They are those of the trapezoidal rule: a force changes the velocity that damping answers within the piece.
    """
    if not (plan.constant or plan.stiff):
        return INERTIA
    place = w.made_with
    if not plan.constant:
        inverse = after(plan.A_inverse, place * w.n_q * w.n_q)
        answer_forces(inverse, w.G, responses(plan, w, place), mobilities(plan, w, place), w.n_q, w.n_c)
    return place


def choose_resting(w: Work) -> int:
    """Contacts that rest on their obstacles, closed or just touching; their number."""
    n_k = 0
    for c in range(w.n_c):
        closed = w.status[c] == CLOSED
        if closed or (w.touching and w.grounded[c] == GROUND and w.velocity[c] == 0.0):
            w.chosen[n_k] = c
            w.z[n_k] = w.force_now[c] if closed else 0.0
            w.b[n_k] = w.alpha[c]
            n_k += 1
    w.touching = False
    return n_k


def leaving(m: Model, plan: Plan, w: Work, W: Doubles, k: int, n_k: int, t: float) -> float:
    """Acceleration with which the k-th chosen contact, which carries no force, opens at t; 0 if it is but rounding.

    Of a closed one that is known to pull by more than rounding its sign is enough: else it might be asked for ever.
    """
    c = w.chosen[k]
    alpha, size = w.b[k], 0.0
    for j in range(n_k):
        d = w.chosen[j]
        alpha += W[c * w.n_c + d] * w.z[j]
        size += abs(W[c * w.n_c + d] * w.z[j])
    if w.status[c] == CLOSED and w.grounded[c] == LEFT:
        return max(alpha, 0.0)
    if alpha <= NOISE * (size + abs(w.b[k])) or alpha <= NOISE * (size + acceleration_terms(m, w, c)):
        return 0.0
    return alpha if alpha > jerked(w, W, c) and tells(plan, w, c, alpha, t) else 0.0


def mobility(w: Work, W: Doubles, c: int, n_k: int) -> float:
    """How contact c, which bears nothing, answers a force while those of the chosen that bear one stay closed.

    What it would have to pull with keeps all of them closed, not c alone: the others answer it.
    """
    n, own = factor_pressed(w, W, n_k, False), W[c * w.n_c + c]
    for i in range(n):
        w.change[i] = W[w.held[i] * w.n_c + c]
    solve_factored(w.problem, n_k, n, w.change)
    left = own
    for i in range(n):
        left -= W[c * w.n_c + w.held[i]] * w.change[i]
    return left if left > NOISE * own else own


def tells(plan: Plan, w: Work, c: int, alpha: float, t: float) -> bool:
    """Whether an acceleration makes a gap velocity that can be told within the rest of the span.

    Bodies that go on together, touching along a curve, have a rounding of velocities across it whose square is left.
    """
    return alpha * (plan.clock.t_end - t) > NOISE * speed_terms(plan, w, c)


def pulls(m: Model, plan: Plan, w: Work, c: int, t: float) -> bool:
    """Whether the negative force in w.p of closed contact c, at t, is more than rounding of what it balances.

    The factor of the closed contacts is that of these forces. What they balance may be but the rounding of the next
    force, as in a row of bodies of which the last alone is pressed.
    """
    alpha, size = -w.W[c * w.n_c + c] * w.p[c], 0.0
    if alpha <= jerked(w, w.W, c) or not tells(plan, w, c, alpha, t):
        return False
    for d in range(w.n_c):
        if w.status[d] == CLOSED:
            size += abs(w.W[c * w.n_c + d] * w.p[d])
    return alpha > NOISE * (size + acceleration_terms(m, w, c)) and -w.p[c] > force_rounding(m, w, c)


def force_rounding(m: Model, w: Work, c: int) -> float:
    """Rounding of the force of contact c, sum_d |W^-1|_cd |terms_d|: much of it where normals are nearly parallel."""
    n_k, error = w.n_held, 0.0
    for k in range(n_k):
        w.change[k] = 1.0 if w.held[k] == c else 0.0
    solve_factored(w.problem, w.n_c, n_k, w.change)
    for k in range(n_k):
        d = w.held[k]
        size = acceleration_terms(m, w, d)
        for j in range(n_k):
            size += abs(w.W[d * w.n_c + w.held[j]] * w.p[w.held[j]])
        error += abs(w.change[k]) * size
    return NOISE * error


def jerked(w: Work, W: Doubles, c: int) -> float:
    """Acceleration of gap c by the rounding of the forces in w.p, each of which rounds those next to it in a chain.

    Those on the contact itself it need not bear: it opens.
    """
    felt = 0.0
    for d in range(w.n_c):
        if d != c and w.status[d] == CLOSED:
            felt += abs(W[c * w.n_c + d])
    return NOISE * min(felt, W[c * w.n_c + c]) * largest_connected(w, c) if felt > 0.0 else 0.0


def largest_connected(w: Work, c: int) -> float:
    """The largest force in w.p of the closed contacts that a chain of such connects with contact c."""
    largest, more = 0.0, True
    for d in range(w.n_c):
        w.place[d] = 1 if d == c else 0
    while more:
        more = False
        for d in range(w.n_c):
            for e in range(w.n_c):
                if (
                    w.place[e] == 1
                    and w.place[d] == 0
                    and w.status[d] == CLOSED
                    and w.W[d * w.n_c + e] != 0.0
                ):
                    w.place[d], more = 1, True
    for d in range(w.n_c):
        if w.place[d] == 1:
            largest = max(largest, abs(w.p[d]))
    return largest


def zero_rounding(plan: Plan, w: Work) -> None:
    """What is but rounding of the sums in w.a_try is zero: accelerations, and velocities that they made."""
    for i in range(w.n_q):
        if abs(w.a[i]) <= NOISE * w.a_try[i]:
            w.a[i] = 0.0
            if plan.plain and abs(w.v[i]) <= NOISE * w.a_try[i] * plan.h:
                w.v[i] = 0.0


def stop_closed(m: Model, plan: Plan, w: Work, t: float, tau: float) -> bool:
    """Gap velocities of closed contacts back to zero, with the normals at the end of the piece that began at t.

    A contact that would have to be pulled for that opens. Where the motion is the trapezoidal rule's, impulses act as
    forces over the piece do: damping answers them.
    """
    n_k = 0
    for c in range(w.n_c):
        if w.status[c] == CLOSED:
            w.chosen[n_k] = c
            w.z[n_k] = 0.5 * tau * w.force_now[c]
            w.b[n_k] = velocity_of(w, c)
            n_k += 1
    if n_k == 0:
        return True
    place = fit_responses(plan, w)
    W, MG = mobilities(plan, w, place), responses(plan, w, place)
    if not solve_chosen(m, plan, w, place, n_k, IMPULSES):
        return False
    for k in range(n_k):
        c, p = w.chosen[k], w.z[k]
        w.p[c] = p
        w.impulse[c] += p
        w.pushed[c] += p
        add(w.v, p, after(MG, c * w.n_q), w.n_q)
    for k in range(n_k):
        c = w.chosen[k]
        if w.p[c] == 0.0:
            u = velocity_of(w, c)
            if u > NOISE * speed_terms(plan, w, c):
                lost = 2.0 * u / (tau * mobility(w, W, c, n_k))
                force = w.force_now[c]
                share = force / (force + lost) if force > 0.0 else 0.0
                release(m, plan, w, c, t + tau * share, u)
            elif u > 0.0:  # rounding: beside the velocities of a later, slower motion it would be none
                add(w.v, -u / W[c * w.n_c + c], after(MG, c * w.n_q), w.n_q)
    return True
