"""The state of a system whose motion between events is a parabola, under the names of mechanics."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.rows.chatter import find_stop
from lcpstep.events.rows.contacts import Contacts, add_impulse, count_impulses, hold_modes
from lcpstep.events.rows.equations import size_of
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.together import gap_rounding
from lcpstep.kernels.vectors import add, copy
from lcpstep.pointers import abs, after, inf, max
from lcpstep.shelf import Shelf


class Mechanism(Contacts):
    """Contacts and joints whose gaps and velocities are carried along, not computed from q, v.

    So small ones keep their digits; what touches has a gap of zero.

    length            duration of the last flight
    bare              whether the acceleration is that without contacts
    state             q0, v0 as Python sees them
    q0, v0            state at the base time;  q, v  state last asked for
    n_members         of the problem, contacts that are closed;  lift : (n_c,)   rounding of its rates
    synchronous : (n_c,)   whether gap and velocity are those of q, v

    Parameters
    ----------
    model, joints : Model;  n_j : how many joints;  tolerances : rtol, atol;  t_span : (start, end)
    """

    def __init__(
        self, model: Model, joints: Model, n_j: int, tolerances: tuple[float, float], t_span: tuple[float, float]
    ) -> None:  # fmt: skip
        Contacts.__init__(self, model, joints, n_j, model, 0, tolerances, t_span, (), inf)
        n, n_c = self.n_q, self.n_c
        self.length, self.bare, self.n_members = 0.0, False, 0
        self.state, self.numbers = np.zeros(2 * n), np.zeros(2 * n + 2 * n_c)
        self.q0 = doubles(self.state)
        self.v0 = after(self.q0, n)
        x = Shelf(self.numbers)
        self.q, self.v, self.lift, self.synchronous = x.take(n), x.take(n), x.take(n_c), x.take(n_c)

    def start(self, q: Any, v: Any) -> None:
        """Begin with the state q, v (n_q,)."""
        self.state[: self.n_q], self.state[self.n_q :] = q, v
        copy(self.q, self.q0, self.n_q)
        copy(self.v, self.v0, self.n_q)

    def noise(self, c: int) -> float:
        """Rounding of the gap velocity of a contact, that of the earlier impacts of the same instant included.

        Contact forces may have held against what the others would have made of it in the step before.
        """
        i, size = self.n_j + c, 0.0
        for j in range(self.n_q):
            size += abs(self.R[i * self.n_q + j]) * (abs(self.v[j]) + self.length * abs(self.a_free[j]))
        self.terms[c] = max(NOISE * size, self.terms[c])
        return self.terms[c]

    def rounding_of_gap(self, c: int) -> float:
        """What rounding may leave of gap c, of the way included by which it has come in the last step."""
        way = self.length * size_of(self, self.n_j + c, 0.0, self.v) if self.length > 0.0 else 0.0
        return gap_rounding(self.model, after(self.R, self.n_j * self.n_q), self.q, c, way)

    def push(self, i: int, p: float) -> None:
        """Apply the impulse p on row i, to the velocities of contacts as well, and count it."""
        if p != 0.0:
            self.move(i, p)
            add_impulse(self, i, p)

    def move(self, i: int, p: float) -> None:
        """The same, not counted."""
        add(self.v, p, after(self.MR, i * self.n_q), self.n_q)
        for c in range(self.n_c):
            k = self.n_j + c
            if self.D[k * self.n_r + i] != 0.0:
                du = self.D[k * self.n_r + i] * p
                self.terms[c] = max(self.terms[c], NOISE * abs(du))
                self.velocity[k] = self.velocity[k] + du
                self.synchronous[c] = 0.0

    def stop(self) -> None:
        """Take their velocities from the closed contacts."""
        self.halt()
        count_impulses(self, self.change)

    def halt(self) -> None:
        """The same, by impulses on the rows held that lie in `change`, and are not counted."""
        hold_modes(self)
        find_stop(self)
        for m in range(self.n_held):
            self.move(self.row[m], self.change[m])
        for c in range(self.n_c):
            if self.mode[c] != 0:
                self.velocity[self.n_j + c] = 0.0
