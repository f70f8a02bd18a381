"""`--prove` of the commands orbit and corner: enclosures, or why there are none."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from lcpstep.analysis.corners import CornerImpact
from lcpstep.analysis.orbits import OrbitBranch, PeriodicOrbit
from lcpstep.cli.common import DONE, FAILED

PROVED = ("corner", "flip", "fold")  # special points of a branch
SAME = 1e-6  # relative: a speed that is proved and one that was located


def argument(p: argparse.ArgumentParser, what: str) -> None:
    """The option itself."""
    p.add_argument(
        "--prove",
        action="store_true",
        help=f"prove {what} in ball arithmetic, and print what encloses it (needs python-flint: lcpstep[proofs])",
    )


def check(options: argparse.Namespace) -> None:
    """MissingSolver where a proof is asked for and cannot be had, before anything is computed."""
    if options.prove:
        from lcpstep.analysis import proofs  # noqa: F401


def show_orbit(orbit: PeriodicOrbit) -> int:
    """Print the proof of an orbit; the exit status."""
    from lcpstep.analysis.proofs import NotProved, prove

    try:
        print(prove(orbit))
    except NotProved as reason:
        print(f"not proved: {reason}")
        return FAILED
    return DONE


def show_branch(ways: Sequence[OrbitBranch], make: Callable[[float], Any]) -> int:
    """Print the proofs of the corners, flips and folds of a branch; the exit status."""
    from lcpstep.analysis.proofs import NotProved, prove_speed

    status = DONE
    for way in ways:
        for special in way.special:
            if special.kind not in PROVED:
                continue
            beside = [k for k in (special.after, special.after + 1) if 0 <= k < len(way.orbits)]
            nearest = min(beside, key=lambda k: abs(way.points.p[k] - special.p))
            scene = make(special.p)
            located = 2.0 * math.pi / scene.period
            try:
                proof = prove_speed(replace(way.orbits[nearest], scene=scene), special.kind)
                if abs(proof.omega.lower - located) > SAME * located:
                    raise NotProved(f"what is proved near it lies at omega = {proof.omega}")
                print(proof)
            except NotProved as reason:
                print(f"{special.kind} at {special.p:.10g} not proved: {reason}")
                status = FAILED
    return status


def corner_data(orbit: CornerImpact) -> dict[str, Any]:
    """The proof of a corner impact, or the reason why there is none, for a file."""
    from lcpstep.analysis.proofs import NotProved, prove_speed

    try:
        proof = prove_speed(orbit)
    except NotProved as reason:
        return {"proved": False, "text": f"not proved: {reason}"}
    return {
        "proved": True,
        "rpm": [proof.rpm.lower, proof.rpm.upper],
        "omega": [proof.omega.lower, proof.omega.upper],
        "text": str(proof),
    }
