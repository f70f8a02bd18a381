"""The error bar of a run, from its distance to a companion and the first event on which the two disagree."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lagrangian.labels import units
from lcpstep.errorbar.bars import Bar, ErrorBar
from lcpstep.errorbar.breaks import increasing, with_nodes
from lcpstep.errorbar.companions import Companion, best, companions, followed, in_closed_form, in_words
from lcpstep.errorbar.curves import merged
from lcpstep.errorbar.distance import Distance, alike, distance, fall, moving_apart
from lcpstep.errorbar.looks import NOWHERE, Looks, fewer, looks, seen
from lcpstep.errorbar.partners import WEAK, Pairs, Partners, partners
from lcpstep.model import looked_at
from lcpstep.recording import Kept
from lcpstep.stepping.located import Located
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
Found = list[tuple[Companion, Trajectory]]
LOST = 0.5  # of the size of the motion: a run that far off tells nothing of where the motion is
STILL = 1e-9  # of the speed of a motion: jumps below it are rounding
PART = 0.125  # of the span, that is held against the best companion first
MANY_STEPS = 20_000  # of a run, from which on that is done
SAVED = 0.7  # of its forces: a best companion that evaluates more is worth a looser one
SHORT = 1e-9  # of the span: impacts of one contact that follow each other faster are one
ROUNDING = 8 * float(np.finfo(float).eps)  # of a time or an impulse


def error_bar(run: Trajectory, every: bool, seconds: float, wide: Array | None = None) -> ErrorBar:
    """Error bar of a run.

    Parameters
    ----------
    run : by `Moreau`, `Located` or `EventDriven`
    every : whether every step was kept; if not, states are compared where they were kept, and the integrals of
        velocity and energy are not known
    seconds : CPU time that a companion may take, where it takes more than a second [s]
    wide : times between its steps at which the run has kept states too, so that no other run is needed for them
    """
    if len(run.t) < 2:
        return unknown(run, "only one state was kept" if len(run.t) else "no state was kept")
    start, end = float(run.t[0]), _reached(run)
    if not end > start:
        return unknown(run, "the run ended where it began")
    scene = run.scene if end == run.scene.t_span[1] else replace(run.scene, t_span=(run.scene.t_span[0], end))
    error = None
    if every and run.counts.steps > MANY_STEPS and isinstance(run.method, (Moreau, Located)):
        soon, error = _soon(run, seconds, wide)
        if soon is not None:
            return soon
    look: Looks | None = None
    known: dict[Companion, Trajectory | None] = {}
    bar, reach, clear = None, start, True
    for group in companions(run, error):
        for c in group:
            if c not in known:
                if look is None and (c.seen or not every):
                    look = looks(run, run, every, end)
                known[c] = followed(c, scene, _kept(look if c.seen or not every else None, every), seconds)
        found = [(c, x) for c in group if (x := known[c]) is not None and len(x.t) > 1]
        told = len(found) > 0 and known[group[0]] is not None
        if not told or _reach(found) < reach or (_reach(found) == reach and clear):
            continue
        bar, reach = against(run, every, found, wide=wide, look=look), _reach(found)
        clear = all(c.tells(run, bar) for c in group)
        if reach >= end and clear:
            break
    return bar or unknown(run, "no companion")


def _soon(run: Trajectory, seconds: float, wide: Array | None) -> tuple[ErrorBar | None, float | None]:
    """The bar of a long run where it ends within its first part; else the error there, or what is none.

    The error is what a looser companion is chosen by: 0 where the best one has less to do than the run.
    """
    if in_closed_form(run.scene) and not isinstance(run.method, Moreau):  # the best is cheap then
        return None, None
    start, end = float(run.t[0]), _reached(run)
    part = replace(run.scene, t_span=(start, start + PART * (end - start)))
    tightest = Companion(best(run))
    x = followed(tightest, part, Kept(1, False, np.zeros(0)), seconds)
    if x is None or x.status != Status.DONE:
        return None, None
    bar = against(run, True, [(tightest, x)], wide=wide, goes_on=True)
    if bar.reason:
        return bar, None
    work = max(run.counts.force_evaluations, run.counts.steps)
    dear = x.counts.force_evaluations / PART > SAVED * work
    return None, bar.position.sup if dear else 0.0


def _kept(look: Looks | None, every: bool) -> Kept:
    """What a companion keeps: every step, or the states that it is asked for."""
    if look is None:
        return Kept(1, False, np.zeros(0))
    return Kept(0, False, increasing(with_nodes(look.t)) if every else look.t)


def _reach(found: Found) -> float:
    return min(_reached(x) for _, x in found)


def _reached(run: Trajectory) -> float:
    """How far a run has come, whatever it keeps."""
    return float(run.scene.t_span[1] if run.status == Status.DONE else run.t[-1])


def unknown(run: Trajectory, reason: str) -> ErrorBar:
    """The bar of a run that has none."""
    start = run.t[:1] if len(run.t) else np.array(run.scene.t_span[:1])
    missing = np.full(len(run.impacts), math.nan)
    n_q, (q, v, joule) = run.scene.n_q, units(run.scene.labels)
    position, velocity, energy = (
        Bar(np.full((1, k), math.inf), np.full((1, k), math.inf), unit)
        for k, unit in ((n_q, q), (n_q, v), (1, joule))
    )
    at = float(start[0])
    nothing = np.zeros((0, 2))
    return ErrorBar(start, position, velocity, energy, missing, missing, at, reason, at, (), nothing)


def against(
    run: Trajectory,
    every: bool,
    found: Found,
    limit: float = math.inf,
    resolution: float | None = None,
    wide: Array | None = None,
    look: Looks | None = None,
    goes_on: bool = False,
) -> ErrorBar:
    """The bar from a companion that measures and others that look for the same events, up to a limit.

    resolution : within what time impacts of a contact are one; default: what the run resolves [s]
    wide : as of `error_bar`;  look : times at which a companion that is `seen` there alone has kept states
    goes_on : whether the companion ends before the run, whose size and strongest impact are those of the whole
    """
    other = found[0][1]
    resolution = resolved(run) if resolution is None else resolution
    until, reason = _reached(run), ""
    for c, x in found:
        if _reached(x) < until:
            until = _reached(x)
            reason = "" if goes_on else f"{in_words(c.method)} ends there, {x.message}"
    m = looked_at(run.scene)
    falls = fall(m, run)
    still = STILL * (float(np.max(np.abs(run.v))) + falls)
    if goes_on:
        struck = run.impacts[run.impacts["kind"] == Kind.IMPACT]
        still = max(still, WEAK * float(np.max(np.abs(struck["after"] - struck["before"]), initial=0.0)))
    logs = [_matched(run, x, every, until, resolution, still, not c.seen) for c, x in found]
    for (c, _), pairs in zip(found, logs, strict=True):
        if pairs.differs < until:
            until = pairs.differs
            reason = f"there the run and {in_words(c.method)} see different events, {pairs.reason}"
    around = ROUNDING * _latest(run) + 0.5 * resolution
    last = min(limit, until - around if reason else until)
    known_there = every and look is not None and found[0][0].seen
    if look is not None and known_there:
        look = seen(look, last)
    elif not every and look is not None:
        look = fewer(run, look, last)
    else:
        windows = NOWHERE if wide is None else merged(logs[0].windows, around)
        look = looks(run, other, every, last, wide, windows)
    t = look.t
    if len(t) < 2 or not t[-1] > t[0]:
        return unknown(run, reason or "no states to compare")
    apart = distance(m, (run, other), look, logs[0].pairs, logs[0].windows, around, falls)
    texts = tuple(in_words(c.method) for c, _ in found)
    size = max(apart.size, 0.5 * float(np.ptp(run.q, axis=0).max()) if goes_on else 0.0)
    horizon = _lost(t, apart, size) if math.isinf(limit) else math.inf
    n = max(int(np.searchsorted(t, horizon)), 1)
    if n < len(t):
        reason = "from there on its error is more than a quarter of the range of the motion"
    position, velocity, energy = (
        Bar(b.largest[:n], b.integral[:n], b.unit) for b in (apart.position, apart.velocity, apart.energy)
    )
    known = float(t[n - 1]) if reason or math.isfinite(limit) else until
    times, impulses = _of_impacts(run, logs[0].pairs, known)
    bars, out = (position, velocity, energy), apart.left_out
    return ErrorBar(t[:n], *bars, times, impulses, known, reason, horizon, texts, out[out[:, 0] < known])


def _of_impacts(run: Trajectory, pairs: Pairs, until: float) -> tuple[Array, Array]:
    """Errors of times and impulses, one for each row of the log."""
    times, impulses = np.full((2, len(run.impacts)), math.nan)
    if len(pairs.rows):
        of_row = pairs.of_row
        known = ((pairs.stop <= until) & ~pairs.weak)[of_row]
        known[1:] &= of_row[1:] != of_row[:-1]  # of the others of a blow the companion's are not told apart
        rows, pair = pairs.rows[known], of_row[known]
        times[rows] = pairs.time[pair] + ROUNDING * _latest(run)
        impulses[rows] = pairs.impulse[pair] + ROUNDING * np.asarray(run.impacts)["impulse"][rows]
    return times, impulses


def _latest(run: Trajectory) -> float:
    """The largest of the times of a run, by its size [s]."""
    return max(abs(float(run.t[0])), abs(float(run.t[-1])))


def _matched(
    run: Trajectory,
    other: Trajectory,
    every: bool,
    until: float,
    resolution: float,
    still: float,
    whole: bool,
) -> Partners:
    """Partners of the impacts of two runs; a jump below `still` is none: rounding of what moves, or would."""
    if not every:
        return partners(run.impacts, other.impacts, until, resolution, still)
    differ = moving_apart(run, other, whole)
    same = alike(run, other, resolution, differ)
    return partners(run.impacts, other.impacts, until, resolution, still, same, differ)


def resolved(run: Trajectory) -> float:
    """Within what time impacts of a contact are one [s]."""
    span = float(run.t[-1] - run.t[0])
    if not isinstance(run.method, Moreau):
        return SHORT * span
    return 2.0 * min(run.method.h, span / max(run.counts.steps, 1))


def _lost(t: Array, apart: Distance, size: float) -> float:
    """Time from which on the error says only how large the motion is."""
    most, largest = LOST * size, apart.position.largest  # which only grows
    if not np.any(largest[-1] > most):
        return math.inf
    return float(t[np.argmax(np.any(largest > most, axis=1))])
