"""The rows of a step in which normals, tangents and joints act together: small kernels on plain arrays.

A row is a direction h of the velocities with its rate u = h v + h_t and its impulse; `ids` lists the rows that take
part in a step, the normals of the active contacts first, then tangents, then joints. See `constrained`.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dynamics import product

CANCELLED = 0.1  # of these terms: as in `theta`, the size by which a change of it is judged
ROUNDING = 1e-13  # of the terms that a velocity is the sum of: what is left of it is no motion
NO_APPROACH = 1e-11  # of the terms of a frictional contact's rate
CONTRADICTION = 1e-9  # of the terms of a joint's rate: what may be left of it


def take_part(active: Any, mu: Any, ids: Any, carrier: Any, n_a: int, n_t: int, n_j: int) -> int:
    """List the rows of the step: normals of active contacts, tangents of the n_f frictional ones, all joints."""
    n_f, n_c = 0, len(mu)
    for k in range(n_a):
        ids[k] = active[k]
    for k in range(n_a):
        if n_t > 0 and mu[active[k]] > 0.0:
            carrier[n_f] = k
            ids[n_a + n_f] = n_c + active[k]
            n_f += 1
    for j in range(n_j):
        ids[n_a + n_f + j] = n_c + n_t + j
    return n_f


def position(h: float, theta: float, q: Any, v: Any, v_next: Any, q_next: Any) -> None:
    """q + h [theta v+ + (1 - theta) v]."""
    for i in range(len(q)):
        q_next[i] = q[i] + h * (theta * v_next[i] + (1.0 - theta) * v[i])


def average(J: Any, J_start: Any, theta: float, D: Any) -> None:
    """Directions of the joints' forces."""
    for j in range(len(J)):
        for i in range(J.shape[1]):
            D[j, i] = theta * J[j, i] + (1.0 - theta) * J_start[j, i]


def mobilities(H: Any, X: Any, ids: Any, n_k: int, W: Any) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k], ids[m]] = product(H, X[ids[m]], ids[k])


def rates(H: Any, H_t: Any, v: Any, ids: Any, n_k: int, rough: int, b: Any) -> None:
    """H v + g_t on the rows that take part; zero on the first `rough` ones where it is nothing but rounding.

    For a frictional contact that stays closed has no approach: whether it jams must not hang on a rounding's sign.
    """
    for k in range(n_k):
        i = ids[k]
        total, terms = H_t[i], abs(H_t[i])
        for j in range(len(v)):
            total += H[i, j] * v[j]
            terms += abs(H[i, j] * v[j])
        b[i] = total if k >= rough or abs(total) > NO_APPROACH * terms else 0.0


def usable(b: Any, W: Any, ids: Any, n_k: int) -> bool:
    """Whether the problem is finite."""
    total = 0.0
    for k in range(n_k):
        total += b[ids[k]] - b[ids[k]]
        for m in range(n_k):
            total += W[ids[k], ids[m]] - W[ids[k], ids[m]]
    return total == 0.0


def restitute(
    u: Any,
    sliding: Any,
    v: Any,
    H: Any,
    r: Any,
    r_tangent: Any,
    ids: Any,
    carrier: Any,
    n_a: int,
    n_f: int,
    b: Any,
) -> None:
    """b <- b + r u on the normals and, where something strikes, on the tangents."""
    largest, impact = 0.0, False
    for i in range(len(v)):
        largest = max(largest, abs(v[i]))
    for k in range(n_a):
        i = ids[k]
        size = 0.0
        for j in range(len(v)):
            size = max(size, abs(H[i, j]))
        impact = impact or u[i] < -(abs(b[i] - u[i]) + ROUNDING * size * largest)
        b[i] += r[i] * u[i]
    if impact:
        for f in range(n_f):
            i = ids[carrier[f]]
            b[ids[n_a + f]] += r_tangent[i] * sliding[i]


def apply(v: Any, v_free: Any, X: Any, p: Any, ids: Any, n_f: int, n_k: int, v_next: Any) -> float:
    """v_next = v_free + X^T p; how much it changed, relative to the velocities' size.

    Where friction acts, a velocity that is nothing but rounding is zero: what sticks is at rest.
    """
    change = size = 0.0
    for i in range(len(v)):
        total, terms = v_free[i], abs(v_free[i])
        for k in range(n_k):
            term = X[ids[k], i] * p[ids[k]]
            total += term
            terms += abs(term)
        if n_f > 0 and abs(total) <= ROUNDING * terms:
            total = 0.0
        change = max(change, abs(total - v_next[i]))
        size = max(size, abs(total), abs(v[i]), CANCELLED * terms)
        v_next[i] = total
    return change / size if change > 0.0 else 0.0


def joints_hold(
    J: Any,
    J_t: Any,
    J_start: Any,
    v: Any,
    v_free: Any,
    v_next: Any,
    X: Any,
    p: Any,
    turning: float,
    failed: Any,
) -> bool:
    """Whether the joints' rates are zero after the step; marks those for which they are not.

    Redundant joints agree on the joints' positions only, so what the joints turn by in the step is granted. What
    the impulses p change a velocity by, X^T p, counts to its size: with unequal masses it is much more than the rest.
    """
    hold = True
    for j in range(len(J_t)):
        rate, size, turned = J_t[j], abs(J_t[j]), 0.0
        for i in range(len(v)):
            rate += J[j, i] * v_next[i]
            speed = max(abs(v_next[i]), abs(v[i]), abs(v_free[i]))
            for k in range(len(p)):
                speed = max(speed, abs(X[k, i] * p[k]))
            size += abs(J[j, i]) * speed
            turned += abs(J[j, i] - J_start[j, i]) * speed
        failed[j] = 0 if abs(rate) <= CONTRADICTION * size + turning * turned else 1
        hold = hold and failed[j] == 0
    return hold
