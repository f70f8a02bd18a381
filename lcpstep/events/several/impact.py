"""The impact of all contacts that are closed at one time, as kernels.

    0 <= u+ + r u-  complementary to  p >= 0,        u+ = u- + W p        (Newton's law in Moreau's form)

It takes all contacts that are closed, to rounding, and do not separate: so the energy falls by sum (1 - r) |u-| p / 2
whatever the restitution of each. A contact that has separated at the same instant and is pushed back strikes anew, in
a problem of its own. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer
2008), chapter 3.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest
from lcpstep.dynamics import product
from lcpstep.events.acceleration import inverse_mass
from lcpstep.events.several.held import REFINEMENTS, hold, hold_joints, solve_held
from lcpstep.events.several.problem import CHECKED, solve_contacts
from lcpstep.events.several.state import (
    CLOSED,
    CYCLE_IMPULSE,
    GAP,
    HELD_JOINTS,
    HELD_ROWS,
    IMPULSE,
    JOINT_CYCLE_IMPULSE,
    LCP_B,
    LCP_NOISE,
    LCP_Z,
    LOADED,
    MEMBERS,
    NOISE,
    RATE,
    SPEED,
    SYNCHRONOUS,
    TERMS,
    WORK,
    V,
)


def strike(s: Any) -> bool:
    """The impact of the contacts whose gap is zero and that do not separate; p into LCP_Z, by member.

    Velocities and contact speeds are those after it. False where none exists.
    """
    s.number[MEMBERS] = 0
    for c in range(len(s.G)):
        s.mode[LOADED, c] = 0
        u = 0.0 if s.mode[CLOSED, c] == 1 else s.contact[SPEED, c]
        if s.mode[CLOSED, c] == 1 or (s.contact[GAP, c] == 0.0 and u <= speed_noise(s, c)):
            s.member[s.number[MEMBERS]] = c
            s.contact[LCP_B, s.number[MEMBERS]] = (1.0 + s.model.restitution[c]) * min(u, 0.0)
            s.contact[LCP_NOISE, s.number[MEMBERS]] = speed_noise(s, c)
            s.number[MEMBERS] += 1
    hold_joints(s)
    solved = solve_contacts(s)
    most = impulses(s)
    for a in range(s.number[MEMBERS]):
        if s.contact[LCP_Z, a] < 0.0:
            if not solved and s.contact[LCP_Z, a] < -CHECKED * most:
                return False
            s.contact[LCP_Z, a] = s.change[s.number[HELD_JOINTS] + a] = 0.0
    if not solved and not separates(s):
        return False
    apply(s)
    return True


def impulses(s: Any) -> float:
    """Impulses of the members, of which LCP_Z is a guess, and of the joints into `change`; returns the largest.

    They give the loaded members the speeds of the law; corrected with the residual of M (v+ - v-) = R^T p itself.
    """
    n_j, k = len(s.J), s.number[MEMBERS]
    hold_joints(s)
    k_j = s.number[HELD_JOINTS]
    for m in range(len(s.change)):
        s.change[m] = s.held[m] = 0.0
    for a in range(k):
        s.held[n_j + s.member[a]] = s.contact[LCP_Z, a]  # by row, not by place in the list of rows held
    for a in range(k):
        if s.mode[LOADED, s.member[a]] == 1:
            hold(s, n_j + s.member[a])
    h, before = s.number[HELD_ROWS], math.inf
    for _ in range(REFINEMENTS if k + k_j > 1 else 0):  # one impulse alone loses no digits
        error = missing_speeds(s)
        if error == 0.0 or not error < 0.5 * before:
            break
        before = error
        solve_held(s, h, s.change)
        for m in range(h):
            s.held[s.row[m]] += s.change[m]
    for a in range(k):
        s.contact[LCP_Z, a] = s.held[n_j + s.member[a]]
    list_impulses(s)
    return largest(s.contact[LCP_Z, :k], 0.0)


def missing_speeds(s: Any) -> float:
    """What the impulses `held` leave missing of the law's speeds, on the rows held, into `change`; the largest."""
    dv, h, k_j = s.state[WORK], s.number[HELD_ROWS], s.number[HELD_JOINTS]
    for j in range(len(dv)):
        dv[j] = 0.0
        for i in range(len(s.R)):
            if s.held[i] != 0.0:
                dv[j] += s.R[i, j] * s.held[i]
    inverse_mass(s, dv)
    for m in range(h):
        s.change[m] = -product(s.R, dv, s.row[m])
    for a in range(s.number[MEMBERS]):
        for m in range(k_j, h):
            if s.row[m] == len(s.J) + s.member[a]:
                s.change[m] -= s.contact[LCP_B, a]
    return largest(s.change[:h], 0.0)


def list_impulses(s: Any) -> None:
    """The impulses of joints and members, in this order, into `change`, for `apply`."""
    n_j, k_j, k = len(s.J), s.number[HELD_JOINTS], s.number[MEMBERS]
    for m in range(k_j):
        s.change[m] = s.held[s.row[m]]
    for a in range(k):
        s.row[k_j + a], s.change[k_j + a] = n_j + s.member[a], s.contact[LCP_Z, a]
    s.number[HELD_ROWS] = k_j + k


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


def apply(s: Any) -> None:
    """Apply the impulses `change` on the rows held.

    Under constant acceleration the contacts' speeds are carried along, not computed from V, so that small ones keep
    their digits.
    """
    n_j, n_c, v = len(s.J), len(s.G), s.state[V]
    for m in range(s.number[HELD_ROWS]):
        i, p = s.row[m], s.change[m]
        if p != 0.0:
            for j in range(len(v)):
                v[j] += s.MR[i, j] * p
            if i < n_j:
                s.joint[IMPULSE, i] += p
                s.joint[JOINT_CYCLE_IMPULSE, i] += p
            else:
                s.contact[IMPULSE, i - n_j] += p
                s.contact[CYCLE_IMPULSE, i - n_j] += p
            for c in range(n_c):
                if s.D[n_j + c, i] != 0.0:
                    du = s.D[n_j + c, i] * p
                    s.contact[TERMS, c] = max(s.contact[TERMS, c], abs(du))
                    if s.constant:
                        s.contact[SPEED, c] += du
                        s.contact[SYNCHRONOUS, c] = 0.0
    if not s.constant:
        for c in range(n_c):
            s.contact[SPEED, c] = product(s.R, v, n_j + c) + s.contact[RATE, c]


def speed_noise(s: Any, c: int) -> float:
    """Rounding of the gap velocity of a contact, that of the earlier impacts of the same instant included."""
    i, terms = len(s.J) + c, abs(s.contact[RATE, c])
    for j in range(s.state.shape[1]):
        terms += abs(s.R[i, j] * s.state[V, j])
    s.contact[TERMS, c] = max(terms, s.contact[TERMS, c])
    return NOISE * s.contact[TERMS, c]
