"""The rows of a step in which normals, tangents and joints act together.

A row is a direction h of the velocities with its rate u = h v + h_t and its impulse; `ids` lists the rows that take
part in a step, the normals of the active contacts first, then tangents, then joints. Matrices of all n rows lie row
by row: H and X have n_q columns, W has n. See `theta_method.theta_step`.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.linear import solve_definite
    from lcpstep.kernels.vectors import copy, largest, product
    from lcpstep.pointers import Doubles, Indices, abs, after, max

CONVERGED = 1e-12  # change of the velocity, relative to it
CANCELLED = 0.1  # of the terms that it is the sum of: near rest it cannot be known better than these
ROUNDING = 1e-13  # of these terms: what is left of it is no motion
NO_APPROACH = 1e-11  # of the terms of a frictional contact's rate
CONTRADICTION = 1e-9  # of the terms of a joint's rate: what may be left of it


def take_part(ids: Indices, carrier: Indices, mu: Doubles, n_a: int, n_c: int, n_t: int, n_j: int) -> int:
    """List after the normals of active contacts the tangents of the n_f frictional ones, and all joints; n_f."""
    n_f = 0
    if n_t > 0:
        for k in range(n_a):
            if mu[ids[k]] > 0.0:
                carrier[n_f] = k
                ids[n_a + n_f] = n_c + ids[k]
                n_f += 1
    for j in range(n_j):
        ids[n_a + n_f + j] = n_c + n_t + j
    return n_f


def position(
    h: float, theta: float, q: Doubles, v: Doubles, v_next: Doubles, q_next: Doubles, n_q: int
) -> None:
    """q + h [theta v+ + (1 - theta) v]."""
    for i in range(n_q):
        q_next[i] = q[i] + h * (theta * v_next[i] + (1.0 - theta) * v[i])


def average(J: Doubles, J_start: Doubles, theta: float, D: Doubles, size: int) -> None:
    """Directions of the joints' forces."""
    for i in range(size):
        D[i] = theta * J[i] + (1.0 - theta) * J_start[i]


def mobilities(H: Doubles, X: Doubles, ids: Indices, n_k: int, W: Doubles, n: int, n_q: int) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k] * n + ids[m]] = product(H, after(X, ids[m] * n_q), ids[k], n_q)


def rates(
    H: Doubles, H_t: Doubles, v: Doubles, ids: Indices, n_k: int, rough: int, b: Doubles, n_q: int
) -> None:
    """H v + g_t on the rows that take part; zero on the first `rough` ones where it is nothing but rounding.

    For a frictional contact that stays closed has no approach: whether it jams must not hang on a rounding's sign.
    """
    for k in range(n_k):
        i = ids[k]
        b[i] = product(H, v, i, n_q) + H_t[i]
    for k in range(rough):
        i = ids[k]
        terms = abs(H_t[i])
        for j in range(n_q):
            terms += abs(H[i * n_q + j] * v[j])
        if not abs(b[i]) > NO_APPROACH * terms:
            b[i] = 0.0


def usable(b: Doubles, W: Doubles, ids: Indices, n_k: int, n: int) -> bool:
    """Whether the problem is finite."""
    total = 0.0
    for k in range(n_k):
        total += b[ids[k]] - b[ids[k]]
        for m in range(n_k):
            total += W[ids[k] * n + ids[m]] - W[ids[k] * n + ids[m]]
    return total == 0.0


def restitute(u: Doubles, r: Doubles, ids: Indices, n_a: int, b: Doubles) -> None:
    """B <- b + r u on the normals."""
    for k in range(n_a):
        b[ids[k]] += r[ids[k]] * u[ids[k]]


def strikes(u: Doubles, v: Doubles, H: Doubles, ids: Indices, n_a: int, b: Doubles, n_q: int) -> bool:
    """Whether a contact closes faster than the forces of one step could move it; b: rates without restitution."""
    size_v = largest(v, 0.0, n_q)
    for k in range(n_a):
        i = ids[k]
        size = largest(after(H, i * n_q), 0.0, n_q)
        if u[i] < -(abs(b[i] - u[i]) + ROUNDING * size * size_v):
            return True
    return False


def apply(
    v: Doubles,
    v_free: Doubles,
    X: Doubles,
    p: Doubles,
    ids: Indices,
    n_f: int,
    n_k: int,
    v_next: Doubles,
    n_q: int,
) -> bool:
    """v_next = v_free + X^T p; whether that has hardly changed it.

    Where friction acts, a velocity that is nothing but rounding is zero: what sticks is at rest.
    """
    change = size = 0.0
    for i in range(n_q):
        total, terms = v_free[i], abs(v_free[i])
        for k in range(n_k):
            term = X[ids[k] * n_q + i] * p[ids[k]]
            total += term
            terms += abs(term)
        if n_f > 0 and abs(total) <= ROUNDING * terms:
            total = 0.0
        change = max(change, abs(total - v_next[i]))
        size = max(max(size, abs(total)), max(abs(v[i]), CANCELLED * terms))
        v_next[i] = total
    return change <= CONVERGED * size


def joints_hold(
    J: Doubles, J_t: Doubles, J_start: Doubles, n_j: int, v: Doubles, v_free: Doubles, v_next: Doubles, n_q: int,
    X: Doubles, p: Doubles, n: int, turning: float, failed: Indices,
) -> bool:  # fmt: skip
    """Whether the joints' rates are zero after the step; marks those for which they are not.

    Redundant joints agree on the joints' positions only, so what the joints turn by in the step is granted. What
    the impulses p of all n rows change a velocity by, X^T p, counts to its size: with unequal masses it is much more
    than the rest.
    """
    hold = True
    for j in range(n_j):
        rate, size, turned = J_t[j], abs(J_t[j]), 0.0
        for i in range(n_q):
            row = J[j * n_q + i]
            rate += row * v_next[i]
            speed = max(max(abs(v_next[i]), abs(v[i])), abs(v_free[i]))
            for k in range(n):
                speed = max(speed, abs(X[k * n_q + i] * p[k]))
            size += abs(row) * speed
            turned += abs(row - J_start[j * n_q + i]) * speed
        failed[j] = 0 if abs(rate) <= CONTRADICTION * size + turning * turned else 1
        hold = hold and failed[j] == 0
    return hold


def divide_by_mass(
    constant: bool, inverse: Doubles, L: Doubles, row: Doubles, out: Doubles, n_q: int
) -> None:
    """Out <- M^-1 row, by the inverse of a constant mass or else by Cholesky's factor L."""
    copy(out, row, n_q)
    if constant:
        for i in range(n_q):
            out[i] = product(inverse, row, i, n_q)
    else:
        solve_definite(L, out, n_q)
