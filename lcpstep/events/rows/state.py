"""Rows of joints, contacts and tangents at one state, under the names of mechanics, and their work space."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.kernels.clock import Clock
    from lcpstep.kernels.model import Model
    from lcpstep.pointers import after


class Rows(Clock):
    """Joints, then the contacts' normals, then their tangents, if there are any; see `equations` in this folder.

    model, joints, tangents   the same system with its contacts, its joints and its tangents as rows
    n_q, n_c, n_j, n_t, n_r   coordinates, contacts, joints, tangents; rows in all
    rtol, atol                tolerances
    a_free, force : (n_q,)    acceleration M^-1 f without contacts and joints, f
    M                         factor of the mass matrix, where that changes
    R, MR : (n_r, n_q)        rows, and rows M^-1 R^T
    D : (n_r, n_r)            Delassus matrix R M^-1 R^T
    rate, bias : (n_r,)       velocity of a row at rest, and its acceleration at v' = 0
    row, n_held               rows held, and how many
    work, shifted : (n_q,);  near, further : (n_r,);  G : (n_r, n_q)   work space

    Parameters
    ----------
    model, joints, tangents : Model;  n_j, n_t, rtol, atol   as above;  t_span, corners, period   as of `Clock`
    """

    def __init__(
        self,
        model: Model,
        joints: Model,
        n_j: int,
        tangents: Model,
        n_t: int,
        tolerances: tuple[float, float],
        t_span: tuple[float, float],
        corners: Any,
        period: float,
    ) -> None:
        Clock.__init__(self, t_span, corners, period)
        n, n_c = model.n_q, model.n_c
        r = n_j + n_c + n_t
        self.model, self.joints, self.tangents = model, joints, tangents
        self.n_q, self.n_c, self.n_j, self.n_t, self.n_r, self.n_held = n, n_c, n_j, n_t, r, 0
        self.rtol, self.atol = tolerances
        self.row_numbers = np.zeros(4 * n + n * n + 3 * r * n + r * r + 4 * r)
        self.a_free = doubles(self.row_numbers)
        self.force = after(self.a_free, n)
        self.work = after(self.force, n)
        self.shifted = after(self.work, n)
        self.M = after(self.shifted, n)
        self.R = after(self.M, n * n)
        self.MR = after(self.R, r * n)
        self.G = after(self.MR, r * n)
        self.D = after(self.G, r * n)
        self.rate = after(self.D, r * r)
        self.bias = after(self.rate, r)
        self.near = after(self.bias, r)
        self.further = after(self.near, r)
        self.row_list = np.zeros(r, dtype=np.intp)
        self.row = indices(self.row_list)
