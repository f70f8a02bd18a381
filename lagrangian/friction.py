"""Planar Coulomb friction, for contacts that ask for it.

    sliding velocity   u_T = T v + slip       T: tangent (n_c, n_q), slip: of a belt, minus its velocity
    in contact         |lambda_T| <= mu lambda_N,   lambda_T = -mu lambda_N sign(u_T) where u_T != 0
    impact (Moreau)    the same law between the impulses p_N, p_T and the averages (u+ + r u-) / (1 + r)

Moreau's law, with one coefficient r for the normals and tangents of all contacts that strike together, creates no
energy. Newton's law on the normal with none on the tangent (`restitution=0.0` here) can, and so can contacts that
strike together with different r.

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3;
J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (CISM 302, 1988).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.pickling import Pickled


@dataclass(frozen=True, eq=False)
class Coulomb(Pickled):
    """Dry friction of the contacts that carry it.

    Parameters
    ----------
    mu : (n_c,) or one number for all contacts, mu >= 0   coefficient of friction [-]; 0 for a contact without
    tangent : (n_c, n_q) constant matrix, or callback filling out (n_c, n_q)   T [-]
    slip : (n_c,) constants where the tangent is constant, callback filling out (n_c,) where it is one; or None
        Sliding velocity at v = 0 [m/s]: a belt that runs with velocity b along the tangent has slip = -b.
        None for obstacles at rest.
    restitution : (n_c,) or one number, 0 <= r <= 1, or None
        On the tangent, at impacts; None (the default) for the contact's own, which is Moreau's law.

    Raises
    ------
    ValueError   a shape does not fit, a coefficient is negative, or a restitution lies outside [0, 1]
    """

    mu: ArrayLike
    tangent: ArrayLike | Callback
    slip: ArrayLike | Callback | None = None
    restitution: ArrayLike | None = None

    def fitted(self, n_c: int) -> Coulomb:
        """The same with every number an array of one entry a contact."""
        mu = checks.per_contact("friction.mu", self.mu, n_c)
        if np.any(mu < 0.0):
            raise ValueError(f"friction.mu: expected coefficients >= 0, got {self.mu!r}")
        tangent = self.tangent
        if not callable(tangent):
            tangent = checks.matrix("friction.tangent", tangent)
            if len(tangent) != n_c:
                raise ValueError(
                    f"friction.tangent: expected {n_c} rows, one per contact, got shape {tangent.shape}"
                )
        slip = self.slip
        if slip is not None and callable(slip) != callable(tangent):
            raise ValueError("friction.slip: expected a callback exactly where friction.tangent is one")
        if not callable(slip) and not callable(tangent):
            slip = checks.per_contact("friction.slip", 0.0 if slip is None else slip, n_c)
        r = None if self.restitution is None else checks.restitution(self.restitution, n_c)
        return Coulomb(mu, tangent, slip, r)

    def sliding(self, t: float, q: Array, v: Array, p: Array) -> Array:
        """Sliding velocities u_T [m/s], (n_c,); raises ValueError where a callback does not fit."""
        at, n_c = (t, q, v, p), len(np.atleast_1d(np.asarray(self.mu)))
        if callable(self.tangent):
            T = checks.evaluate("friction.tangent", self.tangent, at, (n_c, len(q)))
        else:
            T = np.asarray(self.tangent)
        if T.shape[1] != len(q):
            raise ValueError(
                f"friction.tangent: expected {len(q)} columns, one per coordinate, got shape {T.shape}"
            )
        u = np.asarray(T @ v)
        if callable(self.slip):
            return u + checks.evaluate("friction.slip", self.slip, at, (n_c,))
        return u if self.slip is None else u + np.asarray(self.slip)
