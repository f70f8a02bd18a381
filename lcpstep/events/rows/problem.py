"""The complementarity problem of closed contacts, on the joints (`rows.on_joints`), as kernels.

The same problem has impulses (`impact`) or forces (`modes`) for its unknowns; see `kernels.coulomb` for its form. A
contact that slides has its friction in the column of its normal, one that may stick has an unknown of its own. With
the joints alone, or with all that the modes hold, accelerations are

    M a = M a_free + R_h^T lambda,      R_h a + bias_h = 0      h: the rows held

Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapter 5.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN
from lcpstep.events.rows.contacts import Contacts, list_multipliers, rubs
from lcpstep.events.rows.equations import size_of_acceleration
from lcpstep.events.rows.held import constrain, hold_joints
from lcpstep.events.rows.loads import unload
from lcpstep.kernels.coulomb import solve_contacts
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import clear, copy, largest
from lcpstep.pointers import Indices, abs, after

SMALL = 1e-12  # of the largest acceleration: as much as differences of callbacks leave of one that is none


def row_of(s: Contacts, a: int, n_a: int) -> int:
    """The row of unknown a of the problem: normals of n_a contacts, then tangents of those that may stick."""
    if a < n_a:
        return s.n_j + s.problem.ids[a]
    return s.n_j + s.n_c + s.problem.ids[s.problem.carrier[a - n_a]]


def list_unknowns(s: Contacts) -> tuple[int, int]:
    """The closed contacts into `ids`, those that may stick into `carrier`; how many of each."""
    n_a, n_f = 0, 0
    for c in range(s.n_c):
        if s.mode[c] != OPEN:
            s.problem.ids[n_a] = c
            if s.may_stick[c] == 1 and rubs(s, c):
                s.problem.carrier[n_f] = n_a
                n_f += 1
            n_a += 1
    return n_a, n_f


def fill(s: Contacts, n_a: int, n_f: int) -> None:
    """The matrix of the problem, sliding friction in the columns of the normals."""
    m, W = n_a + n_f, s.problem.mobility
    fill_without_sliding(s, n_a, n_f)
    for b in range(n_a if s.n_t > 0 else 0):
        c = s.problem.ids[b]
        if s.may_stick[c] == 0 and rubs(s, c):
            for a in range(m):
                k = row_of(s, a, n_a) * s.n_r + row_of(s, b, n_a) + s.n_c
                W[a * m + b] -= s.direction[c] * s.mu[c] * s.D_on[k]


def fill_without_sliding(s: Contacts, n_a: int, n_f: int) -> None:
    """The same without the friction of what slides."""
    m = n_a + n_f
    for a in range(m):
        row = after(s.D_on, row_of(s, a, n_a) * s.n_r)
        for b in range(m):
            s.problem.mobility[a * m + b] = row[row_of(s, b, n_a)]


def stand_without_friction(s: Contacts, n_a: int) -> bool:
    """Whether the normals alone have forces for the accelerations in `rate`."""
    fill_without_sliding(s, n_a, 0)
    return solve_contacts(s.problem, n_a, 0)


def solve_forces(s: Contacts, n_a: int, n_f: int) -> bool:
    """Forces for the accelerations in `rate`; where there are none, for those that rounding does not tell from them.

    What is held from both sides has two accelerations that are one but for its sign, each with a rounding of its own.
    Of bodies that lean on each other one may have so small an acceleration that no digit of it is left in the forces.
    """
    if solve_contacts(s.problem, n_a, n_f):
        return True
    allow(s, n_a, 1.0)
    found = solve_contacts(s.problem, n_a, n_f)
    allow(s, n_a, -1.0)
    return found or (leave_out_small(s, n_a + n_f) and solve_contacts(s.problem, n_a, n_f))


def leave_out_small(s: Contacts, m: int) -> bool:
    """Take accelerations for none that are rounding of the largest; whether there are any."""
    none, some = SMALL * largest(s.problem.rate, 0.0, m), False
    for a in range(m):
        if s.problem.rate[a] != 0.0 and abs(s.problem.rate[a]) <= none:
            s.problem.rate[a], some = 0.0, True
    return some


def allow(s: Contacts, n_a: int, sign: float) -> None:
    """Raise, or lower, the accelerations of the normals by their rounding."""
    for a in range(n_a):
        size = size_of_acceleration(s, row_of(s, a, n_a), s.a)
        s.problem.rate[a] = s.problem.rate[a] + sign * NOISE * size


def leave_independent(s: Contacts, n_a: int, loaded: Indices) -> None:
    """Of contacts that all slide leave the load to independent ones: those held first push, whichever they are.

    Feet on a line share two normals, and the forces found may be of three.
    """
    if n_a < 2:  # one depends on no other
        return
    clear(s.curve, s.n_c)
    for a in range(n_a):
        c = s.problem.ids[a]
        s.curve[c] = s.problem.impulse[a]
        if s.n_t > 0:
            slides = s.may_stick[c] == 0 and rubs(s, c)
            s.share[s.n_j + c] = -s.direction[c] * s.mu[c] if slides else 0.0
            s.either[s.n_j + c] = 0
    unload(s, s.curve, loaded)
    for a in range(n_a):
        s.problem.impulse[a] = s.curve[s.problem.ids[a]]


def accelerate(s: Contacts) -> None:
    """The acceleration with the rows held, into `a`; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s, s.a, s.bias)


def accelerate_on_joints(s: Contacts) -> None:
    """The same with the joints alone held."""
    hold_joints(s)
    accelerate(s)


def accelerate_as_held(s: Contacts) -> None:
    """The acceleration with the rows held, and their forces by row, into `multiplier`."""
    accelerate(s)
    list_multipliers(s)
