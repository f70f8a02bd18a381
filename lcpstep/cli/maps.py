"""`lcpstep map`: maps given by formulas or a file; diagram, exponent, periodic points, border-collision verdict."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from lcpstep.analysis.border_collision import BorderCollision, PiecewiseLinearMap, classify
from lcpstep.analysis.fixed_points import PeriodicPoint
from lcpstep.analysis.map_border import border_point
from lcpstep.analysis.map_diagram import STARTS, Escaped, exponent, map_diagram, periodic_points, settled
from lcpstep.analysis.returns import TOLERANCE, settled_time
from lcpstep.cli.common import DONE, number, settings
from lcpstep.cli.studies import PARTS, files, finish, parts_bar, stopped
from lcpstep.maps.formulas import MAPS, Family, named, piecewise_linear

OWN = "piecewise-linear"
UNSETTLED = "unsettled, nearing a periodic orbit: {} iterations dropped are too few (--drop)"
MATRICES = ("A-minus", "A-plus", "B-minus", "B-plus", "C")
LONGEST = 64  # period that is recognised
MARGIN = 1.0  # of the box in which periodic points are looked for, in sizes of the orbit


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "map",
        help="iterate a map given by a formula: diagram, exponent, periodic points, border collision",
        description="MAP is logistic, border-collision, grazing, piecewise-linear (with --A-minus and so on), or a "
        "Python file with a function image(x, parameters) and, if you like, derivative(x, parameters), PARAMETERS "
        "and RANGES (by name), X0, and side(x, parameters), zero on a border between smooth pieces. Prints where the "
        "orbit settles, the largest Lyapunov exponent, periodic points with their multipliers and, of "
        "piecewise-linear maps, the verdict on the border collision. --range makes a bifurcation diagram; a run that "
        "was interrupted goes on with the same command. --near finds where a fixed point meets the border, and "
        "says what happens there.",
        epilog="Example: lcpstep map logistic --parameter r --range 2.8 4 --out out",
    )
    p.add_argument("map", metavar="MAP", help=f"one of: {', '.join(MAPS)}, {OWN}; or FILE.py")
    p.add_argument(
        "--set", nargs="+", action="extend", default=[], metavar="NAME=VALUE", help="parameters of the map"
    )
    p.add_argument(
        "--x0", type=float, nargs="+", metavar="X", help="where orbits start; default: the map's own"
    )
    p.add_argument("--drop", type=int, default=1000, help="iterations dropped (1000)")
    p.add_argument("--keep", type=int, default=400, help="iterations recorded (400)")
    p.add_argument(
        "--parameter", metavar="NAME", help="parameter of the diagram; default: the first of the map"
    )
    p.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="of the parameter")
    p.add_argument("--points", type=int, default=800, help="parameter values (800)")
    p.add_argument("--start", choices=STARTS, default="fixed", help="of each value's orbit (fixed)")
    p.add_argument(
        "--periods",
        type=int,
        nargs="+",
        default=[1, 2],
        metavar="N",
        help="of periodic points looked for (1 2)",
    )
    p.add_argument(
        "--box", type=float, nargs="+", metavar="X",
        help="lowest, then highest point of the box in which they are looked for; default: around the orbit",
    )  # fmt: skip
    for name in MATRICES:
        p.add_argument(f"--{name}", type=float, nargs="+", metavar="X", help=f"of {OWN}, row by row")
    p.add_argument(
        "--near", type=float, metavar="VALUE",
        help="find where a fixed point meets the border of a file with `side`, from this value of --parameter on",
    )  # fmt: skip
    p.add_argument("--D", type=float, default=0.0, help=f"of {OWN} (0)")
    p.add_argument(
        "--seed", type=int, default=0, help="of the points that periodic ones are looked for from (0)"
    )
    p.add_argument("--jobs", type=int, metavar="N", help="threads; default: all cores")
    p.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="where the files go (out)")
    p.add_argument("--overwrite", action="store_true", help="write over files of an earlier run")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=stopped(run_map))


def run_map(options: argparse.Namespace) -> int:
    """`lcpstep map`."""
    family = family_of(options)
    if options.near is not None:
        return _run_border(options, family)
    if options.range is not None:
        return _run_diagram(options, family)
    result = _described(options, family)
    print(json.dumps(result, indent=2) if options.json else _text(result))
    return DONE


def family_of(options: argparse.Namespace) -> Family:
    """The map that the options name, with its parameters set."""
    given = {name: getattr(options, name.replace("-", "_")) for name in MATRICES}
    if options.map == OWN:
        family = piecewise_linear(**_matrices(given), D=options.D)
    else:
        for name, value in given.items():
            if value is not None:
                raise ValueError(f"--{name}: only {OWN} takes matrices")
        family = named(options.map)
    given = settings(options, family.parameters, family.name)
    return family.with_values({name: number(name, value) for name, value in given.items()})


def _matrices(given: dict[str, Any]) -> dict[str, Any]:
    """The matrices of a piecewise-linear map from lists of numbers, row by row."""
    for name, value in given.items():
        if value is None:
            raise ValueError(f"--{name}: {OWN} needs {', '.join(f'--{x}' for x in MATRICES)}")
    d = len(given["C"])
    result = {}
    for name, value in given.items():
        expected = d * d if name.startswith("A") else d
        if len(value) != expected:
            raise ValueError(f"--{name}: expected {expected} numbers, as --C has {d}, got {len(value)}")
        result[name.replace("-", "_")] = (
            np.reshape(value, (d, d)) if expected > d or name[0] == "A" else value
        )
    return result


def _described(options: argparse.Namespace, family: Family) -> dict[str, Any]:
    """What the map does at its parameters."""
    P, x0 = family.at(), family.x0 if options.x0 is None else options.x0
    result: dict[str, Any] = {"map": family.name, "parameters": dict(family.parameters)}
    try:
        orbit = settled(P, x0, options.drop, options.keep)
    except Escaped as error:
        orbit, result["orbit"] = np.atleast_2d(np.asarray(x0, dtype=float)), str(error)
    else:
        size = max(float(np.max(np.abs(orbit))), 1e-300)
        n = settled_time(orbit, min(LONGEST, len(orbit) // 2), TOLERANCE * size)
        found = exponent(P, orbit[0], options.keep, n)
        repeats = f"period {n}" if n else ""
        near = UNSETTLED.format(options.drop) if found.nearing else "aperiodic"
        other = "chaotic" if found.chaotic else near
        result |= {
            "orbit": repeats or other,
            "points": (orbit[: n or 1] + 0.0).tolist(),
            "lyapunov": found.largest if math.isfinite(found.largest) else str(found.largest),
            "lyapunov_error": found.error if math.isfinite(found.error) else str(found.error),
        }
    box = _box(options, orbit)
    result["periodic"] = [
        _point(point, n) for n in options.periods for point in periodic_points(P, box, n, seed=options.seed)
    ]
    if family.border is not None:
        result["border_collision"] = _verdict(
            classify(PiecewiseLinearMap(**family.border(family.parameters)))
        )
    return result


def _box(options: argparse.Namespace, orbit: Any) -> Any:
    """Lowest and highest point of the box in which periodic points are looked for."""
    d = orbit.shape[1]
    if options.box is None:
        size = np.maximum(np.ptp(orbit, axis=0), float(np.max(np.abs(orbit))) or 1.0)
        return np.stack([np.min(orbit, axis=0) - MARGIN * size, np.max(orbit, axis=0) + MARGIN * size])
    if len(options.box) != 2 * d:
        raise ValueError(f"--box: expected {2 * d} numbers, lowest and highest point, got {len(options.box)}")
    low, high = np.reshape(options.box, (2, d))
    if not np.all(low < high):
        raise ValueError(f"--box: expected lowest below highest, got {low.tolist()} and {high.tolist()}")
    return np.stack([low, high])


def _point(point: PeriodicPoint, n: int) -> dict[str, Any]:
    return {
        "period": n, "points": (point.points + 0.0).tolist(), "stable": point.stable,
        "multipliers": [[float(m.real), float(m.imag)] for m in point.multipliers],
    }  # fmt: skip


def _verdict(found: BorderCollision) -> dict[str, Any]:
    sides = ("minus", "plus")
    return {
        "verdict": found.words,
        "real_multipliers_above_1": list(found.above),
        "real_multipliers_below_-1": list(found.below),
        "fixed_points": {
            sign: [side for side in sides if getattr(found.fixed, f"{side}_exists")[k]]
            for k, sign in enumerate(("m < 0", "m > 0"))
        },
        "period_two": {sign: found.two_cycle[k] for k, sign in enumerate(("m < 0", "m > 0"))},
    }


def _text(r: dict[str, Any]) -> str:
    values = ", ".join(f"{k} = {x:g}" for k, x in r["parameters"].items())
    lines = [f"{r['map']} ({values}): {r['orbit']}"]
    if "lyapunov" in r:
        shown = ["; ".join(_numbers(x) for x in r["points"])] if r["orbit"].startswith("period") else []
        lines += [f"  points {x}" for x in shown]
        largest, error = (float(r[name]) for name in ("lyapunov", "lyapunov_error"))
        lines.append(f"largest Lyapunov exponent per iteration: {largest:.8g} +- {error:.2g}")
    for p in r["periodic"]:
        kind = "stable" if p["stable"] else "unstable"
        multipliers = ", ".join(f"{complex(*m):.8g}" if m[1] else f"{m[0]:.8g}" for m in p["multipliers"])
        points = "; ".join(_numbers(x) for x in p["points"])
        lines.append(f"period {p['period']}, {kind}: {points}   multipliers {multipliers}")
    if not r["periodic"]:
        lines.append("no periodic points found; --box and --periods say where and which")
    if "border_collision" in r:
        lines += _verdict_lines(r["border_collision"], "m = 0")
    return "\n".join(lines)


def _verdict_lines(border: dict[str, Any], where: str) -> list[str]:
    """The verdict, and what there is on both sides."""
    lines = [f"border collision at {where}: {border['verdict']}"]
    for sign in ("m < 0", "m > 0"):
        fixed = " and ".join(f"x{'-' if side == 'minus' else '+'}" for side in border["fixed_points"][sign])
        two = ", an orbit of period two" if border["period_two"][sign] else ""
        lines.append(f"  {sign}: {f'fixed point {fixed}' if fixed else 'no fixed point'}{two}")
    return lines


def _numbers(x: list[float]) -> str:
    return f"({', '.join(f'{y:.10g}' for y in x)})"


def _run_border(options: argparse.Namespace, family: Family) -> int:
    """The border collision of a fixed point, and what it leads to."""
    parameter = _parameter(options, family)
    found = border_point(family, parameter, options.near, options.x0)
    verdict = _verdict(classify(found.map))
    names = ("A_minus", "A_plus", "B_minus", "B_plus", "C")
    matrices = {name: np.asarray(getattr(found.map, name)).tolist() for name in names} | {"D": found.map.D}
    result = {"map": family.name, "parameter": parameter, "value": found.p, "x": found.x.tolist()}
    if options.json:
        print(json.dumps(result | {"local": matrices, "border_collision": verdict}, indent=2))
        return DONE
    point = _numbers(found.x.tolist())
    print(f"{family.name}: the fixed point {point} meets the border at {parameter} = {found.p:.10g}")
    print("\n".join(_verdict_lines(verdict, f"{parameter} = {found.p:.6g}")))
    print(f"m = {parameter} - {found.p:.10g}; side > 0 is +")
    return DONE


def _parameter(options: argparse.Namespace, family: Family) -> str:
    """The parameter that varies."""
    if not family.parameters:
        raise ValueError(f"--range, --near: {family.name} has no parameters")
    return str(options.parameter or next(iter(family.parameters)))


def _run_diagram(options: argparse.Namespace, family: Family) -> int:
    low, high = options.range
    if not low < high:
        raise ValueError(f"--range: expected LOW < HIGH, got {low:g} {high:g}")
    if options.points < 1:
        raise ValueError(f"--points: expected a positive number, got {options.points}")
    parameter = _parameter(options, family)
    names = files(options, "map")
    with parts_bar(f"{parameter} {low:g} .. {high:g}") as progress:
        data = map_diagram(
            family, parameter, np.linspace(low, high, options.points), x0=options.x0, start=options.start,
            drop=options.drop, keep=options.keep, jobs=options.jobs, out=options.out / PARTS, progress=progress,
        )  # fmt: skip
    from lcpstep.plot.maps import map_diagram as picture

    others = ", ".join(f"{k} = {x:g}" for k, x in family.parameters.items() if k != parameter)
    title = (
        f"{family.name}{f' ({others})' if others else ''}\n"
        f"{options.start} start, {options.drop} iterations dropped, {options.keep} shown"
    )
    if family.border is not None and parameter == "m":
        verdict = classify(PiecewiseLinearMap(**family.border(family.parameters))).words
        title += f"; border collision at m = 0: {verdict}"
    finish(options, data, picture(data, title), names)
    lost = int(np.sum(~np.isfinite(data["x"].values[:, 0, 0])))
    chaotic = int(np.sum(data["lyapunov"].values > 3.0 * data["lyapunov_error"].values))
    if options.json:
        found = {"values": data[parameter].values.tolist(), "positive_exponent": chaotic, "unbounded": lost}
        print(json.dumps({"map": family.name, "parameter": parameter} | found, indent=2))
        return DONE
    print(
        f"{options.points} values: {chaotic} with a positive exponent, {lost} where the orbit leaves all bounds"
    )
    return DONE
