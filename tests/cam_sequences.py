"""Whole chattering sequences of the cam-follower that rests on its cam, in 110 digits: the judge of their ends.

    m u'' + k u = 0 off the cam, u >= c(t), u'+ = (1 + r) c' - r u'-

Every flight is a sinusoid over arcs of circles, in closed form; impacts are roots of the gap to 40 digits. A sequence
is followed hop by hop until its hops last less than 1e-30 s, and the rest is summed. The arcs are those of the
published constants, of which lift and slope at a corner are off by 4e-15: there the gap and its velocity go on, and
only the acceleration jumps.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

from mpmath import mp, mpf

DIGITS = 110
EXACT = mpf(10) ** -40  # relative, of roots: what cancels of the gap of the shortest hops leaves as much
SHORTEST = mpf(10) ** -30  # hop [s]
REGULAR = (
    mpf(10) ** -7
)  # hops shorter than this last as long as under a constant acceleration, or nearly so [s]
SMOOTH = mpf(10) ** -20  # a release with less acceleration than this is where it turns positive [m/s^2]
M, K, R = mpf(1.221), mpf(1430.8), mpf(0.8)
OFFSET = mpf("0.3")
# Release, impacts (time, u-), accumulation; the last is None where the span ends before
Sequence = tuple[Any, list[tuple[Any, Any]], Any]


@dataclass
class Cam:
    """The turning cam; its arcs and corners are counted from t = 0, the start of the lift, and on over the turns."""

    rpm: Any

    @cached_property
    def omega(self) -> Any:
        return 2 * mp.pi * mpf(self.rpm) / 60

    @cached_property
    def period(self) -> Any:
        return 60 / mpf(self.rpm)

    @cached_property
    def angles(self) -> list[Any]:
        a, b = mpf("1.050328174371336"), mpf("1.22173047639603")
        return [mpf(0), a, b, mp.pi - b, mp.pi - a, mp.pi]

    @cached_property
    def arcs(self) -> list[Any]:
        """kappa, psi, rho and direction; or the lift of a dwell."""
        flank = (mpf("0.45"), -mp.pi / 2, mpf("0.85"))
        nose = (mpf("0.40393320723821"), 8 * mp.pi / 9, mpf("0.15"))
        top, base = mpf("0.55393320723821") - OFFSET, mpf("0.40") - OFFSET
        return [(*flank, 1), (*nose, 1), top, (*nose, -1), (*flank, -1), base]

    def corner(self, n: int) -> Any:
        """Time of the n-th corner."""
        return self.angles[n % 6] / self.omega + n // 6 * self.period

    def lift(self, t: Any, n: int) -> tuple[Any, Any, Any]:
        """c, c', c'' by the arc that begins at the n-th corner."""
        arc = self.arcs[n % 6]
        if not isinstance(arc, tuple):
            return arc, mpf(0), mpf(0)
        kappa, psi, rho, direction = arc
        beta = self.omega * (t - n // 6 * self.period) + mp.pi / 2
        angle = (beta if direction > 0 else 2 * mp.pi - beta) - psi
        x, y = (kappa * part for part in mp.cos_sin(angle))
        root = mp.sqrt(rho * rho - y * y)
        second = -x - (x * x - y * y) / root - (x * y) ** 2 / root**3
        return x + root - OFFSET, direction * self.omega * (-y - x * y / root), self.omega**2 * second

    def parting(self, t: Any, n: int) -> Any:
        """Gap acceleration of the follower that rests on the cam: it opens where this turns positive."""
        c, _, ddc = self.lift(t, n)
        return -K / M * c - ddc


@dataclass
class Flight:
    """A flight that leaves the cam at t0, on its n-th arc, with the gap velocity u."""

    cam: Cam
    t0: Any
    n: int
    u: Any
    turned: tuple[Any, Any, Any] = field(default=(mpf(0), mpf(0), mpf(0)))

    @cached_property
    def start(self) -> tuple[Any, Any]:
        c, dc, _ = self.cam.lift(self.t0, self.n)
        return c, dc + self.u

    @cached_property
    def rate(self) -> Any:
        return mp.sqrt(K / M)

    def gap(self, tau: Any, n: int) -> tuple[Any, Any, Any]:
        """Gap, its velocity and acceleration above the n-th arc."""
        (y0, v0), w = self.start, self.rate
        cosine, sine = mp.cos_sin(w * tau)
        y, v = y0 * cosine + v0 / w * sine, v0 * cosine - w * y0 * sine
        c, dc, ddc = self.cam.lift(self.t0 + tau, n)
        corner, g, u = self.turned
        return y - c + g + u * (tau - corner), v - dc + u, -w * w * y - ddc

    def pass_corner(self, tau: Any, n: int) -> None:
        """Onto the n-th arc, with the gap and the velocity at hand."""
        g, u, _ = self.gap(tau, n - 1)
        self.turned = (tau, mpf(0), mpf(0))
        g_new, u_new, _ = self.gap(tau, n)
        self.turned = (tau, g - g_new, u - u_new)

    def end(self, limit: Any) -> tuple[Any, int, Any] | None:
        """Time, arc and gap velocity of the next impact; None if there is none before `limit`."""
        alpha = self.gap(mpf(0), self.n)[2]
        hop = 2 * self.u / -alpha if alpha < 0 and self.u > 0 else mpf(10) ** -7
        if self.u == 0 and alpha > SMOOTH:
            hop = min(hop, alpha / 10**6)  # the acceleration does not fall faster than that
        n, a, rising = self.n, mpf(0), False
        step = hop / (64 if hop > REGULAR else 1.9)  # beyond the end, for Newton overshoots
        while self.t0 + a < limit:
            corner = self.cam.corner(n + 1) - self.t0
            b = min(a + step, corner)
            g, u, _ = self.gap(b, n)
            low = b if g <= 0 else None
            if low is None and rising and u > 0:  # it has turned in between
                low = root(lambda x, n=n: self.gap(x, n)[1:], a, b)
                low = low if self.gap(low, n)[0] <= 0 else None
            if low is not None:
                tau = root(lambda x, n=n: self.gap(x, n), a if a > 0 else low / 2**20, low)
                return self.t0 + tau, n, self.gap(tau, n)[1]
            if b == corner:
                n += 1
                self.pass_corner(b, n)
            a, rising = b, u < 0
            step = min(max(step, b / 12), self.cam.period / 300)
        return None


def root(f: Any, a: Any, b: Any) -> Any:
    """Root of f(x)[0] between a and b, by Newton's method with the slope f(x)[1], safeguarded by bisection."""
    positive, x = f(a)[0] > 0, (a + b) / 2
    for _ in range(500):
        value, slope = f(x)[:2]
        if (value > 0) == positive:
            a = x
        else:
            b = x
        new = x - value / slope if slope != 0 else a
        if abs(new - x) > EXACT * abs(x) and not a < new < b:
            new = (a + b) / 2
        if abs(new - x) <= EXACT * abs(x):
            return new
        x = new
    raise ArithmeticError(f"no root between {a} and {b}")


def parts(cam: Cam, t: Any, n: int) -> Any:
    """Where the follower that rests on the cam from t on leaves the n-th arc; None if it does not."""
    if cam.parting(t, n) > 0:
        return t
    end, pieces = cam.corner(n + 1), 64
    a = t
    for k in range(1, pieces + 1 if isinstance(cam.arcs[n % 6], tuple) else 1):
        b = t + (end - t) * k / pieces
        if cam.parting(b, n) > 0:
            while b - a > EXACT * b:
                middle = (a + b) / 2
                a, b = (a, middle) if cam.parting(middle, n) > 0 else (middle, b)
            return b
        a = b
    return None


def sequence(cam: Cam, t: Any, n: int, limit: Any) -> tuple[Sequence, int]:
    """The sequence that begins with the release at t, and the arc on which it ends."""
    release, u, impacts = t, mpf(0), []
    while True:
        hit = Flight(cam, t, n, u).end(limit)
        if hit is None:
            return (release, impacts, None), n
        t, n, before = hit
        impacts.append((t, before))
        u, alpha = -R * before, cam.parting(t, n)
        if alpha < 0 and 2 * u < -alpha * SHORTEST:
            return (release, impacts, t + 2 * u / (-alpha * (1 - R))), n


@cache
def sequences(rpm: Any, turns: int = 1, most: int = 100) -> tuple[Cam, list[Sequence]]:
    """The first sequences of the follower that rests on the cam at the start of the lift."""
    with mp.workdps(DIGITS):
        cam, found = Cam(rpm), []
        t, n, limit = mpf(0), 0, turns * 60 / mpf(rpm)
        while t < limit and len(found) < most:
            release = parts(cam, t, n)
            if release is None:
                n += 1
                t = cam.corner(n)
                continue
            made, n = sequence(cam, release, n, limit)
            found.append(made)
            t = limit if made[2] is None else made[2]
        return cam, found
