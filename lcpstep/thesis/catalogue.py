"""Which figures there are, and how one is made into a folder: PNG, SVG, and the data it shows.

A figure whose number in the thesis is not known to us goes by its window or by what it shows.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lcpstep.dataset import save
from lcpstep.errors import UnknownName
from lcpstep.files import replacing
from lcpstep.plot.words import DPI
from lcpstep.thesis import cams, controller, corners, diagrams, maps, motions

Made = tuple[Any, Any]  # figure; a dataset, or named arrays and numbers


@dataclass(frozen=True)
class FigureOfThesis:
    """A figure: what it shows, the function that makes it, and the command that makes it by hand."""

    about: str
    make: Callable[[], Made]
    command: str = ""


CAM = "cam-follower"
FIGURES: dict[str, FigureOfThesis] = {
    "2": FigureOfThesis(
        "normal forms of the smooth bifurcations: fold, transcritical, pitchfork, flip", maps.normal_forms
    ),
    "3.2": FigureOfThesis("the cam, its lift, velocity and acceleration", cams.profile),
    "3.3": FigureOfThesis("profiles whose velocity, acceleration or jerk jumps", cams.smoothness),
    "3.4": FigureOfThesis(
        "time series by time-stepping and event-driven at 358, 660, 700 rpm", motions.series,
        f"lcpstep compare {CAM} --rpm 358 660 700",
    ),
    "3.5": FigureOfThesis("state-space portraits of the same", motions.portraits_of_both),
    "3.6": FigureOfThesis("impact and stroboscopic maps at 660 rpm by both methods", motions.maps_of_both),
    "4.3": FigureOfThesis("follower over the cam at 125 rpm: two chattering sequences", motions.two_sequences),
    "4.4": FigureOfThesis("follower over the cam at 150 rpm: one chattering sequence", motions.one_sequence),
    "4.5": FigureOfThesis(
        "diagram 114-200 rpm with accumulation points and number of impacts", diagrams.chattering,
        f"lcpstep bifurcation {CAM} --window 114-200",
    ),
    "114-850": FigureOfThesis(
        "diagram 114-850 rpm", diagrams.whole, f"lcpstep bifurcation {CAM} --window 114-850 --points 1000"
    ),
    "4.7": FigureOfThesis(
        "diagram 198-200 rpm, where the chattering motion ends", diagrams.end_of_chattering,
        f"lcpstep bifurcation {CAM} --window 198-200",
    ),
    "357.5-361.5": FigureOfThesis(
        "diagram 357.5-361.5 rpm, coexisting attractors", diagrams.coexisting,
        f"lcpstep bifurcation {CAM} --window 357.5-361.5 --start random",
    ),
    "4.10": FigureOfThesis(
        "the coexisting orbits O(3, 8) and O(1, 2) at 358.5 rpm", motions.coexisting_orbits,
        f"lcpstep orbit {CAM} --rpm 358.5 --draw",
    ),
    "4.11": FigureOfThesis(
        "their basins", diagrams.basins_at_358, f"lcpstep basin {CAM} --rpm 358.5 --grid 1000 1000"
    ),
    "4.12": FigureOfThesis(
        "diagram 660-760 rpm", diagrams.upper, f"lcpstep bifurcation {CAM} --window 660-760"
    ),
    "4.13": FigureOfThesis(
        "branch and multipliers of O(1, 1) up to its flip", diagrams.branch_of_the_flip,
        f"lcpstep orbit {CAM} --rpm 700 --range 660 760",
    ),
    "5.1": FigureOfThesis("the O(1, 1) orbit around its corner impact at 673.23 rpm", corners.around_the_corner),
    "5.4": FigureOfThesis(
        "local map and full system at the corner impact, with the unstable branch", corners.corner_diagrams,
        f"lcpstep corner {CAM}",
    ),
    "6": FigureOfThesis("border-collision scenarios of the piecewise-linear normal form", maps.scenarios),
    "7.2": FigureOfThesis("friction over slip on four roads", controller.roads),
    "7.4": FigureOfThesis(
        "phase portraits of the controller's states 0 and 2: torque rises, falls", controller.ramps
    ),
    "7.5": FigureOfThesis("phase portraits of its states 1 and 3: torque held", controller.holds),
    "7-overview": FigureOfThesis(
        "cycle, time series, bifurcation and basins of the controller", controller.overview_of_all, "lcpstep abs"
    ),
    "7.15": FigureOfThesis("cycle and equilibria over the torque threshold", controller.over_threshold),
}  # fmt: skip


def make(
    name: str,
    out: Path,
    overwrite: bool = False,
    kinds: tuple[str, ...] = ("png", "svg", "data"),
    dpi: int = DPI,
) -> list[Path]:
    """Make one figure into a folder; the files written.

    kinds, dpi : png, svg, data (NetCDF or JSON); resolution of pixels

    Raises
    ------
    UnknownName   no such figure; names the nearest
    FileExistsError   a file of it is there already
    """
    if name not in FIGURES:
        raise UnknownName("figure of the thesis", name, FIGURES)
    files = {kind: out / f"figure-{name}.{kind}" for kind in ("png", "svg", "nc", "json")}
    for file in files.values():
        if file.exists() and not overwrite:
            raise FileExistsError(f"--out: {file} exists already; --overwrite replaces it")
    figure, data = FIGURES[name].make()
    written = [files[kind] for kind in ("png", "svg") if kind in kinds]
    for file in written:
        with replacing(file) as draft:
            figure.savefig(draft, dpi=dpi)
    if "data" in kinds and isinstance(data, dict):
        with replacing(files["json"]) as draft:
            draft.write_text(json.dumps(data, default=_plain, indent=1) + "\n")
        written.append(files["json"])
    elif "data" in kinds:
        written.append(save(data, files["nc"], overwrite=overwrite))
    return written


def _plain(value: Any) -> Any:
    """Arrays and numbers of numpy as JSON has them."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"no JSON for {type(value).__name__}")
