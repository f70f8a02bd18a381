"""`lcpstep orbit`: a periodic orbit, its multipliers, and its branch over a parameter."""

from __future__ import annotations

import argparse
from functools import partial
from typing import Any

import numpy as np

from lagrangian.scenes import CATALOGUE
from lcpstep.analysis.continuation import Steps
from lcpstep.analysis.orbits import OrbitBranch, PeriodicOrbit, continue_orbit, periodic_orbit
from lcpstep.analysis.variation import PeriodMap
from lcpstep.cli.common import DONE
from lcpstep.cli.studies import files, finish, method_of, stopped, study_arguments, study_scene
from lcpstep.dataset import labelled, provenance
from lcpstep.errors import UnknownName
from lcpstep.plot import diagrams


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "orbit",
        help="find a periodic orbit and follow it over a parameter",
        description="Shoots for a periodic orbit, from --guess or from where the scene's motion settles; prints its "
        "impacts and multipliers. --range follows it over a parameter, stable or not, and locates folds, flips, "
        "corners and grazing contacts.",
        epilog="Example: lcpstep orbit cam-follower --rpm 700 --range 660 760 --out out",
    )
    study_arguments(p)
    p.add_argument("--periods", type=int, default=1, help="periods of the forcing after which it repeats (1)")
    p.add_argument("--guess", type=float, nargs="+", metavar="X", help="state (q, v) on the section")
    p.add_argument("--transient", type=int, default=500, help="periods to settle without a guess (500)")
    p.add_argument("--parameter", default="rpm", help="parameter of the branch (rpm)")
    p.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="of the parameter")
    p.add_argument("--points", type=int, default=200, help="most points of the branch, each way (200)")
    p.set_defaults(run=stopped(run_orbit))


def run_orbit(options: argparse.Namespace) -> int:
    """`lcpstep orbit`."""
    scene, method = study_scene(options), method_of(options)
    known = CATALOGUE[options.scene].parameters
    if options.range is not None and options.parameter not in known:
        raise UnknownName(f"parameter of {options.scene}", options.parameter, known)
    if options.range is not None and not options.range[0] < options.range[1]:
        raise ValueError("--range: expected LOW < HIGH, got {:g} {:g}".format(*options.range))
    names = files(options, "branch") if options.range is not None else None
    guess = options.guess
    if guess is None:
        x = np.concatenate([scene.q0, scene.v0])
        guess = (
            PeriodMap(scene, method, options.phase)
            .follow(x, options.transient + 1, options.transient)
            .final[0]
        )
    orbit = periodic_orbit(scene, guess, options.periods, method=method, phase=options.phase)
    _print(orbit)
    if names is None:
        return DONE
    fixed = {k: v for k, v in scene.parameters.items() if k in known and k != options.parameter}
    make = partial(CATALOGUE[options.scene].make, **fixed)
    here = float(scene.parameters[options.parameter])
    steps = Steps(points=options.points)
    ways = [
        continue_orbit(lambda p: make(**{options.parameter: p}), orbit, here, tuple(options.range), steps=steps,
                       forward=forward)
        for forward in (False, True)
    ]  # fmt: skip
    data = _dataset(ways, options.parameter, scene, method)
    finish(options, data, diagrams.branch(data, f"{orbit.name} of {scene.name}"), names)
    for way in ways:
        for s in way.special:
            shown = ", ".join(f"{m:.6g}" for m in s.multipliers)
            print(f"{s.kind:13} at {options.parameter} = {s.p:.10g}   multipliers {shown}")
        print(f"ended: {way.points.ended}")
    return DONE


def _print(orbit: PeriodicOrbit) -> None:
    print(f"{orbit.name}, {'stable' if orbit.stable else 'unstable'}; residual {orbit.residual:.2g}")
    print("states on the section: " + "; ".join(str(x.tolist()) for x in orbit.x))
    for phase, before, after in zip(orbit.phases, orbit.before, orbit.after, strict=True):
        print(f"impact at phase {phase:.12f}: gap velocity {before:.9g} -> {after:.9g} m/s")
    print("multipliers: " + ", ".join(f"{m:.10g} (modulus {abs(m):.10g})" for m in orbit.multipliers))


def _dataset(ways: list[OrbitBranch], parameter: str, scene: Any, method: Any) -> Any:
    """Both directions as one branch, and its special points."""
    down, up = ways
    special = [*down.special, *up.special]
    order = [(down, k) for k in range(len(down.orbits) - 1, 0, -1)] + [(up, k) for k in range(len(up.orbits))]
    multipliers = np.array([way.points.multipliers[k] for way, k in order])
    places = np.array([s.x for s in special]).reshape(len(special), multipliers.shape[1])
    variables = {
        "x": (("point", "state"), np.array([way.points.x[k] for way, k in order])),
        "stable": (("point",), np.array([way.orbits[k].stable for way, k in order], dtype=np.int8)),
        "multiplier_real": (("point", "state"), multipliers.real),
        "multiplier_imag": (("point", "state"), multipliers.imag),
        "multiplier_modulus": (("point", "state"), np.abs(multipliers)),
        "name": (("point",), np.array([way.orbits[k].name for way, k in order])),
        "special_kind": (("special",), np.array([s.kind for s in special], dtype=str)),
        "special_p": (("special",), np.array([s.p for s in special])),
        "special_x": (("special", "state"), places),
    }
    values = np.array([way.points.p[k] for way, k in order])
    attributes = provenance(scene, method) | {"parameter": parameter, "phase": up.phase}
    return labelled(variables, {parameter: (("point",), values)}, attributes)
