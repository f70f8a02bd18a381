"""Coefficients of friction in steps of large sparse systems: the law of `kernels.stiction`, on whole vectors.

What stuck before a step has mu_s as long as that keeps it from sliding, what slides has mu, and sticks with mu_s
where it would turn about within the step; each contact changes to and fro once at most.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Coulomb, Harmonic, Scene
from lcpstep.model import coefficients
from lcpstep.stepping.sparse.coulomb import Coupled, Point, Problem
from lcpstep.stepping.sparse.path import STICK

Array = NDArray[np.float64]
AT_REST = 1e-12  # of the terms of a sliding velocity: less is rounding; see `kernels.repose`, `stiction`
SLIDES, STICKS, GIVES_WAY, MEETS = range(4)  # what has been tried of a contact; the last one meets a blow


class Stiction:
    """The coefficients of all contacts at the state last measured, and which of the contacts stick.

    mu, mu_s : (n_c,)   of what slides, and of what sticks
    rough : (n_c,)      contacts that have any friction, or may have
    sticks : (n_c,)     contacts that the last step kept from sliding
    """

    def __init__(self, scene: Scene, friction: Coulomb | None) -> None:
        n_c = scene.n_c
        self.kernel, self.given = coefficients(scene), None if friction is None else friction.slip
        self.varies, self.sticks = bool(self.kernel.varies), np.zeros(n_c, dtype=bool)
        system: Any = scene.system
        self.M = system.M.tocoo(copy=True)
        self.M.eliminate_zeros()
        self.mu, self.mu_s = np.zeros((2, n_c))
        if not self.varies:
            self.measure(scene.t_span[0], np.array(scene.q0), np.zeros(n_c))
        self.rough = self.varies | (self.mu_s > 0.0)

    def slip(self, t: float) -> Array:
        """Sliding velocities at v = 0."""
        given: Any = self.given
        if isinstance(given, Harmonic):
            return given.at(t, len(self.mu))
        return np.zeros(len(self.mu)) if given is None else np.asarray(given)

    def measure(self, t: float, q: Array, u: Array) -> bool:
        """The coefficients at the sliding velocities u; False where one is negative or no number."""
        measured = self.kernel.measured(t, q, np.where(self.sticks, 0.0, u))
        if measured is None:
            return False
        self.mu, self.mu_s = measured
        return True

    def solve(
        self, coupled: Coupled, problem: Problem, modes: Any, p: Array, sliding: Array, strikes: Any
    ) -> Point:
        """The answer with the coefficients that fit it; those of `problem` do not count.

        sliding : (n_c,)   sliding velocities at the start of the step
        strikes : (n_c,)   contacts that strike in it: these, and all that they reach (`connected`), meet mu
        """
        tried = np.where(self.sticks, STICKS, SLIDES)
        if self.kernel.two and np.any(strikes):
            tried[connected(self.M, coupled, problem, strikes)] = MEETS
        mu = np.where(tried == STICKS, self.mu_s, self.mu)
        while True:
            point = coupled.solve(problem._replace(mu=mu), modes, p)
            if not self.kernel.two or not point.solved:
                return point
            u, size = self.rates(coupled, problem, point)
            moves = problem.rough & (np.abs(u) > AT_REST * size)
            gives_way = moves & (point.modes > STICK) & (tried == STICKS)
            turns = moves & (tried == SLIDES) & (u * sliding <= 0.0)
            if not np.any(gives_way | (turns & (point.modes > STICK))):
                return point
            tried = np.where(gives_way, GIVES_WAY, np.where(turns, STICKS, tried))
            mu = np.where(gives_way, self.mu, np.where(turns, self.mu_s, mu))
            modes, p = point.modes, point.p

    def note(self, coupled: Coupled, problem: Problem, point: Point, u: Array, rebound: Any) -> None:
        """Which contacts do not slide at the end of a step, those among them that nothing presses at the moment.

        u, rebound : (n_c,)   their sliding velocities then; what restitution has added to those of the problem
        """
        size = self.rates(coupled, problem, point)[1]
        still = ((point.modes == STICK) & (rebound == 0.0)) | (np.abs(u) <= AT_REST * size)
        self.sticks = problem.rough & still

    def rates(self, coupled: Coupled, problem: Problem, point: Point) -> tuple[Array, Array]:
        """Sliding velocities at an answer, and the sizes of their terms."""
        T = slice(coupled.n_r - coupled.n_c, None)
        u = (coupled.R @ point.x + problem.b)[T]
        return u, (problem.size + coupled.abs_R @ (point.size_x / coupled.diagonal))[T]


def connected(M: Any, c: Coupled, problem: Problem, strikes: Any) -> Any:
    """Contacts (n_c,) that impulses connect with those that strike, by masses, joints or active contacts.

    Springs and dampers carry no impulses, though a step's matrix has them, too. As `theta_method.reached`, but for
    rows that share coordinates and yet do not move each other, as of the centre of percussion: here these connect.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    total = c.n_q + c.n_r
    bear = np.concatenate([np.ones(c.n_j, dtype=bool), problem.active, problem.rough])[c.row] & (
        c.R.data != 0.0
    )
    normal = c.n_q + c.n_j + np.flatnonzero(problem.rough)
    links = (
        np.concatenate([M.row, c.n_q + c.row[bear], normal]),
        np.concatenate([M.col, c.R.indices[bear], normal + c.n_c]),
    )
    part = connected_components(csr_array((np.ones(len(links[0])), links), shape=(total, total)), False)[1]
    normals = part[c.n_q + c.n_j : total - c.n_c]
    return np.isin(normals, normals[strikes])
