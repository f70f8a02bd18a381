"""Numbers with first derivatives, and mixed second ones, in ball arithmetic.

A jet is a number of the algebra with generators e_1 .. e_k, each of square zero:

    x = sum over subsets S of {1 .. k} of x_S e_S,     (x y)_S = sum over T in S of x_T y_(S - T)

Where a function is fed with a + e_1 b, it answers f(a) + e_1 f'(a) b; with e_1 b + e_2 c, e_1 e_2 bears f''(a) b c.
Subsets are written as bits. Source: J. Fike, J. Alonso, The development of hyper-dual numbers for exact
second-derivative calculations, AIAA 2011-886.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_mat, arb_series

PARTS = {
    size: [(S, T, S & ~T) for S in range(size) for T in range(size) if T & ~S == 0] for size in (1, 2, 4)
}


class Jet:
    """One number; `c` are its parts, 1, 2 or 4 balls, by the bits of their generators."""

    __slots__ = ("c",)

    def __init__(self, parts: Sequence[Any]) -> None:
        self.c = [arb(x) for x in parts]

    @classmethod
    def constant(cls, x: Any, size: int) -> Jet:
        """A number that depends on nothing."""
        return cls([x] + [0] * (size - 1))

    def like(self, x: Any) -> Jet:
        """The other operand as a jet."""
        return x if isinstance(x, Jet) else Jet.constant(x, len(self.c))

    def __add__(self, other: Any) -> Jet:
        return Jet([a + b for a, b in zip(self.c, self.like(other).c, strict=True)])

    def __sub__(self, other: Any) -> Jet:
        return Jet([a - b for a, b in zip(self.c, self.like(other).c, strict=True)])

    def __neg__(self) -> Jet:
        return Jet([-a for a in self.c])

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet([a * other for a in self.c])
        result = [arb(0)] * len(self.c)
        for S, T, rest in PARTS[len(self.c)]:
            result[S] += self.c[T] * other.c[rest]
        return Jet(result)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> Jet:
        return self.like(other) - self

    def key(self) -> tuple[Any, ...]:
        """The parts to the last bit, as a key of a dictionary; those without bounds are all alike."""
        return tuple(x.mid().man_exp() + x.rad().man_exp() if x.is_finite() else None for x in self.c)

    def inverse(self) -> Jet:
        """1/x."""
        return self.through((1 / self.series()).coeffs())

    def series(self, more: int = 0) -> arb_series:
        """The value as the variable of a power series, with `more` terms than `through` needs."""
        return arb_series([self.c[0], 1], prec=self.length + more)

    @property
    def length(self) -> int:
        """How many coefficients of a power series reach this jet."""
        return len(self.c).bit_length()

    def through(self, coefficients: Sequence[Any]) -> Jet:
        """f(x) from the power series of f at the value."""
        nilpotent = Jet([0, *self.c[1:]])
        result = Jet.constant(0, len(self.c))
        for f in reversed(list(coefficients)[: self.length]):
            result = result * nilpotent + f
        return result


def derivative(coefficients: Sequence[Any]) -> list[Any]:
    """The power series of f' from that of f."""
    return [j * f for j, f in enumerate(coefficients)][1:]


def exponential(terms: Sequence[tuple[Jet, arb_mat]]) -> list[arb_mat]:
    """The parts of exp(sum of x X) for jets x and constant matrices X; zero for generators that none of x has."""
    size, n = len(terms[0][0].c), terms[0][1].nrows()
    bits = [1 << k for k in range(size.bit_length() - 1)]
    acting = [
        bit for bit in bits if not all(x.c[S].is_zero() for x, _ in terms for S in range(size) if S & bit)
    ]
    subsets = [sum(bit for k, bit in enumerate(acting) if S >> k & 1) for S in range(1 << len(acting))]
    parts = _exponential([sum((X * x.c[S] for x, X in terms), arb_mat(n, n)) for S in subsets])
    return [parts[subsets.index(S)] if S in subsets else arb_mat(n, n) for S in range(size)]


def _exponential(parts: Sequence[arb_mat]) -> list[arb_mat]:
    """The parts of the exponential of a matrix of jets.

    Multiplication by a jet is a triangular matrix over its parts: the exponential of the whole has the parts sought
    in its first column of blocks.
    """
    size, n = len(parts), parts[0].nrows()
    if size == 1:
        return [parts[0].exp()]
    whole = arb_mat(size * n, size * n)
    for S, T, rest in PARTS[size]:
        for i in range(n):
            for j in range(n):
                whole[S * n + i, T * n + j] = parts[rest][i, j]
    E = whole.exp()
    return [arb_mat([[E[S * n + i, j] for j in range(n)] for i in range(n)]) for S in range(size)]


def applied(E: Sequence[arb_mat], x: Sequence[Jet]) -> list[Jet]:
    """The matrix with the parts E times a vector of jets."""
    size, n = len(E), len(x)
    result = [arb_mat(n, 1) for _ in range(size)]
    vectors = [arb_mat(n, 1, [component.c[S] for component in x]) for S in range(size)]
    for S, T, rest in PARTS[size]:
        result[S] += E[T] * vectors[rest]
    return [Jet([part[i, 0] for part in result]) for i in range(n)]
