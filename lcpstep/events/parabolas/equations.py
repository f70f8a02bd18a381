"""Contacts and joints at the state q, v, as kernels: gaps, speeds, and what they may be off. See `events.rows`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.equations import (
        free_motion,
        least_effect,
        renew_biases,
        renew_rates,
        respond,
    )
    from lcpstep.kernels.dynamics import gaps
    from lcpstep.kernels.vectors import product


def measure(s: Mechanism, t: float) -> bool:
    """Everything at the state q, v and time t: gaps, speeds, R, D, free acceleration; False where M is singular."""
    q, v, n_j = s.q, s.v, s.n_j
    if not free_motion(s, t, q, v, s.a_free):
        return False
    measure_gaps(s, t)
    renew_biases(s, t, q, v)
    renew_rates(s, t, q, v)
    respond(s)
    for i in range(s.n_c):
        s.contact.speed[i] = product(s.R, v, n_j + i, s.n_q) + s.contact.rate[i]
        size = s.contact.speed[i] + s.contact.gap[i] + s.contact.bias[i]
        if size - size != 0.0:
            return False
    return True


def measure_gaps(s: Mechanism, t: float) -> None:
    """Gaps of the contacts."""
    if s.n_c > 0:
        gaps(s.model, t, s.q, s.v, s.contact.gap)


def gap_tolerance(s: Mechanism, c: int) -> float:
    """The gap of contact c that goes without moving a coordinate by more than its tolerance."""
    return least_effect(s, s.n_j + c, s.q)


def speed_tolerance(s: Mechanism, c: int) -> float:
    """The gap velocity of contact c that goes without changing a velocity by more than its tolerance."""
    return least_effect(s, s.n_j + c, s.v)
