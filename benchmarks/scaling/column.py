"""The column, and one run of it by the library: `python -m benchmarks.scaling.column N CASE STEPS` prints JSON.

N bodies of one kilogramme above each other and a floor, restitution 1/2, step 1 ms, theta 1/2.

    touching   all gaps closed, at rest: they must stay so, and contact k carries (N - k) g
    falling    1 mm between neighbours, dropped: contacts close one after another; of up to 100 bodies the true motion
               can be had, from the event-driven integrator
"""

from __future__ import annotations

import json
import resource
import sys
import time

import numpy as np

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Moreau, simulate

H, GRAVITY, GAP = 1e-3, 9.81, 1e-3
CASES = ("touching", "falling")
FOLLOWED = 100  # bodies up to which a falling column is followed from impact to impact
LOOKS = 20  # states that are compared then


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


def looks(steps: int) -> np.ndarray:
    """Times at which a falling column is compared with its true motion; the last one is the end."""
    return H * (steps // LOOKS) * np.arange(1, LOOKS + 1)


def true_motion(n: int, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities of a column that falls, from impact to impact, at these times."""
    scene = column(n, "falling", steps)
    G, M = scene.contacts.G.toarray(), np.eye(n)
    system = LinearSystem(M, force=np.full(n, -GRAVITY))
    dense = Scene(system, scene.q0, scene.v0, scene.t_span, LinearContacts(G, restitution=0.5))
    run = simulate(dense, EventDriven(), keep=looks(steps))
    return run.q, run.v


def main() -> None:
    n, case, steps = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    followed = case == "falling" and n <= FOLLOWED
    scene, ends = column(n, case, steps), looks(steps) if followed else np.array([H * steps])
    for loads_once in (10, 300):  # dense steps, sparse ones
        simulate(column(loads_once, case, 3), Moreau(H))
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
        if followed:
            answer |= {"q": run.q.tolist(), "v": run.v.tolist()}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
