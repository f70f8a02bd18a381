"""Unilateral constraints: gap functions g(t, q) >= 0 with their derivatives and restitution.

    u = dg/dt = G v + g_t,      G = dg/dq,  g_t = partial g / partial t
    u'        = G v' + bias,    bias = (dG/dt) v + d(g_t)/dt along the motion

Impact (Newton): u+ = -r u-.  Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.14-3.15.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks, sparse
from lagrangian.checks import Array, Callback
from lagrangian.friction import Coulomb
from lagrangian.pickling import Pickled


@dataclass(frozen=True, eq=False)
class LinearContacts(Pickled):
    """Gaps g = G q + offset - s(t): flat obstacles, at rest or moving with s(t).

    Parameters
    ----------
    G : (n_c, n_q)   gap Jacobian, constant [-]; dense, or a scipy.sparse matrix
    offset : (n_c,)   gap at q = 0, s = 0 [m]
    restitution : (n_c,) or one number for all contacts, 0 <= r <= 1; 0, the default, is plastic
    motion : callback filling out (n_c, 3), or None
        out[i] = (s_i, s_i', s_i'') at time t: the obstacle's position, velocity and acceleration; s_i is continuous.
    friction : Coulomb, or None for contacts without

    Raises
    ------
    ValueError   a shape does not fit, a number is not finite, a row of G is zero, or a restitution lies outside of
        [0, 1]
    """

    G: ArrayLike
    offset: ArrayLike = 0.0
    restitution: ArrayLike = 0.0
    motion: Callback | None = None
    friction: Coulomb | None = None

    def __post_init__(self) -> None:
        checks.callbacks(self, (), ("motion",))
        read = sparse.matrix if self.sparse else checks.matrix
        object.__setattr__(self, "G", read("G", self.G))
        empty = sparse.empty_rows(self.G) if self.sparse else np.flatnonzero(~np.any(self.G, axis=1))
        if len(empty):
            raise ValueError(
                f"G: row {empty[0]} is zero: the gap depends on no coordinate; G has shape {np.shape(self.G)}, "
                "a row for each contact and a column for each coordinate"
            )
        object.__setattr__(self, "offset", checks.per_contact("offset", self.offset, self.n_c))
        object.__setattr__(self, "restitution", checks.restitution(self.restitution, self.n_c))
        if self.friction is not None:
            checks.instance("friction", self.friction, Coulomb)
            object.__setattr__(self, "friction", self.friction.fitted(self.n_c))

    @property
    def sparse(self) -> bool:
        """Whether G is kept as a scipy.sparse matrix."""
        return sparse.is_sparse(self.G)

    @property
    def n_c(self) -> int:
        """Number of contacts."""
        G: Any = self.G
        return int(G.shape[0])

    def state(self, t: float, q: Array, v: Array, p: Array) -> tuple[Array, Array]:
        """Gaps g [m] and gap velocities u [m/s], each (n_c,)."""
        s = np.zeros((self.n_c, 3))
        if self.motion is not None:
            s = checks.evaluate("contacts.motion", self.motion, (t, q, v, p), (self.n_c, 3))
        G: Any = self.G
        if G.shape[1] != len(q):
            raise ValueError(
                f"contacts.G: expected {len(q)} columns, one per coordinate, got shape {G.shape}"
            )
        if self.friction is not None:
            self.friction.sliding(t, q, v, p, self.n_c)
        return G @ q + np.asarray(self.offset) - s[:, 0], G @ v - s[:, 1]

    def normals(self, t: float, q: Array, v: Array, p: Array) -> Any:
        """G, the same at all states; sparse where it is kept so."""
        return self.G


@dataclass(frozen=True, eq=False)
class Contacts(Pickled):
    """Gaps g(t, q) of any form.

    Parameters
    ----------
    n_c : number of contacts
    gap : callback filling out (n_c,)   g [m], continuous; with friction a distance, and no other function of its sign
    jacobian : callback filling out (n_c, n_q)   G = dg/dq
    gap_t : callback filling out (n_c,), or None for gaps that do not depend on time   partial g / partial t
    bias : callback filling out (n_c,), or None   (dG/dt) v + d(g_t)/dt, the gap acceleration at v' = 0;
        differenced along the motion where not given (the event-driven integrator needs it), up to 2 ms away, also
        beyond the ends of the span, unless they are among the scene's `corners`
    restitution : (n_c,) or one number for all contacts, 0 <= r <= 1; 0, the default, is plastic
    friction : Coulomb, or None for contacts without
    lipschitz : (n_c,) or one number for all contacts, or None
        Bound of |du/dt| in free motion [m/s^2], for audits of callbacks of which bounds cannot be found.

    Raises
    ------
    ValueError   a shape does not fit, a restitution lies outside [0, 1], or a bound is not positive
    """

    n_c: int
    gap: Callback
    jacobian: Callback
    gap_t: Callback | None = None
    bias: Callback | None = None
    restitution: ArrayLike = 0.0
    friction: Coulomb | None = None
    lipschitz: ArrayLike | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "n_c", checks.count("n_c", self.n_c))
        object.__setattr__(self, "restitution", checks.restitution(self.restitution, self.n_c))
        if self.lipschitz is not None:
            bounds = checks.per_contact("lipschitz", self.lipschitz, self.n_c)
            if not np.all(bounds > 0.0):
                raise ValueError(f"lipschitz: expected positive numbers, got {self.lipschitz!r}")
            object.__setattr__(self, "lipschitz", bounds)
        if self.friction is not None:
            checks.instance("friction", self.friction, Coulomb)
            object.__setattr__(self, "friction", self.friction.fitted(self.n_c))
        checks.callbacks(self, ("gap", "jacobian"), ("gap_t", "bias"))

    def state(self, t: float, q: Array, v: Array, p: Array) -> tuple[Array, Array]:
        """Gaps g [m] and gap velocities u [m/s], each (n_c,)."""
        at = (t, q, v, p)
        g = checks.evaluate("contacts.gap", self.gap, at, (self.n_c,))
        u = checks.evaluate("contacts.jacobian", self.jacobian, at, (self.n_c, len(q))) @ v
        if self.gap_t is not None:
            u += checks.evaluate("contacts.gap_t", self.gap_t, at, (self.n_c,))
        if self.bias is not None:
            checks.evaluate("contacts.bias", self.bias, at, (self.n_c,))
        if self.friction is not None:
            self.friction.sliding(*at, self.n_c)
        return g, u

    def normals(self, t: float, q: Array, v: Array, p: Array) -> Array:
        """G at a state, (n_c, n_q)."""
        return checks.evaluate("contacts.jacobian", self.jacobian, (t, q, v, p), (self.n_c, len(q)))
