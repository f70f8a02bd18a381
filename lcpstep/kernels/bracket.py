"""A root between two places, for whoever can evaluate the function: steps towards it, safeguarded by bisection.

The caller keeps function and tolerance, and asks where to look:

    bracket.begin(a, b, positive, x)        or bracket.span(a, f_a, b, f_b)
    while bracket.seek(small):
        bracket.take(f, step)               of the function at bracket.x, and from there
    bracket.x                               is the root;  bracket.a, bracket.b  lie on its two sides

A step is Newton's, Halley's or along a chord; 0 is none. One that leads out of the bracket, as where the function
turns within it, or that is longer than half the one before, is replaced by a halving, after which any step may
follow; so is one that is small but leads out: the root is not near because the function is. The last step, below
`small`, is taken without another look.
Where little steps do not shrink any more the function is lost in rounding, and x is as good a root as any.
Source: W. Press et al., Numerical Recipes, section 9.4.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import abs, inf, max, min

MOST = 200  # places looked at
LITTLE = 1e-9  # of x: steps no longer than this shrink, unless the function is lost in rounding


class Bracket:
    """Two places between which a function changes its sign, and the place to look at.

    a, b         the ends;  positive  whether the function is so at a
    x            the place to look at; in the end the root
    step         from x to where the function is thought to be zero, once it is known there
    seen, value  the place before, and the function there
    moved        by how much x has moved last
    """

    def __init__(self) -> None:
        self.begin(0.0, 0.0, True, 0.0)

    def begin(self, a: float, b: float, positive: bool, x: float) -> None:
        """Seek between a and b, and look at x first; in the middle where x does not lie between them."""
        self.a, self.b, self.positive = a, b, positive
        self.x = x if a <= x <= b else 0.5 * (a + b)
        self.seen = self.x
        self.f = self.value = self.step = 0.0
        self.moved, self.looks, self.known = inf, 0, False

    def span(self, a: float, f_a: float, b: float, f_b: float) -> None:
        """Seek between a and b, where the function is known: first where its chord is zero; f_a f_b <= 0."""
        self.begin(a, b, f_a > 0.0, a)
        self.x, self.f, self.moved, self.known = a, f_a, b - a, True
        if abs(f_b) < abs(f_a):
            self.x, self.f = b, f_b
        if self.f == 0.0:
            self.a = self.b = self.x
        else:
            self.step = -self.f / ((f_b - f_a) / (b - a))

    def seek(self, small: float) -> bool:
        """Move x to the next place to look at; False where it is the root, to the tolerance `small`."""
        if not self.known:
            self.looks = 1
            return True
        if self.arrive(small) or self.b - self.a <= small or self.looks >= MOST:
            return False
        new, halved = self.x + self.step, False
        if not self.a < new < self.b or abs(self.step) > 0.5 * abs(self.moved):
            inwards = self.step != 0.0 and (self.step > 0.0) == (self.x == self.a)
            if inwards and max(abs(self.step), abs(self.moved)) <= LITTLE * abs(self.x):
                return False
            new, halved = 0.5 * (self.a + self.b), True
            if not self.a < new < self.b:
                return False
        self.seen, self.value, self.moved, self.x = self.x, self.f, inf if halved else new - self.x, new
        self.looks += 1
        return True

    def arrive(self, small: float) -> bool:
        """Whether the step from x leads inwards and is no longer than `small`; if so it is taken."""
        inwards = self.step > 0.0 if self.x == self.a else self.step < 0.0
        if not inwards or abs(self.step) > small:
            return False
        self.x = min(max(self.x + self.step, self.a), self.b)
        return True

    def take(self, f: float, step: float) -> None:
        """The function at x, and the step from there to its root: one end moves to x."""
        self.f, self.step, self.known = f, step, True
        if f == 0.0:
            self.a = self.b = self.x
        elif (f > 0.0) == self.positive:
            self.a = self.x
        else:
            self.b = self.x

    def halve(self, as_at_a: bool) -> None:
        """Of the function at x no more than whether its sign is that at a: seek in the middle of what is left."""
        self.take(1.0 if as_at_a == self.positive else -1.0, 0.0)

    def newton(self, f: float, slope: float) -> None:
        """The same with Newton's step: f over its slope."""
        self.take(f, -f / slope if slope != 0.0 else 0.0)

    def chord(self, f: float) -> None:
        """The same with the step along the chord to the place before, if there is one."""
        change = f - self.value
        self.take(f, -f * (self.x - self.seen) / change if change != 0.0 else 0.0)
