"""A piece of smooth motion that can be asked for any time within it, as kernels: state, gap, contact force.

A piece starts at a base time with the state (q, v) and is one DOP853 step long, whose dense output it is.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import assign, join, largest, split
from lcpstep.dynamics import gap_rates, gaps, product
from lcpstep.events.acceleration import free_acceleration
from lcpstep.events.clock import RESOLUTION, T0, inside, start_at
from lcpstep.events.contact import ALPHA0, ON_SURFACE, ON_THE_SURFACE, SPEED0
from lcpstep.events.dop853 import interpolate
from lcpstep.events.single.equations import GAP0, LENGTH, contact_response, gap_bias

GAUSS = (  # nodes and weights on [0, 1]
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127307),
    (0.6699905217924281, 0.32607257743127307),
    (0.9305681557970263, 0.17392742256872692),
)
NODES = tuple(node for node, _ in GAUSS)
# What the quadrature leaves of the first power that it does not integrate, x^8: (4!)^4 / (9 (8!)^2)
REMAINDER = math.factorial(4) ** 4 / (9 * math.factorial(8) ** 2)


def rebase(s: Any, t: float) -> None:
    """Begin a new piece at time t with the state s.q, s.v."""
    assign(s.q0, s.q)
    assign(s.v0, s.v)
    join(s.w.y, s.q, s.v)
    start_at(s.x, t)
    s.x[ON_SURFACE], s.x[SPEED0], s.x[GAP0] = 0.0, 0.0, 0.0


def state_at(s: Any, tau: float) -> None:
    """q and v at the time tau after the base of the piece, into the piece."""
    if tau == 0.0:
        assign(s.q, s.q0)
        assign(s.v, s.v0)
    else:
        interpolate(s.w.F, s.w.y, tau / s.x[LENGTH], s.y)
        split(s.y, s.q, s.v)


def contact_at(s: Any, tau: float) -> tuple[float, float, float]:
    """Gap, gap velocity and gap acceleration of the free motion, at tau after the base of the piece."""
    t = s.x[T0] + tau
    state_at(s, tau)
    gaps(s.model, t, s.q, s.v, s.g)
    gap_rates(s.model, t, s.q, s.v, s.G, s.g_t)
    u = product(s.G, s.v, 0) + s.g_t[0]
    side = inside(s.x, t)
    free_acceleration(s, side, s.q, s.v, s.a)
    return s.g[0], u, product(s.G, s.a, 0) + gap_bias(s, side, s.q, s.v)


def gap_acceleration(s: Any, tau: float) -> float:
    """alpha at tau after the base of the piece."""
    _, _, alpha = contact_at(s, tau)
    return alpha


def near_surface(s: Any, tau: float) -> tuple[float, float, bool]:
    """g / tau and u after leaving the surface at the base of the piece, from the acceleration alone.

    g = tau (u0 + tau int_0^1 (1-s) alpha(s tau) ds), u = u0 + tau int_0^1 alpha(s tau) ds: no difference of
    nearly equal positions is taken, so the smallest hops keep all their digits. The integrals are of alpha less
    its value at the base, so that equal hops under constant acceleration stay equal to the last digit. Last, whether
    the quadrature is as good as what rounding of the positions leaves of the gap.
    """
    alpha0 = s.x[ALPHA0]
    mean, weighted, most = alpha0, 0.5 * alpha0, abs(alpha0)
    d0 = d1 = d2 = d3 = 0.0
    for k in range(len(GAUSS)):
        node, weight = GAUSS[k]
        alpha = gap_acceleration(s, node * tau)
        change = alpha - alpha0
        mean += weight * change
        weighted += weight * (1.0 - node) * change
        most = max(most, abs(alpha))
        d0, d1, d2, d3 = d1, d2, d3, change / node
    speed = s.x[SPEED0] + tau * weighted
    left = tau * tau * REMAINDER * eighth_power(d0, d1, d2, d3, most)
    exact = left <= RESOLUTION * max(largest(s.q0, 0.0), s.x[SPEED0] * tau)
    return speed, s.x[SPEED0] + tau * mean, exact


def eighth_power(d0: float, d1: float, d2: float, d3: float, most: float) -> float:
    """Estimate of the coefficient of x^8 in a function of size `most`; d: its change since x = 0 over x, at NODES.

    Coefficients fall like powers of one ratio, which is the largest that those of x^2, x^3 and x^4 show.
    """
    n0, n1, n2, n3 = NODES
    d01, d12, d23 = (d1 - d0) / (n1 - n0), (d2 - d1) / (n2 - n1), (d3 - d2) / (n3 - n2)
    d02, d13 = (d12 - d01) / (n2 - n0), (d23 - d12) / (n3 - n1)
    c4 = (d13 - d02) / (n3 - n0)
    c3 = d02 - c4 * (n0 + n1 + n2)
    c2 = d01 - (n0 + n1) * d02 + c4 * (n0 * n1 + n0 * n2 + n1 * n2)
    if most == 0.0:
        return 0.0
    ratio = max(math.sqrt(abs(c2) / most), (abs(c3) / most) ** (1.0 / 3.0), (abs(c4) / most) ** 0.25)
    return most * ratio**8


def contact_impulse(s: Any, a: float, b: float) -> float:
    """Impulse of the contact force lambda = -alpha / (G M^-1 G^T) over (a, b) of a closed piece [N s]."""
    total = 0.0
    for k in range(len(s.plan.nodes)):
        tau = a + s.plan.nodes[k] * (b - a)
        alpha = gap_acceleration(s, tau)
        total -= s.plan.weights[k] * alpha / contact_response(s, s.x[T0] + tau, s.q, s.v)
    return total * (b - a)


def velocity_noise(s: Any) -> float:
    """Rounding of the gap velocity at the state of the piece [m/s]."""
    return ON_THE_SURFACE * largest(s.v, 1.0)
