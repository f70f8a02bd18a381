"""That a flight touches nothing: gaps enclosed over intervals that cover it without a hole.

About the middle of an interval of half-width h a gap is g(m) + g'(m) s + g''(xi) s^2/2, |s| <= h. Its second
derivative is enclosed by the power series of the motion, z_k = A z_(k-1)/k, whose rest from p on is at most
|A^p z| h^(p-2)/(p-2)! e^(|A| h) in the maximum norm, and by that of the obstacle's formula over the whole ball.
Intervals are halved until g > 0. At an impact g is zero: there g' is shown to have one sign up to the impact, so
that g > 0 beside it.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, arb_mat, arb_series

from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.formulas import Formulas
from lcpstep.analysis.proofs.obstacles import Stretch, above, below, covering, stretches

ORDER = 14  # of the power series
HALVINGS = 40  # of an interval
PIECES = 4000  # of one flight that are looked at


@dataclass(frozen=True)
class Flight:
    """Free motion from the phase `start` with z there, to the phase `end`.

    A : dz/dtheta = A z;  opened, struck : the contacts that are left at its start and met at its end
    """

    formulas: Formulas
    A: arb_mat
    start: arb
    z: arb_mat
    end: arb
    opened: int
    struck: int

    def show_clear(self) -> None:
        """NotProved unless all gaps are positive on the way."""
        for c in range(len(self.formulas.contacts)):
            self._show_clear(c)

    def _show_clear(self, c: int) -> None:
        obstacle = self.formulas.contacts[c].obstacle
        low, high = below(self.start), above(self.end)
        ways = stretches(obstacle, low, high)
        if c == self.opened:  # at a corner the obstacle that is left is the one after it
            ways = [way for way in ways if way.end is None or way.end > self.start]
        if c == self.struck:  # and the one that is met is the one before
            ways = [way for way in ways if way.start is None or way.start < self.end]
        if c == self.opened:
            low = self._leaving(c, ways[0], low, high)
        if c == self.struck:
            high = self._coming(c, ways[-1], low, high)
        looked = 0
        for way in ways:
            todo = [(*covering(way, low, high), 0)]
            while todo:
                a, b, depth = todo.pop()
                if not a <= b:
                    continue
                looked += 1
                middle, gap, _ = self.gap(c, way, a, b)
                if gap > 0:
                    continue
                if middle < 0 or depth == HALVINGS or looked > PIECES:
                    raise NotProved(self._touched(c, a, b, middle))
                half = 0.5 * (a + b)
                todo += [(half, b, depth + 1), (a, half, depth + 1)]

    def _leaving(self, c: int, way: Stretch, low: float, high: float) -> float:
        """Up to where the gap grows from the impact at the start on."""
        end = covering(way, low, high)[1]
        for _ in range(HALVINGS):
            if self.gap(c, way, low, end)[2] > 0:
                return end
            end = low + 0.5 * (end - low)
        raise NotProved(f"grazing: contact {c} is not shown to open after its impact at {self._time(low)}")

    def _coming(self, c: int, way: Stretch, low: float, high: float) -> float:
        """From where on the gap falls up to the impact at the end."""
        start = covering(way, low, high)[0]
        for _ in range(HALVINGS):
            if self.gap(c, way, start, high)[2] < 0:
                return start
            start = high - 0.5 * (high - start)
        raise NotProved(f"grazing: contact {c} is not shown to close before its impact at {self._time(high)}")

    def gap(self, c: int, way: Stretch, a: float, b: float) -> tuple[arb, arb, arb]:
        """The gap half way from the phase a to b; the gap, and its rate dg/dtheta, enclosed over all of them."""
        contact, n = self.formulas.contacts[c], self.formulas.n
        middle = arb(0.5 * (a + b))
        h = (arb(b) - middle).max(middle - arb(a))
        ball = arb(middle, h.upper())
        z = ((middle - self.start) * self.A).exp() * self.z
        first, second = self.A * z, self._second(z, h)
        y = [
            sum((contact.G[i] * x[i + at, 0] for i in range(n)), arb(0))
            for x, at in ((z, 0), (first, 0), (second, 0))
        ]
        here = _coefficients(way, middle, 2)
        over = _coefficients(way, ball, 3)
        s = ball - middle
        curve = y[2] - 2 * over[2]
        rate = y[1] - here[1]
        gap = y[0] - here[0]
        return gap, gap + s * rate + s * s * curve / 2, rate + s * curve

    def _second(self, z: arb_mat, h: arb) -> arb_mat:
        """d2z/dtheta2 over half-width h about z."""
        s = arb(0, h.upper())
        term, total, power = z, arb_mat(z.nrows(), 1), arb(1)
        for k in range(1, ORDER):
            term = self.A * term * (arb(1) / k)
            if k >= 2:
                total += term * (power * (k * (k - 1)))
                power *= s
        last = _norm(self.A * term) * (ORDER - 1) * h ** (ORDER - 2) * (_norm(self.A) * h).exp()
        rest = arb(0, last.upper())
        return arb_mat(z.nrows(), 1, [total[i, 0] + rest for i in range(z.nrows())])

    def _touched(self, c: int, a: float, b: float, gap: arb) -> str:
        at = self._time(0.5 * (a + b))
        if gap < 0:
            return f"the flight passes through contact {c} at {at}: the gap is {float(gap):.3g} there"
        for impact, struck in ((self.start, self.opened), (self.end, self.struck)):
            if c != struck and not (arb(b) < impact or arb(a) > impact):
                return f"contact {c} is not shown to be open while contact {struck} is struck at {at}: both at once"
        return f"contact {c} is touched, or nearly, at {at}: the gap is not shown to be positive"

    def _time(self, theta: float) -> str:
        return f"t = {theta / float(self.formulas.omega):.9g} s"


def _coefficients(way: Stretch, theta: arb, n: int) -> list[arb]:
    """Of the obstacle's power series about a phase."""
    found = list(way.formula(arb_series([theta, 1], prec=n)).coeffs())
    return found + [arb(0)] * (n - len(found))


def _norm(A: arb_mat) -> arb:
    """Maximum norm: the largest sum of moduli along a row."""
    largest = arb(0)
    for i in range(A.nrows()):
        largest = largest.max(sum((abs(A[i, j]) for j in range(A.ncols())), arb(0)))
    return largest
