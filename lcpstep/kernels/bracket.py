"""A root between two places, for whoever can evaluate the function there: Newton's method safeguarded by bisection.

The caller keeps function and tolerance and asks where to look:

    bracket.begin(a, b, positive, x)        or bracket.span(a, f_a, b, f_b)
    while bracket.seek(small):
        bracket.take(f, slope)              of the function at bracket.x
    bracket.x                               is the root

The slope may be that of a chord; without one (0) the bracket is halved. A step that leaves the bracket, or is longer
than half the one before, is replaced by a halving. The last step, which is below `small`, is taken without another
look. Source: W. Press et al., Numerical Recipes, section 9.4.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.pointers import abs, inf, max, min, nan

MOST = 200  # places looked at


class Bracket:
    """Two places between which a function changes its sign, and the place to look at.

    a, b         the ends;  positive  whether the function is so at a
    x            the place to look at; in the end the root
    f, slope     of the function at x, once taken
    seen, value  the place before, and the function there
    step         by which x has moved last
    """

    def __init__(self) -> None:
        self.begin(0.0, 0.0, True, 0.0)

    def begin(self, a: float, b: float, positive: bool, x: float) -> None:
        """Seek between a and b, and look at x first."""
        self.a, self.b, self.positive, self.x = a, b, positive, x
        self.f, self.slope, self.seen, self.value, self.step = nan, 0.0, nan, nan, inf
        self.looks, self.known = 0, False

    def span(self, a: float, f_a: float, b: float, f_b: float) -> None:
        """Seek between a and b, where the function is known: first where its chord is zero; f_a f_b <= 0."""
        self.begin(a, b, f_a > 0.0, a)
        self.f, self.slope, self.step, self.known = f_a, (f_b - f_a) / (b - a), b - a, True
        if abs(f_b) < abs(f_a):
            self.x, self.f = b, f_b

    def seek(self, small: float) -> bool:
        """Move x to the next place to look at; False where it is the root, to the tolerance `small`."""
        if self.known:
            if self.f == 0.0 or self.b - self.a <= small or self.looks >= MOST:
                return False
            step = -self.f / self.slope if self.slope != 0.0 else inf
            if abs(step) <= small:
                self.x = min(max(self.x + step, self.a), self.b)
                return False
            new = self.x + step
            if not self.a < new < self.b or abs(step) > 0.5 * abs(self.step):
                new = 0.5 * (self.a + self.b)
                if not self.a < new < self.b:
                    return False
            self.seen, self.value = self.x, self.f
            self.step, self.x = new - self.x, new
        self.looks += 1
        return True

    def take(self, f: float, slope: float) -> None:
        """The function and its slope at x: one end moves there."""
        self.f, self.slope, self.known = f, slope, True
        if f == 0.0:
            self.a = self.b = self.x
        elif (f > 0.0) == self.positive:
            self.a = self.x
        else:
            self.b = self.x

    def chord(self, f: float) -> float:
        """Slope of the chord from the place before to f at x."""
        return (f - self.value) / (self.x - self.seen)
