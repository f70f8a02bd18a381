"""The answer of a run of a system with modes: states, modes, and the log of switches."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian.hybrid import HybridScene
from lcpstep.answer import Answer, asked, require_kept
from lcpstep.events.hybrid.kinds import SWITCH_LEAD
from lcpstep.trajectory import Counts, Status

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pieces:
    """Steps: start t (n,), length h (n,), mode (n,), state x (n, n_x) and dense output (n, 7, n_x), or none."""

    t: Array
    h: Array
    mode: NDArray[np.int64]
    x: Array
    dense: Array


@dataclass(frozen=True, eq=False)
class HybridTrajectory(Answer):
    """A motion of a system with modes.

    Attributes
    ----------
    t : (n,)   times of the kept states
    x : (n, n_x)   states; after the switch at a time that has one
    mode : (n,)   names of the modes from these times on
    switches : record array (m,)
        Fields time, source, target (names of the modes left and entered), guard (its place in the table of all
        guards), before, after (states, (n_x,) each).
    status : Status   DONE, or why the run ended early; `message` says it in words
    counts : Counts   steps, evaluations of the field, switches (`events`)
    scene, method : the question, and how it was answered
    impulse : (n, n_c)   impulse of each contact since the state before [N s], the contact force's included
    friction_impulse : (n, n_c)   impulse of each contact's friction since the state before [N s]; no columns
        without friction
    impacts : record array, the log of the contacts as of a `Trajectory`, or None where there are none
    """

    scene: HybridScene
    method: Any
    t: Array
    x: Array
    mode: NDArray[np.str_]
    switches: Any
    status: Status
    message: str
    counts: Counts
    pieces: Pieces
    impulse: Array = field(default_factory=lambda: np.zeros((0, 0)))
    friction_impulse: Array = field(default_factory=lambda: np.zeros((0, 0)))
    impacts: Any = None

    def at(self, t: ArrayLike) -> Array:
        """State at any time of the run; the right limit where it jumps.

        Parameters
        ----------
        t : number or (m,)   times within the run

        Returns
        -------
        (n_x,) for a number, (m, n_x) for an array

        Raises
        ------
        ValueError   a time lies outside the run, or, of a system with contacts, between states that were not kept
        """
        times, row = self._rows(t)
        s = self.pieces
        if len(s.dense) == 0:
            require_kept(times, s.t)
            return s.x[row[0]] if np.ndim(t) == 0 else s.x[row]
        length = np.where(s.h[row] > 0.0, s.h[row], np.inf)
        with np.errstate(invalid="ignore"):
            fraction = np.clip((times - s.t[row]) / length, 0.0, 1.0)[:, None]
        total = np.zeros((len(times), s.x.shape[1]))
        for k in range(7):
            total = (total + s.dense[row, 6 - k]) * (fraction if k % 2 == 0 else 1.0 - fraction)
        x = s.x[row] + total
        return x[0] if np.ndim(t) == 0 else x

    def mode_at(self, t: ArrayLike) -> Any:
        """Name of the mode at any time of the run, or (m,) names; the later one at a switch."""
        times, _ = self._rows(t)
        entered = np.array([self.scene.mode, *self.switches.target])
        result = entered[np.searchsorted(self.switches.time, times, side="right")]
        return str(result[0]) if np.ndim(t) == 0 else result

    def _rows(self, t: ArrayLike) -> tuple[Array, NDArray[np.intp]]:
        s = self.pieces
        times = asked(t, s.t)
        return times, np.searchsorted(s.t, times, side="right") - 1

    def __repr__(self) -> str:
        met = f"{len(self.impacts)} events of contacts, " if self.impacts is not None else ""
        span = f"t = {self.t[0]:g} .. {self.t[-1]:g}, " if len(self.t) else ""
        return (
            f"HybridTrajectory({self.scene.name}, {self.method}, {span}"
            f"{len(self.t)} states, {len(self.switches)} switches, {met}{self.status.name})"
        )


def log_of(run: HybridTrajectory) -> Array:
    """The switches of a run as kernels write them."""
    names, n = run.scene.system.names, run.scene.n_x
    log = np.zeros((len(run.switches), SWITCH_LEAD + 2 * n))
    log[:, 0], log[:, 3] = run.switches.time, run.switches.guard
    for place, which in ((1, run.switches.source), (2, run.switches.target)):
        log[:, place] = [names.index(str(name)) for name in which]
    log[:, SWITCH_LEAD : SWITCH_LEAD + n] = run.switches.before
    log[:, SWITCH_LEAD + n :] = run.switches.after
    return log
