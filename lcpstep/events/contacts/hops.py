"""Short hops of contacts, as kernels: followed by the gap acceleration, not by the gap.

    g = g0 + u0 tau + tau^2 int_0^1 (1 - x) alpha(x tau) dx,      u = u0 + tau int_0^1 alpha(x tau) dx

A hop as low as the rounding of positions is lost in their difference, and with it the end of a chattering sequence,
which is where the hops before put it. So the landing of a hop that a blow has begun on the surface is sought in the
integrals; a low one that crosses a corner goes on beyond it from the gap that they give there. So does one hardly
higher than that rounding beyond the end of a step, or what happens to another contact: from a gap that rounding has
made larger an elastic one would gain energy, hop by hop, and never come to rest.
"""

from __future__ import annotations

from math import pow, sqrt

import cython

from lcpstep.events.codes import LOW, OPEN
from lcpstep.events.contacts.held import know_biases, know_rows
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.hybrid.roots import NONE
from lcpstep.events.rows.contacts import gap_tolerance, speed_tolerance
from lcpstep.events.rows.equations import acceleration_of, list_gaps, size_of, velocity_of
from lcpstep.kernels.quadratic import first_zero, highest
from lcpstep.kernels.quadrature import NODES_4, WEIGHTS_4
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import largest
from lcpstep.pointers import abs, after, inf, max, min, nan

# In place of a landing: there is none within the step; it is NONE where the gap itself is to be looked at
NEVER = -2.0

# What the quadrature leaves of the first power that it does not integrate, x^8: (4!)^4 / (9 (8!)^2)
REMAINDER = 331776.0 / (9.0 * 1625702400.0)
LONGER = 3.0  # how much longer than under constant acceleration a hop may last
SHORT = 0.02  # of the scan interval: what the quadrature of a hop resolves to rounding
FAINT = 1e-12  # as LOW, where no corner is: of lower ones it tells no more than four digits
UNLIKE = 1e-6  # of the way that its speed at first would take a gap: one so far open has not landed
STEADY = 1e-7  # of its terms: a gap velocity that changes by more at a corner does not do so by errors of integration


def begin_hops(s: Rubbing) -> None:
    """Note the hops that begin at the base, just measured, whose accelerations are in `dy`; and those under way.

    What rises from where it cannot be told from its surface begins one, too: rounding would hide its landing.
    """
    s.hopping = False
    for c in range(s.n_c):
        i = s.n_j + c
        carried = s.carried[c] == 1 and s.mode[c] == OPEN
        u = velocity_of(s.rows, i, s.v)
        low = s.touches[c] == 1 or s.gap[i] <= s.rows.rounding_of_gap(c)
        begins = s.mode[c] == OPEN and low and u > s.terms[c]
        s.height[c] = s.height[c] if carried else 0.0
        s.rise[c], s.bend[c] = u, acceleration_of(s.rows, i, after(s.dy, s.n_q))
        s.hops[c], s.lands[c], s.carried[c] = 1 if carried or begins else 0, NONE, 1 if carried else 0
        s.hopping = s.hopping or s.hops[c] == 1


def landing(s: Rubbing, c: int, h: float) -> float:
    """When contact c lands within the step, NEVER if it does not, or NONE if the gap itself is to be looked at."""
    guess = hop_time(s, c)
    low = guess < inf and is_low(s, c, h)
    if not low and not guess < h:
        return NONE
    tau = hop_end(s, c, guess, min(LONGER * guess, h))
    if low:
        return NEVER if tau == NONE else tau
    return tau if tau == NONE or ends_so(s, c, tau) else NONE


def shortest_hop(s: Rubbing) -> float:
    """Duration of the shortest hop that has just begun, were its acceleration constant."""
    shortest = inf
    if s.hopping:
        for c in range(s.n_c):
            shortest = min(shortest, hop_time(s, c))
    return shortest


def hop_time(s: Rubbing, c: int) -> float:
    """Duration of the hop of contact c that begins at the base, were alpha constant; infinite if none does."""
    if s.hops[c] == 0 or not s.bend[c] < 0.0:
        return inf
    return first_zero(s.height[c], s.rise[c], 0.5 * s.bend[c])


def is_low(s: Rubbing, c: int, h: float) -> bool:
    """Whether a hop that is pressed stays low up to the end of the step of size h, at a corner or not."""
    if h > SHORT * s.scan_length:
        return False
    low = LOW if h >= s.rows.high - s.rows.t0 else FAINT
    return highest(s.height[c], s.rise[c], s.bend[c], h) <= low * largest(s.q, 0.0, s.n_q)


def hop_end(s: Rubbing, c: int, guess: float, longest: float) -> float:
    """End of a hop that begins with a gap g0 >= 0 at the base, or NONE if it is longer than `longest`: g / tau = 0.

    NONE as well where g0 is zero and the acceleration changes too much for the quadrature: such hops are seen in the
    gap itself.
    """
    g0 = s.height[c]
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


def ends_so(s: Rubbing, c: int, tau: float) -> bool:
    """Whether the gap itself is closed where its hop lands.

    It is another one where the obstacle has an edge or a valley, at which the gap velocity jumps.
    """
    s.at(tau / s.length, s.seen)
    list_gaps(s.rows, s.rows.t0 + tau, s.seen, s.gap)
    strayed = s.rows.untold(s.length) * abs(s.rate[s.n_j + c])
    errors = max(s.rows.rounding_of_gap(c) + strayed, gap_tolerance(s.rows, c))
    return abs(s.gap[s.n_j + c]) <= UNLIKE * tau * abs(s.rise[c]) + errors


def follow(s: Rubbing, c: int, tau: float) -> tuple[float, float, bool]:
    """(g - g0) / tau and u at tau after the base, and whether they are as good as rounding leaves the gap itself.

    The integrals are of alpha less its value at the base, so that equal hops under constant acceleration stay equal
    to the last digit.
    """
    alpha, outer, inner = s.bend[c], WEIGHTS_4[0], WEIGHTS_4[1]
    x0, x1, x2, x3 = NODES_4[0], NODES_4[1], NODES_4[2], NODES_4[3]
    d0, d1 = change_of_bend(s, c, x0 * tau), change_of_bend(s, c, x1 * tau)
    d2, d3 = change_of_bend(s, c, x2 * tau), change_of_bend(s, c, x3 * tau)
    mean = alpha + (outer * (d0 + d3) + inner * (d1 + d2))
    late_outer, late_inner = (1.0 - x0) * d0 + (1.0 - x3) * d3, (1.0 - x1) * d1 + (1.0 - x2) * d2
    weighted = 0.5 * alpha + (outer * late_outer + inner * late_inner)
    most = max(abs(alpha), max(max(abs(alpha + d0), abs(alpha + d1)), max(abs(alpha + d2), abs(alpha + d3))))
    left = tau * tau * REMAINDER * eighth_power(d0 / x0, d1 / x1, d2 / x2, d3 / x3, most)
    u0 = s.rise[c]
    exact = left <= RESOLUTION * max(largest(s.q, 0.0, s.n_q), u0 * tau)
    return u0 + tau * weighted, u0 + tau * mean, exact


def change_of_bend(s: Rubbing, c: int, tau: float) -> float:
    """By how much the gap acceleration at tau after the base differs from that at the base."""
    i, t = s.n_j + c, s.rows.t0 + tau
    s.at(tau / s.length, s.seen)
    if not know_rows(s, t):
        return nan
    return acceleration_of(s.rows, i, after(s.dy, s.n_q)) - s.bend[c]


def eighth_power(d0: float, d1: float, d2: float, d3: float, most: float) -> float:
    """Estimate of the coefficient of x^8 in a function of size `most`; d: its change over x, at the nodes.

    Coefficients fall like powers of one ratio, which is the largest that those of x^2, x^3 and x^4 show.
    """
    x0, x1, x2, x3 = NODES_4[0], NODES_4[1], NODES_4[2], NODES_4[3]
    d01, d12, d23 = (d1 - d0) / (x1 - x0), (d2 - d1) / (x2 - x1), (d3 - d2) / (x3 - x2)
    d02, d13 = (d12 - d01) / (x2 - x0), (d23 - d12) / (x3 - x1)
    c4 = (d13 - d02) / (x3 - x0)
    c3 = d02 - c4 * (x0 + x1 + x2)
    c2 = d01 - (x0 + x1) * d02 + c4 * (x0 * x1 + x0 * x2 + x1 * x2)
    if most == 0.0:
        return 0.0
    ratio = max(sqrt(abs(c2) / most), max(pow(abs(c3) / most, 1.0 / 3.0), pow(abs(c4) / most, 0.25)))
    return most * pow(ratio, 8.0)


def first_landing(s: Rubbing) -> int:
    """The contact whose hop lands first within the step, or -1."""
    first = -1
    if s.hopping:
        for c in range(s.n_c):
            if s.lands[c] >= 0.0 and (first < 0 or s.lands[c] < s.lands[first]):
                first = c
    return first


def interrupt(s: Rubbing, g: int, tau: float) -> None:
    """The motion ends at tau, by the event of contact g, if any: low hops of others are followed up to there."""
    if not s.hopping:
        return
    for c in range(s.n_c):
        s.carried[c] = 0
        rises = s.hops[c] == 1 and s.bend[c] >= 0.0
        if s.lands[c] == NEVER or (c != g and (rises or s.lands[c] > tau) and is_low(s, c, tau)):
            f, s.speed[c], _ = follow(s, c, tau)
            s.height[c] += f * tau
            s.carried[c] = 1 if s.height[c] > 0.0 else 0


def carry(s: Rubbing) -> None:
    """Beyond the end of a step without an event low hops go on, unless the surface jumps there; `dy` is known."""
    know_biases(s, s.rows.t0, s.y)
    for c in range(s.n_c):
        i = s.n_j + c
        u = velocity_of(s.rows, i, s.v)
        errors = STEADY * size_of(s.rows, i, s.rate[i], s.v) + speed_tolerance(s.rows, i)
        if s.carried[c] == 1 and abs(u - s.speed[c]) > errors:
            s.carried[c] = 0
    begin_hops(s)
