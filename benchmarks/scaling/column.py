"""The column, and one run of it by the library: `python -m benchmarks.scaling.column N CASE STEPS` prints JSON.

N bodies of one kilogramme above each other and a floor, restitution 1/2, step 1 ms, theta 1/2.

    touching   all gaps closed, at rest: they must stay so, and contact k carries (N - k) g
    falling    1 mm between neighbours, dropped: contacts close one after another
"""

from __future__ import annotations

import json
import resource
import sys
import time

import numpy as np

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate

H, GRAVITY, GAP = 1e-3, 9.81, 1e-3
CASES = ("touching", "falling")


def column(n: int, case: str, steps: int) -> Scene:
    """The scene, with sparse matrices."""
    from scipy import sparse

    G = sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1])
    q0 = np.zeros(n) if case == "touching" else GAP * np.arange(1, n + 1)
    system = LinearSystem(sparse.eye_array(n), force=np.full(n, -GRAVITY))
    return Scene(system, q0, np.zeros(n), (0.0, H * steps), LinearContacts(G, restitution=0.5))


def judged(case: str, q: np.ndarray, v: np.ndarray) -> dict[str, float]:
    """Speed in the end of a column that must rest; penetration of one that falls."""
    if case == "touching":
        return {"error": float(np.max(np.abs(v)))}
    return {"error": float(max(0.0, -np.min(np.diff(q, prepend=0.0))))}


def main() -> None:
    n, case, steps = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    scene, ends = column(n, case, steps), np.array([H * steps])
    simulate(column(10, case, 3), Moreau(H))  # what is loaded once
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begin = time.process_time()
    run = simulate(scene, Moreau(H), keep=ends)
    seconds = time.process_time() - begin
    answer = {"seconds": seconds / steps, "status": run.status.name}
    answer["megabytes"] = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    if run.status.name == "DONE":
        answer |= judged(case, run.q[-1], run.v[-1])
        if case == "touching":
            weights = GRAVITY * np.arange(n, 0, -1) * H * steps
            answer["force_error"] = float(np.max(np.abs(run.impulse[-1] / weights - 1.0)))
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
