"""One level of a study: the method at a few nearby steps or tolerances, its errors, its bars and its time."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from statistics import median

import numpy as np

from lagrangian import Scene
from lcpstep.accuracy.dials import changeable, dial, with_value
from lcpstep.accuracy.errors import Difference
from lcpstep.accuracy.horizon import LOST
from lcpstep.accuracy.reference import Reference
from lcpstep.accuracy.work_precision import Level, Study
from lcpstep.errorbar.companions import KNOWN
from lcpstep.errors import LcpStepError
from lcpstep.pace import counted
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Status, Trajectory

TRUSTED = 10.0  # an error this many times what the reference may be off is the method's own
OF_IMPACTS = ("impact_time", "impact_impulse", "unmatched")
WEAK = 1e-4  # of the strongest impulse; weaker impacts are not matched: methods end chattering differently
PATIENCE = 2.0  # CPU seconds after which a level is timed no more often


def measured(
    scene: Scene, name: str, method: Method, found: Reference, measures: Sequence[str], result: Study, repeats: int,
    spread: Sequence[float], size: float,
) -> Level:  # fmt: skip
    """One level: a run at every nearby step that is measured, and repeated ones that are timed."""
    which, value = dial(method)
    near = [with_value(method, value * s) for s in spread] if changeable(method) else [method]
    value *= math.exp(float(np.mean(np.log(spread)))) if changeable(method) else 1.0
    start = Level(name, repr(method), which, value, "REFUSED")
    errors: dict[str, list[float]] = {m: [] for m in measures}
    counts: list[tuple[int, int, int]] = []
    bars: dict[str, float] = {}
    for k, one in enumerate(counted(near)):
        with_bar = k == len(near) // 2 and isinstance(one, KNOWN)
        try:
            run = simulate(scene, one, error=with_bar)
        except (LcpStepError, ValueError) as error:
            return replace(start, message=str(error))
        if run.status is not Status.DONE:
            return replace(start, status=run.status.name, message=run.message)
        own = _errors(run, found, measures, result.compared_until)
        for measure, found_error in own.items():
            errors[measure].append(found_error)
        bars |= _over_bar(run, own, result.compared_until)
        counts.append((run.counts.steps, run.counts.lcp_calls, run.counts.force_evaluations))
    seconds = _timed(scene, near, repeats)
    steps, lcp_calls, forces = (float(x) for x in np.mean(counts, axis=0))
    means = {m: float(np.mean(e)) for m, e in errors.items() if e}
    unsure = result.uncertainty
    return replace(
        start,
        status=Status.DONE.name,
        errors=means,
        scatter={m: (min(e), max(e)) for m, e in errors.items() if e},
        seconds=median(seconds),
        repeats=len(seconds),
        steps=steps,
        lcp_calls=lcp_calls,
        force_evaluations=forces,
        limited=tuple(m for m, e in means.items() if m != "unmatched" and e < TRUSTED * unsure.get(m, 0.0)),
        separated=means.get("sup_position", 0.0) > LOST * size,
        bars=bars,
    )


def _over_bar(run: Trajectory, errors: dict[str, float], until: float) -> dict[str, float]:
    """True errors over the bar of a run, by measure; none where it has no bar or one that ends before they do."""
    bar = run.error
    if bar is None or bar.until < until:
        return {}
    length = bar.until - float(bar.t[0])
    told = {
        "sup_position": bar.position.sup,
        "l1_velocity": bar.velocity.l1,
        "energy": bar.energy.l1 / length,
    }
    return {m: errors[m] / x for m, x in told.items() if m in errors and x > 0.0}


def _errors(run: Trajectory, found: Reference, measures: Sequence[str], until: float) -> dict[str, float]:
    if found.motion is None:
        return {"penetration": Difference(run, run).penetration} if "penetration" in measures else {}
    strongest = float(np.max(found.motion.impacts["impulse"], initial=0.0))
    apart = Difference(run, found.motion, t_end=until, least=WEAK * strongest)
    known = [m for m in measures if found.knows_impacts or m not in OF_IMPACTS]
    return {m: float(getattr(apart, m)) for m in known}


def _timed(scene: Scene, near: Sequence[Method], repeats: int) -> list[float]:
    """CPU seconds of runs that keep the last state, in turns over the nearby steps."""
    seconds: list[float] = []
    end = [scene.t_span[1]]
    for _ in range(repeats):
        for method in near:
            begin = time.process_time()
            simulate(scene, method, keep=end)
            seconds.append(time.process_time() - begin)
            if sum(seconds) > PATIENCE:
                return seconds
    return seconds
