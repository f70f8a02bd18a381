"""Closed-form motion of one linear degree of freedom under a constant and a harmonic force.

    y'' + 2 delta y' + w2 y = f0 + X-, Y-forcing at the frequency Omega

splits into the steady oscillation X cos(Omega t) + Y sin(Omega t) and a remainder that is carried by

    S'' + 2 delta S' + w2 S = 0,  S(0) = 0, S'(0) = 1;      P = integral of S
    z(tau) = z0 (S' + 2 delta S) + z0' S + f0 P

for every damping, and for w2 = 0 (a free particle), without loss of digits at small tau. Source: any text on
linear vibrations, e.g. L. Meirovitch, Fundamentals of Vibrations, chapters 2 and 3.
"""

from __future__ import annotations

from math import copysign, cos, exp, expm1, hypot, sin, sqrt

import cython

from lcpstep.kernels.model import Model
from lcpstep.pointers import abs, max

SMALL = 0.25  # of 2 delta tau and w2 tau^2: below it the power series is used
# Ratios of the coefficients of sin x / x in x^2, and of 2 (1 - cos x) / x^2
D1, D2, D3, D4, D5, D6, D7 = 1.0 / 6, 1.0 / 20, 1.0 / 42, 1.0 / 72, 1.0 / 110, 1.0 / 156, 1.0 / 210
C1, C2, C3, C4, C5, C6, C7 = 1.0 / 12, 1.0 / 30, 1.0 / 56, 1.0 / 90, 1.0 / 132, 1.0 / 182, 1.0 / 240
TERMS = 16  # of the series; the first neglected one is below rounding
NEGLIGIBLE = 1e-18  # two terms in a row, of a sum that is near one
NOTHING = 1e-100  # an exponent that is zero for every purpose
NEAR_RESONANCE = 1e-6  # relative; the motion is lost in the size of the steady oscillation beyond it


# 1 / k and 1 / (k (k + 1))
if not cython.compiled:
    ONE_OVER, ONE_OVER_PAIR = [0.0] * (TERMS + 2), [0.0] * (TERMS + 2)
for k in range(1, TERMS + 2):
    ONE_OVER[k], ONE_OVER_PAIR[k] = 1.0 / k, 1.0 / (k * (k + 1))


class Oscillator:
    """Coefficients of the equation, per unit mass, and of its steady oscillation."""

    def __init__(self, delta: float, w2: float, f0: float, X: float, Y: float, Omega: float) -> None:
        self.delta, self.w2, self.f0 = delta, w2, f0
        self.X, self.Y, self.Omega = X, Y, Omega


@cython.ccall
def oscillator_of(m: Model) -> Oscillator | None:
    """A model's motion between events in closed form; None where it has none."""
    if not (m.linear and m.n_q == 1 and m.n_c <= 1 and m.flat and not m.force.given):
        return None
    return oscillator(m.M[0], m.C[0], m.K[0], m.constant[0], m.cosine[0], m.sine[0], m.omega)


def oscillator(
    m: float, c: float, k: float, constant: float, cosine: float, sine: float, omega: float
) -> Oscillator | None:
    """Oscillator of m y'' + c y' + k y = F(t); None where it is undamped and near resonance."""
    delta, w2 = 0.5 * c / m, k / m
    if omega == 0.0 or (cosine == 0.0 and sine == 0.0):
        return Oscillator(delta, w2, (constant + (cosine if omega == 0.0 else 0.0)) / m, 0.0, 0.0, 0.0)
    a, b = w2 - omega * omega, 2.0 * delta * omega
    D = m * (a * a + b * b)
    if D == 0.0 or hypot(a, b) < NEAR_RESONANCE * (abs(w2) + omega * omega):
        return None
    return Oscillator(
        delta, w2, constant / m, (cosine * a - sine * b) / D, (cosine * b + sine * a) / D, omega
    )


@cython.ccall
def is_lost(o: Oscillator, m: Model, start: float, end: float) -> bool:
    """Whether what a force moves in the span is lost in the steady oscillation: it is slow, the spring not strong.

    Late phases are rounded, the oscillation with them.
    """
    way = hypot(m.cosine[0], m.sine[0]) / m.M[0] * (end - start) * (end - start)
    return hypot(o.X, o.Y) * NEAR_RESONANCE * max(1.0, o.Omega * max(abs(start), abs(end))) > way


def envelope(delta: float, w2: float, x: float, dx: float) -> float:
    """What an underdamped free motion never exceeds from a value and its rate on: its envelope only shrinks."""
    rise = dx + delta * x
    return sqrt(x * x + rise * rise / (w2 - delta * delta))


@cython.ccall
@cython.nogil
def fundamental(delta: float, w2: float, tau: float) -> tuple[float, float, float]:
    """S, S' and P at tau >= 0."""
    if delta == 0.0 and w2 == 0.0:
        return tau, 1.0, 0.5 * tau * tau
    if max(2.0 * abs(delta) * tau, abs(w2) * tau * tau) < SMALL:
        return undamped_series(w2, tau) if delta == 0.0 else series(delta, w2, tau)
    if w2 > 0.0 and delta == 0.0:
        w = sqrt(w2)
        dS = cos(w * tau)
        return sin(w * tau) / w, dS, (1.0 - dS) / w2
    if w2 > delta * delta:
        w = sqrt(w2 - delta * delta)
        decay = exp(-delta * tau)
        S = decay * sin(w * tau) / w
        dS = decay * cos(w * tau) - delta * S
        return S, dS, (1.0 - dS - 2.0 * delta * S) / w2
    return overdamped(delta, w2, tau)


def undamped_series(w2: float, tau: float) -> tuple[float, float, float]:
    """The same without damping, by power series in w2 tau^2."""
    t2 = tau * tau
    m = w2 * t2
    S = D6 * (1.0 - D7 * m)
    P = C6 * (1.0 - C7 * m)
    S, P = D5 * (1.0 - m * S), C5 * (1.0 - m * P)
    S, P = D4 * (1.0 - m * S), C4 * (1.0 - m * P)
    S, P = D3 * (1.0 - m * S), C3 * (1.0 - m * P)
    S, P = D2 * (1.0 - m * S), C2 * (1.0 - m * P)
    S, P = D1 * (1.0 - m * S), C1 * (1.0 - m * P)
    P = 0.5 * t2 * (1.0 - m * P)
    return tau * (1.0 - m * S), 1.0 - w2 * P, P


def series(delta: float, w2: float, tau: float) -> tuple[float, float, float]:
    """The same by their power series."""
    S = dS = P = 0.0
    before, term = 0.0, 1.0  # s_{k-1} tau^{k-2}, s_k tau^{k-1}
    damping, stiffness = 2.0 * delta * tau, w2 * tau * tau
    for k in range(1, TERMS + 1):
        dS += k * term
        S += term
        P += term * ONE_OVER[k + 1]
        before, term = term, -(damping * k * term + stiffness * before) * ONE_OVER_PAIR[k]
        if abs(before) + abs(term) < NEGLIGIBLE:
            break
    return S * tau, dS, P * tau * tau


def overdamped(delta: float, w2: float, tau: float) -> tuple[float, float, float]:
    """The same where both characteristic exponents are real; w2 may be zero or negative."""
    root = sqrt(delta * delta - w2)
    fast = -delta - copysign(root, delta) if delta != 0.0 else -root
    slow = w2 / fast
    if abs(fast - slow) * tau < SMALL:
        # Nearly equal exponents: S = tau exp(-delta tau) sinh(x)/x with x = root tau
        x2 = root * root * tau * tau
        decay = exp(-delta * tau)
        S = tau * decay * (1.0 + x2 / 6.0 * (1.0 + x2 / 20.0 * (1.0 + x2 / 42.0 * (1.0 + x2 / 72.0))))
        cosh = 1.0 + x2 / 2.0 * (1.0 + x2 / 12.0 * (1.0 + x2 / 30.0 * (1.0 + x2 / 56.0)))
        dS = decay * cosh - delta * S
        return S, dS, (1.0 - dS - 2.0 * delta * S) / w2
    e_fast, e_slow = expm1(fast * tau), expm1(slow * tau)
    gap = fast - slow
    S = (e_fast - e_slow) / gap
    dS = (fast * (e_fast + 1.0) - slow * (e_slow + 1.0)) / gap
    P_slow = e_slow / slow if abs(slow) * tau > NOTHING else tau
    return S, dS, (e_fast / fast - P_slow) / gap
