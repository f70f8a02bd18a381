"""The part of the gaps' accelerations that does not depend on v': their bias.

    u' = G v' + bias,    bias = (dG/dt) v + d(g_t)/dt along the motion

Where a scene does not give it, by differences of order four of its rates along the straight line that v leads along.
"""

from __future__ import annotations

from math import pow, sqrt

import cython

from lcpstep.kernels.dynamics import gap_rates, moves, obstacle
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import clear, product, product_and_size
from lcpstep.pointers import Doubles, abs, inf, max, min

# Fourth-order differences that stand in for a missing bias: the longest way they take; the third difference, relative
# to the terms of the rate, that they may show, and what a shorter step aims at; how often it is shortened, and beyond
# what a gap has turned so much that nothing is seen of it
DIFFERENCE = 1e-3
REACH = 2.125  # of these steps: what differences keep from the ends of a smooth interval, where rates jump
FAR = 1e4  # steps from t = 0: times are rounded by more than values are
BENT, SMOOTH, SHORTENINGS, LOST = 1e-8, 1e-9, 5, 1e-2


def bias(
    m: Model, t: float, low: float, high: float, q: Doubles, v: Doubles,
    shifted: Doubles, G: Doubles, rate: Doubles, out: Doubles,
) -> None:  # fmt: skip
    """(dG/dt) v + d(g_t)/dt along the motion; by differences of order four where the scene does not give it.

    low, high : the smooth interval that t lies in, which differences keep to; any where high <= low
    shifted, G, rate : (n_q,), (n_c, n_q), (n_c,)   work space
    """
    for c in range(m.n_c):
        out[c] = 0.0
    if m.flat:
        if moves(m):
            obstacle(m, t, q, v)
            for c in range(m.n_c):
                out[c] = -m.motion_now[3 * c + 2]
        return
    if m.bias.given:
        m.bias.fill(t, q, v, out)
        return
    if high <= low:
        low, high = -inf, inf
    d = difference_step(m, t, low, high, q, v, shifted, G, rate, out)
    beside = middle(t, low, high, d)
    if beside == 0.0 and not m.gap_t.given and bend(m, out) > BENT:  # jumps in time are ends of intervals
        beside = smooth_side(m, t, low, high, q, v, shifted, G, rate, out, d)
    if beside != 0.0:
        slope_beside(m, t, beside, q, v, shifted, G, rate, d, out)
        return
    for c in range(m.n_c):
        out[c] = (8.0 * m.motion_now[3 * c] - m.motion_now[3 * c + 1]) / (12.0 * d)


def difference_step(
    m: Model, t: float, low: float, high: float, q: Doubles, v: Doubles,
    shifted: Doubles, G: Doubles, rate: Doubles, even: Doubles,
) -> float:  # fmt: skip
    """A step short enough for the differences of the gaps' rates along the motion; it leaves these in `motion_now`.

    Gaps may bend at any scale. A third difference too large, or a value at t too far off, asks for a shorter step, in
    proportion to its third root, unless the last one has shown that this does not help: the curvature jumps nearby.
    Where it does not fall at all steps may have been too long to see anything of the gap: shorter ones count if they
    find it smooth; else it is noise of the callbacks.
    They see nothing of what is narrower than they are apart, but where its ends are those of the interval.
    """
    speed = 1.0
    for i in range(m.n_q):
        speed = max(speed, abs(v[i]))
    d, before, shorter, longer = min(DIFFERENCE / speed, (high - low) / (2.0 * REACH)), inf, 1.0, 1.0
    in_noise = 0.0  # the first step that does not help
    for _ in range(SHORTENINGS):
        d = kept_by_clock(t, d)
        bent = differences(m, t, middle(t, low, high, d), q, v, shifted, G, rate, even, d)
        if not bent > BENT:
            return d
        if not bent > LOST and bent > before * shorter:
            falls = bent < before * longer
            if falls and in_noise == 0.0:
                return d
            in_noise = d if in_noise == 0.0 else in_noise
            if falls:
                break
        change = max(pow(SMOOTH / bent, 1.0 / 3.0), DIFFERENCE)
        before, shorter, longer = inf if bent > LOST else bent, change * sqrt(change), sqrt(change)
        d *= change
    d = kept_by_clock(t, d) if in_noise == 0.0 else in_noise
    differences(m, t, middle(t, low, high, d), q, v, shifted, G, rate, even, d)
    return d


def kept_by_clock(t: float, d: float) -> float:
    """The step by which t + d differs from t: far from t = 0 what times are rounded by is much of a short one."""
    exact = (t + d) - t
    return exact if abs(t) > FAR * d and exact > 0.0 else d


def middle(t: float, low: float, high: float, d: float) -> float:
    """How far after t differences of step d are taken so that they keep to the interval, in steps."""
    return min(max(0.0, REACH - (t - low) / d), (high - t) / d - REACH)


def smooth_side(
    m: Model, t: float, low: float, high: float, q: Doubles, v: Doubles,
    shifted: Doubles, G: Doubles, rate: Doubles, even: Doubles, d: float,
) -> float:  # fmt: skip
    """On which side of t, in steps, rates are smooth where their slope jumps nearby: not beyond the jump; 0 for none.

    A rate that bends just beside t is all but smooth on the wrong side of it too, but for how far it is from there.
    """
    least, side = min(BENT, bend(m, even) * SMOOTH / BENT), 0.0
    for k in range(2):
        beside = 4.0 * k - 2.0
        if low <= t + (beside - REACH) * d and t + (beside + REACH) * d <= high:
            bent = differences(m, t, beside, q, v, shifted, G, rate, even, d)
            if bent < least:
                least, side = bent, beside
    if side == 0.0:
        differences(m, t, side, q, v, shifted, G, rate, even, d)
    return side


def differences(
    m: Model, t: float, beside: float, q: Doubles, v: Doubles,
    shifted: Doubles, G: Doubles, rate: Doubles, even: Doubles, d: float,
) -> float:  # fmt: skip
    """Differences of G v + g_t between -d and d, and -2 d and 2 d, into `motion_now`; what of it bends, relative.

    beside : by how many steps d after t zero lies
    even : (n_c,)   how far the value at t is from what the others lead to: a slope that jumps at zero shows in no
        difference of theirs, nor one that jumps between them and t
    Contacts whose gap is a function have no obstacle that moves, and its place is free.
    """
    now = m.motion_now
    for c in range(m.n_c):
        now[3 * c] = now[3 * c + 1] = now[3 * c + 2] = even[c] = 0.0
    for k in range(5):
        sign = 1.0 if k % 2 == 0 else -1.0
        place = sign * (1.0 + k // 2) if k < 4 else -beside
        weight = -value_share(place, -beside) if k < 4 else 1.0
        rates_ahead(m, t, d * (beside + place), q, v, shifted, G, rate)
        for c in range(m.n_c):
            u, size = product_and_size(G, v, c, m.n_q)
            u += rate[c]
            now[3 * c + 2] = max(now[3 * c + 2], abs(rate[c]) + size)
            even[c] = even[c] + weight * u
            if k < 4:
                now[3 * c + k // 2] += u * sign
    return bend(m, even)


def value_share(k: float, x: float) -> float:
    """Value at x of the cubic that is one at k and zero at the others of -2, -1, 1, 2."""
    if k * k == 1.0:
        return -(x * x - 4.0) * (x + k) * k / 6.0
    return (x * x - 1.0) * (x + k) * k / 24.0


def bend(m: Model, even: Doubles) -> float:
    """The third one of the differences in `motion_now`, or how far off the value at t is, relative."""
    now, bent = m.motion_now, 0.0
    for c in range(m.n_c):
        if now[3 * c + 2] > 0.0:
            odd = abs(now[3 * c + 1] - 2.0 * now[3 * c])
            bent = max(bent, max(odd, abs(even[c])) / now[3 * c + 2])
    return bent


def slope_beside(
    m: Model, t: float, beside: float, q: Doubles, v: Doubles,
    shifted: Doubles, G: Doubles, rate: Doubles, d: float, out: Doubles,
) -> None:  # fmt: skip
    """The slope at t of the quartic through five values of G v + g_t, d apart, the middle one `beside` d after t."""
    clear(out, m.n_c)
    for k in range(-2, 3):
        rates_ahead(m, t, d * (beside + k), q, v, shifted, G, rate)
        for c in range(m.n_c):
            out[c] += slope_share(k, -beside) / d * (product(G, v, c, m.n_q) + rate[c])


def slope_share(k: int, x: float) -> float:
    """Slope at x of the quartic that is one at k and zero at the others of -2 .. 2: how much its value counts."""
    if k == 0:
        return x * x * x - 2.5 * x
    if k * k == 1:
        return (-4.0 * x * x * x - 3.0 * k * x * x + 8.0 * x + 4.0 * k) / 6.0
    return (4.0 * x * x * x + 3.0 * k * x * x - 2.0 * x - k) / 24.0


def rates_ahead(
    m: Model, t: float, shift: float, q: Doubles, v: Doubles, shifted: Doubles, G: Doubles, rate: Doubles
) -> None:
    """G and g_t so much later, on the straight line that v leads along."""
    for i in range(m.n_q):
        shifted[i] = q[i] + shift * v[i]
    gap_rates(m, t + shift, shifted, v, G, rate)
