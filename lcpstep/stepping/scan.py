"""Events on a polynomial piece of motion, as kernels: the first gap that closes, the first contact that opens.

The piece is divided into intervals in which each gap velocity changes its sign at most once; so a gap that falls to
zero and returns within an interval is found at its lowest point. Roots are bracketed before they are polished. A
hop that began on the surface is followed by the mean of its gap velocity, g / tau, which keeps all digits.
Source: W. Press et al., Numerical Recipes, sections 9.2 and 9.4.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.stepping.contact_forces import pulls
from lcpstep.stepping.located_work import (
    AHEAD,
    CLOSED,
    CLOSED_NOW,
    EPS,
    GAP,
    GAP_FROM,
    GAP_TO,
    GAP_TRY,
    GROUNDED,
    HALF,
    LEFT,
    OPEN,
    RATE,
    RATE_FROM,
    RATE_NOW,
    RATE_TO,
    STATUS,
    P,
)
from lcpstep.stepping.polynomial import NODES, contacts_at, force_at

NOBODY, NOWHERE = -1, -2
PARTS = 4  # intervals of a piece
PROBES = 4  # of contact forces
SOON = 1e-3  # of a piece: what has been decided at its base is not decided again before
ITERATIONS = 60


def gap_at(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, tau: float, c: int) -> tuple[float, float]:
    """One gap and its velocity."""
    contacts_at(m, plan, w, x, z, t, tau, w.num[GAP_TRY], z.num[RATE_NOW])
    return w.num[GAP_TRY, c], z.num[RATE_NOW, c]


@inline
def hop_at(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, tau: float, c: int) -> tuple[float, float]:
    """Mean of a gap velocity over (0, tau), and its slope."""
    mean = 0.0
    for node, weight in NODES:
        _, u = gap_at(m, plan, w, x, z, t, node * tau, c)
        mean += weight * u
    _, u = gap_at(m, plan, w, x, z, t, tau, c)
    return mean, (u - mean) / tau


def landing(
    m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, a: float, b: float, c: int, hop: bool
) -> float:
    """Where gap c falls to zero in (a, b]: positive at a, or on its way up, and not positive at b."""
    tau = b
    if hop and w.num[HALF, c] < 0.0:
        tau = min(b, -w.num[RATE, c] / w.num[HALF, c])
    for _ in range(ITERATIONS):
        if hop:
            f, slope = hop_at(m, plan, w, x, z, t, tau, c)
        else:
            f, slope = gap_at(m, plan, w, x, z, t, tau, c)
        if f > 0.0:
            a = tau
        else:
            b = tau
        new = tau - f / slope if slope < 0.0 else a
        if not a < new < b:
            new = 0.5 * (a + b)
        if abs(new - tau) <= 2.0 * EPS * tau or b - a <= EPS * b:
            return min(max(new, a), b)
        tau = new
    return tau


def lowest(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, a: float, b: float, c: int) -> float:
    """Where the velocity of gap c passes zero upwards in (a, b): regula falsi after Illinois."""
    f_a, f_b, side, tau = z.num[RATE_FROM, c], z.num[RATE_TO, c], 0, a
    for _ in range(ITERATIONS):
        tau = (a * f_b - b * f_a) / (f_b - f_a)
        if not a < tau < b:
            tau = 0.5 * (a + b)
        _, f = gap_at(m, plan, w, x, z, t, tau, c)
        if f == 0.0 or b - a <= 4.0 * EPS * b:
            break
        if f < 0.0:
            a, f_a = tau, f
            f_b = 0.5 * f_b if side < 0 else f_b
            side = -1
        else:
            b, f_b = tau, f
            f_a = 0.5 * f_a if side > 0 else f_a
            side = 1
    return tau


@inline
def first_landing(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, end: float) -> tuple[int, float]:
    """Which gap closes first in (0, end], and when; NOBODY and the end if none does, NOWHERE if one is not finite."""
    n_c, found, first = w.num.shape[1], NOBODY, end
    for c in range(n_c):
        if w.mark[STATUS, c] == OPEN and w.num[GAP, c] <= 0.0 and w.num[RATE, c] < 0.0:
            return c, 0.0
    assign(z.num[GAP_FROM], w.num[GAP])
    assign(z.num[RATE_FROM], w.num[RATE])
    a = 0.0
    for part in range(1, PARTS + 1):
        b = end * part / PARTS
        contacts_at(m, plan, w, x, z, t, b, z.num[GAP_TO], z.num[RATE_TO])
        for c in range(n_c):
            if not math.isfinite(z.num[GAP_TO, c]):
                return NOWHERE, b
            if w.mark[STATUS, c] != OPEN:
                continue
            hop = w.num[GAP, c] <= 0.0 and z.num[GAP_FROM, c] <= plan.slack
            if hop and z.num[GAP_TO, c] <= plan.slack:  # finer than positions tell
                mean, _ = hop_at(m, plan, w, x, z, t, b, c)
                z.num[GAP_TO, c] = b * mean
            low = b
            if z.num[GAP_TO, c] > 0.0:
                if hop or not (z.num[RATE_FROM, c] < 0.0 < z.num[RATE_TO, c]):
                    continue
                low = lowest(m, plan, w, x, z, t, a, b, c)
                g, _ = gap_at(m, plan, w, x, z, t, low, c)
                if g > 0.0:
                    continue
            start = max(a, SOON * end) if w.mark[GROUNDED, c] == LEFT else a
            rests = hop and start == 0.0 and w.num[RATE, c] <= 0.0
            tau = 0.0 if rests else landing(m, plan, w, x, z, t, start, low, c, hop)
            if tau < first or found == NOBODY:
                found, first = c, tau
        if found != NOBODY:
            return found, first
        assign(z.num[GAP_FROM], z.num[GAP_TO])
        assign(z.num[RATE_FROM], z.num[RATE_TO])
        a = b
    return NOBODY, end


@inline
def first_release(
    m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, end: float, count: Any
) -> tuple[int, float]:
    """Which closed contact loses its force first in (0, end], and when; NOBODY and the end if none does."""
    if x[CLOSED_NOW] == 0:
        return NOBODY, end
    a, found, first = x[AHEAD], NOBODY, end
    for probe in range(1, PROBES + 1):
        b = end * probe / PROBES
        force_at(m, plan, w, x, z, t, b, count)
        assign(z.num[RATE_TO], w.num[P])
        for c in range(w.num.shape[1]):
            if w.mark[STATUS, c] == CLOSED and z.num[RATE_TO, c] < 0.0 and pulls(m, w, c):
                tau = vanishing(m, plan, w, x, z, t, a, b, c, count)
                if tau < first or found == NOBODY:
                    found, first = c, tau
        if found != NOBODY:
            return found, first
        a = b
    return NOBODY, end


def vanishing(
    m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, a: float, b: float, c: int, count: Any
) -> float:
    """Where the force of contact c vanishes in (a, b]: regula falsi after Illinois."""
    force_at(m, plan, w, x, z, t, a, count)
    f_a, f_b, side, tau = w.num[P, c], z.num[RATE_TO, c], 0, b
    if f_a <= 0.0:
        return a
    for _ in range(ITERATIONS):
        tau = (a * f_b - b * f_a) / (f_b - f_a)
        if not a < tau < b:
            tau = 0.5 * (a + b)
        force_at(m, plan, w, x, z, t, tau, count)
        f = w.num[P, c]
        if f == 0.0 or b - a <= 4.0 * EPS * (t + b):
            break
        if f > 0.0:
            a, f_a = tau, f
            f_b = 0.5 * f_b if side > 0 else f_b
            side = 1
        else:
            b, f_b = tau, f
            f_a = 0.5 * f_a if side < 0 else f_a
            side = -1
    return tau
