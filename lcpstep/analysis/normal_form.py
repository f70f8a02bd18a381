"""Canonical forms of continuous piecewise-linear maps: companion matrices, the border at the first coordinate.

Source: M. di Bernardo, M. Feigin, S. Hogan, M. Homer, Local analysis of C-bifurcations in n-dimensional
piecewise-smooth dynamical systems, Chaos, Solitons and Fractals 10 (1999); see `border_collision`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lcpstep.analysis.border_collision import CONTINUOUS, Array, NotContinuous, PiecewiseLinearMap
from lcpstep.errors import LcpStepError


def canonical_form(f: PiecewiseLinearMap) -> PiecewiseLinearMap:
    """The same map in observer form: C = (1, 0, ...), each A a companion matrix of its characteristic polynomial.

    x -> W x with W = T O, O the observability matrix (C, C A-, C A-^2, ...), T lower triangular with the coefficients
    1, d1, d2, ... of the characteristic polynomial of A-; continuity gives A+ the same shape.

    Raises
    ------
    NotContinuous   the two sides do not meet on the border
    LcpStepError   the border does not see the whole state (O is singular)
    """
    W = to_observer_form(f)
    inverse = np.linalg.inv(W)
    return PiecewiseLinearMap(
        A_minus=W @ np.asarray(f.A_minus) @ inverse,
        A_plus=W @ np.asarray(f.A_plus) @ inverse,
        B_minus=W @ np.asarray(f.B_minus),
        B_plus=W @ np.asarray(f.B_plus),
        C=np.asarray(f.C) @ inverse,
        D=f.D,
    )


def to_observer_form(f: PiecewiseLinearMap) -> Array:
    """W of `canonical_form`."""
    gap, _ = f.gap()
    if gap > CONTINUOUS:
        raise NotContinuous(gap)
    A, C = np.asarray(f.A_minus), np.asarray(f.C)
    d = len(C)
    observability = np.array([C @ np.linalg.matrix_power(A, k) for k in range(d)])
    if np.linalg.cond(observability) > 1.0 / np.finfo(float).eps:
        raise LcpStepError("the map has no canonical form: its observability matrix is singular")
    coefficients = np.poly(A)
    T = sum(coefficients[k] * np.eye(d, k=-k) for k in range(d))
    return np.asarray(T @ observability)


class NormalForm(NamedTuple):
    """y -> A- y + B m for y_1 < 0 and A+ y + B m for y_1 > 0, with y = W x + shift m; see `normal_form`."""

    A_minus: Array
    A_plus: Array
    B: Array
    W: Array
    shift: Array


def normal_form(f: PiecewiseLinearMap) -> NormalForm:
    """The same map with companion matrices and its border at y_1 = 0, whatever the parameter.

    y = W x + d m takes the observer form, W of `canonical_form`, and moves the border by d = (D, 0, ..): then
    B = W B- + d - A- d of the companion matrices, and continuity makes W B+ + d - A+ d the same vector.

    Raises
    ------
    NotContinuous, LcpStepError   as `canonical_form`
    """
    g, W = canonical_form(f), to_observer_form(f)
    shift = np.append(f.D, np.zeros(len(W) - 1))
    A = np.asarray(g.A_minus)
    return NormalForm(A, np.asarray(g.A_plus), np.asarray(g.B_minus) + shift - A @ shift, W, shift)
