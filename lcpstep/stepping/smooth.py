"""The smooth motion of `Located` between two events, as kernels: q + v tau + a tau^2 / 2 with one force a piece.

Linear systems take the mean acceleration of the trapezoidal rule over the rest of the step,

    A a = (F(t) + F(t + rest)) / 2 - C v - K (q + v rest / 2),     A = M + rest/2 C + rest^2/4 K,

others the acceleration at the base, M a = f(t, q, v), and at the end of the piece half the difference to the
acceleration there (velocity Verlet). Both are of order two. Where the Jacobian changes, closed contacts are put back
onto the surface, with the normal there (RATTLE). Sources: N. Newmark, A method of computation for structural
dynamics (1959); H. Andersen, Rattle, J. Comput. Phys. 52 (1983).
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import (
    assign,
    factorise,
    grow_factor,
    positive_definite,
    solve,
    solve_definite,
    solve_factored,
)
from lcpstep.dynamics import bias, gap_rates, gaps, mass, product, total_force
from lcpstep.model import ABSENT
from lcpstep.stepping.located_joints import (
    join_acceleration,
    meet_joints,
    put_on_joints,
    reach_joints,
    reduce_mobility,
    settle_velocity,
    take_joints,
)
from lcpstep.stepping.located_work import (
    A_TRY,
    BIAS,
    CHANGE,
    CLOSED,
    CLOSED_NOW,
    DOUBT,
    END,
    FORCE,
    FORCE_NOW,
    FORCES,
    FREE,
    GAP,
    GAP_T,
    GAP_T_TRY,
    GAP_TRY,
    HALF,
    HELD,
    HIGH,
    IMPULSE,
    LOW,
    NEXT_FORCE,
    Q_BASE,
    Q_TRY,
    RATE,
    REST,
    SIGMA,
    STATUS,
    V_TRY,
    WHOLE,
    A,
    Q,
    V,
)

LANDINGS = 6  # Newton iterations onto the surface
ON_THE_SURFACE = 1 / 16  # of what counts as closed: where these end


@inline
def within(plan: Any, x: Any, t: float) -> float:
    """A time moved off the corners, where forces jump, into the smooth interval at hand."""
    return min(max(t, x[LOW] + plan.margin), x[HIGH] - plan.margin)


def invert_rest(m: Any, plan: Any, w: Any, rest: float) -> None:
    """A^-1 for the rest of a step, and what contacts need of it."""
    n, n_c = w.vec.shape[1], w.num.shape[1]
    if n == 1:
        A = m.M[0, 0] + 0.5 * rest * m.C[0, 0] + 0.25 * rest * rest * m.K[0, 0]
        plan.A_inverse[REST, 0, 0] = 1.0 / A
    else:
        for i in range(n):
            for j in range(n):
                plan.A[i, j] = m.M[i, j] + 0.5 * rest * m.C[i, j] + 0.25 * rest * rest * m.K[i, j]
        factorise(plan.A, plan.pivots)
        for j in range(n):
            for i in range(n):
                plan.unit[i] = 1.0 if i == j else 0.0
            solve(plan.A, plan.pivots, plan.unit)
            for i in range(n):
                plan.A_inverse[REST, i, j] = plan.unit[i]
    if plan.constant:
        for c in range(n_c):
            for i in range(n):
                w.AG[REST, c, i] = product(plan.A_inverse[REST], m.G[c], i)
            for d in range(n_c):
                w.WA[REST, d, c] = product(m.G, w.AG[REST, c], d)


@inline
def accelerate(m: Any, plan: Any, w: Any, x: Any, t: float) -> int:
    """Acceleration without contact forces over the rest of the smooth interval; which matrices belong to it."""
    rest = x[END] - x[SIGMA]
    place = WHOLE if rest == plan.made_for or not plan.stiff else REST
    if not plan.trapezoidal or plan.steady:
        return place
    if place == REST:
        if plan.small:
            invert_rest(m, plan, w, rest)
        else:
            place = WHOLE
    n = w.vec.shape[1]
    for i in range(n):
        w.vec[A_TRY, i] = 0.5 * (w.vec[FORCE, i] + w.vec[NEXT_FORCE, i])
    if plan.stiff:
        for i in range(n):
            for j in range(n):
                w.vec[A_TRY, i] -= m.C[i, j] * w.vec[V, j] + m.K[i, j] * (
                    w.vec[Q, j] + 0.5 * rest * w.vec[V, j]
                )
    for i in range(n):
        w.vec[FREE, i] = product(plan.A_inverse[place], w.vec[A_TRY], i)
    return place


@inline
def free_acceleration(m: Any, w: Any, t: float, q: Any, v: Any, out: Any) -> bool:
    """M^-1 f(t, q, v) of a general system; leaves the factors of a mass matrix that changes in w.M."""
    if m.mass == ABSENT:
        total_force(m, t, q, v, w.vec[FORCE])
        for i in range(len(out)):
            out[i] = product(m.M_inverse, w.vec[FORCE], i)
        join_acceleration(w, t, q, v, out)
        return True
    total_force(m, t, q, v, out)
    mass(m, t, q, v, w.M)
    if not positive_definite(w.M):
        return False
    solve_definite(w.M, out)
    join_acceleration(w, t, q, v, out)
    return True


@inline
def mobility(m: Any, w: Any, c: int) -> None:
    """M^-1 G_c^T at the Jacobian w.G, into w.MG[c]; for a changing mass matrix by the factors in w.M."""
    if m.mass == ABSENT:
        for i in range(w.vec.shape[1]):
            w.MG[c, i] = product(m.M_inverse, w.G[c], i)
    else:
        assign(w.MG[c], w.G[c])
        solve_definite(w.M, w.MG[c])
    reduce_mobility(w, c)


@inline
def respond(m: Any, w: Any) -> None:
    """M^-1 G^T and the Delassus matrix at the Jacobian w.G."""
    for c in range(w.num.shape[1]):
        mobility(m, w, c)
        for d in range(w.num.shape[1]):
            w.W[d, c] = product(w.G, w.MG[c], d)


@inline
def refactor(m: Any, w: Any, t: float) -> bool:
    """Factors of the mass matrix and of the joints at the state w.vec[Q]."""
    if m.mass != ABSENT:
        mass(m, t, w.vec[Q], w.vec[V], w.M)
        if not positive_definite(w.M):
            return False
    take_joints(w, t)
    return True


def gap_bias(m: Any, w: Any, t: float, q: Any, v: Any) -> None:
    """Gap accelerations at v' = 0 into w.num[BIAS]."""
    bias(m, t, q, v, w.vec[Q_TRY], w.G_try, w.num[GAP_T_TRY], w.num[BIAS])


@inline
def measure(m: Any, plan: Any, w: Any, x: Any, t: float) -> None:
    """Gaps and gap velocities at the base of the piece; zero where a contact is closed."""
    gaps(m, t, w.vec[Q], w.vec[V], w.num[GAP])
    gap_rates(m, within(plan, x, t), w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
    for c in range(w.num.shape[1]):
        w.num[RATE, c] = product(w.G, w.vec[V], c) + w.num[GAP_T, c]
        if w.mark[STATUS, c] == CLOSED:
            w.num[GAP, c] = w.num[RATE, c] = 0.0


@inline
def shift(w: Any, tau: float) -> None:
    """The state at tau after the base becomes the base: along the quadratics."""
    for i in range(w.vec.shape[1]):
        w.vec[Q, i] += tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
        w.vec[V, i] += tau * w.vec[A, i]
    for c in range(w.num.shape[1]):
        w.num[IMPULSE, c] += tau * w.num[FORCE_NOW, c]
        if w.mark[STATUS, c] == CLOSED:
            w.num[GAP, c] = w.num[RATE, c] = 0.0
        else:
            w.num[GAP, c] += tau * (w.num[RATE, c] + tau * w.num[HALF, c])
            w.num[RATE, c] += 2.0 * tau * w.num[HALF, c]


def put_on_surface(m: Any, plan: Any, w: Any, t: float) -> None:
    """Q onto g = 0 where a contact is closed, and out of obstacles, with the mass matrix at hand."""
    for _ in range(LANDINGS):
        put_on_joints(w, t, plan.slack, w.vec[Q])
        gaps(m, t, w.vec[Q], w.vec[V], w.num[GAP_TRY])
        worst = 0.0
        for c in range(w.num.shape[1]):
            if w.mark[STATUS, c] != CLOSED:
                w.num[GAP_TRY, c] = min(w.num[GAP_TRY, c], 0.0)
            worst = max(worst, abs(w.num[GAP_TRY, c]))
        if worst <= ON_THE_SURFACE * plan.slack:
            return
        if not plan.constant:
            gap_rates(m, t, w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
            respond(m, w)
        newton_step(w, w.vec[Q])


def settle_state(m: Any, plan: Any, w: Any, x: Any, t: float, q: Any) -> None:
    """Q, a position within a piece, onto closed contacts and joints and out of obstacles; V_TRY onto joints."""
    free = plan.plain or w.num.shape[1] == 0 or (plan.exact and x[CLOSED_NOW] > 0)
    if free and not plan.joined:
        return
    assign(w.vec[Q_BASE], w.vec[Q])
    assign(w.vec[Q], q)
    put_on_joints(w, t, plan.slack, w.vec[Q])
    if refactor(m, w, t):
        put_on_surface(m, plan, w, t)
        settle_velocity(w, t)
    assign(q, w.vec[Q])
    assign(w.vec[Q], w.vec[Q_BASE])


def newton_step(w: Any, x: Any) -> None:
    """X + M^-1 G^T z with G M^-1 G^T z = -r for the residuals r in w.num[GAP_TRY] of closed and violated contacts.

    Those that depend on others get no z of their own.
    """
    n_c, n_k = w.num.shape[1], 0
    L = w.problem.reshape((n_c, n_c))
    for c in range(n_c):
        if w.num[GAP_TRY, c] != 0.0 or w.mark[STATUS, c] == CLOSED:
            w.mark[HELD, n_k] = c
            if grow_factor(w.W, L, w.mark[HELD], w.num[DOUBT], n_k):
                w.num[CHANGE, n_k] = -w.num[GAP_TRY, c]
                n_k += 1
    solve_factored(L, n_k, w.num[CHANGE])
    for k in range(n_k):
        for i in range(w.vec.shape[1]):
            x[i] += w.MG[w.mark[HELD, k], i] * w.num[CHANGE, k]


def lift(m: Any, plan: Any, w: Any, x: Any, c: int, distance: float) -> None:
    """Move x, which is q or v, along M^-1 G_c^T so that G_c x grows by the distance."""
    if not plan.constant:
        mobility(m, w, c)
    W = product(w.G, w.MG[c], c)
    if W > 0.0:
        for i in range(w.vec.shape[1]):
            x[i] += w.MG[c, i] * distance / W


@inline
def advance(m: Any, plan: Any, w: Any, x: Any, t: float, tau: float, count: Any) -> bool:
    """The state at tau after the base becomes the base; False where the mass matrix fails.

    With a Jacobian that changes, the contact forces of the base act over half the piece; `land` gives the rest.
    """
    if plan.plain:
        shift(w, tau)
        return True
    n, t_next = w.vec.shape[1], t + tau
    for i in range(n):
        w.vec[V_TRY, i] = w.vec[V, i] + tau * w.vec[A, i]
        w.vec[Q, i] += tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
    for c in range(w.num.shape[1]):
        w.num[IMPULSE, c] += 0.5 * tau * w.num[FORCE_NOW, c]
    reach_joints(w, t_next, tau, plan.slack)
    if x[CLOSED_NOW] > 0:
        if not refactor(m, w, t_next):
            return False
        put_on_surface(m, plan, w, t_next)
    if plan.trapezoidal:
        for i in range(n):
            w.vec[V, i] += 0.5 * tau * (w.vec[FREE, i] + w.vec[A, i])
    else:
        end = within(plan, x, t_next)
        if not free_acceleration(m, w, end, w.vec[Q], w.vec[V_TRY], w.vec[A_TRY]):
            return False
        count[FORCES] += 1
        for i in range(n):
            w.vec[V, i] += 0.5 * tau * (w.vec[A_TRY, i] + w.vec[A, i])
            w.vec[FREE, i] = w.vec[A_TRY, i]
        meet_joints(w, t_next, tau)
    measure(m, plan, w, x, t_next)
    return True
