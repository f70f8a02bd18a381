"""The part of a saddle point problem (see `saddle`) that rows with w < 0 reach, and its matrices in one piece.

Rows and coordinates that neither A nor an active row joins to such a row have their answer already: z = 0, and x as
if there were no rows. The part has all the others, in the order in which the matrix of the problem is a narrow band.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices, small_numbers
from lcpstep.lcp.sparse_rows import SparseRows
from lcpstep.pointers import Doubles, Flags, Indices

NOWHERE = -1


class Part:
    """Coordinates and rows that are solved for, and the matrices A, G and G^T on them.

    n, m                     how many there are
    coordinates, rows        their numbers in the whole problem
    x_place, w_place         where in the order each coordinate and row stands
    A, G, G_T                rows and columns of the part alone

    Parameters
    ----------
    A, G, G_T : SparseRows   of the whole problem
    block : (n,)   number of the block of A that each coordinate belongs to
    order : (n + m,)   of the unknowns x and z
    """

    def __init__(self, A: SparseRows, G: SparseRows, G_T: SparseRows, block: Any, order: Any) -> None:
        self.n, self.m, self.n_all, self.m_all = 0, 0, A.m, G.m
        self.all_A, self.all_G, self.all_G_T = A, G, G_T
        self.A, self.G, self.G_T = [
            SparseRows(x.matrix(x.m, A.m if x is not G_T else G.m)) for x in (A, G, G_T)
        ]
        n_b = int(block.max(initial=-1)) + 1
        begin = np.concatenate([[0], np.cumsum(np.bincount(block, minlength=n_b))])
        lists = {
            "block": block, "order": order, "block_begin": begin, "member": np.argsort(block, kind="stable"),
            "coordinates": self.n_all, "rows": self.m_all, "x_place": self.n_all, "w_place": self.m_all,
            "queue": n_b, "entered_block": n_b, "x_number": self.n_all, "w_number": self.m_all,
        }  # fmt: skip
        self.lists = {
            name: np.full(x, NOWHERE, dtype=np.intp) if isinstance(x, int) else np.array(x, dtype=np.intp)
            for name, x in lists.items()
        }
        self.block, self.order = indices(self.lists["block"]), indices(self.lists["order"])
        self.block_begin, self.member = indices(self.lists["block_begin"]), indices(self.lists["member"])
        self.coordinates, self.rows = indices(self.lists["coordinates"]), indices(self.lists["rows"])
        self.x_place, self.w_place = indices(self.lists["x_place"]), indices(self.lists["w_place"])
        self.queue, self.entered_block = indices(self.lists["queue"]), indices(self.lists["entered_block"])
        self.x_number, self.w_number = indices(self.lists["x_number"]), indices(self.lists["w_number"])
        self.n_b, self.queued = n_b, 0

    @cython.ccall
    def choose(self, active: Any, w: Any) -> bool:
        """Take what rows reach that are active and have w < 0, or no number; whether that is another part."""
        spread(self, small_numbers(active), doubles(w))
        if not enlist(self):
            return False
        take(self.A, self.all_A, self.coordinates, self.n, self.x_number)
        take(self.G, self.all_G, self.rows, self.m, self.x_number)
        take(self.G_T, self.all_G_T, self.coordinates, self.n, self.w_number)
        return True

    @cython.ccall
    def fill(self, chosen: Any, d: Any, k: int, storage: Any) -> None:
        """Write the matrix of the rows chosen with d on their diagonal; rows of the others are of the unit matrix.

        k, storage : half bandwidth; zeros (n + m, 3 k + 1), LAPACK's storage of a band, transposed
        """
        fill(self, small_numbers(chosen), doubles(d), k, doubles(storage))


def spread(part: Part, active: Flags, w: Doubles) -> None:
    """Mark the rows and blocks that are reached: row after row, block after block."""
    part.queued = 0
    for b in range(part.n_b):
        part.entered_block[b] = 0
    for i in range(part.m_all):
        part.w_number[i] = NOWHERE
    for i in range(part.m_all):
        if active[i] and part.w_number[i] == NOWHERE and not w[i] >= 0.0:
            enter(part, i)
    taken = 0
    while taken < part.queued:
        b = part.queue[taken]
        taken += 1
        for k in range(part.block_begin[b], part.block_begin[b + 1]):
            enter_rows_at(part, part.member[k], active)


def enter_rows_at(part: Part, j: int, active: Flags) -> None:
    """Enter the active rows that have an entry at the coordinate j."""
    for e in range(part.all_G_T.begin[j], part.all_G_T.begin[j + 1]):
        i = part.all_G_T.column[e]
        if active[i] and part.w_number[i] == NOWHERE:
            enter(part, i)


def enter(part: Part, i: int) -> None:
    """Enter a row, and queue the blocks of its coordinates."""
    part.w_number[i] = 0
    for e in range(part.all_G.begin[i], part.all_G.begin[i + 1]):
        b = part.block[part.all_G.column[e]]
        if part.entered_block[b] == 0:
            part.entered_block[b] = 1
            part.queue[part.queued] = b
            part.queued += 1


def enlist(part: Part) -> bool:
    """Number what has been marked, in the order of the band; whether that is another part than before."""
    n, m, place, changed = 0, 0, 0, False
    for k in range(part.n_all + part.m_all):
        j = part.order[k]
        i = j - part.n_all
        if i < 0 and part.entered_block[part.block[j]] == 1:
            changed = changed or n >= part.n or part.coordinates[n] != j
            part.coordinates[n], part.x_number[j], part.x_place[n] = j, n, place
            n += 1
            place += 1
        elif i >= 0 and part.w_number[i] != NOWHERE:
            changed = changed or m >= part.m or part.rows[m] != i
            part.rows[m], part.w_number[i], part.w_place[m] = i, m, place
            m += 1
            place += 1
    changed = changed or n != part.n or m != part.m
    part.n, part.m = n, m
    return changed


def take(target: SparseRows, source: SparseRows, rows: Indices, n: int, number: Indices) -> None:
    """These rows of a matrix, in the columns that have a number."""
    place = 0
    for k in range(n):
        target.begin[k] = place
        for e in range(source.begin[rows[k]], source.begin[rows[k] + 1]):
            if number[source.column[e]] != NOWHERE:
                target.column[place], target.value[place] = number[source.column[e]], source.value[e]
                place += 1
    target.begin[n] = place


def fill(part: Part, chosen: Flags, d: Doubles, k: int, storage: Doubles) -> None:
    """The matrix of `saddle`: row p and column q lie at q (3 k + 1) + 2 k + p - q, which is 3 k q + p + 2 k."""
    for j in range(part.n):
        p = part.x_place[j]
        for e in range(part.A.begin[j], part.A.begin[j + 1]):
            storage[3 * k * part.x_place[part.A.column[e]] + p + 2 * k] += part.A.value[e]
    for i in range(part.m):
        p = part.w_place[i]
        storage[3 * k * p + p + 2 * k] = d[i] if chosen[i] else 1.0
        if chosen[i]:
            for e in range(part.G.begin[i], part.G.begin[i + 1]):
                q = part.x_place[part.G.column[e]]
                storage[3 * k * q + p + 2 * k] += part.G.value[e]
                storage[3 * k * p + q + 2 * k] -= part.G.value[e]
