"""Motion under constant acceleration, as kernels: state, impulses."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.equations import size_of
    from lcpstep.kernels.together import gap_rounding
    from lcpstep.kernels.vectors import copy


def rebase(s: Mechanism, t: float) -> None:
    """Begin a new piece at time t with the state q, v."""
    copy(s.q0, s.q, 2 * s.n_q)
    s.start_at(t)


def state_at(s: Mechanism, tau: float) -> None:
    """State q, v at the time tau after the base."""
    a = s.a
    for j in range(s.n_q):
        s.q[j] = s.q0[j] + tau * (s.v0[j] + 0.5 * tau * a[j])
        s.v[j] = s.v0[j] + tau * a[j]


def rounding_of_gap(s: Mechanism, c: int) -> float:
    """What rounding may leave of the gap of contact c, of the way included by which it has come in the last step."""
    way = s.length * size_of(s, s.n_j + c, 0.0, s.v) if s.length > 0.0 else 0.0
    return gap_rounding(s.model, s.contact.G, s.q, c, way)


def press(s: Mechanism, tau: float) -> None:
    """Add the impulses of the forces over the time tau."""
    for c in range(s.n_c):
        s.contact.impulse[c] = s.contact.impulse[c] + s.contact.multiplier[c] * tau
    for i in range(s.n_j):
        s.joint.impulse[i] = s.joint.impulse[i] + s.joint.multiplier[i] * tau
