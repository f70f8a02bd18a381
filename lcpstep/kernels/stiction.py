"""Contacts of a step with coefficients of friction that differ between sticking and sliding.

What stuck before the step goes on with mu_s as long as that keeps it from sliding, and has mu otherwise. What slides
has mu; where it would turn about within the step it comes through rest, and sticks if mu_s holds it there, whether or
not it is pressed meanwhile: of more feet than a body stands on some are not. Each contact changes from mu to mu_s and
back at most, so that this ends.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.coefficients import Coefficients
from lcpstep.kernels.coulomb import ContactProblem, motion_of, solve_contacts
from lcpstep.kernels.repose import is_loaded, moves, share_evenly, stay
from lcpstep.kernels.vectors import clear
from lcpstep.pointers import Doubles, Indices

SLIDES, STICKS, GIVES_WAY, MEETS = range(4)  # what has been tried of a contact; the last one meets a blow


def solve_steps(
    c: ContactProblem, k: Coefficients, sticks: Indices, sliding: Doubles, n_a: int, n_f: int, impact: bool
) -> bool:
    """Impulses of n_a contacts, n_f of them with tangents, into c.impulse; False where there are none.

    Impacts meet mu, and so do all contacts that their impulses reach (`theta_method.reached`).

    sticks, sliding : (n_c,)   whether a contact stuck before the step; its sliding velocity then
    impact : whether contacts strike; these, and those reached, have the entry 1 in c.sum : (n_a,), the others 0
    """
    for f in range(n_f):
        i = c.ids[c.carrier[f]]
        k.tried[i] = STICKS if sticks[i] == 1 else SLIDES
        if impact and c.sum[c.carrier[f]] == 1.0:
            k.tried[i] = MEETS
        c.mu[i] = k.sticking[i] if k.tried[i] == STICKS else k.sliding[i]
    while True:
        if not solve_contacts(c, n_a, n_f):
            return False
        if come_to_rest(c, k, sliding, n_a, n_f):
            continue
        if not impact:
            rest_where_possible(c, sticks, sliding, n_a, n_f)
        if not give_way(c, k, n_a, n_f):
            return True


def come_to_rest(c: ContactProblem, k: Coefficients, sliding: Doubles, n_a: int, n_f: int) -> bool:
    """Give those that would turn about the coefficient of what sticks; whether one of them is pressed."""
    some = False
    for f in range(n_f):
        i = c.ids[c.carrier[f]]
        u, _ = motion_of(c, c.impulse, n_a + f, n_a + n_f)
        turns = k.tried[i] == SLIDES and u * sliding[i] <= 0.0
        if turns and moves(c, c.impulse, n_a + f, n_a + n_f):
            k.tried[i], c.mu[i] = STICKS, k.sticking[i]
            some = some or c.impulse[c.carrier[f]] > 0.0
    return some


def give_way(c: ContactProblem, k: Coefficients, n_a: int, n_f: int) -> bool:
    """Give those that are pressed, and not kept from sliding, the coefficient of what slides; are there any?"""
    some = False
    for f in range(n_f):
        i = c.ids[c.carrier[f]]
        pressed = c.impulse[c.carrier[f]] > 0.0
        if k.tried[i] == STICKS and pressed and moves(c, c.impulse, n_a + f, n_a + n_f):
            k.tried[i], c.mu[i], some = GIVES_WAY, k.sliding[i], True
    return some


def rest_where_possible(c: ContactProblem, sticks: Indices, sliding: Doubles, n_a: int, n_f: int) -> None:
    """Take impulses that leave contacts at rest for those found, where these set one in motion that has been so.

    sticks, sliding : (n_c,)   whether a contact stuck before the step; its sliding velocity then
    """
    some = False
    for f in range(n_f if n_f > 1 else 0):
        i = c.ids[c.carrier[f]]
        u, _ = motion_of(c, c.impulse, n_a + f, n_a + n_f)
        was = sticks[i] == 1 or u * sliding[i] <= 0.0
        was = was and is_loaded(c, c.carrier[f], n_a, n_f)
        some = some or (was and moves(c, c.impulse, n_a + f, n_a + n_f))
    if some:
        clear(c.sum, n_a)
        stay(c, n_a, n_f)
    share_evenly(c, n_a, n_f)
