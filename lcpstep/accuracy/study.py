"""study(scene, methods): what accuracy costs on a scene, as a work-precision diagram.

Every method over its range of steps or tolerances; each level is the mean over a few nearby values, because an
impact falls at another place of its step for every h, and one h scatters by a factor of ten.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene, checks
from lcpstep.accuracy.dials import dial
from lcpstep.accuracy.environment import machine, versions
from lcpstep.accuracy.errors import MEASURES, units
from lcpstep.accuracy.horizon import LOST
from lcpstep.accuracy.levels import measured
from lcpstep.accuracy.limits import (
    allow_for_growth,
    allow_for_rounding,
    growth_of,
    mark_rounding,
    separation,
    shortened,
)
from lcpstep.accuracy.question import curves_of, earlier, levels_of, question_of
from lcpstep.accuracy.reference import find_reference
from lcpstep.accuracy.work_precision import Level, Study
from lcpstep.errors import StudyInterrupted, UnknownName
from lcpstep.pace import counted
from lcpstep.simulation import Method
from lcpstep.trajectory import Status

FEW_STEPS = 4000.0  # that take as long as comparing two motions
SPREAD = (0.87, 0.93, 1.0, 1.07, 1.15)


def study(
    scene: Scene,
    methods: Method | Sequence[Method] | Mapping[str, Sequence[Method]],
    *,
    h: Sequence[float] | None = None,
    tolerances: Sequence[float] | None = None,
    reference: Any = None,
    measures: Sequence[str] = MEASURES,
    horizon: float | None = None,
    repeats: int = 3,
    spread: Sequence[float] = SPREAD,
    save: str | Path | None = None,
    progress: Callable[[str], None] | None = None,
) -> Study:
    """Error against CPU time of several methods on one scene.

    Parameters
    ----------
    scene : lagrangian.Scene
    methods : methods to study, as [Moreau(), EventDriven()]; or the levels of each: {"Moreau": [Moreau(1e-2), ...]}.
        Methods in a list that differ in nothing but their step or tolerance are levels of one curve.
    h, tolerances : the levels of each method that has a step, or a tolerance. Default: the methods as they are given
        where there are several of a kind, else five steps from 1/250 of the span, or tolerances from 1e-4 to 1e-10
    reference : a method, a `Trajectory`, or a function t -> (q, v). Default: the closed form `scene.exact` where the
        scene has one, else `EventDriven` at 1e-13; checked by a run of an independent method
    measures : names of error measures, attributes of `lcpstep.accuracy.errors.Difference`
    horizon : compare up to this time only [s]; at most up to where chaos separates trajectories
    repeats : rounds of timing; the median counts. Levels of more than two seconds are timed once
    spread : factors of the nearby steps that each level averages over
    save : a .json or .csv file, written after every level; an existing .json of the same study is carried
        on, a damaged one is put aside as FILE.damaged
    progress : called with a line of text before every level

    Returns
    -------
    Study : levels, fitted orders with confidence intervals, notes on all that was left out

    Raises
    ------
    TypeError, ValueError, UnknownName   the question is not understood; nothing has been run
    StudyInterrupted   a KeyboardInterrupt; carries the study so far, which is in the file as well
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: expected a lagrangian.Scene, got {scene!r}")
    if isinstance(measures, str) or not isinstance(measures, Iterable):
        raise TypeError(f"measures: expected names in a list, got {measures!r}")
    for measure in measures:
        if measure not in MEASURES:
            raise UnknownName("error measure", measure, MEASURES)
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: expected a function of a line of text, got {progress!r}")
    for name, values in (("h", h), ("tolerances", tolerances), ("spread", spread)):
        if values is not None and (isinstance(values, str) or not np.iterable(values)):
            raise TypeError(f"{name}: expected numbers in a list, got {values!r}")
    if isinstance(repeats, bool) or not isinstance(repeats, int) or repeats < 1:
        raise ValueError(f"repeats: expected at least 1, got {repeats!r}")
    if not (len(spread) and all(math.isfinite(s) and s > 0.0 for s in spread)):
        raise ValueError(f"spread: expected positive factors, got {spread!r}")
    if horizon is not None and horizon != math.inf:
        checks.number("horizon", horizon)
    if save is not None and Path(save).suffix not in (".json", ".csv"):
        raise ValueError(f"save: expected a name that ends in .json or .csv, got {str(save)!r}")
    notes: list[str] = []
    curves = levels_of(curves_of(methods), scene, h, tolerances, notes)
    question = question_of(scene, measures, spread, reference, horizon)
    done = earlier(save, question)
    from lcpstep import __version__

    known = {"lcpstep": __version__} | versions()
    result = Study(question, "", {}, scene.t_span[1], "", notes=notes, versions=known, machine=machine(),
                   units=units(scene))  # fmt: skip
    try:
        _fill(result, scene, curves, reference, measures, horizon, repeats, spread, done, save, progress)
    except KeyboardInterrupt:
        if save is not None:
            result.save(save)
        raise StudyInterrupted(result) from None
    result.finished = True
    if save is not None:
        result.save(save)
    return result


def _fill(
    result: Study, scene: Scene, curves: dict[str, list[Method]], given: Any, measures: Sequence[str],
    horizon: float | None, repeats: int, spread: Sequence[float], done: dict[tuple[str, str], Level],
    save: str | Path | None, progress: Callable[[str], None] | None,
) -> None:  # fmt: skip
    """Reference, horizon, then level after level."""
    say = progress or (lambda _: None)
    say("reference")
    found = find_reference(scene, given)
    result.reference = found.text
    result.notes += found.notes
    grown = growth_of(scene, found, result)
    limit = separation(scene, curves, found, grown)
    scene = shortened(scene, grown, limit, horizon, result)
    size = grown.size if grown else math.inf
    if found.motion is not None and found.motion.t[-1] < scene.t_span[1]:
        result.compared_until = float(found.motion.t[-1])
    result.uncertainty = found.uncertainty(measures, result.compared_until)
    allow_for_rounding(scene, found, result)
    allow_for_growth(found, grown, result)
    levels = [(name, method) for name, methods in curves.items() for method in methods]
    for name, method in counted(levels, [weight(scene, method) for _, method in levels]):
        say(f"{name}, {' = '.join(map(str, dial(method)))}")
        level = done.get((name, repr(method)))
        if level is None:
            level = measured(scene, name, method, found, measures, result, repeats, spread, size)
        result.levels.append(level)
        note = f"{name}: {level.message}"
        if level.status != Status.DONE.name and note not in result.notes:
            result.notes.append(note)
        if save is not None:
            result.save(save)
    mark_rounding(scene, found, result)
    _remarks(result)


def weight(scene: Scene, method: Method) -> float:
    """About how much of the time a level takes, for who waits: a constant and its steps."""
    which, value = dial(method)
    return 1.0 + (float(np.ptp(scene.t_span)) / value / FEW_STEPS if which == "h" else 0.0)


def _remarks(result: Study) -> None:
    """What the reader must know about the errors as a whole."""
    limited = sorted({m for x in result.levels for m in x.limited})
    if limited:
        known = ", ".join(f"{m} {result.uncertainty[m]:.1e}" for m in limited)
        result.notes.append(
            f"the reference is not good enough for the smallest errors; it is known to within: {known}. "
            "Errors within ten times that are marked and left out of the orders"
        )
    if any(x.rounded for x in result.levels):
        result.notes.append(
            "the finest levels of some methods are rounding, and no order is fitted through them: their errors have "
            "ceased to fall, and are no larger than so many steps round"
        )
    lost = [f"{x.method} at {x.dial} = {x.value:.3g}" for x in result.levels if x.separated]
    if lost:
        result.notes.append(
            f"these motions end up more than {LOST:g} of the motion's size from the reference, and are left out "
            f"of the orders: {', '.join(lost)}"
        )
