"""The equations of one contact at one state, as kernels.

Free, the motion follows M v' = f; closed, the contact force keeps g = 0:

    v' = M^-1 (f + G^T lambda),    lambda = -alpha / (G M^-1 G^T),    alpha = G M^-1 f + bias

alpha is the gap acceleration of the free motion: the contact releases where it turns positive. Source: G. Osorio,
Complex Behavior in Impacting Systems, eqs. 3.5 and 3.16.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address
from lcpstep.dense import assign, positive_definite, solve_definite
from lcpstep.dynamics import bias, gap_rates, gaps, mass, product
from lcpstep.events.acceleration import free_acceleration
from lcpstep.events.clock import inside
from lcpstep.events.contact import CLOSED, MODE, N_CONTACT

# Places in Piece.x after those of clock and contact: duration of the piece; size of the next step; gap at the base,
# where it is known better than by a difference (see `corner`)
LENGTH, NEXT_STEP, GAP0 = range(N_CONTACT, N_CONTACT + 3)
N_PIECE = N_CONTACT + 3


@by_address
class Piece(NamedTuple):
    """A piece of smooth motion, one step long; the state last asked for, and work space."""

    model: Any
    contact: bool  # whether the scene has one
    plan: Any
    corners: Any  # (m,) in [0, period)
    x: Any  # numbers, see `clock`, `contact`, `loop`
    w: Any  # of the Runge-Kutta method
    q0: Any  # (n_q,) state at the base time
    v0: Any
    q: Any  # (n_q,) state last asked for
    v: Any
    a: Any  # (n_q,) free acceleration M^-1 f there
    y: Any  # (2 n_q,) the same q, v
    G: Any  # (1, n_q)
    g_t: Any  # (1,)
    g: Any  # (1,)
    MG: Any  # (n_q,)  M^-1 G^T
    M: Any  # (n_q, n_q)
    G_shifted: Any  # (1, n_q), of the differences
    g_t_shifted: Any
    q_shifted: Any
    bias: Any  # (1,)


def inverse_mass_times(s: Any, t: float, q: Any, v: Any, x: Any) -> None:
    """x <- M^-1 x."""
    mass(s.model, t, q, v, s.M)
    positive_definite(s.M)
    solve_definite(s.M, x)


def contact_response(s: Any, t: float, q: Any, v: Any) -> float:
    """G M^-1 G^T of the contact; G, g_t and M^-1 G^T into the piece."""
    gap_rates(s.model, t, q, v, s.G, s.g_t)
    assign(s.MG, s.G[0])
    inverse_mass_times(s, t, q, v, s.MG)
    return product(s.G, s.MG, 0)


def gap_bias(s: Any, t: float, q: Any, v: Any) -> float:
    """(dG/dt) v + d(g_t)/dt along the motion."""
    bias(s.model, t, q, v, s.q_shifted, s.G_shifted, s.g_t_shifted, s.bias)
    return s.bias[0]


def right_hand_side(s: Any, t: float, y: Any, dy: Any) -> bool:
    """dy = (v, v') of the piece's mode; False where the acceleration is not finite."""
    n = len(s.q)
    q, v, a = y[:n], y[n:], dy[n:]
    t = inside(s.x, t)
    if not free_acceleration(s, t, q, v, a):
        return False
    if s.x[MODE] == CLOSED:
        W = contact_response(s, t, q, v)
        multiplier = -(product(s.G, a, 0) + gap_bias(s, t, q, v)) / W
        for i in range(n):
            a[i] += s.MG[i] * multiplier
    for i in range(n):
        dy[i] = v[i]
    return True


def surface_acceleration(s: Any, t: float) -> float:
    """alpha at time t and the state s.q, s.v."""
    side = inside(s.x, t)
    free_acceleration(s, side, s.q, s.v, s.a)
    gap_rates(s.model, t, s.q, s.v, s.G, s.g_t)
    return product(s.G, s.a, 0) + gap_bias(s, side, s.q, s.v)


def project(s: Any, t: float) -> None:
    """Put s.q, s.v onto the surface: g = 0, u = 0, against the drift of the integration."""
    for _ in range(2):
        W = contact_response(s, t, s.q, s.v)
        gaps(s.model, t, s.q, s.v, s.g)
        for i in range(len(s.q)):
            s.q[i] -= s.MG[i] * s.g[0] / W
    W = contact_response(s, t, s.q, s.v)
    u = product(s.G, s.v, 0) + s.g_t[0]
    for i in range(len(s.v)):
        s.v[i] -= s.MG[i] * u / W
