"""`lcpstep corner`: where an impact of a periodic orbit meets a corner of the forcing, and what happens there."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lagrangian.labels import own_unit
from lcpstep import EventDriven, simulate
from lcpstep.analysis.border_collision import BorderCollision, PiecewiseLinearMap, classify, diagram
from lcpstep.analysis.chattering import Crossing, corner_crossings
from lcpstep.analysis.corner_branches import FixedBranch, orbit_branches, uncertainty
from lcpstep.analysis.corner_estimate import agreement, estimate
from lcpstep.analysis.corners import CornerImpact, corner_impact, local_map
from lcpstep.cli import proofs
from lcpstep.cli.common import (
    DONE,
    FAILED,
    save_figure,
    save_text,
    scene_arguments,
    scene_with_contacts,
    vary,
)
from lcpstep.cli.studies import share_bar, work_bar
from lcpstep.errors import LcpStepError
from lcpstep.maps import StroboscopicMap
from lcpstep.pace import counted
from lcpstep.plot.words import on_section

Array = NDArray[np.float64]
TRANSIENT = 300  # periods until the orbit to start from has settled
SETTLED = 3000  # periods dropped in the diagrams: beside the fold motions pass slowly where the orbits were
SHOWN = 40  # points per parameter in the diagrams


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "corner",
        help="find where an impact of a periodic orbit meets a corner of the forcing, and classify it",
        description="Follows the motion of SCENE at --from until it is periodic, finds the parameter at which an "
        "impact of it falls on a corner, the piecewise-linear map around it by the chain rule and by least squares "
        "on simulated perturbations, and the verdict; --out DIR receives corner.json and corner.png.",
        epilog="Example: lcpstep corner cam-follower --from 700 --near 673 --out out",
    )
    scene_arguments(p)
    p.add_argument("--parameter", metavar="NAME", help="parameter of the scene that is varied (rpm)")
    p.add_argument(
        "--from", dest="start", type=float, default=700.0, help="where the orbit is taken from (700)"
    )
    p.add_argument("--near", type=float, default=673.0, help="guess of the parameter sought (673)")
    p.add_argument("--corner", type=int, help="index of the corner; default: the one nearest to an impact")
    p.add_argument("--periods", type=int, default=1, help="of the forcing after which the orbit repeats (1)")
    p.add_argument("--phase", type=float, default=0.0, help="of the section, as a share of the period (0)")
    p.add_argument("--width", type=float, default=1e-3, help="half width of the diagrams, relative (1e-3)")
    p.add_argument("--points", type=int, default=121, help="parameters in the diagrams (121)")
    p.add_argument(
        "--chattering", type=float, nargs=2, metavar=("LOW", "HIGH"),
        help="list instead where releases, impacts and accumulation points of chattering sequences meet corners, "
        "starting at rest on the obstacle",
    )  # fmt: skip
    p.add_argument("--out", type=Path, metavar="DIR", help="where the files go; default: nothing is saved")
    p.add_argument("--overwrite", action="store_true", help="write over files that exist")
    p.add_argument("--no-picture", action="store_true", help="leave the picture out")
    p.add_argument("--json", action="store_true", help="print JSON")
    proofs.argument(p, "the corner impact and the speed of the forcing at which it is")
    p.set_defaults(run=run_corner)


def run_corner(options: argparse.Namespace) -> int:
    """`lcpstep corner`."""
    _check_out(options)
    proofs.check(options)
    if options.chattering is not None and options.prove:
        raise ValueError("--prove: impacts of chattering sequences cannot be proved; leave --chattering out")
    if len(np.asarray(scene_with_contacts(options).corners)) == 0:
        raise ValueError(
            f"scene: expected one whose obstacle has corners, as cam-follower; {options.scene!r} has none"
        )
    vary(options)
    if options.chattering is not None:
        return _run_chattering(options)

    def make(value: float) -> Scene:
        return scene_with_contacts(options, **{options.parameter: value})

    with work_bar("transient") as name_stage:
        start = make(options.start)
        x = np.concatenate([np.asarray(start.q0), np.asarray(start.v0)])
        x = _settled(start, x, options.phase)
        name_stage("corner impact")
        orbit = corner_impact(
            make, options.near, x, corner=options.corner, n=options.periods, phase=options.phase
        )
        name_stage("local map")
        chain = local_map(orbit)
        fitted = estimate(orbit, chain)
        found = classify(chain)
        result = _result(options, orbit, chain, agreement(fitted.map, chain), found)
        result["map_error"] = uncertainty(orbit, chain)
        if options.prove:
            name_stage("proof")
            result["proof"] = proofs.corner_data(orbit)
        if options.out is not None:
            values, local, full = _diagrams(options, orbit, chain, name_stage)
            name_stage("branches")
            branches = orbit_branches(orbit, chain, values)
    if options.out is not None:
        data = {
            "values": values.tolist(), "local": _lists(local), "full": _lists(full),
            "branches": [branch.as_dict() for branch in branches],
        }  # fmt: skip
        save_text(json.dumps(result | {"diagrams": data}, indent=1), options.out / "corner.json")
        if not options.no_picture:
            _draw(options, orbit, values, local, full, branches, found.words)
    print(json.dumps(result, indent=2) if options.json else _text(result, orbit.scene.labels))
    _tell_files(options, "corner.json", *([] if options.no_picture else ["corner.png"]))
    return DONE if not options.prove or result["proof"]["proved"] else FAILED


def _settled(scene: Scene, x: Array, phase: float) -> Array:
    """The state on the section at the phase, after the transient."""
    n, end = scene.n_q, (TRANSIENT + phase) * scene.period
    run = simulate(replace(scene, q0=x[:n], v0=x[n:], t_span=(0.0, end)), EventDriven(), keep=[end])
    return np.concatenate([run.q[-1], run.v[-1]])


def _check_out(options: argparse.Namespace) -> None:
    if options.out is None or options.overwrite:
        return
    for name in ("corner.json", "corner.png", "chattering.json"):
        if (options.out / name).exists():
            raise FileExistsError(f"--out: {options.out / name} exists already; --overwrite writes over it")


def _result(
    options: argparse.Namespace,
    orbit: CornerImpact,
    chain: PiecewiseLinearMap,
    agree: float,
    found: BorderCollision,
) -> dict[str, Any]:
    def complex_list(z: NDArray[np.complex128]) -> list[list[float]]:
        return [[float(v.real), float(v.imag)] for v in z]

    names = ("A_minus", "A_plus", "B_minus", "B_plus", "C")
    return {
        "scene": orbit.scene.name,
        "parameter": options.parameter,
        "value": orbit.p,
        "corner": orbit.corner,
        "time": orbit.time,
        "phase": orbit.time / orbit.scene.period % 1.0,
        "state": orbit.x.tolist(),
        "before": orbit.before,
        "after": orbit.after,
        "residual": orbit.residual,
        "map": {name: np.asarray(getattr(chain, name)).tolist() for name in names} | {"D": chain.D},
        "continuity_gap": found.gap,
        "agreement_with_least_squares": agree,
        "multipliers_minus": complex_list(found.multipliers_minus),
        "multipliers_plus": complex_list(found.multipliers_plus),
        "real_multipliers_above_1": list(found.above),
        "real_multipliers_below_-1": list(found.below),
        "verdict": found.words,
    }


def _text(r: dict[str, Any], labels: Sequence[str]) -> str:
    def rows(name: str) -> str:
        """The entries of one matrix, with the decimals that are known."""
        value, off = np.array(r["map"][name]), max(r["map_error"][name], float(np.finfo(float).tiny))
        places = max(0, min(14, int(-np.log10(2.0 * off))))
        shown = [", ".join(f"{x:.{places}f}" for x in row) for row in np.atleast_2d(value)]
        return ("\n" + " " * 14).join(shown)

    lines = [
        f"{r['scene']}: an impact meets corner {r['corner']} at {r['parameter']} = {r['value']:.9f}",
        f"  phase {r['phase']:.9f} of the period, gap velocity {r['before']:.9g} -> {r['after']:.9g} "
        f"{own_unit('m/s', labels)}",
        f"  state on the section [{', '.join(f'{x:.12g}' for x in r['state'])}], residual {r['residual']:.1e}",
        "local map in deviations (dx, dp), impact before (-) and after (+) the corner:",
        *(f"  {name:10}  {rows(name)}" for name in ("A_minus", "A_plus", "B_minus", "B_plus", "C")),
        f"  {'D':10}  {rows('D')}",
        f"  continuous to {r['continuity_gap']:.1e}; least squares on perturbations agree to "
        f"{r['agreement_with_least_squares']:.1e}",
        f"verdict: {r['verdict']}  (real multipliers above 1: {r['real_multipliers_above_1']}, "
        f"below -1: {r['real_multipliers_below_-1']})",
    ]
    return "\n".join(lines + ([r["proof"]["text"]] if "proof" in r else []))


def _diagrams(
    options: argparse.Namespace,
    orbit: CornerImpact,
    chain: PiecewiseLinearMap,
    name_stage: Callable[[str], None],
) -> tuple[Array, list[Array], list[Array]]:
    """Points of the local map and of the full system around the corner impact, in absolute coordinates."""
    m = np.linspace(-1.0, 1.0, options.points) * options.width * abs(orbit.p)
    name_stage("diagram of the local map")
    local = [orbit.x + y for y in diagram(chain, m, drop=SETTLED, keep=SHOWN)]
    full = []
    name_stage("diagram of the system")
    for value in counted(m.tolist()):
        P = StroboscopicMap(orbit.make(orbit.p + float(value)), EventDriven(), orbit.phase)
        try:
            full.append(P.follow(orbit.x, SETTLED + SHOWN, drop=SETTLED, most=0).states[0])
        except (ValueError, LcpStepError):  # a start inside of the obstacle
            full.append(np.zeros((0, len(orbit.x))))
    return orbit.p + m, local, full


def _tell_files(options: argparse.Namespace, *names: str) -> None:
    """What has been written to --out, for who reads the text."""
    if options.out is not None and not options.json:
        for name in names:
            print(f"wrote {options.out / name}")


def _lists(points: list[Array]) -> list[list[list[float]]]:
    return [y.tolist() for y in points]


def _draw(
    options: argparse.Namespace,
    orbit: CornerImpact,
    values: Array,
    local: list[Array],
    full: list[Array],
    branches: list[FixedBranch],
    words: str,
) -> None:
    from lcpstep.plot.corners import diagrams

    title = f"{orbit.scene.name}: corner impact at {options.parameter} = {orbit.p:.6f}, {words}"
    names = (options.parameter, on_section(orbit.scene.labels[0]))
    figure = diagrams(values, local, full, orbit.p, names, title, branches)
    save_figure(figure, options.out / "corner.png")


def _run_chattering(options: argparse.Namespace) -> int:
    low, high = options.chattering

    def make(value: float) -> Scene:
        return scene_with_contacts(options, **{options.parameter: value, "q0": 0.0, "v0": 0.0})

    with share_bar("chattering sequences") as (_, told):
        found: list[Crossing] = corner_crossings(
            make, (low, high), progress=lambda p: told(p - low, high - low)
        )
    rows = [c._asdict() for c in found]
    if options.out is not None:
        save_text(json.dumps(rows, indent=1), options.out / "chattering.json")
    if options.json:
        print(json.dumps(rows, indent=2))
        return DONE
    print(f"{options.parameter:>14}  sequence  event         corner")
    for c in found:
        event = f"impact {c.number}" if c.event == "impact" else c.event
        print(f"{c.p:14.9f}  {c.sequence + 1:8d}  {event:12}  {c.corner:6d}")
    _tell_files(options, "chattering.json")
    return DONE
