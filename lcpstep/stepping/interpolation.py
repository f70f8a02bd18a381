"""States between the kept ones of a run, as the method itself moves within a step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.answer import require_kept
from lcpstep.kernels import between

Array = NDArray[np.float64]
NOWHERE = np.zeros(0, dtype=np.uint8)


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
        last, times = len(self.t) - 1, np.ascontiguousarray(times)
        i = between.last_rows(self.t, times, 0, max(last - 1, 0))
        if not self.every_step:
            require_kept(times, self.t)
        return (self.q[i], self.v[i]) if last == 0 else self.within(times, i)

    @abstractmethod
    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""


class Linear(Between):
    """Positions and velocities linear within a step: the theta-method."""

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        return between.on_lines(self.t, self.q, self.v, times, i)


class Parabolic(Between):
    """The parabola through both positions that leaves with the first velocity."""

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        return between.on_parabolas(self.t, self.q, self.v, NOWHERE, times, i)


@dataclass(frozen=True, eq=False)
class Bent(Between):
    """The same, whose velocity meets that of the next state, but where it has jumped there.

    Parameters
    ----------
    mode : (n,) above zero where the velocity may have jumped at a kept state
    """

    mode: Array

    @cached_property
    def jumps(self) -> NDArray[np.bool_]:
        """Where the velocity may have jumped: asked for by whoever looks between states."""
        return np.asarray(self.mode > 0.0)

    def within(self, times: Array, i: Any) -> tuple[Array, Array]:
        """The states in the steps from rows i of the kept ones."""
        return between.on_parabolas(self.t, self.q, self.v, self.jumps.view(np.uint8), times, i)
