"""A piece of smooth motion that can be asked for any time within it, as kernels: state, impulses."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.general.earliest import observe
    from lcpstep.events.general.equations import gap_tolerance, measure_on, speed_tolerance
    from lcpstep.events.general.state import Mechanism
    from lcpstep.events.rows.equations import size_of
    from lcpstep.kernels.dynamics import gap_rates
    from lcpstep.kernels.together import gap_rounding
    from lcpstep.kernels.vectors import clear, copy, largest, product
    from lcpstep.pointers import abs, after, max

SURE = 0.5  # of a gap: by how much its slope may change over Newton's step to zero if there is one
GONE = 1e-90  # of the tolerance: what is left of a motion that has died away


def rebase(s: Mechanism, t: float) -> None:
    """Begin a new piece at time t with the state q, v."""
    copy(s.q0, s.q, 2 * s.n_q)
    s.start_at(t)


def state_at(s: Mechanism, tau: float) -> None:
    """State q, v at the time tau after the base."""
    if s.constant:
        a = s.a
        for j in range(s.n_q):
            s.q[j] = s.q0[j] + tau * (s.v0[j] + 0.5 * tau * a[j])
            s.v[j] = s.v0[j] + tau * a[j]
    elif tau == 0.0:
        copy(s.q, s.q0, 2 * s.n_q)
    else:
        s.smooth.at(tau / s.length, s.q)


def come_to_rest(s: Mechanism) -> bool:
    """Put at rest, at zero, a motion of which nothing is left; False where the rest is not finite there.

    Beyond, squares of errors tell nothing, and soon numbers have no digits more, by which impacts have an answer.
    """
    left = largest(s.q, 0.0, 2 * s.n_q)
    if left == 0.0 or left > GONE * s.atol:
        return True
    clear(s.q, 2 * s.n_q)
    return measure_on(s, s.t0)


def lift(s: Mechanism, c: int) -> None:
    """Put q onto the surface of contact c, which it misses by no more than the tolerance: hops start from there."""
    lift_by(s, c, -s.contact.gap[c])
    s.contact.gap[c] = 0.0


def lift_by(s: Mechanism, c: int, g: float) -> None:
    """Move q by Newton's step to where gap c is larger by g, if it depends on a coordinate."""
    i = s.n_j + c
    D = s.D[i * s.n_r + i]
    if D > 0.0:
        for j in range(s.n_q):
            s.q[j] += s.MR[i * s.n_q + j] * g / D


def arrive(s: Mechanism, c: int) -> bool:
    """Put q onto the surface of contact c, which it misses by less than a time can tell: along its own way.

    So gaps that close at one instant, as in the apex of a wedge along which a body slides, go on closing together.
    False where the surface is no longer there.
    """
    g, u = s.contact.gap[c], s.contact.speed[c]
    if s.contact.rate[c] == 0.0 and u < 0.0 and abs(g) <= -s.untold(s.length) * u:
        for j in range(s.n_q):
            s.q[j] -= s.v[j] * g / u
        for d in range(s.n_c):
            if s.contact.closed[d] == 0:
                s.contact.gap[d] = s.contact.gap[d] - (s.contact.speed[d] - s.contact.rate[d]) * g / u
        s.contact.gap[c] = 0.0
        return True
    lift(s, c)
    if s.contact.rate[c] != 0.0:
        close_with(s, c)
    return s.model.flat or has_room(s, c, g)


def close_with(s: Mechanism, c: int) -> None:
    """Gaps that close with that of contact c, whose obstacle moves: within less than a time can tell."""
    for d in range(s.n_c):
        way = -s.untold(s.length) * s.contact.speed[d]
        if d != c and s.contact.closed[d] == 0 and way > 0.0 and abs(s.contact.gap[d]) <= way:
            s.contact.gap[d] = 0.0


def has_room(s: Mechanism, c: int, g: float) -> bool:
    """Whether contact c, whose gap `lift` has taken from g to zero, leaves room; where it was led astray q goes back.

    By h = |(G' - G) dq| / |G dq|: Newton's step leads towards a zero where h <= 1/2. Beyond that a parabola that
    bends downwards, as in the middle of a bowl, has none if g < 0, and if g > 0 rises by no more than g. Source of h:
    L. Kantorovich, Functional analysis and applied mathematics, Uspekhi Matematicheskikh Nauk 3 (1948).
    """
    i = s.n_j + c
    D = s.D[i * s.n_r + i]
    gap_rates(s.model, s.t0, s.q, s.v, s.turned, s.near)
    bend = product(s.turned, after(s.MR, i * s.n_q), c, s.n_q) - D
    if abs(bend) <= SURE * D:
        return True
    lift_by(s, c, g)
    downwards = bend * g > 0.0
    return not (downwards and (g < 0.0 or s.contact.rate[c] < 0.0))


def touching(s: Mechanism, c: int) -> float:
    """The gap below which contact c is closed at the start: rounding, and the tolerance where gaps are not exact."""
    rounding = rounding_of_gap(s, c)
    return rounding if s.constant else max(rounding, gap_tolerance(s, c))


def closed_from(s: Mechanism, c: int) -> float:
    """The gap below which contact c begins closed: rounding, or the tolerance where it does not move.

    A contact that moves is in a hop, and to begin that at the surface would leave it only the height that it has
    beyond.
    """
    still = abs(s.contact.speed[c]) <= speed_tolerance(s, c)
    return touching(s, c) if still else rounding_of_gap(s, c)


def rounding_of_gap(s: Mechanism, c: int) -> float:
    """What rounding may leave of the gap of contact c, of the way included by which it has come in the last step."""
    way = s.length * size_of(s, s.n_j + c, 0.0, s.v) if s.length > 0.0 else 0.0
    return gap_rounding(s.model, s.contact.G, s.q, c, way)


def press(s: Mechanism, tau: float) -> None:
    """Add the impulses of the forces over the time tau."""
    for c in range(s.n_c):
        s.contact.impulse[c] = s.contact.impulse[c] + s.contact.multiplier[c] * tau
    for i in range(s.n_j):
        s.joint.impulse[i] = s.joint.impulse[i] + s.joint.multiplier[i] * tau


def press_between(s: Mechanism, a: float, b: float) -> None:
    """The same for forces that change between a and b after the base: Gauss' quadrature."""
    if s.n_held == 0 or b <= a:
        return
    for k in range(s.n_nodes):
        observe(s, a + s.nodes[k] * (b - a))
        press(s, s.weights[k] * (b - a))
