"""Time of a step of a chain of n hinged links that falls on a rough floor: `python -m benchmarks.scaling.chain`.

Prints the processor time of a step by `Moreau`, averaged over a run, and the power of n by which it grows, for
chains that lie where they fall and for chains that bounce. Restitutions may follow: `... chain 0.5 0.9`.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from lagrangian import scenes
from lcpstep import Moreau, simulate

SIZES = (120, 250, 500, 1000)  # fewer than 100 links take the dense steps
RESTITUTIONS = (0.0, 0.5, 0.9)
H, T_END = 1e-3, 0.3


def seconds(n: int, restitution: float) -> float:
    """Processor time of a step."""
    scene = scenes.hinged_chain(n=n, restitution=restitution, t_end=T_END)
    begin = time.process_time()
    run = simulate(scene, Moreau(H), keep=20)
    taken = time.process_time() - begin
    print(f"{n:5d} links: {1e3 * taken / run.counts.steps:7.2f} ms a step, {run.status.name}", flush=True)
    return taken / run.counts.steps


def main() -> None:
    simulate(scenes.hinged_chain(n=2, t_end=0.02), Moreau(H))  # what is loaded once
    for restitution in map(float, sys.argv[1:] or RESTITUTIONS):
        print(f"restitution {restitution}")
        times = [seconds(n, restitution) for n in SIZES]
        power, _ = np.polyfit(np.log(SIZES), np.log(times), 1)
        print(f"grows with n to the power {power:.2f}")


if __name__ == "__main__":
    main()
