"""Whether a change has left every motion as it was: `python -m benchmarks.fingerprints --help`.

Every scene of the catalogue by every method that takes it, with three ways of keeping states. Of each motion a hash
of all its numbers is taken, and some of them are stored, so that two collections can be compared: equal to the last
bit, or how far apart relative to the size of the motion.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene
from lagrangian.scenes import CATALOGUE
from lcpstep import EventDriven, LcpStepError, Located, Moreau, simulate

STEPS = 1000  # of the default span of a scene
SAMPLES = 20  # states and impacts of a motion that are stored
LONGEST = 20.0  # of a span [s]
Collection = dict[str, dict[str, Any]]


def methods(h: float) -> dict[str, Any]:
    """Every way to compute a motion, by name."""
    return {
        "event-driven": EventDriven(),
        "moreau": Moreau(h),
        "moreau theta=0.7": Moreau(h, theta=0.7),
        "moreau projected": Moreau(h, projected=True),
        "moreau qp": Moreau(h, lcp="qp"),
        "moreau tolerance": Moreau(10.0 * h, tolerance=1e-3),
        "located": Located(h),
        "located tolerance": Located(10.0 * h, tolerance=1e-5),
        "located order 4": Located(h, order=4),
        "located order 4 tolerance": Located(10.0 * h, order=4, tolerance=1e-7),
        "located exact": Located(h, order="exact"),
    }


def keeps(scene: Scene) -> dict[str, Any]:
    """Three ways of keeping states."""
    return {"all": 1, "times": np.linspace(*scene.t_span, 7), "impacts": "impacts"}


def motions(only: list[str]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and fingerprint of every motion."""
    for name, entry in CATALOGUE.items():
        if only and name not in only:
            continue
        scene = entry.make()
        start, end = scene.t_span
        if end - start > LONGEST:
            scene = entry.make(t_end=start + LONGEST)
        for how, method in methods((scene.t_span[1] - start) / STEPS).items():
            for kept, keep in keeps(scene).items():
                yield f"{name} | {how} | {kept}", fingerprint(scene, method, keep)


def fingerprint(scene: Scene, method: Any, keep: Any) -> dict[str, Any]:
    """Hash and samples of one motion; of one that is refused, the reason."""
    try:
        run = simulate(scene, method, keep=keep)
    except LcpStepError as refusal:
        return {"refused": str(refusal)}
    log = np.column_stack([run.impacts[name].astype(float) for name in run.impacts.dtype.names])
    numbers = [run.t, run.q, run.v, run.impulse, log]
    digest = hashlib.sha256(b"".join(np.ascontiguousarray(x, dtype=float).tobytes() for x in numbers))
    rows = np.unique(np.linspace(0, len(run.t) - 1, SAMPLES).astype(int))
    return {
        "hash": digest.hexdigest()[:16], "status": run.status.name, "states": len(run.t), "events": len(log),
        "q": run.q[rows].tolist(), "v": run.v[rows].tolist(), "times": log[-SAMPLES:, 0].tolist(),
        "size": float(max(np.max(np.abs(run.q), initial=0.0), np.max(np.abs(run.v), initial=0.0))),
    }  # fmt: skip


def difference(old: dict[str, Any], new: dict[str, Any]) -> str:
    """How two fingerprints differ, in words; empty where they are equal."""
    if "refused" in old or "refused" in new:
        return "" if old == new else f"refused: {old.get('refused')!r} -> {new.get('refused')!r}"
    if old["hash"] == new["hash"] and old["status"] == new["status"]:
        return ""
    words = [
        f"{key} {old[key]} -> {new[key]}" for key in ("status", "states", "events") if old[key] != new[key]
    ]
    for key in ("q", "v", "times"):
        a, b = np.array(old[key]), np.array(new[key])
        if a.shape == b.shape and a.size:
            words.append(f"{key} {np.max(np.abs(a - b)) / (old['size'] or 1.0):.1e}")
    return ", ".join(words)


def compare(old: Collection, new: Collection) -> int:
    """Print every motion that differs; how many do."""
    differing = 0
    for name in sorted(old.keys() & new.keys()):
        words = difference(old[name], new[name])
        if words:
            differing += 1
            print(f"{name}: {words}")
    print(f"{len(new)} motions, {differing} differ", end="; ")
    print(f"{len(old.keys() ^ new.keys())} are in one collection only")
    return differing


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fingerprints", description=__doc__)
    parser.add_argument("--save", type=Path, metavar="FILE", help="write the fingerprints to this file")
    parser.add_argument("--against", type=Path, metavar="FILE", help="compare with fingerprints saved before")
    parser.add_argument("--scenes", nargs="*", default=[], metavar="SCENE", help="these scenes only")
    asked = parser.parse_args()
    begin, made = time.process_time(), {}
    for name, found in motions(asked.scenes):
        made[name] = found
        print(f"\r{len(made)} motions, {time.process_time() - begin:.0f} s", end="", file=sys.stderr)
    print(file=sys.stderr)
    if asked.save:
        asked.save.write_text(json.dumps(made) + "\n")
    if asked.against:
        old = json.loads(asked.against.read_text())
        if asked.scenes:
            old = {name: x for name, x in old.items() if name.split(" | ")[0] in asked.scenes}
        return 1 if compare(old, made) else 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
