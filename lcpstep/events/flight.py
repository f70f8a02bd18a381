"""Free flight and rest of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

    y'' + 2 delta y' + w2 y = f0 + fc cos(Omega t) + fs sin(Omega t),   y = q + c(t),   g = offset + G q - s(t)

A flight starts at the base time T0 and can be asked for the gap, its velocity and its acceleration at any time tau
after it. On the obstacle, alpha is the acceleration that the gap would have without the contact force: the contact
lasts while alpha <= 0. Source: `oscillator`; G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.5 and 3.16.

All numbers of a flight lie in one array x, constants first: what a kernel is handed is then short, and a million
flights are the rows of a matrix.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call, inline
from lcpstep.events.oscillator import fundamental
from lcpstep.model import ABSENT

# Constants of the scene, places in x
DELTA, W2, F0, X, Y, OMEGA, FC, FS, G, OFFSET, R, RESPONSE, CONTACT = range(13)
SCAN, RTOL, ATOL, PERIOD, SCALE, T_END = range(13, 19)
# The flight at hand: base time and what rounding took from it; smooth interval around it; mode; the absolute state
# at the base less the steady oscillation; gap velocity and acceleration there, and whether it lies on the obstacle
T0, T0_REST, REST, LOW, HIGH, MODE, Z0, DZ0, SPEED0, ALPHA0, ON_SURFACE = range(19, 30)
# The loop over events: time, gap, its velocity and acceleration there; impulse since the last kept state;
# time of the last event; no release before HOLD; the state at the base; largest gap acceleration of the flight
NOW, EDGE_G, EDGE_U, EDGE_ALPHA, IMPULSE, LAST_EVENT, HOLD, Q0, V0, PEAK = range(30, 40)
# The time after the base last asked for, and the absolute motion there
TAU, Y_TAU, W_TAU, A_TAU = range(40, 44)
# Above the first, G times the absolute position is clear of the obstacle at all times; the second bounds the part of
# the gap acceleration that comes from frame and obstacle
CLEAR, BEND = 44, 45
N_NUMBERS = 46

FREE, CLOSED = 0.0, 1.0  # modes
RESOLUTION = 2.0**-52
NUDGE = 2.0**-49  # relative; keeps accelerations on their own side of a corner
NONE = -1.0  # in place of a root's time
MAX_ITERATIONS = 100
STRAIGHT = 1e-3  # of a gap root: the last step, relative to its bracket, and the change of the slope over it
GUESSES = 3  # steps of Newton's on the cubic of a first guess
COARSE = 1e-9  # of the bracket: where a gap turns it changes by the square of this
SHORT = 0.02  # of the scan interval: hops below it are followed by the acceleration alone
SETTLED = 1e-7  # change of the length of the longest hop that needs no further pass
PASSES = 8  # of the search for the end of a short hop; two are the rule
LONGER = 3.0  # how much longer than its guess a short hop may last
LEAPS = 12  # at most, of an open flight
SURE = 0.95  # share of a leap that the bound allows
WORTH = 0.5  # of the scan interval: shorter leaps are not made
GAUSS = (0.1127016653792583, 0.5, 0.8872983346207417)  # nodes on [0, 1]


@by_address
class Flight(NamedTuple):
    """One linear degree of freedom and its obstacle, as kernels see them."""

    x: Any  # (N_NUMBERS,) see above
    frame: Any  # callback or its address: c, c', c''
    motion: Any  # callback or its address: s, s', s''
    p: Any
    corners: Any  # (m,) in [0, period)
    now: Any  # (1, 3), work space of the callbacks
    q: Any  # (1,) the state last asked for
    v: Any


@inline
def inside(x: Any, t: float) -> float:
    """A time moved off the ends of its smooth interval, where accelerations, and an obstacle's velocity, may jump."""
    margin = NUDGE * max(abs(t), x[SCALE])
    return min(max(t, x[LOW] + margin), x[HIGH] - margin)


@inline
def steady(x: Any, t: float) -> tuple[float, float]:
    """The steady oscillation and its velocity."""
    if x[OMEGA] == 0.0:
        return 0.0, 0.0
    cosine, sine = math.cos(x[OMEGA] * t), math.sin(x[OMEGA] * t)
    return x[X] * cosine + x[Y] * sine, x[OMEGA] * (x[Y] * cosine - x[X] * sine)


@inline
def absolute(x: Any, tau: float) -> None:
    """Position, velocity and acceleration of the free motion at tau after the base, into x[Y_TAU .. A_TAU].

    Those last asked for are still there: on the two sides of a corner they are the same.
    """
    if tau == x[TAU]:
        return
    S, dS, P = fundamental(x[DELTA], x[W2], tau)
    z = x[Z0] * (dS + 2.0 * x[DELTA] * S) + x[DZ0] * S + x[F0] * P
    dz = -x[W2] * x[Z0] * S + x[DZ0] * dS + x[F0] * S
    y, dy = steady(x, x[T0] + tau)
    x[TAU], x[Y_TAU], x[W_TAU] = tau, z + y, dz + dy
    x[A_TAU] = x[F0] - 2.0 * x[DELTA] * dz - x[W2] * z - x[OMEGA] * x[OMEGA] * y


@inline
def moved(s: Any, f: Any, t: float) -> tuple[float, float, float]:
    """Displacement of the frame or of the obstacle at time t with its derivatives, from its side of a corner."""
    side = inside(s.x, t)
    call(f, side, s.q, s.v, s.p, s.now)
    beyond = t - side
    return s.now[0, 0] + s.now[0, 1] * beyond, s.now[0, 1] + s.now[0, 2] * beyond, s.now[0, 2]


@inline
def free(s: Any, tau: float) -> tuple[float, float, float]:
    """Gap, gap velocity and gap acceleration at tau after the base of the flight; the state into s.q, s.v."""
    x = s.x
    t = x[T0] + tau
    absolute(x, tau)
    q, v, a = x[Y_TAU], x[W_TAU], x[A_TAU]
    if s.frame != ABSENT:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, a = q - c, v - dc, a - ddc
    s.q[0], s.v[0] = q, v
    g, u, alpha = x[OFFSET] + x[G] * q, x[G] * v, x[G] * a
    if s.motion != ABSENT:
        c, dc, ddc = moved(s, s.motion, t)
        g, u, alpha = g - c, u - dc, alpha - ddc
    return g, u, alpha


@inline
def on_obstacle(s: Any, t: float, u: float) -> tuple[float, float, float]:
    """Absolute position and velocity on the obstacle when the gap velocity is u, and the gap acceleration alpha.

    The state relative to the frame goes into s.q, s.v.
    """
    x = s.x
    q, v, bias = -x[OFFSET] / x[G], u / x[G], 0.0
    if s.motion != ABSENT:
        c, dc, ddc = moved(s, s.motion, t)
        q, v, bias = q + c / x[G], v + dc / x[G], bias - ddc
    s.q[0], s.v[0] = q, v
    if s.frame != ABSENT:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, bias = q + c, v + dc, bias - x[G] * ddc
    a = x[F0] - 2.0 * x[DELTA] * v - x[W2] * q
    if x[OMEGA] != 0.0:
        side = inside(x, t)
        a += x[FC] * math.cos(x[OMEGA] * side) + x[FS] * math.sin(x[OMEGA] * side)
    return q, v, x[G] * a + bias


@inline
def leave_from(s: Any, t: float, y: float, w: float) -> None:
    """Begin a flight at time t with the absolute state y, w."""
    x = s.x
    rest, rest_velocity = steady(x, t)
    x[Z0], x[DZ0] = y - rest, w - rest_velocity
    x[T0], x[ON_SURFACE], x[SPEED0] = t, 0.0, 0.0
    x[T0_REST], x[REST] = x[REST], 0.0
    x[TAU] = math.nan


@inline
def rebase(s: Any, t: float) -> None:
    """Begin a flight at time t with the state s.q, s.v."""
    y, w = s.q[0], s.v[0]
    s.x[Q0], s.x[V0] = y, w
    if s.frame != ABSENT:
        call(s.frame, t, s.q, s.v, s.p, s.now)
        y += s.now[0, 0]
        w += s.now[0, 1]
    leave_from(s, t, y, w)


@inline
def after(x: Any, tau: float) -> float:
    """The time tau after the base of the flight; what rounding takes from it is kept for the next base.

    Without it, 10^5 equal flights would drift by 10^5 roundings of the time, all of one sign.
    """
    step = x[T0_REST] + tau
    t = x[T0] + step
    moved = t - x[T0]
    x[REST] = (x[T0] - (t - moved)) + (step - moved)
    return float(t)


def gap_root(s: Any, a: float, g_a: float, u_a: float, b: float, g_b: float, u_b: float) -> float:
    """Root of the gap between a and b, g_a g_b <= 0; the first guess from the cubic through both ends."""
    h = b - a
    bend = 3.0 * (g_b - g_a) - h * (2.0 * u_a + u_b)
    twist = h * (u_a + u_b) - 2.0 * (g_b - g_a)
    sigma = g_a / (g_a - g_b) if g_a != g_b else 0.5
    for _ in range(GUESSES):
        slope = h * u_a + sigma * (2.0 * bend + 3.0 * sigma * twist)
        if slope != 0.0:
            sigma -= (g_a + sigma * (h * u_a + sigma * (bend + sigma * twist))) / slope
    return root(s, 0, a, g_a, b, g_b, a + sigma * h)


def root(s: Any, level: int, a: float, f_a: float, b: float, f_b: float, guess: float) -> float:
    """Root between a and b of the gap (level 0), its velocity (1) or acceleration (2); f_a f_b <= 0.

    Halley's method for the gap and Newton's for the others, safeguarded by bisection, from a guess that may be
    anything. The gap's last step is not evaluated any more once its own error, (|curvature| step / |slope|)^2 step,
    is far below what a step of Newton's at its end takes out (`single.fly`), or below rounding. Source: W. Press et
    al., Numerical Recipes, section 9.4.
    """
    if f_a == 0.0:
        return a
    tau, f = (b, f_b) if abs(f_b) < abs(f_a) else (a, f_a)
    new = guess if a < guess < b else tau - f * (b - a) / (f_b - f_a)
    width = before = b - a
    for _ in range(MAX_ITERATIONS):
        if f == 0.0:
            return tau
        if not (a < new < b) or abs(new - tau) > 0.5 * abs(before):
            new = 0.5 * (a + b)
        before = new - tau
        old, f_old, tau = tau, f, new
        g, u, alpha = free(s, tau)
        f, slope, curvature = g, u, alpha
        if level == 1:
            f, slope, curvature = u, alpha, 0.0
        elif level == 2:
            f, slope, curvature = alpha, (alpha - f_old) / (tau - old), 0.0
        if (f > 0.0) == (f_a > 0.0):
            a, f_a = tau, f
        else:
            b = tau
        step = -f / slope if slope != 0.0 else before
        bent = abs(curvature * step)
        near = level == 0 and bent <= STRAIGHT * abs(slope) and abs(step) <= STRAIGHT * width
        if 0.0 < bent <= abs(slope):
            step -= 0.5 * curvature * step * step / slope
        small = RESOLUTION * abs(tau) if level == 0 else COARSE * width
        if near or abs(before) <= small or b - a <= small:
            # At the end of a bracket the root may lie outside by rounding, and by no more
            return tau + step if abs(step) <= 4.0 * RESOLUTION * abs(tau) else min(max(tau + step, a), b)
        new = tau + step
    return tau


def short_hop(s: Any, guess: float, longest: float) -> tuple[float, float]:
    """End of a hop that left the obstacle at the base, and the gap velocity there; NONE if it is longer.

    The gap from the acceleration alone, so that no difference of nearly equal positions is taken and the smallest
    hops keep all their digits: with sigma = s / tau and alpha - alpha0 = c1 sigma + c2 sigma^2 + c3 sigma^3 through
    its values at three Gauss nodes,

        u = u0 + alpha0 tau + tau (c1/2 + c2/3 + c3/4),    g / tau = u0 + alpha0 tau/2 + tau (c1/6 + c2/12 + c3/20)

    which is Gauss' quadrature of degree five at the solution.
    """
    x = s.x
    u0, alpha0 = x[SPEED0], x[ALPHA0]
    tau = guess
    n1, n2, n3 = GAUSS
    for _ in range(PASSES):
        if not 0.0 < tau <= longest:
            return NONE, 0.0
        _, _, f1 = free(s, n1 * tau)
        _, _, f2 = free(s, n2 * tau)
        _, _, f3 = free(s, n3 * tau)
        # Newton's divided differences of (alpha - alpha0) / sigma
        d1, d2, d3 = (f1 - alpha0) / n1, (f2 - alpha0) / n2, (f3 - alpha0) / n3
        d12, d23 = (d2 - d1) / (n2 - n1), (d3 - d2) / (n3 - n2)
        c3 = (d23 - d12) / (n3 - n1)
        c2 = d12 - c3 * (n1 + n2)
        c1 = d1 - n1 * (c2 + n1 * c3)
        r = 1.0
        for _ in range(PASSES):
            F = u0 + tau * r * (0.5 * alpha0 + r * (c1 / 6.0 + r * (c2 / 12.0 + r * c3 / 20.0)))
            dF = tau * (0.5 * alpha0 + r * (c1 / 3.0 + r * (c2 / 4.0 + r * c3 / 5.0)))
            step = -F / dF if dF < 0.0 else 1.0
            r += step
            if abs(step) <= RESOLUTION or not 0.0 < r < LONGER:
                break
        if not 0.0 < r < LONGER:
            return NONE, 0.0
        tau *= r
        # The nodes were those of another length: the cubic's error beyond them, times by how much it was another
        if abs(r - 1.0) <= SETTLED * (SHORT * x[SCAN] / tau) ** 4:
            return tau, u0 + tau * (alpha0 + r * (c1 / 2.0 + r * (c2 / 3.0 + r * c3 / 4.0)))
    return NONE, 0.0


@inline
def hardest(x: Any) -> float:
    """Bound on |y''| in the rest of an undamped or damped flight; infinite where none is known.

    The acceleration of the remainder obeys its own equation of motion, so that its envelope only shrinks.
    """
    delta, w2 = x[DELTA], x[W2]
    a = x[F0] - 2.0 * delta * x[DZ0] - w2 * x[Z0]
    if delta == 0.0 and w2 == 0.0:
        size = abs(a)
    elif delta >= 0.0 and w2 > delta * delta:
        jerk = -2.0 * delta * a - w2 * x[DZ0]
        size = math.sqrt(a * a + (jerk + delta * a) ** 2 / (w2 - delta * delta))
    else:
        size = math.inf
    return size + x[OMEGA] * x[OMEGA] * (abs(x[X]) + abs(x[Y]))


@inline
def clear_until(s: Any, limit: float) -> float:
    """Time after the base up to which the gap is certainly open, at most `limit`; that of now where none is.

    Twice the same bound: under accelerations of at most A the gap stays above g + u tau - A tau^2/2. First for the
    gap itself, from the state at hand; then, step by step, for the height above all that the obstacle can reach,
    where only the free motion accelerates.
    """
    x = s.x
    a = x[NOW] - x[T0]
    g, u = max(x[EDGE_G], 0.0), x[EDGE_U]
    least = WORTH * x[SCAN]
    if not u + math.sqrt(u * u + 2.0 * x[BEND] * g) > least * x[BEND]:
        return a
    free_most = abs(x[G]) * hardest(x)
    most = free_most + x[BEND]
    step = SURE * (u + math.sqrt(u * u + 2.0 * most * g)) / most
    tau = a
    for _ in range(LEAPS):
        if not step > least:
            break
        tau += step
        if tau >= limit:
            return limit
        absolute(x, tau)
        height, rise = x[G] * x[Y_TAU] - x[CLEAR], x[G] * x[W_TAU]
        step = 0.0
        if height > 0.0:
            step = SURE * (rise + math.sqrt(rise * rise + 2.0 * free_most * height)) / free_most
    return tau


def find_corners(s: Any, t: float) -> None:
    """The smooth interval that begins at t or contains it."""
    x = s.x
    near = t + 0.5 * NUDGE * max(abs(t), x[SCALE])
    if x[LOW] <= near < x[HIGH]:
        return
    x[LOW], x[HIGH] = -math.inf, math.inf
    n = len(s.corners)
    if n == 0:
        return
    start = 0.0
    if x[PERIOD] < math.inf:
        turn = math.floor(near / x[PERIOD])
        start = turn * x[PERIOD]
        x[LOW], x[HIGH] = (turn - 1.0) * x[PERIOD] + s.corners[n - 1], (turn + 1.0) * x[PERIOD] + s.corners[0]
        if near >= x[HIGH]:  # the quotient was rounded down
            x[LOW], start = x[HIGH], (turn + 1.0) * x[PERIOD]
            x[HIGH] = (turn + 2.0) * x[PERIOD] + s.corners[0]
    for corner in s.corners:
        if start + corner > near:
            x[HIGH] = start + corner
            break
        x[LOW] = start + corner
