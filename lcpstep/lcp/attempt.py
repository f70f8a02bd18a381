"""An attempt at the part of a saddle point problem (see `saddle`): what x and z leave of it, and what that is worth.

defect_x = r + G^T z - A x,      w = G x + c,      each with the size of the terms that it is a sum of
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, small_numbers
from lcpstep.lcp.newton import STRICT
from lcpstep.lcp.part import Part
from lcpstep.lcp.sparse_rows import SparseRows, add_products, add_sizes
from lcpstep.lcp.status import NOTHING, ROUNDING
from lcpstep.pointers import Doubles, Indices, abs, inf, max
from lcpstep.rows import copy, largest_entry


class Attempt:
    """Numbers of the coordinates and rows of a part, one after another.

    r, c, c_size         of the problem
    x, z, w              the attempt
    size_x, size_w       of the terms of defect_x and w
    defect               in the order of the band: of x; of w, with its sign changed, on the rows chosen
    chosen               1 for each row whose w is to be zero, else 0
    diagonal, mobility   sizes of the diagonals of A and of W = G A^-1 G^T
    left, noise          of x and w, for a while
    scale                of w, at the first change of x: x may be nothing but rounding in the end
    residual             relative, of an attempt that has been judged

    Parameters
    ----------
    diagonal : (n,)   of A
    mobility : (m,)   sizes of the diagonal of W
    """

    def __init__(self, part: Part, diagonal: Any, mobility: Any) -> None:
        n, m = len(diagonal), len(mobility)
        self.part, self.scale, self.residual = part, 0.0, 0.0
        self.whole = diagonal, mobility
        self.all_diagonal, self.all_mobility = doubles(diagonal), doubles(mobility)
        of_x = dict.fromkeys(("r", "x", "size_x", "left", "diagonal"), n)
        of_w = dict.fromkeys(("c", "c_size", "z", "w", "size_w", "noise", "mobility"), m)
        self.arrays = {name: np.zeros(size) for name, size in {**of_x, **of_w, "defect": n + m}.items()}
        self.marks = np.zeros(m, dtype=np.uint8)
        self.r, self.x, self.size_x = (
            doubles(self.arrays["r"]),
            doubles(self.arrays["x"]),
            doubles(self.arrays["size_x"]),
        )
        self.left, self.diagonal = doubles(self.arrays["left"]), doubles(self.arrays["diagonal"])
        self.c, self.c_size = doubles(self.arrays["c"]), doubles(self.arrays["c_size"])
        self.z, self.w, self.size_w = (
            doubles(self.arrays["z"]),
            doubles(self.arrays["w"]),
            doubles(self.arrays["size_w"]),
        )
        self.noise = doubles(self.arrays["noise"])
        self.mobility, self.defect = doubles(self.arrays["mobility"]), doubles(self.arrays["defect"])
        self.chosen = small_numbers(self.marks)

    @cython.ccall
    def pose(self, r: Any, c: Any, c_size: Any) -> None:
        """Take over what the part has of a whole problem, and of what does not change from one to the next."""
        part = self.part
        gather(self.r, doubles(r), part.coordinates, part.n)
        gather(self.diagonal, self.all_diagonal, part.coordinates, part.n)
        gather(self.c, doubles(c), part.rows, part.m)
        gather(self.c_size, doubles(c_size), part.rows, part.m)
        gather(self.mobility, self.all_mobility, part.rows, part.m)

    @cython.ccall
    def begin(self) -> None:
        """From x = 0, and z as it is on the rows chosen."""
        for j in range(self.part.n):
            self.x[j] = 0.0
        for i in range(self.part.m):
            if not self.chosen[i]:
                self.z[i] = 0.0
        measure(self)
        self.scale = 0.0

    @cython.ccall
    def change(self, by: Any) -> float:
        """Add these changes of x and z, in the order of the band; the relative error of A x - r - G^T z and of w."""
        return changed(self, doubles(by))

    @cython.ccall
    def put(self, x: Any, z: Any) -> float:
        """Defects and sizes at these x and z; the largest size of w, with what the terms of x may move it by."""
        copy(self.x, doubles(x), self.part.n)
        copy(self.z, doubles(z), self.part.m)
        measure(self)
        return largest_size(self)

    @cython.ccall
    def judge(self) -> None:
        """The residual; what the rounding of x makes of w counts as zero."""
        judge(self)

    @cython.ccall
    def exchange(self) -> int:
        """Rows with a negative z are chosen no more, and those with a negative w are; how many have changed."""
        return exchange(self)


def finite(x: Doubles, n: int) -> bool:
    """Whether no entry is nan or infinite."""
    total = 0.0
    for i in range(n):
        total += x[i] - x[i]
    return total == 0.0


def gather(target: Doubles, source: Doubles, where: Indices, n: int) -> None:
    """The numbers at n places of a vector."""
    for k in range(n):
        target[k] = source[where[k]]


def changed(a: Attempt, by: Doubles) -> float:
    """See `Attempt.change`."""
    error = 0.0
    for j in range(a.part.n):
        a.x[j] += by[a.part.x_place[j]]
    for i in range(a.part.m):
        a.z[i] += by[a.part.w_place[i]]
    measure(a)
    if a.scale == 0.0:
        a.scale = largest_entry(a.size_w, a.part.m)
        a.scale = a.scale if a.scale > 0.0 else 1.0
    for i in range(a.part.m):
        if a.chosen[i]:
            error = max(error, abs(a.w[i]) / a.scale)
    return max(error, error_of_x(a))


def error_of_x(a: Attempt) -> float:
    """The largest defect of a coordinate, next to the size of its terms."""
    error = 0.0
    for j in range(a.part.n):
        left = abs(a.defect[a.part.x_place[j]])
        error = max(error, left / a.size_x[j] if a.size_x[j] > 0.0 else left)
    return error


def measure(a: Attempt) -> None:
    """See `Attempt.put`."""
    for j in range(a.part.n):
        a.left[j], a.size_x[j] = a.r[j], abs(a.r[j])
    add_products(a.part.G_T, a.part.n, 1.0, a.z, a.left)
    add_products(a.part.A, a.part.n, -1.0, a.x, a.left)
    add_sizes(a.part.A, a.part.n, a.x, a.size_x)
    add_sizes(a.part.G_T, a.part.n, a.z, a.size_x)
    least = NOTHING * largest_entry(a.size_x, a.part.n)  # tails of a wave end in denormal numbers
    for j in range(a.part.n):
        a.defect[a.part.x_place[j]] = a.left[j]
        a.size_x[j] = max(a.size_x[j], least)
    copy(a.w, a.c, a.part.m)
    copy(a.size_w, a.c_size, a.part.m)
    add_products(a.part.G, a.part.m, 1.0, a.x, a.w)
    add_sizes(a.part.G, a.part.m, a.x, a.size_w)
    for i in range(a.part.m):
        a.defect[a.part.w_place[i]] = -a.w[i] if a.chosen[i] else 0.0


def judge(a: Attempt) -> None:
    """See `Attempt.judge`."""
    if not (finite(a.size_x, a.part.n) and finite(a.size_w, a.part.m) and finite(a.w, a.part.m)):
        a.residual = inf
        return
    feel(a)
    a.residual = error_of_x(a)
    for i in range(a.part.m):
        left = max(abs(a.w[i]) - ROUNDING * a.noise[i], 0.0)
        a.w[i] = left if a.w[i] > 0.0 else -left
        a.size_w[i] = a.size_w[i] if a.size_w[i] > 0.0 else 1.0
        a.residual = max(a.residual, violation(a, i))


def feel(a: Attempt) -> None:
    """What the terms of its row may move each coordinate by, and that each w."""
    for j in range(a.part.n):
        a.left[j] = a.size_x[j] / a.diagonal[j]
    for i in range(a.part.m):
        a.noise[i] = 0.0
    add_sizes(a.part.G, a.part.m, a.left, a.noise)


def largest_size(a: Attempt) -> float:
    """See `Attempt.put`."""
    most = 0.0
    feel(a)
    for i in range(a.part.m):
        most = max(most, a.size_w[i] + a.noise[i])
    return most


def violation(a: Attempt, i: int) -> float:
    """How far 0 <= z complementary to w >= 0 is missed, relative to the terms that each is felt among."""
    relative, felt = a.w[i] / a.size_w[i], share(a, a.part.G, i)
    if a.z[i] >= 0.0 and abs(relative) < felt:
        felt = abs(relative)
    return max(felt, -relative)


def share(a: Attempt, G: SparseRows, i: int) -> float:
    """Largest part that |z| has in a row of A x = r + G^T z."""
    most = 0.0
    for e in range(G.begin[i], G.begin[i + 1]):
        if a.size_x[G.column[e]] > 0.0:
            most = max(most, abs(G.value[e]) / a.size_x[G.column[e]])
    if G.begin[i] == G.begin[i + 1]:
        most = 1.0
    return most * abs(a.z[i])


def exchange(a: Attempt) -> int:
    """See `Attempt.exchange`."""
    wrong = 0
    for i in range(a.part.m):
        if a.chosen[i]:
            if a.z[i] < 0.0 and share(a, a.part.G, i) > STRICT:
                a.chosen[i] = 0
                wrong += 1
        elif a.w[i] < -STRICT * a.size_w[i]:
            a.chosen[i] = 1
            wrong += 1
    return wrong
