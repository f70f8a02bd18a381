"""Error against CPU time of all methods that take friction, on the belt and the woodpecker: one picture.

    python -m benchmarks.work_precision.friction docs/friction-precision.png

Errors are the largest of the positions at 40 times, against the closed form (belt) or `EventDriven(1e-13, 1e-13)`
(woodpecker); times the least CPU time of three runs, in one process.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, simulate

REPEATS = 3
TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9)
CURVES: dict[str, Any] = {
    "Moreau": lambda T: [Moreau(T / n) for n in (300, 3000, 30000, 300000)],
    "Located, order 2": lambda T: [Located(T / n) for n in (300, 1000, 3000, 10000, 30000, 100000)],
    "Located, order 4": lambda T: [Located(T / n, order=4) for n in (300, 1000, 3000, 10000)],
    "Located, order 4, tolerance": lambda T: [Located(T / 20, order=4, tolerance=x) for x in TOLERANCES],
    "EventDriven": lambda T: [EventDriven(x, x) for x in (*TOLERANCES, 1e-11)],
}


def measured(scene: Any, method: Any, exact: Any, times: Any) -> tuple[float, float] | None:
    """CPU time [s] and error; None where the run ends early."""
    best, run = np.inf, None
    for _ in range(REPEATS):
        begin = time.process_time()
        run = simulate(scene, method, keep=times)
        best = min(best, time.process_time() - begin)
    if run is None or run.status != 0:
        return None
    return best, float(np.max(np.abs(run.q - exact)))


def main(path: str) -> None:
    """Measure, print and draw."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for axis, scene in zip(axes, (scenes.stick_slip_belt(), scenes.woodpecker(t_end=0.4)), strict=True):
        start, end = scene.t_span
        times = start + (end - start) * (np.arange(40) + 0.5) / 40.0
        best = EventDriven(1e-13, 1e-13)
        exact = scene.exact(times)[0] if scene.exact else simulate(scene, best, keep=times).q
        for name, methods in CURVES.items():
            points = [measured(scene, m, exact, times) for m in methods(end - start)]
            shown = [x for x in points if x is not None]
            print(scene.name, name, " ".join(f"{1e3 * t:.2f} ms {e:.1e}" for t, e in shown))
            axis.loglog(*np.array(shown).T, "o-", label=name)
        axis.set(title=scene.name, xlabel="CPU time [s]", ylabel="error of the positions [m, rad]")
        axis.grid(alpha=0.3)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1])
