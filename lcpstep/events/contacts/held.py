"""The rows that the modes hold, as kernels, sliding friction included; see `events.rows.held`.

    C_c = N_c - s mu T_c where contact c slides (sign s)

The rows are held in turn: joints, what sticks, normals that slide (those that carry a force first).
Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapters 5 and 6.
"""

from __future__ import annotations

import cython

from lcpstep.events.contacts.codes import LEANS, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.contacts.equations import add_impulse, measure_friction
    from lcpstep.events.contacts.state import Rubbing
    from lcpstep.events.rows.equations import (
        free_motion,
        measure_biases,
        other,
        renew_biases,
        renew_rates,
        respond_held,
    )
    from lcpstep.events.rows.held import (
        constrain,
        hold,
        hold_again,
        hold_joints,
        is_held,
    )
    from lcpstep.kernels.acceleration import inverse_mass
    from lcpstep.kernels.dynamics import total_force
    from lcpstep.kernels.vectors import add, clear, copy
    from lcpstep.pointers import Doubles, after


def pull(s: Rubbing, i: int) -> float:
    """How much of the `other` force of its contact comes with that of row i.

    -s mu of the tangent's with a normal that slides or leans; the inverse of the normal's where the tangent of a
    contact that leans is held.
    """
    c = i - s.n_j
    if 0 <= c < s.n_c and s.mode[c] >= SLIDES:
        return -s.direction[c] * (s.mu[c] if s.mode[c] == SLIDES else s.mu_s[c])
    c -= s.n_c
    return -s.direction[c] / s.mu_s[c] if c >= 0 and s.mode[c] == LEANS else 0.0


def hold_row(s: Rubbing, i: int) -> bool:
    """Add row i to the rows held, unless it depends on them; False where sliding takes its force away.

    Of what leans on others the sign tells nothing: it does not slide.
    """
    s.rows.share[i], s.rows.either[i] = pull(s, i), 1 if leans(s, i) else 0
    return hold(s.rows, i)


def leans(s: Rubbing, i: int) -> bool:
    """Whether row i is of a contact that leans on others."""
    return i >= s.n_j and s.mode[(i - s.n_j) % s.n_c] == LEANS


def accelerate_on_joints(s: Rubbing) -> None:
    """The acceleration with the joints alone held, into `a`; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    hold_joints(s.rows)
    constrain(s.rows, s.a, s.bias)


def accelerate_as_held(s: Rubbing) -> None:
    """The acceleration with the rows held, into `a`, and multipliers by row; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s.rows, s.a, s.bias)
    list_multipliers(s)


def hold_modes(s: Rubbing) -> bool:
    """Hold what the modes hold; False where a sliding contact has no force that would (`culprit`).

    What sticks comes first: it may carry what a contact that leans on it, or slides beside it, could not by itself.
    """
    s.mapped = False
    hold_joints(s.rows)
    for c in range(s.n_c):
        if s.mode[c] == STICKS:
            hold_row(s, s.n_j + c)
    for c in range(s.n_c):
        if s.mode[c] == STICKS:
            hold_row(s, s.n_j + s.n_c + c)
    for unloaded in range(2):
        for c in range(s.n_c):
            if s.mode[c] >= SLIDES and s.loaded[c] == 1 - unloaded and not hold_row(s, s.n_j + c):
                s.culprit = c
                return False
        if unloaded == 0:
            hold_leaning(s)
    return True


def hold_leaning(s: Rubbing) -> None:
    """The tangents of loaded contacts that lean, whose normals depend on the rows held.

    Three feet on a line share two normals and one tangent: their forces are known from these three rows.
    """
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == LEANS and s.loaded[c] == 1 and not is_held(s.rows, i):
            hold_row(s, i + s.n_c)


def hold_modes_again(s: Rubbing) -> bool:
    """The same rows, measured at another state; False where they have become dependent."""
    for m in range(s.rows.n_held):
        s.rows.share[s.rows.row[m]] = pull(s, s.rows.row[m])
    respond_held(s.rows)
    i = hold_again(s.rows)
    if i >= 0:
        s.culprit = i - s.n_j if s.n_j <= i < s.n_j + s.n_c else -1
    return i < 0


def right_hand_side(s: Rubbing, t: float, y: Doubles, dy: Doubles) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite, or they cannot be held."""
    n = s.n_q
    a = after(dy, n)
    copy(dy, after(y, n), n)
    if s.constant:
        accelerate(s, t, y, a)
        return a[0] - a[0] == 0.0
    if not free_motion(s.rows, t, y, after(y, s.n_q), a):
        return False
    if s.rows.n_held > 0:
        renew_rates(s.rows, t, y, after(y, n))
        renew_biases(s.rows, t, y, after(y, n))
        if not measure_friction(s, t, y) or not hold_modes_again(s):
            return False
        constrain(s.rows, a, s.bias)
    list_multipliers(s)
    return a[0] - a[0] == 0.0


def know_rows(s: Rubbing, t: float, y: Doubles, dy: Doubles) -> bool:
    """The same, and rates and biases of all rows, if none is held as well."""
    if not right_hand_side(s, t, y, dy):
        return False
    if s.rows.n_held == 0:
        renew_rates(s.rows, t, y, after(y, s.n_q))
        renew_biases(s.rows, t, y, after(y, s.n_q))
    return True


def accelerate(s: Rubbing, t: float, y: Doubles, a: Doubles) -> None:
    """Acceleration, and multipliers by row, where rows and masses never change: linear in forces and biases."""
    n, m = s.n_q, s.n_q + s.n_r
    if not s.mapped:
        map_forces(s)
    total_force(s.model, s.clock.inside(t), y, after(y, n), s.force)
    clear(s.effect, m)
    for j in range(n):
        add(s.effect, s.force[j], after(s.effects, j * m), m)
    if s.rows.moving and s.rows.n_held > 0:
        renew_rates(s.rows, t, y, after(y, s.n_q))
        measure_biases(s.rows, t, y, after(y, s.n_q))
        for i in range(s.n_r):
            add(s.effect, s.bias[i], after(s.effects, (n + i) * m), m)
    copy(a, s.effect, n)


def map_forces(s: Rubbing) -> None:
    """What each force does alone, and each bias."""
    n, r, a, bias = s.n_q, s.n_r, s.dv, s.shifted_rate
    for k in range(n + r if s.rows.moving else n):
        clear(a, n)
        clear(bias, r)
        if k < n:
            a[k] = 1.0
            inverse_mass(s.model, s.rows.M, s.rows.work, a)
        else:
            bias[k - n] = 1.0
        constrain(s.rows, a, bias)
        list_multipliers(s)
        copy(s.effect, a, n)
        copy(after(s.effects, k * (n + r)), s.effect, n + r)
    s.mapped = True


def list_multipliers(s: Rubbing) -> None:
    """Forces by row from those of the rows held: the friction of sliding contacts on their tangents."""
    clear(s.multiplier, s.n_r)
    for m in range(s.rows.n_held):
        i = s.rows.row[m]
        s.multiplier[i] = s.multiplier[i] + s.rows.held[m]
        share = s.rows.share[i]
        if share != 0.0:
            s.multiplier[other(s.rows, i)] = s.multiplier[other(s.rows, i)] + share * s.rows.held[m]


def stop_rows(s: Rubbing) -> None:
    """Impulses on the rows held, sliding friction included, that take their velocities."""
    constrain(s.rows, s.v, s.rate)
    count_impulses(s, s.rows.held)


def take_velocities(s: Rubbing) -> None:
    """The same, not counted, but by row into `multiplier`."""
    constrain(s.rows, s.v, s.rate)
    list_multipliers(s)


def count_impulses(s: Rubbing, x: Doubles) -> None:
    """Count impulses of the rows held, with the friction of those that slide."""
    for m in range(s.rows.n_held):
        i = s.rows.row[m]
        add_impulse(s, i, x[m])
        share = s.rows.share[i]
        if share != 0.0:
            add_impulse(s, other(s.rows, i), share * x[m])
