"""Figs 3.4-3.6, 4.3, 4.4, 4.10: motions of the cam-follower over time, in the state plane, and on sections."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Moreau, simulate
from lcpstep.accuracy.compare import Comparison, compare
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.orbits import PeriodicOrbit, periodic_orbit
from lcpstep.analysis.starts import random_starts
from lcpstep.errorbar.estimate import error_bar
from lcpstep.maps import sections
from lcpstep.plot.motion import portraits, time_series
from lcpstep.plot.orbits import motion_panel, state_panel
from lcpstep.plot.sections import maps
from lcpstep.simulation import Method
from lcpstep.trajectory import Kind

SPEEDS = (358.0, 660.0, 700.0)
STEP = 1e-4
FLANK_NOSE = 1  # the corner at which the thesis cuts the circle of phases
BOX = [[0.0, -60.0], [1.5, 60.0]]
LOWEST, TOUCHING = 1e-12, 1e-18  # gaps that are drawn, and what stands for zero [m]


@lru_cache(maxsize=1)
def _compared() -> tuple[list[str], list[Comparison]]:
    titles = [f"cam-follower at {rpm:g} rpm, from q = 0.4 m, v = 0.4 m/s" for rpm in SPEEDS]
    return titles, [compare(cam_follower(rpm=rpm), Moreau(h=STEP), EventDriven()) for rpm in SPEEDS]


def series() -> tuple[Any, dict[str, Any]]:
    """Fig 3.4."""
    titles, found = _compared()
    return time_series(found, titles), _impacts(titles, found)


def portraits_of_both() -> tuple[Any, dict[str, Any]]:
    """Fig 3.5."""
    titles, found = _compared()
    return portraits(found, [f"{rpm:g} rpm" for rpm in SPEEDS]), _impacts(titles, found)


def _impacts(titles: list[str], found: list[Comparison]) -> dict[str, Any]:
    return {
        title: {
            name: {
                "impact_times": run.trajectory.impacts.time,
                "before": run.trajectory.impacts.before,
                "after": run.trajectory.impacts.after,
                "error_bar": error_bar(run.trajectory, True, run.seconds).as_dict(),
            }
            for name, run in (("time-stepping", c.fast), ("event-driven", c.reference))
        }
        for title, c in zip(titles, found, strict=True)
    }


def maps_of_both() -> tuple[Any, dict[str, Any]]:
    """Fig 3.6."""
    scene = cam_follower(rpm=660.0)
    methods: dict[str, Method] = {"time-stepping, h = 1e-4 s": Moreau(h=STEP), "event-driven": EventDriven()}
    found = {name: sections(scene, method, 6000, 300) for name, method in methods.items()}
    corners = [float(c) / scene.period for c in np.asarray(scene.corners)]
    figure = maps(
        found,
        "cam-follower at 660 rpm, 5700 periods after 300; corners of the cam blue",
        corners[FLANK_NOSE],
        corners,
    )
    return figure, {name: vars(x) for name, x in found.items()}


def two_sequences() -> tuple[Any, dict[str, Any]]:
    """Fig 4.3."""
    return _over_the_cam(125.0)


def one_sequence() -> tuple[Any, dict[str, Any]]:
    """Fig 4.4."""
    return _over_the_cam(150.0)


def _over_the_cam(rpm: float) -> tuple[Any, dict[str, Any]]:
    """A turn of the settled motion, and the gap in each chattering sequence on a logarithmic scale."""
    from matplotlib.figure import Figure

    scene = cam_follower(rpm=rpm, q0=0.0, v0=0.0)
    T = scene.period
    run = simulate(replace(scene, t_span=(0.0, 6.0 * T)), EventDriven(), keep="impacts")
    log = run.impacts[run.impacts.time >= 4.0 * T]
    hits = log.time[log.kind == Kind.IMPACT]
    turn = sampled(run, 4.0 * T, 5.0 * T, hits)
    opened = [float(t) for t in log.time[log.kind == Kind.RELEASE] if t < 5.0 * T]
    closed = [float(min(t for t in log.time[log.kind == Kind.STICK] if t > start)) for start in opened]
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    figure.suptitle(f"follower over the cam at {rpm:g} rpm, event-driven: one turn of the settled motion")
    grid = figure.add_gridspec(2, len(opened))
    motion_panel(figure.add_subplot(grid[0, :]), scene, turn[0] - 4.0 * T, *turn[1:])
    for k, (start, end) in enumerate(zip(opened, closed, strict=True)):
        ax = figure.add_subplot(grid[1, k])
        margin = 0.06 * (end - start)
        t, q, _ = sampled(run, start - margin, end + margin, hits)
        ax.semilogy(t / T - 4.0, np.maximum(q[:, 0], TOUCHING), "C0-", lw=0.9)
        ax.axvline(start / T - 4.0, color="C2", lw=1.0, label="release")
        ax.axvline(end / T - 4.0, color="C3", lw=1.0, label="accumulation point")
        ax.set(xlabel="time [periods]", ylim=(LOWEST, None))
        ax.set_xlim((start - margin) / T - 4.0, (end + margin) / T - 4.0)
        ax.locator_params(axis="x", nbins=6)
        ax.set_title(f"sequence {k + 1}: gap", fontsize=10, loc="left")
        ax.grid(alpha=0.3)
        if k == 0:
            ax.set_ylabel("gap [m]")
        if k == len(opened) - 1:
            ax.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)
    return figure, {"rpm": rpm, "impact_times": hits, "release": opened, "accumulation": closed}


def sampled(run: Any, start: float, end: float, hits: Any) -> tuple[Any, Any, Any]:
    """Times, positions and velocities, finely, and at all impacts between, where a gap goes to zero."""
    inside = hits[(hits > start) & (hits < end)]
    between = 0.5 * (inside[1:] + inside[:-1])
    t = np.unique(np.concatenate([np.linspace(start, end, 3000), inside, between]))
    return t, *run.at(t)


def coexisting_orbits() -> tuple[Any, dict[str, Any]]:
    """Fig 4.10."""
    from matplotlib.figure import Figure

    scene = cam_follower(rpm=358.5)
    found = attractors(scene, EventDriven(), random_starts(BOX, 60, 0)).found
    orbits = [periodic_orbit(scene, a.points[0], a.periods) for a in found]
    figure = Figure(figsize=(12, 4.2 * len(orbits)), layout="constrained")
    figure.suptitle("coexisting stable orbits of the cam-follower at 358.5 rpm, event-driven")
    grid = figure.subplots(len(orbits), 2, width_ratios=[1.6, 1.0], squeeze=False)
    for row, orbit in zip(grid, orbits, strict=True):
        draw_orbit(row[0], row[1], orbit)
        row[0].set_title(orbit.name, fontsize=10)
    return figure, {o.name: {"x": o.x, "time": o.time, "before": o.before, "after": o.after} for o in orbits}


def draw_orbit(left: Any, right: Any, orbit: PeriodicOrbit) -> None:
    """One orbit over its period, and in the state plane."""
    run = orbit.run()
    jumps = run.impacts.time[run.impacts.kind == Kind.IMPACT]
    t0, t1 = run.scene.t_span
    t = np.unique(np.concatenate([np.linspace(t0, t1, 3000), jumps, np.nextafter(jumps, t0)]))
    q, v = run.at(t)
    motion_panel(left, orbit.scene, t, q, v)
    state_panel(right, orbit.scene, t, q[:, 0], v[:, 0], jumps)
    right.plot(orbit.x[:, 0], orbit.x[:, 1], "C3o", ms=4)
