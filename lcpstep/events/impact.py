"""The two complementarity problems of a set of closed contacts, as kernels; joints are eliminated from both.

Impact (velocities):           0 <= u+ + r u-  complementary to  p >= 0        u+ = u- + W p        (Newton, Moreau)
Contact forces (accelerations): 0 <= alpha  complementary to  lambda >= 0      alpha = alpha_0 + W lambda

W = D_cc - D_cj D_jj^-1 D_jc, the Delassus matrix of the contacts on the joints. An impact takes all contacts that
are closed, to rounding, and do not separate: so the energy falls by sum (1 - r) |u-| p / 2 whatever the restitution
of each. A contact that has separated at the same instant and is pushed back strikes anew, in a problem of its own.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapters 3 and 5.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import call_solver
from lcpstep.dense import assign
from lcpstep.dynamics import product
from lcpstep.events.equations import (
    ACCELERATION,
    BIAS,
    CLOSED,
    CULPRIT,
    CURVE,
    FREE_ACCELERATION,
    GAP,
    HELD,
    HELD_JOINTS,
    HELD_ROWS,
    IMPULSE,
    LCP_B,
    LCP_Z,
    LOADED,
    MEMBERS,
    MULTIPLIER,
    NOISE,
    RATE,
    REFINEMENTS,
    SPEED,
    SYNCHRONOUS,
    WORK,
    Q,
    V,
    bias_of,
    constrain,
    contradiction,
    hold,
    hold_contacts,
    hold_joints,
    inverse_mass,
    solve_held,
)
from lcpstep.lcp.status import SOLVED

DONE, NO_SOLUTION, CONTRADICTION = range(3)
LARGE = 1e-6  # of the largest coordinate: what difference of coordinates has digits enough
CHECKED = 1e-10  # relative violation that an answer found without the solver may have


def contact_matrix(s: Any, W: Any) -> None:
    """W of the member contacts; the joints must be the rows held."""
    n_j, k_j, k = len(s.J), s.number[HELD_JOINTS], s.number[MEMBERS]
    for a in range(k):
        i = n_j + s.member[a]
        for m in range(k_j):  # the rows of the Cholesky factor that follow the joints'
            total = s.D[i, s.row[m]]
            for j in range(m):
                total -= s.L[k_j + a, j] * s.L[m, j]
            s.L[k_j + a, m] = total / s.L[m, m]
        for b in range(a + 1):
            total = s.D[i, n_j + s.member[b]]
            for m in range(k_j):
                total -= s.L[k_j + a, m] * s.L[k_j + b, m]
            W[a, b] = W[b, a] = total


def solve_contacts(s: Any, lcp: Any, solver: Any) -> bool:
    """Solve the members' problem with b in LCP_B; z, at least zero, into LCP_Z, and who carries a force.

    Where the solver fails (W has lost too many digits), all that could are said to carry one, with z = 0: an
    answer to be checked.
    """
    k = s.number[MEMBERS]
    z, b = s.contact[LCP_Z], s.contact[LCP_B]
    W = s.W[: k * k].reshape((k, k))
    for a in range(k):
        z[a] = 0.0
    contact_matrix(s, W)
    solved = bool(call_solver(solver, W, b[:k], z[:k], lcp) == SOLVED)
    for a in range(k):
        z[a] = z[a] if solved else 0.0
        s.mode[LOADED, s.member[a]] = 1 if z[a] > 0.0 or not solved else 0
    return solved


def strike(model: Any, s: Any, lcp: Any, solver: Any, tracked: bool) -> int:
    """The impact of the contacts whose gap is zero and that do not separate; p into LCP_Z, by member.

    Velocities and contact speeds are those after it; see `apply` for `tracked`. NO_SOLUTION where none exists.
    """
    speed = speed_noise(s)
    s.number[MEMBERS] = 0
    for c in range(len(s.G)):
        s.mode[LOADED, c] = 0
        u = 0.0 if s.mode[CLOSED, c] == 1 else s.contact[SPEED, c]
        if s.mode[CLOSED, c] == 1 or (s.contact[GAP, c] == 0.0 and u <= speed):
            s.member[s.number[MEMBERS]] = c
            s.contact[LCP_B, s.number[MEMBERS]] = (1.0 + model.restitution[c]) * min(u, 0.0)
            s.number[MEMBERS] += 1
    hold_joints(s)
    solved = solve_contacts(s, lcp, solver)
    largest = impulses(model, s)
    for a in range(s.number[MEMBERS]):
        if s.contact[LCP_Z, a] < 0.0:
            if not solved and s.contact[LCP_Z, a] < -CHECKED * largest:
                return NO_SOLUTION
            s.contact[LCP_Z, a] = s.change[s.number[HELD_JOINTS] + a] = 0.0
    if not solved and not separates(s):
        return NO_SOLUTION
    apply(s, tracked)
    return DONE


def impulses(model: Any, s: Any) -> float:
    """Impulses of the members, of which LCP_Z is a guess, and of the joints into `change`; returns the largest.

    They give the loaded members the speeds of the law; corrected with the residual of M (v+ - v-) = R^T p itself.
    """
    n_j, n, k, dv = len(s.J), s.state.shape[1], s.number[MEMBERS], s.state[WORK]
    hold_joints(s)
    k_j = s.number[HELD_JOINTS]
    for m in range(len(s.change)):
        s.change[m] = s.held[m] = 0.0
    for a in range(k):
        s.held[n_j + s.member[a]] = s.contact[LCP_Z, a]  # by row, not by place in the list of rows held
    for a in range(k):
        if s.mode[LOADED, s.member[a]] == 1:
            hold(s, n_j + s.member[a])
    h = s.number[HELD_ROWS]
    before = math.inf
    for _ in range(REFINEMENTS if k + k_j > 1 else 0):  # one impulse alone loses no digits
        for j in range(n):
            dv[j] = 0.0
            for i in range(len(s.R)):
                if s.held[i] != 0.0:
                    dv[j] += s.R[i, j] * s.held[i]
        inverse_mass(model, s, dv)
        error = 0.0
        for m in range(h):
            s.change[m] = -product(s.R, dv, s.row[m])
        for a in range(k):
            for m in range(k_j, h):
                if s.row[m] == n_j + s.member[a]:
                    s.change[m] -= s.contact[LCP_B, a]
        for m in range(h):
            error = max(error, abs(s.change[m]))
        if error == 0.0 or not error < 0.5 * before:
            break
        before = error
        solve_held(s, h, s.change)
        for m in range(h):
            s.held[s.row[m]] += s.change[m]
    largest = 0.0
    for a in range(k):
        s.contact[LCP_Z, a] = s.held[n_j + s.member[a]]
        largest = max(largest, abs(s.contact[LCP_Z, a]))
    # list all impulses, for `apply`
    for m in range(k_j):
        s.change[m] = s.held[s.row[m]]
    for a in range(k):
        s.row[k_j + a], s.change[k_j + a] = n_j + s.member[a], s.contact[LCP_Z, a]
    s.number[HELD_ROWS] = k_j + k
    return largest


def separates(s: Any) -> bool:
    """Whether every member has at least the speed of the law after the impulses in LCP_Z."""
    for a in range(s.number[MEMBERS]):
        u, size, i = s.contact[LCP_B, a], abs(s.contact[LCP_B, a]), len(s.J) + s.member[a]
        for m in range(s.number[HELD_ROWS]):
            u += s.D[i, s.row[m]] * s.change[m]
            size += abs(s.D[i, s.row[m]] * s.change[m])
        if u < -CHECKED * size:
            return False
    return True


def apply(s: Any, tracked: bool) -> None:
    """Apply the impulses `change` on the rows held.

    `tracked`: the contacts' speeds are carried along, not computed from V, so that small ones keep their digits.
    """
    n_j, n_c, v = len(s.J), len(s.G), s.state[V]
    for m in range(s.number[HELD_ROWS]):
        i, p = s.row[m], s.change[m]
        if p != 0.0:
            for j in range(len(v)):
                v[j] += s.MR[i, j] * p
            if i < n_j:
                s.joint[IMPULSE, i] += p
            else:
                s.contact[IMPULSE, i - n_j] += p
            if tracked:
                for c in range(n_c):
                    if s.D[n_j + c, i] != 0.0:
                        s.contact[SPEED, c] += s.D[n_j + c, i] * p
                        s.contact[SYNCHRONOUS, c] = 0.0
    if not tracked:
        for c in range(n_c):
            s.contact[SPEED, c] = product(s.R, v, n_j + c) + s.contact[RATE, c]


def synchronise(model: Any, s: Any) -> None:
    """Gaps and speeds of contacts just disturbed anew from Q, V, where they are large enough to lose no digits so.

    Carried along over many impacts they would collect rounding, and impulses with them.
    """
    n_j, q, v = len(s.J), s.state[Q], s.state[V]
    length = speed = 0.0
    for j in range(len(q)):
        length, speed = max(length, abs(q[j])), max(speed, abs(v[j]))
    for c in range(len(s.G)):
        if s.contact[SYNCHRONOUS, c] == 0.0 and s.mode[CLOSED, c] == 0:
            s.contact[SYNCHRONOUS, c] = 1.0
            g, u = product(s.R, q, n_j + c) + model.offset[c], product(s.R, v, n_j + c)
            if g > LARGE * length:
                s.contact[GAP, c] = g
            if abs(u) > LARGE * speed:
                s.contact[SPEED, c] = u


def speed_noise(s: Any) -> float:
    """Rounding of a gap velocity."""
    size, v = 0.0, s.state[V]
    for j in range(len(v)):
        size = max(size, abs(v[j]))
    return NOISE * size


def contact_forces(model: Any, s: Any, lcp: Any, solver: Any, t: float) -> int:
    """Forces and accelerations of the closed contacts at time t; those that open are no longer closed.

    The acceleration is left in the state's ACCELERATION, gap accelerations in CURVE, forces in MULTIPLIER.
    """
    n_c, n_j, a = len(s.G), len(s.J), s.state[ACCELERATION]
    hold_joints(s)
    assign(a, s.state[FREE_ACCELERATION])
    constrain(model, s, a)
    if n_j > 0:
        s.number[CULPRIT] = contradiction(s, a)
        if s.number[CULPRIT] >= 0:
            return CONTRADICTION
    s.number[MEMBERS] = 0
    for c in range(n_c):
        s.mode[LOADED, c] = 0
        s.contact[CURVE, c] = product(s.R, a, n_j + c) + s.contact[BIAS, c]
        s.contact[MULTIPLIER, c] = 0.0
        if s.mode[CLOSED, c] == 1:
            s.member[s.number[MEMBERS]], s.contact[LCP_B, s.number[MEMBERS]] = c, s.contact[CURVE, c]
            s.number[MEMBERS] += 1
    solved = True
    if s.number[MEMBERS] > 0:
        solved = solve_contacts(s, lcp, solver)
        if solved:
            open_contacts(s, t)
            unload(s)
        assign(a, s.state[FREE_ACCELERATION])
        hold_contacts(s)
        constrain(model, s, a)
    note(s, a)
    return DONE if solved or presses(s) else NO_SOLUTION


def presses(s: Any) -> bool:
    """Whether the forces of the rows held are those of the closed contacts: none pulls, none is passed."""
    largest, size, a = 0.0, 0.0, s.state[ACCELERATION]
    for m in range(s.number[HELD_ROWS]):
        largest = max(largest, abs(s.held[m]))
    for j in range(len(a)):
        size = max(size, abs(a[j]), abs(s.state[FREE_ACCELERATION, j]))
    for c in range(len(s.G)):
        if s.contact[MULTIPLIER, c] < -CHECKED * largest:
            return False
        i = len(s.J) + c
        if s.mode[CLOSED, c] == 1 and product(s.R, a, i) + s.contact[BIAS, c] < -CHECKED * size:
            return False
    return True


def open_contacts(s: Any, t: float) -> None:
    """Of the members, mark those that carry a force, and open those that accelerate away from the surface."""
    n_j, k = len(s.J), s.number[MEMBERS]
    W = s.W[: k * k].reshape((k, k))
    for m in range(k):
        c, alpha = s.member[m], s.contact[LCP_B, m]
        size = abs(s.contact[BIAS, c])
        for j in range(s.state.shape[1]):
            size += abs(s.R[n_j + c, j] * s.state[FREE_ACCELERATION, j])
        for b in range(k):
            alpha += W[m, b] * s.contact[LCP_Z, b]
            size += abs(W[m, b] * s.contact[LCP_Z, b])
        if s.contact[LCP_Z, m] > 0.0:
            s.mode[LOADED, c], s.contact[MULTIPLIER, c] = 1, s.contact[LCP_Z, m]
        elif alpha > NOISE * size and not s.contact[HELD, c] > t:
            s.mode[CLOSED, c] = 0


def unload(s: Any) -> None:
    """Shift forces between loaded contacts that depend on each other until the rest of the loaded are independent.

    No force becomes negative on the way (Caratheodory): so the rows that will be held carry forces that push.
    """
    n_j, force = len(s.J), s.contact[MULTIPLIER]
    shifting = True
    while shifting:  # each round takes the load from one contact
        shifting = False
        hold_joints(s)
        for c in range(len(s.G)):
            k = s.number[HELD_ROWS]
            if s.mode[LOADED, c] == 1 and not shifting:
                hold(s, n_j + c)
                if s.number[HELD_ROWS] == k:
                    shifting = True
                    for m in range(k):
                        s.change[m] = s.D[s.row[m], n_j + c]
                    solve_held(s, k, s.change)
                    share, leaves = force[c], c
                    for m in range(s.number[HELD_JOINTS], k):
                        d = s.row[m] - n_j
                        if force[d] + share * s.change[m] < 0.0:
                            share, leaves = force[d] / -s.change[m], d
                    for m in range(s.number[HELD_JOINTS], k):
                        force[s.row[m] - n_j] += share * s.change[m]
                    force[c] -= share
                    force[leaves], s.mode[LOADED, leaves] = 0.0, 0


def note(s: Any, a: Any) -> None:
    """Multipliers of the rows held, and the gap accelerations of all contacts."""
    n_j, n_c = len(s.J), len(s.G)
    for i in range(n_j):
        s.joint[MULTIPLIER, i] = 0.0
    for c in range(n_c):
        s.contact[MULTIPLIER, c] = 0.0
        s.contact[CURVE, c] = product(s.R, a, n_j + c) + bias_of(s, n_j + c)
    for m in range(s.number[HELD_ROWS]):
        i = s.row[m]
        if i < n_j:
            s.joint[MULTIPLIER, i] = s.held[m]
        else:
            s.contact[MULTIPLIER, i - n_j] = s.held[m]
            s.contact[CURVE, i - n_j] = 0.0
    for c in range(n_c):
        if s.mode[CLOSED, c] == 1:
            s.contact[CURVE, c] = 0.0
