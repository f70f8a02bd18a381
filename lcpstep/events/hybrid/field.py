"""A system with modes as kernels see it: its vector fields, sliding included, its guards and their gradients.

    F_s = (L2 F1 - L1 F2) / (L2 - L1),    L_i = H_t + H_x F_i         (Filippov's convex combination)

Sliding ends where L1 falls to zero (the motion goes on below) or L2 rises to it (above): two guards of the sliding
mode. Gradients are differences of fourth order, exact for linear functions.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call_first_order
from lcpstep.dense import assign
from lcpstep.events.clock import RESOLUTION

# What a guard is: the user's; a surface reached; the end of sliding, below and above
PLAIN, ARRIVE, EXIT_BELOW, EXIT_ABOVE = range(4)
NOT_SLIDING = -1
DIFFERENCE = 2.0**-10  # step of differences, relative
INNER, OUTER = 2.0 / 3.0, -1.0 / 12.0
TINY = 1e-300  # a band is never empty


@by_address
class Space(NamedTuple):
    """Work space for a state of n numbers."""

    F: Any  # (n,)
    F1: Any
    F2: Any
    out: Any  # (1,)
    H_x: Any  # (n,) gradient of a surface
    g_x: Any  # (n,) gradient of a guard
    x: Any  # (n,) shifted state of the surface's differences
    x_guard: Any  # (n,) the same for guards
    moved: Any  # (n,) state after a reset


@by_address
class Machine(NamedTuple):
    """Everything that a kernel needs to evaluate a system with modes."""

    fields: Any  # (modes,) functions; a sliding mode repeats one that it does not use
    surfaces: Any  # (modes,) H of a sliding mode
    values: Any  # (guards,) functions
    resets: Any  # (guards,) functions
    has_reset: Any  # (guards,)
    first: Any  # (modes + 1,) the guards of mode m are first[m] .. first[m + 1] - 1
    sign: Any  # (guards,) a guard acts where sign times its value rises through zero
    at_once: Any  # (guards,)
    kind: Any  # (guards,) PLAIN, ...
    target: Any  # (guards,) mode entered; for ARRIVE the sliding mode
    below: Any  # (modes,) modes beside a sliding one, or NOT_SLIDING
    above: Any
    p: Any  # (n_p,)
    dt: float  # step of differences in time
    work: Any  # a Space


def scalar(f: Any, m: Any, t: float, x: Any) -> float:
    """Value of a user's function with one result."""
    call_first_order(f, t, x, m.p, m.work.out)
    return m.work.out[0]


def field(m: Any, mode: int, t: float, x: Any, out: Any) -> None:
    """The vector field of a mode."""
    w = m.work
    if m.below[mode] == NOT_SLIDING:
        call_first_order(m.fields[mode], t, x, m.p, out)
        return
    L1, L2 = approaches(m, mode, t, x)
    for i in range(len(out)):
        out[i] = (L2 * w.F1[i] - L1 * w.F2[i]) / (L2 - L1)


def approaches(m: Any, mode: int, t: float, x: Any) -> tuple[float, float]:
    """L1 and L2 of a sliding mode, the rates of H along the fields on both sides, which are left in F1 and F2."""
    w = m.work
    call_first_order(m.fields[m.below[mode]], t, x, m.p, w.F1)
    call_first_order(m.fields[m.above[mode]], t, x, m.p, w.F2)
    H_t = surface_gradient(m, mode, t, x)
    L1, L2 = H_t, H_t
    for i in range(len(x)):
        L1 += w.H_x[i] * w.F1[i]
        L2 += w.H_x[i] * w.F2[i]
    return L1, L2


def surface_gradient(m: Any, mode: int, t: float, x: Any) -> float:
    """H_x into the work space; returns H_t."""
    w = m.work
    H = m.surfaces[mode]
    assign(w.x, x)
    for i in range(len(x)):
        d, slope = DIFFERENCE * max(1.0, abs(x[i])), 0.0
        for k in range(2):
            step, weight = (d, INNER) if k == 0 else (2.0 * d, OUTER)
            w.x[i] = x[i] + step
            up, value = w.x[i], scalar(H, m, t, w.x)
            w.x[i] = x[i] - step
            slope += 2.0 * (1 + k) * weight * (value - scalar(H, m, t, w.x)) / (up - w.x[i])
        w.x[i], w.H_x[i] = x[i], slope
    d, H_t = m.dt, 0.0
    for k in range(2):
        step, weight = (d, INNER) if k == 0 else (2.0 * d, OUTER)
        H_t += weight * (scalar(H, m, t + step, x) - scalar(H, m, t - step, x)) / d
    return H_t


def guard(m: Any, mode: int, k: int, t: float, x: Any) -> float:
    """Value of guard k of a mode; it acts where this rises through zero."""
    if m.kind[k] == EXIT_BELOW:
        return -approaches(m, mode, t, x)[0]
    if m.kind[k] == EXIT_ABOVE:
        return approaches(m, mode, t, x)[1]
    return m.sign[k] * scalar(m.values[k], m, t, x)


def guard_gradient(m: Any, mode: int, k: int, t: float, x: Any) -> float:
    """Gradient of guard k by the state into the work space; returns its derivative by time."""
    w = m.work
    assign(w.x_guard, x)
    for i in range(len(x)):
        d, slope = DIFFERENCE * max(1.0, abs(x[i])), 0.0
        for j in range(2):
            step, weight = (d, INNER) if j == 0 else (2.0 * d, OUTER)
            w.x_guard[i] = x[i] + step
            up, value = w.x_guard[i], guard(m, mode, k, t, w.x_guard)
            w.x_guard[i] = x[i] - step
            slope += 2.0 * (1 + j) * weight * (value - guard(m, mode, k, t, w.x_guard)) / (up - w.x_guard[i])
        w.x_guard[i], w.g_x[i] = x[i], slope
    d, g_t = m.dt, 0.0
    for j in range(2):
        step, weight = (d, INNER) if j == 0 else (2.0 * d, OUTER)
        g_t += weight * (guard(m, mode, k, t + step, x) - guard(m, mode, k, t - step, x)) / d
    return g_t


def band_and_rate(m: Any, mode: int, k: int, t: float, x: Any, flow: Any) -> tuple[float, float, float]:
    """How well guard k is known; its rate along the motion, and how well that is known; flow: with the tolerances."""
    w = m.work
    g_t = guard_gradient(m, mode, k, t, x)
    field(m, mode, t, x, w.F)
    rate, band, size = g_t, TINY + abs(g_t) * 16.0 * RESOLUTION * abs(t), abs(g_t)
    for i in range(len(x)):
        rate += w.g_x[i] * w.F[i]
        size += abs(w.g_x[i] * w.F[i])
        band += abs(w.g_x[i]) * (flow.atol + (flow.rtol + 16.0 * RESOLUTION) * abs(x[i]))
    band += 16.0 * RESOLUTION * abs(t) * abs(rate)
    if m.kind[k] >= EXIT_BELOW:  # made of differences itself
        L1, L2 = approaches(m, mode, t, x)
        band += flow.atol + flow.rtol * (abs(L1) + abs(L2))
    return band, rate, 64.0 * RESOLUTION * size


def project(m: Any, mode: int, t: float, x: Any) -> None:
    """The nearest state on the surface of a sliding mode, by one Newton step."""
    w = m.work
    surface_gradient(m, mode, t, x)
    H, square = scalar(m.surfaces[mode], m, t, x), 0.0
    for i in range(len(x)):
        square += w.H_x[i] * w.H_x[i]
    if square > 0.0:
        for i in range(len(x)):
            x[i] -= w.H_x[i] * H / square
