"""Whether steps of a finished run are short enough for what turns within them: pressed obstacles and joints.

    cos(angle) = G0 M^-1 G1^T / sqrt(G0 M^-1 G0^T  G1 M^-1 G1^T),    G0, G1: a row's Jacobian at both ends of the step

A row that carries an impulse and turns by more than a radian has turned the motion by as much in one step: no order
helps there, what comes out may be anything, and nothing that is looked at afterwards need tell (the gap is closed
again, energy has come and gone). Between two impacts that have their own times nothing is held. A light body that a
round joint or a bent obstacle turns about under a heavy one is so fast for a moment only, wherefore fast steps are
asked (`kernels/turned.py`). Steps by a tolerance are not asked.
Source of the bound: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), section
II.1: methods of order p <= 4 with so many stages are unbounded beyond |h lambda| = 2.8.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrangian import LinearContacts, LinearJoints
from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts.depth import fixed_step
from lcpstep.trajectory import Kind, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.kernels.model import Model

LOOKS = 64  # steps that are looked at, the fastest of each part of the run
LEAST = math.cos(1.0)  # of the cosine: a radian in a step
LATER = 1e-9  # of a step: of the times of its ends
SHARE = 0.1  # of a radian: what steps that resolve the motion turn by
STILL = 1e-9  # of the speed of a motion: a slower approach is that of a closed contact


def turned(run: Trajectory) -> str:
    """Which row turns too far within a step, in words; "" where none does that was looked at."""
    (bent, round_), words = asked(run), ""
    if not (bent or round_):
        return ""
    # Not before it is asked for: that loads what compiles callbacks
    from lcpstep.model import joints_looked_at, looked_at

    if bent:
        words = _too_far(run, looked_at(run.scene), run.impulse, "the obstacle of contact")
    if round_ and not words:
        words = _too_far(run, joints_looked_at(run.scene), None, "joint")
    cause()  # a callback that fails at a state that the run has not asked it for
    forget()
    return words


def asked(run: Trajectory) -> tuple[bool, bool]:
    """Whether it has contacts, and joints, that can turn, and steps of one size, and matrices that are small."""
    contacts, joints, method = run.scene.contacts, run.scene.joints, run.method
    bent = contacts is not None and not isinstance(contacts, LinearContacts)
    round_ = joints is not None and not isinstance(joints, LinearJoints)
    if not (bent or round_) or run.status != Status.DONE or len(run.t) < 2:
        return False, False
    from lcpstep.model import LARGEST_KEPT

    return (bent, round_) if fixed_step(method) > 0.0 and run.scene.n_q <= LARGEST_KEPT else (False, False)


def _too_far(run: Trajectory, m: Model, impulse: Any, what: str) -> str:
    """The row that turns farthest in one of the steps looked at, in words; impulse : None where all hold always."""
    from lcpstep.kernels.turned import farthest_turn

    held = None if impulse is None else _held(run)
    cosine, k, c = farthest_turn(m, run.t, run.q, run.v, impulse, held, run.method.h * (1.0 + LATER), LOOKS)
    if cosine >= LEAST:
        return ""
    angle, start, end = math.acos(max(-1.0, cosine)), run.t[int(k)], run.t[int(k) + 1]
    return (
        f"{what} {int(c)} turns by {angle:.3g} radian within a step at t = {start:.9g} s: steps are too long for "
        f"this motion, which needs some below {(end - start) * SHARE / angle:.3g} s there"
    )


def _held(run: Trajectory) -> Any:
    """(n, n_c) the impulses of contacts since the state before, without those that have struck in between.

    Of steps that place impacts at their own times; others strike what they press.
    """
    if not hasattr(run.method, "order"):
        return run.impulse
    log, held = run.impacts, run.impulse.copy()
    struck = (log.kind == Kind.IMPACT) & (log.before < -STILL * float(np.max(np.abs(run.v))))
    k = np.searchsorted(run.t, log.time[struck])
    held[np.minimum(k, len(held) - 1), log.contact[struck]] = 0.0
    return held
