"""Rows of joints, contacts and tangents at one state, under the names of mechanics, and their work space."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.kernels.clock import Clock
from lcpstep.kernels.model import Model
from lcpstep.kernels.sudden import Sudden
from lcpstep.pointers import inf
from lcpstep.shelf import IndexShelf, Shelf


class Rows(Clock):
    """Joints, then the contacts' normals, then their tangents, if there are any; see `equations` in this folder.

    model, joints, tangents   the same system with its contacts, its joints and its tangents as rows
    n_q, n_c, n_j, n_t, n_r   coordinates, contacts, joints, tangents; rows in all
    rtol, atol                tolerances
    far, fast, longest        of the motion all positions, and velocities, in the metric of M, and the largest
                              coordinate, each at its largest, roughly: absolute tolerances are no more than rtol of
                              them; infinite where these are to hold as given
    sudden, gap_drift         of velocities that jump; gap of a row at rest that a step may leave, as steps have shown
    a_free, force : (n_q,)    acceleration M^-1 f without contacts and joints, f
    M                         factor of the mass matrix, where that changes
    R, MR : (n_r, n_q)        rows, and rows M^-1 R^T
    D : (n_r, n_r)            Delassus matrix R M^-1 R^T
    rate, bias : (n_r,)       velocity of a row at rest, and its acceleration at v' = 0
    row, n_held               rows held, and how many;  n_kept   joints among them, which come first
    held : (n_r,)             multipliers of the rows held
    share : (n_r,)            force of the `other` row of its contact that comes with that of a row held
    either : (n_r,)           whether a row may be held though its force would move it the other way: `held.hold`
    L : (n_r, n_r)            factors of the matrix of the rows held;  pivot_error   relative, in roundings
    idle : (n_j, n_j)         what joints that say the same can take from each other, see `loads`
    rests : (n_r,)            whether the velocity of a row is to be zero, held or not: of joints always
    reach : (n_r,)            coordinates that move each row, see `equations.reach_of`
    moved : (n_q,), n_moved   coordinates that an impulse on the row at hand moves, and how many
    R_on, MR_on, D_on, bias_on   R, MR, D and bias of what is left of the rows on the joints held, see `on_joints`
    on_joints                 whether these are known
    fixed, moving, known      rows and masses never change; flat obstacles move; fixed rows have been measured
    work, shifted : (n_q,);  near, further, change : (n_r,);  G : (n_r, n_q)   work space

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
        self.n_q, self.n_c, self.n_j, self.n_t, self.n_r = n, n_c, n_j, n_t, r
        self.n_held, self.n_kept, self.on_joints = 0, 0, False
        self.fixed = model.flat and tangents.flat and joints.flat and not model.mass.given
        self.moving = model.motion.given or joints.motion.given or tangents.motion.given
        self.known = False
        self.rtol, self.atol = tolerances
        self.far = self.fast = self.longest = inf
        self.sudden, self.gap_drift = Sudden(), 0.0
        self.row_numbers = np.zeros(4 * n + n * n + 5 * r * n + 3 * r * r + 9 * r + n_j * n_j)
        x = Shelf(self.row_numbers)
        self.a_free, self.force, self.work, self.shifted = x.take(n), x.take(n), x.take(n), x.take(n)
        self.M, self.R, self.MR, self.G = x.take(n * n), x.take(r * n), x.take(r * n), x.take(r * n)
        self.D, self.rate, self.bias = x.take(r * r), x.take(r), x.take(r)
        self.near, self.further, self.held, self.change = x.take(r), x.take(r), x.take(r), x.take(r)
        self.share, self.pivot_error, self.L = x.take(r), x.take(r), x.take(r * r)
        self.bias_on, self.R_on, self.MR_on, self.D_on = self.bias, self.R, self.MR, self.D
        self.idle = self.D
        if n_j > 0:
            self.bias_on, self.R_on, self.MR_on = x.take(r), x.take(r * n), x.take(r * n)
            self.D_on, self.idle = x.take(r * r), x.take(n_j * n_j)
        self.row_list = np.zeros(4 * r + n, dtype=np.intp)
        k = IndexShelf(self.row_list)
        self.row, self.either, self.rests, self.reach = k.take(r), k.take(r), k.take(r), k.take(r)
        self.moved, self.n_moved = k.take(n), 0
        self.row_list[2 * r : 2 * r + n_j] = 1
