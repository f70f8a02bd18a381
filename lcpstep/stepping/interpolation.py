"""States between the kept ones of a run, as the method itself moves within a step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Between = Callable[[Array], tuple[Array, Array]]


def linear(t: Array, q: Array, v: Array, every_step: bool) -> Between:
    """Positions and velocities linear within a step: the theta-method.

    Parameters
    ----------
    t : (n,) times of the kept states [s]
    q, v : (n, n_q) the states
    every_step : whether all steps were kept; if not, only the kept states are known

    Returns
    -------
    Function of times (m,) within t; it raises ValueError for one between states that are not known
    """

    def at(times: Array) -> tuple[Array, Array]:
        i = before(t, times)
        if len(t) == 1:
            return q[i], v[i]
        share = (times - t[i]) / (t[i + 1] - t[i])
        known(every_step, (share == 0.0) | (share == 1.0))
        share = share[:, None]
        return (1.0 - share) * q[i] + share * q[i + 1], (1.0 - share) * v[i] + share * v[i + 1]

    return at


def parabolic(t: Array, q: Array, v: Array, every_step: bool) -> Between:
    """The parabola through both positions that leaves with the first velocity; otherwise as `linear`."""

    def at(times: Array) -> tuple[Array, Array]:
        i = before(t, times)
        if len(t) == 1:
            return q[i], v[i]
        last, length = times == t[-1], (t[i + 1] - t[i])[:, None]
        tau = (times - t[i])[:, None]
        known(every_step, (tau[:, 0] == 0.0) | last)
        half = (q[i + 1] - q[i] - length * v[i]) / length**2
        q_at, v_at = q[i] + tau * (v[i] + tau * half), v[i] + 2.0 * tau * half
        q_at[last], v_at[last] = q[-1], v[-1]
        return q_at, v_at

    return at


def before(t: Array, times: Array) -> NDArray[np.intp]:
    """Places of the states from which the given times are reached."""
    return np.clip(np.searchsorted(t, times, side="right") - 1, 0, max(len(t) - 2, 0))


def known(every_step: bool, kept: Any) -> None:
    """ValueError unless all states asked for are known."""
    if not (every_step or np.all(kept)):
        raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
