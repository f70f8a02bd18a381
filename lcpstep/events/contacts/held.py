"""The rows that the modes hold, as kernels, sliding friction included; see `events.rows.held`.

    C_c = N_c - s mu T_c where contact c slides (sign s)

Which rows these are, and in which turn, see `events.rows.contacts.hold_modes`.
Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapters 5 and 6.
"""

from __future__ import annotations

import cython

from lcpstep.events.contacts.equations import measure_friction
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import friction_ratio, list_multipliers
from lcpstep.events.rows.equations import free_motion, measure_biases, measure_rates, respond_held
from lcpstep.events.rows.held import constrain, entry, hold_again
from lcpstep.kernels.acceleration import inverse_mass
from lcpstep.kernels.dynamics import total_force
from lcpstep.kernels.vectors import add, clear, copy
from lcpstep.pointers import Doubles, after


def hold_modes_again(s: Rubbing) -> bool:
    """The same rows, measured at another state; False where they have become dependent."""
    for m in range(s.rows.n_held):
        s.rows.share[s.rows.row[m]] = friction_ratio(s.rows, s.rows.row[m])
    respond_held(s.rows)
    i = hold_again(s.rows)
    if i >= 0:
        own = entry(s.rows, i, i)  # not a number where a callback is not finite, and no contact's fault then
        s.rows.culprit = i - s.n_j if s.n_j <= i < s.n_j + s.n_c and own - own == 0.0 else -1
    return i < 0


def right_hand_side(s: Rubbing, t: float, y: Doubles, dy: Doubles) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite, or they cannot be held."""
    n = s.n_q
    a = after(dy, n)
    copy(dy, after(y, n), n)
    if s.constant:
        accelerate(s, t, y, a)
        return a[0] - a[0] == 0.0
    if not free_motion(s.rows, t, y, a):
        return False
    if s.rows.n_held > 0:
        measure_rates(s.rows, t, y)
        measure_biases(s.rows, t, y)
        if not measure_friction(s, t, y) or not hold_modes_again(s):
            return False
        constrain(s.rows, a, s.bias)
    list_multipliers(s.rows)
    return a[0] - a[0] == 0.0


def know_rows(s: Rubbing, t: float) -> bool:
    """The same of the state `seen`, into `dy`, and rates and biases of all rows, if none is held as well."""
    if not right_hand_side(s, t, s.seen, s.dy):
        return False
    if s.rows.n_held == 0:
        measure_rates(s.rows, t, s.seen)
    know_biases(s, t, s.seen)
    return True


def know_biases(s: Rubbing, t: float, y: Doubles) -> None:
    """Biases of all rows where rates and forces are known; if any row is held these have needed them already."""
    if s.rows.n_held == 0:
        measure_biases(s.rows, t, y)


def accelerate(s: Rubbing, t: float, y: Doubles, a: Doubles) -> None:
    """Acceleration, and multipliers by row, where rows and masses never change: linear in forces and biases."""
    n, m = s.n_q, s.n_q + s.n_r
    if not s.rows.mapped:
        map_forces(s)
    total_force(s.model, s.rows.inside(t), y, after(y, n), s.force)
    clear(s.effect, m)
    for j in range(n):
        add(s.effect, s.force[j], after(s.effects, j * m), m)
    if s.rows.moving and s.rows.n_held > 0:
        measure_rates(s.rows, t, y)
        measure_biases(s.rows, t, y)
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
        list_multipliers(s.rows)
        copy(s.effect, a, n)
        copy(after(s.effects, k * (n + r)), s.effect, n + r)
    s.rows.mapped = True
