"""Motions of one linear degree of freedom over an obstacle, to fifty digits: the judge of both integrators.

    m y'' + c y' + k y = f0 + fc cos(Omega t),      gap  side (y - s(t)) >= 0,      u+ = -r u-

The flow between events is written with complex exponentials, the obstacle with mpmath's functions, and roots are
bracketed by a scan and halved, or found by Newton's method within: nothing is shared with the library but the
equations. Infinitely many impacts are followed down to a speed of `DUST` and then summed; what is left out is of the
order of its square.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mpmath import mp, mpf

mp.dps = 50
DUST = mpf(10) ** -17
NEAR = mpf(10) ** -12  # to a root, of the interval: two steps of Newton's method are left
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
FREE, CLOSED = 0, 1


def at_rest(height: float) -> Callable[[Any, Any], tuple[Any, Any, Any]]:
    """An obstacle that does not move."""
    return lambda t, within: (mpf(height), mpf(0), mpf(0))


FLOOR = at_rest(0.0)


def table(A: float, w: float) -> Callable[[Any, Any], tuple[Any, Any, Any]]:
    """The obstacle A sin(w t)."""
    A, w = mpf(A), mpf(w)
    return lambda t, within: (A * mp.sin(w * t), A * w * mp.cos(w * t), -A * w * w * mp.sin(w * t))


# End, kappa, psi, rho of the arcs, as in the equations of the cam-follower [m, rad]
CAM_ARCS = (
    (mp.pi / 2, 0, 0, mpf("0.40")),
    (mp.pi / 2 + mpf("1.050328174371336"), mpf("0.45"), -mp.pi / 2, mpf("0.85")),
    (mp.pi / 2 + mpf("1.22173047639603"), mpf("0.40393320723821"), mp.pi - mp.pi / 9, mpf("0.15")),
    (mp.pi, 0, 0, mpf("0.55393320723821")),
)


def cam_lift(beta: Any, within: Any) -> tuple[Any, Any, Any]:
    """c, dc/dbeta, d2c/dbeta2 of the cam, by the arc that the angle `within` lies on."""
    turns = mp.floor(within / (2 * mp.pi))
    beta, within = beta - 2 * mp.pi * turns, within - 2 * mp.pi * turns
    direction = 1
    if within > mp.pi:
        beta, within, direction = 2 * mp.pi - beta, 2 * mp.pi - within, -1
    _, kappa, psi, rho = next(arc for arc in CAM_ARCS if within <= arc[0])
    x, y = (kappa * part for part in mp.cos_sin(beta - psi))
    root = mp.sqrt(rho**2 - y**2)
    # d(root)/dbeta = -x y / root; d(x y)/dbeta = x^2 - y^2
    second = -x - ((x * x - y * y) * root + (x * y) ** 2 / root) / root**2
    return x + root - mpf("0.3"), direction * (-y - x * y / root), second


def cam(rpm: float) -> Callable[[Any, Any], tuple[Any, Any, Any]]:
    """The lift of the turning cam and its time derivatives."""
    omega = 2 * mp.pi * mpf(rpm) / 60

    def s(t: Any, within: Any) -> tuple[Any, Any, Any]:
        c, dc, ddc = cam_lift(omega * t + mp.pi / 2, omega * within + mp.pi / 2)
        return c, omega * dc, omega**2 * ddc

    return s


def cam_corners(rpm: float) -> tuple[list[Any], Any]:
    """Times of the corners within a turn, and the period [s]."""
    omega = 2 * mp.pi * mpf(rpm) / 60
    ends = [arc[0] for arc in CAM_ARCS[:3]]
    angles = [e - mp.pi / 2 for e in ends] + [2 * mp.pi - e - mp.pi / 2 for e in reversed(ends)]
    return [a / omega for a in angles], 2 * mp.pi / omega


@dataclass
class Body:
    """One linear degree of freedom and its obstacle."""

    m: Any = 1
    c: Any = 0
    k: Any = 0
    f0: Any = 0
    fc: Any = 0
    Omega: Any = 0
    r: Any = 0
    side: int = 1
    s: Callable[[Any, Any], tuple[Any, Any, Any]] = FLOOR
    corners: tuple[list[Any], Any] = ([], mp.inf)
    scan: Any = 0.05  # no two roots of the gap velocity lie closer [s]

    def __post_init__(self) -> None:
        for name in ("m", "c", "k", "f0", "fc", "Omega", "r", "scan"):
            setattr(self, name, mpf(getattr(self, name)))
        self.X = self.Y = mpf(0)
        if self.fc != 0:
            X = self.fc / (self.k - self.m * self.Omega**2 + 1j * self.c * self.Omega)
            self.X, self.Y = mp.re(X), -mp.im(X)  # X cos + Y sin
        root = mp.sqrt(mp.mpc((self.c / self.m / 2) ** 2 - self.k / self.m))
        self.l1, self.l2 = -self.c / self.m / 2 + root, -self.c / self.m / 2 - root

    def steady(self, t: Any) -> tuple[Any, Any]:
        """The steady oscillation and its velocity."""
        co, si = mp.cos_sin(self.Omega * t)
        return self.X * co + self.Y * si, self.Omega * (self.Y * co - self.X * si)

    def flow(self, t0: Any, y0: Any, v0: Any, tau: Any) -> tuple[Any, Any]:
        """Position and velocity of the free motion."""
        (x0, dx0), (x, dx) = self.steady(t0), self.steady(t0 + tau)
        if self.k == 0:  # undamped: a projectile
            a = self.f0 / self.m
            return x + y0 - x0 + (v0 - dx0) * tau + a * tau**2 / 2, dx + v0 - dx0 + a * tau
        z0, dz0 = y0 - x0 - self.f0 / self.k, v0 - dx0
        B = (self.l1 * z0 - dz0) / (self.l1 - self.l2)
        A = z0 - B
        e1, e2 = A * mp.exp(self.l1 * tau), B * mp.exp(self.l2 * tau)
        return x + self.f0 / self.k + mp.re(e1 + e2), dx + mp.re(self.l1 * e1 + self.l2 * e2)

    def acceleration(self, t: Any, y: Any, v: Any) -> Any:
        """y'' of the free motion."""
        return (self.f0 + self.fc * mp.cos(self.Omega * t) - self.c * v - self.k * y) / self.m


@dataclass
class Motion:
    """Pieces of motion and what happened between them."""

    body: Body
    t: list[Any] = field(default_factory=list)
    mode: list[int] = field(default_factory=list)
    y: list[Any] = field(default_factory=list)
    v: list[Any] = field(default_factory=list)
    events: list[tuple[int, Any, Any, Any]] = field(default_factory=list)  # kind, time, before, after

    def of_kind(self, kind: int) -> list[tuple[int, Any, Any, Any]]:
        """Events of one kind."""
        return [e for e in self.events if e[0] == kind]

    def at(self, t: Any) -> tuple[Any, Any]:
        """Position and velocity, right limits."""
        t = mpf(t)
        i = max(k for k in range(len(self.t)) if self.t[k] <= t)
        if self.mode[i] == CLOSED:
            within = (self.t[i] + (self.t[i + 1] if i + 1 < len(self.t) else t)) / 2
            return self.body.s(t, within)[:2]
        return self.body.flow(self.t[i], self.y[i], self.v[i], t - self.t[i])


def motion(body: Body, y: float, v: float, t_end: float) -> Motion:
    """The motion from (y, v) at t = 0, which lies off the obstacle."""
    out, t, y, v, t_end = Motion(body), mpf(0), mpf(y), mpf(v), mpf(t_end)
    mode, u_plus = FREE, None  # u_plus: gap velocity when the surface has just been left
    while t < t_end:
        hi = min(_next_corner(body, t), t_end)
        within = (t + hi) / 2
        if mode == CLOSED:
            out.t.append(t), out.mode.append(mode), out.y.append(y), out.v.append(v)
            t = _release(body, t, hi, within)
            y, v, _ = body.s(t, within)
            if t < hi or _alpha_on_surface(body, t, _after(body, t, t_end)) > 0:
                mode, u_plus = FREE, None
                out.events.append((RELEASE, t, mpf(0), mpf(0)))
            continue
        out.t.append(t), out.mode.append(mode), out.y.append(y), out.v.append(v)
        found = _first_contact(body, t, y, v, hi, within, u_plus)
        u_plus = None
        if found is None:
            y, v = body.flow(t, y, v, hi - t)
            t = hi
            continue
        _, v = body.flow(t, y, v, found - t)
        t = found
        y, ds, _ = body.s(t, within)
        before = body.side * (v - ds)
        u_plus = -body.r * before
        v = ds + body.side * u_plus
        out.events.append((IMPACT, t, before, u_plus))
        alpha = _alpha_on_surface(body, t, _after(body, t, t_end))
        if alpha <= 0 and u_plus <= DUST:
            T = 2 * u_plus / (-alpha * (1 - body.r)) if u_plus > 0 else mpf(0)
            t, mode, u_plus = t + T, CLOSED, None
            y, v, _ = body.s(t, within)
            if T > 0:
                out.events.append((ACCUMULATION, t, -u_plus if u_plus else mpf(0), mpf(0)))
            out.events.append((STICK, t, mpf(0), mpf(0)))
    return out


def _next_corner(body: Body, t: Any) -> Any:
    times, period = body.corners
    if not times:
        return mp.inf
    turn = mp.floor(t / period)
    return min(
        c + (turn + k) * period for k in (-1, 0, 1, 2) for c in times if c + (turn + k) * period > t + DUST
    )


def _after(body: Body, t: Any, t_end: Any) -> Any:
    """A time inside the smooth interval that begins at t or holds it."""
    return (t + min(_next_corner(body, t), t_end + 1)) / 2


def _alpha_on_surface(body: Body, t: Any, within: Any) -> Any:
    s, ds, dds = body.s(t, within)
    return body.side * (body.acceleration(t, s, ds) - dds)


def _first_contact(body: Body, t: Any, y: Any, v: Any, hi: Any, within: Any, u_plus: Any) -> Any:
    def gap(x: Any) -> tuple[Any, Any]:
        p, w = body.flow(t, y, v, x - t)
        s, ds, _ = body.s(x, within)
        return body.side * (p - s), body.side * (w - ds)

    step = body.scan
    if u_plus is not None:  # hops shorter than the scan
        alpha = _alpha_on_surface(body, t, within)
        guess = 2 * u_plus / -alpha if alpha < 0 else mp.inf
        if guess < step:
            a, b = t + guess / 2, t + 2 * guess
            if b <= hi and gap(b)[0] < 0:
                return _root(lambda x: gap(x), a, b)
            step = guess / 4
    a, u_a = t, None
    while a < hi:
        b = min(a + step, hi)
        g_b, u_b = gap(b)
        if g_b < 0:
            low = b
        elif u_a is not None and u_a < 0 < u_b:
            low = _root(lambda x: (gap(x)[1], None), a, b)
            if gap(low)[0] > 0:
                low = None
        else:
            low = None
        if low is not None:
            return _root(gap, a if a > t else t + (low - t) / 1000, low)
        a, u_a = b, u_b
    return None


def _release(body: Body, t: Any, hi: Any, within: Any) -> Any:
    a, step = t, body.scan
    while a < hi:
        b = min(a + step, hi)
        if _alpha_on_surface(body, b, within) > 0:
            return _root(lambda x: (_alpha_on_surface(body, x, within), None), a, b)
        a = b
    return hi


def _root(f: Callable[[Any], tuple[Any, Any]], a: Any, b: Any) -> Any:
    """Root of f between a and b; f gives its value and its slope, for Newton's method (None: halved to the end)."""
    sign, near, x = mp.sign(f(a)[0]), (b - a) * NEAR, (a + b) / 2
    for _ in range(165):
        value, slope = f(x)
        if mp.sign(value) == sign:
            a = x
        else:
            b = x
        step = value / slope if slope else b - a
        if slope and abs(step) < near:
            break
        x = x - step if a < x - step < b else (a + b) / 2
    for _ in range(2 if slope else 0):
        value, slope = f(x)
        x -= value / slope
    return x
