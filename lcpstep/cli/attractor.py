"""`lcpstep attractor`: which attractors a scene has, and what each is."""

from __future__ import annotations

import argparse
import json
import math
from typing import Any

import numpy as np

from lagrangian import HybridScene, checks
from lcpstep.analysis.attractors import POINTS, Attractors, attractors
from lcpstep.analysis.likeness import Likeness, likeness, sample
from lcpstep.analysis.starts import outside, random_starts
from lcpstep.cli.common import DONE, event_driven, moreau
from lcpstep.cli.studies import (
    CAM_BOX,
    files,
    finish,
    method_of,
    stopped,
    study_arguments,
    study_scene,
    work_bar,
)
from lcpstep.dataset import labelled, provenance, units
from lcpstep.maps.batch import periodic
from lcpstep.plot import attractors as pictures
from lcpstep.plot.words import method_words, scene_words
from lcpstep.simulation import Method
from lcpstep.stepping.moreau import Moreau

LONGEST = 60  # periods that a motion may repeat after, where not given


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "attractor",
        help="find the attractors of a scene and classify them",
        description="Follows motions from random states, and says what they settle to: O(n, m) repeats after n "
        "periods of the forcing with m impacts; chaotic ones come with their largest Lyapunov exponent.",
        epilog="Example: lcpstep attractor cam-follower --rpm 358.5 --starts 200 --out out",
    )
    study_arguments(p)
    p.add_argument("--starts", type=int, default=100, help="number of random starts (100)")
    p.add_argument(
        "--box", type=float, nargs=4, metavar=("QMIN", "QMAX", "VMIN", "VMAX"), help="to draw from"
    )
    p.add_argument("--transient", type=int, default=500, help="periods dropped (500)")
    p.add_argument("--window", type=int, default=240, help="periods looked at (240)")
    p.add_argument(
        "--longest",
        type=int,
        metavar="N",
        help="most periods to a repetition (60, or half the window)",
    )
    p.add_argument(
        "--compare", type=int, default=0, metavar="PERIODS",
        help="also by the other method: drawn below, and compared on the first attractor over so many periods each",
    )  # fmt: skip
    p.add_argument(
        "--points",
        type=int,
        default=POINTS,
        help=f"periods that an aperiodic attractor is drawn over ({POINTS})",
    )
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=stopped(run_attractor))


def run_attractor(options: argparse.Namespace) -> int:
    """`lcpstep attractor`."""
    scene = study_scene(options)
    method = method_of(options, scene)
    periodic(scene, "attractors")
    names = files(options, "attractors")
    number = checks.count("--starts", options.starts)
    starts = outside(scene, random_starts(box(options, scene), number, options.seed), options.phase)
    if len(starts) == 0:
        raise ValueError("--box: it lies inside of the obstacle, as far as was looked")

    longest = min(LONGEST, options.window // 2) if options.longest is None else options.longest
    window = max(options.window, 2 * longest)

    def search(by: Method) -> Attractors:
        return attractors(
            scene, by, starts, transient=options.transient, window=window, longest=longest, phase=options.phase,
            points=options.points,
        )  # fmt: skip

    with work_bar("attractors"):
        found = search(method)
    rows = {method_words(method): found.found}
    compared: dict[str, Likeness] = {}
    if options.compare and found.found:
        x = found.found[0].points[-1]
        with work_bar("by both methods"):
            stepped = sample(scene, moreau(options, scene), x, options.compare)
            exact = sample(scene, event_driven(options), x, options.compare)
        compared = likeness(stepped, exact, seed=options.seed)
        other = event_driven(options) if isinstance(method, Moreau) else moreau(options, scene)
        with work_bar("by the other method"):
            rows[method_words(other)] = search(other).found
    title = f"{scene_words(scene)}: attractors, {options.starts} random starts, section at phase {options.phase:g}"
    corners = np.atleast_1d(np.asarray(scene.corners)) / scene.period
    figure = pictures.attractors(rows, title, [float(c) for c in corners], scene.labels)
    finish(options, _dataset(scene, method, found, options.seed), figure, names)
    lines = [_row(name, a) for name, group in rows.items() for a in group]
    if options.json:
        text = {"attractors": lines, "likeness": {k: vars(x) for k, x in compared.items()}}
        print(json.dumps(text, indent=2))
        return DONE
    event = "switches" if isinstance(scene, HybridScene) else "impacts"
    for r in lines:
        print(
            f"{r['name']:20} share {r['share']:6.1%}   {event} per period {r['impacts_per_period']:8.4g}   "
            f"Lyapunov exponent per period {_exponent(r)}   {r['method'] if len(rows) > 1 else ''}".rstrip()
        )
        if r["unsettled"]:
            print(f"  {r['unsettled']}")
    nowhere = float(np.mean(found.label < 0))
    if nowhere:
        print(f"{'none':20} share {nowhere:6.1%}   motions that end early, or grow without bound")
    for name, x in compared.items():
        print(
            f"time-stepping against event-driven, {name}: distance {x.distance:.4g} "
            f"[{x.low:.4g}, {x.high:.4g}], p = {x.p_value:.3g}"
        )
    return DONE


def _exponent(r: dict[str, Any]) -> str:
    """The exponent and its error; why, where it is not known."""
    if r["lyapunov"] is None:
        return f"not known: {r['lyapunov_reason']}"
    return f"{r['lyapunov']:9.4g} +- {r['lyapunov_error']:.2g}"


def box(options: argparse.Namespace, scene: Any) -> list[list[float]]:
    """Lowest and highest states of the random starts; of several coordinates the others begin as the scene does."""
    if not options.box and options.scene != "cam-follower":
        raise ValueError("--box: expected QMIN QMAX VMIN VMAX, the states to start from")
    q_min, q_max, v_min, v_max = options.box or (x for pair in zip(*CAM_BOX, strict=True) for x in pair)
    ends = [(q_min, v_min), (q_max, v_max)]
    if isinstance(scene, HybridScene) or scene.n_q == 1:
        return [list(end) for end in ends]
    states = []
    for q, v in ends:
        x = np.concatenate([scene.q0, scene.v0]).astype(float)
        x[0], x[scene.n_q] = q, v
        states.append(x.tolist())
    return states


def _row(method: str, a: Any) -> dict[str, Any]:
    per_period, found = a.impacts / a.periods if a.periods else a.impacts, a.lyapunov
    return {
        "method": method, "name": a.name, "share": a.share, "impacts_per_period": per_period,
        "unsettled": a.unsettled, "lyapunov": None if math.isnan(found.largest) else found.largest,
        "lyapunov_error": None if math.isnan(found.error) else found.error, "lyapunov_reason": found.reason,
    }  # fmt: skip


def _dataset(scene: Any, method: Any, found: Attractors, seed: int) -> Any:
    """All attractors, padded to one length."""
    points = max((len(a.cloud) for a in found.found), default=1)
    impacts = max((len(a.impact_phase) for a in found.found), default=1)

    def padded(rows: list[Any], length: int) -> Any:
        out = np.full((len(rows), length, *np.shape(rows[0])[1:]) if rows else (0, length), math.nan)
        for k, row in enumerate(rows):
            out[k, : len(row)] = row
        return out

    at = ("attractor", "impact")
    variables = {
        "name": (("attractor",), np.array([a.name for a in found.found])),
        "share": (("attractor",), np.array([a.share for a in found.found])),
        "lyapunov": (("attractor",), np.array([a.lyapunov.largest for a in found.found])),
        "states": (("attractor", "point", "state"), padded([a.cloud for a in found.found], points)),
        "impact_phase": (at, padded([a.impact_phase for a in found.found], impacts)),
        "impact_before": (at, padded([a.impact_before for a in found.found], impacts)),
        "impact_after": (at, padded([a.impact_after for a in found.found], impacts)),
        "impact_number": (at, padded([a.impact_number for a in found.found], impacts)),
        "impact_contact": (at, padded([a.impact_contact for a in found.found], impacts)),
        "start": (("run", "state"), found.starts),
        "label": (("run",), found.label),
    }
    own = {} if isinstance(scene, HybridScene) else units(scene.labels)
    return labelled(variables, {}, provenance(scene, method) | found.settings | {"seed": seed}, own)
