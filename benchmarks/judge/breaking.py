"""Steps far too long for what turns within them: up to where a run that breaks down can be judged."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import REFERENCE, Run, run

SWINGS = 500  # states of which it is asked how fast joints let them swing
LOOSE = "event-driven-loose"  # knows how fast a motion is where the reference takes too long
# Endings of runs that may have grown before they say so
BROKEN = ("NOT_FINITE", "NEWTON_FAILED", "PROJECTION_FAILED")


def breaks_down(d: Description, r: Run) -> float:
    """When a method goes through a bend in less than a step, which it says by its status; or never (inf).

    Held at a speed v on an obstacle of curvature k / |G|, a body turns at w = k v / |G|, and explicit Runge-Kutta
    methods of order p <= 4 are unbounded at w h > 2.8: no order helps where the normal turns by so much in a step.
    A mass that turns with the place is no better, for implicit steps either. How fast the motion is the reference
    says; w h > 1 is asked, for the speed rises while it turns.
    """
    if not (d.curved or any(d.joint_bend) or d.spread) or r.tolerance > 0.0:
        return np.inf
    reference = run(d, REFERENCE)
    if not reference.usable:
        reference = run(d, LOOSE)
    if not reference.usable:
        return np.inf
    return min(turns(d, reference.motion), swings(d, reference.motion), whirls(d, reference.motion))


def judged_until(d: Description, r: Run) -> float:
    """The time up to which the states of a run are asked: the end (inf), but of one that says that it has failed."""
    return breaks_down(d, r) if r.status in BROKEN else np.inf


def whirls(d: Description, m: Any) -> float:
    """When the mass turns by more than a radian in a step: M(q) goes with the sine of b q."""
    by = np.abs(m.v @ d.row("b")) * d.h if d.spread else np.zeros(len(m.t))
    return float(np.min(m.t[by > 1.0], initial=np.inf))


def turns(d: Description, m: Any) -> float:
    """When a contact that is pressed turns by more than a radian in a step."""
    if not d.curved:
        return np.inf
    rows = np.linalg.norm(physics.jacobians(d, m.q), axis=-1)
    by = np.abs(d.row("bend", d.contacts)) * np.linalg.norm(m.v, axis=-1)[:, None] * d.h
    rests = (m.impulse > 0.0).astype(bool)
    return float(np.min(m.t[np.any(rests & (by > rows), axis=1)], initial=np.inf))


def swings(d: Description, m: Any) -> float:
    """When what joints carry swings by more than a radian in a step, as a light body on which a heavy one hangs."""
    if not any(d.joint_bend):
        return np.inf
    long = np.flatnonzero(np.diff(m.t) > 0.0)
    for k in long[:: 1 + len(long) // SWINGS]:
        forces = m.joint_impulse[k + 1] / (m.t[k + 1] - m.t[k])
        if physics.swinging(d, m.q[k], forces) * d.h > 1.0:
            return float(m.t[k])
    return np.inf


def up_to(r: Run, until: float) -> Run:
    """A run without its states after a time."""
    if until == np.inf or not r.usable:
        return r
    there = r.motion.t <= until
    return replace(
        r, motion=replace(r.motion, **{k: getattr(r.motion, k)[there] for k in ("t", "q", "v", "impulse")})
    )
