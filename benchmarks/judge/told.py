"""Until when the law of impact leaves no choice, and states of a run that the judge asks for, looked up at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import Run
from lcpstep.trajectory import Kind

LOOKS = 160


def looks(d: Description, end: float) -> Any:
    """Times that all step methods reach by whole steps: between them states are interpolated, at order one or two."""
    start = d.t_span[0]
    steps = (end - start) / d.h
    whole = np.unique(np.linspace(1, max(1, int(steps + 1e-9)), LOOKS).astype(int))
    times = start + whole[whole <= steps + 1e-9] * d.h
    return np.minimum(times, end) if len(times) else np.array([end])


def whole(r: Run) -> Any:
    """The beginning, the middle and the end of what was computed."""
    t = r.motion.t
    return np.array([t[0], 0.5 * (t[0] + t[-1]), t[-1]])


def look_up(d: Description, r: Run, times: Any) -> None:
    """Everything that is asked for of a run's states, at once: those between steps may take it another run."""
    r.ask(whole(r), times[times <= r.motion.t[-1]], before(d, r))


def together(d: Description, r: Run) -> float:
    """How near impacts are that a method may take as one."""
    return 2.0 * d.h if r.method.startswith("moreau") else 1e-9 * d.length + 1e-6 * d.h


def told_until(d: Description, r: Run) -> float:
    """Until when the law of impact leaves no choice: the first time at which coupled contacts strike at once.

    Of those that arrive together one may bear the whole impulse, and be the only one in the log.
    """
    log, spread, times = blows(d, r), together(d, r), before(d, r)
    if not len(log):
        return np.inf
    fast, W = np.max(np.abs(log.before)), _coupling(d)
    near = np.flatnonzero((np.diff(log.time) <= spread) & (np.diff(log.contact) != 0))
    logged = [log.time[k] for k in near if W[log.contact[k], log.contact[k + 1]]]
    try:
        q, v = r.at(times)
    except (IndexError, ValueError):  # a finding of its own
        return float(min(logged, default=np.inf)) - spread
    at_start = (times <= r.motion.t[0])[:, None]  # where what is kept has been struck
    g, u = physics.gaps(d, times, q), physics.rates(d, times, q, np.where(at_start, np.array(d.v0), v))
    arrive = (u < -1e-6 * fast) & (g + 2.0 * spread * u <= 0.0)
    pairs = np.einsum("ki,ij,kj->k", arrive, W & ~np.eye(d.contacts, dtype=bool), arrive, dtype=int)
    return float(min([*logged, *log.time[pairs > 0]], default=np.inf)) - spread


def blows(d: Description, r: Run) -> Any:
    """Impacts proper by which a contact that comes nearer is struck; none of a contact that is alone."""
    log = r.motion.impacts
    log = log[(log.kind == Kind.IMPACT) & (log.before < 0.0)]
    if d.contacts < 2 or not len(log):
        return log[:0]
    return log[log.before < -1e-10 * np.max(np.abs(log.before))]


def before(d: Description, r: Run) -> Any:
    """Times just before these."""
    return np.maximum(blows(d, r).time - together(d, r), r.motion.t[0])


def _coupling(d: Description) -> Any:
    if d.curved or d.J or d.nonlinear:
        return np.ones((d.contacts, d.contacts), dtype=bool)
    rows = [np.array(d.G), *([np.array(d.T)] if d.T else [])]
    W = sum(np.abs(a @ np.linalg.solve(d.matrix("M"), b.T)) for a in rows for b in rows)
    return 1e-14 * np.max(W) < W
