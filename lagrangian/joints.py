"""Joints: bilateral constraints g(t, q) = 0, with a multiplier of either sign.

    u = dg/dt = G v + g_t = 0,      u' = G v' + bias = 0,      bias = (dG/dt) v + d(g_t)/dt along the motion

The forms are those of the contacts, without the sign: the force of a joint is G^T lambda with lambda free.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.pickling import Pickled


@dataclass(frozen=True, eq=False)
class LinearJoints(Pickled):
    """Joints G q + offset = s(t).

    Parameters
    ----------
    G : (n_j, n_q)   Jacobian, constant [-]
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
        self.as_contacts()

    @property
    def n_j(self) -> int:
        """Number of joints."""
        return self.as_contacts().n_c

    def as_contacts(self) -> LinearContacts:
        """The same gaps, with which everything that evaluates contacts evaluates joints."""
        return LinearContacts(self.G, self.offset, motion=self.motion)


@dataclass(frozen=True, eq=False)
class Joints(Pickled):
    """Joints g(t, q) = 0 of any form.

    Parameters
    ----------
    n_j : number of joints
    gap : callback filling out (n_j,)   g [m]
    jacobian : callback filling out (n_j, n_q)   G = dg/dq
    gap_t : callback filling out (n_j,), or None for joints that do not depend on time   partial g / partial t
    bias : callback filling out (n_j,), or None   (dG/dt) v + d(g_t)/dt; differenced where not given
    """

    n_j: int
    gap: Callback
    jacobian: Callback
    gap_t: Callback | None = None
    bias: Callback | None = None

    def __post_init__(self) -> None:
        checks.count("n_j", self.n_j)

    def as_contacts(self) -> Contacts:
        """The same gaps, with which everything that evaluates contacts evaluates joints."""
        return Contacts(self.n_j, self.gap, self.jacobian, self.gap_t, self.bias)


def state(joints: LinearJoints | Joints, t: float, q: Array, v: Array, p: Array) -> tuple[Array, Array]:
    """Values g [m] and rates u [m/s] of the joints, each (n_j,): zero where they hold."""
    try:
        return joints.as_contacts().state(t, q, v, p)
    except ValueError as error:
        raise ValueError(str(error).replace("contacts.", "joints.")) from error
