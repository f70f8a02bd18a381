"""Rows of joints, contacts and tangents that are held, as kernels: their multipliers x.

    M a = f + C^T x,    R a + bias = 0 on the rows held,    C_i = R_i + share_i R_other

The force of a normal may come with one of its tangent, its share, as where a contact slides with friction; without
friction C is R. The matrix R M^-1 C^T is factorised as L U row by row, a row that depends on those before it being
left out; answers are refined, for the matrix has lost the digits of large mass ratios. Sources: V. Acary,
B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3; F. Pfeiffer, C. Glocker,
Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapters 5 and 6.
"""

from __future__ import annotations

import cython

from lcpstep.events.rows.equations import acceleration_of, other, size_of, size_of_acceleration
from lcpstep.events.rows.on_joints import leave_joints, leave_joints_again, put_on_joints
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.acceleration import inverse_mass
from lcpstep.kernels.linear import solve_triangles
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import add, clear, copy, largest, product
from lcpstep.pointers import Doubles, abs, after, inf, max

DEPENDENT = 2.0**-48  # relative rounding: what a row must have more of that the rows before it have not
TAKEN_OUT = 2.0**-45  # of a row's mobility: what taking joints out of the row leaves in it, in the same unit
REFINEMENTS = 6
ROUNDED = 64.0 * RESOLUTION  # of multipliers: corrections that leave nothing but rounding
PARTED = 1e3  # tolerances by which joints that say the same may differ
DRIFT = 1e-9  # of the terms of an acceleration: one that the rows held do not keep at zero
DISAGREEMENT = 1e-8  # relative acceleration that joints may not agree about


def is_held(s: Rows, i: int) -> bool:
    """Whether row i is among the rows held."""
    found = False
    for m in range(s.n_held):
        found = found or s.row[m] == i
    return found


def entry(s: Rows, i: int, k: int) -> float:
    """Row i of R M^-1 times column k of C^T; of contacts and tangents on the joints held."""
    W = s.D_on if i >= s.n_j and k >= s.n_j else s.D
    d = W[i * s.n_r + k]
    return d if s.share[k] == 0.0 else d + s.share[k] * W[i * s.n_r + other(s, k)]


def first_between(s: Rows, i: int, k: int) -> int:
    """From which held row on the elimination runs: the joints are already out of `D_on`."""
    return s.n_kept if i >= s.n_j and k >= s.n_j else 0


def hold(s: Rows, i: int) -> bool:
    """Add row i to the rows held, unless it depends on them as far as rounding lets tell.

    False where its pivot is negative: a force on it, beside those rows, would move it the other way. Where `either`
    way is allowed such a row is held, too.
    """
    k, r = s.n_held, s.n_r
    s.row[k] = i
    pivot, first, start = entry(s, i, i), first_between(s, i, i), k
    size = abs(pivot) + (TAKEN_OUT * s.D[i * r + i] if s.n_kept > 0 and i >= s.n_j else 0.0)
    for m in range(k - 1, -1, -1):
        j = s.row[m]
        s.L[k * r + m] = s.L[m * r + k] = entry(s, i, j)
        if s.n_t > 0:  # without friction it is all symmetric
            s.L[m * r + k] = entry(s, j, i)
        if s.L[k * r + m] != 0.0 or s.L[m * r + k] != 0.0:
            start = m  # of the rows that this one is coupled with: those of a chain are few
    for m in range(start, k):
        rounding = grow(s, i, m, start)
        if m >= first:
            pivot -= s.L[k * r + m] * s.L[m * r + k]
            size += rounding
    s.L[k * r + k], s.pivot_error[k] = pivot, size / abs(pivot) if pivot != 0.0 else 0.0
    if pivot > DEPENDENT * size or (pivot < -DEPENDENT * size and s.either[i] == 1):
        s.n_held = k + 1
        return True
    return pivot >= -DEPENDENT * size


def grow(s: Rows, i: int, m: int, start: int) -> float:
    """Entries m of L and U for row i, which comes next; what rounding leaves of their product, in roundings."""
    k, r, first = s.n_held, s.n_r, first_between(s, i, s.row[m])
    first = start if start > first else first
    low, less = what_is_left(s, k, m, first)
    up, more = low, less
    if s.n_t > 0:
        up, more = what_is_left(s, m, k, first)
    s.L[m * r + k], s.L[k * r + m] = up, low / s.L[m * r + m]
    return abs(low / s.L[m * r + m]) * (more + abs(up) * s.pivot_error[m]) + abs(up / s.L[m * r + m]) * less


def what_is_left(s: Rows, i: int, k: int, first: int) -> tuple[float, float]:
    """Entry i, k without what the rows held from the first on have of it; and the size of its terms."""
    r, x = s.n_r, s.L[i * s.n_r + k]
    size = abs(x)
    for n in range(first, i if i < k else k):
        share = s.L[i * r + n] * s.L[n * r + k]
        x -= share
        size += abs(share)
    return x, size


def hold_joints(s: Rows) -> None:
    """Hold the independent joints, and nothing else."""
    if s.on_joints:
        s.n_held = s.n_kept
        return
    s.n_held = s.n_kept = 0
    for i in range(s.n_j):
        put_on_joints(s, i)
        hold(s, i)
        s.n_kept = s.n_held
    leave_joints(s)


def hold_again(s: Rows) -> int:
    """The same rows with the matrices of another state; the first that has become dependent, or -1."""
    count, dependent = s.n_held, -1
    s.n_held, s.n_kept, s.on_joints = 0, 0, False
    for m in range(count):
        i = s.row[m]
        if i < s.n_j:
            put_on_joints(s, i)
            s.n_kept = m + 1
        elif m == s.n_kept:
            leave_joints_again(s, count)
        hold(s, i)
        if s.n_held != m + 1:
            dependent = i
            break
    s.n_held = count
    return dependent


def solve_held(s: Rows, x: Doubles) -> None:
    """X <- (L U)^-1 x."""
    solve_triangles(s.L, s.n_r, s.n_held, x)


def add_column(s: Rows, R: Doubles, i: int, x: float, a: Doubles) -> None:
    """A <- a + C_i^T x, made of the rows R; or M^-1 of it, made of M^-1 R^T."""
    add(a, x, after(R, i * s.n_q), s.n_q)
    if s.share[i] != 0.0:
        add(a, s.share[i] * x, after(R, other(s, i) * s.n_q), s.n_q)


def push_by_change(s: Rows, x: Doubles) -> None:
    """X <- x + M^-1 C^T z with R M^-1 C^T z = `change`, which becomes z."""
    solve_held(s, s.change)
    for m in range(s.n_held):
        add_column(s, s.MR, s.row[m], s.change[m], x)


def constrain(s: Rows, a: Doubles, bias: Doubles) -> None:
    """A, which comes free, such that R a + bias = 0 on the rows held; multipliers into `held`."""
    k, error = s.n_held, inf
    clear(s.held, k)
    for _ in range(REFINEMENTS if k > 0 else 0):
        measure_missing(s, a, bias)
        if largest(s.change, 0.0, k) == 0.0:
            break
        push_by_change(s, a)
        add(s.held, 1.0, s.change, k)
        before, error = error, largest(s.change, 0.0, k)
        if error <= ROUNDED * largest(s.held, 0.0, k) or not error < 0.5 * before:
            break


def measure_missing(s: Rows, a: Doubles, bias: Doubles) -> None:
    """What R a + bias is off from zero on the rows held, into `change`, with its sign turned."""
    for m in range(s.n_held):
        s.change[m] = -bias[s.row[m]] - product(s.R, a, s.row[m], s.n_q)


def balance(s: Rows, a: Doubles) -> None:
    """The acceleration a that `constrain` has found, anew from its forces, M a = f + C^T x.

    Forces that cancel, f lies in `force`, do so exactly where the accelerations that each of them makes do not. What
    rounding of large ones leaves is taken out: the motion must stay on the surfaces.
    """
    copy(a, s.force, s.n_q)
    for m in range(s.n_held):
        add_column(s, s.R, s.row[m], s.held[m], a)
    inverse_mass(s.model, s.M, s.work, a)
    measure_missing(s, a, s.bias)
    push_by_change(s, a)


def size_of_pushes(s: Rows) -> float:
    """Size of the accelerations that the forces of the rows held make, each by itself."""
    most = 0.0
    for j in range(s.n_q):
        size = 0.0
        for m in range(s.n_held):
            size += abs(s.MR[s.row[m] * s.n_q + j] * s.held[m])
        most = max(most, size)
    return most


def contradiction(s: Rows, a: Doubles) -> int:
    """The first joint left out whose acceleration is not zero under that of the others, or -1."""
    for i in range(s.n_j):
        off = abs(acceleration_of(s, i, a))
        if not is_held(s, i) and off > DISAGREEMENT * size_of_acceleration(s, i, a):
            return i
    return -1


def parted(s: Rows, gap: Doubles, q: Doubles) -> int:
    """The first joint left out that the others have not kept closed, or -1; gaps and rows must be those of q.

    It is as far open as these, of which long steps leave more than the tolerance.
    """
    left = 0.0
    for i in range(s.n_j):
        left = max(left, abs(gap[i]) if is_held(s, i) else 0.0)
    for i in range(s.n_j):
        if not is_held(s, i) and abs(gap[i]) > PARTED * (s.atol + s.rtol * size_of(s, i, 0.0, q) + left):
            return i
    return -1
