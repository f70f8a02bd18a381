"""The forces of contacts that are closed, as kernels: which of them carry one, and which open.

    0 <= alpha  complementary to  lambda >= 0,      alpha = alpha_0 + W lambda

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 5.
"""

from __future__ import annotations

import cython

from lcpstep.events.ends import NO_FORCES
from lcpstep.kernels.status import DONE, JOINTS_FAILED

if not cython.compiled:
    from lcpstep.events.parabolas.held import (
        accelerate,
        joints_own,
        note,
    )
    from lcpstep.events.parabolas.problem import CHECKED, solve_contacts
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.equations import size_of, size_of_acceleration
    from lcpstep.events.rows.held import constrain, contradiction, hold, hold_joints, solve_held
    from lcpstep.events.rows.on_joints import acceleration_on_joints
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.vectors import copy, largest, product
    from lcpstep.pointers import abs

PASSES = 1e-12  # of the terms of a gap acceleration: one into the surface that is no rounding


def contact_forces(s: Mechanism) -> int:
    """Forces and accelerations of the closed contacts; those that open are no longer closed.

    The acceleration is left in `a`, gap accelerations in `curve`, forces in `multiplier`.
    """
    n_c, n_j, a = s.n_c, s.n_j, s.a
    hold_joints(s)
    copy(a, s.a_free, s.n_q)
    constrain(s, a, s.bias)
    if n_j > 0:
        s.culprit = contradiction(s, a)
        if s.culprit >= 0:
            return JOINTS_FAILED
    s.n_members = 0
    for c in range(n_c):
        s.contact.loaded[c] = 0
        s.contact.curve[c] = product(s.R, a, n_j + c, s.n_q) + s.contact.bias[c]
        s.contact.multiplier[c] = 0.0
        if s.contact.closed[c] == 1 and not joints_own(s, c):
            s.contact.member[s.n_members] = c
            s.contact.b[s.n_members] = acceleration_on_joints(s, n_j + c, a)
            s.contact.noise[s.n_members] = 0.5 * NOISE * size_of(s, s.n_j + c, s.contact.bias[c], s.a_free)
            s.n_members += 1
    solved = True
    if s.n_members > 0:
        solved = solve_contacts(s)
        if solved:
            open_contacts(s)
            unload(s)
        accelerate(s)
    else:
        note(s, a)
    return DONE if solved or presses(s) else NO_FORCES


def stands(s: Mechanism) -> bool:
    """Whether no contact that touches accelerates into its surface, and none pulls.

    Rows that rounding has dropped bear no load: what has opened by the force of such a contact would close again at
    once, for ever.
    """
    most = largest(s.contact.multiplier, 0.0, s.n_c)
    for c in range(s.n_c):
        if s.contact.multiplier[c] < -CHECKED * most:
            return False
        touches = s.contact.closed[c] == 1 or (s.contact.gap[c] == 0.0 and s.contact.speed[c] == 0.0)
        if touches and enters(s, c):
            return False
    return True


def enters(s: Mechanism, c: int) -> bool:
    """Whether contact c accelerates into its surface, by more than rounding."""
    i = s.n_j + c
    alpha = product(s.R, s.a, i, s.n_q) + s.contact.bias[c]
    return alpha < 0.0 and alpha < -PASSES * size_of_acceleration(s, i, s.a)


def presses(s: Mechanism) -> bool:
    """Whether the forces of the rows held are those of the closed contacts: none pulls, none is passed."""
    a, most = s.a, largest(s.held, 0.0, s.n_held)
    size = largest(s.a_free, largest(a, 0.0, s.n_q), s.n_q)
    for c in range(s.n_c):
        if s.contact.multiplier[c] < -CHECKED * most:
            return False
        i = s.n_j + c
        if s.contact.closed[c] == 1 and product(s.R, a, i, s.n_q) + s.contact.bias[c] < -CHECKED * size:
            return False
    return True


def open_contacts(s: Mechanism) -> None:
    """Of the members, mark those that carry a force, and open those that accelerate away from the surface."""
    k = s.n_members
    for m in range(k):
        c, alpha = s.contact.member[m], s.contact.b[m]
        size = size_of(s, s.n_j + c, s.contact.bias[c], s.a_free)
        for b in range(k):
            alpha += s.W[m * k + b] * s.contact.z[b]
            size += abs(s.W[m * k + b] * s.contact.z[b])
        if s.contact.z[m] > 0.0:
            s.contact.loaded[c], s.contact.multiplier[c] = 1, s.contact.z[m]
        elif alpha > NOISE * size and alpha > NOISE * passed_on(s, c):
            s.contact.closed[c] = 0


def passed_on(s: Mechanism, c: int) -> float:
    """Size of the terms of other gap accelerations, as far as contact c shares them: R_c = sum y_m R_m + a rest.

    What rounding leaves of those held at zero, two rows that are nearly parallel pass on many times as large.
    """
    i, size, acting = s.n_j + c, 0.0, s.trial
    for j in range(s.n_q):
        acting[j] = abs(s.a_free[j])
        for b in range(s.n_members):
            acting[j] += abs(s.MR[(s.n_j + s.contact.member[b]) * s.n_q + j] * s.contact.z[b])
    hold_joints(s)
    for d in range(s.n_c):
        if s.contact.loaded[d] == 1:
            hold(s, s.n_j + d)
    for m in range(s.n_held):
        s.change[m] = s.D[s.row[m] * s.n_r + i]
    solve_held(s, s.change)
    for m in range(s.n_held):
        size += abs(s.change[m]) * size_of(s, s.row[m], s.bias[s.row[m]], acting)
    return size


def unload(s: Mechanism) -> None:
    """Shift forces between loaded contacts that depend on each other until the rest of the loaded are independent.

    No force becomes negative on the way (Caratheodory): so the rows that will be held carry forces that push.
    """
    n_j, force = s.n_j, s.contact.multiplier
    shifting = True
    while shifting:  # each round takes the load from one contact
        shifting = False
        hold_joints(s)
        for c in range(s.n_c):
            k = s.n_held
            if s.contact.loaded[c] == 1 and not shifting:
                hold(s, n_j + c)
                if s.n_held == k:
                    shifting = True
                    for m in range(k):
                        s.change[m] = s.D[s.row[m] * s.n_r + n_j + c]
                    solve_held(s, s.change)
                    share, leaves = force[c], c
                    for m in range(s.n_kept, k):
                        d = s.row[m] - n_j
                        if force[d] + share * s.change[m] < 0.0:
                            share, leaves = force[d] / -s.change[m], d
                    for m in range(s.n_kept, k):
                        force[s.row[m] - n_j] += share * s.change[m]
                    force[c] -= share
                    force[leaves], s.contact.loaded[leaves] = 0.0, 0
