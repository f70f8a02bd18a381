"""Events on a polynomial piece of motion, as kernels: the first gap that closes, the first contact that opens.

The piece is divided into intervals in which each gap velocity changes its sign at most once; so a gap that falls to
zero and returns within an interval is found at its lowest point; what is there but rounding is a touch. A gap that is
small beside what it is made of, as in a hop that began on the surface, is followed by the mean of its velocity,
g = g_0 + tau mean, which keeps all digits.
"""

from __future__ import annotations

from math import isfinite

import cython

from lcpstep.kernels.dynamics import moves
from lcpstep.kernels.model import Model
from lcpstep.kernels.quadrature import NODES_4, WEIGHTS_4
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.vectors import copy, size_of_product
from lcpstep.pointers import abs, after, inf, max, min
from lcpstep.stepping.pieces.codes import CLOSED, LEFT, NOBODY, OPEN
from lcpstep.stepping.pieces.contact_forces import pulls
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, speed_terms
from lcpstep.stepping.pieces.polynomial import PROBES, Polynomial, contacts_at, force_at
from lcpstep.stepping.pieces.state import Plan, Work

NOWHERE = -2
PARTS = 4  # intervals of a piece
FALLS = 3.0  # of a force: by how much it is larger beside a turn; a parabola five times
WIDER = 16.0  # each time: how far on a force is looked at that may pull for but a moment
SOON = 1e-3  # of a piece: what has been decided at its base is not decided again before
LOW = 1e9  # times the slack: rounding of positions is much of gaps below it
BRIEF = 1.0 / 32.0  # of the longest piece: the mean velocity of so short a time is exact to rounding


def gap_at(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, c: int) -> tuple[float, float]:
    """One gap and its velocity."""
    contacts_at(m, plan, w, z, tau, w.gap_try, z.velocity_now)
    return w.gap_try[c], z.velocity_now[c]


def hop_at(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, c: int) -> tuple[float, float]:
    """A low gap at tau after the base of the piece, over tau, and its slope."""
    mean, base = 0.0, max(w.gap[c], 0.0) / tau
    for k in range(4):
        _, u = gap_at(m, plan, w, z, NODES_4[k] * tau, c)
        mean += WEIGHTS_4[k] * u
    _, u = gap_at(m, plan, w, z, tau, c)
    return base + mean, (u - mean - base) / tau


def is_low(plan: Plan, w: Work, tau: float, c: int) -> bool:
    """Whether rounding of positions is much of a gap up to tau after the base, and not of its mean velocity."""
    if not plan.exact or tau > BRIEF * plan.longest:
        return False
    return max(w.gap[c], abs(w.velocity[c]) * tau) <= LOW * plan.slack


def height_terms(m: Model, w: Work, z: Polynomial, c: int) -> float:
    """What a flat gap is made of in the state last asked for, signs left aside; 0 of a curved one."""
    if not m.flat:
        return 0.0
    size = abs(m.offset[c]) + (abs(m.motion_now[3 * c]) if moves(m) else 0.0)
    return size + size_of_product(m.G, z.q, c, w.n_q)


def landing(m: Model, plan: Plan, w: Work, z: Polynomial, a: float, b: float, c: int, low: bool) -> float:
    """Where gap c, which may stay low, falls to zero in (a, b]: positive at a, or on its way up, and not at b."""
    guess = b
    if low and w.gap[c] <= 0.0 and w.half[c] < 0.0:
        guess = min(b, -w.velocity[c] / w.half[c])
    w.bracket.begin(a, b, True, guess)
    while w.bracket.seek(2.0 * RESOLUTION * w.bracket.x):
        if low:
            f, slope = hop_at(m, plan, w, z, w.bracket.x, c)
        else:
            f, slope = gap_at(m, plan, w, z, w.bracket.x, c)
        w.bracket.newton(f, slope)
    return w.bracket.x


def lowest(m: Model, plan: Plan, w: Work, z: Polynomial, a: float, b: float, c: int) -> float:
    """Where the velocity of gap c passes zero upwards in (a, b)."""
    w.bracket.span(a, z.velocity_from[c], b, z.velocity_to[c])
    while w.bracket.seek(4.0 * RESOLUTION * w.bracket.b):
        _g, f = gap_at(m, plan, w, z, w.bracket.x, c)
        w.bracket.chord(f)
    return w.bracket.x


def first_landing(m: Model, plan: Plan, w: Work, z: Polynomial, end: float) -> tuple[int, float]:
    """Which gap closes first in (0, end], and when; NOBODY and the end if none does, NOWHERE if one is not finite."""
    n_c, found, first = w.n_c, closing_now(w), end
    if found != NOBODY or end == 0.0:
        return found, 0.0
    copy(z.gap_from, w.gap, n_c)
    copy(z.velocity_from, w.velocity, n_c)
    a = 0.0
    for part in range(1, PARTS + 1):
        b = end * part / PARTS
        contacts_at(m, plan, w, z, b, z.gap_to, z.velocity_to)
        for c in range(n_c):
            if not isfinite(z.gap_to[c]):
                return NOWHERE, b
            tau = landing_within(m, plan, w, z, a, b, end, c) if w.status[c] == OPEN else inf
            if tau < first or (found == NOBODY and tau < inf):
                found, first = c, tau
        if found != NOBODY:
            return found, first
        copy(z.gap_from, z.gap_to, n_c)
        copy(z.velocity_from, z.velocity_to, n_c)
        a = b
    return NOBODY, end


def closing_now(w: Work) -> int:
    """Of the open gaps that are zero and close, the fastest; NOBODY if none does."""
    found = NOBODY
    for c in range(w.n_c):
        touches = w.status[c] == OPEN and w.gap[c] <= 0.0 and w.velocity[c] < 0.0
        if touches and (found == NOBODY or w.velocity[c] < w.velocity[found]):
            found = c
    return found


def landing_within(
    m: Model, plan: Plan, w: Work, z: Polynomial, a: float, b: float, end: float, c: int
) -> float:
    """When the open gap c falls to zero in the interval (a, b] of (0, end]; infinite if it does not."""
    hop = w.gap[c] <= 0.0 and z.gap_from[c] <= plan.slack
    fine = hop or is_low(plan, w, b, c)
    if fine and z.gap_to[c] <= plan.slack:  # finer than positions tell
        mean, _ = hop_at(m, plan, w, z, b, c)
        z.gap_to[c] = b * mean
        if hop and w.grounded[c] == LEFT and abs(mean) <= NOISE * speed_terms(plan, w, c):
            return inf  # what has been let go a moment ago
    low = b
    if z.gap_to[c] > 0.0:
        if hop or not (z.velocity_from[c] < 0.0 < z.velocity_to[c]):
            return inf
        low = lowest(m, plan, w, z, a, b, c)
        g, _ = gap_at(m, plan, w, z, low, c)
        if g > 0.0:
            return inf
        if g >= -RESOLUTION * height_terms(m, w, z, c):  # a touch
            return low
    start = max(a, SOON * end) if w.grounded[c] == LEFT else a
    if hop and start == 0.0 and w.velocity[c] <= 0.0:
        return 0.0
    return landing(m, plan, w, z, start, low, c, fine)


def first_release(m: Model, plan: Plan, w: Work, z: Polynomial, end: float) -> tuple[int, float]:
    """Which closed contact loses its force first in (0, end], and when; NOBODY and the end if none does.

    It may do so for a moment between two probes; whether one has to be looked for tells the probe beyond them.
    """
    if w.closed_now == 0:
        return NOBODY, end
    n_c, found, first = w.n_c, NOBODY, end
    copy(z.pressed, w.force_now, n_c)
    for probe in range(1, PROBES + 1):
        force_at(m, plan, w, z, end * probe / PROBES)
        copy(after(z.pressed, probe * n_c), w.p, n_c)
        found, first = brief_release(m, plan, w, z, end, probe - 1, probe)
        if found == NOBODY:
            found, first = release_at(m, plan, w, z, end, probe)
        if found != NOBODY:
            return found, first
    return brief_release(m, plan, w, z, end, PROBES, PROBES)


def release_at(m: Model, plan: Plan, w: Work, z: Polynomial, end: float, probe: int) -> tuple[int, float]:
    """Which contact that pulls at a probe has lost its force first since the one before, and when."""
    n_c, found, first = w.n_c, NOBODY, end
    forces, a, b = after(z.pressed, probe * n_c), from_probe(w, end, probe), end * probe / PROBES
    copy(w.p, forces, n_c)
    for c in range(n_c):
        if w.status[c] == CLOSED and forces[c] < 0.0 and pulls(m, plan, w, c, z.t):
            tau = vanishing(m, plan, w, z, a, b, forces[c], c)
            copy(w.p, forces, n_c)  # forces were asked for at other times
            if tau < first or found == NOBODY:
                found, first = c, tau
    return found, first


def brief_release(
    m: Model, plan: Plan, w: Work, z: Polynomial, end: float, probe: int, last: int
) -> tuple[int, float]:
    """Which contact presses at a probe and the one before, and pulls in between, and when; `last` is known too."""
    n_c, found, first, h, before = w.n_c, NOBODY, end, 0.5 * end / PROBES, probe - 2 if probe > 1 else 0
    for c in range(n_c if probe > 0 else 0):
        left, right = z.pressed[(probe - 1) * n_c + c], z.pressed[probe * n_c + c]
        most = max(max(left, right), max(z.pressed[before * n_c + c], z.pressed[last * n_c + c]))
        if w.status[c] != CLOSED or most <= FALLS * max(min(left, right), 0.0):
            continue
        if not w.W[c * w.n_c + c] * most > NOISE * acceleration_terms(
            m, w, c
        ):  # rounding of what they balance
            continue
        x = (2 * probe - 1) * h
        force_at(m, plan, w, z, x)
        z.turn.begin(x, h, left, w.p[c], right)
        while not (w.p[c] < 0.0 and pulls(m, plan, w, c, z.t)) and z.turn.seek():
            x = z.turn.x
            force_at(m, plan, w, z, x)
            z.turn.take(w.p[c])
        if w.p[c] < 0.0 and pulls(m, plan, w, c, z.t):
            force = w.p[c]
            tau = vanishing(m, plan, w, z, from_probe(w, end, probe), x, force, c)
            if (tau < first or found == NOBODY) and rises(m, plan, w, z, tau, x, end, force, c):
                found, first = c, tau
    return found, first


def rises(
    m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, x: float, end: float, force: float, c: int
) -> bool:
    """Whether contact c, whose force vanishes at tau and pulls at x, is let go by more than rounding of its gap.

    A force that touches zero pulls for a moment by the error of the polynomial. Until it presses again a parabola is
    deeper than what is seen of it by a quarter of `WIDER` at most. Forces later than x are left in w.p.
    """
    span, lowest = x - tau, force
    w.p[c] = force
    while w.p[c] <= 0.0:
        span *= WIDER
        if tau + span >= end or -0.125 * WIDER * w.W[c * w.n_c + c] * lowest * span * span > plan.slack:
            return True
        force_at(m, plan, w, z, tau + span)
        lowest = min(lowest, w.p[c])
    return False


def from_probe(w: Work, end: float, probe: int) -> float:
    """Where the part before a probe begins; forces are known from `ahead` on."""
    return w.ahead if probe == 1 else end * (probe - 1) / PROBES


def vanishing(m: Model, plan: Plan, w: Work, z: Polynomial, a: float, b: float, f_b: float, c: int) -> float:
    """Where the force of contact c, which is f_b at b, vanishes in (a, b]."""
    force_at(m, plan, w, z, a)
    if w.p[c] <= 0.0:
        return a
    w.bracket.span(a, w.p[c], b, f_b)
    while w.bracket.seek(4.0 * RESOLUTION * (z.t + w.bracket.b)):
        force_at(m, plan, w, z, w.bracket.x)
        w.bracket.chord(w.p[c])
    return w.bracket.x
