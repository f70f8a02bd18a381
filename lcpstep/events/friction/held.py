"""The rows that the modes hold, as kernels: their multipliers x, sliding friction included.

    M a = f + C^T x,    R a + bias = 0 on the rows held,    C_c = N_c - s mu T_c where contact c slides (sign s)

The matrix R M^-1 C^T is not symmetric where a contact slides. It is factorised as L U row by row: joints, what
sticks, normals that slide (those that carry a force first); a row that depends on those before it is left out.
Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapters 5 and 6.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import LEANS, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.friction.equations import add_impulse, measure_rows, renew_rates
    from lcpstep.events.friction.on_joints import leave_joints
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.events.rows.equations import free_motion, measure_biases
    from lcpstep.events.rows.held import is_held
    from lcpstep.kernels.acceleration import inverse_mass
    from lcpstep.kernels.dynamics import total_force
    from lcpstep.kernels.vectors import add, clear, copy, product
    from lcpstep.pointers import Doubles, abs, after

DEPENDENT = 1e-12  # relative: what a row must have more of that the rows before it have not
REFINEMENTS = 2


def pull(s: Rubbing, i: int) -> float:
    """How much of the `other` force of its contact comes with that of row i.

    -s mu of the tangent's with a normal that slides or leans; the inverse of the normal's where the tangent of a
    contact that leans is held.
    """
    c = i - s.n_j
    if 0 <= c < s.n_c and s.mode[c] >= SLIDES:
        return -s.direction[c] * (s.mu[c] if s.mode[c] == SLIDES else s.mu_s[c])
    c -= s.n_c
    return -s.direction[c] / s.mu_s[c] if c >= 0 and s.mode[c] == LEANS else 0.0


def other(s: Rubbing, i: int) -> int:
    """The tangent of normal i, the normal of tangent i."""
    return i + s.n_c if i < s.n_j + s.n_c else i - s.n_c


def entry(s: Rubbing, i: int, k: int) -> float:
    """Row i of R M^-1 times column k of C^T; of contacts on the joints held."""
    share, W = pull(s, k), s.S if i >= s.n_j and k >= s.n_j else s.W
    d = W[i * s.n_r + k]
    return d + share * W[i * s.n_r + other(s, k)] if share != 0.0 else d


def first_between(s: Rubbing, i: int, k: int) -> int:
    """The first of the rows held that is still between rows i and k: `S` knows what joints are between contacts."""
    return s.n_kept if i >= s.n_j and k >= s.n_j else 0


def hold(s: Rubbing, i: int) -> bool:
    """Add row i to the rows held, unless it depends on them; False where sliding takes its force away."""
    k, r = s.rows.n_held, s.n_r
    s.rows.row[k] = i
    for m in range(k):
        up, low = entry(s, s.rows.row[m], i), entry(s, i, s.rows.row[m])
        for j in range(first_between(s, i, s.rows.row[m]), m):
            up -= s.L[m * r + j] * s.L[j * r + k]
            low -= s.L[k * r + j] * s.L[j * r + m]
        s.L[m * r + k] = up
        s.L[k * r + m] = low / s.L[m * r + m]
    pivot = entry(s, i, i)
    size = (s.W[i * r + i] if i < s.n_j else s.S[i * r + i]) + abs(pivot)
    for j in range(first_between(s, i, i), k):
        pivot -= s.L[k * r + j] * s.L[j * r + k]
        size += abs(s.L[k * r + j] * s.L[j * r + k])
    s.L[k * r + k] = pivot
    # of what leans on others the sign tells nothing: it does not slide
    if pivot > DEPENDENT * size or (pivot < -DEPENDENT * size and leans(s, i)):
        s.rows.n_held = k + 1
        return True
    return pivot >= -DEPENDENT * size


def leans(s: Rubbing, i: int) -> bool:
    """Whether row i is of a contact that leans on others."""
    return i >= s.n_j and s.mode[(i - s.n_j) % s.n_c] == LEANS


def hold_joints(s: Rubbing) -> None:
    """Hold the independent joints, and nothing else."""
    s.rows.n_held, s.mapped = 0, False
    for i in range(s.n_j):
        hold(s, i)
    leave_joints(s)


def accelerate_on_joints(s: Rubbing) -> None:
    """The acceleration with the joints alone held, into `a`; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    hold_joints(s)
    constrain(s, s.a, s.bias)


def accelerate_as_held(s: Rubbing) -> None:
    """The acceleration with the rows held, into `a`, and multipliers by row; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s, s.a, s.bias)
    list_multipliers(s)


def hold_modes(s: Rubbing) -> bool:
    """Hold what the modes hold; False where a sliding contact has no force that would (`culprit`).

    What sticks comes first: it may carry what a contact that leans on it, or slides beside it, could not by itself.
    """
    hold_joints(s)
    for c in range(s.n_c):
        if s.mode[c] == STICKS:
            hold(s, s.n_j + c)
    for c in range(s.n_c):
        if s.mode[c] == STICKS:
            hold(s, s.n_j + s.n_c + c)
    for unloaded in range(2):
        for c in range(s.n_c):
            if s.mode[c] >= SLIDES and s.loaded[c] == 1 - unloaded and not hold(s, s.n_j + c):
                s.culprit = c
                return False
        if unloaded == 0:
            hold_leaning(s)
    return True


def hold_leaning(s: Rubbing) -> None:
    """The tangents of loaded contacts that lean, whose normals depend on the rows held.

    Three feet on a line share two normals and one tangent: their forces are known from these three rows.
    """
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == LEANS and s.loaded[c] == 1 and not is_held(s.rows, i):
            hold(s, i + s.n_c)


def hold_again(s: Rubbing) -> bool:
    """The same rows with the matrices of another state; False where they have become dependent."""
    count = s.rows.n_held
    s.rows.n_held = 0
    for m in range(count):
        i = s.rows.row[m]
        if m == s.n_kept:
            leave_joints(s)
        hold(s, i)
        if s.rows.n_held != m + 1:
            s.culprit = i - s.n_j if s.n_j <= i < s.n_j + s.n_c else -1
            s.rows.n_held = count
            return False
    return True


def solve_held(s: Rubbing, x: Doubles) -> None:
    """X <- (L U)^-1 x."""
    r, k = s.n_r, s.rows.n_held
    for i in range(k):
        for j in range(i):
            x[i] -= s.L[i * r + j] * x[j]
    for i in range(k - 1, -1, -1):
        for j in range(i + 1, k):
            x[i] -= s.L[i * r + j] * x[j]
        x[i] /= s.L[i * r + i]


def push(s: Rubbing, i: int, x: float, a: Doubles) -> None:
    """A <- a + M^-1 C_i^T x."""
    share, n = pull(s, i), s.n_q
    for j in range(n):
        a[j] += s.MR[i * n + j] * x
        if share != 0.0:
            a[j] += share * s.MR[other(s, i) * n + j] * x


def constrain(s: Rubbing, a: Doubles, bias: Doubles) -> None:
    """A, which comes free, such that R a + bias = 0 on the rows held; multipliers into `x`."""
    clear(s.x, s.rows.n_held)
    for _ in range(REFINEMENTS if s.rows.n_held > 0 else 0):
        for m in range(s.rows.n_held):
            i = s.rows.row[m]
            s.change[m] = -bias[i] - product(s.R, a, i, s.n_q)
        if nothing(s.change, s.rows.n_held):
            break
        solve_held(s, s.change)
        for m in range(s.rows.n_held):
            s.x[m] += s.change[m]
            push(s, s.rows.row[m], s.change[m], a)


def nothing(x: Doubles, n: int) -> bool:
    """Whether all entries are exactly zero."""
    total = 0.0
    for i in range(n):
        total += abs(x[i])
    return total == 0.0


def right_hand_side(s: Rubbing, t: float, y: Doubles, dy: Doubles) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite, or they cannot be held."""
    n = s.n_q
    a = after(dy, n)
    copy(dy, after(y, n), n)
    if s.measured:
        accelerate(s, t, y, a)
        return a[0] - a[0] == 0.0
    if not free_motion(s.rows, t, y, after(y, s.n_q), a):
        return False
    if s.rows.n_held > 0:
        if not measure_rows(s, t, y) or not (s.constant or hold_again(s)):
            return False
        constrain(s, a, s.bias)
    list_multipliers(s)
    return a[0] - a[0] == 0.0


def accelerate(s: Rubbing, t: float, y: Doubles, a: Doubles) -> None:
    """Acceleration, and multipliers by row, where rows and masses never change: linear in forces and biases."""
    n, m = s.n_q, s.n_q + s.n_r
    if not s.mapped:
        map_forces(s)
    total_force(s.model, s.clock.inside(t), y, after(y, n), s.force)
    clear(s.effect, m)
    for j in range(n):
        add(s.effect, s.force[j], after(s.effects, j * m), m)
    if s.moving and s.rows.n_held > 0:
        renew_rates(s, t, y)
        measure_biases(s.rows, t, y, after(y, s.n_q))
        for i in range(s.n_r):
            add(s.effect, s.bias[i], after(s.effects, (n + i) * m), m)
    copy(a, s.effect, n)


def map_forces(s: Rubbing) -> None:
    """What each force does alone, and each bias."""
    n, r, a, bias = s.n_q, s.n_r, s.dv, s.shifted_rate
    for k in range(n + r if s.moving else n):
        clear(a, n)
        clear(bias, r)
        if k < n:
            a[k] = 1.0
            inverse_mass(s.model, s.rows.M, s.rows.work, a)
        else:
            bias[k - n] = 1.0
        constrain(s, a, bias)
        list_multipliers(s)
        copy(s.effect, a, n)
        copy(after(s.effects, k * (n + r)), s.effect, n + r)
    s.mapped = True


def list_multipliers(s: Rubbing) -> None:
    """Forces by row from those of the rows held: the friction of sliding contacts on their tangents."""
    clear(s.multiplier, s.n_r)
    for m in range(s.rows.n_held):
        i = s.rows.row[m]
        s.multiplier[i] = s.multiplier[i] + s.x[m]
        share = pull(s, i)
        if share != 0.0:
            s.multiplier[other(s, i)] = s.multiplier[other(s, i)] + share * s.x[m]


def stop_rows(s: Rubbing) -> None:
    """Impulses on the rows held, sliding friction included, that take their velocities."""
    copy(s.dv, s.v, s.n_q)
    constrain(s, s.dv, s.rate)
    copy(s.v, s.dv, s.n_q)
    count_impulses(s, s.x)


def count_impulses(s: Rubbing, x: Doubles) -> None:
    """Count impulses of the rows held, with the friction of those that slide."""
    for m in range(s.rows.n_held):
        i = s.rows.row[m]
        add_impulse(s, i, x[m])
        share = pull(s, i)
        if share != 0.0:
            add_impulse(s, other(s, i), share * x[m])
