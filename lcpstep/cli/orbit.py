"""`lcpstep orbit`: a periodic orbit, its multipliers, and its branch over a parameter."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, checks
from lagrangian.labels import own_unit
from lcpstep import dataset
from lcpstep.analysis.branch_data import TAKEN, branch_dataset
from lcpstep.analysis.continuation import Steps
from lcpstep.analysis.fixed_points import NotConverged, periodic_point
from lcpstep.analysis.orbits import OrbitBranch, PeriodicOrbit, continue_orbit, periodic_orbit
from lcpstep.analysis.predictor import CLOSED, Progress
from lcpstep.analysis.predictor import INTERRUPTED as INTERRUPTED_WORD
from lcpstep.analysis.returns import TOLERANCE, return_time, to_shoot_from
from lcpstep.analysis.variation import PeriodMap
from lcpstep.cli import interrupt, proofs
from lcpstep.cli.common import DONE, INTERRUPTED, arguments_of, making, save_figure, vary
from lcpstep.cli.studies import (
    PARTS,
    files,
    finish,
    method_of,
    stopped,
    study_arguments,
    study_scene,
    work_bar,
)
from lcpstep.files import naming
from lcpstep.maps import EventMap, SwitchMap, iterate
from lcpstep.maps.event import KINDS
from lcpstep.plot import orbits as pictures
from lcpstep.plot.words import method_words, title_of

Found = TypeVar("Found")
LONGEST = 60  # periods after which a motion may repeat, where --periods does not say


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
    p.add_argument(
        "--periods", type=int, metavar="N",
        help="periods of the forcing after which it repeats; default: what the motion settles to, 1 with --guess",
    )  # fmt: skip
    p.add_argument(
        "--mode",
        metavar="NAME",
        help="a mode of the scene: the orbit from one entry into it to the next, driven or not",
    )
    p.add_argument(
        "--event",
        metavar="KIND",
        type=str.upper,
        help=f"the orbit from one event of this kind to the next, driven or not: {', '.join(KINDS).lower()}",
    )
    p.add_argument("--contact", type=int, default=0, help="contact whose events --event looks at (0)")
    p.add_argument(
        "--cyclic", type=int, nargs="+", default=[], metavar="N",
        help="coordinates, counted from 0, that the equations do not know of: left out of the points of --event",
    )  # fmt: skip
    p.add_argument("--guess", type=float, nargs="+", metavar="X", help="state (q, v) on the section")
    p.add_argument("--transient", type=int, default=500, help="periods to settle without a guess (500)")
    p.add_argument("--parameter", help="parameter of the branch (rpm)")
    p.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="of the parameter")
    p.add_argument("--points", type=int, default=400, help="most points of the branch, each way (400)")
    p.add_argument(
        "--draw", action="store_true", help="draw the orbit over its period and in the state plane: orbit.png"
    )
    proofs.argument(p, "the orbit, and the corners, flips and folds of its branch")
    p.set_defaults(run=stopped(run_orbit))


def run_orbit(options: argparse.Namespace) -> int:
    """`lcpstep orbit`."""
    proofs.check(options)
    if options.event is None and (options.contact or options.cyclic):
        raise ValueError("--contact, --cyclic: they belong to --event")
    if options.periods is not None:
        checks.count("--periods", options.periods)
    scene, ends = study_scene(options), options.range or ()
    if ends:
        vary(options)
        dataset.check_free(options.parameter, TAKEN)
        if not ends[0] < ends[1]:
            raise ValueError("--range: expected LOW < HIGH, got {:g} {:g}".format(*ends))
    others = (making(options, scene, options.parameter)(**{options.parameter: x}) for x in ends)
    method = method_of(options, scene, others)
    if options.mode is not None or options.event is not None:
        return _run_returns(options, scene, method)
    names = files(options, "branch") if options.range is not None else None
    drawn = options.out / "orbit.png"
    if options.draw:
        dataset.check_new(drawn, options.overwrite)

    def motion(drop: int, window: int) -> NDArray[np.float64]:
        P = PeriodMap(scene, method, options.phase)
        return P.follow(scene.x0, drop + window, drop).states[0]

    def shoot(x: Any, n: int) -> PeriodicOrbit:
        return periodic_orbit(scene, x, n, method=method, phase=options.phase)

    orbit = _found(options, motion, shoot, lambda orbit: orbit.x)
    _print(orbit)
    if options.draw:
        kind = "stable" if orbit.stable else "unstable"
        title = title_of(scene, f"{orbit.name}, {kind}", method)
        save_figure(pictures.orbit(orbit, title), drawn)
        print(f"wrote {drawn}")
    status = proofs.show_orbit(orbit) if options.prove else DONE
    return status if names is None else max(status, _run_branch(options, orbit, names))


def _found(
    options: argparse.Namespace,
    motion: Callable[[int, int], NDArray[np.float64]],
    shoot: Callable[[Any, int], Found],
    points: Callable[[Found], NDArray[np.float64]],
) -> Found:
    """What shooting finds from --guess, or from a motion(dropped, window) after the transient.

    A motion that still alternates as it settles seems to have twice its period.
    """
    n = options.periods
    with work_bar("transient") as name_stage:
        if options.guess is not None:
            x, n = options.guess, n or 1
        else:
            x, n = to_shoot_from(motion(options.transient, 2 * LONGEST + (n or 0)), LONGEST, n)
        name_stage("orbit")
        try:
            found = shoot(x, n)
            x, least = points(found), _least(points(found))
            return shoot(x[0], least) if options.periods is None and least < n else found
        except NotConverged as error:
            error.args = (f"{error}; {_hint(options)}",)
            raise


def _least(points: NDArray[np.float64]) -> int:
    """After how many of its points an orbit repeats already."""
    size = max(float(np.max(np.abs(points))), 1e-300)
    return return_time(np.concatenate([points, points]), len(points), TOLERANCE * size)


def _hint(options: argparse.Namespace) -> str:
    """What to do where shooting found nothing."""
    if options.guess is not None:
        return "try another --guess, or other --periods"
    if options.periods is not None:
        return "leave --periods out to take what the motion settles to, or give a --guess"
    return (
        f"the motion does not repeat within {LONGEST} periods: it is chaotic (lcpstep attractor tells) or wants a "
        "longer --transient; --periods and --guess find unstable orbits"
    )


def _run_returns(options: argparse.Namespace, scene: Any, method: Any) -> int:
    """The orbit on the section of entries into a mode, or of events of a contact."""
    if options.range is not None or options.draw or options.prove:
        raise ValueError(
            "--mode, --event: print the orbit on that section; --range and --draw go without it, and --prove too"
        )
    P: SwitchMap | EventMap
    if options.mode is not None:
        P, where = SwitchMap(scene, method, options.mode), f"entering {options.mode}"
    else:
        P = EventMap(scene, method, options.event, options.contact, tuple(options.cyclic))
        where = f"{options.event} of contact {options.contact}"

    def motion(drop: int, window: int) -> NDArray[np.float64]:
        return iterate(P, P.entry(), drop + window)[-window:]

    found = _found(options, motion, lambda x, n: periodic_point(P, x, n), lambda point: point.points)
    period = sum(P.duration(y) for y in found.points)
    print(f"{'stable' if found.stable else 'unstable'}; period {period:.12g}, residual {found.residual:.2g}")
    if isinstance(P, EventMap) and options.cyclic:
        moved = sum(P.advance(y) for y in found.points)
        print(f"coordinates left out move on by {np.atleast_1d(moved).tolist()}")
    state = "phase [rad] and state" if P.driven else "state"
    print(f"{state} on {where}: " + "; ".join(str(y.tolist()) for y in found.points))
    print("multipliers: " + ", ".join(f"{m:.10g} (modulus {abs(m):.10g})" for m in found.multipliers))
    return DONE


def _run_branch(options: argparse.Namespace, orbit: PeriodicOrbit, names: tuple[Path, Path]) -> int:
    """The branch through the orbit, both ways; what there is of it is saved where it is interrupted."""
    import xarray  # noqa: F401  (saves it; an interrupt should not wait for that to be loaded)

    scene, parameter = orbit.scene, options.parameter
    values = arguments_of(options, scene)
    make = making(options, scene, parameter)
    ways: list[OrbitBranch] = []
    with _points_bar(options, parameter) as progress:
        for forward in (False, True):
            way = continue_orbit(
                lambda p: make(**{parameter: p}), orbit, float(values[parameter]), tuple(options.range),
                steps=Steps(points=options.points), forward=forward, progress=progress,
            )  # fmt: skip
            ways.append(way)
            if way.points.ended == INTERRUPTED_WORD:
                interrupt.answer()
            if way.points.ended in (INTERRUPTED_WORD, CLOSED):  # the other way round is the same branch
                break
    low, high = (float(x) for x in options.range)
    data = branch_dataset(ways, parameter, (low, high), scene, orbit.method)
    title = (
        f"{scene.name}: branch of {orbit.name}, {parameter} {low:g} to {high:g}; {method_words(orbit.method)}"
    )
    interrupted = ways[-1].points.ended == INTERRUPTED_WORD
    finish(options, data, None if interrupted else pictures.branch(data, title), names)
    for way in ways:
        for s in way.special:
            shown = ", ".join(f"{m:.6g}" for m in s.multipliers)
            print(f"{s.kind:13} at {parameter} = {s.p:.10g}   multipliers {shown}")
        print(f"ended: {way.points.ended}")
    if interrupted:
        return INTERRUPTED
    return proofs.show_branch(ways, lambda p: make(**{parameter: p})) if options.prove else DONE


@contextmanager
def _points_bar(options: argparse.Namespace, parameter: str) -> Generator[Progress, None, None]:
    """A bar over the range of the parameter; each point of the branch is appended to a file as it is found."""
    from tqdm import tqdm

    low, high = options.range
    seen: list[float] = []
    form = "{desc}: {percentage:3.0f}% of the range |{bar}| {postfix} [{elapsed}<{remaining}]"

    file = options.out / PARTS / "branch.csv"
    file.parent.mkdir(parents=True, exist_ok=True)
    with (
        naming(file),
        file.open("w") as lines,
        tqdm(desc="branch", total=high - low, bar_format=form, disable=None, leave=False) as bar,
    ):

        def progress(p: float, x: NDArray[np.float64], multipliers: NDArray[np.complex128]) -> None:
            lines.write(",".join(repr(float(y)) for y in (p, *x, *np.abs(multipliers))) + "\n")
            lines.flush()
            seen[:] = [min([p, *seen]), max([p, *seen])]
            bar.set_postfix_str(f"{parameter} = {p:.6g}", refresh=False)
            bar.update(min(seen[1] - seen[0], high - low) - bar.n)

        yield progress


def _print(orbit: PeriodicOrbit) -> None:
    print(f"{orbit.name}, {'stable' if orbit.stable else 'unstable'}; residual {orbit.residual:.2g}")
    least = _least(orbit.x)
    if least < len(orbit.x):
        print(f"it repeats after {least} of these {len(orbit.x)} periods already (--periods {least})")
    print("states on the section: " + "; ".join(str(x.tolist()) for x in orbit.x))
    event, unit = (
        ("switch", "")
        if isinstance(orbit.scene, HybridScene)
        else ("impact", f" {own_unit('m/s', orbit.scene.labels)}")
    )
    rate = "rate of the guard" if event == "switch" else "gap velocity"
    for phase, before, after in zip(orbit.phases, orbit.before, orbit.after, strict=True):
        print(f"{event} at phase {phase:.12f}: {rate} {before:.9g} -> {after:.9g}{unit}")
    print("multipliers: " + ", ".join(f"{m:.10g} (modulus {abs(m):.10g})" for m in orbit.multipliers))
