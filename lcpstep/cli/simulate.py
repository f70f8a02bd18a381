"""`lcpstep simulate`: run one scene by one method, and save its motion."""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import HybridScene
from lagrangian.labels import own_unit, units
from lcpstep import energy, simulate
from lcpstep.cli import interrupt
from lcpstep.cli.common import (
    DONE,
    FAILED,
    event_driven,
    located,
    moreau,
    progress_bar,
    save_figure,
    save_film,
    save_text,
    scene_arguments,
    scene_of,
    stepping_arguments,
)
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.files import replacing
from lcpstep.simulation import Method
from lcpstep.trajectory import Kind, Status, Trajectory

METHODS: dict[str, Callable[[argparse.Namespace, Any], Method]] = {
    "moreau": lambda options, scene: replace(moreau(options, scene), tolerance=options.tolerance),
    "located": lambda options, scene: replace(located(options, scene), tolerance=options.tolerance),
    "event-driven": lambda options, scene: event_driven(options),
}

DEFAULTS: dict[str, Any] = {"h": None, "theta": 0.5, "lcp": "lemke", "order": "2"}
TAKES = {"moreau": ("h", "theta", "lcp"), "located": ("h", "order"), "event-driven": ()}
SAVED = (".npz", ".nc", ".csv")
DRAWN = (".png", ".pdf", ".svg")
FILMED = (".gif", ".html", ".mp4")


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "simulate",
        help="run one scene and save its motion",
        description="Runs a scene and prints how it went; --out saves t, q, v, impulse and impacts as FILE.npz, all "
        "of the run as FILE.nc, which lcpstep.load opens, or its states as a table, FILE.csv.",
        epilog="Example: lcpstep simulate bouncing-ball --method event-driven --set restitution=0.5 --out ball.npz",
    )
    scene_arguments(p)
    p.add_argument(
        "--method",
        choices=list(METHODS),
        help="(moreau; event-driven for a scene with modes, the one it has)",
    )
    stepping_arguments(p)
    p.add_argument("--order", help="2, 4 or exact, located only (2)")
    p.set_defaults(**dict.fromkeys(DEFAULTS))  # so that it is seen which are given
    p.add_argument(
        "--tolerance",
        type=float,
        help="rtol and atol of event-driven (1e-12); with moreau and located it chooses the steps, h the longest",
    )
    p.add_argument("--every", type=int, default=1, metavar="K", help="keep every K-th step (1)")
    p.add_argument(
        "--out", type=Path, metavar="FILE", help="save the motion (.npz; .nc for lcpstep.load; .csv)"
    )
    p.add_argument("--overwrite", action="store_true", help="write over a motion that was saved before")
    p.add_argument("--picture", type=Path, metavar="FILE", help="draw the motion (.png, .pdf, .svg)")
    p.add_argument(
        "--film", type=Path, metavar="FILE", help="film the motion (.gif, .html, .mp4 with ffmpeg)"
    )
    p.add_argument("--energy", action="store_true", help="balance the energy along the kept states")
    p.add_argument("--error", action="store_true", help="say how far the motion is right, by a second run")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=run_simulate)


def run_simulate(options: argparse.Namespace) -> int:
    """`lcpstep simulate`."""
    scene = scene_of(options)
    modes = isinstance(scene, HybridScene)
    options.method = options.method or ("event-driven" if modes else "moreau")
    if modes and options.energy:
        raise ValueError(f"--energy: {scene.name!r} has modes, and no masses and forces to balance")
    _refuse_what_does_not_apply(options)
    method = METHODS[options.method](options, scene)
    options.out = _checked_name(options.out, options.overwrite)
    _check_pictures(options, scene)
    try:
        with progress_bar(scene, options.method) as progress:
            run = simulate(scene, method, keep=options.every, progress=progress, error=options.error)
    except (SimulationError, SimulationInterrupted) as stopped:
        interrupt.answer()
        if options.out is not None:  # a long motion takes seconds to put together
            _save(options.out, stopped.trajectory, options.overwrite)
        raise
    _save(options.out, run, options.overwrite)
    if options.picture:
        from lcpstep.plot.motion import overview

        save_figure(overview(run), options.picture)
    if options.film:
        save_film(run, options.film)
    balance = {"energy": _balance(run)} if options.energy else {}
    sentence = _modes_sentence(run) if modes else _sentence(run, balance)
    print(json.dumps(_summary(run) | balance, indent=2) if options.json else sentence)
    for file in () if options.json else (options.out, options.picture, options.film):
        if file is not None:
            print(f"wrote {file}")
    return DONE if run.status == Status.DONE and (modes or not run.doubt) else FAILED


def _refuse_what_does_not_apply(options: argparse.Namespace) -> None:
    """ValueError for an option that the method does not take; what is not given is set to its default."""
    for name, default in DEFAULTS.items():
        value = getattr(options, name)
        if value is not None and name not in TAKES[options.method]:
            takers = " and ".join(method for method, taken in TAKES.items() if name in taken)
            raise ValueError(f"--{name}: {options.method} has none, it belongs to {takers}")
        setattr(options, name, default if value is None else value)


def _checked_name(file: Path | None, overwrite: bool) -> Path | None:
    """Where the motion is saved; a name without an ending gets that of numpy's files."""
    if file is None:
        return None
    file = file if file.suffix else file.with_name(f"{file.name}.npz")
    if file.suffix not in SAVED:
        raise ValueError(f"--out: expected a name that ends in {', '.join(SAVED)}, got {str(file)!r}")
    if file.is_dir():
        raise IsADirectoryError(f"--out: {file} is a folder")
    if file.exists() and not overwrite:
        raise FileExistsError(f"--out: {file} exists already; --overwrite replaces it")
    return file


def _check_pictures(options: argparse.Namespace, scene: Any) -> None:
    """ValueError for a picture or a film that could not be written after the run."""
    for name, file, endings in (("picture", options.picture, DRAWN), ("film", options.film, FILMED)):
        if file is None:
            continue
        if file.suffix not in endings:
            raise ValueError(
                f"--{name}: expected a name that ends in {', '.join(endings)}, got {str(file)!r}"
            )
        if file.is_dir():
            raise IsADirectoryError(f"--{name}: {file} is a folder")
        folder = next(path for path in file.absolute().parents if path.exists())
        if not folder.is_dir():
            raise ValueError(f"--{name}: {folder} is no folder")
    if options.film is not None and scene.drawing is None:
        raise ValueError(
            f"--film: {scene.name!r} has no drawing; give the scene a function of time and state that draws it"
        )
    if options.film is not None and options.film.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise ValueError(
            f"--film: {options.film} needs ffmpeg, which is not on the PATH; install it, or write .gif or .html"
        )


def _ended(run: Trajectory | HybridTrajectory) -> dict[str, Any]:
    return {
        "scene": run.scene.name,
        "parameters": dict(run.scene.parameters),
        "method": repr(run.method),
        "status": run.status.name,
        "message": run.message,
        "t_end": float(run.t[-1]),
    }


def _kinds(run: Trajectory | HybridTrajectory) -> dict[str, int]:
    """How many events of each kind."""
    return {kind.name.lower(): int(np.sum(run.impacts.kind == kind)) for kind in Kind}


def _modes_summary(run: HybridTrajectory) -> dict[str, Any]:
    entered, counts = np.unique(run.switches.target, return_counts=True)
    return (
        _ended(run)
        | {
            "x_end": run.x[-1].tolist(),
            "mode_end": str(run.mode[-1]),
            "steps": run.counts.steps,
            "force_evaluations": run.counts.force_evaluations,
            "switches": {str(name): int(n) for name, n in zip(entered, counts, strict=True)},
        }
        | ({} if run.impacts is None else {"events": _kinds(run)})
    )


def _modes_sentence(run: HybridTrajectory) -> str:
    s = _modes_summary(run)
    to = ", ".join(f"{n} to {name}" for name, n in s["switches"].items())
    met = "".join(f", {n} {kind}" for kind, n in s.get("events", {}).items() if n)
    return (
        f"{s['scene']} by {s['method']}: {s['status']}, {s['message']}\n"
        f"t = {s['t_end']:g} s, x = {s['x_end']}, mode {s['mode_end']}\n"
        f"{s['steps']} steps; switches: {to or 'none'}{met}"
    )


def _summary(run: Trajectory | HybridTrajectory) -> dict[str, Any]:
    if isinstance(run, HybridTrajectory):
        return _modes_summary(run)
    kinds = _kinds(run)
    return (
        _ended(run)
        | {
            "q_end": run.q[-1].tolist(),
            "v_end": run.v[-1].tolist(),
            "steps": run.counts.steps,
            "lcp_calls": run.counts.lcp_calls,
            "force_evaluations": run.counts.force_evaluations,
            "events": kinds,
            "penetration": float(np.max(run.penetration, initial=0.0)),
            "joint_drift": float(np.max(run.joint_drift, initial=0.0)),
        }
        | ({"error": run.error.as_dict()} if run.error else {})
    )


def _balance(run: Trajectory) -> dict[str, Any]:
    """The energy balance at the end of the run [J]."""
    e = energy(run)
    ends = {"start": e.total[0], "end": e.total[-1], "kinetic": e.kinetic[-1], "potential": e.potential[-1]}
    names = ("work", "obstacles", "damping", "impacts", "friction")
    ends |= {name: getattr(e, name)[-1] for name in names} | {"residual": e.residual[-1]}
    return {name: float(x) for name, x in ends.items()} | {
        "created_at_contacts": float(np.sum(e.created.energy)),
        "steps_that_created": len(e.created),
    }


def _sentence(run: Trajectory, balance: dict[str, Any]) -> str:
    s, length, joule = _summary(run), own_unit("m", run.scene.labels), units(run.scene.labels)[2]
    events = ", ".join(f"{n} {kind}" for kind, n in s["events"].items())
    return (
        f"{s['scene']} by {s['method']}: {s['status']}, {s['message']}\n"
        f"t = {s['t_end']:g} s, q = {s['q_end']}, v = {s['v_end']}\n"
        f"{s['steps']} steps, {s['lcp_calls']} complementarity problems; events: {events}\n"
        f"largest penetration {s['penetration']:.3g} {length}"
        + (f", joint drift {s['joint_drift']:.3g} {length}" if run.scene.n_j else "")
        + "".join(f"\nenergy: {_words(e, joule)}" for e in balance.values())
        + (f"\nerror bar: {run.error}" if run.error else "")
    )


def _words(e: dict[str, Any], unit: str) -> str:
    parts = ", ".join(
        f"{name} {e[name]:.6g}" for name in ("work", "obstacles", "damping", "impacts", "friction") if e[name]
    )
    created = (
        f"; {e['steps_that_created']} steps created {e['created_at_contacts']:.3g} {unit} at their contacts"
    )
    return (
        f"{e['start']:.6g} {unit} -> {e['end']:.6g} {unit} ({parts or 'no exchange'}), "
        f"residual {e['residual']:.2g} {unit}" + (created if e["steps_that_created"] else "")
    )


def _save(file: Path | None, run: Trajectory | HybridTrajectory, overwrite: bool) -> None:
    if file is not None and file.suffix == ".nc":
        interrupt.wrote(run.save(file, overwrite=overwrite))
    elif file is not None and file.suffix == ".csv":
        save_text(run.to_dataframe().to_csv().rstrip("\n"), file)
    elif file is not None:
        arrays: dict[str, Any] = {"t": run.t}
        if isinstance(run, HybridTrajectory):
            arrays |= {"x": run.x, "mode": run.mode, "switches": np.asarray(run.switches)}
            if run.impacts is not None:
                arrays |= {"impulse": run.impulse, "impacts": np.asarray(run.impacts)}
        else:
            log = np.asarray(run.impacts)
            arrays |= {"q": run.q, "v": run.v, "impulse": run.impulse, "impacts": log}
        with replacing(file) as draft:
            np.savez_compressed(draft, **arrays, summary=json.dumps(_summary(run)))
        interrupt.wrote(file)
