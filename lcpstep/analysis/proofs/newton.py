"""Newton's method in ball arithmetic: a zero of F that is there, and the only one near (Krawczyk's operator).

    K(X) = m - Y F(m) + (1 - Y F'(X)) (X - m),     m the midpoint of the box X, Y about F'(m)^-1

If K(X) lies in the interior of X, F has one zero in X, and it lies in K(X). Source: R. Krawczyk, Computing 4 (1969);
R. Moore, R. Kearfott, M. Cloud, Introduction to Interval Analysis (SIAM 2009), section 8.2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from flint import arb, arb_mat, ctx

from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.jets import Jet

Equations = Callable[[Sequence[Jet]], Sequence[Jet]]
ITERATIONS = 60  # of Newton's method, and of Krawczyk's
LARGEST, SHRINK = -4, 3  # exponents of two: of the first radius that is tried, and from one to the next
LESS = 0.99  # a box that shrinks by less than this has become as small as it can


@dataclass(frozen=True)
class Zero:
    """A zero: `balls` enclose it; it is the only one within `radii` of them, which are `radius` times the scales."""

    balls: list[arb]
    radii: list[arb]
    radius: arb


def evaluate(F: Equations, x: Sequence[arb]) -> arb_mat:
    """F(x), a column."""
    return arb_mat(len(x), 1, [y.c[0] for y in F([Jet([z]) for z in x])])


def jacobian(F: Equations, x: Sequence[arb]) -> arb_mat:
    """F'(x), column by column."""
    n = len(x)
    columns = [[y.c[1] for y in F([Jet([z, int(i == j)]) for i, z in enumerate(x)])] for j in range(n)]
    return arb_mat([[columns[j][i] for j in range(n)] for i in range(n)])


def improved(F: Equations, x: Sequence[arb]) -> list[arb]:
    """A zero by Newton's method on midpoints, to the working precision; nothing is proved of it."""
    least = arb(2) ** (8 - ctx.prec)
    for _ in range(ITERATIONS):
        try:
            step = jacobian(F, x).mid().solve(evaluate(F, x).mid())
        except ZeroDivisionError:
            raise NotProved(
                "the equations of the orbit are singular near it: a fold, a grazing contact, or no orbit"
            ) from None
        x = [(z - step[i, 0]).mid() for i, z in enumerate(x)]
        if not all(z.is_finite() for z in x):
            break
        if all(abs(step[i, 0]) <= least * (1 + abs(z)) for i, z in enumerate(x)):
            return x
    raise NotProved("Newton's method finds no orbit near the one given")


def zero(
    F: Equations, x: Sequence[arb], scale: Sequence[arb], allowed: Callable[[Sequence[arb]], bool]
) -> Zero:
    """The zero next to x, proved.

    Parameters
    ----------
    F : as many equations as unknowns
    x : about the zero, to the working precision
    scale : what a radius of one means for each unknown
    allowed : whether the equations are valid throughout a box

    Raises
    ------
    NotProved   no radius could be found for which it holds
    """
    try:
        Y = jacobian(F, x).mid().inv().mid()
    except ZeroDivisionError:
        raise NotProved(
            "the equations of the orbit are singular there: a fold, or a grazing contact"
        ) from None
    shift = Y * evaluate(F, x)
    for exponent in range(LARGEST, -ctx.prec // 2, -SHRINK):
        radii = [s * arb(2) ** exponent for s in scale]
        box = _box(x, radii)
        if not allowed(box):
            continue
        image = _krawczyk(F, x, Y, shift, box)
        if all(b.contains_interior(k) for b, k in zip(box, image, strict=True)):
            balls = _refined(F, Y, image)
            left = [(r - abs(b - z)) / s for r, b, z, s in zip(radii, balls, x, scale, strict=True)]
            radius = min((r.lower() for r in left), key=float)  # about the zero, and not about x
            return Zero(balls, [s * radius for s in scale], radius)
    raise NotProved(
        "no neighbourhood was found, however small, in which there must be an orbit: too near to a fold or to grazing"
    )


def _box(x: Sequence[arb], radii: Sequence[arb]) -> list[arb]:
    return [arb(m, r.upper()) for m, r in zip(x, radii, strict=True)]


def _krawczyk(F: Equations, m: Sequence[arb], Y: arb_mat, shift: arb_mat, box: Sequence[arb]) -> list[arb]:
    n = len(m)
    rest = arb_mat(n, n, [int(i == j) for i in range(n) for j in range(n)]) - Y * jacobian(F, box)
    moved = rest * arb_mat(n, 1, [b - z for b, z in zip(box, m, strict=True)])
    return [m[i] - shift[i, 0] + moved[i, 0] for i in range(n)]


def _refined(F: Equations, Y: arb_mat, box: list[arb]) -> list[arb]:
    """The operator again and again, while the box becomes smaller."""
    for _ in range(ITERATIONS):
        m = [b.mid() for b in box]
        image = _krawczyk(F, m, Y, Y * evaluate(F, m), box)
        smaller = [b.intersection(k) for b, k in zip(box, image, strict=True)]
        if not any(s.rad() < LESS * b.rad() for s, b in zip(smaller, box, strict=True)):
            return smaller
        box = smaller
    return box
