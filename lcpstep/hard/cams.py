"""Checks on the cam-follower: where it leaves the cam, and its motion at the speeds of the thesis."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

from lagrangian import scenes
from lagrangian.scenes.cam_follower import HALF_TURN, NOSE_END, NOSE_START, detachment_rpm
from lcpstep.hard.check import FIRST_ORDER, SECOND_ORDER, Found, Solver, check, states
from lcpstep.trajectory import Kind

SHARE = 1e-3  # of a turn before and after the corner, through which the follower starts at rest on the cam
PRECISION = 1e-10  # relative, of the bisection
AT_ONCE = 1e-13  # after the corner, relative to a turn


def _left(solve: Solver, rpm: float, beta: float) -> float:
    """Where the follower leaves the cam after the corner beta, in turns; infinite where it does not."""
    scene = scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0)
    corner = (beta - HALF_TURN) / (2.0 * math.pi)
    span = ((corner - SHARE) * scene.period, (corner + SHARE) * scene.period)
    log = solve(replace(scene, t_span=span, exact=None)).impacts
    times = log.time[log.kind == Kind.RELEASE]
    return float(times[0] / scene.period - corner) if len(times) else math.inf


def _lowest_speed(solve: Solver, beta: float) -> float:
    """Speed from which on the follower leaves the cam at the corner beta itself, by bisection [rpm]."""
    from scipy.optimize import bisect

    def late(rpm: float) -> float:
        return -1.0 if _left(solve, rpm, beta) <= AT_ONCE else 1.0

    return float(bisect(late, 100.0, 150.0, rtol=PRECISION))


@check("cam-follower", "first detachment, 114.979 rpm, relative", period=0.09, event_driven=1e-8)
def first_detachment(solve: Solver) -> Found:
    speed = _lowest_speed(solve, NOSE_START)
    return Found(abs(speed / detachment_rpm(NOSE_START) - 1.0), f"{speed:.9f} rpm")


@check(
    "cam-follower",
    "detachment at the end of the nose, 134.873 rpm, relative",
    period=0.09,
    event_driven=1e-8,
)
def end_of_nose(solve: Solver) -> Found:
    # On the way down, where the follower comes off the top dwell: below this speed it leaves further down the nose
    speed = _lowest_speed(solve, 2.0 * math.pi - NOSE_END)
    return Found(abs(speed / detachment_rpm(NOSE_END - 1e-14) - 1.0), f"{speed:.9f} rpm")


for what, rpm, period, error in (
    ("states at 100 rpm, 2 s", 100.0, 0.18, 1e-10),
    ("states at 120 rpm, 2 s", 120.0, 0.18, 1e-10),
    ("states at 358 rpm, 2 s", 358.0, 0.18, 1e-10),
    ("states at 358 rpm, 2 s, absolute coordinates", 358.0, 0.18, 1e-10),
    ("states at 660 rpm, 2 s: chaotic", 660.0, 0.09, 1e-9),
    ("states at 700 rpm, 2 s", 700.0, 0.09, 1e-9),
):
    coordinates = "absolute" if "absolute" in what else "relative"
    make = partial(scenes.cam_follower, rpm=rpm, coordinates=coordinates)
    states(
        "cam-follower",
        what,
        make,
        period=period,
        event_driven=error,
        located=SECOND_ORDER,
        moreau=FIRST_ORDER,
    )
