"""Planar Coulomb friction, for contacts that ask for it.

    sliding velocity   u_T = T v + slip       T: tangent (n_c, n_q), slip: of a belt, minus its velocity
    in contact         |lambda_T| <= mu_s lambda_N where u_T = 0,   lambda_T = -mu(u_T) lambda_N sign(u_T) elsewhere
    impact             by the law that is named

Laws of impact, for the impulses p_N >= 0 and |p_T| <= mu p_N:

    "moreau"   p_T = -mu p_N sign(xi_T), xi = u+ + r u-, 0 <= xi_N complementary to p_N: Coulomb's law between
               impulses and averages. Creates no energy if all contacts that strike together have one r.
    "newton"   the same with no restitution on the tangent, xi_T = u_T+. May create energy.
    "stronge"  Coulomb's law at every instant of an impact that is integrated over p_N, through slip, reversal and
               stick; it ends when the normal impulse has given back r^2 of the work that it took in compression.
               Never creates energy. Contacts that strike together do so in turn, the fastest first.

Sources: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3;
J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (CISM 302, 1988); E. J. Routh, Dynamics
of a System of Rigid Bodies (1905), volume 1, chapter 5; W. J. Stronge, Impact Mechanics (Cambridge 2000), chapter 3.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks, sparse
from lagrangian.checks import Array, Callback
from lagrangian.pickling import Pickled
from lagrangian.system import Harmonic

LAWS = ("moreau", "newton", "stronge")
Normals = Callable[[float, Array, Array, Array], Any]  # G (n_c, n_q) at a state t, q, v, p
PARALLEL = 1e-12  # squared sine of the angle between normal and tangent, below which they are one direction
ELSEWHERE = 1e-3  # of the coordinates: where a tangent is looked at beside the initial state


@dataclass(frozen=True, eq=False)
class Coulomb(Pickled):
    """Dry friction of the contacts that carry it.

    Parameters
    ----------
    mu : (n_c,) or one number for all contacts, mu >= 0   coefficient of friction [-]; 0 for a contact without;
        or a callback f(t, q, u, p, out) filling out (n_c,) from the sliding velocities u (n_c,), 0 of what sticks
    tangent : (n_c, n_q) constant matrix, dense or scipy.sparse, or callback filling out (n_c, n_q)   T [-]
        T v is a velocity in m/s, as gaps are distances in m: else mu means another coefficient. A function of time
        and coordinates: a contact has one direction of friction, in space as well.
    slip : (n_c,) constants or a Harmonic where the tangent is constant, callback filling out (n_c,) where it is one
        Sliding velocity at v = 0 [m/s]: a belt that runs with velocity b along the tangent has slip = -b.
        None for obstacles at rest.
    restitution : (n_c,) or one number, 0 <= r <= 1, or None
        On the tangent, at impacts by Moreau's law; None (the default) for the contact's own.
    mu_s : (n_c,) or one number, mu_s >= mu, or None
        Coefficient of what sticks; None (the default) for mu, or mu at u = 0. Impacts have mu, at the sliding
        velocity before them.
    law : "moreau", "newton" or "stronge"   of impacts

    Raises
    ------
    ValueError   when contacts get it: a shape does not fit, a coefficient is negative, mu_s is smaller than mu, a
        restitution lies outside [0, 1] or belongs to no law, or the law is unknown
    """

    mu: ArrayLike | Callback
    tangent: ArrayLike | Callback
    slip: ArrayLike | Harmonic | Callback | None = None
    restitution: ArrayLike | None = None
    mu_s: ArrayLike | None = None
    law: str = "moreau"

    def fitted(self, n_c: int) -> Coulomb:
        """The same with every number an array of one entry a contact."""
        mu = self.mu if callable(self.mu) else _coefficients("friction.mu", self.mu, n_c)
        mu_s = None if self.mu_s is None else _coefficients("friction.mu_s", self.mu_s, n_c)
        if not callable(mu):
            _check_static(mu_s, mu)
        tangent = self.tangent
        if not callable(tangent):
            read: Any = sparse.matrix if sparse.is_sparse(tangent) else checks.matrix
            tangent = read("friction.tangent", tangent)
            if tangent.shape[0] != n_c:
                raise ValueError(
                    f"friction.tangent: expected {n_c} rows, one per contact, got shape {tangent.shape}; friction "
                    "acts along one direction a contact"
                )
        slip = self.slip
        if slip is not None and callable(slip) != callable(tangent):
            raise ValueError("friction.slip: expected a callback exactly where friction.tangent is one")
        if isinstance(slip, Harmonic):
            if callable(tangent):
                raise ValueError(
                    "friction.slip: expected a callback where friction.tangent is one, got a Harmonic"
                )
            slip = Harmonic(*slip.terms(n_c, "friction.slip"), slip.omega)
        elif not callable(slip) and not callable(tangent):
            slip = checks.per_contact("friction.slip", 0.0 if slip is None else slip, n_c)
        r = None if self.restitution is None else checks.restitution(self.restitution, n_c)
        if not isinstance(self.law, str) or self.law not in LAWS:
            raise ValueError(f"friction.law: expected one of {', '.join(map(repr, LAWS))}, got {self.law!r}")
        if r is not None and self.law != "moreau":
            raise ValueError(
                f"friction.restitution: expected None with law={self.law!r}, got {self.restitution!r}"
            )
        return Coulomb(mu, tangent, slip, r, mu_s, self.law)

    def tangential(self, restitution: ArrayLike) -> Array:
        """Restitution on the tangents (n_c,) by Moreau's law or Newton's; `restitution`: the contacts' own."""
        if self.law == "newton":
            return np.zeros(np.shape(restitution))
        return np.array(restitution if self.restitution is None else self.restitution, dtype=np.float64)

    def sliding(self, t: float, q: Array, v: Array, p: Array, n_c: int) -> Array:
        """Sliding velocities u_T [m/s], (n_c,); raises ValueError where a callback does not fit."""
        at = (t, q, v, p)
        T = self.tangents(at, n_c)
        if T.shape[1] != len(q):
            raise ValueError(
                f"friction.tangent: expected {len(q)} columns, one per coordinate, got shape {T.shape}"
            )
        u = np.asarray(T @ v)
        if callable(self.slip):
            u = u + checks.evaluate("friction.slip", self.slip, at, (n_c,))
        elif isinstance(self.slip, Harmonic):
            u = u + self.slip.at(t, n_c)
        elif self.slip is not None:
            u = u + np.asarray(self.slip)
        if callable(self.mu):
            self.coefficients(t, q, u, p)
        return u

    def tangents(self, at: tuple[float, Array, Array, Array], n_c: int) -> Any:
        """T at a state (t, q, v, p), sparse where it was given so."""
        if callable(self.tangent):
            return checks.evaluate("friction.tangent", self.tangent, at, (n_c, len(at[1])))
        return self.tangent

    def coefficients(self, t: float, q: Array, u: Array, p: Array) -> tuple[Array, Array]:
        """Mu at the sliding velocities u, and the coefficients of what sticks, each (n_c,)."""
        if not callable(self.mu):
            mu = np.asarray(self.mu)
            return mu, mu if self.mu_s is None else np.asarray(self.mu_s)
        mu, still = (
            checks.evaluate("friction.mu", self.mu, (t, q, x, p), u.shape, ("u", "sliding velocities "))
            for x in (u, np.zeros(u.shape))
        )
        for x, value in ((u, mu), (0.0 * u, still)):
            if np.any(value < 0.0):
                raise ValueError(
                    f"friction.mu: expected coefficients >= 0, got {checks.shown(value)} at t = {t:.9g}, "
                    f"sliding velocities {checks.shown(x)}"
                )
        _check_static(self.mu_s, still)
        return mu, still if self.mu_s is None else np.asarray(self.mu_s)

    def check_directions(self, at: tuple[float, Array, Array, Array], normals: Normals, fixed: bool) -> None:
        """ValueError for a tangent that is nothing but the normal, at the state `at` (t, q, v, p).

        Normal and tangent of a mechanism may be parallel at one position: those that are not `fixed` must be at two
        others as well. One coordinate has one direction: contacts that it meets obliquely.
        """
        t, q, v, p = at
        places = [q] if len(q) > 1 else []
        if places and not (fixed and not callable(self.tangent)):
            size = ELSEWHERE * max(1.0, float(np.max(np.abs(q))))
            places += [q + size * np.cos(k * np.arange(1.0, len(q) + 1.0)) for k in (1.0, 2.0)]
        parallel: NDArray[Any] = np.arange(0)
        for k, x in enumerate(places):
            found = self._parallel((t, x, v, p), normals)
            parallel = found if k == 0 else np.intersect1d(parallel, found)
            if not len(parallel):
                return
        if len(parallel):
            raise ValueError(
                f"friction.tangent: row {parallel[0]} is parallel to the normal of its contact at t = {t:.9g}, "
                f"q = {checks.shown(q)}"
            )

    def _parallel(self, at: tuple[float, Array, Array, Array], normals: Normals) -> NDArray[Any]:
        """Contacts with friction whose tangent lies along their normal."""
        N = normals(*at)
        T = self.tangents(at, N.shape[0])
        sizes = sparse.products(N, N) * sparse.products(T, T)
        across = sizes - sparse.products(N, T) ** 2
        rough = np.full(len(sizes), True) if callable(self.mu) else np.asarray(self.mu) > 0.0
        return np.flatnonzero(rough & (sizes > 0.0) & (across <= PARALLEL * sizes))


def swaying(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """What a harmonic slip makes of the tangents' obstacles: velocity and acceleration; see `sway`."""
    cosine, sine = math.cos(p[1] * t), math.sin(p[1] * t)
    for c in range(int(p[0])):
        k = 2 + 3 * c
        out[c, 0] = 0.0
        out[c, 1] = -p[k] - p[k + 1] * cosine - p[k + 2] * sine
        out[c, 2] = p[1] * (p[k + 1] * sine - p[k + 2] * cosine)


def sway(slip: Harmonic, n_c: int) -> Array:
    """The parameters of `swaying`: n_c, omega, and constant, cosine and sine of each contact."""
    return np.concatenate([[float(n_c), slip.omega], np.stack(slip.terms(n_c), axis=1).ravel()])


def _coefficients(name: str, value: ArrayLike, n_c: int) -> Array:
    """Coefficients of friction, one a contact."""
    mu = checks.per_contact(name, value, n_c)
    if np.any(mu < 0.0):
        raise ValueError(f"{name}: expected coefficients >= 0, got {value!r}")
    return mu


def _check_static(mu_s: ArrayLike | None, mu: Array) -> None:
    """ValueError for a coefficient of sticking below that of sliding."""
    if mu_s is not None and np.any(np.asarray(mu_s) < mu):
        raise ValueError(
            f"friction.mu_s: expected coefficients of sticking that are not below mu = {checks.shown(mu)}, got "
            f"{checks.shown(np.asarray(mu_s))}"
        )
