"""The forces of contacts that are closed, as kernels: which of them carry one, and which open.

    0 <= alpha  complementary to  lambda >= 0,      alpha = alpha_0 + W lambda

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 5.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.chatter import CHECKED
from lcpstep.events.rows.contacts import hold_modes, list_multipliers
from lcpstep.events.rows.equations import size_of, size_of_acceleration
from lcpstep.events.rows.held import DRIFT, balance, constrain, contradiction, hold, hold_joints, solve_held
from lcpstep.events.rows.loads import unload
from lcpstep.events.rows.on_joints import acceleration_on_joints, can_bear
from lcpstep.events.rows.problem import accelerate_on_joints, fill
from lcpstep.kernels.coulomb import solve_contacts
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.status import DONE, JOINTS_FAILED
from lcpstep.kernels.vectors import add, clear, copy, largest, product
from lcpstep.pointers import abs, after

PASSES = 1e-12  # of the terms of a gap acceleration: one into the surface that is no rounding


def contact_forces(s: Mechanism) -> int:
    """Forces and accelerations of the closed contacts; those that open are no longer closed.

    The acceleration is left in `a`, gap accelerations in `curve`, forces in `multiplier`; whether these would do
    says `stands`.
    """
    n_j = s.n_j
    accelerate_on_joints(s)
    if n_j > 0:
        s.culprit = contradiction(s, s.a)
        if s.culprit >= 0:
            return JOINTS_FAILED
    s.n_members = 0
    for c in range(s.n_c):
        s.loaded[c] = 0
        if s.mode[c] != OPEN and not joints_own(s, c):
            s.problem.ids[s.n_members] = c
            s.problem.rate[s.n_members] = acceleration_on_joints(s, n_j + c, s.a)
            s.lift[s.n_members] = 0.5 * NOISE * size_of(s, n_j + c, 0.0, s.a_free)
            s.n_members += 1
    if s.n_members > 0:
        if solve_members(s):
            open_contacts(s)
            unload(s, after(s.multiplier, s.n_j), s.loaded)
        copy(s.a, s.a_free, s.n_q)
        hold_modes(s)
        constrain(s, s.a, s.bias)
        balance(s, s.a)
    list_forces(s)
    return DONE


def joints_own(s: Mechanism, c: int) -> bool:
    """Whether the joints, which must have been held, leave nothing of the row of contact c: it bears nothing."""
    return s.n_j > 0 and not can_bear(s, c)


def solve_members(s: Mechanism) -> bool:
    """Solve the members' problem with `rate`; impulses or forces, at least zero, and who carries one.

    Opposite contacts can make it a problem without an answer by as little as rounding; then `rate` is lifted by it.
    Where the solver fails (the matrix has lost too many digits), all that could are said to carry one, which is zero:
    an answer to be checked.
    """
    k, found = s.n_members, s.problem.impulse
    fill(s, k, 0)
    solved = solve_contacts(s.problem, k, 0)
    if not solved:
        add(s.problem.rate, 1.0, s.lift, k)
        solved = solve_contacts(s.problem, k, 0)
    if not solved:
        clear(found, k)
    for a in range(k):
        s.loaded[s.problem.ids[a]] = 1 if found[a] > 0.0 or not solved else 0
    return solved


def list_forces(s: Mechanism) -> None:
    """Multipliers of the rows held, and the gap accelerations of all contacts.

    Closed contacts whose rows depend on those held are kept by these.
    """
    list_multipliers(s)
    for c in range(s.n_c):
        i = s.n_j + c
        alpha = product(s.R, s.a, i, s.n_q)
        kept = s.mode[c] != OPEN and (
            s.multiplier[i] != 0.0 or abs(alpha) <= DRIFT * size_of_acceleration(s, i, s.a)
        )
        s.curve[c] = 0.0 if kept else alpha


def stands(s: Mechanism) -> bool:
    """Whether no contact that touches accelerates into its surface, and none pulls, by more than rounding.

    Rows that rounding has dropped bear no load: what has opened by the force of such a contact would close again at
    once, for ever.
    """
    most = largest(after(s.multiplier, s.n_j), 0.0, s.n_c)
    for c in range(s.n_c):
        if s.multiplier[s.n_j + c] < -CHECKED * most and pulls(s, c):
            return False
        touches = s.mode[c] != OPEN or (s.gap[s.n_j + c] == 0.0 and s.velocity[s.n_j + c] == 0.0)
        alpha = product(s.R, s.a, s.n_j + c, s.n_q) if touches else 0.0
        if alpha < 0.0 and alpha < -PASSES * size_of_acceleration(s, s.n_j + c, s.a):
            return False
    return True


def pulls(s: Mechanism, c: int) -> bool:
    """Whether what contact c pulls with is more than rounding: of bodies that fall together it is all there is."""
    i = s.n_j + c
    return -s.multiplier[i] * s.D[i * s.n_r + i] > PASSES * size_of_acceleration(s, i, s.a)


def open_contacts(s: Mechanism) -> None:
    """Of the members, mark those that carry a force, and open those that accelerate away from the surface."""
    k = s.n_members
    for m in range(k):
        c, alpha = s.problem.ids[m], s.problem.rate[m]
        size = size_of(s, s.n_j + c, 0.0, s.a_free)
        for b in range(k):
            alpha += s.problem.mobility[m * k + b] * s.problem.impulse[b]
            size += abs(s.problem.mobility[m * k + b] * s.problem.impulse[b])
        if s.problem.impulse[m] > 0.0:
            s.loaded[c], s.multiplier[s.n_j + c] = 1, s.problem.impulse[m]
        elif alpha > NOISE * size and alpha > NOISE * passed_on(s, c):
            s.mode[c] = OPEN


def passed_on(s: Mechanism, c: int) -> float:
    """Size of the terms of other gap accelerations, as far as contact c shares them: R_c = sum y_m R_m + a rest.

    What rounding leaves of those held at zero, two rows that are nearly parallel pass on many times as large.
    """
    i, size, acting = s.n_j + c, 0.0, s.dv
    for j in range(s.n_q):
        acting[j] = abs(s.a_free[j])
        for b in range(s.n_members):
            acting[j] += abs(s.MR[(s.n_j + s.problem.ids[b]) * s.n_q + j] * s.problem.impulse[b])
    hold_joints(s)
    for d in range(s.n_c):
        if s.loaded[d] == 1:
            hold(s, s.n_j + d)
    for m in range(s.n_held):
        s.change[m] = s.D[s.row[m] * s.n_r + i]
    solve_held(s, s.change)
    for m in range(s.n_held):
        size += abs(s.change[m]) * size_of(s, s.row[m], 0.0, acting)
    return size
