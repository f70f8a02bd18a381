"""States between the kept ones of a run, as the method itself moves within a step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Between(ABC):
    """A function of times (m,) within a run, which can be pickled.

    Parameters
    ----------
    t : (n,) times of the kept states [s]
    q, v : (n, n_q) the states
    every_step : whether all steps were kept; if not, only the kept states are known
    """

    t: Array
    q: Array
    v: Array
    every_step: bool

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q); ValueError for one between states that are not known."""
        i = before(self.t, times)
        return (self.q[i], self.v[i]) if len(self.t) == 1 else self.within(times, i)

    @abstractmethod
    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""


class Linear(Between):
    """Positions and velocities linear within a step: the theta-method."""

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        t, q, v = self.t, self.q, self.v
        share = (times - t[i]) / (t[i + 1] - t[i])
        known(self.every_step, (share == 0.0) | (share == 1.0))
        share = share[:, None]
        return (1.0 - share) * q[i] + share * q[i + 1], (1.0 - share) * v[i] + share * v[i + 1]


class Parabolic(Between):
    """The parabola through both positions that leaves with the first velocity."""

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        t, q, v = self.t, self.q, self.v
        last, length = times == t[-1], (t[i + 1] - t[i])[:, None]
        tau = (times - t[i])[:, None]
        known(self.every_step, (tau[:, 0] == 0.0) | last)
        half = (q[i + 1] - q[i] - length * v[i]) / length**2
        q_at, v_at = q[i] + tau * (v[i] + tau * half), v[i] + 2.0 * tau * half
        q_at[last], v_at[last] = q[-1], v[-1]
        return q_at, v_at


@dataclass(frozen=True, eq=False)
class Bent(Parabolic):
    """The same, whose velocity meets that of the next state, but where it has jumped there.

    As within a step: v + s a + (s / h)^2 (v_next - v - h a), where the parabola alone would leave a gap of order two.

    Parameters
    ----------
    mode : (n,) above zero where the velocity may have jumped at a kept state
    """

    mode: Array

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        q_at, v_at = super().within(times, i)
        t, q, v = self.t, self.q, self.v
        length = (t[i + 1] - t[i])[:, None]
        end = 2.0 * (q[i + 1] - q[i]) / length - v[i]  # where the parabola's velocity arrives
        share = np.where(
            ((self.mode[i + 1] > 0.0) | (times == t[-1]))[:, None], 0.0, (times - t[i])[:, None] / length
        )
        return q_at, v_at + share * share * (v[i + 1] - end)


def before(t: Array, times: Array) -> NDArray[np.intp]:
    """Places of the states from which the given times are reached."""
    return np.clip(np.searchsorted(t, times, side="right") - 1, 0, max(len(t) - 2, 0))


def known(every_step: bool, kept: Any) -> None:
    """ValueError unless all states asked for are known."""
    if not (every_step or np.all(kept)):
        raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
