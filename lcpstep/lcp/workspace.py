"""What the pivoting kernels work in, made once for the largest problem and used for smaller ones.

Every quantity has its name. A matrix of a problem of n unknowns lies row by row from the start of its place, n
numbers a row, whatever the largest n; indices of variables are numbered as in `lemke`.
"""

from __future__ import annotations

import cython
import numpy as np

from lcpstep.shelf import IndexShelf, Shelf

VECTORS = 15  # rows of n + 1 numbers, and of indices of 2 n + 1:
LISTS = 12


class Workspace:
    """Work space for problems of up to n unknowns; every thread needs its own.

    columns : (n+1, n)   columns of the scaled W, each in one piece, the last Lemke's covering vector; or the tableau
    inverse : (n, n)     inverse of the basis matrix
    factor : (n, n)      LU factors of a principal submatrix
    scaled_b             b of the scaled problem
    row_scale, column_scale  powers of two that rows were multiplied by, and columns: z = column scale * scaled z
    x, dx                basic z by position, and its change with the entering variable
    slack, dslack        w by index, and its change
    left                 a left product with the inverse
    trial                a solution on trial, or marks
    size                 sizes of the terms of w, the judge's scale
    ray_direction, ray_start  the ray that pivoting left along, in the units of z
    best                 the best answer so far that passes the tolerance asked for
    changes : (2 n, n)   of the tableau: columns that entered, to change others by; where inverse and factor lie
    reciprocal : (2 n,)  of their pivots

    basic, tight         by position: index of the basic z; index of the row whose w is not basic
    z_place, w_place     position of z_j in `basic`, of w_i in `tight`; -1 where there is none
    tied                 variables that reach zero together
    order                row interchanges of an elimination
    active, chosen       indices of a principal submatrix, and 1 for each of them, else 0
    nonbasic, place      of the tableau: variable by column; column by variable, -1 for a basic one
    row, made            of the tableau: row of the pivot by change; how many of the changes by column have been made

    residual, iterations     of the last problem
    waiting                  number of changes
    best_residual            of the answer in `best`
    ray_dz_0, ray_z_0        the covering variable's share in the ray
    thorough                 whether a solution is searched for as long as there is hope
    smallest                 size above which a component of Lemke's direction counts
    """

    def __init__(self, n: int) -> None:
        self.numbers = np.empty((n + 1) * n + 2 * n * n + VECTORS * (n + 1))
        self.lists = np.zeros(LISTS * (2 * n + 1), dtype=np.intp)
        self.residual = self.best_residual = self.smallest = 0.0
        self.ray_dz_0 = self.ray_z_0 = 0.0
        self.iterations = self.waiting = 0
        self.thorough = False
        m, k = n + 1, 2 * n + 1
        x = Shelf(self.numbers)
        self.columns, self.inverse, self.factor = x.take((n + 1) * n), x.take(n * n), x.take(n * n)
        self.scaled_b, self.row_scale, self.column_scale, self.x = x.take(m), x.take(m), x.take(m), x.take(m)
        self.dx, self.slack, self.dslack, self.left = x.take(m), x.take(m), x.take(m), x.take(m)
        self.trial, self.size, self.ray_direction, self.ray_start = x.take(m), x.take(m), x.take(m), x.take(m)
        self.best, self.reciprocal = x.take(m), x.take(2 * n)
        self.changes = self.inverse
        y = IndexShelf(self.lists)
        self.basic, self.tight, self.z_place, self.w_place = y.take(k), y.take(k), y.take(k), y.take(k)
        self.tied, self.order, self.active, self.chosen = y.take(k), y.take(k), y.take(k), y.take(k)
        self.nonbasic, self.place, self.row, self.made = y.take(k), y.take(k), y.take(k), y.take(k)
