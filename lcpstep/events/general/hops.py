"""Short hops of contacts of a Runge-Kutta step, as kernels: followed by the gap acceleration, not by the gap.

    g = g0 + u0 tau + tau^2 int_0^1 (1 - x) alpha(x tau) dx,      u = u0 + tau int_0^1 alpha(x tau) dx

A hop as low as the rounding of positions is lost in their difference, and with it the end of a chattering sequence,
which is where the hops before put it. So the landing of a hop that starts on the surface is sought in the integrals;
a low one that crosses a corner goes on beyond it from the gap and the speed that they give there. So does one hardly
higher than that rounding beyond the end of a step, or what happens to another contact: from a gap that rounding has
made larger an elastic one would gain energy, hop by hop, and never come to rest.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from math import pow, sqrt

    from lcpstep.events.general.earliest import NEVER, NONE, gap_noise, observe
    from lcpstep.events.general.equations import gap_tolerance
    from lcpstep.events.general.impact import speed_noise
    from lcpstep.events.general.parabolas import hop
    from lcpstep.events.general.state import Mechanism
    from lcpstep.kernels.clock import NOISE, RESOLUTION
    from lcpstep.kernels.quadratic import first_zero
    from lcpstep.kernels.vectors import largest
    from lcpstep.pointers import abs, inf, max, min, nan

# Gauss' nodes on [0, 1], and weights, the same for the outer and for the inner two
NODE_0, NODE_1, NODE_2, NODE_3 = (
    0.06943184420297371,
    0.33000947820757187,
    0.6699905217924281,
    0.9305681557970263,
)
OUTER, INNER = 0.17392742256872692, 0.32607257743127307
# What the quadrature leaves of the first power that it does not integrate, x^8: (4!)^4 / (9 (8!)^2)
REMAINDER = 331776.0 / (9.0 * 1625702400.0)
LONGER = 3.0  # how much longer than under constant acceleration a hop may last
SHORT = 0.02  # of the scan interval: what the quadrature of a hop resolves to rounding
LOW = 1e-6  # of the positions: higher gaps are as well known by their difference
FAINT = 1e-12  # the same where no corner is: of lower ones it tells no more than four digits
UNLIKE = 1e-6  # of the way that its speed at first would take a gap: one so far open has not landed
STEADY = 1e-7  # of its terms: a gap velocity that changes by more at a corner does not do so by errors of integration


def find_landings(s: Mechanism, h: float) -> None:
    """When the hops that have just begun land within the step of size h, into `lands`."""
    for c in range(s.n_c):
        s.contact.lands[c], s.contact.carried[c] = landing(s, c, h), 0


def landing(s: Mechanism, c: int, h: float) -> float:
    """When contact c lands within the step, NEVER if it does not, or NONE if the gap itself is to be looked at."""
    guess = hop_time(s, c, s.start.gap[c], s.start.speed[c], s.start.curve[c])
    low = guess < inf and is_low(s, c, h)
    if not low and not guess < h:
        return NONE
    longest = min(LONGER * guess, h)
    tau = hop_end(s, c, guess, longest)
    if low:
        return NEVER if tau == NONE else tau
    return tau if tau == NONE or ends_so(s, c, tau) else NONE


def shortest_hop(s: Mechanism) -> float:
    """Duration of the shortest hop that has just begun, were its acceleration constant."""
    shortest = inf
    for c in range(s.n_c):
        shortest = min(shortest, hop_time(s, c, s.contact.gap[c], s.contact.speed[c], s.contact.curve[c]))
    return shortest


def hop_time(s: Mechanism, c: int, g: float, u: float, alpha: float) -> float:
    """Duration of the hop of contact c that begins so at the base, were alpha constant; infinite if none does."""
    if s.contact.closed[c] == 1 or not alpha < 0.0:
        return inf
    if g == 0.0:
        return hop(u, alpha) if u > 0.0 else inf
    return first_zero(g, u, 0.5 * alpha) if s.contact.carried[c] == 1 else inf


def is_low(s: Mechanism, c: int, h: float) -> bool:
    """Whether a hop that is pressed stays low up to the end of the step of size h, at a corner or not."""
    if h > SHORT * s.scan:
        return False
    low = LOW if h >= s.high - s.t0 else FAINT
    highest = s.start.gap[c] + h * (abs(s.start.speed[c]) + 0.5 * h * abs(s.start.curve[c]))
    return highest <= low * largest(s.q0, 0.0, s.n_q)


def hop_end(s: Mechanism, c: int, guess: float, longest: float) -> float:
    """End of a hop that begins with a gap g0 >= 0 at the base, or NONE if it is longer than `longest`: g / tau = 0.

    NONE as well where g0 is zero and the acceleration changes too much for the quadrature: such hops are seen in the
    gap itself.
    """
    g0 = s.start.gap[c]
    f, u, exact = follow(s, c, longest)
    if f + g0 / longest > 0.0:
        return NONE
    s.bracket.begin(0.0, longest, True, min(guess, longest))
    while s.bracket.seek(2.0 * RESOLUTION * s.bracket.x):
        x = s.bracket.x
        f, u, exact = follow(s, c, x)
        if g0 == 0.0 and not exact:
            return NONE
        f += g0 / x
        s.bracket.newton(f, (u - f) / x)
    return s.bracket.x


def ends_so(s: Mechanism, c: int, tau: float) -> bool:
    """Whether the gap itself is closed where its hop lands.

    It is another one where the obstacle has an edge or a valley, at which the gap velocity jumps.
    """
    if not observe(s, tau):
        return False
    errors = max(gap_noise(s, c), gap_tolerance(s, c))
    return abs(s.contact.gap[c]) <= UNLIKE * tau * abs(s.start.speed[c]) + errors


def follow(s: Mechanism, c: int, tau: float) -> tuple[float, float, bool]:
    """(g - g0) / tau and u at tau after the base, and whether they are as good as rounding leaves the gap itself.

    The integrals are of alpha less its value at the base, so that equal hops under constant acceleration stay equal
    to the last digit.
    """
    alpha = s.start.curve[c]
    d0, d1 = change_of_curve(s, c, NODE_0 * tau), change_of_curve(s, c, NODE_1 * tau)
    d2, d3 = change_of_curve(s, c, NODE_2 * tau), change_of_curve(s, c, NODE_3 * tau)
    mean = alpha + (OUTER * (d0 + d3) + INNER * (d1 + d2))
    outer, inner = (1.0 - NODE_0) * d0 + (1.0 - NODE_3) * d3, (1.0 - NODE_1) * d1 + (1.0 - NODE_2) * d2
    weighted = 0.5 * alpha + (OUTER * outer + INNER * inner)
    most = max(abs(alpha), max(max(abs(alpha + d0), abs(alpha + d1)), max(abs(alpha + d2), abs(alpha + d3))))
    left = tau * tau * REMAINDER * eighth_power(d0 / NODE_0, d1 / NODE_1, d2 / NODE_2, d3 / NODE_3, most)
    u0 = s.start.speed[c]
    exact = left <= RESOLUTION * max(largest(s.q0, 0.0, s.n_q), u0 * tau)
    return u0 + tau * weighted, u0 + tau * mean, exact


def speed_at(s: Mechanism, c: int, tau: float) -> float:
    """The gap velocity that a hop of contact c has at tau after the base."""
    return follow(s, c, tau)[1]


def change_of_curve(s: Mechanism, c: int, tau: float) -> float:
    """By how much the gap acceleration at tau after the base differs from that at the base."""
    return s.contact.curve[c] - s.start.curve[c] if observe(s, tau) else nan


def eighth_power(d0: float, d1: float, d2: float, d3: float, most: float) -> float:
    """Estimate of the coefficient of x^8 in a function of size `most`; d: its change over x, at the nodes.

    Coefficients fall like powers of one ratio, which is the largest that those of x^2, x^3 and x^4 show.
    """
    d01, d12, d23 = (
        (d1 - d0) / (NODE_1 - NODE_0),
        (d2 - d1) / (NODE_2 - NODE_1),
        (d3 - d2) / (NODE_3 - NODE_2),
    )
    d02, d13 = (d12 - d01) / (NODE_2 - NODE_0), (d23 - d12) / (NODE_3 - NODE_1)
    c4 = (d13 - d02) / (NODE_3 - NODE_0)
    c3 = d02 - c4 * (NODE_0 + NODE_1 + NODE_2)
    c2 = d01 - (NODE_0 + NODE_1) * d02 + c4 * (NODE_0 * NODE_1 + NODE_0 * NODE_2 + NODE_1 * NODE_2)
    if most == 0.0:
        return 0.0
    ratio = max(sqrt(abs(c2) / most), max(pow(abs(c3) / most, 1.0 / 3.0), pow(abs(c4) / most, 0.25)))
    return most * pow(ratio, 8.0)


def interrupt(s: Mechanism, c: int, tau: float) -> None:
    """Something happens to contact c at tau: low hops of others that would land later are followed up to there."""
    for d in range(s.n_c):
        if d != c and s.contact.lands[d] > tau and is_low(s, d, tau):
            s.contact.lands[d] = NEVER
    reach_end(s, tau)


def reach_end(s: Mechanism, h: float) -> None:
    """Gaps and speeds of the low hops at the end of the step, into `right`."""
    for c in range(s.n_c):
        if s.contact.lands[c] == NEVER:
            f, u, _ = follow(s, c, h)
            s.right.gap[c], s.right.speed[c] = s.start.gap[c] + f * h, u


def carry(s: Mechanism) -> None:
    """Beyond the end of the step low hops go on from what `reach_end` has found, unless the surface jumps there."""
    for c in range(s.n_c):
        u = s.right.speed[c]
        steady = abs(s.contact.speed[c] - u) <= STEADY * speed_noise(s, c) / NOISE
        if s.contact.lands[c] == NEVER and s.right.gap[c] > 0.0 and steady:
            s.contact.gap[c], s.contact.speed[c], s.contact.carried[c] = s.right.gap[c], u, 1
