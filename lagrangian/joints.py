"""Joints: bilateral constraints g(t, q) = 0, with a multiplier of either sign.

    u = dg/dt = G v + g_t = 0,      u' = G v' + bias = 0,      bias = (dG/dt) v + d(g_t)/dt along the motion

The forms are those of the contacts, without the sign: the force of a joint is G^T lambda with lambda free.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.pickling import Pickled


@dataclass(frozen=True, eq=False)
class LinearJoints(Pickled):
    """Joints G q + offset = s(t).

    Parameters
    ----------
    G : (n_j, n_q)   Jacobian, constant [-]; dense, or a scipy.sparse matrix
    offset : (n_j,)   value at q = 0, s = 0 [m]
    motion : callback filling out (n_j, 3), or None   out[i] = (s_i, s_i', s_i'') at time t

    Raises
    ------
    ValueError   a shape does not fit, or a number is not finite
    """

    G: ArrayLike
    offset: ArrayLike = 0.0
    motion: Callback | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "G", self._contacts.G)
        object.__setattr__(self, "offset", self._contacts.offset)

    @property
    def n_j(self) -> int:
        """Number of joints."""
        return self._contacts.n_c

    def as_contacts(self) -> LinearContacts:
        """The same gaps, with which everything that evaluates contacts evaluates joints."""
        return self._contacts

    @cached_property
    def _contacts(self) -> LinearContacts:
        return LinearContacts(self.G, self.offset, motion=self.motion)


@dataclass(frozen=True, eq=False)
class Joints(Pickled):
    """Joints g(t, q) = 0 of any form.

    Parameters
    ----------
    n_j : number of joints
    gap : callback filling out (n_j,)   g [m]
    jacobian : callback filling out (n_j, n_q)   G = dg/dq; with a pattern, filling out (n_e,): its entries
    gap_t : callback filling out (n_j,), or None for joints that do not depend on time   partial g / partial t
    bias : callback filling out (n_j,), or None   (dG/dt) v + d(g_t)/dt; differenced where not given
    pattern : (2, n_e) whole numbers, or None
        Row and column of each entry of G that is not zero at all states, none twice. Large systems give it: their
        Jacobian is kept sparse.

    Raises
    ------
    ValueError   n_j is no number of joints, or the pattern is none
    """

    n_j: int
    gap: Callback
    jacobian: Callback
    gap_t: Callback | None = None
    bias: Callback | None = None
    pattern: ArrayLike | None = None

    def __post_init__(self) -> None:
        checks.count("n_j", self.n_j)
        if self.pattern is not None:
            object.__setattr__(self, "pattern", _pattern(self.pattern, self.n_j))
        checks.callbacks(self, ("gap", "jacobian"), ("gap_t", "bias"))

    def as_contacts(self) -> Contacts:
        """The same gaps, with which everything that evaluates contacts evaluates joints; all of G is filled."""
        return self._contacts

    @cached_property
    def _contacts(self) -> Contacts:
        jacobian = (
            self.jacobian if self.pattern is None else _everywhere(self.jacobian, *np.array(self.pattern))
        )
        return Contacts(self.n_j, self.gap, jacobian, self.gap_t, self.bias)

    def matrix(self, entries: Array, n_q: int) -> Any:
        """G as a sparse matrix, from its entries in the order of the pattern."""
        from scipy.sparse import csr_array

        order, columns, begin = self._by_row
        if np.max(columns) >= n_q:
            raise ValueError(f"joints.pattern: expected columns below {n_q}, got {np.max(columns)}")
        return csr_array((np.asarray(entries)[order], columns, begin), shape=(self.n_j, n_q))

    @cached_property
    def _by_row(self) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
        """The entries row by row, their columns, and where each row begins."""
        rows, columns = np.asarray(self.pattern)
        order = np.lexsort((columns, rows))
        return order, columns[order], np.append(0, np.cumsum(np.bincount(rows, minlength=self.n_j)))


def _pattern(given: ArrayLike, n_j: int) -> NDArray[np.intp]:
    """Rows and columns of the entries of a Jacobian, checked and read-only."""
    pattern = np.array(given)
    if pattern.ndim != 2 or len(pattern) != 2 or pattern.shape[1] == 0 or pattern.dtype.kind not in "iu":
        raise ValueError(
            f"pattern: expected whole numbers of shape (2, entries), rows and columns, got {given!r}"
        )
    if pattern.min() < 0 or pattern[0].max() >= n_j:
        raise ValueError(f"pattern: expected rows in [0, {n_j}) and columns >= 0, got {given!r}")
    if np.unique(pattern, axis=1).shape != pattern.shape:
        raise ValueError("pattern: expected each entry once, got one twice")
    pattern = pattern.astype(np.intp)
    pattern.flags.writeable = False
    return pattern


def _everywhere(entries: Callback, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Callback:
    """A callback that fills all of G from one that fills its entries."""

    def jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
        found = np.empty(len(rows))
        entries(t, q, v, p, found)
        out[:] = 0.0
        for k in range(len(rows)):
            out[rows[k], columns[k]] = found[k]

    return jacobian


def state(joints: LinearJoints | Joints, t: float, q: Array, v: Array, p: Array) -> tuple[Array, Array]:
    """Values g [m] and rates u [m/s] of the joints, each (n_j,): zero where they hold."""
    try:
        if isinstance(joints, Joints) and joints.pattern is not None:
            return _sparse_state(joints, (t, q, v, p))
        return joints.as_contacts().state(t, q, v, p)
    except ValueError as error:
        raise ValueError(str(error).replace("contacts.", "joints.")) from error


def _sparse_state(joints: Joints, at: tuple[float, Array, Array, Array]) -> tuple[Array, Array]:
    """The same where the Jacobian has a pattern."""
    shape = (np.asarray(joints.pattern).shape[1],)
    g = checks.evaluate("joints.gap", joints.gap, at, (joints.n_j,))
    u = joints.matrix(checks.evaluate("joints.jacobian", joints.jacobian, at, shape), len(at[1])) @ at[2]
    if joints.gap_t is not None:
        u += checks.evaluate("joints.gap_t", joints.gap_t, at, (joints.n_j,))
    if joints.bias is not None:
        checks.evaluate("joints.bias", joints.bias, at, (joints.n_j,))
    return g, u
