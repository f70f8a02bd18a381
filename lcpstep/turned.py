"""Whether steps of a finished run are short enough for what turns within them: pressed obstacles and joints.

    cos(angle) = G0 M^-1 G1^T / sqrt(G0 M^-1 G0^T  G1 M^-1 G1^T),    G0, G1: a row's Jacobian at both ends of the step

A row that carries an impulse and turns by more than a radian has turned the motion by as much in one step: no order
helps there, what comes out may be anything, and nothing that is looked at afterwards need tell (the gap is closed
again, energy has come and gone). A light body that a round joint or a bent obstacle turns about under a heavy one is
so fast for a moment only, wherefore the fastest steps are asked. Steps by a tolerance are not asked.
Source of the bound: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), section
II.1: methods of order p <= 4 with so many stages are unbounded beyond |h lambda| = 2.8.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, LinearJoints
from lcpstep.faults import cause, forget
from lcpstep.trajectory import Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.kernels.model import Model

LOOKS = 16  # steps that are looked at, the fastest ones
LEAST = math.cos(1.0)  # of the cosine: a radian in a step
LATER = 1e-9  # of a step: of the times of its ends


def turned(run: Trajectory) -> str:
    """Which row turns too far within a step, in words; "" where none does that was looked at."""
    h = getattr(run.method, "h", 0.0)
    stepped = h > 0.0 and getattr(run.method, "tolerance", None) is None
    if not stepped or run.status != Status.DONE or len(run.t) < 2:
        return ""
    scene = run.scene
    words = ""
    if scene.contacts is not None and not isinstance(scene.contacts, LinearContacts):
        from lcpstep.model import looked_at

        words = _too_far(run, looked_at(scene), run.impulse > 0.0, h, "the obstacle of contact")
    if not words and scene.joints is not None and not isinstance(scene.joints, LinearJoints):
        from lcpstep.model import joint_model

        held = np.ones((len(run.t), scene.n_j), dtype=bool)
        words = _too_far(run, joint_model(scene), held, h, "joint")
    cause()  # a callback that fails at a state that the run has not asked it for
    forget()
    return words


def _too_far(run: Trajectory, m: Model, held: NDArray[np.bool_], h: float, what: str) -> str:
    """The row that turns farthest in one of the steps looked at, in words; held : (n, rows) at the kept states."""
    from lcpstep.kernels.states import responses

    k = _fastest(run, h, held)
    if len(k) == 0:
        return ""
    G0, MG0 = responses(m, run.t[k], run.q[k], run.v[k])
    G1, MG1 = responses(m, run.t[k + 1], run.q[k + 1], run.v[k + 1])
    with np.errstate(all="ignore"):
        squares = np.einsum("krn,krn->kr", G0, MG0) * np.einsum("krn,krn->kr", G1, MG1)
        cosine = np.einsum("krn,krn->kr", G1, MG0) / np.sqrt(squares)
    cosine = np.where(held[k] & held[k + 1], cosine, 1.0)
    worst = int(np.argmin(cosine))  # the first that is not-a-number, if any is
    if cosine.flat[worst] >= LEAST:
        return ""
    i, c = np.unravel_index(worst, cosine.shape)
    angle = float(np.arccos(np.clip(np.nan_to_num(cosine[i, c], nan=-1.0), -1.0, 1.0)))
    start, end = run.t[k[i]], run.t[k[i] + 1]
    return (
        f"{what} {c} turns by {angle:.3g} radian within a step at t = {start:.9g} s: steps are too long for "
        f"this motion, which needs some below {(end - start) * 0.1 / angle:.3g} s there"
    )


def _fastest(run: Trajectory, h: float, held: NDArray[np.bool_]) -> Any:
    """Kept states from which a step, with something held at both of its ends, begins or ends fastest."""
    square = np.einsum("ij,ij->i", run.v, run.v)
    way, pressed = run.t[1:] - run.t[:-1], held[:, 0] if held.shape[1] == 1 else held.any(axis=1)
    there = (way > 0.0) & (way <= h * (1.0 + LATER)) & pressed[:-1] & pressed[1:]
    rate = np.where(there, square[:-1] + square[1:], -1.0)
    k = np.argpartition(rate, max(len(rate) - LOOKS, 0))[-LOOKS:]
    return k[rate[k] >= 0.0]
