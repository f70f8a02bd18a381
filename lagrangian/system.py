"""Lagrangian systems without their contacts.

Linear, time-invariant:   M v' + C v + K q = F(t) + G^T lambda            all matrices constant
General:                  M(t, q) v' = f(t, q, v) + G^T lambda            f = F_ext - N - F_int

Source: G. Osorio, Complex Behavior in Impacting Systems, eq. 3.6; V. Acary, B. Brogliato, Numerical Methods
for Nonsmooth Dynamical Systems (Springer 2008).

Functions of the user ("callbacks") have one signature, f(t, q, v, p, out): they fill the array `out` from the
time t, coordinates q (n_q,), velocities v (n_q,) and the scene's parameters p (n_p,).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks, sparse
from lagrangian.checks import Array, Callback
from lagrangian.pickling import Pickled

TURN = 1e-6  # by how much a period may differ from whole turns of the force


@dataclass(frozen=True, eq=False)
class Harmonic:
    """Force F(t) = constant + cosine cos(omega t) + sine sin(omega t) [N], each term of shape (n_q,).

    A linear system under such a force has its motion in closed form. Also the velocities of belts, one a contact.
    """

    constant: ArrayLike = 0.0
    cosine: ArrayLike = 0.0
    sine: ArrayLike = 0.0
    omega: float = 0.0

    def terms(self, n_q: int, name: str = "force") -> tuple[Array, Array, Array]:
        """The three amplitudes as arrays of shape (n_q,); a scalar stands for all coordinates.

        name : of what they belong to, in errors
        """
        named = {"constant": self.constant, "cosine": self.cosine, "sine": self.sine}
        constant, cosine, sine = (
            checks.array(
                f"{name}.{term}", np.broadcast_to(value, (n_q,)) if np.ndim(value) == 0 else value, (n_q,)
            )
            for term, value in named.items()
        )
        checks.number(f"{name}.omega", self.omega)
        return constant, cosine, sine

    def at(self, t: float, n_q: int) -> Array:
        """The value at time t, (n_q,)."""
        constant, cosine, sine = self.terms(n_q)
        return np.asarray(constant + cosine * math.cos(self.omega * t) + sine * math.sin(self.omega * t))

    def repeats_after(self, period: float) -> bool:
        """Whether the force is the same a period later; infinity is no period."""
        if not (np.any(self.cosine) or np.any(self.sine)) or self.omega == 0.0 or math.isinf(period):
            return True
        turns = abs(self.omega) * period / (2.0 * math.pi)
        return round(turns) >= 1 and abs(turns - round(turns)) <= TURN


@dataclass(frozen=True, eq=False)
class LinearSystem(Pickled):
    """M v' + C v + K q = F(t), with constant matrices.

    Parameters
    ----------
    M : (n_q, n_q)   symmetric positive definite mass matrix [kg]
    C, K : (n_q, n_q)   damping and gyroscopic terms [N s/m], and stiffness, symmetric [N/m]; None for zero
        If one of M, C, K is a scipy.sparse matrix, all are kept as such, and `Moreau` makes none of them dense.
    force : Harmonic, (n_q,) constant force, callback filling out (n_q,), or None   F(t) [N]
        A callback may depend on time alone; forces that depend on q or v belong to a `System`.
    frame : callback filling out (n_q, 3), or None
        Moving frame: q is measured relative to c(t), and out[i] = (c_i, c_i', c_i''). The equation above then
        holds for q + c, which puts the force F - M c'' - C c' - K c on q. c and c' are continuous: a jump of c' is a
        blow that no force tells of. Where one jumps take coordinates at rest, and the obstacle's `motion`.

    Raises
    ------
    ValueError   a shape does not fit, a number is not finite, M is not symmetric positive definite, or K is not
        symmetric
    """

    M: ArrayLike
    C: ArrayLike | None = None
    K: ArrayLike | None = None
    force: Harmonic | ArrayLike | Callback | None = None
    frame: Callback | None = None

    def __post_init__(self) -> None:
        checks.callbacks(self, (), ("frame",))
        if any(map(sparse.is_sparse, (self.M, self.C, self.K))):
            self._keep_sparse()
        else:
            M = checks.matrix("M", self.M)
            if M.shape[0] != M.shape[1]:
                raise ValueError(f"M: expected a square matrix, got shape {np.shape(self.M)}")
            zero = np.zeros_like(M)
            square = M.shape
            object.__setattr__(self, "M", checks.mass_matrix("M", M))
            object.__setattr__(self, "C", checks.array("C", zero if self.C is None else self.C, square))
            K = checks.array("K", zero if self.K is None else self.K, square)
            object.__setattr__(self, "K", checks.symmetric("K", K))
        if not callable(self.force):
            force = self.force if self.force is not None else 0.0
            force = force if isinstance(force, Harmonic) else Harmonic(constant=force)
            constant, cosine, sine = force.terms(self.n_q)  # its own, which nobody changes
            force = Harmonic(constant, cosine, sine, force.omega)
            object.__setattr__(self, "force", force)

    def _keep_sparse(self) -> None:
        M = sparse.matrix("M", self.M)
        square = (M.shape[0], M.shape[0])
        object.__setattr__(self, "M", sparse.mass_matrix("M", sparse.matrix("M", M, square)))
        for name, value in (("C", self.C), ("K", self.K)):
            kept = sparse.zero(len(M.indptr) - 1) if value is None else sparse.matrix(name, value, square)
            object.__setattr__(self, name, kept)
        sparse.symmetric("K", self.K)

    @property
    def sparse(self) -> bool:
        """Whether the matrices are kept as scipy.sparse ones."""
        return sparse.is_sparse(self.M)

    @property
    def n_q(self) -> int:
        """Number of coordinates."""
        M: Any = self.M
        return int(M.shape[0])

    def trial(self, t: float, q: Array, v: Array, p: Array) -> None:
        """Evaluate every callback once in plain Python; raises ValueError where one does not fit."""
        at = (t, q, v, p)
        if callable(self.force):
            checks.evaluate("system.force", self.force, at, (self.n_q,))
        if self.frame is not None:
            checks.evaluate("system.frame", self.frame, at, (self.n_q, 3))


@dataclass(frozen=True, eq=False)
class System(Pickled):
    """M(t, q) v' = f(t, q, v): any Lagrangian system, its mass matrix and forces as functions.

    Parameters
    ----------
    n_q : number of coordinates
    mass : callback filling out (n_q, n_q), or a constant (n_q, n_q) matrix   M [kg]
    force : callback filling out (n_q,)   f = F_ext - N - F_int [N]
    force_q, force_v : callbacks filling out (n_q, n_q), or None
        Jacobians df/dq and df/dv; differenced where not given.
    potential : callback filling out (1,), or None
        Potential energy V(t, q) [J] of the part of the force that has one, for the energy balance only.

    Raises
    ------
    ValueError   a shape does not fit, or a constant mass matrix is not symmetric positive definite
    """

    n_q: int
    mass: Callback | ArrayLike
    force: Callback
    force_q: Callback | None = None
    force_v: Callback | None = None
    potential: Callback | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "n_q", checks.count("n_q", self.n_q))
        checks.callbacks(self, ("force",), ("force_q", "force_v", "potential"))
        if not callable(self.mass):
            M = checks.array("mass", self.mass, (self.n_q, self.n_q))
            object.__setattr__(self, "mass", checks.mass_matrix("mass", M))

    def trial(self, t: float, q: Array, v: Array, p: Array) -> None:
        """Evaluate every callback once in plain Python; raises ValueError where one does not fit."""
        at, square = (t, q, v, p), (self.n_q, self.n_q)
        checks.evaluate("system.force", self.force, at, (self.n_q,))
        if callable(self.mass):
            checks.mass_matrix("system.mass", checks.evaluate("system.mass", self.mass, at, square))
        if self.potential is not None:
            checks.evaluate("system.potential", self.potential, at, (1,))
        for name, f in {"force_q": self.force_q, "force_v": self.force_v}.items():
            if f is not None:
                checks.evaluate(f"system.{name}", f, at, square)
