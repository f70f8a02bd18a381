"""The smooth motion between events, as kernels: pieces that can be asked for any time within them.

A piece starts at a base time with the state (q, v) and is one DOP853 step long. Free, it follows M v' = f; closed,
the contact force keeps g = 0:

    v' = M^-1 (f + G^T lambda),    lambda = -alpha / (G M^-1 G^T),    alpha = G M^-1 f + bias

alpha is the gap acceleration of the free motion: the contact releases where it turns positive. Source: G. Osorio,
Complex Behavior in Impacting Systems, eqs. 3.5 and 3.16.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call, inline
from lcpstep.dense import assign, positive_definite, solve_definite, split
from lcpstep.dynamics import gap_rates, gaps, mass, product, total_force
from lcpstep.events.dop853 import STAGES, combine, interpolant, interpolate
from lcpstep.model import ABSENT

FREE, CLOSED = 0, 1  # modes of the contact
# Places in the array of a piece's numbers
T0, T0_REST, LENGTH, LOW, HIGH, SCALE, MODE, SPEED0, ALPHA0, ON_SURFACE, REST = range(11)
N_NUMBERS = 11
NUDGE = 2.0**-49  # relative; keeps accelerations on their own side of a corner
DIFFERENCE = 1e-3  # step of the fourth-order differences that stand in for a missing bias
GAUSS = (  # nodes and weights on [0, 1]
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127307),
    (0.6699905217924281, 0.32607257743127307),
    (0.9305681557970263, 0.17392742256872692),
)


@by_address
class Piece(NamedTuple):
    """A piece of smooth motion, the state last asked for, and work space."""

    x: Any  # (N_NUMBERS,) base time, length, the smooth interval (LOW, HIGH) around it, mode; see above
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


def after(piece: Any, tau: float) -> float:
    """The time tau after the base of the piece; what rounding takes from it is kept for the next base.

    Without it, 10^5 equal flights would drift by 10^5 roundings of the time, all of one sign.
    """
    step = piece.x[T0_REST] + tau
    t = piece.x[T0] + step
    moved = t - piece.x[T0]
    piece.x[REST] = (piece.x[T0] - (t - moved)) + (step - moved)
    return t


@inline
def inside(piece: Any, t: float) -> float:
    """A time moved off the ends of its smooth interval, where accelerations jump."""
    margin = NUDGE * max(abs(t), piece.x[SCALE])
    return min(max(t, piece.x[LOW] + margin), piece.x[HIGH] - margin)


def free_acceleration(model: Any, piece: Any, t: float, q: Any, v: Any, a: Any) -> bool:
    """a = M^-1 f; False where M is singular or f is not finite."""
    total_force(model, t, q, v, a)
    if model.mass == ABSENT:
        for i in range(len(a)):
            piece.y[i] = a[i]
        for i in range(len(a)):
            a[i] = 0.0
            for j in range(len(a)):
                a[i] += model.M_inverse[i, j] * piece.y[j]
        return a[0] - a[0] == 0.0
    mass(model, t, q, v, piece.M)
    if not positive_definite(piece.M):
        return False
    solve_definite(piece.M, a)
    return a[0] - a[0] == 0.0


def inverse_mass_times(model: Any, piece: Any, t: float, q: Any, v: Any, x: Any) -> None:
    """x <- M^-1 x."""
    mass(model, t, q, v, piece.M)
    positive_definite(piece.M)
    solve_definite(piece.M, x)


def contact_response(model: Any, piece: Any, t: float, q: Any, v: Any) -> float:
    """G M^-1 G^T of the contact; G, g_t and M^-1 G^T into the piece."""
    gap_rates(model, t, q, v, piece.G, piece.g_t)
    assign(piece.MG, piece.G[0])
    inverse_mass_times(model, piece, t, q, v, piece.MG)
    return product(piece.G, piece.MG, 0)


def gap_bias(model: Any, piece: Any, t: float, q: Any, v: Any) -> float:
    """(dG/dt) v + d(g_t)/dt along the motion."""
    if model.flat:
        if model.motion == ABSENT:
            return 0.0
        call(model.motion, t, q, v, model.p, model.motion_now)
        return -model.motion_now[0, 2]
    if model.bias != ABSENT:
        call(model.bias, t, q, v, model.p, piece.g_t_shifted)
        return piece.g_t_shifted[0]
    size = 1.0
    for i in range(len(q)):
        size = max(size, abs(v[i]))
    d = DIFFERENCE / size
    return (
        8.0 * (gap_speed_along(model, piece, t, q, v, d) - gap_speed_along(model, piece, t, q, v, -d))
        - gap_speed_along(model, piece, t, q, v, 2.0 * d)
        + gap_speed_along(model, piece, t, q, v, -2.0 * d)
    ) / (12.0 * d)


def gap_speed_along(model: Any, piece: Any, t: float, q: Any, v: Any, d: float) -> float:
    """G v + g_t at t + d, q + d v, with the same v."""
    for i in range(len(q)):
        piece.q_shifted[i] = q[i] + d * v[i]
    gap_rates(model, t + d, piece.q_shifted, v, piece.G_shifted, piece.g_t_shifted)
    return product(piece.G_shifted, v, 0) + piece.g_t_shifted[0]


def right_hand_side(model: Any, piece: Any, t: float, y: Any, dy: Any) -> bool:
    """dy = (v, v') of the piece's mode; False where the acceleration is not finite."""
    n = len(piece.q)
    q, v, a = y[:n], y[n:], dy[n:]
    t = inside(piece, t)
    if not free_acceleration(model, piece, t, q, v, a):
        return False
    if piece.x[MODE] == CLOSED:
        W = contact_response(model, piece, t, q, v)
        multiplier = -(product(piece.G, a, 0) + gap_bias(model, piece, t, q, v)) / W
        for i in range(n):
            a[i] += piece.MG[i] * multiplier
    for i in range(n):
        dy[i] = v[i]
    return True


def rk_step(model: Any, piece: Any, tab: Any, w: Any, t: float, h: float) -> bool:
    """DOP853 step of size h from w.y to w.y_new."""
    if not right_hand_side(model, piece, t, w.y, w.K[0]):
        return False
    if not stages(model, piece, tab, w, t, h, 1, STAGES):
        return False
    combine(tab, w, h, STAGES)
    assign(w.y_new, w.y_stage)
    return right_hand_side(model, piece, t + h, w.y_new, w.K[STAGES])


def rk_dense(model: Any, piece: Any, tab: Any, w: Any, t: float, h: float) -> bool:
    """Dense output of the step that `rk_step` has just made."""
    if not stages(model, piece, tab, w, t, h, STAGES + 1, 16):
        return False
    interpolant(tab, w, h)
    piece.x[LENGTH] = h
    return True


def stages(model: Any, piece: Any, tab: Any, w: Any, t: float, h: float, first: int, end: int) -> bool:
    """Stages first .. end - 1 of a step."""
    for stage in range(first, end):
        combine(tab, w, h, stage)
        if not right_hand_side(model, piece, t + tab.C[stage] * h, w.y_stage, w.K[stage]):
            return False
    return True


def state_at(model: Any, osc: Any, piece: Any, w: Any, tau: float) -> None:
    """q and v at the time tau after the base of the piece, into the piece."""
    if tau == 0.0:
        assign(piece.q, piece.q0)
        assign(piece.v, piece.v0)
    else:
        interpolate(w.F, w.y, tau / piece.x[LENGTH], piece.y)
        split(piece.y, piece.q, piece.v)


def contact_at(model: Any, osc: Any, piece: Any, w: Any, tau: float) -> tuple[float, float, float]:
    """Gap, gap velocity and gap acceleration of the free motion, at tau after the base of the piece."""
    t = piece.x[T0] + tau
    state_at(model, osc, piece, w, tau)
    gaps(model, t, piece.q, piece.v, piece.g)
    gap_rates(model, t, piece.q, piece.v, piece.G, piece.g_t)
    u = product(piece.G, piece.v, 0) + piece.g_t[0]
    side = inside(piece, t)
    free_acceleration(model, piece, side, piece.q, piece.v, piece.a)
    return piece.g[0], u, product(piece.G, piece.a, 0) + gap_bias(model, piece, side, piece.q, piece.v)


def gap_acceleration(model: Any, osc: Any, piece: Any, w: Any, tau: float) -> float:
    """alpha at tau after the base of the piece."""
    _, _, alpha = contact_at(model, osc, piece, w, tau)
    return alpha


def near_surface(model: Any, osc: Any, piece: Any, w: Any, tau: float) -> tuple[float, float]:
    """g / tau and u after leaving the surface at the base of the piece, from the acceleration alone.

    g = tau (u0 + tau int_0^1 (1-s) alpha(s tau) ds), u = u0 + tau int_0^1 alpha(s tau) ds: no difference of
    nearly equal positions is taken, so the smallest hops keep all their digits. The integrals are of alpha less
    its value at the base, so that equal hops under constant acceleration stay equal to the last digit.
    """
    alpha0 = piece.x[ALPHA0]
    mean, weighted = alpha0, 0.5 * alpha0
    for node, weight in GAUSS:
        change = gap_acceleration(model, osc, piece, w, node * tau) - alpha0
        mean += weight * change
        weighted += weight * (1.0 - node) * change
    return piece.x[SPEED0] + tau * weighted, piece.x[SPEED0] + tau * mean
