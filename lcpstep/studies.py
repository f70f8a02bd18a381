"""study(scene, methods): what accuracy costs on a scene, as a work-precision diagram.

Every method over its range of steps or tolerances; each level is the mean over a few nearby values, because an
impact falls at another place of its step for every h, and one h scatters by a factor of ten.
"""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.analysis.dials import changeable, dial, label, with_value
from lcpstep.analysis.environment import machine, versions
from lcpstep.analysis.errors import MEASURES, Difference, units
from lcpstep.analysis.horizon import LOST, Growth, growth
from lcpstep.analysis.reference import TIGHTEST, Reference, find_reference
from lcpstep.analysis.work_precision import Level, Study
from lcpstep.errorbar.companions import KNOWN
from lcpstep.errors import DamagedFile, LcpStepError, StudyInterrupted, UnknownName
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Status, Trajectory

LOG = logging.getLogger(__name__)
SPREAD = (0.87, 0.93, 1.0, 1.07, 1.15)
# Default: steps in the span, how many times more in each further level, levels
COARSEST, FINER, LEVELS = 250, 4, 5
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)  # the same for methods with a tolerance
LOOKS = 2001  # instants at which the size of a motion is measured
CHAOTIC = 100.0  # growth from which on a lost motion was lost to chaos
TRUSTED = 10.0  # an error this many times what the reference may be off is the method's own
OF_IMPACTS = ("impact_time", "impact_impulse", "unmatched")
WEAK = 1e-4  # of the strongest impulse; weaker impacts are not matched: methods end chattering differently
ROUNDING = 1e-15  # of the size of the motion
PATIENCE = 2.0  # CPU seconds after which a level is timed no more often


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
    measures : names of error measures, attributes of `lcpstep.analysis.errors.Difference`
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
    if save is not None and Path(save).suffix not in (".json", ".csv"):
        raise ValueError(f"save: expected a name that ends in .json or .csv, got {str(save)!r}")
    notes: list[str] = []
    curves = _levels(_curves(methods), scene, h, tolerances, notes)
    question = _question(scene, measures, spread, reference)
    done = _earlier(save, question)
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
    grown = _growth(scene, found, result)
    limit = _separation(scene, curves, found, grown)
    scene = _shortened(scene, grown, limit, horizon, result)
    size = grown.size if grown else math.inf
    if found.motion is not None and found.motion.t[-1] < scene.t_span[1]:
        result.compared_until = float(found.motion.t[-1])
    result.uncertainty = found.uncertainty(measures, result.compared_until)
    _allow_for_rounding(scene, found, result)
    _allow_for_growth(found, grown, result)
    for name, methods in curves.items():
        for method in methods:
            say(f"{name}, {' = '.join(map(str, dial(method)))}")
            level = done.get((name, repr(method)))
            if level is None:
                level = _level(scene, name, method, found, measures, result, repeats, spread, size)
            result.levels.append(level)
            note = f"{name}: {level.message}"
            if level.status != Status.DONE.name and note not in result.notes:
                result.notes.append(note)
            if save is not None:
                result.save(save)
    _remarks(result)


def _level(
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
    for k, one in enumerate(near):
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


# --- the question


def _curves(methods: Any) -> dict[str, list[Method]]:
    """Methods by curve, each coarse to fine."""
    if isinstance(methods, Mapping):
        named = {str(name): list(of_it) for name, of_it in methods.items()}
    else:
        named = {}
        for method in methods if isinstance(methods, Iterable) else [methods]:
            named.setdefault(label(method), []).append(method)
    for method in (m for of_it in named.values() for m in of_it):
        if isinstance(method, type) or not hasattr(method, "run"):
            raise TypeError(f"methods: expected for example [lcpstep.Moreau()], got {method!r}")
    if not any(named.values()):
        raise ValueError("methods: expected at least one method")
    return named


def _levels(
    curves: dict[str, list[Method]], scene: Scene, h: Any, tolerances: Any, notes: list[str]
) -> dict[str, list[Method]]:
    """The levels of every curve, coarse to fine; what cannot be used is noted and left out."""
    steps = np.ptp(scene.t_span) / (COARSEST * FINER ** np.arange(LEVELS))
    wanted = {True: (h, steps, "h"), False: (tolerances, TOLERANCES, "tolerances")}
    result = {}
    for name, methods in curves.items():
        which, _ = dial(methods[0])
        values, default, argument = wanted[which == "h"]
        if not changeable(methods[0]):
            result[name] = methods
            continue
        if values is None and len(methods) > 1:
            values, make = [dial(m)[1] for m in methods], methods
        else:
            values = list(default if values is None else values)
            make = [methods[0]] * len(values)
        levels: dict[float, Method] = {}
        for value, method in zip(values, make, strict=True):
            try:
                number = float(value)
                if not (math.isfinite(number) and number > 0.0):
                    raise ValueError(f"expected positive numbers, got {value!r}")
                if number in levels:
                    raise ValueError(f"{value!r} is there twice")
                levels[number] = with_value(method, number)
            except (TypeError, ValueError) as error:
                notes.append(f"{argument}: {error}; left out for {name}")
        result[name] = [levels[v] for v in sorted(levels, reverse=True)]
    if not any(result.values()):
        raise ValueError("; ".join(notes))
    return result


def _question(
    scene: Scene, measures: Sequence[str], spread: Sequence[float], reference: Any
) -> dict[str, Any]:
    initial = [np.asarray(x).tolist() for x in (scene.q0, scene.v0, scene.p)]
    return {
        "scene": scene.name, "parameters": dict(scene.parameters), "t_span": list(scene.t_span),
        "q0": initial[0], "v0": initial[1], "p": initial[2], "measures": list(measures), "spread": list(spread),
        "reference": None if reference is None else repr(reference),
    }  # fmt: skip


def _earlier(save: str | Path | None, question: dict[str, Any]) -> dict[tuple[str, str], Level]:
    """Levels that are in the file already."""
    if save is None or not Path(save).exists():
        return {}
    if Path(save).suffix != ".json":
        raise FileExistsError(f"save: {save} exists already")
    try:
        earlier = Study.load(save)
    except DamagedFile as error:
        aside = Path(save).with_name(Path(save).name + ".damaged")
        Path(save).replace(aside)
        LOG.warning("%s; it is now %s, and the study starts anew", error, aside.name)
        return {}
    if earlier.question != question:
        raise FileExistsError(f"save: {save} exists already and holds another study")
    return {(x.method, x.settings): x for x in earlier.levels}


# --- how far motions can be compared


def _allow_for_rounding(scene: Scene, found: Reference, result: Study) -> None:
    """No motion is known better than its numbers are rounded."""
    if found.motion is None:
        return
    t = np.linspace(scene.t_span[0], min(scene.t_span[1], float(found.motion.t[-1])), LOOKS)
    q, v = (float(np.max(np.abs(x))) for x in found.motion.at(t))
    sizes = {"sup_position": q, "l1_velocity": v * float(np.ptp(scene.t_span)), "graph_distance": v}
    for measure in set(sizes) & set(result.measures):
        known = result.uncertainty.get(measure, 0.0)
        result.uncertainty[measure] = max(known, ROUNDING * sizes[measure])


def _growth(scene: Scene, found: Reference, result: Study) -> Growth | None:
    """Growth of a disturbance."""
    grown, motion = None, found.motion if isinstance(found.motion, Trajectory) else None
    method = found.method or TIGHTEST
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


def _allow_for_growth(found: Reference, grown: Growth | None, result: Study) -> None:
    """Rounding grows as a disturbance does."""
    if grown is None or not isinstance(found.motion, Trajectory):
        return
    share = ROUNDING * grown.size / grown.disturbance
    apart = Difference(found.motion, grown.disturbed, t_end=min(grown.horizon, result.compared_until))
    for measure, value in result.uncertainty.items():
        if measure != "unmatched":
            result.uncertainty[measure] = max(value, share * float(getattr(apart, measure)))


def _separation(
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


def _shortened(
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


def _remarks(result: Study) -> None:
    """What the reader must know about the errors as a whole."""
    limited = sorted({m for x in result.levels for m in x.limited})
    if limited:
        known = ", ".join(f"{m} {result.uncertainty[m]:.1e}" for m in limited)
        result.notes.append(
            f"the reference is not good enough for the smallest errors; it is known to within: {known}. "
            "Errors within ten times that are marked and left out of the orders"
        )
    lost = [f"{x.method} at {x.dial} = {x.value:.3g}" for x in result.levels if x.separated]
    if lost:
        result.notes.append(
            f"these motions end up more than {LOST:g} of the motion's size from the reference, and are left out "
            f"of the orders: {', '.join(lost)}"
        )
