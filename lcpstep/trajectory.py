"""The answer of a simulation: states, impulses, an impact log, and how the run went."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene
from lcpstep.answer import Answer, asked

Array = NDArray[np.float64]


class Status(IntEnum):
    """How a run ended. Kernels return the number, people read the name.

    Attributes
    ----------
    DONE : the end of the span is reached
    INTERRUPTED : by Ctrl-C
    NOT_FINITE : a callback, or the motion, left the finite numbers
    LCP_FAILED : the complementarity solver said no
    NEWTON_FAILED : the implicit step did not converge
    TOO_MANY_EVENTS : events faster than the bound allows
    STEP_TOO_SMALL : the tolerance cannot be met, or only by steps without end
    JOINTS_FAILED : joints contradict each other
    PROJECTION_FAILED : no position near satisfies all joints and contacts
    ENDLESS_SWITCHING : modes follow one another for ever at one instant
    NOT_TRANSVERSAL : a guard is touched, and tolerances decide whether it acts
    PAINLEVE_INCONSISTENT : with friction no contact forces keep a sliding contact from passing the surface
    PAINLEVE_INDETERMINATE : with friction a sliding contact may as well stay closed as open
    """

    DONE = 0
    INTERRUPTED = 1
    NOT_FINITE = 2
    LCP_FAILED = 3
    NEWTON_FAILED = 4
    TOO_MANY_EVENTS = 5
    STEP_TOO_SMALL = 6
    JOINTS_FAILED = 7
    PROJECTION_FAILED = 8
    ENDLESS_SWITCHING = 9
    NOT_TRANSVERSAL = 10
    PAINLEVE_INCONSISTENT = 11
    PAINLEVE_INDETERMINATE = 12


class Kind(IntEnum):
    """What happened at a contact.

    `Moreau` tells no SLIP, STICK_TANGENT and REVERSE; they have sliding velocities in `before` and `after`.

    Attributes
    ----------
    IMPACT : velocity jump; of `Moreau` the first step in which a contact bears
    ACCUMULATION : infinitely many impacts end here (complete chattering)
    STICK : the contact stays closed from here on; of `Moreau` the second step in a row in which it bears
    RELEASE : a closed contact opens
    SLIP : a contact that stuck slides
    STICK_TANGENT : a contact that slid sticks
    REVERSE : a contact slides the other way
    JAM : sliding without a force that would hold the contact: an impact without collision
    """

    IMPACT = 0
    ACCUMULATION = 1
    STICK = 2
    RELEASE = 3
    SLIP = 4
    STICK_TANGENT = 5
    REVERSE = 6
    JAM = 7


# time [s], contact, gap velocity before and after [m/s], impulse [N s], kind (a `Kind`)
IMPACT_DTYPE = np.dtype(
    [
        ("time", "f8"),
        ("contact", "i4"),
        ("before", "f8"),
        ("after", "f8"),
        ("impulse", "f8"),
        ("kind", "i4"),
    ]
)


def blows(log: Any) -> Any:
    """The rows of a log at which velocities jump."""
    return log[np.isin(log.kind, (Kind.IMPACT, Kind.JAM))]


@dataclass(frozen=True)
class Counts:
    """Work done by a run.

    Attributes
    ----------
    steps : of the method, or of its integrator
    lcp_calls : complementarity problems solved, by methods that step
    force_evaluations : evaluations of all forces together
    events : lines of the log
    """

    steps: int = 0
    lcp_calls: int = 0
    force_evaluations: int = 0
    events: int = 0


@dataclass(frozen=True, eq=False)
class Trajectory(Answer):
    """A motion with impacts.

    Attributes
    ----------
    t : (n,)   times of the kept states [s]
    q, v : (n, n_q)   coordinates and velocities; v is the right limit, after an impact at that time
    impulse : (n, n_c)   impulse of each contact since the state before [N s], the contact force's included
    impacts : record array (n_events,), in the order of time
        Fields time [s], contact, before, after (gap velocities [m/s], or sliding ones, see `Kind`), impulse [N s],
        kind (`Kind`). Of `Moreau` time is the end of the step, before the velocity at its start, and the impulse
        includes that of the step's forces.
    status : Status   DONE, or why the run ended early; `message` says it in words
    doubt : what is wrong with a run although it is DONE; also part of `message`, and "" where nothing is known
    audit : lcpstep.audit.Audit   what could be shown to be free of unnoticed events; None where it was not asked for
    counts : Counts   steps, complementarity problems solved (by methods that step), force evaluations, events
    joint_impulse : (n, n_j)   impulse of each joint since the state before [N s]
    friction_impulse : (n, n_c)   impulse of each contact's friction since the state before [N s]; no columns
        where the scene has none
    scene, method : the question, and how it was answered
    error : how far all this can be trusted, a `lcpstep.errorbar.bars.ErrorBar`; None where it was not asked for
    """

    scene: Scene
    method: Any
    t: Array
    q: Array
    v: Array
    impulse: Array
    impacts: Any
    status: Status
    message: str
    counts: Counts
    dense: Callable[[Array], tuple[Array, Array]]
    joint_impulse: Array = field(default_factory=lambda: np.zeros((0, 0)))
    friction_impulse: Array = field(default_factory=lambda: np.zeros((0, 0)))
    doubt: str = ""
    error: Any = None
    audit: Any = None

    def at(self, t: ArrayLike) -> tuple[Array, Array]:
        """State at any time of the run.

        Parameters
        ----------
        t : number or (m,)   times within [self.t[0], self.t[-1]] [s]

        Returns
        -------
        q, v : (n_q,) for a number, (m, n_q) for an array; v is the right limit at an impact

        Raises
        ------
        ValueError   t has two dimensions, or a time lies outside the run or between states that were not kept
        """
        q, v = self.dense(asked(t, self.t))
        return (q[0], v[0]) if np.ndim(t) == 0 else (q, v)

    @property
    def penetration(self) -> Array:
        """(n_c,) how deep each contact lay inside its obstacle at worst, over the kept states [m]."""
        from lcpstep.gaps import lowest_and_highest

        lowest, _ = lowest_and_highest(self.scene, self.t, self.q, self.v)
        return np.maximum(0.0, 0.0 - lowest)

    @property
    def joint_drift(self) -> Array:
        """(n_j,) how far each joint was open at worst, over the kept states [m]."""
        from lcpstep.gaps import lowest_and_highest

        lowest, highest = lowest_and_highest(self.scene, self.t, self.q, self.v, joints=True)
        return np.maximum(-lowest, highest)

    def __repr__(self) -> str:
        span = f"t = {self.t[0]:g} .. {self.t[-1]:g} s, " if len(self.t) else ""
        return (
            f"Trajectory({self.scene.name}, {self.method}, {span}"
            f"{len(self.t)} states, {len(self.impacts)} events, {self.status.name})"
        )
