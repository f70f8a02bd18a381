"""`lcpstep basin`: basins of attraction on a grid of initial states."""

from __future__ import annotations

import argparse
from typing import Any

from lagrangian import checks
from lcpstep.analysis.basins import basins
from lcpstep.cli.common import DONE
from lcpstep.cli.studies import (
    PARTS,
    files,
    finish,
    keeps_parts,
    method_of,
    stopped,
    study_arguments,
    study_scene,
    work_bar,
)
from lcpstep.maps.batch import periodic
from lcpstep.plot import basins as pictures
from lcpstep.plot.words import title_of

CAM_POSITION, CAM_VELOCITY = (0.1, 1.6), (-60.0, 60.0)  # absolute, as in the thesis


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "basin",
        help="basins of attraction on a grid of initial states",
        description="Labels every cell of a rectangle of initial states by the attractor that its centre goes to, "
        "and prints each attractor's share with its uncertainty. The cam-follower is taken in absolute coordinates. "
        "A run that was interrupted goes on with the same command.",
        epilog="Example: lcpstep basin cam-follower --rpm 358.5 --grid 1000 1000 --out out",
    )
    study_arguments(p)
    p.add_argument(
        "--position", type=float, nargs=2, metavar=("LOW", "HIGH"), help="in the unit of the scene"
    )
    p.add_argument(
        "--velocity", type=float, nargs=2, metavar=("LOW", "HIGH"), help="in the unit of the scene"
    )
    p.add_argument(
        "--grid", type=int, nargs=2, default=(200, 200), metavar=("NQ", "NV"), help="cells (200 200)"
    )
    p.add_argument("--longest", type=int, default=1000, help="periods to wait for an attractor (1000)")
    p.add_argument("--sample", type=int, default=2000, help="cells followed one by one as a check (2000)")
    p.set_defaults(run=stopped(run_basin))


def run_basin(options: argparse.Namespace) -> int:
    """`lcpstep basin`."""
    cam = options.scene == "cam-follower"
    given = any(setting.startswith("coordinates=") for setting in options.set)
    scene = study_scene(options, **({"coordinates": "absolute"} if cam and not given else {}))
    periodic(scene, "basins")
    position, velocity = options.position, options.velocity
    if cam and not given:
        position, velocity = position or CAM_POSITION, velocity or CAM_VELOCITY
    if position is None or velocity is None:
        raise ValueError("--position, --velocity: expected LOW HIGH, the rectangle of initial states")
    for name, (low, high) in {"--position": position, "--velocity": velocity}.items():
        if not low < high:
            raise ValueError(f"{name}: expected LOW < HIGH, got {low:g} {high:g}")
    n_q, n_v = (checks.count("--grid", n) for n in options.grid)
    names = files(options, "basins")
    keeps_parts(options)
    method = method_of(options, scene)
    with work_bar("basins"):
        data = basins(
            scene, [position[0], velocity[0]], [position[1], velocity[1]], (n_q, n_v),
            method=method, phase=options.phase, longest=options.longest, sample=options.sample,
            seed=options.seed, jobs=options.jobs, out=options.out / PARTS,
        )  # fmt: skip
    finish(
        options,
        data,
        pictures.basins(data, title_of(scene, f"{n_q} x {n_v} cells", method)),
        names,
    )
    for name, share, error in zip(*(data[k].values for k in ("name", "share", "share_error")), strict=True):
        print(f"{name:20} share {share:.5f} +- {error:.5f}")
    print(f"{data.attrs['unlabelled']:.3%} of the cells reached no attractor")
    return DONE
