"""A companion of runs in closed form: oscillators above a fixed obstacle, by conservative advancement (`advance`).

It shares neither formulas nor search with the event-driven method, and has no step: an impact takes some ten
evaluations of the motion.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.errorbar.advance import Advance
from lcpstep.errors import LcpStepError, SimulationInterrupted
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.model import Model
from lcpstep.kernels.status import DONE, STEP_TOO_SMALL
from lcpstep.model import looked_at
from lcpstep.recording import LOGGED, Kept, in_order
from lcpstep.stepping.again import Again
from lcpstep.trajectory import IMPACT_DTYPE, Counts, Status, Trajectory

Array = NDArray[np.float64]
ROWS = 8192  # of the log, between two looks at the outside world
NEAR = 1e-3  # resonance, relative: the steady oscillation loses digits
DAMPED = 0.9  # of critical damping: beyond it the formulas lose digits
SURFACE = 1e-15  # of the size of gaps: a gap at the start that is none


@dataclass(frozen=True)
class Advancement:
    """Conservative advancement of one oscillating coordinate above a fixed flat obstacle."""

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion, with states at the times that are kept; LcpStepError where it does not treat the scene."""
        if not treats(scene):
            raise LcpStepError("scene: not one oscillator above a fixed flat obstacle")
        m, times = looked_at(scene), np.ascontiguousarray(kept.times)
        states, log = np.zeros((len(times), 2)), np.empty((ROWS, COLUMNS))
        a = Advance(_numbers(m, scene), times, states, log)
        rows, stopped = _events(a, log, progress)
        states[:, 0] -= m.arrays["offset"][0]
        states /= m.arrays["G"][0, 0]
        run = _trajectory(self, scene, times[: a.next], states[: a.next], rows, a, stopped)
        if stopped:
            raise SimulationInterrupted(lambda: run)
        return run


def treats(scene: Scene) -> bool:
    """Whether it treats a scene, but for numbers near resonance or critical damping."""
    s, c = scene.system, scene.contacts
    if not (isinstance(s, LinearSystem) and isinstance(s.force, Harmonic) and s.frame is None):
        return False
    flat = isinstance(c, LinearContacts) and c.motion is None and c.friction is None
    return flat and scene.n_q == 1 and scene.n_c == 1 and scene.n_j == 0


def _events(a: Advance, log: Array, progress: Callable[[float], None]) -> tuple[Array, bool]:
    """Rows of the log up to the end, or to an interrupt, and whether there was one."""
    found, code = [], -1
    while code != DONE:
        code = a.go_on()
        if code == STEP_TOO_SMALL:
            raise LcpStepError("a flight that does not come on")
        found.append(log[: a.rows].copy())
        try:
            progress(a.t)
        except KeyboardInterrupt:
            return np.concatenate(found), True
    return np.concatenate(found), False


def _trajectory(
    method: Any, scene: Scene, t: Array, states: Array, rows: Array, a: Advance, stopped: bool
) -> Trajectory:
    q, v = states[:, :1].copy(), states[:, 1:].copy()
    status, message = (
        (Status.INTERRUPTED, "interrupted") if stopped else (Status.DONE, "reached the end of the span")
    )
    last = (x[-1] if len(t) else np.zeros(1) for x in (q, v))
    none = np.zeros((len(t), 0))
    return Trajectory(
        scene=scene, method=method, t=t, q=q, v=v, impulse=np.zeros((len(t), 1)),
        impacts=_logged(rows, scene.t_span[1]), status=status, message=message,
        counts=Counts(a.steps, events=a.events), dense=Again(method, scene, *last), joint_impulse=none,
        friction_impulse=none,
    )  # fmt: skip


def _logged(rows: Array, end: float) -> Any:
    """Rows of a log as the impact log of a trajectory."""
    rows = in_order(rows, end)
    log = np.empty(len(rows), dtype=LOGGED)
    for k, name in enumerate(IMPACT_DTYPE.names or ()):
        log[name] = rows[:, k]
    return log.view(np.recarray)


def _numbers(m: Model, scene: Scene) -> dict[str, float]:
    """What `Advance` is given: the equation of motion of the gap, and its state at the start."""
    M, C, K, G, offset, constant, cosine, sine, r = (
        float(m.arrays[x].flat[0])
        for x in ("M", "C", "K", "G", "offset", "constant", "cosine", "sine", "restitution")
    )
    q0, v0 = (float(np.asarray(x)[0]) for x in (scene.q0, scene.v0))
    delta, w2, Omega = 0.5 * C / M, K / M, m.omega
    if Omega == 0.0:
        constant, cosine, sine = constant + cosine, 0.0, 0.0
    a, b = w2 - Omega * Omega, 2.0 * delta * Omega
    F0, Fc, Fs = G * constant / M + w2 * offset, G * cosine / M, G * sine / M
    size = abs(offset) + abs(G * q0) + (abs(F0) + math.hypot(Fc, Fs)) / max(w2, 1e-300)
    near = math.hypot(a, b) < NEAR * (w2 + Omega * Omega) and (cosine != 0.0 or sine != 0.0)
    if not (w2 > 0.0 and 0.0 <= delta * delta < DAMPED * w2 and delta >= 0.0) or near or Omega < 0.0:
        raise LcpStepError("no damped oscillation away from resonance")
    X, Y = np.linalg.solve([[a, b], [-b, a]], [Fc, Fs]) if Fc != 0.0 or Fs != 0.0 else (0.0, 0.0)
    g, u = offset + G * q0, G * v0
    if g <= SURFACE * size:
        g = 0.0
    return {
        "delta": delta, "w2": w2, "F0": F0, "Fc": Fc, "Fs": Fs, "Omega": Omega, "X": float(X), "Y": float(Y),
        "r": r, "push": M / (G * G), "t": scene.t_span[0], "g": g, "u": u, "t_end": scene.t_span[1], "size": size,
    }  # fmt: skip
