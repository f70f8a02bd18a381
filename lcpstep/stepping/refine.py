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
        return solve_unrefined(W, w.num, w.mark, w.problem[: n * n].reshape((n, n)), w.solver, w.lcp, n)
    factored = place == INERTIA and m.mass != ABSENT
    inverse = w.M if factored else (m.M_inverse if place == INERTIA else plan.A_inverse[place])
    return solve_several(
        inverse,
        factored,
        w.G,
        W,
        w.vec,
        w.num,
        w.mark,
        w.problem[: n * n].reshape((n, n)),
        w.solver,
        w.lcp,
        n,
    )


def solve_unrefined(W: Any, num: Any, mark: Any, P: Any, solver: Any, lcp: Any, n: int) -> bool:
    """The same from W alone: with joints W is not G A^-1 G^T."""
    for i in range(n):
        for j in range(n):
            P[i, j] = W[mark[CHOSEN, i], mark[CHOSEN, j]]
    return call_solver(solver, P, num[B, :n], num[Z, :n], lcp) == 0


def solve_several(
    inverse: Any,
    factored: bool,
    G: Any,
    W: Any,
    vec: Any,
    num: Any,
    mark: Any,
    P: Any,
    solver: Any,
    lcp: Any,
    n: int,
) -> bool:
    """The same for any number: the guess if it is still right, or all pressed, else the solver's answer; refined.

    `inverse` is A^-1 or, if `factored`, Cholesky's factor of A.
    """
    if right(inverse, factored, G, vec, num, mark, n):
        return True
    if n > 1 and all_pressed(W, P, num, mark, n):
        return refine(inverse, factored, G, W, vec, num, mark, P, n, n, True)
    for i in range(n):
        for j in range(n):
            P[i, j] = W[mark[CHOSEN, i], mark[CHOSEN, j]]
    solved = call_solver(solver, P, num[B, :n], num[Z, :n], lcp) == 0
    if n == 1:
        return solved
    if not solved:
        for k in range(n):
            num[Z, k] = 0.0
    return refine(inverse, factored, G, W, vec, num, mark, P, n, -1, solved)


def all_pressed(W: Any, L: Any, num: Any, mark: Any, n: int) -> bool:
    """Whether W z + b = 0 has an answer with z > 0 for all; that answer, and the factor of W into L."""
    if factor_pressed(W, L, num, mark, n, True) < n:
        return False
    for k in range(n):
        num[Z, k] = -num[B, k]
    solve_factored(L, n, num[Z])
    largest = 0.0
    for k in range(n):
        largest = max(largest, num[Z, k])
    least = largest
    for k in range(n):
        least = min(least, num[Z, k])
    return least > PULLS * largest


def right(inverse: Any, factored: bool, G: Any, vec: Any, num: Any, mark: Any, n: int) -> bool:
    """Whether the guess, positive for all, is the answer: what rests keeps its forces from step to step."""
    if n == 1:
        return False
    size = 0.0
    for k in range(n):
        if not num[Z, k] > 0.0:
            return False
        size = max(size, abs(num[B, k]))
    leftover(inverse, factored, G, vec, num, mark, n)
    worst = 0.0
    for k in range(n):
        worst = max(worst, abs(num[RESIDUAL, k]))
    return worst <= EXACT * size


def leftover(inverse: Any, factored: bool, G: Any, vec: Any, num: Any, mark: Any, n: int) -> None:
    """b + G A^-1 (G^T z) of the chosen contacts, into num[RESIDUAL]; A^-1 G^T z into vec[JOLT]."""
    n_q = vec.shape[1]
    for i in range(n_q):
        vec[A_TRY, i] = 0.0
    for k in range(n):
        if num[Z, k] != 0.0:
            c = mark[CHOSEN, k]
            for i in range(mark[FIRST_COORDINATE, c], mark[LAST_COORDINATE, c] + 1):
                vec[A_TRY, i] += G[c, i] * num[Z, k]
    if factored:
        assign(vec[JOLT], vec[A_TRY])
        solve_definite(inverse, vec[JOLT])
    else:
        for i in range(n_q):
            vec[JOLT, i] = 0.0
        for j in range(n_q):
            if vec[A_TRY, j] != 0.0:
                for i in range(n_q):
                    vec[JOLT, i] += inverse[j, i] * vec[A_TRY, j]
    for k in range(n):
        c, total = mark[CHOSEN, k], 0.0
        for i in range(mark[FIRST_COORDINATE, c], mark[LAST_COORDINATE, c] + 1):
            total += G[c, i] * vec[JOLT, i]
        num[RESIDUAL, k] = num[B, k] + total


def factor_pressed(W: Any, L: Any, num: Any, mark: Any, n: int, all_pressed: bool) -> int:
    """Cholesky factor of W for the independent contacts with z > 0; their places in the list go to mark[HELD]."""
    n_k = 0
    for k in range(n):
        if num[Z, k] > 0.0 or all_pressed:
            mark[HELD, n_k] = mark[CHOSEN, k]
            if grow_factor(W, L, mark[HELD], num[DOUBT], n_k):
                mark[PLACE, n_k] = k
                n_k += 1
    return n_k


def refine(
    inverse: Any,
    factored: bool,
    G: Any,
    W: Any,
    vec: Any,
    num: Any,
    mark: Any,
    L: Any,
    n: int,
    n_k: int,
    solved: bool,
) -> bool:
    """Correct z by what it leaves; False where that is no answer either. L is the factor of n_k rows, or n_k < 0."""
    size = 0.0
    for k in range(n):
        size = max(size, abs(num[B, k]))
    leftover(inverse, factored, G, vec, num, mark, n)
    for _ in range(REFINEMENTS):
        worst = 0.0
        for k in range(n):
            if num[Z, k] > 0.0 or not solved:
                worst = max(worst, abs(num[RESIDUAL, k]))
        if worst <= EPS * size:
            break
        if n_k < 0:
            n_k = factor_pressed(W, L, num, mark, n, not solved)
        for i in range(n_k):
            num[CHANGE, i] = -num[RESIDUAL, mark[PLACE, i]]
        solve_factored(L, n_k, num[CHANGE])
        largest = change = 0.0
        for i in range(n_k):
            num[Z, mark[PLACE, i]] += num[CHANGE, i]
            largest, change = (
                max(largest, abs(num[Z, mark[PLACE, i]])),
                max(change, abs(num[CHANGE, i])),
            )
        leftover(inverse, factored, G, vec, num, mark, n)
        if change <= SETTLED * largest:
            break
    answered = solved or presses(W, num, mark, n)
    for k in range(n):
        num[Z, k] = max(num[Z, k], 0.0)
    return answered


def keep_closed(G: Any, W: Any, MG: Any, vec: Any, num: Any, mark: Any, L: Any, n: int) -> bool:
    """Take out of the acceleration what rounding leaves of G a on the pressed contacts; whether there was any."""
    worst = 0.0
    for k in range(n):
        num[RESIDUAL, k] = product(G, vec[A], mark[CHOSEN, k]) if num[Z, k] > 0.0 else 0.0
        worst = max(worst, abs(num[RESIDUAL, k]))
    if worst == 0.0:
        return False
    n_k = factor_pressed(W, L, num, mark, n, False)
    for i in range(n_k):
        num[CHANGE, i] = -num[RESIDUAL, mark[PLACE, i]]
    solve_factored(L, n_k, num[CHANGE])
    for i in range(n_k):
        for j in range(vec.shape[1]):
            vec[A, j] += MG[mark[HELD, i], j] * num[CHANGE, i]
    return True


def presses(W: Any, num: Any, mark: Any, n: int) -> bool:
    """Whether z of an answer found without the solver pulls nowhere, and leaves no contact closing."""
    largest = 0.0
    for k in range(n):
        largest = max(largest, num[Z, k])
    for k in range(n):
        c, z = mark[CHOSEN, k], num[Z, k]
        if not z >= -PULLS * largest or num[RESIDUAL, k] < -PULLS * (abs(num[B, k]) + W[c, c] * abs(z)):
            return False
    return True
