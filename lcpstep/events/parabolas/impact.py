"""The impact of all contacts that are closed at one time, as kernels.

    0 <= u+ + r u-  complementary to  p >= 0,        u+ = u- + W p        (Newton's law in Moreau's form)

It takes all contacts that are closed, to rounding, and do not separate: so the energy falls by sum (1 - r) |u-| p / 2
whatever the restitution of each. A contact that has separated at the same instant and is pushed back strikes anew, in
a problem of its own. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer
2008), chapter 3.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.parabolas.held import joints_own
    from lcpstep.events.parabolas.problem import CHECKED, solve_contacts
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.held import add_column, constrain, hold, hold_joints
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.vectors import clear, copy, largest, product
    from lcpstep.pointers import abs, max, min


def strike(s: Mechanism) -> bool:
    """The impact of the contacts whose gap is zero and that do not separate; p into `z`, by member.

    Velocities and contact speeds are those after it. False where none exists. What is held from all sides cannot
    leave every obstacle as its restitution asks, and speeds carried along may not agree with the velocities: where no
    impulses answer, they but end the approach, and at last that which the velocities have.
    """
    gather(s)
    if solve_law(s, True) or solve_law(s, False):
        return True
    for c in range(s.n_c):
        s.contact.speed[c] = product(s.R, s.v, s.n_j + c, s.n_q) + s.contact.rate[c]
        if s.contact.closed[c] == 1:
            s.contact.closed[c], s.contact.gap[c] = 0, 0.0
    gather(s)
    return solve_law(s, False)


def gather(s: Mechanism) -> None:
    """The contacts that take part: those whose gap is zero and that do not separate; those of joints bear nothing."""
    s.n_members = 0
    hold_joints(s)
    for c in range(s.n_c):
        s.contact.loaded[c] = 0
        u = 0.0 if s.contact.closed[c] == 1 else s.contact.speed[c]
        touches = s.contact.gap[c] == 0.0 and s.contact.parting[c] == 0
        takes_part = s.contact.closed[c] == 1 or (touches and u <= speed_noise(s, c))
        if takes_part and not (u >= -speed_noise(s, c) and joints_own(s, c)):
            s.contact.member[s.n_members] = c
            s.contact.noise[s.n_members] = speed_noise(s, c)
            s.n_members += 1


def solve_law(s: Mechanism, rebounds: bool) -> bool:
    """Impulses by the law, with restitution or without it, applied; False where there are none."""
    for a in range(s.n_members):
        c = s.contact.member[a]
        u = 0.0 if s.contact.closed[c] == 1 else s.contact.speed[c]
        s.contact.loaded[c] = 0
        s.contact.b[a] = (1.0 + s.model.restitution[c]) * min(u, 0.0) if rebounds else min(u, 0.0)
    hold_joints(s)
    solved = solve_contacts(s)
    most = impulses(s)
    for a in range(s.n_members):
        if s.contact.z[a] < 0.0:
            if not solved and s.contact.z[a] < -CHECKED * most:
                return False
            s.contact.z[a] = s.change[s.n_kept + a] = 0.0
    if not solved and not separates(s):
        return False
    apply(s)
    return True


def impulses(s: Mechanism) -> float:
    """Impulses of the members, of which `z` is a guess, and of the joints into `change`; returns the largest.

    They give the loaded members the speeds of the law.
    """
    n_j, k, dv = s.n_j, s.n_members, s.trial
    clear(dv, s.n_q)
    clear(s.near, s.n_r)
    hold_joints(s)
    for a in range(k):
        i = n_j + s.contact.member[a]
        s.near[i] = s.contact.b[a]
        add_column(s, s.MR, i, s.contact.z[a], dv)
    for a in range(k):
        if s.contact.loaded[s.contact.member[a]] == 1:
            hold(s, n_j + s.contact.member[a])
    clear(s.held, s.n_held)
    if k + s.n_kept > 1:  # one impulse alone loses no digits
        constrain(s, dv, s.near)
    clear(s.further, s.n_r)
    for m in range(s.n_held):
        s.further[s.row[m]] = s.held[m]
    for a in range(k):
        s.contact.z[a] = s.contact.z[a] + s.further[n_j + s.contact.member[a]]
    list_impulses(s)
    return largest(s.contact.z, 0.0, k)


def list_impulses(s: Mechanism) -> None:
    """The impulses of joints and members, in this order, into `change`, for `apply`."""
    n_j, k_j, k = s.n_j, s.n_kept, s.n_members
    copy(s.change, s.held, k_j)
    for a in range(k):
        s.row[k_j + a], s.change[k_j + a] = n_j + s.contact.member[a], s.contact.z[a]
    s.n_held = k_j + k


def separates(s: Mechanism) -> bool:
    """Whether every member has at least the speed of the law after the impulses in `z`."""
    for a in range(s.n_members):
        u, size, i = s.contact.b[a], abs(s.contact.b[a]), s.n_j + s.contact.member[a]
        for m in range(s.n_held):
            u += s.D[i * s.n_r + s.row[m]] * s.change[m]
            size += abs(s.D[i * s.n_r + s.row[m]] * s.change[m])
        if u < -CHECKED * size:
            return False
    return True


def apply(s: Mechanism) -> None:
    """Apply the impulses `change` on the rows held.

    The contacts' speeds are carried along, not computed from v, so that small ones keep their digits.
    """
    n_j, n_c, v = s.n_j, s.n_c, s.v
    for m in range(s.n_held):
        i, p = s.row[m], s.change[m]
        if p != 0.0:
            for j in range(s.n_q):
                v[j] += s.MR[i * s.n_q + j] * p
            if i < n_j:
                s.joint.impulse[i] = s.joint.impulse[i] + p
                s.joint.turn_impulse[i] = s.joint.turn_impulse[i] + p
            else:
                s.contact.impulse[i - n_j] = s.contact.impulse[i - n_j] + p
                s.contact.turn_impulse[i - n_j] = s.contact.turn_impulse[i - n_j] + p
            for c in range(n_c):
                if s.D[(n_j + c) * s.n_r + i] != 0.0:
                    du = s.D[(n_j + c) * s.n_r + i] * p
                    s.contact.terms[c] = max(s.contact.terms[c], abs(du))
                    s.contact.speed[c] = s.contact.speed[c] + du
                    s.contact.synchronous[c] = 0.0


def speed_noise(s: Mechanism, c: int) -> float:
    """Rounding of the gap velocity of a contact, that of the earlier impacts of the same instant included.

    Contact forces may have held against what the others would have made of it in the step before.
    """
    i, size = s.n_j + c, abs(s.contact.rate[c])
    for j in range(s.n_q):
        size += abs(s.R[i * s.n_q + j]) * (abs(s.v[j]) + s.length * abs(s.a_free[j]))
    s.contact.terms[c] = max(size, s.contact.terms[c])
    return NOISE * s.contact.terms[c]
