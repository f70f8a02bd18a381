"""Joints and closed contacts that are held, as kernels; see `events.rows.held`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.equations import (
        size_of_acceleration,
    )
    from lcpstep.events.rows.held import balance, constrain, hold, hold_joints
    from lcpstep.events.rows.on_joints import can_bear
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import Doubles, abs

DRIFT = 1e-9  # of the terms of a gap acceleration: one that the rows held do not keep at zero


def joints_own(s: Mechanism, c: int) -> bool:
    """Whether the joints, which must have been held, leave nothing of the row of contact c: it bears nothing."""
    return s.n_j > 0 and not can_bear(s, c)


def hold_contacts(s: Mechanism) -> None:
    """Hold the joints and the closed contacts, those that carry a force first."""
    n_j = s.n_j
    hold_joints(s)
    for unloaded in range(2):
        for c in range(s.n_c):
            if s.contact.closed[c] == 1 and s.contact.loaded[c] == 1 - unloaded:
                hold(s, n_j + c)


def accelerate(s: Mechanism) -> None:
    """The acceleration with joints and closed contacts held, into `a`; multipliers, and gap accelerations."""
    copy(s.a, s.a_free, s.n_q)
    hold_contacts(s)
    constrain(s, s.a, s.bias)
    balance(s, s.a)
    note(s, s.a)


def note(s: Mechanism, a: Doubles) -> None:
    """Multipliers of the rows held, and the gap accelerations of all contacts.

    Closed contacts whose rows depend on those held are kept by these, but where obstacles move apart.
    """
    n_j, n_c = s.n_j, s.n_c
    for i in range(n_j):
        s.joint.multiplier[i] = 0.0
    for c in range(n_c):
        s.contact.multiplier[c] = 0.0
        s.contact.curve[c] = product(s.R, a, n_j + c, s.n_q) + s.contact.bias[c]
    for m in range(s.n_held):
        i = s.row[m]
        if i < n_j:
            s.joint.multiplier[i] = s.held[m]
        else:
            s.contact.multiplier[i - n_j] = s.held[m]
            s.contact.curve[i - n_j] = 0.0
    for c in range(n_c):
        if s.contact.closed[c] == 1 and not drifts(s, a, c):
            s.contact.curve[c] = 0.0


def drifts(s: Mechanism, a: Doubles, c: int) -> bool:
    """Whether a gap acceleration, in `curve`, is no rounding under the acceleration a."""
    alpha = abs(s.contact.curve[c])
    return alpha > 0.0 and alpha > DRIFT * size_of_acceleration(s, s.n_j + c, a)
