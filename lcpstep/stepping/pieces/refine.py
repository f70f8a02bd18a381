"""Impulses and forces of several contacts to the last digit: `Located`'s complementarity problems.

The Delassus matrix W = G A^-1 G^T rounds away what a heavy body adds to a light one: solved from W alone, forces lose
log10(mass ratio) digits. What is left of

    b + G A^-1 (G^T z) = 0        on the contacts with z > 0

is therefore formed from the bodies' own data, forces summed before they are divided by masses, and W gives but the
correction. That all contacts are pressed is tried first, since it is so in most piles and costs a sixth of the
solver; and again where W is too rough for the solver. Contacts that depend on others get no correction of their own.

Impulses of contacts that depend on each other are not unique. Those that bear any are made independent, see
`independent`, and go on bearing while none of the others closes by more than rounding: so answers last.
Source: N. Higham, Accuracy and Stability of Numerical Algorithms, chapter 12.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.linear import grow_factor, solve_definite, solve_factored
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.vectors import clear, copy, largest, product
from lcpstep.lcp.kernel import solve_small
from lcpstep.lcp.status import SOLVED
from lcpstep.pointers import Doubles, abs, after, max
from lcpstep.stepping.pieces.codes import INERTIA
from lcpstep.stepping.pieces.independent import bear_on_independent
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, speed_terms
from lcpstep.stepping.pieces.smooth import mobilities, push_held
from lcpstep.stepping.pieces.state import Plan, Work

NONE, FORCES, IMPULSES = range(3)  # what a guess is of
REFINEMENTS = 6
SETTLED = 4 * RESOLUTION  # correction, relative to the largest impulse, after which none is needed
EXACT = 8 * RESOLUTION  # residual, relative to the largest b, at which the forces of before are still right
PULLS = 1e-10  # relative to the largest impulse: what an answer found without the solver may lack


def solve_unrefined(w: Work, W: Doubles, n: int) -> bool:
    """The z of the chosen contacts by `solve_small`, from W alone; False where it finds none."""
    for i in range(n):
        for j in range(n):
            w.problem[i * n + j] = W[w.chosen[i] * w.n_c + w.chosen[j]]
    if solve_small(w.problem, w.b, w.z, n, w.lcp) != SOLVED:
        return False
    bear_on_independent(w, W, n)
    return True


def solve_several(m: Model, plan: Plan, w: Work, place: int, n: int, guess: int) -> bool:
    """The same of several: the guess if it is still right, who was pressed, all, or the solver's answer; refined."""
    W = mobilities(plan, w, place)
    if n == 1:
        return solve_unrefined(w, W, n)
    if right(m, plan, w, place, n):
        return True
    if guess != NONE:
        n_k = still_pressed(m, plan, w, W, n, guess)
        if n_k > 0:
            return refine(m, plan, w, place, n, n_k, True)
    if all_pressed(w, W, n):
        return refine(m, plan, w, place, n, n, True)
    solved = solve_unrefined(w, W, n)
    if not solved:
        clear(w.z, n)
    return refine(m, plan, w, place, n, -1, solved)


def all_pressed(w: Work, W: Doubles, n: int) -> bool:
    """Whether W z + b = 0 has an answer with z > 0 for all; that answer, and the factor of W."""
    if factor_pressed(w, W, n, True) < n:
        return False
    for k in range(n):
        w.z[k] = -w.b[k]
    solve_factored(w.problem, n, n, w.z)
    least, pressed = PULLS * largest(w.z, 0.0, n), True
    for k in range(n):
        pressed = pressed and w.z[k] > least
    return pressed


def still_pressed(m: Model, plan: Plan, w: Work, W: Doubles, n: int, guess: int) -> int:
    """How many the guess presses, if they alone are the answer to rounding, which goes to w.z; their factor.

    Else 0, and the guess is as it was.
    """
    n_k = factor_pressed(w, W, n, False)
    for i in range(n_k):
        w.change[i] = -w.b[w.place[i]]
    solve_factored(w.problem, n, n_k, w.change)
    least = PULLS * largest(w.change, 0.0, n_k)
    for i in range(n_k):
        if not w.change[i] > least:
            return 0
    i = 0
    for k in range(n):
        if i < n_k and w.place[i] == k:
            i += 1
        elif w.z[k] > 0.0 or closes(m, plan, w, W, k, n_k, guess):
            return 0
    for i in range(n_k):
        w.z[w.place[i]] = w.change[i]
    return n_k


def closes(m: Model, plan: Plan, w: Work, W: Doubles, k: int, n_k: int, guess: int) -> bool:
    """Whether the k-th chosen contact closes by more than rounding while n_k are pressed, by w.change."""
    c, u, size = w.chosen[k], w.b[k], 0.0
    for i in range(n_k):
        change = W[c * w.n_c + w.held[i]] * w.change[i]
        u += change
        size += abs(change)
    if u >= 0.0:
        return False
    size += acceleration_terms(m, w, c) if guess == FORCES else speed_terms(plan, w, c)
    return -u > NOISE * size


def right(m: Model, plan: Plan, w: Work, place: int, n: int) -> bool:
    """Whether the guess, positive for all, is the answer: what rests keeps its forces from step to step."""
    for k in range(n):
        if not w.z[k] > 0.0:
            return False
    leftover(m, plan, w, place, n)
    return largest(w.residual, 0.0, n) <= EXACT * largest(w.b, 0.0, n)


def leftover(m: Model, plan: Plan, w: Work, place: int, n: int) -> None:
    """b + G A^-1 (G^T z) of the chosen contacts, into w.residual; A^-1 G^T z into w.jolt."""
    force, jolt, n_q = w.a_try, w.jolt, w.n_q
    clear(force, n_q)
    for k in range(n):
        if w.z[k] != 0.0:
            c = w.chosen[k]
            for i in range(w.first_coordinate[c], w.last_coordinate[c] + 1):
                force[i] += w.G[c * w.n_q + i] * w.z[k]
    if place == INERTIA and m.mass.given:
        copy(jolt, force, n_q)
        solve_definite(w.M, jolt, n_q)
    else:
        inverse = m.M_inverse if place == INERTIA else after(plan.A_inverse, place * n_q * n_q)
        clear(jolt, n_q)
        for j in range(n_q):
            if force[j] != 0.0:
                for i in range(n_q):
                    jolt[i] += inverse[j * n_q + i] * force[j]
    for k in range(n):
        c, total = w.chosen[k], 0.0
        for i in range(w.first_coordinate[c], w.last_coordinate[c] + 1):
            total += w.G[c * w.n_q + i] * jolt[i]
        w.residual[k] = w.b[k] + total


def factor_pressed(w: Work, W: Doubles, n: int, everybody: bool) -> int:
    """Cholesky factor of W for the independent contacts with z > 0, into w.problem; their places into w.place."""
    n_k = 0
    for k in range(n):
        if w.z[k] > 0.0 or everybody:
            w.held[n_k] = w.chosen[k]
            if grow_factor(W, w.n_c, w.problem, n, w.held, w.doubt, n_k):
                w.place[n_k] = k
                n_k += 1
    return n_k


def refine(m: Model, plan: Plan, w: Work, place: int, n: int, n_k: int, solved: bool) -> bool:
    """Correct z by what it leaves; False where that is no answer either. n_k: rows of the factor; < 0: none yet."""
    W, size = mobilities(plan, w, place), largest(w.b, 0.0, n)
    leftover(m, plan, w, place, n)
    for _ in range(REFINEMENTS):
        worst = 0.0
        for k in range(n):
            if w.z[k] > 0.0 or not solved:
                worst = max(worst, abs(w.residual[k]))
        if worst <= RESOLUTION * size:
            break
        if n_k < 0:
            n_k = factor_pressed(w, W, n, not solved)
        most, change = correct(w, n, n_k)
        leftover(m, plan, w, place, n)
        if change <= SETTLED * most:
            break
    answered = solved or presses(w, W, n)
    if not answered and 0 < n_k < n:
        squeeze(w, W, n, n_k)
        leftover(m, plan, w, place, n)
        correct(w, n, n_k)
        leftover(m, plan, w, place, n)
        answered = presses(w, W, n)
    for k in range(n):
        w.z[k] = max(w.z[k], 0.0)
    return answered


def squeeze(w: Work, W: Doubles, n: int, n_k: int) -> None:
    """Add impulses that move nothing to an answer that pulls, until it presses everywhere, if by next to nothing.

    Bodies without clearance between two walls can be squeezed by any force: y with W y = 0. Each row left out of the
    factor, for it depends on those in it, gives one.
    """
    least, i = PULLS * largest(w.z, 0.0, n), 0
    for k in range(n):
        if i < n_k and w.place[i] == k:
            i += 1
            continue
        for j in range(n_k):
            w.change[j] = -W[w.held[j] * w.n_c + w.chosen[k]]
        solve_factored(w.problem, n, n_k, w.change)
        more = max(0.0, -w.z[k])
        for j in range(n_k):
            if w.change[j] > PULLS:
                more = max(more, -w.z[w.place[j]] / w.change[j])
        more += least
        for j in range(n_k):
            w.z[w.place[j]] += more * w.change[j]
        w.z[k] += more


def correct(w: Work, n: int, n_k: int) -> tuple[float, float]:
    """Add to z what the residual asks for; the largest impulse and the largest correction."""
    for i in range(n_k):
        w.change[i] = -w.residual[w.place[i]]
    solve_factored(w.problem, n, n_k, w.change)
    largest = change = 0.0
    for i in range(n_k):
        k = w.place[i]
        w.z[k] += w.change[i]
        largest, change = max(largest, abs(w.z[k])), max(change, abs(w.change[i]))
    return largest, change


def keep_closed(w: Work, W: Doubles, MG: Doubles, n: int) -> bool:
    """Take out of the acceleration what rounding leaves of G a on the pressed contacts; whether there was any."""
    worst = 0.0
    for k in range(n):
        pressed = w.z[k] > 0.0
        w.residual[k] = product(w.G, w.a, w.chosen[k], w.n_q) if pressed else 0.0
        worst = max(worst, abs(w.residual[k]))
    if worst == 0.0:
        return False
    n_k = factor_pressed(w, W, n, False)
    for i in range(n_k):
        w.change[i] = -w.residual[w.place[i]]
    push_held(w, MG, n, n_k, w.a)
    return True


def presses(w: Work, W: Doubles, n: int) -> bool:
    """Whether z of an answer found without the solver pulls nowhere, and leaves no contact closing."""
    most = largest(w.z, 0.0, n)
    for k in range(n):
        c, z = w.chosen[k], w.z[k]
        if not z >= -PULLS * most or w.residual[k] < -PULLS * (abs(w.b[k]) + W[c * w.n_c + c] * abs(z)):
            return False
    return True
