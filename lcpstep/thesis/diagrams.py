"""Chapter 4: bifurcation diagrams, basins, and the branch of the orbit that flips."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian.scenes import cam_follower
from lcpstep import EventDriven
from lcpstep.analysis.basins import basins
from lcpstep.analysis.bifurcation import WINDOWS, bifurcation
from lcpstep.analysis.branch_data import branch_dataset
from lcpstep.analysis.continuation import Steps
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.plot import bifurcation as pictures
from lcpstep.plot.basins import basins as draw_basins
from lcpstep.plot.orbits import branch

DROP, KEEP = 500, 60  # periods, as in the thesis
LONG = 2500  # periods that chaos may last before one of the coexisting orbits is reached
CELLS = 1000
BOX = [[0.0, -60.0], [1.5, 60.0]]


def _window(name: str, points: int, show: tuple[str, ...] | None = None, **settings: Any) -> tuple[Any, Any]:
    low, high = WINDOWS[name]
    values, drop = np.linspace(low, high, points), settings.pop("drop", DROP)
    data = bifurcation(cam_follower, "rpm", values, drop=drop, keep=KEEP, **settings)
    start = "random starts" if settings.get("start") == "random" else "from rest on the cam"
    title = (
        f"cam-follower, {low:g} to {high:g} rpm, {start}: {drop} periods dropped, {KEEP} shown; event-driven"
    )
    return pictures.bifurcation(data, title, show), data


def chattering() -> tuple[Any, Any]:
    """Fig 4.5."""
    return _window("114-200", 800)


def whole() -> tuple[Any, Any]:
    """The whole range of speeds."""
    return _window("114-850", 1000, ("phase", "position"))


def end_of_chattering() -> tuple[Any, Any]:
    """Fig 4.7."""
    return _window("198-200", 500)


def coexisting() -> tuple[Any, Any]:
    """Two attractors beside each other."""
    return _window("357.5-361.5", 400, ("phase", "position"), start="random", box=BOX, runs=6, drop=LONG)


def upper() -> tuple[Any, Any]:
    """Fig 4.12."""
    return _window("660-760", 800, ("phase", "position"))


def basins_at_358() -> tuple[Any, Any]:
    """Fig 4.11."""
    scene = cam_follower(rpm=358.5, coordinates="absolute")
    data = basins(scene, [0.1, -60.0], [1.6, 60.0], (CELLS, CELLS))
    title = f"cam-follower at 358.5 rpm: basins, {CELLS} x {CELLS} cells; event-driven"
    return draw_basins(data, title), data


def branch_of_the_flip() -> tuple[Any, Any]:
    """Fig 4.13."""
    scene, p_range = cam_follower(rpm=700.0), (660.0, 760.0)
    orbit = periodic_orbit(scene, [1.33, -66.2])
    ways = [
        continue_orbit(
            lambda rpm: cam_follower(rpm=rpm),
            orbit,
            700.0,
            p_range,
            steps=Steps(largest=0.02),
            forward=forward,
        )
        for forward in (False, True)
    ]
    data = branch_dataset(ways, "rpm", p_range, scene, EventDriven())
    return branch(data, "cam-follower: branch of O(1, 1) through corner impact and flip; event-driven"), data
