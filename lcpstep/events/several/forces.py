"""The forces of contacts that are closed, as kernels: which of them carry one, and which open.

    0 <= alpha  complementary to  lambda >= 0,      alpha = alpha_0 + W lambda

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 5.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign, largest
from lcpstep.dynamics import product
from lcpstep.events.several.held import (
    constrain,
    contradiction,
    hold,
    hold_contacts,
    hold_joints,
    note,
    solve_held,
)
from lcpstep.events.several.problem import CHECKED, solve_contacts
from lcpstep.events.several.state import (
    ACCELERATION,
    BIAS,
    CLOSED,
    CULPRIT,
    CURVE,
    FREE_ACCELERATION,
    HELD,
    HELD_JOINTS,
    HELD_ROWS,
    LCP_B,
    LCP_NOISE,
    LCP_Z,
    LOADED,
    MEMBERS,
    MULTIPLIER,
    NOISE,
)

DONE, NO_SOLUTION, CONTRADICTION = range(3)


def contact_forces(s: Any, t: float) -> int:
    """Forces and accelerations of the closed contacts at time t; those that open are no longer closed.

    The acceleration is left in the state's ACCELERATION, gap accelerations in CURVE, forces in MULTIPLIER.
    """
    n_c, n_j, a = len(s.G), len(s.J), s.state[ACCELERATION]
    hold_joints(s)
    assign(a, s.state[FREE_ACCELERATION])
    constrain(s, a)
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
            s.contact[LCP_NOISE, s.number[MEMBERS]] = 0.5 * NOISE * terms(s, c)
            s.number[MEMBERS] += 1
    solved = True
    if s.number[MEMBERS] > 0:
        solved = solve_contacts(s)
        if solved:
            open_contacts(s, t)
            unload(s)
        assign(a, s.state[FREE_ACCELERATION])
        hold_contacts(s)
        constrain(s, a)
    note(s, a)
    return DONE if solved or presses(s) else NO_SOLUTION


def presses(s: Any) -> bool:
    """Whether the forces of the rows held are those of the closed contacts: none pulls, none is passed."""
    a, most = s.state[ACCELERATION], largest(s.held[: s.number[HELD_ROWS]], 0.0)
    size = largest(s.state[FREE_ACCELERATION], largest(a, 0.0))
    for c in range(len(s.G)):
        if s.contact[MULTIPLIER, c] < -CHECKED * most:
            return False
        i = len(s.J) + c
        if s.mode[CLOSED, c] == 1 and product(s.R, a, i) + s.contact[BIAS, c] < -CHECKED * size:
            return False
    return True


def open_contacts(s: Any, t: float) -> None:
    """Of the members, mark those that carry a force, and open those that accelerate away from the surface."""
    k = s.number[MEMBERS]
    W = s.W[: k * k].reshape((k, k))
    for m in range(k):
        c, alpha = s.member[m], s.contact[LCP_B, m]
        size = terms(s, c)
        for b in range(k):
            alpha += W[m, b] * s.contact[LCP_Z, b]
            size += abs(W[m, b] * s.contact[LCP_Z, b])
        if s.contact[LCP_Z, m] > 0.0:
            s.mode[LOADED, c], s.contact[MULTIPLIER, c] = 1, s.contact[LCP_Z, m]
        elif alpha > NOISE * size and not s.contact[HELD, c] > t:
            s.mode[CLOSED, c] = 0


def terms(s: Any, c: int) -> float:
    """Size of the terms of a gap acceleration without contact forces."""
    size = abs(s.contact[BIAS, c])
    for j in range(s.state.shape[1]):
        size += abs(s.R[len(s.J) + c, j] * s.state[FREE_ACCELERATION, j])
    return size


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
