"""Contacts of a step with coefficients of friction that differ between sticking and sliding.

What stuck before the step goes on with mu_s as long as that keeps it from sliding, and has mu otherwise. What slides
has mu; where it would turn about within the step it comes through rest, and sticks if mu_s holds it there, whether or
not it is pressed meanwhile: of more feet than a body stands on some are not. Each contact changes from mu to mu_s and
back at most, so that this ends.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.coefficients import Coefficients
    from lcpstep.kernels.coulomb import ContactProblem, slip, solve_contacts
    from lcpstep.pointers import Doubles, Indices, abs

AT_REST = 1e-12  # of the terms of a sliding velocity: less is rounding
SLIDES, STICKS, GIVES_WAY = range(3)  # what has been tried of a contact


def solve_steps(
    c: ContactProblem, k: Coefficients, sticks: Indices, sliding: Doubles, n_a: int, n_f: int
) -> bool:
    """Impulses of n_a contacts, n_f of them with tangents, into c.impulse; False where there are none.

    sticks, sliding : (n_c,)   whether a contact stuck before the step; its sliding velocity then
    """
    for f in range(n_f):
        i = c.ids[c.carrier[f]]
        k.tried[i] = STICKS if sticks[i] == 1 else SLIDES
        c.mu[i] = k.sticking[i] if sticks[i] == 1 else k.sliding[i]
    while True:
        if not solve_contacts(c, n_a, n_f):
            return False
        again = False
        for f in range(n_f):
            i = c.ids[c.carrier[f]]
            turns = k.tried[i] == SLIDES and moves(c, n_a, n_f, f) and slip(c, n_a, n_f, f) * sliding[i] <= 0.0
            pressed = c.impulse[c.carrier[f]] > 0.0
            if turns:
                k.tried[i], c.mu[i], again = STICKS, k.sticking[i], again or pressed
            elif pressed and k.tried[i] == STICKS and moves(c, n_a, n_f, f):
                k.tried[i], c.mu[i], again = GIVES_WAY, k.sliding[i], True
        if not again:
            return True


def terms(c: ContactProblem, n_a: int, n_f: int, f: int) -> float:
    """Size of the terms of the same velocity, their signs left aside."""
    m = n_a + n_f
    size = abs(c.rate[n_a + f])
    for b in range(m):
        size += abs(c.mobility[(n_a + f) * m + b] * c.impulse[b])
    return size


def moves(c: ContactProblem, n_a: int, n_f: int, f: int) -> bool:
    """Whether the impulses found do not keep contact f from sliding."""
    return abs(slip(c, n_a, n_f, f)) > AT_REST * terms(c, n_a, n_f, f)
