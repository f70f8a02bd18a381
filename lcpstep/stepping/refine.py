"""Impulses and forces of several contacts to the last digit, as kernels: `Located`'s complementarity problems.

The Delassus matrix W = G A^-1 G^T rounds away what a heavy body adds to a light one: solved from W alone, forces lose
log10(mass ratio) digits. What is left of

    b + G A^-1 (G^T z) = 0        on the contacts with z > 0

is therefore formed from the bodies' own data, forces summed before they are divided by masses, and W gives but the
correction. That all contacts are pressed is tried first, since it is so in most piles and costs a sixth of the
solver; and again where W is too rough for the solver. Contacts that depend on others get no correction of their own.
Source: N. Higham, Accuracy and Stability of Numerical Algorithms, chapter 12.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import call_solver
from lcpstep.dense import assign, grow_factor, solve_definite, solve_factored
from lcpstep.dynamics import product
from lcpstep.model import ABSENT
from lcpstep.stepping.located_work import (
    A_TRY,
    CHANGE,
    CHOSEN,
    DOUBT,
    EPS,
    FIRST_COORDINATE,
    HELD,
    INERTIA,
    JOLT,
    LAST_COORDINATE,
    LCP_CALLS,
    MEMBERS,
    PLACE,
    RESIDUAL,
    A,
    B,
    Z,
)

REFINEMENTS = 6
SETTLED = 4 * EPS  # correction, relative to the largest impulse, after which none is needed
EXACT = 8 * EPS  # residual, relative to the largest b, at which the forces of before are still right
PULLS = 1e-10  # relative to the largest impulse: what an answer found without the solver may lack


def solve_chosen(m: Any, plan: Any, w: Any, W: Any, place: int, n: int, count: Any) -> bool:
    """0 <= z, W z + b >= 0 on the chosen contacts; W = G A^-1 G^T with the A of `place`.

    w.num[Z] comes as a guess. False where there is no answer; the chosen are then noted as the culprits.
    """
    count[LCP_CALLS] += 1
    count[MEMBERS] = n
    if n == 1:
        c = w.mark[CHOSEN, 0]
        if W[c, c] > 0.0:
            w.num[Z, 0] = max(0.0, -w.num[B, 0] / W[c, c])
            return True
    if plan.joined:
        return solve_unrefined(w, W, n)
    factored = place == INERTIA and m.mass != ABSENT
    inverse = w.M if factored else (m.M_inverse if place == INERTIA else plan.A_inverse[place])
    return solve_several(w, W, inverse, factored, n)


def solve_unrefined(w: Any, W: Any, n: int) -> bool:
    """The same from W alone: with joints W is not G A^-1 G^T."""
    P = w.problem[: n * n].reshape((n, n))
    for i in range(n):
        for j in range(n):
            P[i, j] = W[w.mark[CHOSEN, i], w.mark[CHOSEN, j]]
    return call_solver(w.solver, P, w.num[B, :n], w.num[Z, :n], w.lcp) == 0


def solve_several(w: Any, W: Any, inverse: Any, factored: bool, n: int) -> bool:
    """The same for any number: the guess if it is still right, or all pressed, else the solver's answer; refined.

    `inverse` is A^-1 or, if `factored`, Cholesky's factor of A.
    """
    L = w.problem[: n * n].reshape((n, n))
    if right(w, inverse, factored, n):
        return True
    if n > 1 and all_pressed(w, W, L, n):
        return refine(w, W, inverse, factored, L, n, n, True)
    solved = solve_unrefined(w, W, n)
    if n == 1:
        return solved
    if not solved:
        for k in range(n):
            w.num[Z, k] = 0.0
    return refine(w, W, inverse, factored, L, n, -1, solved)


def all_pressed(w: Any, W: Any, L: Any, n: int) -> bool:
    """Whether W z + b = 0 has an answer with z > 0 for all; that answer, and the factor of W into L."""
    if factor_pressed(w, W, L, n, True) < n:
        return False
    for k in range(n):
        w.num[Z, k] = -w.num[B, k]
    solve_factored(L, n, w.num[Z])
    largest = 0.0
    for k in range(n):
        largest = max(largest, w.num[Z, k])
    least = largest
    for k in range(n):
        least = min(least, w.num[Z, k])
    return least > PULLS * largest


def right(w: Any, inverse: Any, factored: bool, n: int) -> bool:
    """Whether the guess, positive for all, is the answer: what rests keeps its forces from step to step."""
    if n == 1:
        return False
    size = 0.0
    for k in range(n):
        if not w.num[Z, k] > 0.0:
            return False
        size = max(size, abs(w.num[B, k]))
    leftover(w, inverse, factored, n)
    worst = 0.0
    for k in range(n):
        worst = max(worst, abs(w.num[RESIDUAL, k]))
    return worst <= EXACT * size


def leftover(w: Any, inverse: Any, factored: bool, n: int) -> None:
    """b + G A^-1 (G^T z) of the chosen contacts, into w.num[RESIDUAL]; A^-1 G^T z into w.vec[JOLT]."""
    force, jolt, n_q = w.vec[A_TRY], w.vec[JOLT], w.vec.shape[1]
    for i in range(n_q):
        force[i] = 0.0
    for k in range(n):
        if w.num[Z, k] != 0.0:
            c = w.mark[CHOSEN, k]
            for i in range(w.mark[FIRST_COORDINATE, c], w.mark[LAST_COORDINATE, c] + 1):
                force[i] += w.G[c, i] * w.num[Z, k]
    if factored:
        assign(jolt, force)
        solve_definite(inverse, jolt)
    else:
        for i in range(n_q):
            jolt[i] = 0.0
        for j in range(n_q):
            if force[j] != 0.0:
                for i in range(n_q):
                    jolt[i] += inverse[j, i] * force[j]
    for k in range(n):
        c, total = w.mark[CHOSEN, k], 0.0
        for i in range(w.mark[FIRST_COORDINATE, c], w.mark[LAST_COORDINATE, c] + 1):
            total += w.G[c, i] * jolt[i]
        w.num[RESIDUAL, k] = w.num[B, k] + total


def factor_pressed(w: Any, W: Any, L: Any, n: int, everybody: bool) -> int:
    """Cholesky factor of W for the independent contacts with z > 0; their places in the list go to w.mark[HELD]."""
    n_k = 0
    for k in range(n):
        if w.num[Z, k] > 0.0 or everybody:
            w.mark[HELD, n_k] = w.mark[CHOSEN, k]
            if grow_factor(W, L, w.mark[HELD], w.num[DOUBT], n_k):
                w.mark[PLACE, n_k] = k
                n_k += 1
    return n_k


def refine(w: Any, W: Any, inverse: Any, factored: bool, L: Any, n: int, n_k: int, solved: bool) -> bool:
    """Correct z by what it leaves; False where that is no answer either. L has n_k rows, or none yet if n_k < 0."""
    size = 0.0
    for k in range(n):
        size = max(size, abs(w.num[B, k]))
    leftover(w, inverse, factored, n)
    for _ in range(REFINEMENTS):
        worst = 0.0
        for k in range(n):
            if w.num[Z, k] > 0.0 or not solved:
                worst = max(worst, abs(w.num[RESIDUAL, k]))
        if worst <= EPS * size:
            break
        if n_k < 0:
            n_k = factor_pressed(w, W, L, n, not solved)
        largest, change = correct(w, L, n_k)
        leftover(w, inverse, factored, n)
        if change <= SETTLED * largest:
            break
    answered = solved or presses(w, W, n)
    for k in range(n):
        w.num[Z, k] = max(w.num[Z, k], 0.0)
    return answered


def correct(w: Any, L: Any, n_k: int) -> tuple[float, float]:
    """Add to z what the residual asks for; the largest impulse and the largest correction."""
    for i in range(n_k):
        w.num[CHANGE, i] = -w.num[RESIDUAL, w.mark[PLACE, i]]
    solve_factored(L, n_k, w.num[CHANGE])
    largest = change = 0.0
    for i in range(n_k):
        k = w.mark[PLACE, i]
        w.num[Z, k] += w.num[CHANGE, i]
        largest, change = max(largest, abs(w.num[Z, k])), max(change, abs(w.num[CHANGE, i]))
    return largest, change


def keep_closed(w: Any, W: Any, MG: Any, n: int) -> bool:
    """Take out of the acceleration what rounding leaves of G a on the pressed contacts; whether there was any."""
    worst = 0.0
    for k in range(n):
        pressed = w.num[Z, k] > 0.0
        w.num[RESIDUAL, k] = product(w.G, w.vec[A], w.mark[CHOSEN, k]) if pressed else 0.0
        worst = max(worst, abs(w.num[RESIDUAL, k]))
    if worst == 0.0:
        return False
    L = w.problem[: n * n].reshape((n, n))
    n_k = factor_pressed(w, W, L, n, False)
    for i in range(n_k):
        w.num[CHANGE, i] = -w.num[RESIDUAL, w.mark[PLACE, i]]
    solve_factored(L, n_k, w.num[CHANGE])
    for i in range(n_k):
        for j in range(w.vec.shape[1]):
            w.vec[A, j] += MG[w.mark[HELD, i], j] * w.num[CHANGE, i]
    return True


def presses(w: Any, W: Any, n: int) -> bool:
    """Whether z of an answer found without the solver pulls nowhere, and leaves no contact closing."""
    largest = 0.0
    for k in range(n):
        largest = max(largest, w.num[Z, k])
    for k in range(n):
        c, z = w.mark[CHOSEN, k], w.num[Z, k]
        if not z >= -PULLS * largest or w.num[RESIDUAL, k] < -PULLS * (abs(w.num[B, k]) + W[c, c] * abs(z)):
            return False
    return True
