"""How far motions can be compared: the horizon of prediction, and what the reference itself is known to.

Rounding grows as a small disturbance of the start does; past the horizon chaos separates any two computed motions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from lagrangian import Scene
from lcpstep.accuracy.errors import Difference, Motion
from lcpstep.accuracy.horizon import LOST, Growth, growth
from lcpstep.accuracy.reference import TIGHTEST, Reference, alike
from lcpstep.accuracy.work_precision import UNFIT, Study
from lcpstep.errors import LcpStepError
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Trajectory

LOOKS = 2001  # instants at which the size of a motion is measured
CHAOTIC = 100.0  # growth from which on a lost motion was lost to chaos
EPSILON = float(np.finfo(float).eps)
ROUNDING = 1e-15  # of the size of the motion


def allow_for_rounding(scene: Scene, found: Reference, result: Study) -> None:
    """No motion is known better than its numbers are rounded."""
    if found.motion is None:
        return
    q, v = _sizes(scene, found.motion)
    sizes = {"sup_position": q, "l1_velocity": v * float(np.ptp(scene.t_span)), "graph_distance": v}
    for measure in set(sizes) & set(result.measures):
        known = result.uncertainty.get(measure, 0.0)
        result.uncertainty[measure] = max(known, ROUNDING * sizes[measure])


def mark_rounding(scene: Scene, found: Reference, result: Study) -> None:
    """Mark errors that are nothing but rounding, of the finest levels of a method.

    They have ceased to fall, and are no larger than what so many steps round. What levels of a file were marked as
    counts for nothing: there may be finer ones now.
    """
    result.levels[:] = [replace(x, rounded=()) for x in result.levels]
    if found.motion is None:
        return
    q, v = _sizes(scene, found.motion)
    latest = max(abs(scene.t_span[0]), abs(min(scene.t_span[1], float(found.motion.t[-1]))))
    of_a_step = EPSILON * max(q, v * latest)
    for method in result.methods:
        for measure in (m for m in result.measures if m not in UNFIT):
            own = [
                k for k, x in enumerate(result.levels) if x.method == method and x.errors.get(measure, 0.0)
            ]
            best = min(own, key=lambda k: result.levels[k].errors[measure], default=0)
            for k in (k for k in own if best <= k and best < own[-1]):
                x = result.levels[k]
                if x.errors.get("sup_position", math.inf) <= of_a_step * x.steps:
                    result.levels[k] = replace(x, rounded=(*x.rounded, measure))


def _sizes(scene: Scene, motion: Motion) -> tuple[float, float]:
    """The largest coordinate and velocity of a motion, within the span."""
    end = min(scene.t_span[1], float(motion.t[-1]))
    q, v = (float(np.max(np.abs(x))) for x in motion.at(np.linspace(scene.t_span[0], end, LOOKS)))
    return q, v


def growth_of(scene: Scene, found: Reference, result: Study) -> Growth | None:
    """Growth of a disturbance."""
    grown, motion, method = None, None, found.method or TIGHTEST
    if isinstance(found.motion, Trajectory) and alike(found.motion.scene, scene):
        motion = found.motion
    try:
        grown = growth(scene, method, motion if found.method else None)
    except (LcpStepError, ValueError) as error:
        result.notes.append(f"how long the motion can be predicted is not known: {error}")
    else:
        if grown is None:
            result.notes.append(
                "how long the motion can be predicted is not known: its start cannot be disturbed"
            )
    result.growth = str(grown) if grown else "not known"
    return grown


def allow_for_growth(found: Reference, grown: Growth | None, result: Study) -> None:
    """Rounding grows as a disturbance does; a blow that is of the disturbance alone tells nothing of the others."""
    if grown is None or not isinstance(found.motion, Trajectory):
        return
    share = ROUNDING * grown.size / grown.disturbance
    apart = Difference(found.motion, grown.disturbed, t_end=min(grown.horizon, result.compared_until))
    for measure, value in result.uncertainty.items():
        if measure != "unmatched" and math.isfinite(grows := float(getattr(apart, measure))):
            result.uncertainty[measure] = max(value, share * grows)


def separation(
    scene: Scene, curves: Mapping[str, Sequence[Method]], found: Reference, grown: Growth | None
) -> float:
    """Until when motions can be compared in chaos: to the horizon, or to where that has separated a middle level.

    A separation counts as one by chaos once disturbances have grown `CHAOTIC` times; before that it is the
    method's own error.
    """
    limit = grown.horizon if grown else math.inf
    if grown is None or math.isinf(limit) or found.motion is None:
        return limit
    short = replace(scene, t_span=(scene.t_span[0], min(limit, float(found.motion.t[-1]))))
    for methods in curves.values():
        try:
            run = simulate(short, methods[len(methods) // 2])
        except (LcpStepError, ValueError):
            continue  # its level will say why
        apart = np.max(np.abs(run.q - found.motion.at(run.t)[0]), axis=1)
        lost = run.t[(apart > LOST * grown.size) & (np.interp(run.t, grown.t, grown.factor) > CHAOTIC)]
        limit = min([limit, *lost[:1].tolist()])
    return limit


def shortened(
    scene: Scene, grown: Growth | None, limit: float, horizon: float | None, result: Study
) -> Scene:
    """The scene up to where its motions can be compared."""
    start, end = scene.t_span
    until = end
    if horizon is not None and horizon < end:
        if not horizon > start:
            result.notes.append(
                f"horizon: expected a time after {start:g} s, got {horizon!r}; the whole span is compared"
            )
        else:
            until = float(horizon)
    if limit < until:
        asked = "the horizon asked for" if horizon is not None else "the end of the span"
        result.notes.append(
            f"{asked}, {until:g} s, lies past the predictability limit: chaos separates trajectories, {grown}. "
            f"Compared up to {limit:.6g} s only; beyond that compare statistics"
        )
        until = limit
    result.compared_until = until
    return scene if until == end else replace(scene, t_span=(start, until))
