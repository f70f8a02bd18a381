"""The smooth motion of `Located` between two events, as kernels: q + v tau + a tau^2 / 2 with one force a piece.

Linear systems take the mean acceleration of the trapezoidal rule over the rest of the step,

    A a = (F(t) + F(t + rest)) / 2 - C v - K (q + v rest / 2),     A = M + rest/2 C + rest^2/4 K,

others the acceleration at the base, M a = f(t, q, v), and at the end of the piece half the difference to the
acceleration there (velocity Verlet). Both are of order two. Where the Jacobian changes, closed contacts are put back
onto the surface, with the normal there (RATTLE). Sources: N. Newmark, A method of computation for structural
dynamics (1959); H. Andersen, Rattle, J. Comput. Phys. 52 (1983).
"""

from __future__ import annotations

import cython

from lcpstep.kernels.acceleration import factor_mass, response
from lcpstep.kernels.biases import bias
from lcpstep.kernels.dynamics import external_force, gap_rates, gaps, implicit_mass, total_force
from lcpstep.kernels.linear import grow_factor, invert_matrix, solve_factored, uncouple
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import add, copy, filled, product, product_at, product_between
from lcpstep.pointers import Doubles, abs, after, max, min
from lcpstep.stepping.pieces.codes import CLOSED, INERTIA, OPEN, REST, WHOLE
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import look_one, move_gap, move_one, within

SMALL = 8  # coordinates up to which matrices are made anew for the rest of a step
LANDINGS = 6  # Newton iterations onto the surface
ON_THE_SURFACE = 0.0625  # of what counts as closed: where these end


def invert(m: Model, plan: Plan, w: Work, rest: float, place: int) -> None:
    """A^-1 for a piece as long as `rest`, and what contacts need of it, into a place."""
    n, n_c = w.n_q, w.n_c
    inverse, AG = after(plan.A_inverse, place * n * n), after(plan.AG, place * n_c * n)
    WA = after(plan.WA, place * n_c * n_c)
    implicit_mass(m, 0.5 * rest, w.M)  # which has no factor: the mass matrix of a linear system is constant
    if n == 1:
        inverse[0] = 1.0 / w.M[0]
    else:
        invert_matrix(w.M, w.moved, 1.0, w.a_try, inverse, n)
    if plan.constant:
        answer_forces(inverse, m.G, AG, WA, n, n_c)


def answer_forces(inverse: Doubles, G: Doubles, AG: Doubles, WA: Doubles, n: int, n_c: int) -> None:
    """(A^-1 G^T)^T and G A^-1 G^T: how accelerations answer contact forces over a piece."""
    for c in range(n_c):
        for i in range(n):
            AG[c * n + i] = product(inverse, after(G, c * n), i, n)
        for d in range(n_c):
            WA[d * n_c + c] = product(G, after(AG, c * n), d, n)


def mobilities(plan: Plan, w: Work, place: int) -> Doubles:
    """W = G A^-1 G^T with the A of a place."""
    return w.W if place == INERTIA else after(plan.WA, place * w.n_c * w.n_c)


def responses(plan: Plan, w: Work, place: int) -> Doubles:
    """(A^-1 G^T)^T."""
    return w.MG if place == INERTIA else after(plan.AG, place * w.n_c * w.n_q)


def accelerate(m: Model, plan: Plan, w: Work) -> None:
    """Acceleration without contact forces over the rest of the smooth interval; the place of its matrices."""
    rest = w.end - w.sigma
    w.made_with = REST if plan.stiff and rest != plan.made_for and w.n_q <= SMALL else WHOLE
    if not m.linear or plan.steady:
        return
    if w.made_with == REST:
        invert(m, plan, w, rest, REST)
    n = w.n_q
    for i in range(n):
        w.a_try[i] = 0.5 * (w.force[i] + w.next_force[i])
    if plan.stiff:
        for i in range(n):
            for j in range(n):
                w.a_try[i] -= m.C[i * n + j] * w.v[j] + m.K[i * n + j] * (w.q[j] + 0.5 * rest * w.v[j])
    for i in range(n):
        w.a_free[i] = product(after(plan.A_inverse, w.made_with * n * n), w.a_try, i, n)


def free_acceleration(m: Model, w: Work, t: float, q: Doubles, v: Doubles, out: Doubles) -> bool:
    """M^-1 f(t, q, v) of a general system; leaves the factors of a mass matrix that changes in w.M.

    False where that is not positive definite.
    """
    total_force(m, t, q, v, w.force)
    if not factor_mass(m, t, q, v, w.M):
        return False
    response(m, w.M, w.jolt, w.force, out)
    return True


def renew_forces(m: Model, plan: Plan, w: Work, t: float) -> bool:
    """Forces at time t, the base of a piece, or their acceleration without contact; False where the mass fails."""
    if m.linear and not plan.steady:
        external_force(m, within(w, t), w.q, w.v, w.force)
        w.force_evaluations += 1
    elif not m.linear:
        if not free_acceleration(m, w, within(w, t), w.q, w.v, w.a_free):
            return False
        w.force_evaluations += 1
    return True


def respond(m: Model, w: Work) -> None:
    """M^-1 G^T and the Delassus matrix at the Jacobian w.G; for a changing mass matrix by the factors in w.M."""
    for c in range(w.n_c):
        response(m, w.M, w.jolt, after(w.G, c * w.n_q), after(w.MG, c * w.n_q))
        n_k = filled(after(w.MG, c * w.n_q), w.n_q, w.moved)
        for d in range(w.n_c):
            w.W[d * w.n_c + c] = product_at(w.G, after(w.MG, c * w.n_q), d, w.n_q, w.moved, n_k)
    uncouple(w.W, w.G, w.MG, 0, w.n_c, w.n_c, w.n_q)


def gap_bias(m: Model, w: Work, t: float, q: Doubles, v: Doubles) -> None:
    """Gap accelerations at v' = 0 into w.bias."""
    bias(m, within(w, t), w.low, w.high, q, v, w.q_try, w.G_try, w.gap_t_try, w.bias)


def gap_accelerations(w: Work, a: Doubles) -> None:
    """Gap accelerations under the acceleration a, without contact forces, into w.alpha."""
    for c in range(w.n_c):
        w.alpha[c] = product(w.G, a, c, w.n_q) + w.bias[c]


def measure(m: Model, w: Work, t: float) -> None:
    """Gaps and gap velocities at the base of the piece; zero where a contact is closed, and they are numbers."""
    gaps(m, t, w.q, w.v, w.gap)
    gap_rates(m, within(w, t), w.q, w.v, w.G, w.gap_t)
    for c in range(w.n_c):
        if m.flat:
            w.velocity[c] = product_between(m.G, w.v, c, w.n_q, m.G_ends) + w.gap_t[c]
        else:
            w.velocity[c] = product(w.G, w.v, c, w.n_q) + w.gap_t[c]
        if w.status[c] == CLOSED:
            w.gap[c] -= w.gap[c]
            w.velocity[c] -= w.velocity[c]


def look_along(w: Work, tau: float) -> None:
    """The state at tau after the base, along the quadratics, into w.q_try and w.v_try."""
    for i in range(w.n_q):
        look_one(w, i, tau)


def renew_mobility(m: Model, plan: Plan, w: Work, t: float) -> bool:
    """What impulses do at the state w.q, where that changes; False where the mass matrix fails."""
    if not plan.constant:
        if not factor_mass(m, t, w.q, w.v, w.M):
            return False
        respond(m, w)
    return True


def shift(w: Work, tau: float) -> None:
    """The state at tau after the base becomes the base: along the quadratics."""
    for i in range(w.n_q):
        move_one(w, i, tau)
    for c in range(w.n_c):
        w.impulse[c] += tau * w.force_now[c]
        w.pushed[c] += tau * w.force_now[c]
        if w.status[c] == CLOSED:
            w.gap[c] = w.velocity[c] = 0.0
        else:
            move_gap(w, c, tau)


def put_on_surface(m: Model, plan: Plan, w: Work, t: float, q: Doubles) -> None:
    """Q onto g = 0 where a contact is closed, and out of obstacles, with the mass matrix at hand.

    Onto the closed ones first: rounding leaves one that closes just now on either side of zero.
    """
    near = ON_THE_SURFACE * plan.slack
    for landing in range(LANDINGS):
        gaps(m, t, q, w.v, w.gap_try)
        worst, closed = 0.0, landing == 0 and closed_off(w) > near
        for c in range(w.n_c):
            if w.status[c] != CLOSED:
                w.gap_try[c] = 0.0 if closed else min(w.gap_try[c], 0.0)
            worst = max(worst, abs(w.gap_try[c]))
        if worst <= near:
            return
        if not plan.constant:
            gap_rates(m, t, q, w.v, w.G, w.gap_t)
            respond(m, w)
        newton_step(w, q)


def closed_off(w: Work) -> float:
    """How far closed contacts are off their obstacles, by w.gap_try."""
    most = 0.0
    for c in range(w.n_c):
        if w.status[c] == CLOSED:
            most = max(most, abs(w.gap_try[c]))
    return most


def settle_state(m: Model, plan: Plan, w: Work, t: float, q: Doubles) -> None:
    """Q, a position within a piece, onto closed contacts and out of obstacles."""
    if plan.plain or w.n_c == 0 or (plan.exact and w.closed_now > 0):
        return
    if factor_mass(m, t, q, w.v, w.M):
        put_on_surface(m, plan, w, t, q)


def newton_step(w: Work, x: Doubles) -> None:
    """X + M^-1 G^T z with G M^-1 G^T z = -r for the residuals r in w.gap_try of closed and violated contacts.

    Those that depend on others get no z of their own: violated ones on closed ones, whatever their numbers.
    """
    n_c, n_k = w.n_c, 0
    for status in range(CLOSED, OPEN - 1, -1):
        for c in range(n_c):
            if w.status[c] == status and (status == CLOSED or w.gap_try[c] != 0.0):
                w.held[n_k] = c
                if grow_factor(w.W, n_c, w.problem, n_c, w.held, w.doubt, n_k):
                    w.change[n_k] = -w.gap_try[c]
                    n_k += 1
    push_held(w, w.MG, n_c, n_k, x)


def push_held(w: Work, MG: Doubles, stride: int, n_k: int, x: Doubles) -> None:
    """X + M^-1 G^T z of the n_k contacts held, G M^-1 G^T z = `change`; its factor has `stride` numbers a row."""
    solve_factored(w.problem, stride, n_k, w.change)
    for k in range(n_k):
        add(x, w.change[k], after(MG, w.held[k] * w.n_q), w.n_q)


def advance(m: Model, plan: Plan, w: Work, t: float, tau: float) -> bool:
    """The state at tau after the base becomes the base; False where the mass matrix fails.

    With a Jacobian that changes, contact forces of the base act over half the piece; `stop_closed` gives the rest.
    """
    if plan.plain:
        shift(w, tau)
        return True
    n, t_next = w.n_q, t + tau
    look_along(w, tau)
    copy(w.q, w.q_try, n)
    add(w.impulse, 0.5 * tau, w.force_now, w.n_c)
    add(w.pushed, 0.5 * tau, w.force_now, w.n_c)
    if w.closed_now > 0:
        if not factor_mass(m, t_next, w.q, w.v, w.M):
            return False
        put_on_surface(m, plan, w, t_next, w.q)
    if m.linear:
        for i in range(n):
            w.v[i] += 0.5 * tau * (w.a_free[i] + w.a[i])
    else:
        end = within(w, t_next)
        if not free_acceleration(m, w, end, w.q, w.v_try, w.a_try):
            return False
        w.force_evaluations += 1
        for i in range(n):
            w.v[i] += 0.5 * tau * (w.a_try[i] + w.a[i])
            w.a_free[i] = w.a_try[i]
    measure(m, w, t_next)
    return True
